"""The cases of a suite: what is hidden in each, and with which seeds."""

from __future__ import annotations

import itertools
import json
import random
from collections import Counter
from dataclasses import asdict, dataclass, field
from pathlib import Path

# Reported suites use seeds on which nothing was tuned.
FIRST_SEED = {"ci": 100, "development": 10_000, "reported": 500_000, "again": 600_000,
              "third": 700_000, "fourth": 800_000, "fifth": 900_000, "sixth": 1_000_000}
STRENGTHS = (2., 4., 8.)  # shift in standard deviations of one run (Mahalanobis)
STRENGTH_OF_PAIRS, STRENGTH_WHEN_DELETED = 6., 8.
JUST_VISIBLE, OVERWHELMING = 3., 40.


@dataclass
class Case:
    """One hidden truth and the study that looks for it."""

    name: str
    kind: str  # none, single, two, deleted, confounded
    seed: int  # of the twin
    study_seed: int
    strengths: dict[str, float] = field(default_factory=dict)  # negative: below the null value
    excluded: list[str] = field(default_factory=list)  # effects deleted from the catalogue
    amplitudes: dict[str, float] = field(default_factory=dict)

    def save(self, folder: Path) -> None:
        (folder / "case.json").write_text(json.dumps(asdict(self), indent=1) + "\n", encoding="utf-8")

    @classmethod
    def load(cls, folder: Path) -> Case:
        return cls(**json.loads((folder / "case.json").read_text(encoding="utf-8")))


@dataclass
class Numbers:
    """How many cases of each kind."""

    none: int
    single: int  # for each effect and strength
    two: int
    deleted: int
    confounded: int
    drawn: int = 0  # for each effect, of a strength from just visible to the end of its range


# "ci" runs in minutes on cheap experiments, "small" in some hours on two cores, "full" on a cluster. "range" has
# physical amplitudes all over the ranges, in an order that may be cut short anywhere.
TIERS = {"ci": Numbers(2, 1, 0, 1, 0), "small": Numbers(12, 1, 6, 6, 6),
         "full": Numbers(100, 3, 40, 40, 40), "range": Numbers(14, 0, 4, 8, 0, 2)}


def another_truth(taken: list[tuple[str, float]], effects: dict[str, dict], draw: random.Random) -> tuple[str, float]:
    """An effect and a strength that are not among those taken: of an effect that is there least often, and on the
    other side of its null value rather than with another strength."""
    times = Counter(name for name, _ in taken)
    fewest = min(times[name] for name in effects)
    name = draw.choice([name for name in sorted(effects) if times[name] == fewest])
    sides = {"above": [1], "below": [-1]}.get(effects[name]["sign"]) or draw.sample((-1, 1), 2)
    # A little weaker, a little stronger, weaker still, ...
    strengths = (round(STRENGTH_WHEN_DELETED * 1.25 ** ((step + 1) // 2 * (-1) ** step), 1) for step in itertools.count())
    return next((name, side * strength) for strength in strengths for side in sides if (name, side * strength) not in taken)


def make_cases(effects: dict[str, dict], tier: str, seeds: str, study_seeds: int) -> list[Case]:
    """All cases of a suite, the same for the same arguments.

    @param effects: the output of --list-effects, by name
    @param study_seeds: number of different seeds of studies; studies with the same seed share the runs
        of the base model and of the fingerprints, which saves most of the time but ties their errors
    """
    numbers, first = TIERS[tier], FIRST_SEED[seeds]
    draw = random.Random(first)
    # Apart from the other draws, so that what a suite has made already stays as it was.
    redraw = random.Random(f"truths instead of those deleted twice, {first}")
    cases: list[Case] = []

    def add(kind: str, strengths: dict[str, float], excluded: list[str] | None = None) -> None:
        number = len(cases)
        words = [kind, *(f"{name}{value:+g}" for name, value in strengths.items()), str(number)]
        cases.append(Case("_".join(words), kind, first + number, first // 100 + number % study_seeds,
                          strengths, excluded or []))

    def sign(name: str) -> int:
        return {"above": 1, "below": -1}.get(effects[name]["sign"]) or draw.choice((-1, 1))

    names = sorted(effects)
    for _ in range(numbers.none):
        add("none", {})
    for strength, name, _ in itertools.product(STRENGTHS, names, range(numbers.single)):
        add("single", {name: sign(name) * strength})
    for name, _ in itertools.product(names, range(numbers.drawn)):
        strength = JUST_VISIBLE * (OVERWHELMING / JUST_VISIBLE) ** draw.random()
        add("single", {name: sign(name) * round(strength, 1)})
    for _ in range(numbers.two):
        add("two", {name: sign(name) * STRENGTH_OF_PAIRS for name in draw.sample(names, 2)})
    deleted = [(name, sign(name) * STRENGTH_WHEN_DELETED) for name in (draw.choice(names) for _ in range(numbers.deleted))]
    for k, truth in enumerate(deleted):
        if truth in deleted[:k]:
            deleted[k] = another_truth(deleted, effects, redraw)
        add("deleted", dict([deleted[k]]), [deleted[k][0]])
    pairs = [(name, other) for name in names for other in effects[name]["confounders"] if other in effects]
    for _ in range(numbers.confounded if pairs else 0):
        name, _ = draw.choice(pairs)
        add("confounded", {name: sign(name) * STRENGTHS[1]})
    if numbers.drawn:
        draw.shuffle(cases)
    return cases
