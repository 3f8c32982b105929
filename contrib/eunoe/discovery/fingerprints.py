"""How well observables tell effects apart: distances of their fingerprints, from recorded runs.

Usage: contrib/tools fingerprints table.txt --effects cohesion_dmt rolling_resistance [--experiments heap]
       [--without profile,solid_fraction:2] [--strength 8]

The table is one that record-runs writes. Each effect's fingerprint, its change of the means over the data
points in deviations of one run, is taken at the recorded amplitude whose strength (Mahalanobis distance from the
base model) is nearest to the wanted one, and scaled to it. The distance of two effects is what is left
between them, in deviations of one run, if the second has its best amplitude: strength times the sine of their
angle. A fingerprint's own noise is subtracted from its strength; it makes distances look larger.
"""

from __future__ import annotations

import argparse
import collections
import itertools
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from eunoe.launch import Failure, parser
from eunoe.tables import Table, as_markdown


@dataclass
class Recorded:
    points: dict[str, list[str]] = field(default_factory=dict)
    runs: dict[str, dict[tuple[str, float], list[np.ndarray]]] = field(
        default_factory=lambda: collections.defaultdict(lambda: collections.defaultdict(list)))


def read(path: Path) -> Recorded:
    recorded = Recorded()
    for line in path.read_text(encoding="utf-8").splitlines():
        words = line.split()
        if not words or words[0] in ("factor", "#") or words[0].startswith("#") or words[-1] == "failed":
            continue
        if words[0] == "cells":
            recorded.points[words[1]] = words[3:]
        else:
            recorded.runs[words[0]][words[1], float(words[2])].append(np.array([float(word) for word in words[4:]]))
    return recorded


def shrunk(deviations: np.ndarray) -> np.ndarray:
    """Covariance of scaled deviations, towards independence by Ledoit and Wolf's share of the correlations."""
    n, dimension = deviations.shape
    correlation = deviations.T @ deviations / (n - 1)
    squares = ((deviations[:, :, None] * deviations[:, None, :] - correlation)**2).sum(axis=0) / (n * (n - 1))
    off = ~np.eye(dimension, dtype=bool)
    share = min(1., float(squares[off].sum() / (correlation[off]**2).sum()))
    correlation[off] *= 1. - share
    return correlation


@dataclass
class Fingerprint:
    amplitude: float
    change: np.ndarray  # whitened
    noise: float  # expected square of its norm by chance

    @property
    def strength(self) -> float:
        return float(np.sqrt(max(0., self.change @ self.change - self.noise)))


def fingerprints(recorded: Recorded, experiments: list[str], effects: list[str],
                 without: set[str]) -> dict[str, list[Fingerprint]]:
    """Of each effect at each of its amplitudes, over all data points of the experiments."""
    found: dict[str, dict[float, Fingerprint]] = {effect: {} for effect in effects}
    for experiment in experiments:
        runs = recorded.runs[experiment]
        base = np.array(runs["base", 0.])
        if len(base) < 3:
            raise Failure(f"The table has {len(base)} runs of the base model of '{experiment}'. Record more.")
        keep = np.array([not {name, name.split(":")[0]} & without for name in recorded.points[experiment]])
        keep &= np.isfinite(base).all(axis=0) & (base.std(axis=0) > 0.)
        deviation = base[:, keep].std(axis=0, ddof=1)
        whiten = np.linalg.inv(np.linalg.cholesky(shrunk((base[:, keep] - base[:, keep].mean(axis=0)) / deviation)))
        for effect, amplitude in runs:
            if effect not in found:
                continue
            values = np.array(runs[effect, amplitude])[:, keep]
            change = whiten @ ((values.mean(axis=0) - base[:, keep].mean(axis=0)) / deviation)
            noise = len(change) * (1. / len(values) + 1. / len(base))
            old = found[effect].get(amplitude, Fingerprint(amplitude, np.empty(0), 0.))
            found[effect][amplitude] = Fingerprint(amplitude, np.append(old.change, change), old.noise + noise)
    missing = [effect for effect, amplitudes in found.items() if not amplitudes]
    if missing:
        raise Failure(f"The table has no runs of '{missing[0]}' in {', '.join(experiments)}.")
    return {effect: list(amplitudes.values()) for effect, amplitudes in found.items()}


def distances(all_of: dict[str, list[Fingerprint]], strength: float) -> Table:
    """Cosines and distances of all pairs."""
    chosen = {effect: min(of, key=lambda f: abs(np.log(max(f.strength, 1e-3) / strength))) for effect, of in all_of.items()}
    rows: Table = [["effects", "amplitudes", "strengths there", "cosine", f"distance at strength {strength:g}"]]
    for (a, first), (b, second) in itertools.combinations(chosen.items(), 2):
        cosine = float(first.change @ second.change / np.linalg.norm(first.change) / np.linalg.norm(second.change))
        rows.append([f"{a}, {b}", f"{first.amplitude:g}, {second.amplitude:g}", f"{first.strength:.1f}, {second.strength:.1f}",
                     f"{cosine:.3f}", f"{strength * np.sqrt(max(0., 1. - cosine**2)):.1f}"])
    return rows


def main(words: list[str]) -> int:
    arguments = parser(__doc__)
    arguments.add_argument("table", type=Path)
    arguments.add_argument("--effects", nargs="+", required=True)
    arguments.add_argument("--experiments", nargs="+", help="else all of the table")
    arguments.add_argument("--without", default="", help="observables, or their data points, that are left out, with commas between")
    arguments.add_argument("--strength", type=float, default=8.)
    options: argparse.Namespace = arguments.parse_args(words)
    recorded = read(options.table)
    experiments = options.experiments or list(recorded.points)
    unknown = set(experiments) - set(recorded.points)
    if unknown:
        raise Failure(f"The table has no experiment '{sorted(unknown)[0]}', but {', '.join(recorded.points)}.")
    without = {name for name in options.without.split(",") if name}
    print(as_markdown(distances(fingerprints(recorded, experiments, options.effects, without), options.strength)))
    return 0
