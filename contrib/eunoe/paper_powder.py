"""The powder of prm/spreading: what studies and the reproduction of the paper change of it."""

from __future__ import annotations

import math

RAYLEIGH_TIME = 2.816e-7 / 0.15  # s, of the smallest grain
TYPE = "lagrangian physical properties/particle type 0"
WALL = "lagrangian physical properties"
YOUNG = 26.25e6  # Pa
TIME_STEP = "simulation control/time step"


def softened(factor: float, percent: float) -> dict[str, str]:
    """Entries for Young's modulus times `factor`, and a time step of this percentage of the Rayleigh time, which
    goes with the inverse root of the modulus. The pull-off force, which depends on the surface energy alone,
    stays."""
    young = f"{factor * YOUNG:.6g}"
    return {f"{TYPE}/young modulus particles": young, f"{WALL}/young modulus wall": young,
            TIME_STEP: f"{0.01 * percent * RAYLEIGH_TIME / math.sqrt(factor):.6g}"}
