"""Scores of how well the hidden truths of a suite were found."""

from __future__ import annotations

import json
import math
from collections import Counter
from dataclasses import asdict, dataclass, field
from pathlib import Path
from statistics import median

from eunoe.launch import Failure

from .case import STRENGTHS, Case

SOMETHING = ("named", "tie", "off catalogue")
WITH_A_NAME = ("named", "tie")  # verdicts in which an effect is named or leads
# A model is refuted by held-out data below this p-value, as in the program's tuned.h.
REFUTED = 0.01
# Borders between the strengths 2, 4, 8 and 16, where strengths are drawn and not given.
BORDERS = (0., 2.8, 5.7, 11.3, math.inf)


# What is scored of the lists of an answer, and how many of the likeliest effects are kept.
MOST_CANDIDATES = 5
SCORED_ROWS = {"candidates": ("effect", "confidence"),
               "amplitudes": ("effect", "amplitude", "lower", "upper"),
               "tie": ("effects", "probability"),
               "catalogue": ("name", "family"),
               "learning curve": ("runs", "verdict", "first", "probability", "p of nothing missing")}


@dataclass
class Outcome:
    case: Case
    verdict: str
    named: set[str]  # effects that are named
    first: str  # likeliest candidate
    covering: list[set[str]]  # sets of effects, one of which the answer takes for the truth
    confidence: dict[str, float]
    amplitudes: dict[str, dict]
    shrink: float | None
    runs: int
    curve: list[tuple[int, set[str]]] = field(default_factory=list)  # runs, and the likeliest model with them
    # What held-out data say of models, by their p-values: of those that the fit has named, and of others.
    names_tested: list[tuple[set[str], float]] = field(default_factory=list)
    others_tested: list[tuple[set[str], float]] = field(default_factory=list)
    families: dict[str, str] = field(default_factory=dict)  # of effects that have one
    probabilities: list[float] = field(default_factory=list)  # of the sets in covering
    seen: bool | None = None  # whether something was detected, where that was said beside the verdict

    @property
    def truth(self) -> set[str]:
        return set(self.case.strengths)

    @property
    def strength(self) -> float:
        return max((abs(value) for value in self.case.strengths.values()), default=0.)

    @property
    def detected(self) -> bool:
        return self.verdict in SOMETHING if self.seen is None else self.seen

    @property
    def has_name(self) -> bool:
        """Whether an effect is named or leads. Off the catalogue none does, whichever comes closest."""
        return self.verdict in WITH_A_NAME

    @property
    def first_is_right(self) -> bool:
        return self.has_name and self.first in self.truth

    def leading_with(self, runs: int) -> set[str]:
        """The model that is named or leads after this many runs, if one does."""
        return next((model for number, model in reversed(self.curve) if number <= runs), set())

    def wrong_p(self, tested: list[tuple[set[str], float]]) -> list[float]:
        """p-values of those models that have no effect of the truth."""
        return [p for effects, p in tested if not effects & self.truth_in_catalogue]

    def p_of_wrong_families(self, tested: list[tuple[set[str], float]]) -> list[float]:
        """p-values of those models that have no effect of the truth's families."""
        return [p for effects, p in tested if not self.families_of(effects) & self.families_of(self.truth)]

    @property
    def leading_families(self) -> set[str]:
        """Of the families that the answer leaves the choice among, those with the most probability."""
        sums: Counter = Counter()
        for effects, probability in zip(self.covering, self.probabilities):
            sums[frozenset(self.families_of(effects))] += probability
        return set(max(sums, key=lambda key: sums[key])) if sums else set()

    def families_of(self, effects: set[str]) -> set[str]:
        """Families of effects; an effect without one stands for itself."""
        return {self.families.get(name) or name for name in effects}

    @property
    def covers(self) -> bool:
        return any(members == self.truth for members in self.covering)

    @property
    def confidently_wrong(self) -> bool:
        """Whether an effect is named, without a tie, that is not part of the truth."""
        return self.verdict == "named" and bool(self.named - self.truth_in_catalogue)

    @property
    def truth_in_catalogue(self) -> set[str]:
        return self.truth - set(self.case.excluded)


