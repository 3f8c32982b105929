"""The examples of Lethe that are run to their ends, and what is measured in each.

Numbers that Lethe's pages or the experiments behind them give stand beside ours. SI units, angles in
degrees.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from eunoe.launch import Failure
from eunoe.vtk_files import read_pvd, read_vtu


@dataclass(frozen=True)
class Result:
    """A measured number beside a published one, as texts."""

    what: str
    published: str
    ours: str


@dataclass(frozen=True)
class Example:
    """@param parts input files, one after the other, relative to `folder`
    @param measure gets the example's folder
    @param template what replaces the words in double braces of a template
    @param settings entries of parts that are set to other values: shorter runs, fewer pictures, or what
    Lethe's page describes where its file has another value"""

    folder: str
    parts: tuple[str, ...]
    measure: Callable[[Path], list[Result]]
    time_of_lethe: str = ""
    template: dict[str, str] = field(default_factory=dict)
    settings: dict[str, dict[str, object]] = field(default_factory=dict)


def points_at(folder: Path, name: str, *fields: str) -> list[tuple[float, dict[str, np.ndarray]]]:
    """Time and data of all pictures of a series."""
    return [(snapshot.time, read_vtu(snapshot.file, ("points", *fields)))
            for snapshot in read_pvd(folder / f"{name}.pvd")]


def slope_of_highest(points: np.ndarray, begin: float, end: float, diameter: float) -> float:
    """Angle of the line through the highest particle of each strip of a diameter along |x|."""
    x = np.abs(points[:, 0])
    strips = np.floor((x - begin) / diameter).astype(int)
    highest = []
    for strip in range(round((end - begin) / diameter)):
        inside = np.flatnonzero(strips == strip)
        if inside.size:
            top = inside[np.argmax(points[inside, 1])]
            highest.append((x[top], points[top, 1]))
    if len(highest) < 3:
        raise Failure("there is no heap to measure")
    along, up = np.array(highest).T
    return -math.degrees(math.atan(np.polyfit(along, up, 1)[0]))


def hopper(folder: Path) -> list[Result]:
    """Mass that has passed the opening, a straight line from a quarter to three quarters of a second
    after it opened, at 4 s."""
    diameter, density = 0.00224, 2500.
    grain = density * math.pi / 6. * diameter**3
    series = [(time, grain * np.count_nonzero(data["points"][:, 1] < -0.5 * diameter))
              for time, data in points_at(folder / "output_periodic", "hopper") if 4.25 <= time <= 4.75]
    times, masses = np.array(series).T
    rate = 1e3 * np.polyfit(times, masses, 1)[0]
    return [Result("mass flow rate", "91.73 g/s (Lethe)", f"{rate:.2f} g/s")]


def plate(folder: Path) -> list[Result]:
    """The heap on the plate, at a height of 0.4 m, and the slopes below; Lethe's angles, of its run without
    load balancing and sleep, were read off its picture."""
    series = points_at(folder / "output_base", "out")
    found = []
    for moment, top, bottom in ((10., 20.6, 24.4), (11., 20.3, 24.0), (12., 19.8, 23.6)):
        points = min(series, key=lambda entry: abs(entry[0] - moment))[1]["points"]
        above = points[:, 1] > 0.4
        for what, heap, sign, published in (("heap on the plate", points[above], 1., top),
                                            ("slopes below", points[~above], -1., bottom)):
            angle = sign * slope_of_highest(heap, 0.15, 0.35, 0.01)
            found.append(Result(f"{what} at {moment:g} s", f"{published} (Lethe)", f"{angle:.1f}"))
    return found


def bounce(folder: Path) -> list[Result]:
    """Largest heights of the centre between bounces; the sphere of 0.1 m falls from 0.5 m."""
    restitution = 0.9
    series = [(time, data["points"][0, 2], data["velocity"][0, 2])
              for time, data in points_at(folder / "out_09", "out", "velocity")]
    tops = [0.5 * v1 * v1 / 9.81 + z1 for (_, _, v0), (_, z1, v1) in zip(series, series[1:]) if v0 > 0. >= v1]
    found = []
    for number in (1, 2, 5):
        exact = 0.1 + 0.4 * restitution ** (2 * number)
        found.append(Result(f"height after bounce {number}", f"{exact:.4f} m (without gravity in the contact)", f"{tops[number - 1]:.4f} m"))
    return found


def oblique(folder: Path) -> list[Result]:
    """Impact at 30.1 degrees, beside Kharaz, Gorham and Salman."""
    _, data = points_at(folder / "30", "out", "velocity", "omega")[-1]
    along, spin = data["velocity"][0, 1], abs(data["omega"][0, 0])
    ratio = along / (3.9 * math.sin(math.radians(30.127)))
    return [Result("tangential restitution", "0.688 (measured)", f"{ratio:.3f}"),
            Result("spin", "613 rad/s (measured, 31.2 degrees)", f"{spin:.0f} rad/s")]


