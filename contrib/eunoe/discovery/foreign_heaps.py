"""Makes heaps with LIGGGHTS or LAMMPS, and turns them into the measured data of a study.

Usage: contrib/tools foreign-heaps folder [--engine liggghts|lammps] [--repeats 5] [--first-seed 1]
       [--friction 0.3] [--rolling 0.2] [--cohesion 500] [--case prm/discovery/foreign/heap.prm]

The case is read by eunoe-particles: it gives apparatus, powder and contacts, and the options change the true
coefficients. Each repetition draws its own sizes and places. The folder gets the dumps of the heaps and
measured.csv. Heaps that are there are not made again; a folder with heaps of other coefficients is refused.
Cohesion is that of the other program: in LIGGGHTS an energy density (J/m3) of SJKR, in LAMMPS a surface energy
(J/m2) of DMT. In LAMMPS the spring of rolling resistance has a
constant stiffness, and a heap creeps; its decks are compared without rolling resistance.
"""

from __future__ import annotations

import argparse
import math
import re
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from eunoe.folders import occupy
from eunoe.launch import Failure, output_of, overrides, parser
from eunoe.prm_file import parse_prm
from eunoe.repository import CASES, PROGRAM, ROOT

from .measure import HEAD, measure, measured_rows
from .particle_files import read_particles

DECKS = ROOT / "contrib" / "discovery"
# Of the process: places of loose particles in parts of the largest diameter (loose_powder.h), the solid
# fraction and the angle behind the fill ratio (heap/apparatus.cc), and the rim in largest diameters.
PITCH, SHIFT, SOLID, ANGLE, RIM = 1.05, 0.05, 0.55, math.radians(37.5), 5.


@dataclass
class Model:
    """What the case says, in SI units."""

    entries: dict[str, str]

    def text(self, name: str) -> str:
        return self.entries[name]

    def number(self, name: str) -> float:
        return float(self.entries[name])

    def numbers(self, name: str) -> np.ndarray:
        return np.array([float(word) for word in self.entries[name].split(",")])


def model_of(case: Path, program: str, settings: list[str]) -> Model:
    """The entries of a case with all its includes and defaults, by "subsection/entry"."""
    printed = output_of([program, str(case), *overrides(settings), "--print-parameters"], Path.cwd())
    return Model(parse_prm(printed).flat())


TYPE = "lagrangian physical properties/particle type 0/"
WALL = "lagrangian physical properties/"
# What decks and drawn powder have built in: the entries that say so in the case, and the values that they must have.
BUILT_IN = {
    WALL + "g": "0, -9.81, 0",
    WALL + "number of particle types": "1",
    TYPE + "size distribution type": "custom",
    TYPE + "size weighting exponent": "0",
    TYPE + "minimum diameter cutoff": "-1",
    TYPE + "maximum diameter cutoff": "-1",
    TYPE + "custom distribution from file": "false",
    TYPE + "custom distribution probability function type": "PDF",
    TYPE + "custom distribution interpolation": "false",
    "heap/number of particles": "0",
    "heap/mass": "0",
    "heap/gap below the tube": "0",
    "heap/disc rim height": "0",
}


def _is(text: str, wanted: str) -> bool:
    """Whether an entry has a value, however its numbers are written."""
    try:
        return [float(word) for word in text.split(",")] == [float(word) for word in wanted.split(",")]
    except ValueError:
        return text == wanted


def check(model: Model) -> None:
    """Refuses a case whose powder or apparatus would be another one in the other program."""
    for name, value in BUILT_IN.items():
        if not _is(model.text(name), value):
            raise Failure(f"foreign-heaps makes heaps with '{name} = {value}' only, and the case has {model.text(name)}. "
                          "Give a case with it.")


@dataclass
class Classes:
    """Diameters of a custom distribution (m), and their shares by number."""

    diameters: np.ndarray
    shares: np.ndarray

    @classmethod
    def of(cls, model: Model) -> Classes:
        found = model.numbers(TYPE + "custom distribution diameters values")
        shares = model.numbers(TYPE + "custom distribution diameters probabilities")
        if model.text(TYPE + "distribution weighting basis") == "volume":
            shares = shares / found**3
        return cls(found, shares / shares.sum())

    def draw(self, n: int, random: np.random.Generator) -> np.ndarray:
        return random.choice(self.diameters, n, p=self.shares)

    @property
    def mean_volume(self) -> float:
        return math.pi / 6. * float((self.shares * self.diameters**3).sum())


