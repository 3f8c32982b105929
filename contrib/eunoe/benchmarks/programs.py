"""The programs that are compared: how each is started, and how its speed is read."""

from __future__ import annotations

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from eunoe.launch import Failure, mpirun, output_of, overrides
from eunoe.repository import BENCHMARKS, PROGRAM
from eunoe.repository import CASES as INPUTS

from . import bed, blade
from .cases import BEDS, Case
from .slot import Slot
from .soft_column import SoftColumn

CASES = {case.name: case for case in (
    *BEDS, SoftColumn("soft_column", "collapse of soft grains, 37,800", "soft_column.prm", 8000),
    Slot("slot", "discharge through a slot, 50,000", "slot.prm", 8000, copies=5))}
MEASURE_RSS = Path(__file__).with_name("measure_rss.py")


@dataclass
class Run:
    """What a run gave: the speed of its time loop (particle-steps/s), and, from Eunoe alone, its
    summary and its peak memory over all ranks (bytes)."""

    speed: float
    summary: dict = field(default_factory=dict)
    memory: float = 0.


def add_program(arguments: argparse.ArgumentParser) -> None:
    arguments.add_argument("--program", default=str(PROGRAM))


def said(*command: str) -> str:
    """What a command printed. LIGGGHTS ends its help with an error and leaves a log file behind."""
    with tempfile.TemporaryDirectory() as folder:
        return subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True, check=False).stdout


class Eunoe:
    """Our program."""

    name = "Eunoe"

    def __init__(self, path: str) -> None:
        self.path = str(Path(path).resolve())
        if not os.access(self.path, os.X_OK):
            raise Failure(f"{path} is not a program. Build it with contrib/build.sh, or name it with "
                          "--program.")

    def version(self) -> str:
        return said(self.path, "--version").splitlines()[0]

    def run(self, case: Case, ranks: int, steps: int, folder: Path,
            settings: tuple[str, ...] = (), particles=None) -> Run:
        if case.peers:
            if particles is None:
                particles = case.particles()
            bed.write_for_eunoe(folder / "bed.csv", particles)
            settings += (f"insertion info/list of input files = {folder / 'bed.csv'}",
                         f"mesh/grid arguments = {case.mesh()}", "mesh/initial refinement = 0",
                         f"simulation control/iteration end = {steps}")
        for old in folder.glob("rss.*"):
            old.unlink()
        summary = self.compute(INPUTS / "benchmarks" / case.input, settings, ranks, folder,
                               [sys.executable, str(MEASURE_RSS), str(folder / "rss")])
        memory = sum(float(file.read_text()) for file in folder.glob("rss.*"))
        return Run(summary["particle_steps_per_second"], summary, memory)

    def compute(self, case: Path, settings: Iterable[str], ranks: int, folder: Path,
                watcher: Sequence[str] = ()) -> dict:
        """Runs a case, whose results go to 'results' in the folder, and returns its summary.

        @param watcher: a command in front of the program
        """
        results = folder / "results"
        output_of([*mpirun(ranks), *watcher, self.path, str(case), "--quiet",
                   *overrides([f"simulation control/output path = {results}", *settings])], folder)
        return json.loads((results / "summary.json").read_text(encoding="utf-8"))


def loop_seconds(log: str, name: str) -> float:
    """Seconds of the last time loop in a log of LAMMPS or LIGGGHTS."""
    loops = re.findall(r"^Loop time of (\S+) on", log, re.M)
    if not loops:
        raise Failure(f"{name} told no 'Loop time':\n{log[-2000:]}")
    return float(loops[-1])


class Peer:
    """What LAMMPS and LIGGGHTS share."""

    name, executable, deck, atoms = "", "", "", ""

    def __init__(self) -> None:
        self.path = shutil.which(self.executable)

    def run(self, case: Case, ranks: int, steps: int, folder: Path) -> Run:
        particles = case.particles()
        logs = [self.start(case, particles, ranks, {"steps": steps, "every": 1000, "skin": skin}, folder)
                for skin in case.skins]
        return Run(len(particles) * steps / min(loop_seconds(log, self.name) for log in logs))

    def start(self, case: Case, particles, ranks: int, variables: dict, folder: Path) -> str:
        """Runs the deck and returns its log."""
        bed.write_for_peer(folder / "bed.data", particles, case.box, case.density, self.atoms)
        values = {"data": folder / "bed.data", "timestep": case.time_step, "skin": case.skins[0],
                  "plough": int(case.plough), "speed": blade.SPEED,
                  **self.variables(case, folder), **case.variables(folder), **variables}
        options = [word for name, value in values.items() for word in ("-var", name, str(value))]
        deck = BENCHMARKS / "decks" / f"{case.deck}{self.deck}"
        return output_of([*mpirun(ranks), self.path or self.executable, "-in", str(deck), *options], folder)


class Lammps(Peer):
    name, executable, deck, atoms = "LAMMPS", "lmp", "lammps.in", "Atoms # sphere"

    def version(self) -> str:
        match = re.search(r"Simulator - (.*)$", said(self.path, "-h"), re.M)
        return match.group(1).strip() if match else "unknown"

    def variables(self, case: Case, folder: Path) -> dict:
        del folder
        return {"right": "NULL" if case.collapse else case.length, "radius": blade.RADIUS,
                "tip_x": blade.TIP_X, "tip_y": blade.TIP_Y, "check": 0}


class Liggghts(Peer):
    name, executable, deck, atoms = "LIGGGHTS", "liggghts", "liggghts.in", "Atoms"

    def version(self) -> str:
        match = re.search(r"Version LIGGGHTS-(\S+ [\d.]+)", said(self.path, "-h"))
        return match.group(1) if match else "unknown"

    def variables(self, case: Case, folder: Path) -> dict:
        # A box that follows the particles (s) divides them evenly; one with a minimum size (m)
        # includes the spreader.
        edge = "m m" if case.plough else "s f" if case.collapse else "f f"
        blade.write_stl(folder / "blade.stl", case.depth)
        return {"right": case.length, "edge": edge, "blade": folder / "blade.stl"}
