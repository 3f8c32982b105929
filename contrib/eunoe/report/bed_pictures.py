"""Pictures of the powder in the spreading apparatus."""

from __future__ import annotations

from typing import Mapping, Sequence

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, Colormap, ListedColormap, LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Polygon, Rectangle

from . import style
from .apparatus import Apparatus
from .canvas import MM, Window, add_colour_bar, draw_circles, front_slice, make_panels
from .evidence import Fields
from .layer_results import STATIC_BELOW, moved_over_plate


def plate_window(apparatus: Apparatus, last_layer: int, largest_diameter: float) -> Window:
    """The window around the measuring plate, down to its height at the last layer."""
    beside = max(2.5 * apparatus.gap, 0.08 * apparatus.plate_length)
    above = max(2. * largest_diameter, 0.07 * apparatus.plate_length)
    return Window(apparatus.x_gap - beside, apparatus.x_exit + beside,
                  apparatus.plate_height(last_layer) - min(1.4 * apparatus.lip, above),
                  apparatus.clearance + above)


def whole_window(apparatus: Apparatus) -> Window:
    """The window from the feedstock platform to the collector."""
    beside = 0.02 * apparatus.x_end
    right = max(apparatus.x_end, apparatus.spreader_tip() + apparatus.front)
    return Window(-beside, right + beside, apparatus.y_bottom,
                  1.1 * apparatus.spreader_height + apparatus.clearance)


def _draw_plates(axes: Axes, apparatus: Apparatus, plate_height: float,
                 tips: Sequence[float] = ()) -> None:
    """Transfer, measuring and exit plate, and the spreaders at the time of weighing."""
    a = apparatus
    look = {"facecolor": style.SOLID_FACE, "edgecolor": style.SOLID_EDGE, "linewidth": 0.6,
            "zorder": 0.5}
    edge = -a.y_bottom if a.rim > 0. else a.lip  # beside rims the gaps have walls on both sides
    for x0, x1, y, deep in ((a.x_transfer, a.x_gap, 0., edge), (a.x_plate, a.x_plate_end, plate_height, a.lip),
                            (a.x_exit, a.x_end, 0., edge)):
        axes.add_patch(Rectangle((MM * x0, MM * (y - deep)), MM * (x1 - x0), MM * deep, **look))
    for x in (a.x_plate - a.rim, a.x_plate_end) if a.rim > 0. else ():
        axes.add_patch(Rectangle((MM * x, MM * a.y_bottom), MM * a.rim, -MM * a.y_bottom, **look))
    for tip in tips or [a.spreader_tip()]:
        axes.add_patch(Polygon(MM * a.spreader_outline(tip), **look))


def _draw_platform(axes: Axes, apparatus: Apparatus, height: float) -> None:
    """The feedstock platform and the walls on its two sides."""
    x1, bottom = MM * apparatus.x_transfer, MM * apparatus.y_bottom
    axes.plot([0., x1], [MM * height] * 2, color=style.SOLID_EDGE, linewidth=1.)
    axes.vlines([0., x1], bottom, [axes.get_ylim()[1], 0.], color=style.SOLID_EDGE, linewidth=0.6)


def _rows_to_draw(particles: Fields, window: Window) -> tuple[np.ndarray, float]:
    x, y, z = particles["points"].T
    return front_slice(window.shows(x, y, particles["diameter"]), z)


def _draw_rows(axes: Axes, particles: Fields, rows: np.ndarray, faces: np.ndarray) -> None:
    draw_circles(axes, particles["points"][rows, 0], particles["points"][rows, 1],
                 particles["diameter"][rows], faces)


def _layer_colours(n_layers: int) -> tuple[Colormap, Normalize]:
    shades = colormaps["viridis"](np.linspace(0.05, 0.97, n_layers))
    return ListedColormap(shades), BoundaryNorm(np.arange(n_layers + 1) - 0.5, n_layers)


