"""Distances of fingerprints whose directions are known: scatter of unit variance, and two effects at an angle
of 60 degrees, of which one is seen in another observable too.

Exit code 77, which skips the test, if numpy is missing.
"""

import importlib.util
import itertools
import math
import sys
import tempfile
from pathlib import Path

if importlib.util.find_spec("numpy") is None:
    sys.exit(77)
import numpy as np

from eunoe.discovery import fingerprints
from eunoe.launch import Failure

STRENGTH = 8.


def table() -> str:
    random = np.random.default_rng(1)
    lines = ["# a table", *(f"factor {name} effect 0 1 0 2 above 0" for name in "abc"), "cells heap 0 height:0 height:1 density:0"]

    def add(effect: str, amplitude: float, mean: tuple[float, float, float], n: int) -> None:
        for seed in range(n):
            values = mean + random.normal(size=3) * (1., 3., 0.1) + (5., 0., 0.)
            lines.append(f"heap {effect} {amplitude} {seed} " + " ".join(f"{value:.6f}" for value in values))
    add("base", 0., (0., 0., 0.), 4000)
    add("a", 0.5, (4., 0., 0.), 400)
    add("a", 1., (8., 0., 0.), 400)
    # Deviations of one run: 4 and 4 sqrt(3) along the heights, and 8 along the density.
    add("b", 2., (4., 3. * 4. * math.sqrt(3.), 0.), 400)
    add("c", 2., (8., 0., 0.8), 400)
    return "\n".join([*lines, "heap b 2 400 failed"]) + "\n"


def thinned(recorded: fingerprints.Recorded, n: int) -> fingerprints.Recorded:
    """With the first runs of each amplitude of an effect."""
    runs = {key: values if key[0] == "base" else dict(itertools.islice(values.items(), n))
            for key, values in recorded.runs["heap"].items()}
    return fingerprints.Recorded(recorded.points, recorded.effects, recorded.null_values, {"heap": runs})


def main() -> int:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "table.txt"
        path.write_text(table(), encoding="utf-8")
        recorded = fingerprints.read(path)
    found = fingerprints.fingerprints(recorded, ["heap"], ["a", "b", "c"], set())
    strengths = {effect: [round(of.strength, 1) for of in sides[0]] for effect, sides in found.items()}
    assert abs(strengths["a"][0] / 4. - 1.) < 0.05 and abs(strengths["a"][1] / 8. - 1.) < 0.03, strengths
    _, *rows = fingerprints.distances(recorded, ["heap"], ["a", "b", "c"], set(), STRENGTH, False)
    by_pair = {(row[0][0], row[2][0]): float(row[3]) for row in rows}
    for pair, cosine in (("ab", 0.5), ("ac", math.sqrt(0.5))):
        assert abs(by_pair[pair[0], pair[1]] - STRENGTH * math.sqrt(1. - cosine**2)) < 0.4, (pair, by_pair)
    # The amplitudes are those of the strength, and of the second effect's projection.
    assert abs(float(rows[0][0].split()[1]) - 1.) < 0.11 and abs(float(rows[0][2].split()[1]) - 1.) < 0.11, rows[0]
    closest = fingerprints.distances(recorded, ["heap"], ["a", "b", "c"], set(), STRENGTH, True)
    assert closest[1][2].startswith("c "), "of b and c, c is nearer to a"
    # Without the density, c cannot be told from a, however few runs there are, whose noise alone
    # is more than a deviation.
    _, blind = fingerprints.distances(thinned(recorded, 4), ["heap"], ["a", "c"], {"density"}, STRENGTH, False)
    assert float(blind[3]) < 2. < float(blind[4]) < 4., blind
    # The column does not change what happens in the heap, and its runs are those of the base model.
    copies = thinned(recorded, 4)
    copies.effects.append("d")
    copies.null_values["d"] = 0.
    copies.runs["heap"]["d", 1.] = dict(itertools.islice(copies.runs["heap"]["base", 0.].items(), 4))
    traceless = fingerprints.fingerprints(copies, ["heap"], ["d"], set())["d"][0][0]
    assert traceless.square == 0. and traceless.variance == 0., traceless
    try:
        fingerprints.fingerprints(recorded, ["heap"], ["d"], set())
    except Failure as failure:
        assert "no runs of 'd' in heap" in str(failure)
    else:
        raise AssertionError("an unknown effect was accepted")
    print("ok")
    return 0


if __name__ == "__main__":
    sys.exit(main())
