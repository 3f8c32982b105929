#!/usr/bin/env python3
"""What a packing loses when its contacts forget: runs the micro heap, the micro spreading and a pile that is
watched at rest with several intervals after which every contact loses its slip and its rolling, and several
seeds, which draw sizes and places anew, and makes a table of what has finished.

Usage: contrib/studies/forgetting.py path/to/eunoe-particles folder [--intervals 0 100000 10000 1000 100]
       [--seeds 1 2 3 4 5] [--jobs 1] [--table-only] [--picture FILE.png]

An interval is a number of steps; 0: nothing is forgotten. A run that has finished is not run again.
forgetting.csv in the folder has a row for each finished run and observable, forgetting.md means and
standard deviations of single runs over the seeds. A mean that lies farther from that of interval 0 than
three standard errors of the difference is in bold.
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

CASES = Path(__file__).resolve().parents[2] / "prm"
# The pile is watched from here to its end (s), in mean diameters (m).
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
    with open(folder / "energies.csv", encoding="utf-8") as file:
        rows = [{name: float(row[name]) for name in ("time", "kinetic", "potential")}
                for row in csv.DictReader(file)]
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

    def command(self, program: str, folder: Path) -> list[str]:
        experiment = EXPERIMENTS[self.experiment]
        settings = {
            "model parameters/contact history/forget interval": self.interval,
            "simulation control/output path": folder / self.name,
        }
        return [program, str(CASES / experiment.case), "--seed", str(self.seed),
                *(word for entry, value in settings.items() for word in ("--set", f"{entry} = {value}"))]

    def results(self, folder: Path) -> dict[str, float] | None:
        """Values by observable and index; None if the run has not finished."""
        try:
            summary = json.loads((folder / self.name / "summary.json").read_text(encoding="utf-8"))
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


def compute(program: str, folder: Path, run: Run) -> bool:
    if run.results(folder):
        return True
    with open(folder / f"{run.name}.log", "w", encoding="utf-8") as log:
        code = subprocess.run(run.command(program, folder), stdout=log, stderr=log,
                              check=False).returncode
    print(f"{run.name}: exit code {code}", flush=True)
    return code == 0


Series = dict[tuple[str, int], list[dict[str, float]]]


def finished(folder: Path, runs: list[Run]) -> Series:
    found: Series = {}
    for run in runs:
        results = run.results(folder)
        if results:
            found.setdefault((run.experiment, run.interval), []).append(results)
    return found


def write_csv(folder: Path, runs: list[Run]) -> None:
    with open(folder / "forgetting.csv", "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(("experiment", "interval", "seed", "observable", "value"))
        for run in runs:
            for name, value in (run.results(folder) or {}).items():
                table.writerow((run.experiment, run.interval, run.seed, name, repr(value)))


def mean_and_spread(values: list[float]) -> tuple[float, float]:
    return statistics.mean(values), statistics.stdev(values) if len(values) > 1 else math.nan


def distance(values: list[float], reference: list[float]) -> float:
    """Difference of the means over its standard error; 0 where that is not known."""
    (a, s), (b, t) = mean_and_spread(values), mean_and_spread(reference)
    error = math.sqrt(s * s / len(values) + t * t / len(reference))
    return abs(a - b) / error if error > 0. else 0.


def as_markdown(series: Series) -> str:
    lines = []
    for key, experiment in EXPERIMENTS.items():
        intervals = sorted((n for name, n in series if name == key), key=lambda n: -n if n else -math.inf)
        if not intervals:
            continue
        lines += [f"| {experiment.title}: forgets every | runs | times | "
                  + " | ".join(label for _, label, _, _ in experiment.observables) + " |",
                  "|---|---|---|" + "---|" * len(experiment.observables)]
        for interval in intervals:
            runs = series[key, interval]
            times = statistics.mean(run["steps"] // interval for run in runs) if interval else 0
            cells = []
            for name, _, factor, form in experiment.observables:
                values = [run[name] for run in runs]
                mean, spread = mean_and_spread(values)
                text = f"{factor * mean:{form}} ± {factor * spread:{form}}"
                base = [run[name] for run in series.get((key, 0), [])]
                differs = interval and base and distance(values, base) > 3.
                cells.append(f"**{text}**" if differs else text)
            steps = f"{interval} steps" if interval else "never"
            lines.append(f"| {steps} | {len(runs)} | {times:.0f} | " + " | ".join(cells) + " |")
        lines.append("")
    return "\n".join(lines)


def draw(series: Series, file: Path) -> None:
    sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "postprocessing"))
    from eunoe_report import style
    from matplotlib.figure import Figure
    shown = (("heap", "base_angle/0", "(a) Base angle of the heap (degrees)"),
             ("heap", "height/0", "(b) Height of the heap (µm)"),
             ("spreading", "CRD/3", "(c) CRD of layer 3"),
             ("pile", "sinks", "(d) Sinking at rest (1/1000 diameter)"))
    figure = Figure(figsize=(style.WIDTH, 4.4), layout="constrained")
    for axes, (key, name, label) in zip(figure.subplots(2, 2).flat, shown):
        factor = next(f for n, _, f, _ in EXPERIMENTS[key].observables if n == name)
        intervals = sorted((n for e, n in series if e == key), key=lambda n: -n if n else -math.inf)
        for place, interval in enumerate(intervals):
            values = [factor * run[name] for run in series[key, interval]]
            mean, spread = mean_and_spread(values)
            axes.plot([place] * len(values), values, "o", color=style.PALE_BLUE, markersize=4)
            axes.errorbar(place, mean, spread, fmt="_", color=style.BLUE, markersize=14, capsize=3)
        axes.set_xticks(range(len(intervals)), [f"{n:,}" if n else "never" for n in intervals])
        axes.set_title(label)
        if name == "sinks":
            axes.set_yscale("symlog", linthresh=0.1)
            axes.set_ylim(-0.02, 200.)
    figure.supxlabel("Steps after which the contacts forget", fontsize=8.5)
    figure.savefig(file, dpi=style.RESOLUTION)


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", 1)[0])
    parser.add_argument("program")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--intervals", type=int, nargs="+", default=[0, 100000, 10000, 1000, 100])
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3, 4, 5])
    parser.add_argument("--experiments", nargs="+", default=list(EXPERIMENTS), choices=EXPERIMENTS)
    parser.add_argument("--jobs", type=int, default=1, help="runs at a time")
    parser.add_argument("--table-only", action="store_true", help="runs nothing")
    parser.add_argument("--picture", type=Path, help="a .png to draw")
    options = parser.parse_args(arguments)
    options.folder.mkdir(parents=True, exist_ok=True)
    runs = [Run(experiment, interval, seed) for seed in options.seeds
            for experiment in options.experiments for interval in options.intervals]
    good = True
    if not options.table_only:
        with ThreadPoolExecutor(options.jobs) as pool:
            good = all(list(pool.map(lambda run: compute(options.program, options.folder, run), runs)))
    write_csv(options.folder, runs)
    series = finished(options.folder, runs)
    table = as_markdown(series)
    (options.folder / "forgetting.md").write_text(table, encoding="utf-8")
    print(table, end="")
    if options.picture:
        draw(series, options.picture)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
