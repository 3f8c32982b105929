"""A movie of a pass, as .gif, and the same as a strip of a few pictures: the powder on the measuring plate,
coloured by how far it has moved over the plate since the last weighing."""

from __future__ import annotations

import io
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PolyCollection
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from eunoe.vtk_files import Snapshot, read_vtu

from . import style
from .apparatus import Apparatus
from .bed_pictures import plate_window
from .canvas import MM, Window, add_colour_bar, draw_circles, front_slice, make_panels
from .evidence import Fields
from .layer_results import STATIC_BELOW
from .run_folder import Layers, ReportError, Run

FIELDS = ("diameter", "layer", "on_plate", "last_position")
FARTHEST = 1e-3  # end of the scale of displacements (m)
FEWEST_FRAMES = 3
WHOLE = 0.9  # share of the time between two weighings in which the spreader moves
RESOLUTION = 110  # dots per inch
FRAME_TIME = 90  # ms


@dataclass(frozen=True)
class Frame:
    """A moment of a pass."""

    time: float  # s
    particles: Fields
    solids: np.ndarray  # triangles: corner, coordinate

    def plate_height(self, apparatus: Apparatus) -> float:
        """Height of the lowest solid that stands between the two gaps."""
        x, y = self.solids[..., 0], self.solids[..., 1]
        slack = 0.01 * apparatus.gap
        inside = ((x > apparatus.x_plate - slack) & (x < apparatus.x_plate_end + slack)).all(axis=1)
        if not inside.any():
            raise ReportError("The pictures of the solids do not show the measuring plate.")
        # The plate's edges reach down from its surface; a spreader above it is higher than both.
        level = (np.ptp(y, axis=1) < slack) & inside
        return float(y[level].min())


@dataclass(frozen=True)
class Pass:
    """The pictures of the particles between two weighings."""

    layer: int
    snapshots: Sequence[Snapshot]
    solids: dict[float, Path]
    duration: float = math.nan  # from weighing to weighing (s)

    @property
    def share_shown(self) -> float:
        return (self.snapshots[-1].time - self.snapshots[0].time) / self.duration

    def frames(self, every: int = 1) -> Iterator[Frame]:
        for snapshot in self.snapshots[::every]:
            triangles = read_vtu(self.solids[snapshot.time], ())["points"].reshape(-1, 3, 3)
            yield Frame(snapshot.time, read_vtu(snapshot.file, FIELDS), triangles)


def passes_of(run: Run, layers: Layers) -> dict[int, Pass]:
    """The passes of which there are enough pictures, by their layers."""
    solids = {entry.time: entry.file for entry in run.pictures("_solids")}
    usable = [entry for entry in run.pictures() if entry.time in solids]
    found = {}
    for k in range(1, len(layers)):
        within = [entry for entry in usable if layers.time[k - 1] < entry.time <= layers.time[k]]
        if len(within) >= FEWEST_FRAMES:
            duration = layers.time[k] - layers.time[k - 1]
            found[int(layers.layer[k])] = Pass(int(layers.layer[k]), within, solids, duration)
    return found


def pass_of(run: Run, layers: Layers, layer: int | None) -> Pass:
    """The wanted pass, or the last one that has pictures of all of it, else the one that has most of it."""
    found = passes_of(run, layers)
    if not found or (layer is not None and layer not in found):
        there = f" It has those of {', '.join(map(str, found))}." if found else ""
        raise ReportError(f"{run.folder} has no pictures of {'a pass' if layer is None else f'pass {layer}'} for a "
                          f"movie: 'output control', 'output time' and 'output time interval' in 'simulation "
                          f"control' make them.{there}")
    if layer is not None:
        return found[layer]
    return max(found.values(), key=lambda one: (min(one.share_shown, WHOLE), one.layer))


def moved_since(frame: Frame, apparatus: Apparatus, layer: int) -> np.ndarray:
    """Distance over the plate since the last weighing (m); NaN for what was not on the plate then."""
    here, there = frame.particles["points"].astype(float), frame.particles["last_position"].astype(float)
    fallen = frame.plate_height(apparatus) - apparatus.plate_height(layer - 1)
    moved = np.hypot(here[:, 0] - there[:, 0], here[:, 1] - there[:, 1] - fallen)
    return np.where((frame.particles["on_plate"] > 0) & (frame.particles["layer"] < layer), moved, np.nan)


def _norm() -> LogNorm:
    return LogNorm(1e6 * STATIC_BELOW, 1e6 * FARTHEST)


def _draw(axes: Axes, frame: Frame, apparatus: Apparatus, layer: int, window: Window) -> None:
    particles = frame.particles
    x, y, z = particles["points"].astype(float).T
    rows, _ = front_slice(window.shows(x, y, particles["diameter"]), z)
    moved = moved_since(frame, apparatus, layer)
    rows = rows[np.lexsort((z[rows], ~np.isnan(moved[rows])))]  # new powder behind
    faces = colormaps["plasma_r"](_norm()(np.clip(1e6 * moved[rows], 1e6 * STATIC_BELOW, None)))
    faces[moved[rows] < STATIC_BELOW] = (0.6, 0.6, 0.6, 1.)
    faces[np.isnan(moved[rows])] = (1., 1., 1., 1.)
    draw_circles(axes, x[rows], y[rows], particles["diameter"][rows], faces)
    axes.add_collection(PolyCollection(MM * frame.solids[..., :2], facecolors=style.SOLID_FACE,
                                       edgecolors=style.SOLID_EDGE, linewidths=0.6, zorder=0.5))


def _window(apparatus: Apparatus, frame: Frame, layer: int) -> Window:
    largest = float(frame.particles["diameter"].max(initial=0.))
    window = plate_window(apparatus, layer, largest)
    # Room for the powder before the spreader.
    return Window(window.x0, window.x1, window.y0, window.y1 + 0.12 * (window.x1 - window.x0))


def _figure(frames: Sequence[Frame], apparatus: Apparatus, layer: int, start: float) -> Figure:
    window = _window(apparatus, frames[0], layer)
    figure, panels = make_panels(window, len(frames))
    for axes, frame in zip(panels, frames):
        _draw(axes, frame, apparatus, layer, window)
        axes.text(0.008, 0.97, f"Pass {layer}, {1e3 * (frame.time - start):.0f} ms", transform=axes.transAxes,
                  va="top", bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.7, "pad": 1.})
    bar = add_colour_bar(figure, panels, ScalarMappable(_norm(), colormaps["plasma_r"]), "Displacement (µm)")
    style.plain_log_axis(bar.yaxis)
    return figure


def strip_figure(found: Pass, apparatus: Apparatus, n: int = 4) -> Figure:
    """The pass in a few pictures, with the same time between them; the last one is at its end."""
    start = found.snapshots[0].time
    n = min(n, len(found.snapshots))
    chosen = np.linspace(0, len(found.snapshots) - 1, n + 1).round().astype(int)[1:]
    some = Pass(found.layer, [found.snapshots[k] for k in chosen], found.solids)
    return _figure(list(some.frames()), apparatus, found.layer, start)


def movie_of(found: Pass, apparatus: Apparatus) -> bytes:
    """A .gif of all pictures of the pass."""
    from PIL import Image
    images = []
    for frame in found.frames():
        buffer = io.BytesIO()
        _figure([frame], apparatus, found.layer, found.snapshots[0].time).savefig(buffer, dpi=RESOLUTION)
        images.append(Image.open(buffer).convert("RGB").quantize(64))
    target = io.BytesIO()
    images[0].save(target, "gif", save_all=True, append_images=images[1:], duration=FRAME_TIME, loop=0, optimize=True)
    return target.getvalue()
