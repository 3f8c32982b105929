"""Makes the output folder of a study, as eunoe-discovery writes it, for two effects and four data
points."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

CELLS = [("layers", "LRD", 1), ("layers", "LRD", 2), ("heap", "angle", 0), ("heap", "mass", 0)]
CHANGES = {"cohesion": np.array([-4., -3., 2., 0.]), "rolling_resistance": np.array([-3., -3., 3., 0.])}
SCALES = {"cohesion": 1e-4, "rolling_resistance": 0.1}
SPREAD = np.array([0.01, 0.02, 0.5, 1e-9])
MEAN = np.array([0.5, 0.55, 40., 1e-6])


def envelope(cell: tuple[str, str, int], k: int, after: bool) -> dict:
    """A row of a data point; the first two are flagged."""
    row = {"experiment": cell[0], "observable": cell[1], "index": cell[2],
           "measured": MEAN[k] + 3. * SPREAD[k], "measured deviation": SPREAD[k], "repeats": 4,
           "base": MEAN[k], "base deviation": SPREAD[k], "flagged": k < 2}
    if after:
        row |= {"after": MEAN[k] + 2.8 * SPREAD[k], "after deviation": SPREAD[k]}
    return row


def power_row(effect: str) -> dict:
    return {"effect": effect, "simulated": True, "detectable": True,
            "detectable above": SCALES[effect], "upper bound": 3. * SCALES[effect]}


def make_content(verdict: str) -> dict:
    found = verdict in ("named", "tie", "off catalogue")
    content: dict = {"verdict": verdict, "p of nothing missing": 0.012 if found else 0.4,
                     "confidence off catalogue": 0.05,
                     "candidates": [{"effect": "cohesion", "confidence": 0.9, "log Bayes factor alone": 12.5},
                                    {"effect": "rolling_resistance", "confidence": 0.05}],
                     "amplitudes": [], "tie": [], "notes": ["A note."],
                     "runs": {"asked for": 200, "failed": 1, "budget": 0}}
    if verdict == "named":
        content["amplitudes"] = [{"effect": "cohesion", "unit": "J/m2", "amplitude": 1.1e-4,
                                  "lower": 0.9e-4, "upper": 1.3e-4, "lower reached": True,
                                  "upper reached": True, "confidence": 0.9,
                                  "posterior": [[1e-4, 0.4], [1.1e-4, 0.5], [1.2e-4, 0.1]]}]
        content["decisive"] = [{"experiment": "heap", "observable": "angle", "index": 0, "measured": 41.5,
                                "first": 41.4, "second": 40., "log likelihood ratio": 4.5}]
    if verdict == "tie":
        content["tie"] = [{"effects": "cohesion", "probability": 0.6},
                          {"effects": "rolling_resistance", "probability": 0.4}]
        content["measurements that would break the tie"] = [
            {"experiment": "heap", "observable": "profile", "information": 0.8, "of": 0.97,
             "separation": 5.2, "again": False},
            {"experiment": "layers", "observable": "all", "information": 0.1, "of": 0.97,
             "separation": 1.2, "again": True}]
    if verdict == "off catalogue":
        content["remainder"] = {"resembles": [{"effect": "cohesion", "mechanism": "", "cosine": 0.7}]}
    held_out: dict = {"envelopes": [envelope(("thick", "LRD", 1), 0, found)], "result": "base model only"}
    gaps: dict = {"fit": {"cells": 4, "gap before": 3.1}, "held-out": held_out}
    if found:
        gaps["fit"]["gap after"] = 0.4
        held_out |= {"gap before": 2.5, "gap after": 0.3, "shrink": 0.88, "result": "it describes the data",
                     "could have refuted": [{"effects": "nothing", "p": 1e-4, "would be refuted": 0.9},
                                            {"effects": "rolling_resistance", "p": 0.2,
                                             "would be refuted": 0.15}]}
    content["gaps"] = gaps
    content["envelopes"] = [envelope(cell, k, found) for k, cell in enumerate(CELLS)]
    content["effects"] = [power_row(effect) for effect in CHANGES]
    content["fingerprints"] = [{"effect": name, "amplitude": 5. * SCALES[name], "change": list(5. * change),
                                "error": [0.2] * len(change)} for name, change in CHANGES.items()]
    content["strengths"] = {name: [[u * SCALES[name], float(u * np.sqrt((change**2).sum()))]
                                   for u in (0.01, 0.1, 0.5, 1., 2., 5.)]
                            for name, change in CHANGES.items()}
    content["similarity"] = {"effects": list(CHANGES), "cosines": [[1., 0.95], [0.95, 1.]]}
    content["learning curve"] = [{"runs": n, "p of nothing missing": 0.1 / n, "verdict": verdict,
                                  "first": "cohesion", "probability": 1. - 30. / n} for n in (100, 200, 400)]
    content["catalogue"] = [{"name": name, "kind": "effect", "mechanism": f"what {name} does",
                             "parameter": "size of it", "unit": "1" if "roll" in name else "J/m2",
                             "null_value": 0., "scale": scale, "range": [0., 5. * scale],
                             "confounders": [], "source": "tests"} for name, scale in SCALES.items()]
    content["observables"] = [{"experiment": e, "name": o, "unit": "1", "index": "", "text": ""}
                              for e, o in {c[:2] for c in CELLS} | {("thick", "LRD")}]
    content["experiments"] = [{"name": "layers", "core_seconds": 123.4}, {"name": "heap", "core_seconds": 4.5},
                              {"name": "thick", "core_seconds": 150.}]
    content["nuisances"] = [{"nuisance": "friction of walls", "value": 0.0213, "prior deviations": 0.71}]
    content["provenance"] = {"version": "0"}
    content["simulations"] = {"made_now": 10, "from_table": 5, "core_hours": 0.2}
    run = {"experiment": "layers", "key": "k", "cached": False, "core_seconds": 1.}
    content["ledger"] = [run | {"amplitudes": {"cohesion": 3e-4}, "seed": 1, "failure": "a <particle> went wrong"},
                         *(run | {"amplitudes": {name: scale}, "seed": 2} for name, scale in SCALES.items())]
    return content


def make_study(folder: Path, verdict: str) -> None:
    folder.mkdir(parents=True)
    (folder / "discovery.json").write_text(json.dumps(make_content(verdict)), encoding="utf-8")
    (folder / "model_layers.diff").write_text("set a = 1 # before: 0\n", encoding="utf-8")