def dam(folder: Path) -> list[Result]:
    """Height of the deposit's surface at two places along the channel."""
    points = points_at(folder / "output", "out")[-1][1]["points"]
    return [Result(f"height at x = {x} m", text, f"{height_at(points, x):.3f} m")
            for x, text in ((0.4, "0.2 m (measured)"), (0.8, "0.025 m (measured)"))]


def height_at(points: np.ndarray, x: float) -> float:
    """Top of the particles of 10 mm in a slice of two diameters; median over strips across it."""
    part = points[np.abs(points[:, 0] - x) < 0.01]
    across = np.floor(part[:, 2] / 0.01).astype(int)
    tops = [part[across == strip, 1].max() + 0.005 for strip in np.unique(across)]
    return float(np.median(tops)) if tops else 0.


def surface_slope(points: np.ndarray) -> float:
    """Slope of a bed in the drum of 56 mm, whose axis is x, from the highest grain of each strip along z."""
    middle = points[np.abs(points[:, 0]) < 0.04]
    strips = np.floor(middle[:, 2] / 0.003).astype(int)
    tops = [(middle[strips == k, 2].mean(), middle[strips == k, 1].max()) for k in range(-8, 8)
            if np.any(strips == k)]
    along, up = np.array(tops).T
    return math.degrees(math.atan(np.polyfit(along, up, 1)[0]))


def drum(folder: Path) -> list[Result]:
    """Slope of the bed in the turning drum of 56 mm, over the last second; the axis is x."""
    angles = []
    for time, data in points_at(folder / "output_dem", "out"):
        if time < 4.:
            continue
        angles.append(abs(surface_slope(data["points"])))
    return [Result("slope of the bed", "", f"{np.mean(angles):.1f}")]


def mixing_index(points: np.ndarray, marked: np.ndarray, neighbours: int = 15) -> float:
    """Twice the share of a particle's nearest neighbours that are of the other kind, mean over particles: 0
    for separate kinds, 1 for mixed ones (Godlieb, Deen and Kuipers 2007)."""
    of_other_kind, block = 0, 500
    squares = (points**2).sum(axis=1)
    for begin in range(0, len(points), block):
        rows = slice(begin, begin + block)
        distances = squares - 2. * points[rows] @ points.T
        nearest = np.argpartition(distances, neighbours, axis=1)[:, :neighbours + 1]
        of_other_kind += np.count_nonzero(marked[nearest] != marked[rows, None])
    return 2. * of_other_kind / (neighbours * len(points))


def stirred_drum(folder: Path) -> list[Result]:
    """Mixing of grains that lay farther from the axis, x, than the mean with the others, in the drum of 56 mm at
    2 rad/s; Lethe's curve was read off its picture."""
    series = points_at(folder / "output_dem", "out", "ID")

    def state_at(moment: float) -> dict[str, np.ndarray]:
        return min(series, key=lambda entry: abs(entry[0] - moment))[1]

    start = state_at(2.)
    radius = np.hypot(start["points"][:, 1], start["points"][:, 2])
    outer = dict(zip(start["ID"].astype(int), radius > radius.mean()))
    found = []
    for moment, published in ((4., 0.28), (6., 0.45), (8., 0.51)):
        data = state_at(moment)
        marked = np.array([outer[number] for number in data["ID"].astype(int)])
        found.append(Result(f"mixing index at {moment:g} s", f"{published} (Lethe)",
                            f"{mixing_index(data['points'], marked):.2f}"))
    return found + drum_profile(folder)


def drum_profile(folder: Path) -> list[Result]:
    """Velocity along the surface over the depth below it, in the middle of the drum of 56 mm at 2 rad/s, mean
    from 6 to 8 s. Below the flowing layer a bed that sticks to the wall would turn with the drum."""
    series = [data for time, data in points_at(folder / "output_dem", "out", "velocity") if 6. <= time <= 8.]
    points, velocities = (np.concatenate([data[name] for data in series]) for name in ("points", "velocity"))
    slope = math.radians(np.mean([surface_slope(data["points"]) for data in series]))
    along, up = np.array([0., math.sin(slope), math.cos(slope)]), np.array([0., math.cos(slope), -math.sin(slope)])
    middle = (np.abs(points[:, 0]) < 0.04) & (np.abs(points @ along) < 0.004)
    height, speed = (points @ up)[middle], (velocities @ along)[middle]
    below = (height > -0.05) & (height < -0.025)
    top = np.quantile(height, 0.99)
    surface = np.mean(speed[height > top - 0.003])
    heights = np.arange(-0.05, top, 0.003)
    profile = [np.sign(surface) * np.mean(speed[np.abs(height - h) < 0.0015]) for h in heights]
    still = float(np.interp(0., profile, heights))
    return [Result("speed of the surface in its middle", "", f"{abs(surface):.2f} m/s"),
            Result("depth of the flowing layer", "", f"{1e3 * (top - still):.0f} mm"),
            Result("turning of the bed below", "", f"{abs(np.polyfit(height[below], speed[below], 1)[0]):.2f} rad/s")]


