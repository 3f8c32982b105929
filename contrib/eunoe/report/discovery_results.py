"""What a study has left in its folder."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .run_folder import ReportError


@dataclass
class Fingerprint:
    """The change of each data point by an effect, in standard deviations of one base-model run."""

    effect: str
    amplitude: float
    change: np.ndarray
    error: np.ndarray  # standard error of the change


class Study:
    """The content of discovery.json, and the runs that the stages list."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        path = folder / "discovery.json"
        try:
            self.content = json.loads(path.read_text(encoding="utf-8"))
        except FileNotFoundError:
            raise ReportError(f"{path} is missing. Name the output folder of a study that has "
                              "ended.") from None
        except json.JSONDecodeError as error:
            raise ReportError(f"{path} is damaged: {error}.") from None
        self.verdict: str = self.content["verdict"]
        self.effects = {e["name"]: e for e in self.content["catalogue"]}
        self.observables = {(o["experiment"], o["name"]): o for o in self.content["observables"]}

    def stage(self, name: str) -> dict:
        return self.content.get("stages", {}).get(name, {})

    def envelopes(self, held_out: bool) -> dict[tuple[str, str], list[dict]]:
        """Rows of cells by experiment and observable."""
        rows = (self.content["gaps"].get("held-out", {}).get("envelopes", []) if held_out
                else self.content.get("envelopes", []))
        groups: dict[tuple[str, str], list[dict]] = {}
        for row in rows:
            groups.setdefault((row["experiment"], row["observable"]), []).append(row)
        return {key: sorted(cells, key=lambda row: row["index"]) for key, cells in groups.items()}

    def flagged(self) -> set[tuple[str, str, int]]:
        return {(c["experiment"], c["observable"], c["index"])
                for c in self.stage("detect").get("cells", []) if c["flagged"]}

    def fingerprints(self) -> tuple[list[tuple[str, str, int]], list[Fingerprint]]:
        """The measured cells that vary, and each effect's change of them in the stage screen."""
        cells = [(c["experiment"], c["observable"], c["index"]) for c in self.content["envelopes"]]
        places = {(experiment, *cell): k for experiment, known in self.content["cells"].items()
                  for k, cell in enumerate(map(tuple, known))}
        base = self._values({}, cells, places)
        if len(base) < 2:
            return cells, []
        spread = base.std(axis=0, ddof=1)
        kept = spread > 0.
        spread = spread[kept]
        prints = []
        for row in self.stage("screen").get("effects", []):
            effect = self.effects[row["effect"]]
            amplitudes = self._amplitudes_of(effect["name"])
            if not amplitudes:
                continue
            amplitude = max(amplitudes, key=lambda a: abs(a - effect["null_value"]))
            runs = self._values({effect["name"]: amplitude}, cells, places)
            if len(runs) == 0:
                continue
            change = (runs.mean(axis=0) - base.mean(axis=0))[kept] / spread
            error = np.full(len(change), np.sqrt(1. / len(runs) + 1. / len(base)))
            prints.append(Fingerprint(effect["name"], amplitude, change, error))
        return [cell for cell, keep in zip(cells, kept) if keep], prints

    def _runs(self) -> list[dict]:
        if not hasattr(self, "_kept_runs"):
            self._kept_runs = []
            for name in ("null", "screen"):
                path = self.folder / "stages" / f"{name}.json"
                if path.exists():
                    self._kept_runs += json.loads(path.read_text(encoding="utf-8"))["runs"]
        return self._kept_runs

    def _amplitudes_of(self, effect: str) -> set[float]:
        return {run["amplitudes"][effect] for run in self._runs()
                if list(run["amplitudes"]) == [effect] and run["values"] is not None}

    def _values(self, amplitudes: dict, cells: list, places: dict) -> np.ndarray:
        """One row for each seed: the data points of all experiments at these amplitudes."""
        by_seed: dict[int, dict[str, list]] = {}
        for run in self._runs():
            if run["amplitudes"] == amplitudes and run["values"] is not None:
                by_seed.setdefault(run["seed"], {})[run["experiment"]] = run["values"]
        rows = []
        for values in by_seed.values():
            if all(experiment in values for experiment, _, _ in cells):
                rows.append([values[cell[0]][places[cell]] for cell in cells])
        return np.array(rows, dtype=float)
