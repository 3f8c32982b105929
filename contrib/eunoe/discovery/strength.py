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
