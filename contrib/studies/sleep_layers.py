#!/usr/bin/env python3
"""Whether sleeping particles change the densities of layers: runs a spreading case with and without
adaptive sparse contacts for several seeds, which draw sizes and places anew, and compares.

Usage: contrib/studies/sleep_layers.py path/to/eunoe-particles folder [--case CASE.prm] [--layers 21]
       [--seeds 1 2 3 4] [--jobs 1] [--ranks 1] [--set ENTRY=VALUE ...] [--table-only]

A run that has finished is not run again, one that was interrupted continues from its checkpoint.
sleep_layers.md in the folder has LRD and CRD of every layer, mean and standard deviation over the
seeds; then the difference of their means in standard errors. With n seeds each way a difference of no
significance exceeds 2 to 2.5 standard errors in one layer of twenty.
"""

from __future__ import annotations

import argparse
import csv
import json
import statistics
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SLEEP = "model parameters/adaptive sparse contacts"


@dataclass(frozen=True)
class Run:
    sleep: bool
    seed: int

    @property
    def name(self) -> str:
        return f"{'sleep' if self.sleep else 'awake'}_seed{self.seed}"

    def command(self, options: argparse.Namespace) -> list[str]:
        settings = [
            f"{SLEEP}/enable adaptive sparse contacts = {'true' if self.sleep else 'false'}",
            f"powder spreading/number of layers = {options.layers}",
            "powder spreading/layer pictures = false",
            f"simulation control/output path = {options.folder / self.name}",
            "restart/restart = auto", "restart/checkpoint = true", "restart/wall time interval = 5",
            *options.set]
        launch = ["mpirun", "-np", str(options.ranks)] if options.ranks > 1 else []
        return [*launch, options.program, str(options.case), "--seed", str(self.seed),
                *(word for setting in settings for word in ("--set", setting))]


def result(folder: Path) -> dict | None:
    """Layers and cost of a finished run."""
    try:
        summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
        with open(folder / "layers.csv", newline="", encoding="utf-8") as file:
            rows = [row for row in csv.DictReader(file) if int(float(row["layer"])) >= 1]
    except (OSError, ValueError):
        return None
    return {**{key: [float(row[key] or "nan") for row in rows] for key in ("LRD", "CRD")},
            "seconds": summary["loop_seconds"], "asleep": summary.get("share_asleep", 0.)}


def make(run: Run, options: argparse.Namespace) -> int:
    if result(options.folder / run.name):
        return 0
    with open(options.folder / f"{run.name}.log", "a", encoding="utf-8") as log:
        code = subprocess.run(run.command(options), stdout=log, stderr=log, check=False).returncode
    print(f"{run.name} ended with exit code {code}", flush=True)
    return code


def compared(awake: list[float], asleep: list[float]) -> tuple[str, float]:
    """Cells of a table, and the difference of the means in standard errors."""
    cells, errors = [], 0.
    for values in (awake, asleep):
        spread = statistics.stdev(values)
        errors += spread**2 / len(values)
        cells.append(f"{statistics.mean(values):.4f} ± {spread:.4f}")
    difference = statistics.mean(asleep) - statistics.mean(awake)
    in_errors = difference / errors**0.5 if errors > 0. else float("nan")
    return " | ".join(cells) + f" | {in_errors:+.1f}", in_errors


def as_markdown(awake: list[dict], asleep: list[dict]) -> str:
    lines = ["| layer | LRD awake | LRD with sleep | in standard errors | CRD awake | CRD with sleep | "
             "in standard errors |", "|---|---|---|---|---|---|---|"]
    worst = 0.
    for layer in range(len(awake[0]["LRD"])):
        columns = [f"{layer + 1}"]
        for key in ("LRD", "CRD"):
            values = [[run[key][layer] for run in runs] for runs in (awake, asleep)]
            if any(value != value for list_ in values for value in list_):  # CRD begins later
                columns.append(" | | ")
                continue
            cells, errors = compared(*values)
            columns.append(cells)
            worst = max(worst, abs(errors))
        lines.append("| " + " | ".join(columns) + " |")
    means = [[statistics.mean(run["LRD"][4:]) for run in runs] for runs in (awake, asleep)]
    cells, _ = compared(*means)
    seconds = [statistics.mean(run["seconds"] for run in runs) for runs in (awake, asleep)]
    return "\n".join([
        *lines, "", f"{len(awake)} and {len(asleep)} seeds. Largest difference: {worst:.1f} standard "
        f"errors. Mean LRD from layer 5 on (awake, with sleep, difference in standard errors): "
        f"{cells.replace(' | ', ', ')}. Loop: {seconds[0]:.0f} s awake, {seconds[1]:.0f} s with "
        f"sleep, {100. * statistics.mean(run['asleep'] for run in asleep):.0f} % of all particle "
        f"steps slept."]) + "\n"


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", 1)[0])
    parser.add_argument("program")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--case", type=Path, default=ROOT / "prm/spreading/quickstart.prm")
    parser.add_argument("--layers", type=int, default=21)
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3, 4])
    parser.add_argument("--jobs", type=int, default=1, help="runs at the same time")
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--set", action="append", default=[])
    parser.add_argument("--table-only", action="store_true", help="runs nothing")
    options = parser.parse_args(arguments)
    options.folder.mkdir(parents=True, exist_ok=True)
    runs = [Run(sleep, seed) for seed in options.seeds for sleep in (False, True)]
    failed = 0
    if not options.table_only:
        with ThreadPoolExecutor(options.jobs) as pool:
            failed = sum(code != 0 for code in pool.map(lambda run: make(run, options), runs))
    found = {sleep: [r for r in (result(options.folder / run.name) for run in runs
                                 if run.sleep == sleep) if r] for sleep in (False, True)}
    if min(map(len, found.values())) < 2:
        print("A comparison needs two finished runs each way.")
        return 1
    table = as_markdown(found[False], found[True])
    (options.folder / "sleep_layers.md").write_text(table, encoding="utf-8")
    print(table, end="")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
