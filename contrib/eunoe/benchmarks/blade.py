"""The plough's spreader: the lower half of a cylinder with its axis in z, in plane facets.

Eunoe makes the same surface itself (`half_round_bar` in prm/benchmarks/plough.prm).
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

RADIUS, TIP_X, TIP_Y = 1.5e-3, -1.2e-3, 1e-3  # (m)
MARGIN = 0.1e-3  # by which it is longer than the period, at each end (m)
FACETS, SPEED = 50, 0.1  # (1), (m/s)


def triangles(depth: float) -> np.ndarray:
    """Corners of the triangles (m), shape (n, 3, 3), for a period of `depth` (m) in z."""
    angle = np.pi * (1. + np.arange(FACETS + 1) / FACETS)
    x, y = TIP_X + RADIUS * np.cos(angle), TIP_Y + RADIUS * (1. + np.sin(angle))
    near, far = (np.column_stack((x, y, np.full_like(x, z))) for z in (-MARGIN, depth + MARGIN))
    return np.concatenate((np.stack((near[:-1], near[1:], far[1:]), axis=1),
                           np.stack((near[:-1], far[1:], far[:-1]), axis=1)))


def write_triangles(path: Path, name: str, corners: np.ndarray) -> None:
    """An STL file of triangles, shape (n, 3, 3)."""
    with open(path, "w", encoding="utf-8") as file:
        file.write(f"solid {name}\n")
        for a, b, c in corners:
            normal = np.cross(b - a, c - a)
            file.write("facet normal %g %g %g\nouter loop\n" % tuple(normal / np.hypot.reduce(normal)))
            for corner in (a, b, c):
                file.write("vertex %.12g %.12g %.12g\n" % tuple(corner))
            file.write("endloop\nendfacet\n")
        file.write(f"endsolid {name}\n")


def write_stl(path: Path, depth: float) -> None:
    write_triangles(path, "blade", triangles(depth))