def place_of_truth(folder: Path) -> Path:
    """While a study runs, and after it was killed, the truth is away."""
    away = folder.parent / f".sealed_{folder.name}"
    return away if away.exists() else folder / "sealed"


def read(folder: Path, label: str) -> dict | None:
    """The case and what is scored of the answer: a line of JSON, as the suites without simulations print it."""
    path = folder / label / "discovery.json"
    if not path.exists() or not (folder / "case.json").exists():
        return None
    content = json.loads(path.read_text(encoding="utf-8"))
    sealed = json.loads((place_of_truth(folder) / "truth.json").read_text(encoding="utf-8"))
    case = Case.load(folder)
    if sealed["effects"] != case.amplitudes:
        raise Failure(f"{folder}: the sealed truth is not the one of case.json.")
    content["candidates"] = content["candidates"][:MOST_CANDIDATES]
    content["gaps"] = {"held-out": {key: value for key, value in content["gaps"].get("held-out", {}).items()
                                    if key != "envelopes"}}
    return {"case": asdict(case), "nuisances": sealed["nuisances"],
            "answer": {key: content[key] for key in ("verdict", "detected", "p of nothing missing", "gaps", "runs") if key in content}
            | {key: [{word: row[word] for word in words if word in row} for row in content.get(key, [])]
               for key, words in SCORED_ROWS.items()}}


def read_lines(path: Path) -> list[Outcome]:
    """The outcomes of a suite that writes cases and answers as lines of JSON."""
    return [outcome_of(json.loads(line)) for line in path.read_text(encoding="utf-8").splitlines() if line]


def outcome_of(line: dict) -> Outcome:
    return outcome(Case(**line["case"]), line["answer"])


def outcome(case: Case, content: dict) -> Outcome:
    """@param content: of discovery.json, or the parts of it that are scored"""
    candidates = content["candidates"]
    rows = {row["effect"]: row for row in content["amplitudes"]}
    named = set(rows) if content["verdict"] == "named" else set()
    covering = [named] if named else [set(row["effects"].split(" + ")) for row in content["tie"]]
    probabilities = [1.] if named else [row.get("probability", 0.) for row in content["tie"]]
    held_out = content["gaps"].get("held-out", {})

    def tested(key: str) -> list[tuple[set[str], float]]:
        return [(set(row["effects"].split(" + ")), row["p"]) for row in held_out.get(key, [])
                if row.get("p") is not None and row["effects"] != "nothing"]
    names = tested("members of the tie")
    return Outcome(case, content["verdict"], named, candidates[0]["effect"] if candidates else "",
                   covering, {row["effect"]: row["confidence"] for row in candidates}, rows,
                   held_out.get("shrink"), content["runs"]["asked for"],
                   [(row["runs"], set(row["first"].split(" + ")) if row["verdict"] in WITH_A_NAME else set())
                    for row in content.get("learning curve", [])],
                   names, [row for row in tested("could have refuted") if row not in names],
                   {row["name"]: row["family"] for row in content.get("catalogue", []) if row.get("family")},
                   probabilities, content.get("detected"))


def wilson(hits: int, number: int, z: float = 1.96) -> tuple[float, float]:
    """95 % interval of a rate (Wilson 1927)."""
    if number == 0:
        return 0., 1.
    share = hits / number
    centre = share + z * z / (2. * number)
    half = z * math.sqrt(share * (1. - share) / number + z * z / (4. * number * number))
    below = 1. + z * z / number
    return max(0., (centre - half) / below), min(1., (centre + half) / below)


@dataclass
class Rate:
    name: str
    hits: int
    number: int
    target: str = ""

    def row(self) -> list[str]:
        if self.number == 0:
            return [self.name, "–", "–", "0", self.target]
        low, high = wilson(self.hits, self.number)
        return [self.name, f"{100. * self.hits / self.number:.1f} %",
                f"{100. * low:.1f} to {100. * high:.1f} %", f"{self.hits} of {self.number}", self.target]


