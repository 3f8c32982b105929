"""How strong an effect is in an experiment: from the runs of a pilot study, the amplitude at which
it shifts the data points by a given number of standard deviations of one run (Mahalanobis)."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np


class Strengths:
    """Shifts of all effects by amplitude, in units of one run's scatter."""

    def __init__(self, pilot: Path) -> None:
        self.content = json.loads((pilot / "discovery.json").read_text(encoding="utf-8"))
        self.effects = {e["name"]: e for e in self.content["catalogue"] if e["kind"] == "effect"}
        cells = [(c["experiment"], c["observable"], c["index"]) for c in self.content["envelopes"]]
        places = {(experiment, *cell): k for experiment, known in self.content["cells"].items()
                  for k, cell in enumerate(map(tuple, known))}
        self.sets: dict[tuple, list[np.ndarray]] = {}
        runs: dict[tuple, dict[str, list]] = {}
        for stage in sorted((pilot / "stages").glob("*.json")):
            for run in json.loads(stage.read_text(encoding="utf-8"))["runs"]:
                if run["values"] is not None:
                    key = (tuple(sorted(run["amplitudes"].items())), run["seed"])
                    runs.setdefault(key, {})[run["experiment"]] = run["values"]
        for (amplitudes, _), values in runs.items():
            if all(experiment in values for experiment, _, _ in cells):
                self.sets.setdefault(amplitudes, []).append(
                    np.array([values[cell[0]][places[cell]] for cell in cells], dtype=float))
        base = np.array(self.sets[()])
        self.kept = base.std(axis=0) > 0.
        self.mean, self.n_base = base.mean(axis=0)[self.kept], len(base)
        self.whiten = _whitening(base[:, self.kept])

    def shift(self, effect: str, amplitude: float) -> float:
        """Squared length of the shift, less the contribution of noise."""
        rows = np.array(self.sets[((effect, amplitude),)])[:, self.kept]
        change = self.whiten @ (rows.mean(axis=0) - self.mean)
        return float(change @ change) - len(change) * (1. / len(rows) + 1. / self.n_base)

    def amplitude(self, effect: str, strength: float) -> float | None:
        """The amplitude with a strength (negative: below the null value); None if the range ends before
        it. The shift is taken to grow in proportion on each side."""
        known = self.effects[effect]
        null = known["null_value"]
        side = 1. if strength > 0. else -1.
        slopes = []
        for key in self.sets:
            if len(key) == 1 and key[0][0] == effect and (key[0][1] - null) * side > 0.:
                square = self.shift(effect, key[0][1])
                slopes.append(np.sqrt(max(square, 0.)) / abs(key[0][1] - null))
        if not slopes or max(slopes) <= 0.:
            return None
        amplitude = null + side * abs(strength) / float(np.mean([s for s in slopes if s > 0.]))
        low, high = known["range"]
        return amplitude if low <= amplitude <= high else None


def _whitening(rows: np.ndarray) -> np.ndarray:
    """A matrix that makes the covariance of the runs' scatter a unit matrix. Correlations are
    shrunk towards zero, the more the fewer the runs (Schaefer and Strimmer 2005)."""
    n = len(rows)
    spread = rows.std(axis=0, ddof=1)
    z = (rows - rows.mean(axis=0)) / spread
    correlation = z.T @ z / (n - 1)
    products = np.einsum("ni,nj->nij", z, z)
    variance = n / (n - 1.)**3 * ((products - products.mean(axis=0))**2).sum(axis=0)
    off = ~np.eye(len(spread), dtype=bool)
    denominator = float((correlation[off]**2).sum())
    share = min(1., float(variance[off].sum()) / denominator) if denominator > 0. else 1.
    shrunk = np.where(off, (1. - share) * correlation, correlation)
    values, vectors = np.linalg.eigh(shrunk)
    return (vectors / np.sqrt(np.maximum(values, 1e-3))).T / spread
