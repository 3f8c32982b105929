"""How well observables tell effects apart: distances of their fingerprints, from recorded runs.

Usage: contrib/tools fingerprints table.txt [--effects cohesion_dmt rolling_resistance] [--experiments heap]
       [--without profile,solid_fraction:2] [--strength 8]

The table is one that record-runs writes. An effect's fingerprint is its change of the means over the data points,
in deviations of one run of the base model (Mahalanobis), linear between the recorded amplitudes. The first effect of
a pair has the wanted strength, or is at the end of its range; the distance is what is left between the two, in
deviations of one run, if the second has its best amplitude. Data that are means of n runs see sqrt(n) times as much.
What the scatter of the few runs adds to a square is subtracted, so that effects that nothing tells apart have 0, not
some deviations of noise; "at most" is a one-sided limit of 95 % for the distance. Of all effects, if none are named,
each is shown with the one that is nearest to it.
"""

from __future__ import annotations

import argparse
import collections
import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from eunoe.launch import Failure, parser
from eunoe.tables import Table, as_markdown

NORMAL_95 = 1.645
PLACES_OF_A_PIECE = 20


@dataclass
class Recorded:
    points: dict[str, list[str]] = field(default_factory=dict)
    effects: list[str] = field(default_factory=list)
    null_values: dict[str, float] = field(default_factory=dict)
    runs: dict[str, dict[tuple[str, float], list[np.ndarray]]] = field(
        default_factory=lambda: collections.defaultdict(lambda: collections.defaultdict(list)))


def read(path: Path) -> Recorded:
    recorded = Recorded()
    for line in path.read_text(encoding="utf-8").splitlines():
        words = line.split()
        if not words or words[0].startswith("#") or words[-1] == "failed":
            continue
        if words[0] == "factor":
            recorded.null_values[words[1]] = float(words[3])
            if words[2] == "effect":
                recorded.effects.append(words[1])
        elif words[0] == "cells":
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
    """The whitened change of the means from the base model at an amplitude, or a combination of several."""

    amplitude: float
    change: np.ndarray
    own_noise: float  # expected square of the change by the scatter of the effect's runs
    base_noise: float  # and by that of the base model's, for a weight of 1
    weight: float = 1.  # of the base model's mean

    @property
    def noise(self) -> float:
        return self.own_noise + self.weight**2 * self.base_noise

    @property
    def square(self) -> float:
        return float(self.change @ self.change) - self.noise

    @property
    def strength(self) -> float:
        return math.sqrt(max(0., self.square))

    @property
    def at_most(self) -> float:
        """One-sided limit of 95 % for the strength."""
        square = max(0., self.square)
        variance = (2. * self.noise**2 + 4. * square * self.noise) / len(self.change)
        return math.sqrt(square + NORMAL_95 * math.sqrt(variance))

    def times(self, share: float) -> Fingerprint:
        return Fingerprint(share * self.amplitude, share * self.change, share**2 * self.own_noise, self.base_noise,
                           share * self.weight)

    def plus(self, other: Fingerprint) -> Fingerprint:
        return Fingerprint(self.amplitude + other.amplitude, self.change + other.change, self.own_noise + other.own_noise,
                           self.base_noise, self.weight + other.weight)


# Fingerprints of one effect on one side of its null value, by growing distance from it.
Side = list[Fingerprint]


def places(side: Side) -> Iterator[Fingerprint]:
    """From nothing to the end of the range, linear between the recorded amplitudes."""
    for before, after in itertools.pairwise([side[0].times(0.), *side]):
        for place in range(1, PLACES_OF_A_PIECE + 1):
            share = place / PLACES_OF_A_PIECE
            yield before.times(1. - share).plus(after.times(share))


def of_strength(side: Side, strength: float) -> Fingerprint:
    """The first place that is as strong, or the end of the range."""
    return next((place for place in places(side) if place.strength >= strength), side[-1])


