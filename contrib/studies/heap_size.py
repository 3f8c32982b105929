#!/usr/bin/env python3
"""How the base angle of a heap depends on the size of its disc: runs the reduced heap cases with discs
of several sizes and several seeds, which draw sizes and places anew, and makes a table of what has finished.

Usage: contrib/studies/heap_size.py path/to/eunoe-particles folder [--discs 2 3] [--fill-ratios 12]
       [--sets PS1 PS2 PS3] [--seeds 1 2 3] [--ranks 1] [--table-only]

The disc and the tube have the same diameter (mm); the fill ratio is the powder over that of a heap of 37.5
degrees. A run that has finished is not run again, one that was interrupted continues from its
checkpoint. heap_size.csv in the folder has a row for each finished run, heap_size.md means and standard
deviations over the seeds, and the share of the powder that stayed on the disc: where that is close to 1, the
powder stands as a column and the angle says only how much was filled in.
"""

from __future__ import annotations

import argparse
import csv
import json
import re
import statistics
import subprocess
import sys
from dataclasses import astuple, dataclass
from pathlib import Path

CASES = Path(__file__).resolve().parents[2] / "prm" / "heap"
COLUMNS = ("heap_base_angle", "heap_base_angle_spread", "heap_height", "heap_mass_on_disc",
           "heap_mass_drained", "heap_particles_on_disc")
# Simulated at full size by Gaboriault et al. (2025); their measured angle is 37.5 degrees.
PAPER = {"PS1": 35.79, "PS2": 36.34, "PS3": 37.18}


@dataclass(frozen=True)
class Run:
    properties: str
    disc: float  # mm
    fill_ratio: float
    seed: int

    @property
    def name(self) -> str:
        return f"{self.properties}_{self.disc:g}mm_fill{self.fill_ratio:g}_seed{self.seed}"

    @classmethod
    def from_name(cls, name: str) -> Run | None:
        match = re.fullmatch(r"([^_]+)_([0-9.]+)mm_fill([0-9.]+)_seed(\d+)", name)
        return cls(match[1], float(match[2]), float(match[3]), int(match[4])) if match else None

    def command(self, program: str, folder: Path, ranks: int) -> list[str]:
        settings = {
            "heap/tube inner diameter": f"{self.disc}e-3",
            "heap/disc diameter": f"{self.disc}e-3",
            "heap/fill ratio": self.fill_ratio,
            "simulation control/output path": folder / self.name,
            "restart/restart": "auto",
            "restart/checkpoint": "true",
            "restart/wall time interval": 5,
        }
        launch = ["mpirun", "-np", str(ranks)] if ranks > 1 else []
        options = [word for entry, value in settings.items()
                   for word in ("--set", f"{entry} = {value}")]
        return [*launch, program, str(CASES / f"{self.properties}_small.prm"), "--seed", str(self.seed),
                *options]


def result(folder: Path) -> dict | None:
    """The summary of a finished run."""
    try:
        summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return summary if "heap_base_angle" in summary else None


def finished(folder: Path) -> dict[Run, dict]:
    found = {}
    for path in folder.iterdir():
        run = Run.from_name(path.name)
        summary = result(path) if run else None
        if summary:
            found[run] = summary
    return dict(sorted(found.items(), key=lambda item: astuple(item[0])))


def write_table(folder: Path, runs: dict[Run, dict]) -> None:
    with open(folder / "heap_size.csv", "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(("properties", "disc_mm", "fill_ratio", "seed", "inserted_particles", *COLUMNS))
        for run, summary in runs.items():
            table.writerow((*astuple(run), summary["inserted_particles"],
                            *(summary[column] for column in COLUMNS)))


def cell(runs: dict[Run, dict], properties: str, disc: float, fill_ratio: float) -> str:
    """Mean angle and its standard deviation over the seeds, and the mean share that stayed."""
    found = [s for run, s in runs.items()
             if (run.properties, run.disc, run.fill_ratio) == (properties, disc, fill_ratio)]
    if not found:
        return ""
    angles = [s["heap_base_angle"] for s in found]
    spread = f" ± {statistics.stdev(angles):.1f} ({len(angles)} runs)" if len(angles) > 1 else " (one run)"
    stayed = statistics.mean(s["heap_mass_on_disc"] / s["inserted_mass"] for s in found)
    return f"{statistics.mean(angles):.1f}{spread}, {100. * stayed:.0f} % stayed"


def as_markdown(runs: dict[Run, dict]) -> str:
    sets = sorted({run.properties for run in runs} | set(PAPER))
    lines = ["| disc | fill ratio | particles | " + " | ".join(sets) + " |",
             "|---|---|---|" + "---|" * len(sets)]
    for disc, fill_ratio in sorted({(run.disc, run.fill_ratio) for run in runs}):
        number = max(s["inserted_particles"] for run, s in runs.items()
                     if (run.disc, run.fill_ratio) == (disc, fill_ratio))
        cells = " | ".join(cell(runs, properties, disc, fill_ratio) for properties in sets)
        lines.append(f"| {disc:g} mm | {fill_ratio:g} | {number} | {cells} |")
    paper = " | ".join(f"{PAPER[s]:.2f}" if s in PAPER else "" for s in sets)
    lines.append(f"| 10 mm, the paper | | about 1 600 000 | {paper} |")
    return "\n".join(lines) + "\n"


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", 1)[0])
    parser.add_argument("program")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--discs", type=float, nargs="+", default=[2., 3.], help="mm")
    parser.add_argument("--fill-ratios", type=float, nargs="+", default=[12.])
    parser.add_argument("--sets", nargs="+", default=list(PAPER))
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3])
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--table-only", action="store_true", help="runs nothing")
    options = parser.parse_args(arguments)
    options.folder.mkdir(parents=True, exist_ok=True)
    wanted = [] if options.table_only else [
        Run(properties, disc, fill_ratio, seed) for disc in sorted(options.discs)
        for fill_ratio in options.fill_ratios for seed in options.seeds
        for properties in options.sets]
    failed = 0
    for run in wanted:
        if result(options.folder / run.name):
            continue
        print(run.name, flush=True)
        with open(options.folder / f"{run.name}.log", "a", encoding="utf-8") as log:
            command = run.command(options.program, options.folder, options.ranks)
            code = subprocess.run(command, stdout=log, stderr=log, check=False).returncode
        if code != 0:
            failed += 1
            print(f"{run.name} ended with exit code {code}: see {log.name}", flush=True)
        write_table(options.folder, finished(options.folder))
    runs = finished(options.folder)
    write_table(options.folder, runs)
    table = as_markdown(runs)
    (options.folder / "heap_size.md").write_text(table, encoding="utf-8")
    print(table, end="")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
