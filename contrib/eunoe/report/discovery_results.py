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


class Study:
    """The content of discovery.json."""

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
        # Core-seconds of a run by experiment; older answers do not tell them.
        self.costs = {e["name"]: e["core_seconds"] for e in self.content.get("experiments", [])}
        self.observables = {(o["experiment"], o["name"]): o for o in self.content["observables"]}

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
                for c in self.content["envelopes"] if c.get("flagged")}

    def fingerprints(self) -> tuple[list[tuple[str, str, int]], list[Fingerprint]]:
        """The measured cells, and each effect's change of them at the end of its range."""
        cells = [(c["experiment"], c["observable"], c["index"]) for c in self.content["envelopes"]]
        prints = [Fingerprint(row["effect"], row["amplitude"], np.array(row["change"], dtype=float))
                  for row in self.content.get("fingerprints", [])]
        return cells, prints