def _draw_layers(axes: Axes, particles: Fields, window: Window, colours: Colormap) -> float:
    """Particles in the colours of their layers, the newest on top; returns the share drawn."""
    rows, share = _rows_to_draw(particles, window)
    layer = particles["layer"][rows].astype(int)
    order = np.lexsort((particles["points"][rows, 2], layer))
    faces = colours(np.maximum(layer, 0))
    faces[layer < 0] = (0.88, 0.88, 0.88, 1.)
    _draw_rows(axes, particles, rows[order], faces[order])
    return share


def _add_layer_colour_bar(figure: Figure, panels: list[Axes], n_layers: int) -> None:
    colours, norm = _layer_colours(n_layers)
    step = -(-n_layers // 8)
    add_colour_bar(figure, panels, ScalarMappable(norm, colours), "Layer",
                   ticks=range(0, n_layers, step)).minorticks_off()


def layers_figure(pictures: dict[int, Fields], apparatus: Apparatus,
                  n_layers: int) -> tuple[Figure, float]:
    """Side views of the powder on the plate at some weighings; and the share of it drawn."""
    largest = max(particles["diameter"].max(initial=0.) for particles in pictures.values())
    window = plate_window(apparatus, max(pictures), largest)
    figure, panels = make_panels(window, len(pictures))
    colours, _ = _layer_colours(n_layers)
    shares = []
    for axes, (layer, particles) in zip(panels, sorted(pictures.items())):
        _draw_plates(axes, apparatus, apparatus.plate_height(layer))
        shares.append(_draw_layers(axes, particles, window, colours))
        axes.text(0.008, 0.97, f"Layer {layer}", transform=axes.transAxes, va="top")
    _add_layer_colour_bar(figure, panels, n_layers)
    return figure, min(shares)


def overview_figure(particles: Fields, apparatus: Apparatus, layer: int,
                    weighings: Mapping[int, float]) -> tuple[Figure, float]:
    """The whole apparatus at a weighing; and the share of the powder that is drawn."""
    window = whole_window(apparatus)
    figure, panels = make_panels(window, 1)
    _draw_plates(panels[0], apparatus, apparatus.plate_height(layer),
                 apparatus.spreader_tips(layer, weighings))
    _draw_platform(panels[0], apparatus, apparatus.platform_height(layer, weighings))
    share = _draw_layers(panels[0], particles, window, _layer_colours(layer + 1)[0])
    _add_layer_colour_bar(figure, panels, layer + 1)
    return figure, share


def displacement_figure(particles: Fields, apparatus: Apparatus,
                        layer: int) -> tuple[Figure, float]:
    """How far the last pass moved the powder on the plate; and the share of the powder drawn."""
    window = plate_window(apparatus, layer, particles["diameter"].max(initial=0.))
    figure, panels = make_panels(window, 1)
    _draw_plates(panels[0], apparatus, apparatus.plate_height(layer))
    rows, share = _rows_to_draw(particles, window)
    tracked = particles["tracked"] > 0.
    # New powder is drawn behind the powder that it has moved.
    rows = rows[np.lexsort((particles["points"][rows, 2], tracked[rows]))]
    moved = moved_over_plate(particles)
    largest = max(moved[tracked].max(initial=0.), 10. * STATIC_BELOW)
    norm = LogNorm(1e6 * STATIC_BELOW, 1e6 * largest)
    colours = colormaps["plasma_r"]
    faces = colours(norm(np.maximum(1e6 * moved[rows], 1e6 * STATIC_BELOW)))
    faces[moved[rows] < STATIC_BELOW] = (0.6, 0.6, 0.6, 1.)
    faces[~tracked[rows]] = (1., 1., 1., 1.)
    _draw_rows(panels[0], particles, rows, faces)
    bar = add_colour_bar(figure, panels, ScalarMappable(norm, colours), "Displacement (µm)")
    style.plain_log_axis(bar.yaxis)
    return figure, share
