"""A column of soft, equal grains that collapses fast: the searches' benchmark.

37,800 grains of 10 mm stand on a lattice with gaps of a fiftieth of their diameter and shifts at random of
half as much, between x = 0 and 0.306 m over the floor of a closed box.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .cases import Case

DIAMETER = 0.01  # (m)
COLUMNS, LAYERS, ROWS = 30, 63, 20
PITCH = 1.02  # diameters


@dataclass(frozen=True)
class SoftColumn(Case):
    deck: str = "soft_column_"
    density: float = 2400.
    time_step: float = 5e-5
    # The best of the other programs' skins counts.
    skins: tuple[float, ...] = (2e-3, 3.5e-3, 5e-3)

    @property
    def box(self) -> tuple[float, float, float]:
        return 1.6, 0.8, 0.21

    def particles(self) -> np.ndarray:
        shape = (COLUMNS, LAYERS, ROWS)
        pitch = PITCH * DIAMETER
        places = pitch * (np.indices(shape).reshape(3, -1).T + 0.5)
        gap = pitch - DIAMETER
        places += 0.25 * gap * np.random.default_rng(1).uniform(-1., 1., places.shape)
        return np.column_stack((np.full(len(places), DIAMETER), places))
