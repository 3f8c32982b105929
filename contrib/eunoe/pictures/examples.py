"""Runs the cases of prm/examples and draws the pictures of doc/examples.md from their output.

Usage: contrib/tools example-pictures path/to/eunoe-particles folder [--cases NAME ...]
       [--pictures doc/pictures] [--run-only | --draw-only]

Each case runs in a folder of its own. Needs numpy, matplotlib and Pillow.
"""

from __future__ import annotations

import io
from pathlib import Path

import matplotlib
matplotlib.use("Agg")
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PolyCollection
from matplotlib.colors import Normalize, to_rgba_array
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator
from PIL import Image

from eunoe.launch import output_of, overrides, parser
from eunoe.report import style
from eunoe.report.canvas import MM, Window, draw_circles
from eunoe.repository import CASES, DOC, ROOT
from eunoe.tables import read_columns
from eunoe.vtk_files import read_pvd, read_vtu

# For each case: the view (axes to the right and upwards), the window (mm), the panels' times (s).
VIEWS = {
    "sandpile": ("xz", (-22., 22., 0., 32.), (0.2, 0.4, 1.2)),
    "packing_in_box": ("xz", (-0.3, 12.3, 0., 24.), (0.1, 0.2, 0.5)),
    "rotating_drum": ("xz", (-15.5, 15.5, -15.5, 15.5), (0.1, 0.4, 1.1)),
    "granular_mixer": ("xz", (-11., 11., 0., 16.), (0.2, 0.5, 1.2)),
    "dam_break": ("xz", (0., 70., 0., 35.), (0.2, 0.3, 0.8)),
}
# Solids that are drawn; the others would hide the particles.
DRAWN = {"granular_mixer": 1, "rotating_drum": 0, "sandpile": 0}


def outline(axes: Axes, file: Path, view: tuple[int, int], number: int) -> None:
    """Draws the edges of one solid's triangles, without faces."""
    data = read_vtu(file, ("solid",))
    points = data["points"][:, list(view)]
    solid = np.asarray(data["solid"], dtype=int)
    corners = points[solid == np.unique(solid)[number]].reshape(-1, 3, 2)
    axes.add_collection(PolyCollection(MM * corners, facecolors="none", edgecolors="#00000030",
                                       linewidths=0.4, zorder=3))


# In all other cases the speed gives the colour.
COLOURED_BY = {"granular_mixer": "type", "packing_in_box": "diameter"}
TYPES = ((style.PALE_BLUE, "2500 kg/m³"), (style.VERMILLION, "4000 kg/m³"))
LEGEND = 0.3  # height of the legend below the panels (inch)
SPEEDS = ScalarMappable(Normalize(0., 0.3), "viridis")  # m/s
DIAMETERS = ScalarMappable(Normalize(0.7, 1.5), "plasma")  # mm


def colours(name: str, particles: dict[str, np.ndarray]) -> np.ndarray:
    if COLOURED_BY.get(name) == "type":
        return to_rgba_array([colour for colour, _ in TYPES])[particles["type"].astype(int)]
    if COLOURED_BY.get(name) == "diameter":
        return DIAMETERS.to_rgba(MM * particles["diameter"])
    return SPEEDS.to_rgba(np.linalg.norm(particles["velocity"], axis=1))


def explain_colours(name: str, figure: Figure, panels: list[Axes]) -> None:
    if COLOURED_BY.get(name) == "type":
        share = LEGEND / figure.get_figheight()
        figure.get_layout_engine().set(rect=(0., share, 1., 1. - share))
        figure.legend(handles=[Patch(facecolor=colour, label=label) for colour, label in TYPES],
                      loc="lower center", ncol=2)
        return
    shown, label = ((DIAMETERS, "Diameter (mm)") if name in COLOURED_BY else (SPEEDS, "Speed (m/s)"))
    bar = figure.colorbar(shown, ax=panels, label=label, fraction=0.03, pad=0.01, aspect=12,
                          extend="neither" if name in COLOURED_BY else "max")
    bar.locator = MaxNLocator(4, steps=[1, 2, 5, 10])
    bar.outline.set_linewidth(0.6)


