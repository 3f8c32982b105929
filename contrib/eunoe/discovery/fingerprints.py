"""How well observables tell effects apart: distances of their fingerprints, from recorded runs.

Usage: contrib/tools fingerprints table.txt [--effects cohesion_dmt rolling_resistance] [--experiments heap]
       [--without profile,solid_fraction:2] [--strength 8]

The table is one that record-runs writes. An effect's fingerprint is its change of the means over the data points,
in deviations of one run of the base model (Mahalanobis), linear between the recorded amplitudes. The first effect of
a pair has the wanted strength, or is at the end of its range; the distance is what is left between the two, in
deviations of one run, if the second has its best amplitude. Data that are means of n runs see sqrt(n) times as much.
What the scatter of the few runs adds to a square is subtracted, so that effects that nothing tells apart have 0, not
some deviations of noise. The best amplitude is found by one half of the runs and judged by the other, and the other
way round, as the smallest of many differences is small by chance. "at most" is a one-sided limit of 95 % for the
distance. Of all effects, if none are named, each is shown with the one that is nearest to it.
"""

from __future__ import annotations

import argparse
import collections
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from eunoe.launch import Failure, parser
from eunoe.tables import Table, as_markdown

NORMAL_95 = 1.645
PLACES_OF_A_PIECE = 10


@dataclass
class Recorded:
    points: dict[str, list[str]] = field(default_factory=dict)
    effects: list[str] = field(default_factory=list)
    null_values: dict[str, float] = field(default_factory=dict)
    # By experiment, effect and amplitude: the values of each run, by its seed.
    runs: dict[str, dict[tuple[str, float], dict[int, np.ndarray]]] = field(
        default_factory=lambda: collections.defaultdict(lambda: collections.defaultdict(dict)))

    def has_trace(self, experiment: str, effect: str) -> bool:
        """Whether an effect changes anything in an experiment: runs with the seed of a run of the base model are
        the same to the last digit if it does not."""
        base = self.runs[experiment]["base", 0.]
        return not all(seed in base and np.array_equal(values, base[seed], equal_nan=True)
                       for (name, _), runs in self.runs[experiment].items() if name == effect
                       for seed, values in runs.items())


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
            recorded.runs[words[0]][words[1], float(words[2])][int(words[3])] = np.array([float(word) for word in words[4:]])
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
    own_noise: np.ndarray  # variance of each component by the scatter of the effect's few runs
    base_noise: np.ndarray  # and by that of the base model's, for a weight of 1
    weight: np.ndarray  # of the base model's mean
    runs: float = math.inf  # from how many the scatter is known

    @property
    def noise(self) -> np.ndarray:
        return self.own_noise + self.weight**2 * self.base_noise

    @property
    def square(self) -> float:
        return float((self.change**2 - self.noise).sum())

    @property
    def variance(self) -> float:
        """Of the square."""
        of_noise = 1. + 1. / max(1., self.runs - 1.)
        squares = np.maximum(0., self.change**2 - self.noise)
        return float((2. * of_noise * self.noise**2 + 4. * squares * self.noise).sum())

    @property
    def strength(self) -> float:
        return math.sqrt(max(0., self.square))

    def times(self, share: float) -> Fingerprint:
        return Fingerprint(share * self.amplitude, share * self.change, share**2 * self.own_noise, self.base_noise,
                           share * self.weight, self.runs)

    def plus(self, other: Fingerprint) -> Fingerprint:
        return Fingerprint(self.amplitude + other.amplitude, self.change + other.change, self.own_noise + other.own_noise,
                           np.maximum(self.base_noise, other.base_noise), self.weight + other.weight,
                           min(self.runs, other.runs))


# Fingerprints of one effect on one side of its null value, by growing distance from it.
Side = list[Fingerprint]


def places(side: Side) -> Iterator[Fingerprint]:
    """From nothing to the end of the range, linear between the recorded amplitudes."""
    for before, after in zip([side[0].times(0.), *side], side):
        for place in range(1, PLACES_OF_A_PIECE + 1):
            share = place / PLACES_OF_A_PIECE
            yield before.times(1. - share).plus(after.times(share))


def of_strength(side: Side, strength: float) -> int:
    """The number of the first place that is as strong, or of the end of the range."""
    return next((k for k, place in enumerate(places(side)) if place.strength >= strength), -1)


@dataclass
class Distance:
    """Of an effect from another one at its best amplitude."""

    amplitude: float  # of the other
    square: float
    variance: float

    @property
    def value(self) -> float:
        return math.sqrt(max(0., self.square))

    @property
    def at_most(self) -> float:
        """One-sided limit of 95 %."""
        return math.sqrt(max(0., self.square) + NORMAL_95 * math.sqrt(self.variance))


def nearest(to: Fingerprint, side: Side) -> int:
    """The place of the other effect at which least is left."""
    return min(enumerate(places(side)), key=lambda place: to.plus(place[1].times(-1.)).square)[0]


