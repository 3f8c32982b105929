"""How strong an effect is in an experiment: from a pilot study, the amplitude at which it shifts the
data points by a given number of standard deviations of one run (Mahalanobis)."""

from __future__ import annotations

import json
from pathlib import Path

# The study of the pilot's data that ends a suite.
PILOT_AT_THE_END = "end"


class Strengths:
    """Strengths of all effects by amplitude, as the emulator of a pilot study gives them."""

    def __init__(self, pilot: Path) -> None:
        content = json.loads((pilot / "discovery.json").read_text(encoding="utf-8"))
        self.null = {e["name"]: e["null_value"] for e in content["catalogue"]}
        self.known = content["strengths"]
        self.untried = set(content.get("untried", []))
        # Whether any run of a measured experiment came to its end, by effect and side of its null value: the table
        # has runs of held-out experiments, too. An emulator has strengths on both sides as soon as there are runs on one.
        measured = {row["experiment"] for row in content["envelopes"]}
        self.succeeded: dict[tuple[str, bool], bool] = {}
        for run in content["ledger"]:
            for name, amplitude in run["amplitudes"].items() if run["experiment"] in measured else ():
                side = name, amplitude > self.null[name]
                self.succeeded[side] = self.succeeded.get(side, False) or "failure" not in run

    def knows(self, effect: str, strength: float) -> bool:
        """Whether the pilot has simulated an effect on this side of its null value. Where it has not, a strength of
        zero says nothing."""
        return effect in self.known and self.succeeded.get((effect, strength > 0.), False)

    def why_unknown(self, effect: str, strength: float) -> str:
        """Why the pilot does not know an effect on this side of its null value, though it would with all the runs that
        it wants; empty if it has not made these yet."""
        if effect not in self.null:
            return "is not of its catalogue"
        if (effect, strength > 0.) in self.succeeded:
            return "failed in all of its runs"
        return "" if effect in self.known or effect in self.untried else "acts in none of its measured experiments"

    def amplitude(self, effect: str, strength: float) -> tuple[float, float]:
        """The first amplitude with a strength (negative: below the null value), or the range's end, and the
        strength there."""
        null, side = self.null[effect], 1. if strength > 0. else -1.
        before, below = null, 0.
        rows = sorted((abs(a - null), a, s) for a, s in self.known.get(effect, []) if (a - null) * side > 0.)
        for _, amplitude, reached in rows:
            if reached >= abs(strength):
                share = (abs(strength) - below) / (reached - below)
                return before + share * (amplitude - before), abs(strength)
            before, below = amplitude, reached
        return before, below

    def strength(self, effect: str, amplitude: float) -> float:
        """The strength at an amplitude, negative below the null value; beyond the last amplitude, that there."""
        null = self.null[effect]
        side = 1. if amplitude > null else -1.
        before, below = 0., 0.
        rows = sorted((abs(a - null), s) for a, s in self.known.get(effect, []) if (a - null) * side > 0.)
        for away, reached in rows:
            if away >= abs(amplitude - null):
                below += (abs(amplitude - null) - before) / (away - before) * (reached - below)
                break
            before, below = away, reached
        return side * below