def draw_case(name: str, folder: Path) -> Figure:
    names, (x0, x1, y0, y1), times = VIEWS[name]
    view = ("xyz".index(names[0]), "xyz".index(names[1]))
    depth = 3 - sum(view)
    window = Window(x0 / MM, x1 / MM, y0 / MM, y1 / MM)
    pictures, solids = read_pvd(folder / "out.pvd"), read_pvd(folder / "out_solids.pvd")
    width = (style.WIDTH - 1.1) / len(times)
    height = max(width * (y1 - y0) / (x1 - x0) + 0.8, 1.7)
    height += LEGEND if COLOURED_BY.get(name) == "type" else 0.
    figure = Figure(figsize=(style.WIDTH, height), layout="constrained")
    panels = figure.subplots(1, len(times), sharey=True)
    for axes, time in zip(panels, times):
        picture = min(pictures, key=lambda p: abs(p.time - time))
        particles = read_vtu(picture.file, ("diameter", "velocity", "type"))
        points = particles["points"].astype(float)
        axes.set(xlim=(x0, x1), ylim=(y0, y1), aspect="equal", title=f"{picture.time:.2g} s")
        axes.locator_params(nbins=5)
        axes.set_xlabel(f"{names[0]} (mm)")
        rows = np.flatnonzero(window.shows(points[:, view[0]], points[:, view[1]], particles["diameter"]))
        # Particles nearest to the viewer, with the least coordinate in depth, are drawn last.
        rows = rows[np.argsort(-points[rows, depth])]
        draw_circles(axes, points[rows, view[0]], points[rows, view[1]], particles["diameter"][rows],
                     colours(name, particles)[rows])
        if name in DRAWN and solids:
            outline(axes, min(solids, key=lambda p: abs(p.time - time)).file, view, DRAWN[name])
    panels[0].set_ylabel(f"{names[1]} (mm)")
    explain_colours(name, figure, list(panels))
    return figure


def draw_bounces(folder: Path) -> Figure:
    """Height of the bouncing sphere over the time, and the peaks that its restitution prescribes."""
    energies = read_columns(folder / "energies.csv")
    time, potential = energies["time"], energies["potential"]
    restitution, start = 0.9, 0.2
    height = (potential / potential[0]) * (start + 0.5e-3) - 0.5e-3
    fall = np.sqrt(2. * start / 9.81)
    n = np.arange(12)
    peaks = fall * (2. * np.cumsum(restitution**n) - 1.) + fall * restitution**(n + 1.)
    figure = Figure(figsize=(4.5, 2.4), layout="constrained")
    axes = figure.subplots()
    axes.plot(time, MM * height, color=style.BLUE, label="Eunoe")
    axes.plot(peaks, MM * start * restitution**(2. * (n + 1.)), "o", color=style.VERMILLION,
              markerfacecolor="none", label="0.81 of the height before")
    axes.set(xlabel="Time (s)", ylabel="Height (mm)", xlim=(0., 2.), ylim=(0., None))
    axes.legend()
    return figure


def save(figure: Figure, file: Path) -> None:
    """Saves a small file: 128 colours are enough for these pictures."""
    buffer = io.BytesIO()
    figure.savefig(buffer, dpi=style.RESOLUTION)
    Image.open(buffer).convert("RGB").quantize(128).save(file, optimize=True)


def main(words: list[str]) -> int:
    cases = ["bouncing_sphere", *VIEWS]
    arguments = parser(__doc__)
    arguments.add_argument("program")
    arguments.add_argument("folder", type=Path)
    arguments.add_argument("--cases", nargs="+", default=cases, choices=cases)
    arguments.add_argument("--pictures", type=Path, default=DOC / "pictures")
    parts = arguments.add_mutually_exclusive_group()
    parts.add_argument("--run-only", action="store_true", help="draws nothing")
    parts.add_argument("--draw-only", action="store_true", help="runs nothing")
    options = arguments.parse_args(words)
    program, folder = str(Path(options.program).resolve()), options.folder.resolve()
    options.pictures.mkdir(parents=True, exist_ok=True)
    for name in options.cases:
        if not options.draw_only:
            output_of([program, str(CASES / "examples" / f"{name}.prm"),
                       *overrides({"simulation control/output path": folder / name})], ROOT)
        if not options.run_only:
            figure = (draw_bounces(folder / name) if name == "bouncing_sphere" else
                      draw_case(name, folder / name))
            save(figure, options.pictures / f"example_{name}.png")
    return 0
