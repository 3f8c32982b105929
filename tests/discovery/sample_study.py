"""Makes the output folder of a study, as eunoe-discovery writes it, for two effects and four data
points."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

CELLS = [("layers", "LRD", 1), ("layers", "LRD", 2), ("heap", "angle", 0), ("heap", "mass", 0)]
KNOWN = {"layers": [["LRD", 1], ["LRD", 2]], "heap": [["angle", 0], ["mass", 0]]}
CHANGES = {"cohesion": np.array([-4., -3., 2., 0.]), "rolling_resistance": np.array([-3., -3., 3., 0.])}
SCALES = {"cohesion": 1e-4, "rolling_resistance": 0.1}
SPREAD = np.array([0.01, 0.02, 0.5, 1e-9])
MEAN = np.array([0.5, 0.55, 40., 1e-6])
N_BASE, N_EFFECT = 40, 4


def make_runs() -> dict[str, list[dict]]:
    draw = np.random.default_rng(1)
    stages: dict[str, list[dict]] = {"null": [], "screen": []}

    def add(stage: str, amplitudes: dict[str, float], seed: int, change: np.ndarray) -> None:
        values = MEAN + SPREAD * (change + draw.standard_normal(len(CELLS)))
        for experiment in KNOWN:
            stages[stage].append({"experiment": experiment, "amplitudes": amplitudes, "seed": seed,
                                  "values": [v for v, c in zip(values, CELLS) if c[0] == experiment]})

    for seed in range(N_BASE):
        add("null", {}, seed, np.zeros(len(CELLS)))
    for effect, change in CHANGES.items():
        for times in (1., 2.):
            for seed in range(N_EFFECT):
                add("screen", {effect: times * SCALES[effect]}, seed, times * change)
    stages["screen"].append({"experiment": "layers", "amplitudes": {"cohesion": 3e-4}, "seed": 1,
                             "values": None})
    return stages


def envelope(cell: tuple[str, str, int], k: int, after: bool) -> dict:
    row = {"experiment": cell[0], "observable": cell[1], "index": cell[2],
           "measured": MEAN[k] + 3. * SPREAD[k], "measured deviation": SPREAD[k], "repeats": 4,
           "base": MEAN[k], "base deviation": SPREAD[k]}
    if after:
        row |= {"after": MEAN[k] + 2.8 * SPREAD[k], "after deviation": SPREAD[k]}
    return row


def screen_row(effect: str) -> dict:
    return {"effect": effect, "simulated": True, "p": 0.0004, "detectable": True,
            "detectable above": SCALES[effect], "upper bound": 3. * SCALES[effect]}


def make_content(verdict: str) -> dict:
    found = verdict in ("named", "tie", "off catalogue")
    content: dict = {"verdict": verdict, "p of nothing missing": 0.012 if found else 0.4,
                     "p of nothing missing is a bound": found,
                     "confidence off catalogue": 0.05,
                     "candidates": [{"effect": "cohesion", "confidence": 0.9},
                                    {"effect": "rolling_resistance", "confidence": 0.05}],
                     "amplitudes": [], "tie": [], "notes": ["A note."],
                     "runs": {"asked for": 200, "failed": 1, "budget": 0}}
    if verdict == "named":
        content["amplitudes"] = [{"effect": "cohesion", "unit": "J/m2", "amplitude": 1.1e-4,
                                  "lower": 0.9e-4, "upper": 1.3e-4, "lower reached": True,
                                  "upper reached": True, "confidence": 0.9}]
    if verdict == "tie":
        content["tie"] = [{"effects": "cohesion", "probability": 0.6},
                          {"effects": "rolling_resistance", "probability": 0.4}]
        content["measurements that would break the tie"] = [
            {"experiment": "heap", "observable": "profile", "indices": [0, 1], "separation": 5.2},
            {"experiment": "the same", "observable": "the same", "separation": 1.2, "repeats": 12}]
    if verdict == "off catalogue":
        content["remainder"] = {"resembles": [{"effect": "cohesion", "mechanism": "", "cosine": 0.7}]}
    held_out: dict = {"envelopes": [envelope(("thick", "LRD", 1), 0, found)], "result": "base model only"}
    gaps: dict = {"fit": {"cells": 4, "gap before": 3.1}, "held-out": held_out}
    if found:
        gaps["fit"]["gap after"] = 0.4
        held_out |= {"gap before": 2.5, "gap after": 0.3, "shrink": 0.88, "result": "the gap shrinks",
                     "gap before interval": [2., 3.], "gap after interval": [0., 0.6],
                     "shrink interval": [0.7, 0.95]}
    content["gaps"] = gaps
    content["envelopes"] = [envelope(cell, k, found) for k, cell in enumerate(CELLS)]
    content["stages"] = {
        "detect": {"cells": [{"experiment": c[0], "observable": c[1], "index": c[2], "flagged": k < 2}
                             for k, c in enumerate(CELLS)]},
        "screen": {"effects": [screen_row(effect) for effect in CHANGES],
                   "similarity": {"effects": list(CHANGES), "cosines": [[1., 0.95], [0.95, 1.]]}},
        "validate": held_out}
    content["catalogue"] = [{"name": name, "kind": "effect", "mechanism": f"what {name} does",
                             "parameter": "size of it", "unit": "1" if "roll" in name else "J/m2",
                             "null_value": 0., "scale": scale, "range": [0., 5. * scale],
                             "confounders": [], "source": "tests"} for name, scale in SCALES.items()]
    content["observables"] = [{"experiment": e, "name": o, "unit": "1", "index": "", "text": ""}
                              for e, o in {c[:2] for c in CELLS} | {("thick", "LRD")}]
    content["cells"] = KNOWN | {"thick": [["LRD", 1]]}
    content["provenance"] = {"version": "0"}
    content["simulations"] = {"made_now": 10, "from_cache": 5, "core_hours": 0.2}
    content["ledger"] = [{"experiment": "layers", "amplitudes": {"cohesion": 3e-4}, "seed": 1, "key": "k",
                          "cached": False, "core_seconds": 1., "failure": "a <particle> went wrong"}]
    return content


def make_study(folder: Path, verdict: str) -> None:
    (folder / "stages").mkdir(parents=True)
    for name, runs in make_runs().items():
        (folder / "stages" / f"{name}.json").write_text(json.dumps({"runs": runs}), encoding="utf-8")
    (folder / "discovery.json").write_text(json.dumps(make_content(verdict)), encoding="utf-8")
    (folder / "model_layers.diff").write_text("set a = 1 # before: 0\n", encoding="utf-8")
