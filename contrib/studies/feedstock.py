#!/usr/bin/env python3
"""What the velocity of the feedstock platform and the depth of the feedstock bed do to the layers: spreads
small layers of the paper's powder with several of both and several seeds, and compares their densities.

Usage: contrib/studies/feedstock.py path/to/eunoe-particles folder [--layers 3] [--seeds 1 2 3] [--jobs 1]
       [--table-only]

The apparatus is that of the micro-spreading with a plate of 1.5 mm x 0.25 mm, of which a stroke feeds 2.7 times
what a layer takes (the paper's 5.7 times); friction, rolling friction and cohesion are those of property set
PS1, the grains soft as in all micro experiments. The reservoir is only 0.8 mm long, so that its walls count
for far more than in the apparatus; so the depth of the bed is asked of a longer one, too, of 4 mm, before a
plate of 4 mm, of which a stroke feeds 5 times what a layer takes. Seeds draw sizes and places anew. A run that has finished is not run again.
feedstock.md in the folder has means and standard deviations of single runs over the seeds; in brackets the
difference from the first row of the same reservoir in its standard errors.
"""

from __future__ import annotations

import argparse
import csv
import json
import math
import statistics
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

CASE = Path(__file__).resolve().parents[2] / "prm" / "discovery" / "micro_spreading.prm"
SPREADING = "powder spreading/"
POWDER = "lagrangian physical properties/"
MODEL = "model parameters/"
PS1 = {"friction coefficient": 0.2, "rolling friction": 0.1, "surface energy": 35e-5}
SETTINGS = {
    **{f"{POWDER}particle type 0/{name} particles": value for name, value in PS1.items()},
    **{f"{POWDER}{name} wall": value for name, value in PS1.items()},
    MODEL + "particle particle contact force method": "DMT",
    MODEL + "particle wall contact force method": "DMT",
    MODEL + "contact detection/neighborhood threshold": 1.13,
    SPREADING + "depth": 0.25e-3,
    SPREADING + "feedstock bed depth": 0,
}


@dataclass(frozen=True)
class Feed:
    """How the powder is fed."""

    velocity: float  # of the platform (mm/s)
    margin: float  # left in the reservoir (mm)
    reservoir: float = 0.8  # its length (mm)

    @property
    def plate(self) -> float:
        """Length of the measuring plate (mm)."""
        return 1.5 if self.reservoir < 1. else self.reservoir

    @property
    def spreader(self) -> float:
        """Radius of the spreader (mm), for what lies before it."""
        return 0.4 if self.reservoir < 1. else 1.5

    def __str__(self) -> str:
        return f"reservoir of {self.reservoir:g} mm, {self.velocity:g} mm/s, margin {self.margin:g} mm"


# The first, and what differs from it in one thing. That 0.2 mm, three grains, are left below the stroke makes
# the platform felt more than the 1 mm of the paper's procedure, and is cheap.
FEEDS = (Feed(11., 0.2), Feed(11., 1.), Feed(2., 0.2),
         Feed(11., 1., 4.), Feed(11., 2.4, 4.))


@dataclass(frozen=True)
class Run:
    feed: Feed
    seed: int

    @property
    def name(self) -> str:
        feed = self.feed
        return f"reservoir{feed.reservoir:g}_velocity{feed.velocity:g}_margin{feed.margin:g}_seed{self.seed}"

    def command(self, options: argparse.Namespace) -> list[str]:
        settings = {**SETTINGS,
                    SPREADING + "number of layers": options.layers,
                    SPREADING + "feedstock platform velocity": f"{self.feed.velocity:g}e-3",
                    SPREADING + "feedstock margin": f"{self.feed.margin:g}e-3",
                    SPREADING + "feedstock platform length W1": f"{self.feed.reservoir:g}e-3",
                    SPREADING + "measuring plate length W3": f"{self.feed.plate:g}e-3",
                    SPREADING + "spreader radius R_s": f"{self.feed.spreader:g}e-3",
                    "simulation control/output path": options.folder / self.name}
        return [options.program, str(CASE), "--seed", str(self.seed),
                *(word for entry, value in settings.items() for word in ("--set", f"{entry} = {value}"))]