def nearest(to: Fingerprint, side: Side) -> tuple[Fingerprint, float]:
    """What is left of a fingerprint at the best amplitude of another effect, and that amplitude."""
    left = ((to.plus(place.times(-1.)), place.amplitude) for place in places(side))
    return min(left, key=lambda one: one[0].square)


def fingerprints(recorded: Recorded, experiments: list[str], effects: list[str],
                 without: set[str]) -> dict[str, list[Side]]:
    """Of each effect on each side of its null value, over all data points of the experiments; amplitudes are
    differences from the null value."""
    sums: dict[tuple[str, float], Fingerprint] = {}
    for experiment in experiments:
        runs = recorded.runs[experiment]
        base = np.array(runs["base", 0.])
        if len(base) < 3:
            raise Failure(f"The table has {len(base)} runs of the base model of '{experiment}'. Record more.")
        keep = np.array([not {name, name.split(":")[0]} & without for name in recorded.points[experiment]])
        keep &= np.isfinite(base).all(axis=0) & (base.std(axis=0) > 0.)
        for (effect, _), rows in runs.items():
            if effect in effects:
                keep &= np.isfinite(np.array(rows)).all(axis=0)
        mean, deviation = base[:, keep].mean(axis=0), base[:, keep].std(axis=0, ddof=1)
        whiten = np.linalg.inv(np.linalg.cholesky(shrunk((base[:, keep] - mean) / deviation)))
        base_noise = len(mean) / len(base)
        for (effect, amplitude), rows in runs.items():
            if effect in effects:
                values = ((np.array(rows)[:, keep] - mean) / deviation) @ whiten.T
                scatter = values.var(axis=0, ddof=1).sum() if len(values) > 1 else len(mean)
                old = sums.get((effect, amplitude), Fingerprint(0., np.empty(0), 0., 0.))
                sums[effect, amplitude] = Fingerprint(amplitude - recorded.null_values[effect],
                                                      np.append(old.change, values.mean(axis=0)),
                                                      old.own_noise + scatter / len(values), old.base_noise + base_noise)
    found: dict[str, list[Side]] = {effect: [] for effect in effects}
    for effect, sides in found.items():
        recorded_at = sorted((of for (name, _), of in sums.items() if name == effect), key=lambda of: abs(of.amplitude))
        sides += filter(None, ([of for of in recorded_at if of.amplitude * sign > 0.] for sign in (1, -1)))
        if not sides:
            raise Failure(f"The table has no runs of '{effect}' in {', '.join(experiments)}.")
    return found


def distances(all_of: dict[str, list[Side]], strength: float, only_nearest: bool) -> Table:
    """Of the effects before and after each other in the list, or of each and the one nearest to it."""
    rows: Table = [["effect", "strength", "nearest" if only_nearest else "and", "distance", "at most"]]

    def row(to: Fingerprint, effect: str, other: str) -> tuple[float, list[str]]:
        left, amplitude = min((nearest(to, side) for side in all_of[other]), key=lambda one: one[0].square)
        return left.square, [f"{effect} {to.amplitude:+.3g}", f"{to.strength:.1f}", f"{other} {amplitude:+.3g}",
                             f"{left.strength:.1f}", f"{left.at_most:.1f}"]
    for position, (effect, sides) in enumerate(all_of.items()):
        others = [other for other in all_of if other != effect] if only_nearest else list(all_of)[position + 1:]
        for side in sides:
            found = [row(of_strength(side, strength), effect, other) for other in others]
            rows += [text for _, text in ([min(found)] if only_nearest else found)]
    return rows


def main(words: list[str]) -> int:
    arguments = parser(__doc__)
    arguments.add_argument("table", type=Path)
    arguments.add_argument("--effects", nargs="+", help="else each of the table, with the one nearest to it")
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
    found = fingerprints(recorded, experiments, options.effects or recorded.effects, without)
    print(as_markdown(distances(found, options.strength, not options.effects)))
    return 0
