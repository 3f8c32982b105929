"""The settled bed that all benchmarks start from, in the formats of the three programs.

20,000 spheres of 52.6 to 106 um over the floor y = 0, between x = 0 and 4 mm, with a period of 1 mm
in z, at rest under gravity. The contacts' memory is not part of it: every program starts with
relaxed friction springs.
"""

from __future__ import annotations

import gzip
from pathlib import Path

import numpy as np

from eunoe.repository import BENCHMARKS

FILE = BENCHMARKS / "settled_bed.csv.gz"
DENSITY = 4386.  # kg/m3
LENGTH, HEIGHT, PERIOD = 4e-3, 6e-3, 1e-3  # of the box (m)


def read(copies: int = 1) -> np.ndarray:
    """Columns diameter, x, y, z (m), one row for each particle: `copies` of the bed in a row along
    z."""
    with gzip.open(FILE, "rt") as file:
        bed = 1e-6 * np.loadtxt(file, delimiter=",", skiprows=1)
    shift = np.array([0., 0., 0., PERIOD])
    return np.concatenate([bed + k * shift for k in range(copies)])


def narrow(bed: np.ndarray, length: float) -> np.ndarray:
    """The particles that lie wholly between x = 0 and `length` (m): a shorter column."""
    return bed[bed[:, 1] + 0.5 * bed[:, 0] < length]


def jittered(bed: np.ndarray, seed: int, amplitude: float = 1e-8) -> np.ndarray:
    """The bed with every coordinate moved at random by up to `amplitude` (m); seed 0 moves none."""
    if seed == 0:
        return bed
    result = bed.copy()
    result[:, 1:] += np.random.default_rng(seed).uniform(-amplitude, amplitude, (len(bed), 3))
    return result


def write_for_eunoe(path: Path, bed: np.ndarray) -> None:
    """A table for the insertion method 'file'."""
    np.savetxt(path, bed[:, [1, 2, 3, 0]], fmt="%.12e", delimiter="; ",
               header="p_x; p_y; p_z; diameters", comments="")


def write_for_peer(path: Path, bed: np.ndarray, size: tuple[float, float, float], density: float,
                   style: str) -> None:
    """A data file for LAMMPS (style 'Atoms # sphere') or LIGGGHTS ('Atoms'); `size` of the box
    (m), `density` of the particles (kg/m3)."""
    with open(path, "w", encoding="utf-8") as file:
        file.write(f"settled bed\n\n{len(bed)} atoms\n1 atom types\n\n0 {size[0]} xlo xhi\n"
                   f"{-0.02 * size[1]} {size[1]} ylo yhi\n0 {size[2]} zlo zhi\n\n{style}\n\n")
        rows = np.column_stack((np.arange(1, len(bed) + 1), bed))
        np.savetxt(file, rows, fmt=f"%d 1 %.9e {density} %.12e %.12e %.12e")