@dataclass
class Apparatus:
    """The heap instrument of the process, from the case."""

    tube: float
    disc: float
    facets: int
    largest: float
    classes: Classes
    n: int
    layer: np.ndarray  # places in x and z of a layer of loose particles

    @classmethod
    def of(cls, model: Model) -> Apparatus:
        tube, disc = model.number("heap/tube inner diameter"), model.number("heap/disc diameter")
        facets = int(model.number("heap/facets"))
        classes = Classes.of(model)
        largest = float(classes.diameters.max())
        heap = math.pi / 3. * (disc / 2.)**3 * math.tan(ANGLE) * SOLID
        n = round(model.number("heap/fill ratio") * heap / classes.mean_volume)
        pitch = PITCH * largest
        reach = tube / 2. * math.cos(math.pi / facets) - largest / 2. - SHIFT * largest
        k = int(reach / pitch)
        layer = np.array([(i, j) for i in range(-k, k + 1) for j in range(-k, k + 1) if math.hypot(i, j) * pitch <= reach])
        return cls(tube, disc, facets, largest, classes, n, layer * pitch)

    @property
    def top(self) -> float:
        """Of the loose powder."""
        return PITCH * self.largest * math.ceil(self.n / len(self.layer))

    def places(self, random: np.random.Generator) -> np.ndarray:
        k = np.arange(self.n)
        x = np.empty((self.n, 3))
        x[:, [0, 2]] = self.layer[k % len(self.layer)]
        x[:, 1] = (k // len(self.layer) + 0.5) * PITCH * self.largest
        return x + SHIFT * self.largest * (random.uniform(size=x.shape) - 0.5)

    def ring(self, radius: float) -> np.ndarray:
        turn = 2. * math.pi * np.arange(self.facets + 1) / self.facets
        return radius * np.column_stack((np.cos(turn), np.sin(turn)))

    def side(self, radius: float, low: float, high: float) -> list[list[tuple[float, float, float]]]:
        """Triangles of a cylinder's wall."""
        corners = self.ring(radius)
        triangles = []
        for (x, z), (u, w) in zip(corners, corners[1:]):
            triangles += [[(x, low, z), (u, low, w), (u, high, w)], [(x, low, z), (u, high, w), (x, high, z)]]
        return triangles

    def surfaces(self) -> dict[str, list[list[tuple[float, float, float]]]]:
        corners = self.ring(self.disc / 2.)
        face = [[(0., 0., 0.), (u, 0., w), (x, 0., z)] for (x, z), (u, w) in zip(corners, corners[1:])]
        return {"tube": self.side(self.tube / 2., 0., self.top + 4. * self.largest),
                "disc": face + self.side(self.disc / 2., -RIM * self.largest, 0.)}


def write_stl(path: Path, triangles: list[list[tuple[float, float, float]]]) -> None:
    lines = ["solid surface"]
    for triangle in triangles:
        a, b, c = (np.array(corner) for corner in triangle)
        normal = np.cross(b - a, c - a)
        normal /= np.linalg.norm(normal)
        lines += ["facet normal " + " ".join(f"{v:.9e}" for v in normal), "outer loop",
                  *("vertex " + " ".join(f"{v:.9e}" for v in corner) for corner in triangle), "endloop", "endfacet"]
    path.write_text("\n".join([*lines, "endsolid surface"]) + "\n", encoding="utf-8")


def write_particles(path: Path, apparatus: Apparatus, model: Model, seed: int, style: str) -> None:
    random = np.random.default_rng(seed)
    d, x = apparatus.classes.draw(apparatus.n, random), apparatus.places(random)
    half, low = apparatus.disc / 2. + 8. * apparatus.largest, -(RIM + 4.) * apparatus.largest
    high = 4. * apparatus.top + 8. * apparatus.largest
    with open(path, "w", encoding="utf-8") as file:
        file.write(f"loose powder\n\n{apparatus.n} atoms\n1 atom types\n\n{-half} {half} xlo xhi\n"
                   f"{low} {high} ylo yhi\n{-half} {half} zlo zhi\n\n{style}\n\n")
        rows = np.column_stack((np.arange(1, apparatus.n + 1), d, x))
        np.savetxt(file, rows, fmt=f"%d 1 %.9e {model.text(TYPE + 'density particles')} %.12e %.12e %.12e")


def tsuji(restitution: float) -> float:
    """The coefficient that makes the polynomial of LAMMPS' damping 'tsuji' give this restitution exactly."""
    log = math.log(restitution)
    wanted = math.sqrt(5.) * -log / math.sqrt(math.pi**2 + log**2)
    e = np.linspace(0.01, 1., 10000)
    polynomial = (1.2728 - 4.2783 * e + 11.087 * e**2 - 22.348 * e**3 + 27.467 * e**4 - 18.022 * e**5 + 4.8218 * e**6)
    return float(e[np.abs(polynomial - wanted).argmin()])


def variables(model: Model, apparatus: Apparatus, options: argparse.Namespace) -> dict[str, object]:
    def of(name: str, given: float | None) -> float:
        particles, walls = model.number(TYPE + f"{name} particles"), model.number(WALL + f"{name} wall")
        if particles != walls:
            raise Failure(f"The case has {particles} and {walls} as {name} of particles and walls. Give one value.")
        return particles if given is None else given
    step = model.number("simulation control/time step")
    poisson = of("poisson ratio", None)
    values = {"young": of("young modulus", None), "poisson": poisson,
              "restitution": of("restitution coefficient", None),
              "friction": of("friction coefficient", options.friction),
              "rolling": of("rolling friction", options.rolling), "cohesion": options.cohesion,
              "timestep": step, "filling": round(options.filling / step), "rest": round(options.rest / step),
              "speed": model.number("heap/insertion speed"), "lifting": model.number("heap/lifting velocity"),
              "largest": apparatus.largest, "skin": 0.4 * apparatus.largest}
    if options.engine == "lammps":
        values.update(eta=tsuji(values["restitution"]), shear=math.sqrt(2. * (1. - poisson) / (2. - poisson)),
                      tube_radius=apparatus.tube / 2., disc_radius=apparatus.disc / 2.,
                      rim=RIM * apparatus.largest, tube_top=apparatus.top + 4. * apparatus.largest)
        if values["rolling"] != 0.:
            raise Failure("LAMMPS' rolling resistance has another spring: give --rolling 0 and a case without it.")
    return values


def make_heap(seed: int, model: Model, apparatus: Apparatus, options: argparse.Namespace) -> Path:
    """Runs the other program, unless the heap is there; returns its dump."""
    program = shutil.which("liggghts" if options.engine == "liggghts" else "lmp")
    if program is None:
        raise Failure(f"{options.engine} is not installed: apt install {options.engine}.")
    target = options.folder / f"heap_{seed}.dump"
    if target.exists():
        return target
    work = options.folder / f"work_{seed}"
    work.mkdir(parents=True, exist_ok=True)
    write_particles(work / "loose.data", apparatus, model, seed, "Atoms" if options.engine == "liggghts" else "Atoms # sphere")
    values = {**variables(model, apparatus, options), "data": "loose.data", "places": "heap.dump"}
    for name, triangles in apparatus.surfaces().items():
        write_stl(work / f"{name}.stl", triangles)
        if options.engine == "liggghts":
            values[name] = f"{name}.stl"
    # Files by their bare names: the programs take a blank in a path for the end of it.
    words = [word for name, value in values.items() for word in ("-var", name, str(value))]
    done = subprocess.run([program, "-in", str(DECKS / f"heap_{options.engine}.in"), *words], cwd=work, check=False,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace")
    if done.returncode != 0 or not (work / "heap.dump").exists() or re.search(r"^ERROR", done.stdout, re.M):
        raise Failure(f"{options.engine} failed for seed {seed}:\n{done.stdout[-1500:]}")
    (work / "heap.dump").replace(target)
    shutil.rmtree(work)
    return target


def parse(words: list[str]) -> argparse.Namespace:
    arguments = parser(__doc__)
    arguments.add_argument("folder", type=Path)
    arguments.add_argument("--engine", choices=("liggghts", "lammps"), default="liggghts")
    arguments.add_argument("--program", default=str(PROGRAM), help="eunoe-particles, which reads the case and measures")
    arguments.add_argument("--case", type=Path, default=CASES / "discovery" / "foreign" / "heap.prm")
    arguments.add_argument("--set", action="append", default=[], metavar="ENTRY=VALUE", help="entry of the case")
    arguments.add_argument("--experiment", default="heap")
    arguments.add_argument("--held-out", action="store_true", help="these rows are not for the fit")
    arguments.add_argument("--repeats", type=int, default=5)
    arguments.add_argument("--first-seed", type=int, default=1)
    arguments.add_argument("--friction", type=float, help="true coefficient; else the case's")
    arguments.add_argument("--rolling", type=float, help="true coefficient; else the case's")
    arguments.add_argument("--cohesion", type=float, default=0.)
    arguments.add_argument("--filling", type=float, default=0.02, help="time for the fall into the tube (s)")
    arguments.add_argument("--rest", type=float, help="time from the lifting's end to the measurement (s); "
                           "else the case's measurement delay, or 0.05 if it has none")
    options = arguments.parse_args(words)
    options.folder = options.folder.resolve()
    return options


def main(words: list[str]) -> int:
    options = parse(words)
    model = model_of(options.case, options.program, options.set)
    check(model)
    if options.rest is None:
        options.rest = model.number("heap/measurement delay") or 0.05
    apparatus = Apparatus.of(model)
    occupy(options.folder,
           {"engine": options.engine, "case": str(options.case.resolve()), "set": options.set,
            **{name: getattr(options, name) for name in ("friction", "rolling", "cohesion", "filling", "rest")}},
           "truth.json")
    repeats = []
    for seed in range(options.first_seed, options.first_seed + options.repeats):
        rows = read_particles(make_heap(seed, model, apparatus, options))
        repeats.append(measure([rows], options, f"heap_{seed}.dump"))
        angle = next(row["value"] for row in repeats[-1] if row["observable"] == "base_angle")
        print(f"seed {seed}: base angle {float(angle):.2f} degrees", flush=True)
    if len(repeats) > 1:
        table = [f"# place: heaps made by {options.engine}", HEAD, *measured_rows(repeats, options)]
        (options.folder / "measured.csv").write_text("\n".join(table) + "\n", encoding="utf-8")
    return 0
