"""The short report of a run of any other process: timings and the last picture."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib import colormaps
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PolyCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from .canvas import MM, Window, add_colour_bar, draw_circles, front_slice, make_panels
from .page import Page
from eunoe.prm_file import MissingEntry
from .quantities import count, number
from .run_folder import Run
from .run_section import add_run_section
from eunoe.vtk_files import VtkError, read_vtu

Fields = dict[str, np.ndarray]


def _vertical_axis(run: Run) -> tuple[int, float]:
    """The axis along gravity and its direction upwards; z if used.prm does not tell."""
    try:
        if run.parameters is None:
            raise MissingEntry("used.prm is missing.")
        powder = run.parameters.section("lagrangian physical properties")
        gravity = np.array([float(g) for g in powder.text("g").split(",")])
    except (MissingEntry, ValueError):
        gravity = np.zeros(3)
    if not gravity.any():
        return 2, 1.
    axis = int(np.argmax(np.abs(gravity)))
    return axis, -float(np.sign(gravity[axis]))


def _towards_viewer(points: np.ndarray, horizontal: int, vertical: int, upwards: float) -> np.ndarray:
    """How near points are to the viewer, who sees the horizontal axis lead to the right and the vertical one upwards,
    downwards if gravity points along it. In a frame of x, y and z, only turned, the third axis points to the viewer."""
    is_turned = (vertical - horizontal) % 3 == 1
    return points[:, 3 - vertical - horizontal] * (upwards if is_turned else -upwards)


def speed_figure(particles: Fields, triangles: np.ndarray, vertical: int,
                 upwards: float) -> tuple[Figure, float]:
    """Particles coloured by speed in the view that shows most of them; and the share drawn.

    :param triangles: corners of the solids' triangles, three rows each (m)
    """
    everything = np.concatenate((particles["points"], triangles))
    extent = np.ptp(everything, axis=0)
    horizontal = max((axis for axis in range(3) if axis != vertical), key=lambda a: extent[a])
    x, y = (particles["points"][:, axis].astype(float) for axis in (horizontal, vertical))
    low, high = everything.min(axis=0), everything.max(axis=0)
    margin = 0.03 * max(extent[horizontal], extent[vertical]) + particles["diameter"].max()
    window = Window(low[horizontal] - margin, high[horizontal] + margin,
                    low[vertical] - margin, high[vertical] + margin)
    figure, panels = make_panels(window, 1, "xyz"[horizontal] + "xyz"[vertical])
    if upwards < 0.:
        panels[0].invert_yaxis()
    panels[0].add_collection(PolyCollection(
        MM * triangles[:, [horizontal, vertical]].reshape(-1, 3, 2), facecolors="#e4e4e4",
        edgecolors="#bbbbbb", linewidths=0.2, rasterized=True))
    nearness = _towards_viewer(particles["points"], horizontal, vertical, upwards)
    rows, share = front_slice(window.shows(x, y, particles["diameter"]), nearness)
    rows = rows[np.argsort(nearness[rows])]
    speed = np.linalg.norm(particles["velocity"], axis=1)
    norm = Normalize(0., max(float(np.quantile(speed, 0.99)), 1e-12))
    colours = colormaps["viridis"]
    draw_circles(panels[0], x[rows], y[rows], particles["diameter"][rows],
                 colours(norm(speed[rows])))
    add_colour_bar(figure, panels, ScalarMappable(norm, colours), "Speed (m/s)", extend="max")
    return figure, share


def _solids(file: Path | None) -> np.ndarray:
    """Corners of the solids' triangles; none if the run wrote no pictures of them."""
    points = read_vtu(file, ())["points"] if file else np.empty((0, 3))
    return points if len(points) % 3 == 0 else points[:0]


def _add_picture(page: Page, run: Run) -> None:
    picture, solids = run.last_picture(), run.last_picture("_solids")
    if picture is None:
        page.notice("There are no pictures of the particles.")
        return
    time, file = picture
    if run.summary and time > float(run.summary.get("simulated_time", time)) * (1. + 1e-9):
        page.notice(f"{file.name} is of an earlier run in this folder: this one has no pictures of the particles.")
        return
    particles = read_vtu(file, ("diameter", "velocity"))
    if len(particles["points"]) == 0 or len(particles) < 3:
        page.notice(f"{file.name} has no particles or lacks a field.")
        return
    figure, share = speed_figure(particles, _solids(solids[1] if solids else None),
                                 *_vertical_axis(run))
    page.heading("The last picture")
    drawn = "" if share == 1. else f" The front {100. * share:.0f}\u00a0% of them are drawn."
    page.figure(figure, f"The {count(len(particles['points']))} particles at "
                f"{number(time, 4)}\u00a0s, to scale, coloured by speed.{drawn}")


def general_report(run: Run) -> Page:
    page = Page(f"Run {run.name}", "No powder spreading: timings and the last picture")
    if run.summary is None:
        page.notice("The run has not finished: there is no summary.json.")
    try:
        _add_picture(page, run)
    except VtkError as error:
        page.notice(str(error))
    add_run_section(page, run, {})
    return page
