"""Whether what makes runs cheap changes a heap: runs a heap case with larger time steps, softer grains and
sleeping particles for several seeds, which draw sizes and places anew, and compares the angles.

Usage: contrib/tools cheap-heaps path/to/eunoe-particles folder [--case CASE.prm] [--variants step20 soft ...]
       [--seeds 1 2 3 4 5 6] [--jobs 1] [--table-only]

The variants are compared with `step15`, the case with a time step of 15 % of the Rayleigh time. A run that has
finished is not run again. cheap_heaps.md in the folder has the base angle and the mass on the disc of each
variant, and their differences from the reference with a 95 % interval (Welch's t).
"""

from __future__ import annotations

import argparse
import csv
import statistics
from pathlib import Path

from eunoe.intervals import difference_of
from eunoe.launch import Failure, overrides
from eunoe.powder import powder_of
from eunoe.repository import CASES
from eunoe.tables import Table

from .series import SeededVariant, arguments, compute, mean_and_spread, plus_minus, publish, summary_of

SLEEP = "model parameters/adaptive sparse contacts/enable adaptive sparse contacts"
OBSERVABLES = {"base_angle": ("base angle (degrees)", 1.), "mass_on_disc": ("mass on the disc (mg)", 1e6)}
SHARES = (15, 20, 25, 30, 40)
REFERENCE = "step15"
TITLES = {**{f"step{share}": f"{share} % of the Rayleigh time" for share in SHARES},
          "soft": "E / 10", "sleep": "with sleep"}


class Run(SeededVariant):
    def command(self, options: argparse.Namespace) -> list[str]:
        share = int(self.variant[4:]) if self.variant.startswith("step") else 15
        powder = options.powder
        settings = {**(powder.softened(0.1, share) if self.variant == "soft" else powder.step(share)),
                    "simulation control/output path": options.folder / self.name}
        if self.variant == "sleep":
            settings[SLEEP] = "true"
        return [options.program, str(options.case), "--seed", str(self.seed), *overrides(settings)]

    def result(self, folder: Path) -> dict | None:
        summary = summary_of(folder / self.name)
        if summary is None:
            return None
        with open(folder / self.name / "measurements.csv", encoding="utf-8", newline="") as file:
            values = {row["observable"]: float(row["value"]) for row in csv.DictReader(file)}
        return {**{name: values[name] for name in OBSERVABLES}, "seconds": summary["loop_seconds"]}


def table_of(found: dict[str, list[dict]]) -> Table:
    """A row for each variant with finished runs."""
    table = [["variant", "runs", *(word for title, _ in OBSERVABLES.values() for word in (title, "difference")),
              "loop (s)"]]
    for name, runs in found.items():
        cells = [TITLES[name], str(len(runs))]
        for observable, (_, unit) in OBSERVABLES.items():
            values, others = ([unit * run[observable] for run in some] for some in (runs, found[REFERENCE]))
            change = difference_of(values, others)
            cells += [mean_and_spread(values),
                      "" if name == REFERENCE else plus_minus(change.value, change.half, "+.2g")]
        table.append([*cells, f"{statistics.mean(run['seconds'] for run in runs):.1f}"])
    return table


def main(words: list[str]) -> int:
    parser = arguments(__doc__, range(1, 7))
    parser.add_argument("--case", type=Path, default=CASES / "discovery" / "micro_heap.prm")
    parser.add_argument("--variants", nargs="+", choices=TITLES, default=list(TITLES))
    options = parser.parse_args(words)
    options.powder = powder_of(options.program, options.case, [])
    names = list(dict.fromkeys((REFERENCE, *options.variants)))
    runs = [Run(name, seed) for seed in options.seeds for name in names]
    good = compute(runs, options)
    found = {name: [r for r in (run.result(options.folder) for run in runs if run.variant == name) if r]
             for name in names}
    if not found[REFERENCE]:
        raise Failure(f"A comparison needs a finished run of {REFERENCE}.")
    publish(table_of({name: results for name, results in found.items() if results}),
            options.folder / "cheap_heaps.md")
    return 0 if good else 1
