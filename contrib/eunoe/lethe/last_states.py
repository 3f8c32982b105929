"""How far the last state of a run is from the one that a test of Lethe prints."""

from __future__ import annotations

import re
from pathlib import Path

from eunoe.launch import Failure

# Lethe prints four digits behind the point.
PRINTED = 0.51e-4
HEADER = "id, type, dp, x, y, z"
Particles = list[tuple[float, tuple[float, float, float]]]  # diameter and place (m), in the order of ids


def published(test: Path) -> Particles:
    """The particles that Lethe prints at the end of a test; none if it prints no such table."""
    outputs = [path for path in sorted(test.parent.glob(f"{test.stem}.*"))
               if re.fullmatch(r"(\..*)?\.(output|disabled)", path.name[len(test.stem):])]
    for path in outputs:
        tables = path.read_text(encoding="utf-8", errors="replace").split(HEADER)[1:]
        if not tables:
            continue
        rows = []
        for line in tables[-1].splitlines()[1:]:
            words = line.split()
            if len(words) < 6 or not words[0].isdigit():
                break
            rows.append((int(words[0]), float(words[2]), tuple(float(word) for word in words[3:6])))
        if rows:
            return [(diameter, place) for _, diameter, place in sorted(rows)]
    return []


def ours(results: Path) -> Particles:
    """The particles at the end of a run, from its particles.csv."""
    lines = (results / "particles.csv").read_text(encoding="utf-8").splitlines()
    rows = [[float(cell) for cell in line.split(";") if cell.strip()] for line in lines[1:]]
    return [(row[9], (row[0], row[1], row[2])) for row in rows]


def distance(a: tuple[float, ...], b: tuple[float, ...]) -> float:
    return sum((x - y)**2 for x, y in zip(a, b))**0.5


def compared(theirs: Particles, mine: Particles) -> str:
    """In words: the distances of particles of the same number if most are closer than half a diameter,
    else of each of Lethe's particles to the nearest one."""
    if not theirs:
        raise Failure("Lethe prints no particles.")
    if len(theirs) != len(mine):
        return f"{len(mine)} particles instead of {len(theirs)}"
    n_same = sum(all(abs(x - y) <= PRINTED for x, y in zip(a, b)) for (_, a), (_, b) in zip(theirs, mine))
    if n_same == len(mine):
        return f"{len(mine)} particles, in all digits that are printed"
    diameter = max(d for d, _ in theirs)
    apart = sorted(distance(a, b) / diameter for (_, a), (_, b) in zip(theirs, mine))
    how = "by number"
    if apart[len(apart) // 2] > 0.5:
        apart = sorted(min(distance(a, b) for _, b in mine) / diameter for _, a in theirs)
        how = "to the nearest"
    return f"{len(mine)} particles, {how}: median {apart[len(apart) // 2]:.2g}, largest {apart[-1]:.2g} diameters"