def result(folder: Path) -> dict[str, float] | None:
    """Densities by layer of a finished run, their mean, what a stroke feeds, and what the run took."""
    try:
        summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
        with open(folder / "layers.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        values = {f"LRD of layer {row['layer']}": float(row["LRD"]) for row in rows if row["LRD"]}
        # What a stroke brings: it stays on the plate, or leaves.
        lost = sum(float(row[name]) for row in rows[1:] for name in ("mass_to_gap", "mass_to_collector"))
        fed = (float(rows[-1]["mass"]) - float(rows[0]["mass"]) + lost) / (len(rows) - 1)
    except (OSError, ValueError):
        return None
    values["mean LRD"] = statistics.mean(values.values())
    values["fed mass (ug)"] = fed * 1e9
    values["million particle-steps"] = (summary["particle_steps_per_second"]
                                        * summary["loop_seconds"] / 1e6)
    return values


def make(run: Run, options: argparse.Namespace) -> int:
    if result(options.folder / run.name):
        return 0
    with open(options.folder / f"{run.name}.log", "w", encoding="utf-8") as log:
        code = subprocess.run(run.command(options), stdout=log, stderr=log, check=False).returncode
    print(f"{run.name} ended with exit code {code}", flush=True)
    return code


def spread(values: list[float]) -> float:
    return statistics.stdev(values) if len(values) > 1 else math.nan


def cell(values: list[float], reference: list[float]) -> str:
    """Mean and standard deviation, and how far the mean is from the reference's in standard errors."""
    text = f"{statistics.mean(values):.3g}" + (f" ± {spread(values):.2g}" if len(values) > 1 else "")
    error = math.hypot(*(spread(v) / math.sqrt(len(v)) for v in (values, reference))) if reference else 0.
    if error > 0.:
        text += f" ({(statistics.mean(values) - statistics.mean(reference)) / error:+.1f})"
    return text


def as_markdown(found: dict[Feed, list[dict[str, float]]]) -> str:
    cost = "million particle-steps"
    names = [name for name in next(iter(found.values()))[0] if name != cost]
    lines = ["| feed | runs | " + " | ".join(names) + f" | {cost} |", "|---|---|" + "---|" * (len(names) + 1)]
    for feed in FEEDS:
        if feed not in found:
            continue
        first = next(other for other in FEEDS if other.reservoir == feed.reservoir)
        runs, others = found[feed], found.get(first, []) if feed != first else []
        cells = [cell([run[name] for run in runs], [run[name] for run in others]) for name in names]
        lines.append(f"| {feed} | {len(runs)} | " + " | ".join(cells)
                     + f" | {statistics.mean(run[cost] for run in runs):.0f} |")
    return "\n".join(lines) + "\n"


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", 1)[0])
    parser.add_argument("program")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--layers", type=int, default=3)
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3])
    parser.add_argument("--jobs", type=int, default=1, help="runs at the same time")
    parser.add_argument("--table-only", action="store_true", help="runs nothing")
    options = parser.parse_args(arguments)
    options.folder.mkdir(parents=True, exist_ok=True)
    runs = [Run(feed, seed) for feed in FEEDS for seed in options.seeds]
    failed = 0
    if not options.table_only:
        with ThreadPoolExecutor(options.jobs) as pool:
            failed = sum(code != 0 for code in pool.map(lambda run: make(run, options), runs))
    found: dict[Feed, list[dict[str, float]]] = {}
    for run in runs:
        values = result(options.folder / run.name)
        if values:
            found.setdefault(run.feed, []).append(values)
    if not found:
        print("No run has finished.")
        return 1
    table = as_markdown(found)
    (options.folder / "feedstock.md").write_text(table, encoding="utf-8")
    print(table, end="")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