def rate(name: str, outcomes: list[Outcome], hit, target: str = "") -> Rate:
    return Rate(name, sum(1 for o in outcomes if hit(o)), len(outcomes), target)


@dataclass
class Scores:
    rates: list[Rate]
    numbers: dict[str, float]
    confusion: dict[str, Counter] = field(default_factory=dict)
    calibration: list[tuple[str, int, float, float]] = field(default_factory=list)
    learning: list[tuple[int, int, int, int]] = field(default_factory=list)


def score(outcomes: list[Outcome]) -> Scores:
    nothing = [o for o in outcomes if o.case.kind == "none"]
    single = [o for o in outcomes if o.case.kind in ("single", "confounded")]
    strong = [o for o in single if o.strength >= 4.]
    two = [o for o in outcomes if o.case.kind == "two"]
    deleted = [o for o in outcomes if o.case.kind == "deleted"]
    answered = [o for o in single if o.has_name]
    right = [o for o in single + two if o.verdict == "named" and o.named == o.truth]
    rates = [rate("false alarms", nothing, lambda o: o.detected, "upper limit at most 5 %")]
    by_strength = _by_strength(single)
    for at, some in by_strength.items():
        rates.append(rate(f"detection at strength {at}", some, lambda o: o.detected))
    rates += [
        rate("detection at strength 4 and more", strong, lambda o: o.detected, "at least 95 %")]
    for strength, some in by_strength.items():
        if max(o.strength for o in some) < STRENGTHS[1]:
            continue
        at = f"at strength {strength}"
        rates += [
            rate(f"first name, named or leading, correct {at}", some,
                 lambda o: o.first_is_right, "85 % at 4, 93 % at 8"),
            rate(f"named rightly {at}", some, lambda o: o.verdict == "named" and o.named == o.truth),
            rate(f"named wrongly {at}", some, lambda o: o.confidently_wrong, "at most 2 %"),
            rate(f"tied with the truth {at}", some, lambda o: o.verdict == "tie" and o.covers),
            rate(f"tied without it {at}", some, lambda o: o.verdict == "tie" and not o.covers),
            rate(f"off the catalogue {at}", some, lambda o: o.verdict == "off catalogue"),
            rate(f"missed {at}", some, lambda o: not o.detected)]
    rates += [
        rate("first name correct at strength 4 and more", strong, lambda o: o.first_is_right),
        rate("set covers the truth", answered, lambda o: o.covers, "at least 97 %"),
        rate("family right, named or leading, strength 4 and more", [o for o in strong if o.families],
             lambda o: o.detected and o.leading_families == o.families_of(o.truth)),
        rate("two effects: detected", two, lambda o: o.detected),
        rate("two effects: first name correct", two, lambda o: o.first_is_right),
        rate("two effects: off the catalogue", two, lambda o: o.verdict == "off catalogue"),
        rate("two effects: both named", two, lambda o: o.named == o.truth, "at least 60 %"),
        rate("two effects: covered", [o for o in two if o.covering], lambda o: o.covers),
        rate("deleted effect recognised as off the catalogue", deleted,
             lambda o: o.verdict == "off catalogue", "at least 70 %"),
        rate("deleted effect: off the catalogue, or no outright name", deleted,
             lambda o: not o.confidently_wrong, "at least 80 %"),
        rate("off the catalogue although it is in it, strength 4 and more", strong,
             lambda o: o.verdict == "off catalogue"),
        rate("confident and wrong, effect deleted", deleted, lambda o: o.confidently_wrong),
        rate("confident and wrong", single + two + deleted, lambda o: o.confidently_wrong, "at most 2 %"),
        rate("amplitude within its interval", right, _covers_amplitudes, "95 %")]
    known = single + two + deleted
    rates += [_refuted("wrong name refuted by held-out data", [p for o in known for p in o.wrong_p(o.names_tested)],
                       "at least 70 %"),
              _refuted("name of a wrong family refuted by held-out data",
                       [p for o in single + two if o.families for p in o.p_of_wrong_families(o.names_tested)]),
              _refuted("any wrong model refuted by held-out data",
                       [p for o in known for p in o.wrong_p(o.names_tested + o.others_tested)])]
    numbers = {}
    for name, some in (("", answered), (", strength 4 and more", [o for o in answered if o.strength >= 4.])):
        if some:
            numbers[f"mean size of the set{name} (target 1.5)"] = (
                sum(len(o.covering) for o in some) / len(some))
    shrinks = [o.shrink for o in single if o.verdict == "named" and o.shrink is not None]
    if shrinks:
        numbers["median shrink of the held-out gap (target 0.8)"] = median(shrinks)
    errors = [abs(o.amplitudes[name]["amplitude"] / o.case.amplitudes[name] - 1.)
              for o in right for name in o.truth if o.case.amplitudes[name] != 0.]
    if errors:
        numbers["median relative error of the amplitude"] = median(errors)
    numbers["runs of a study, mean"] = sum(o.runs for o in outcomes) / max(1, len(outcomes))
    confusion: dict[str, Counter] = {}
    for o in single + nothing:
        truth = ", ".join(sorted(o.truth)) or "nothing"
        answer = o.first if o.verdict == "named" else o.verdict
        confusion.setdefault(truth, Counter())[answer] += 1
    return Scores(rates, numbers, confusion, calibration(single), learning(strong))


