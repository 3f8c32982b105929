"""Compares the discharge of the benchmark `slot` in all programs: the mass that has run out over time.

Usage: contrib/tools slot [--program build/release/eunoe-particles] [--ranks 1] [--steps 8000]
           [--table FILE]
       contrib/tools slot --bed FILE

The rate is that of the second half of the run, when the flow has developed. Exit code 1 if a program's
differs by more than 5 % from Eunoe's: then they do not do the same work. With --bed the benchmark's bed is
made anew (prm/benchmarks/slot_bed.prm) and written to FILE, for contrib/benchmarks/slot_bed.csv.gz.
"""

from __future__ import annotations

import argparse
import gzip
import re
import tempfile
from pathlib import Path

import numpy as np

from eunoe.launch import Failure, parser
from eunoe.repository import CASES as INPUTS
from eunoe.tables import as_markdown, as_text
from eunoe.vtk_files import read_pvd, read_vtu

from .programs import CASES, Eunoe, Lammps, Liggghts, Peer, add_program
from .slot import LIP, MICROMETRE, PERIOD

CASE = CASES["slot"]
SAMPLES = 20
LIMIT = 0.05  # accepted difference of two rates


def mass_out(places: np.ndarray, diameters: np.ndarray) -> float:
    """Mass of the grains that have left the bin (kg)."""
    return float(CASE.density * np.pi / 6. * (diameters[places[:, 1] < LIP] ** 3).sum())


def of_eunoe(eunoe: Eunoe, options: argparse.Namespace, folder: Path) -> list[float]:
    eunoe.run(CASE, options.ranks, options.steps, folder,
              (f"simulation control/output frequency = {options.every}",))
    masses = []
    for picture in read_pvd(folder / "results" / "out.pvd"):
        data = read_vtu(picture.file, ["diameter"])
        masses.append(mass_out(data["points"].astype(float), data["diameter"].astype(float)))
    return masses


def of_peer(peer: Peer, options: argparse.Namespace, folder: Path) -> list[float]:
    log = peer.start(CASE, CASE.particles(), options.ranks, {"steps": options.steps, "every": options.every},
                     folder)
    # Step, atoms, kinetic energy, mass.
    return [float(line[1]) for line in re.finditer(r"^ *\d+ +\d+ +\S+ +(\S+) *$", log, re.M)]


def rate(times: np.ndarray, masses: np.ndarray) -> float:
    """Mean rate of the second half (kg/s)."""
    half = len(times) // 2
    return float((masses[-1] - masses[half]) / (times[-1] - times[half]))


def compute(options: argparse.Namespace) -> dict[str, np.ndarray]:
    """Mass that has run out (kg) at the samples, by program."""
    found = {}
    for program in (Eunoe(options.program), Lammps(), Liggghts()):
        if program.path is None:
            print(f"{program.name} is not installed (no program '{program.executable}')", flush=True)
            continue
        measure = of_eunoe if isinstance(program, Eunoe) else of_peer
        with tempfile.TemporaryDirectory(prefix="eunoe_slot_") as folder:
            masses = measure(program, options, Path(folder))
        if len(masses) != SAMPLES + 1:
            raise Failure(f"{program.name} gave {len(masses)} samples instead of {SAMPLES + 1}.")
        found[program.name] = np.array(masses)
    if len(found) == 1:
        raise Failure("No other program is installed: run contrib/install_dependencies.sh benchmarks.")
    return found


def make_bed(program: str, path: Path) -> None:
    with tempfile.TemporaryDirectory(prefix="eunoe_slot_") as folder:
        Eunoe(program).compute(INPUTS / "benchmarks" / "slot_bed.prm", (), 1, Path(folder))
        table = np.genfromtxt(Path(folder) / "results" / "particles.csv", delimiter=";", skip_header=1)
    table[:, 2] %= PERIOD
    with gzip.GzipFile(path, "w", mtime=0) as file:
        np.savetxt(file, table[:, [9, 0, 1, 2]] / MICROMETRE, fmt="%.0f", delimiter=",",
                   header="diameter,x,y,z", comments="")


def parse(words: list[str]) -> argparse.Namespace:
    arguments = parser(__doc__)
    add_program(arguments)
    arguments.add_argument("--ranks", type=int, default=1)
    arguments.add_argument("--steps", type=int, default=CASE.steps)
    arguments.add_argument("--table", type=Path)
    arguments.add_argument("--bed", type=Path)
    options = arguments.parse_args(words)
    options.every = max(1, options.steps // SAMPLES)
    options.steps = options.every * SAMPLES
    return options


def main(words: list[str]) -> int:
    options = parse(words)
    if options.bed:
        make_bed(options.program, options.bed)
        return 0
    found = compute(options)
    times = CASE.time_step * options.every * np.arange(SAMPLES + 1)
    table = [["time (s)", *(f"{name} (kg)" for name in found)]]
    table += [[f"{times[k]:.3g}", *(f"{masses[k]:.4g}" for masses in found.values())]
              for k in range(0, SAMPLES + 1, 2)]
    rates = {name: rate(times, masses) for name, masses in found.items()}
    if rates["Eunoe"] <= 0.:
        raise Failure(f"Nothing has run out in {options.steps} steps. Give more with --steps.")
    table.append(["rate (kg/s)", *(f"{value:.4g}" for value in rates.values())])
    print(as_text(table))
    if options.table:
        options.table.write_text(as_markdown(table) + "\n", encoding="utf-8")
    worst = max(abs(value / rates["Eunoe"] - 1.) for value in rates.values())
    print(f"\nThe rates differ from Eunoe's by at most {100. * worst:.1f} %.")
    return 0 if worst <= LIMIT else 1
