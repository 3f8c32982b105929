"""Whether what makes runs cheap changes the layers: runs a spreading case with larger time steps, softer
grains and sleeping particles for several seeds, which draw sizes and places anew, and compares.

Usage: contrib/tools cheap-layers path/to/eunoe-particles folder [--case CASE.prm] [--layers 6]
       [--variants step20 step30 soft_pull ...] [--seeds 1 2 3 4 5 6] [--jobs 1] [--ranks 1]
       [--set ENTRY=VALUE ...] [--table-only]

The variants are compared with `step15`, the case with a time step of 15 % of the Rayleigh time. A run that
has finished is not run again; one that was interrupted continues from its checkpoint. cheap_layers.csv in
the folder has the layers of each finished run, cheap_layers.md the mean over layers of each variant, its
difference from the reference with a 95 % interval (Welch's t), and the time of the loop.
"""

from __future__ import annotations

import argparse
import statistics
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from eunoe.intervals import difference_of
from eunoe.launch import Failure
from eunoe.powder import Powder, powder_of
from eunoe.repository import CASES
from eunoe.tables import Table, write_csv

from .series import (SeededVariant, arguments, at_least, compute, layers_of, mean_and_spread, mean_of_whole, plus_minus,
                     publish, spreading_command)

SLEEP = "model parameters/adaptive sparse contacts/enable adaptive sparse contacts"
REFERENCE = "step15"


@dataclass(frozen=True)
class Variant:
    """:param title: in words
    :param settings: entries of the input and their values, for the powder of the case"""

    title: str
    settings: Callable[[Powder], dict[str, str]]


def step(percent: float, title: str) -> Variant:
    return Variant(title, lambda powder: powder.step(percent))


def softer(exponent: float, title: str) -> Variant:
    """A tenth of Young's modulus, surface energy over 10^exponent, and the time step that keeps its share of the
    Rayleigh time."""
    return Variant(title, lambda powder: {**powder.softened(0.1, 15.), **powder.less_cohesive(0.1**exponent)})


VARIANTS = {
    "step15": step(15., "15 % of the Rayleigh time"),
    **{f"step{percent}": step(percent, f"{percent} %") for percent in (20, 25, 30, 40)},
    "soft_pull": softer(0., "E / 10, the same pull-off force"),
    "soft_energy": softer(0.4, "E / 10, surface energy / 10^0.4"),
    "soft_ratio": softer(1., "E / 10, surface energy / 10"),
    "sleep": Variant("with sleep", lambda powder: {**powder.step(15.), SLEEP: "true"}),
}


class Run(SeededVariant):
    def command(self, options: argparse.Namespace) -> list[str]:
        return spreading_command(options, self, self.seed, VARIANTS[self.variant].settings(options.powder))

    def result(self, folder: Path) -> dict | None:
        return layers_of(folder / self.name)


def table_of(found: dict[str, list[dict]]) -> Table:
    """A row for each variant with finished runs."""
    reference = found[REFERENCE]
    rows = [["variant", "runs", "LRD, mean of layers", "difference", "CRD, last layer", "difference", "loop (s)"]]
    for name, runs in found.items():
        cells = [VARIANTS[name].title, str(len(runs))]
        for value in (lambda run: statistics.mean(run["LRD"]), lambda run: run["CRD"][-1]):
            values, others = [value(run) for run in runs], [value(run) for run in reference]
            cells.append(mean_and_spread(values, ".4f", ".4f"))
            change = difference_of(values, others)
            cells.append("" if name == REFERENCE else plus_minus(change.value, change.half, "+.4f", ".4f"))
        rows.append([*cells, mean_of_whole(runs, "seconds", ".0f")])
    return rows


def main(words: list[str]) -> int:
    parser = arguments(__doc__, range(1, 7))
    parser.add_argument("--case", type=Path, default=CASES / "spreading" / "quickstart.prm")
    parser.add_argument("--layers", type=at_least(3), default=6)
    parser.add_argument("--variants", nargs="+", choices=VARIANTS, default=list(VARIANTS))
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--set", action="append", default=[])
    options = parser.parse_args(words)
    options.powder = powder_of(options.program, options.case, options.set)
    names = list(dict.fromkeys((REFERENCE, *options.variants)))
    runs = [Run(name, seed) for seed in options.seeds for name in names]
    good = compute(runs, options)
    done = [(run, result) for run in runs if (result := run.result(options.folder))]
    found = {name: [result for run, result in done if run.variant == name] for name in names}
    if not found[REFERENCE]:
        raise Failure(f"A comparison needs a finished run of {REFERENCE}.")
    write_csv(options.folder / "cheap_layers.csv",
              [["variant", "seed", "layer", "LRD"],
               *([run.variant, run.seed, layer, lrd] for run, result in done
                 for layer, lrd in enumerate(result["LRD"], 1))])
    publish(table_of({name: results for name, results in found.items() if results}),
            options.folder / "cheap_layers.md")
    return 0 if good else 1
