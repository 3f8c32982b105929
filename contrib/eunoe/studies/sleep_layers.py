"""Whether sleeping particles change the densities of layers: runs a spreading case with and without
adaptive sparse contacts for several seeds, which draw sizes and places anew, and compares.

Usage: contrib/tools sleep-layers path/to/eunoe-particles folder [--case CASE.prm] [--layers 21]
       [--seeds 1 2 3 4] [--jobs 1] [--ranks 1] [--set ENTRY=VALUE ...] [--table-only]

A run that has finished is not run again; one that was interrupted continues from its checkpoint.
sleep_layers.md in the folder has LRD and CRD of every layer, mean and standard deviation over the
seeds; then the difference of their means in standard errors. With n seeds each way, chance alone
makes the difference exceed 2 to 2.5 standard errors in one layer of twenty.
"""

from __future__ import annotations

import argparse
import math
import statistics
from dataclasses import dataclass
from pathlib import Path

from eunoe.launch import Failure
from eunoe.repository import CASES
from eunoe.tables import Table

from .series import (arguments, at_least, compute, in_errors, layers_of, mean_and_spread, mean_of_whole, publish,
                     spreading_command)

SLEEP = "model parameters/adaptive sparse contacts"


@dataclass(frozen=True)
class Run:
    sleep: bool
    seed: int

    @property
    def name(self) -> str:
        return f"{'sleep' if self.sleep else 'awake'}_seed{self.seed}"

    def command(self, options: argparse.Namespace) -> list[str]:
        enable = {f"{SLEEP}/enable adaptive sparse contacts": "true" if self.sleep else "false"}
        return spreading_command(options, self, self.seed, enable)

    def result(self, folder: Path) -> dict | None:
        return layers_of(folder / self.name)


def cells_of(awake: list[float], asleep: list[float]) -> list[str]:
    """Both means with their scatter, and the difference of the means in standard errors."""
    errors = in_errors(asleep, awake)
    return [*(mean_and_spread(values, ".4f", ".4f") for values in (awake, asleep)),
            "" if math.isnan(errors) else f"{errors:+.1f}"]


def of_layer(runs: dict[bool, list[dict]], key: str, layer: int) -> list[list[float]]:
    """The values of a layer without and with sleep; none of CRD before its first layer."""
    values = [[run[key][layer] for run in runs[sleep]] for sleep in (False, True)]
    return [] if any(map(math.isnan, sum(values, []))) else values


def table_of(runs: dict[bool, list[dict]]) -> tuple[Table, float]:
    """The table of layers, and the largest difference in standard errors."""
    table = [["layer", *(head for key in ("LRD", "CRD")
                         for head in (f"{key} awake", f"{key} with sleep", "in standard errors"))]]
    worst = 0.
    for layer in range(len(runs[False][0]["LRD"])):
        row = [f"{layer + 1}"]
        for key in ("LRD", "CRD"):
            values = of_layer(runs, key, layer)
            row += cells_of(*values) if values else [""] * 3
            worst = max(worst, abs(in_errors(*values))) if values else worst
        table.append(row)
    return table, worst


def sentence(runs: dict[bool, list[dict]], worst: float) -> str:
    first = min(5, len(runs[False][0]["LRD"]))
    means = [[statistics.mean(run["LRD"][first - 1:]) for run in runs[sleep]] for sleep in (False, True)]
    seconds = [mean_of_whole(runs[sleep], "seconds", ".0f") for sleep in (False, True)]
    return (f"{len(runs[False])} and {len(runs[True])} seeds. Largest difference: {worst:.1f} standard errors. "
            f"Mean LRD from layer {first} on (awake, with sleep, difference in standard errors): "
            f"{', '.join(cells_of(*means))}. Loop (s): {seconds[0]} awake, {seconds[1]} with sleep; "
            f"{mean_of_whole(runs[True], 'asleep', '.0f', 100.)} % of all particle steps slept.")


def main(words: list[str]) -> int:
    parser = arguments(__doc__, [1, 2, 3, 4])
    parser.add_argument("--case", type=Path, default=CASES / "spreading" / "quickstart.prm")
    parser.add_argument("--layers", type=at_least(2), default=21)
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--set", action="append", default=[])
    options = parser.parse_args(words)
    runs = [Run(sleep, seed) for seed in options.seeds for sleep in (False, True)]
    good = compute(runs, options)
    found = {sleep: [r for r in (run.result(options.folder) for run in runs if run.sleep == sleep) if r]
             for sleep in (False, True)}
    if min(map(len, found.values())) < 2:
        raise Failure("A comparison needs two finished runs each way.")
    table, worst = table_of(found)
    publish(table, options.folder / "sleep_layers.md", sentence(found, worst))
    return 0 if good else 1
