"""The powder of a case: what studies and the reproduction of the paper change of it."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from pathlib import Path

from eunoe.launch import Failure, output_of, overrides

PARTICLES = "lagrangian physical properties/particle type 0"
WALL = "lagrangian physical properties"
TIME_STEP = "simulation control/time step"


@dataclass(frozen=True)
class Powder:
    """Rayleigh time of the smallest grain (s), Young's modulus of the grains (Pa), surface energy of grains and of
    walls (J/m2)."""

    rayleigh_time: float
    young: float
    energy: float = 0.
    wall_energy: float = 0.

    def step(self, percent: float) -> dict[str, str]:
        """A time step of this percentage of the Rayleigh time."""
        return {TIME_STEP: f"{0.01 * percent * self.rayleigh_time:.6g}"}

    def softened(self, factor: float, percent: float) -> dict[str, str]:
        """Young's modulus, of walls too, times `factor`, and a time step of this percentage of the Rayleigh time,
        which goes with the inverse root of the modulus. The pull-off force, which depends on the surface energy
        alone, stays."""
        young = f"{factor * self.young:.6g}"
        return {f"{PARTICLES}/young modulus particles": young, f"{WALL}/young modulus wall": young,
                **self.step(percent / math.sqrt(factor))}

    def less_cohesive(self, factor: float) -> dict[str, str]:
        """Surface energies times `factor`."""
        return {f"{PARTICLES}/surface energy particles": f"{factor * self.energy:.6g}",
                f"{WALL}/surface energy wall": f"{factor * self.wall_energy:.6g}"}


PAPER = Powder(2.816e-7 / 0.15, 26.25e6)  # of prm/spreading


def powder_of(program: str, case: Path, settings: list[str]) -> Powder:
    """The powder of a case with these entries, as the program says it; of several particle types the first."""
    command = [program, str(case), *overrides(settings)]

    def step_and_percent(*more: str) -> tuple[float, float]:
        said = output_of([*command, *overrides(more), "--check"], Path.cwd())
        found = re.search(r"time step of (\S+) s is (\S+) % of the Rayleigh time", said)
        if not found or float(found[2]) == 0.:
            raise Failure(f"{case}: --check says nothing about the Rayleigh time of its particles.")
        return float(found[1]), float(found[2])

    # It is said to a tenth of a percent, which is little of a large share.
    step, percent = step_and_percent()
    step, percent = step_and_percent(f"{TIME_STEP} = {50. * step / percent:.6g}")
    used = output_of([*command, "--print-parameters"], Path.cwd())

    def value(entry: str) -> float:
        return float(re.search(rf"^ *set {entry} *= (\S+)", used, re.M)[1])

    return Powder(step / (0.01 * percent), value("young modulus particles"),
                  value("surface energy particles"), value("surface energy wall"))