def mixer(folder: Path) -> list[Result]:
    """Mixing of the two types under the impeller."""
    return [Result(f"mixing index at {time:g} s", "", f"{mixing_index(data['points'], data['type']):.2f}")
            for time, data in points_at(folder / "output", "mixer", "type")
            if any(abs(time - moment) < 1e-6 for moment in (0.5, 1., 1.5, 2.))]


def silo(folder: Path) -> list[Result]:
    """Mass that has passed the slot of 40 mm by 50 mm at z = 0 from half a second to 1.25 s after it opened, at 4 s,
    beside the formula of Beverloo for slots as in Nedderman (1992), with 58 % of solid in the silo."""
    diameter, density = 0.005833, 600.
    grain = density * math.pi / 6. * diameter**3
    series = [(time, grain * np.count_nonzero(data["points"][:, 2] < 0.))
              for time, data in points_at(folder / "output", "out") if 4.5 <= time <= 5.25]
    times, masses = np.array(series).T
    empty = 1.4 * diameter
    formula = 1.03 * 0.58 * density * math.sqrt(9.81) * (0.05 - empty) * (0.04 - empty) ** 1.5
    return [Result("mass flow rate", f"{formula:.2f} kg/s (formula)", f"{np.polyfit(times, masses, 1)[0]:.3f} kg/s")]


def packing(folder: Path) -> list[Result]:
    """Centre of mass of the balls at rest."""
    points = points_at(folder / "output", "out")[-1][1]["points"]
    return [Result("balls", "5000", str(len(points))),
            Result("height of their centre", "", f"{points[:, 2].mean():.4f} m")]


def inside(folder: Path) -> list[Result]:
    """How many are still in the box that turns."""
    return [Result("grains", "4000", str(len(points_at(folder / "output", "out")[-1][1]["points"])))]


def bunny(folder: Path) -> list[Result]:
    return [Result("grains at the end", "8000", str(len(points_at(folder / "output", "out")[-1][1]["points"])))]


# Young's modulus for which the spring of the linear law has 5e5 N/m in an impact with 1 m/s.
def young_of_spring(stiffness: float = 5e5) -> float:
    radius, mass, wall = 0.1, 2600. * 4. / 3. * math.pi * 1e-3, 0.91 / 1e12
    root = math.sqrt(radius)
    effective = (stiffness / (16. / 15. * root * (15. * mass / (16. * root)) ** 0.2)) ** 1.25
    return 0.91 / (1. / effective - wall)


ANGLE = math.radians(30.127)
EXAMPLES = {
    "bouncing particle": Example("3d-bouncing-particle", ("bouncing_particle_original.tpl",), bounce, "",
                                 {"ER": "09", "er": "0.9", "YP": f"{young_of_spring():.17g}"}),
    "oblique wall impact": Example("3d-oblique-wall-impact", ("oblique_wall_impact_template.tpl",), oblique, "",
                                   {"FN": "30", "vy": f"{3.9 * math.sin(ANGLE):.17g}",
                                    "vz": f"{-3.9 * math.cos(ANGLE):.17g}"}),
    "dam break": Example("3d-dam-break", ("granular-dam-break.prm",), dam, "10 min, 8 cores"),
    "hopper, periodic": Example("3d-rectangular-hopper", ("hopper_periodic.prm",), hopper, "10 min, 8 cores"),
    "plate discharge": Example("3d-plate-discharge/data", ("plate-discharge_base.prm",), plate,
                               "25 to 45 min, 8 cores",
                               settings={"plate-discharge_base.prm": {"simulation control/time end": 12}}),
    "box that turns": Example("3d-grid-rotation-in-box", ("grid-rotation-box.prm",), inside),
    "packing in a ball": Example("3d-packing-in-ball", ("packing-in-ball.prm",), packing),
    "bunny drill": Example("3d-bunny-drill", ("bunny-drill-loading.prm", "bunny-drill.prm"), bunny),
    "small drum": Example("3d-small-scale-rotating-drum", ("packing-rotating-drum.prm", "small-rotating-drum-dem.prm"),
                          drum, "60 min, 8 cores"),
    "small drum, mixing": Example(
        "3d-small-scale-rotating-drum", ("packing-rotating-drum.prm", "small-rotating-drum-dem.prm"), stirred_drum, "",
        settings={"small-rotating-drum-dem.prm": {
            "DEM boundary conditions/boundary condition 0/rotational speed": 2,
            "simulation control/time end": 8, "simulation control/output frequency": 10000}}),
    "silo": Example("3d-silo", ("silo-Golshan.prm",), silo, "14 h, 8 cores, to 30 s",
                    settings={"silo-Golshan.prm": {"simulation control/time end": 5.25,
                                                   "simulation control/output frequency": 2500}}),
    "mixer": Example("3d-granular-mixer", ("granular-mixer.prm",), mixer, "2 h, 8 cores",
                     settings={"granular-mixer.prm": {"simulation control/time end": 2,
                                                       "simulation control/output frequency": 10000}}),
}
