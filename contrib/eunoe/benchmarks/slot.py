"""A bin of 50,000 soft grains that runs out through a slot: the benchmark of flow.

The bed of the file, 10,000 grains that are at rest over a floor, stands five times behind each other on the
bin's floor, and everything has a period of five times its own in z.
"""

from __future__ import annotations

import gzip
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from eunoe.repository import BENCHMARKS

from . import blade
from .cases import Case

FILE = BENCHMARKS / "slot_bed.csv.gz"  # diameter, x, y, z in um, over a floor at y = 0
MICROMETRE = 1e-6
LENGTH, HEIGHT, PERIOD = 0.4, 0.8, 0.05  # of the box, the last one of the bed in the file (m)
LIP, FLOOR = 0.3, 0.32  # lower and upper side of the bin's floor (m)
LEFT, RIGHT = 0.15, 0.25  # sides of the slot (m)


@dataclass(frozen=True)
class Slot(Case):
    deck: str = "slot_"
    density: float = 2400.
    time_step: float = 5e-5
    # The best of the other programs' skins counts.
    skins: tuple[float, ...] = (2e-3, 3e-3, 4e-3)

    @property
    def box(self) -> tuple[float, float, float]:
        return LENGTH, HEIGHT, self.copies * PERIOD

    def particles(self) -> np.ndarray:
        with gzip.open(FILE, "rt") as file:
            bed = MICROMETRE * np.loadtxt(file, delimiter=",", skiprows=1)
        return np.concatenate([bed + [0., 0., FLOOR, k * PERIOD] for k in range(self.copies)])

    def variables(self, folder: Path) -> dict:
        write_stl(folder / "floor.stl", self.box[2])
        return {"lip": LIP, "floor": FLOOR, "left": LEFT, "right": RIGHT, "length": LENGTH,
                "mesh": folder / "floor.stl"}


def triangles(depth: float) -> np.ndarray:
    """Corners of the triangles (m) of both halves of the bin's floor, shape (n, 3, 3). They are longer than
    the period and have no ends, as LIGGGHTS refuses triangles outside of its box."""
    # A corner of a box has the bits x, y, z; each side is cut into two triangles.
    sides = ((0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6))
    ends = (-PERIOD, depth + PERIOD)
    found = []
    for x in ((0., LEFT), (RIGHT, LENGTH)):
        corner = [(x[k >> 2], (LIP, FLOOR)[k >> 1 & 1], ends[k & 1]) for k in range(8)]
        for a, b, c, d in sides:
            found += [(corner[a], corner[b], corner[c]), (corner[a], corner[c], corner[d])]
    return np.array(found)


def write_stl(path: Path, depth: float) -> None:
    blade.write_triangles(path, "floor", triangles(depth))
