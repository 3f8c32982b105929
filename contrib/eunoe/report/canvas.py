"""Drawing of particles to scale: every particle is a circle of its true diameter."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import EllipseCollection
from matplotlib.figure import Figure

from . import style

MOST_CIRCLES = 100_000  # in a panel; of more circles, only the front ones are drawn
MM = 1e3  # of a metre

LEFT, RIGHT, BOTTOM, TOP, BETWEEN = 0.62, 0.82, 0.42, 0.08, 0.12  # around the panels (inch)
MOST_HEIGHT = 6.  # of a panel (inch)
LEAST_BAR, MOST_BAR = 1.2, 1.8  # height of a colour bar (inch)


@dataclass(frozen=True)
class Window:
    """What a panel shows (m)."""

    x0: float
    x1: float
    y0: float
    y1: float

    def shows(self, x: np.ndarray, y: np.ndarray, diameters: np.ndarray) -> np.ndarray:
        """Whether each circle reaches into the window."""
        reach = 0.5 * diameters
        return ((x + reach > self.x0) & (x - reach < self.x1) &
                (y + reach > self.y0) & (y - reach < self.y1))


def make_panels(window: Window, n: int, names: str = "xy") -> tuple[Figure, list[Axes]]:
    """Makes panels in a column that show a window to scale, in mm."""
    ratio = (window.y1 - window.y0) / (window.x1 - window.x0)
    width = min(style.WIDTH - LEFT - RIGHT, MOST_HEIGHT / ratio)
    height = width * ratio
    total = TOP + max(n * height + (n - 1) * BETWEEN + BOTTOM, LEAST_BAR + 0.1)
    figure = Figure(figsize=(style.WIDTH, total))
    panels = []
    for k in range(n):
        bottom = total - TOP - height - k * (height + BETWEEN)
        axes = figure.add_axes((LEFT / style.WIDTH, bottom / total, width / style.WIDTH,
                                height / total))
        axes.set_xlim(MM * window.x0, MM * window.x1)
        axes.set_ylim(MM * window.y0, MM * window.y1)
        axes.set_ylabel(f"{names[1]} (mm)")
        axes.locator_params(axis="y", nbins=max(2, min(6, int(height / 0.3))))
        axes.tick_params(labelbottom=k == n - 1)
        panels.append(axes)
    panels[-1].set_xlabel(f"{names[0]} (mm)")
    return figure, panels


def add_colour_bar(figure: Figure, panels: list[Axes], mappable: ScalarMappable, label: str,
                   **options) -> Axes:
    """Adds a colour bar right of the panels, from the upper end of the first one."""
    low, high = panels[-1].get_position(), panels[0].get_position()
    height = np.clip(high.y1 - low.y0, LEAST_BAR / figure.get_figheight(),
                     MOST_BAR / figure.get_figheight())
    axes = figure.add_axes((high.x1 + 0.14 / style.WIDTH, high.y1 - height, 0.11 / style.WIDTH,
                            height))
    figure.colorbar(mappable, cax=axes, label=label, **options).outline.set_linewidth(0.6)
    return axes


def front_slice(shown: np.ndarray, towards_viewer: np.ndarray) -> tuple[np.ndarray, float]:
    """Rows of the circles to draw, and their share of the circles shown."""
    rows = np.flatnonzero(shown)
    if len(rows) <= MOST_CIRCLES:
        return rows, 1.
    share = MOST_CIRCLES / len(rows)
    nearness = towards_viewer[rows]
    return rows[nearness >= np.quantile(nearness, 1. - share)], share


def draw_circles(axes: Axes, x: np.ndarray, y: np.ndarray, diameters: np.ndarray,
                 faces: np.ndarray) -> None:
    """Draws circles in the order given, so that later ones cover earlier ones (m)."""
    if len(diameters) == 0:
        return
    points_wide = 72. * style.WIDTH * axes.get_position().width
    mean_in_points = MM * diameters.mean() / np.ptp(axes.get_xlim()) * points_wide
    axes.add_collection(EllipseCollection(
        MM * diameters, MM * diameters, np.zeros_like(diameters), units="x",
        offsets=MM * np.column_stack((x, y)), transOffset=axes.transData, facecolors=faces,
        edgecolors="#000000aa", linewidths=min(0.35, 0.06 * mean_in_points), rasterized=True))