def _by_strength(outcomes: list[Outcome]) -> dict[str, list[Outcome]]:
    """Outcomes by their strengths, or, where strengths were drawn, by ranges of it."""
    strengths = sorted({o.strength for o in outcomes})
    if set(strengths) <= set(STRENGTHS):
        return {f"{strength:g}": [o for o in outcomes if o.strength == strength] for strength in strengths}
    groups = {(f"{low:g} to {high:g}" if high < math.inf else f"{low:g} and more"):
              [o for o in outcomes if low <= o.strength < high] for low, high in zip(BORDERS, BORDERS[1:])}
    return {name: some for name, some in groups.items() if some}


def _refuted(name: str, p_values: list[float], target: str = "") -> Rate:
    return Rate(name, sum(1 for p in p_values if p < REFUTED), len(p_values), target)


def _covers_amplitudes(o: Outcome) -> bool:
    def covers(row: dict, truth: float) -> bool:
        # An interval that reaches the range's end is rounded like any product of numbers.
        rounding = 1e-9 * abs(truth)
        return row["lower"] - rounding <= truth <= row["upper"] + rounding
    return all(covers(o.amplitudes[name], o.case.amplitudes[name]) for name in o.truth)


def learning(outcomes: list[Outcome]) -> list[tuple[int, int, int, int]]:
    """Number of runs, studies, those in which the true effect led with as many runs, and those still going on."""
    studied = [o for o in outcomes if o.curve]
    return [(runs, len(studied), sum(1 for o in studied if o.truth <= o.leading_with(runs)),
             sum(1 for o in studied if o.curve[-1][0] > runs))
            for runs in (300, 400, 600, 900, 1300, 2000)] if studied else []


def calibration(outcomes: list[Outcome]) -> list[tuple[str, int, float, float]]:
    """Bin, number, mean stated confidence of the first name, and how often it was right."""
    rows = []
    for low, high in ((0., 0.5), (0.5, 0.7), (0.7, 0.9), (0.9, 1.0001)):
        inside = [o for o in outcomes if o.detected and low <= o.confidence.get(o.first, 0.) < high]
        if inside:
            rows.append((f"{low:g} to {min(high, 1.):g}", len(inside),
                         sum(o.confidence[o.first] for o in inside) / len(inside),
                         sum(1 for o in inside if o.first in o.truth) / len(inside)))
    return rows
