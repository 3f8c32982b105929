"""What a packing loses when its contacts forget: runs the micro heap, the micro spreading and a pile that is
watched at rest with several intervals after which every contact loses its slip and its rolling, and several
seeds, which draw sizes and places anew, and makes a table of what has finished.

Usage: contrib/tools forgetting path/to/eunoe-particles folder [--intervals 0 100000 10000 1000 100]
       [--seeds 1 2 3 4 5] [--jobs 1] [--table-only] [--picture FILE.png]

An interval is a number of steps; 0: nothing is forgotten. A run that has finished is not run again.
forgetting.csv in the folder has a row for each finished run and observable, forgetting.md means and
standard deviations of single runs over the seeds. A mean is in bold if it differs from that of
interval 0 by more than three standard errors of the difference.
"""

from __future__ import annotations

import argparse
import csv
import math
import statistics
from dataclasses import dataclass
from pathlib import Path

from eunoe.launch import overrides
from eunoe.repository import CASES
from eunoe.tables import as_markdown, read_rows, write_csv

from .series import arguments, compute, in_errors, mean_and_spread, spread, summary_of

# Start of the interval in which the pile is watched (s), and its mean diameter (m).
WATCHED_FROM, MEAN_DIAMETER = 0.8, 1e-3


@dataclass(frozen=True)
class Experiment:
    title: str
    case: str
    observables: tuple[tuple[str, str, float, str], ...]  # observable/index, label, factor, format


SPREADING = tuple((f"{name}/{layer}", f"{name} of layer {layer}", 1., ".3f")
                  for name, layer in (("LRD", 1), ("LRD", 2), ("LRD", 3), ("CRD", 2), ("CRD", 3)))
EXPERIMENTS = {
    "heap": Experiment("Heap", "discovery/micro_heap.prm", (
        ("base_angle/0", "base angle (degrees)", 1., ".2f"),
        ("height/0", "height (um)", 1e6, ".1f"),
        ("mass_on_disc/0", "mass on the disc (mg)", 1e6, ".4f"),
        ("rest", "comes to rest at (ms)", 1e3, ".1f"))),
    "spreading": Experiment("Spreading", "discovery/micro_spreading.prm", SPREADING),
    "pile": Experiment("Pile", "verification/pile.prm", (
        ("height", "centre of mass in the end (mm)", 1e3, ".3f"),
        ("sinks", "sinks while it is watched (1/1000 diameter)", 1e3, ".3f"),
        ("speed", "rms speed in the end (um/s)", 1e6, ".3f"))),
}


def pile_at_rest(folder: Path, mass: float) -> dict[str, float]:
    rows = read_rows(folder / "energies.csv")
    heights = [row["potential"] / (9.81 * mass) for row in rows if row["time"] >= WATCHED_FROM]
    return {"height": heights[-1], "sinks": (heights[0] - heights[-1]) / MEAN_DIAMETER,
            "speed": math.sqrt(2. * rows[-1]["kinetic"] / mass)}


@dataclass(frozen=True)
class Run:
    experiment: str
    interval: int
    seed: int

    @property
    def name(self) -> str:
        return f"{self.experiment}_every{self.interval}_seed{self.seed}"

    def command(self, options: argparse.Namespace) -> list[str]:
        settings = {"model parameters/contact history/forget interval": self.interval,
                    "simulation control/output path": options.folder / self.name}
        return [options.program, str(CASES / EXPERIMENTS[self.experiment].case), "--seed", str(self.seed),
                *overrides(settings)]

    def result(self, folder: Path) -> dict[str, float] | None:
        """Values by observable and index; None if the run has not finished."""
        summary = summary_of(folder / self.name)
        if summary is None:
            return None
        try:
            if self.experiment == "pile":
                values = pile_at_rest(folder / self.name, summary["inside_mass"])
            else:
                with open(folder / self.name / "measurements.csv", encoding="utf-8") as file:
                    values = {f"{row['observable']}/{row['index']}": float(row["value"])
                              for row in csv.DictReader(file)}
        except (OSError, ValueError):
            return None
        values["steps"] = summary["steps"]
        if "heap_rest_time" in summary:
            values["rest"] = summary["heap_rest_time"]
        return values


Series = dict[tuple[str, int], list[dict[str, float]]]


