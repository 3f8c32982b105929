"""Runs cases, reads their results, and defines the rows of the table of verification."""

from __future__ import annotations

import re
import subprocess
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Callable

import numpy as np

from eunoe.launch import Failure, overrides
from eunoe.repository import CASES, ROOT
from eunoe.tables import read_columns

Columns = dict[str, np.ndarray]


@dataclass(frozen=True)
class Particles:
    """The state at the end, ordered by identity: arrays of shape (n, 3) or (n), SI units."""
    position: np.ndarray
    velocity: np.ndarray
    spin: np.ndarray
    radius: np.ndarray


@dataclass(frozen=True)
class Results:
    """The folder of a run."""
    folder: Path

    @property
    def particles(self) -> Particles:
        data = np.genfromtxt(self.folder / "particles.csv", delimiter=";", skip_header=1, ndmin=2)
        return Particles(data[:, 0:3], data[:, 3:6], data[:, 6:9], data[:, 9] / 2.)

    @property
    def energies(self) -> Columns:
        return read_columns(self.folder / "energies.csv")

    def solid_forces(self, solid: int) -> Columns:
        return read_columns(self.folder / f"solid_forces_{solid:02d}.csv")


@dataclass(frozen=True)
class Bench:
    """The folder where cases run."""
    program: str
    folder: Path
    reuse: bool = False  # whether finished runs in the folder are used again
    rayleigh_share: float | None = None  # time step of all cases in place of their own

    def run(self, case: str, label: str = "", **settings: Any) -> Results:
        """Runs prm/verification/<case>.prm.

        @param label distinguishes several runs of a case
        @param settings overrides, "subsection/entry" with "__" for "/" and "_" for a blank
        """
        share = "" if self.rayleigh_share is None else f"_step{100. * self.rayleigh_share:g}"
        folder = self.folder / ((f"{case}_{label}" if label else case) + share)
        if self.reuse and (folder / "summary.json").exists():
            return Results(folder)
        entries = {name.replace("__", "/").replace("_", " "): value for name, value in settings.items()}
        entries["simulation control/output path"] = folder
        if self.rayleigh_share is not None:
            entries["simulation control/time step"] = self._time_step(case, entries)
        self._start(case, entries, "--quiet")
        return Results(folder)

    def _time_step(self, case: str, entries: dict[str, Any]) -> float:
        """The time step that is the wanted share of the Rayleigh time, from what --check says of others."""
        step = 1e-9
        for _ in range(20):
            text = self._start(case, {**entries, "simulation control/time step": step}, "--check")
            percent = max(map(float, re.findall(r"is (\S+) % of the Rayleigh time", text)))
            if 100. * self.rayleigh_share <= percent < 200. * self.rayleigh_share:
                return step * 100. * self.rayleigh_share / percent
            # The share is written with one digit behind the point.
            step *= 150. * self.rayleigh_share / percent if percent >= 1. else 10.
        raise Failure(f"{case}: no time step is {100. * self.rayleigh_share:g} % of the Rayleigh time.")

    def _start(self, case: str, entries: dict[str, Any], option: str) -> str:
        """Starts the program and returns its output."""
        command = [self.program, str(CASES / "verification" / f"{case}.prm"), option, *overrides(entries)]
        # Files that a case names are relative to the folder where the program starts.
        done = subprocess.run(command, check=False, capture_output=True, text=True, cwd=ROOT)
        if done.returncode != 0:
            raise Failure(f"{case} ended with exit code {done.returncode}: {done.stderr}")
        return done.stdout


@dataclass(frozen=True)
class Check:
    """A number beside its reference. The tolerance is absolute, in the same unit; without one the
    reference is the smallest allowed value."""
    what: str
    result: float
    reference: float
    tolerance: float | None
    unit: str = ""

    @property
    def passes(self) -> bool:  # false for a NaN
        if self.tolerance is None:
            return self.result >= self.reference
        return abs(self.result - self.reference) <= self.tolerance

    def __str__(self) -> str:
        unit = f" {self.unit}" if self.unit else ""
        demand = (f"at least {self.reference:.6g}{unit}" if self.tolerance is None else
                  f"reference {self.reference:.6g}{unit}, tolerance {self.tolerance:.2g}{unit}")
        return f"{self.what}: {self.result:.6g}{unit}, {demand}"


def at_least(what: str, result: float, bound: float, unit: str = "") -> Check:
    return Check(what, float(result), bound, None, unit)


def relative(what: str, result: float, reference: float, tolerance: float, unit: str = "") -> Check:
    return Check(what, float(result), float(reference), tolerance * abs(reference), unit)


def absolute(what: str, result: float, reference: float, tolerance: float, unit: str = "") -> Check:
    return Check(what, float(result), float(reference), tolerance, unit)


@dataclass
class Row:
    """The results of a row of the table, and a function that draws them on given axes."""
    checks: list[Check] = field(default_factory=list)
    n_panels: int = 0
    draw: Callable[[Any], None] | None = None


@dataclass(frozen=True)
class RowMaker:
    name: str
    title: str
    make: Callable[[Bench], Row]
    is_long: bool = False


ROWS: dict[str, RowMaker] = {}


def row(name: str, title: str, is_long: bool = False) -> Callable:
    """Registers a function as a row of the table."""
    def register(make: Callable[[Bench], Row]) -> Callable[[Bench], Row]:
        ROWS[name] = RowMaker(name, title, make, is_long)
        return make
    return register
