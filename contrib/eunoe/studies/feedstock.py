"""What the velocity of the feedstock platform and the depth of the feedstock bed do to the layers: spreads
small layers of the paper's powder with several of both and several seeds, and compares their densities.

Usage: contrib/tools feedstock path/to/eunoe-particles folder [--layers 3] [--seeds 1 2 3] [--jobs 1]
       [--table-only]

The apparatus is that of the micro-spreading with a plate of 1.5 mm x 0.25 mm; a stroke feeds 2.7
times what a layer takes (the paper's 5.7 times). Friction, rolling friction and cohesion are those
of property set PS1; the grains are soft as in all micro experiments. The reservoir is only 0.8 mm
long, so its walls matter far more than in the real apparatus. The depth of the bed is therefore
also varied in a reservoir of 4 mm before a plate of 4 mm, where a stroke feeds 5 times what a layer
takes. Each seed draws sizes and positions anew. A run that has finished is not run again.
feedstock.md in the folder has means and standard deviations of single runs over the seeds; in
brackets the difference from the first row of the same reservoir in its standard errors.
"""

from __future__ import annotations

import argparse
import csv
import statistics
from dataclasses import dataclass
from pathlib import Path

from eunoe.launch import Failure, overrides
from eunoe.repository import CASES
from eunoe.tables import Table

from .series import arguments, at_least, compute, in_errors, mean_and_spread, publish, summary_of

CASE = CASES / "discovery" / "micro_spreading.prm"
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
    # As in the paper's cases. With the 20 mm/s of the micro experiments a deep bed would count as
    # settled while it still collapses, and not reach the level of the transfer plate.
    SPREADING + "settled speed": 2e-3,
    SPREADING + "settling time": 0.2,
}


@dataclass(frozen=True)
class Feed:
    """How the powder is fed."""

    velocity: float  # velocity of the platform (mm/s)
    margin: float  # left in the reservoir (mm)
    reservoir: float = 0.8  # length of the reservoir (mm)

    @property
    def plate(self) -> float:
        """Length of the measuring plate (mm)."""
        return 1.5 if self.reservoir < 1. else self.reservoir

    @property
    def spreader(self) -> float:
        """Radius of the spreader (mm), which must hold the powder before it."""
        return 0.4 if self.reservoir < 1. else 1.5

    def __str__(self) -> str:
        return f"reservoir of {self.reservoir:g} mm, {self.velocity:g} mm/s, margin {self.margin:g} mm"


# The first feed, and feeds that differ from it in one property. Only 0.2 mm, three grains, are left
# below the stroke: this is cheap, and the platform has more influence than with the paper's 1 mm.
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
        return [options.program, str(CASE), "--seed", str(self.seed), *overrides(settings)]

    def result(self, folder: Path) -> dict[str, float] | None:
        """Results of a finished run: densities by layer, their mean, mass that a stroke feeds,
        cost."""
        summary = summary_of(folder / self.name)
        return densities(folder / self.name / "layers.csv", summary) if summary else None


def densities(table: Path, summary: dict) -> dict[str, float] | None:
    try:
        with open(table, newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        values = {f"LRD of layer {row['layer']}": float(row["LRD"]) for row in rows if row["LRD"]}
        # The powder that a stroke feeds stays on the plate or leaves.
        lost = sum(float(row[name]) for row in rows[1:] for name in ("mass_to_gap", "mass_to_collector"))
        fed = (float(rows[-1]["mass"]) - float(rows[0]["mass"]) + lost) / (len(rows) - 1)
    except (OSError, ValueError):
        return None
    values["mean LRD"] = statistics.mean(values.values())
    values["fed mass (ug)"] = fed * 1e9
    values["million particle-steps"] = (summary["particle_steps_per_second"]
                                        * summary["loop_seconds"] / 1e6)
    return values


def cell(values: list[float], reference: list[float]) -> str:
    """Mean, standard deviation, and the mean's difference from the reference in standard errors."""
    text = mean_and_spread(values, ".3g")
    errors = in_errors(values, reference) if reference else float("nan")
    return text if errors != errors else f"{text} ({errors:+.1f})"


def table_of(found: dict[Feed, list[dict[str, float]]]) -> Table:
    cost = "million particle-steps"
    names = [name for name in next(iter(found.values()))[0] if name != cost]
    table = [["feed", "runs", *names, cost]]
    for feed in FEEDS:
        if feed not in found:
            continue
        first = next(other for other in FEEDS if other.reservoir == feed.reservoir)
        runs, others = found[feed], found.get(first, []) if feed != first else []
        cells = [cell([run[name] for run in runs], [run[name] for run in others]) for name in names]
        table.append([str(feed), str(len(runs)), *cells, f"{statistics.mean(run[cost] for run in runs):.0f}"])
    return table


def main(words: list[str]) -> int:
    parser = arguments(__doc__, [1, 2, 3])
    parser.add_argument("--layers", type=at_least(2), default=3)
    options = parser.parse_args(words)
    runs = [Run(feed, seed) for feed in FEEDS for seed in options.seeds]
    good = compute(runs, options)
    found: dict[Feed, list[dict[str, float]]] = {}
    for run in runs:
        values = run.result(options.folder)
        if values:
            found.setdefault(run.feed, []).append(values)
    if not found:
        raise Failure("No run has finished.")
    publish(table_of(found), options.folder / "feedstock.md")
    return 0 if good else 1
