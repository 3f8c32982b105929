"""Pictures of a heap: the map of all views, the profile, the angles, and the particles."""

from __future__ import annotations

from math import radians, tan

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from . import style
from .canvas import MM, Window, add_colour_bar, draw_circles, front_slice, make_panels
from .heap_results import HeapMap, Profile, Views

Fields = dict[str, np.ndarray]

RIM_SHOWN = 0.2  # of the height of the disc's rim


def _draw_disc(axes: Axes, disc: float, rim: float) -> None:
    axes.add_patch(Rectangle((-0.5 * MM * disc, -MM * rim), MM * disc, MM * rim,
                             facecolor=style.SOLID_FACE, edgecolor=style.SOLID_EDGE, linewidth=0.6,
                             zorder=0.5))


def _draw_triangle(axes: Axes, disc: float, angle: float, **look) -> None:
    """The isosceles triangle whose base angle (degrees) is the result."""
    axes.plot(0.5 * MM * disc * np.array([-1., 0., 1.]),
              0.5 * MM * disc * tan(radians(angle)) * np.array([0., 1., 0.]), **look)


def map_figure(heap: HeapMap, views: Views, disc: float, rim: float) -> Figure:
    """The mean of all views in shades of grey."""
    left, right, bottom, top = heap.extent
    top = max(top, 0.53 * disc * tan(radians(views.mean_angle)))
    figure, panels = make_panels(Window(left, right, -RIM_SHOWN * rim, top), 1)
    norm = Normalize(0., 100.)
    panels[0].imshow(100. * heap.share, cmap="Greys", norm=norm, origin="lower",
                     extent=[MM * value for value in heap.extent], interpolation="nearest",
                     aspect="auto", zorder=0.1)
    _draw_disc(panels[0], disc, rim)
    _draw_triangle(panels[0], disc, views.mean_angle, color=style.VERMILLION, linewidth=1.)
    panels[0].set_xlim(MM * left, MM * right)
    panels[0].set_ylim(-RIM_SHOWN * MM * rim, MM * top)
    add_colour_bar(figure, panels, ScalarMappable(norm, "Greys"), "Seen in % of the views")
    return figure


def profile_figure(profile: Profile, views: Views, disc: float) -> Figure:
    """The mean profile with its spread, and the base angle of each view."""
    figure = Figure(figsize=(style.WIDTH, 2.9))
    left, right = figure.subplots(1, 2, width_ratios=(1.6, 1.))
    figure.subplots_adjust(left=0.08, right=0.985, top=0.91, bottom=0.16, wspace=0.24)
    x, mean, spread = (MM * values for values in (profile.x, profile.mean, profile.spread))
    left.fill_between(x, mean - spread, mean + spread, color=style.PALE_BLUE, linewidth=0.,
                      label="± standard deviation of the views")
    left.plot(x, mean, color=style.BLUE, label="mean of the views")
    if np.isfinite(profile.measured).any():
        left.plot(x, MM * profile.measured, color=style.INK, linewidth=1., label="measured")
    _draw_triangle(left, disc, views.mean_angle, color=style.VERMILLION, linewidth=0.9,
                   label="triangle of the same area")
    left.set_ylim(0., 1.45 * max(left.get_ylim()[1] / 1.05, 1e-9))
    left.set_xlabel("x (mm)")
    left.set_ylabel("Height (mm)")
    left.set_title("(a) Profile")
    left.legend(loc="upper left", ncol=1)
    right.plot(views.direction, views.base_angle, "o", markersize=3.8, color=style.BLUE)
    right.axhline(views.mean_angle, color=style.VERMILLION, linewidth=0.9)
    right.set_xlabel("Direction of the base line (degrees)")
    right.set_ylabel("Base angle (degrees)")
    right.set_title("(b) Views")
    right.set_xlim(-8., 180.)
    right.set_xticks(range(0, 181, 45))
    right.grid(axis="y")
    return figure


def particles_figure(particles: Fields, height: float, disc: float,
                     rim: float) -> tuple[Figure, float]:
    """The heap seen along z, coloured by diameter; and the share of it drawn. Lengths in m."""
    x, y, z = particles["points"].T.astype(float)
    margin = 0.06 * disc + particles["diameter"].max(initial=0.)
    window = Window(-0.5 * disc - margin, 0.5 * disc + margin, -RIM_SHOWN * rim, height + margin)
    figure, panels = make_panels(window, 1)
    _draw_disc(panels[0], disc, rim)
    rows, share = front_slice(window.shows(x, y, particles["diameter"]), z)
    rows = rows[np.argsort(z[rows])]
    diameters = particles["diameter"].astype(float)
    norm = Normalize(1e6 * diameters.min(), 1e6 * diameters.max())
    colours = colormaps["viridis"]
    draw_circles(panels[0], x[rows], y[rows], diameters[rows], colours(norm(1e6 * diameters[rows])))
    add_colour_bar(figure, panels, ScalarMappable(norm, colours), "Diameter (µm)")
    return figure, share