def finished(folder: Path, runs: list[Run]) -> Series:
    found: Series = {}
    for run in runs:
        results = run.result(folder)
        if results:
            found.setdefault((run.experiment, run.interval), []).append(results)
    return found


def rows_of(folder: Path, runs: list[Run]) -> list[list]:
    """The rows of forgetting.csv."""
    return [["experiment", "interval", "seed", "observable", "value"],
            *([run.experiment, run.interval, run.seed, name, repr(value)] for run in runs
              for name, value in (run.result(folder) or {}).items())]


def intervals_of(series: Series, key: str) -> list[int]:
    """The intervals from the longest to the shortest; 0, without forgetting, comes first."""
    return sorted((n for name, n in series if name == key), key=lambda n: -n if n else -math.inf)


def cells_of(series: Series, key: str, interval: int) -> list[str]:
    """Means and standard deviations of the observables, in bold where forgetting changes them."""
    cells = []
    for name, _, factor, form in EXPERIMENTS[key].observables:
        values = [run[name] for run in series[key, interval]]
        base = [run[name] for run in series.get((key, 0), [])]
        text = mean_and_spread([factor * value for value in values], form, form)
        differs = interval and base and abs(in_errors(values, base)) > 3.
        cells.append(f"**{text}**" if differs else text)
    return cells


def pages_of(series: Series) -> str:
    """A table for each experiment."""
    tables = []
    for key, experiment in EXPERIMENTS.items():
        table = [[f"{experiment.title}: forgets every", "runs", "times",
                  *(label for _, label, _, _ in experiment.observables)]]
        for interval in intervals_of(series, key):
            runs = series[key, interval]
            times = statistics.mean(run["steps"] // interval for run in runs) if interval else 0
            table.append([f"{interval} steps" if interval else "never", str(len(runs)), f"{times:.0f}",
                          *cells_of(series, key, interval)])
        if len(table) > 1:
            tables.append(as_markdown(table) + "\n")
    return "\n".join(tables)


def draw(series: Series, file: Path) -> None:
    from eunoe.report import style
    from matplotlib.figure import Figure
    shown = (("heap", "base_angle/0", "(a) Base angle of the heap (degrees)"),
             ("heap", "height/0", "(b) Height of the heap (µm)"),
             ("spreading", "CRD/3", "(c) CRD of layer 3"),
             ("pile", "sinks", "(d) Sinking at rest (1/1000 diameter)"))
    figure = Figure(figsize=(style.WIDTH, 4.4), layout="constrained")
    for axes, (key, name, label) in zip(figure.subplots(2, 2).flat, shown):
        factor = next(f for n, _, f, _ in EXPERIMENTS[key].observables if n == name)
        intervals = intervals_of(series, key)
        for place, interval in enumerate(intervals):
            values = [factor * run[name] for run in series[key, interval]]
            axes.plot([place] * len(values), values, "o", color=style.PALE_BLUE, markersize=4)
            axes.errorbar(place, statistics.mean(values), spread(values), fmt="_", color=style.BLUE,
                          markersize=14, capsize=3)
        axes.set_xticks(range(len(intervals)), [f"{n:,}" if n else "never" for n in intervals])
        axes.set_title(label)
        if name == "sinks":
            axes.set_yscale("symlog", linthresh=0.1)
            axes.set_ylim(-0.02, 200.)
    figure.supxlabel("Steps after which the contacts forget", fontsize=8.5)
    figure.savefig(file, dpi=style.RESOLUTION)


def main(words: list[str]) -> int:
    parser = arguments(__doc__, [1, 2, 3, 4, 5])
    parser.add_argument("--intervals", type=int, nargs="+", default=[0, 100000, 10000, 1000, 100])
    parser.add_argument("--experiments", nargs="+", default=list(EXPERIMENTS), choices=EXPERIMENTS)
    parser.add_argument("--picture", type=Path, help="a .png to draw")
    options = parser.parse_args(words)
    runs = [Run(experiment, interval, seed) for seed in options.seeds
            for experiment in options.experiments for interval in options.intervals]
    good = compute(runs, options)
    write_csv(options.folder / "forgetting.csv", rows_of(options.folder, runs))
    series = finished(options.folder, runs)
    pages = pages_of(series)
    (options.folder / "forgetting.md").write_text(pages, encoding="utf-8")
    print(pages, end="")
    if options.picture:
        draw(series, options.picture)
    return 0 if good else 1