def distance(to: Sequence[Fingerprint], others: Sequence[Side]) -> Distance:
    """@param to, others: by all runs, by one half and by the other half of them"""
    whole = list(places(others[0]))[nearest(to[0], others[0])]
    left = [to[judge].plus(list(places(others[judge]))[nearest(to[3 - judge], others[3 - judge])].times(-1.))
            for judge in (1, 2)]
    # Each half has twice the noise of all, and both judge the same.
    return Distance(whole.amplitude, sum(one.square for one in left) / 2., sum(one.variance for one in left) / 4.)


def fingerprints(recorded: Recorded, experiments: list[str], effects: list[str], without: set[str],
                 half: int | None = None) -> dict[str, list[Side]]:
    """Of each effect on each side of its null value, over all data points of the experiments; amplitudes are
    differences from the null value.

    @param half: of the runs at each amplitude, 0 or 1; all by default"""
    sums: dict[tuple[str, float], Fingerprint] = {}
    nothing = np.empty(0)
    for experiment in experiments:
        runs = recorded.runs[experiment]
        base = np.array(list(runs["base", 0.].values()))
        if len(base) < 6:
            raise Failure(f"The table has {len(base)} runs of the base model of '{experiment}'. Record more.")
        keep = np.array([not {name, name.split(":")[0]} & without for name in recorded.points[experiment]])
        keep &= np.isfinite(base).all(axis=0) & (base.std(axis=0) > 0.)
        for (effect, _), rows in runs.items():
            if effect in effects:
                keep &= np.isfinite(np.array(list(rows.values()))).all(axis=0)
        mean, deviation = base[:, keep].mean(axis=0), base[:, keep].std(axis=0, ddof=1)
        whiten = np.linalg.inv(np.linalg.cholesky(shrunk((base[:, keep] - mean) / deviation)))

        def whitened(rows: dict[int, np.ndarray]) -> np.ndarray:
            return ((np.array(list(rows.values()))[:, keep] - mean) / deviation) @ whiten.T
        chosen = slice(half, None, 1 if half is None else 2)
        of_base = whitened(runs["base", 0.])[chosen]
        base_noise = np.full(len(mean), 1. / len(of_base))
        for (effect, amplitude), rows in runs.items():
            if effect not in effects:
                continue
            old = sums.get((effect, amplitude), Fingerprint(0., nothing, nothing, nothing, nothing))
            values = whitened(rows)
            if len(values) < 2:
                raise Failure(f"The table has a single run of '{effect}' at {amplitude:g} in '{experiment}'. Record more.")
            scatter, mine = values.var(axis=0, ddof=1), values[chosen]
            trace = float(recorded.has_trace(experiment, effect))
            sums[effect, amplitude] = Fingerprint(
                amplitude - recorded.null_values[effect],
                np.append(old.change, trace * (mine.mean(axis=0) - of_base.mean(axis=0))),
                np.append(old.own_noise, trace * scatter / len(mine)),
                np.append(old.base_noise, base_noise), np.append(old.weight, np.full(len(mean), trace)),
                min(old.runs, len(values)))
    found: dict[str, list[Side]] = {effect: [] for effect in effects}
    for effect, sides in found.items():
        recorded_at = sorted((of for (name, _), of in sums.items() if name == effect), key=lambda of: abs(of.amplitude))
        sides += filter(None, ([of for of in recorded_at if of.amplitude * sign > 0.] for sign in (1, -1)))
        if not sides:
            raise Failure(f"The table has no runs of '{effect}' in {', '.join(experiments)}.")
    return found


def distances(recorded: Recorded, experiments: list[str], effects: list[str], without: set[str], strength: float,
              only_nearest: bool) -> Table:
    """Of the effects before and after each other in the list, or of each and the one nearest to it."""
    by_half = [fingerprints(recorded, experiments, effects, without, half) for half in (None, 0, 1)]
    rows: Table = [["effect", "strength", "nearest" if only_nearest else "and", "distance", "at most"]]
    for position, effect in enumerate(effects):
        others = [other for other in effects if other != effect] if only_nearest else effects[position + 1:]
        for number, side in enumerate(by_half[0][effect]):
            place = of_strength(side, strength)
            to = [list(places(found[effect][number]))[place] for found in by_half]
            text = [f"{effect} {to[0].amplitude:+.3g}", f"{to[0].strength:.1f}"]
            found = [(other, min((distance(to, [half[other][k] for half in by_half])
                                  for k in range(len(by_half[0][other]))), key=lambda one: one.square))
                     for other in others]
            for other, one in [min(found, key=lambda pair: pair[1].square)] if only_nearest else found:
                rows.append([*text, f"{other} {one.amplitude:+.3g}", f"{one.value:.1f}", f"{one.at_most:.1f}"])
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
    print(as_markdown(distances(recorded, experiments, options.effects or recorded.effects, without, options.strength,
                                not options.effects)))
    return 0
