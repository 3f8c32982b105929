"""How the base angle of a heap depends on the size of its disc: runs the reduced heap cases with discs
of several sizes and several seeds, which draw sizes and places anew, and makes a table of what has finished.

Usage: contrib/tools heap-size path/to/eunoe-particles folder [--discs 2 3] [--fill-ratios 12]
       [--sets PS1 PS2 PS3] [--seeds 1 2 3] [--ranks 1] [--set ENTRY=VALUE ...] [--table-only]

The disc and the tube have the same diameter (mm); the fill ratio is the mass of the powder over
that of a heap of 37.5 degrees. A run that has finished is not run again; one that was interrupted
continues from its checkpoint. heap_size.csv in the folder has a row for each finished run.
heap_size.md has means and standard deviations over the seeds, and the share of the powder that
stayed on the disc. If that share is close to 1, the powder stands as a column, and the angle
depends only on the filling.
"""

from __future__ import annotations

import argparse
import re
import statistics
from dataclasses import astuple, dataclass
from pathlib import Path

from eunoe.launch import beside, mpirun, overrides
from eunoe.repository import CASES
from eunoe.tables import Table, write_csv

from .series import CONTINUED, arguments, compute, publish, summary_of

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

    def command(self, options: argparse.Namespace) -> list[str]:
        settings = {"heap/tube inner diameter": f"{self.disc}e-3",
                    "heap/disc diameter": f"{self.disc}e-3",
                    "heap/fill ratio": self.fill_ratio,
                    "simulation control/output path": options.folder / self.name, **CONTINUED}
        return [*mpirun(options.ranks, *beside(options.jobs)), options.program,
                str(CASES / "heap" / f"{self.properties}_small.prm"),
                "--seed", str(self.seed), *overrides(settings), *overrides(options.set)]

    def result(self, folder: Path) -> dict | None:
        """The summary of a finished run."""
        summary = summary_of(folder / self.name)
        return summary if summary and "heap_base_angle" in summary else None


def finished(folder: Path) -> dict[Run, dict]:
    """All finished runs in the folder, including those of earlier calls."""
    found = {}
    for path in folder.iterdir():
        run = Run.from_name(path.name)
        summary = run.result(folder) if run else None
        if summary:
            found[run] = summary
    return dict(sorted(found.items(), key=lambda item: astuple(item[0])))


def write_table(folder: Path) -> None:
    write_csv(folder / "heap_size.csv",
              [["properties", "disc_mm", "fill_ratio", "seed", "inserted_particles", *COLUMNS],
               *([*astuple(run), summary["inserted_particles"], *(summary[column] for column in COLUMNS)]
                 for run, summary in finished(folder).items())])


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


def table_of(runs: dict[Run, dict]) -> Table:
    sets = sorted({run.properties for run in runs} | set(PAPER))
    table = [["disc", "fill ratio", "particles", *sets]]
    for disc, fill_ratio in sorted({(run.disc, run.fill_ratio) for run in runs}):
        number = max(s["inserted_particles"] for run, s in runs.items()
                     if (run.disc, run.fill_ratio) == (disc, fill_ratio))
        table.append([f"{disc:g} mm", f"{fill_ratio:g}", str(number),
                      *(cell(runs, properties, disc, fill_ratio) for properties in sets)])
    return [*table, ["10 mm, the paper", "", "about 1 600 000",
                     *(f"{PAPER[s]:.2f}" if s in PAPER else "" for s in sets)]]


def main(words: list[str]) -> int:
    parser = arguments(__doc__, [1, 2, 3])
    parser.add_argument("--discs", type=float, nargs="+", default=[2., 3.], help="mm")
    parser.add_argument("--fill-ratios", type=float, nargs="+", default=[12.])
    parser.add_argument("--sets", nargs="+", default=list(PAPER))
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--set", action="append", default=[], metavar="ENTRY=VALUE", help="entry of all cases")
    options = parser.parse_args(words)
    wanted = [Run(properties, disc, fill_ratio, seed) for disc in sorted(options.discs)
              for fill_ratio in options.fill_ratios for seed in options.seeds
              for properties in options.sets]
    good = compute(wanted, options, after_each=lambda: write_table(options.folder))
    write_table(options.folder)
    publish(table_of(finished(options.folder)), options.folder / "heap_size.md")
    return 0 if good else 1
