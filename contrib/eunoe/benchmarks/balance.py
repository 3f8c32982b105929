"""Measures what load balancing does over a spreading run: how uneven the ranks' parts are, and what
the sharing out costs.

Usage: contrib/tools balance [case.prm] [--program build/release/eunoe-particles] [--ranks 2]
           [--every 20000] [--cell-weights 1000,20] [--set ENTRY=VALUE ...]

The case (prm/benchmarks/two_passes.prm) runs with the methods none, frequent (every --every steps)
and dynamic, the latter with each cell weight; 20 is the program's default. Pictures, also every
--every steps, show how many particles each rank owns. The imbalance is the largest number over the
mean, less 1. It does not depend on the machine's load, but the seconds do; with more ranks than
cores they mean nothing.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path
from statistics import mean

from eunoe.launch import Failure, parser
from eunoe.repository import CASES
from eunoe.tables import Table, as_markdown, as_text
from eunoe.vtk_files import points_of_pieces, read_pvd

from .programs import Eunoe, add_program

SECTION = "model parameters/load balancing"
HEAD = ["load balancing", "ranks", "imbalance, mean", "worst", "times shared out", "searches", "share of search",
        "loop", "million particle-steps/s"]


def imbalances(folder: Path, n_ranks: int) -> list[float]:
    """The imbalance in each picture of a run that has particles in it."""
    result = []
    # Other pictures, of cells, contacts or layers, are beside those of the particles, whose name they begin with.
    for series in sorted(folder.glob("*.pvd"), key=lambda path: len(path.stem))[:1]:
        for picture in read_pvd(series):
            owned = points_of_pieces(picture.file)
            if sum(owned) > 0:
                result.append(max(owned) * n_ranks / sum(owned) - 1.)
    return result


def methods(options: argparse.Namespace) -> dict[str, list[str]]:
    """The settings of each way of balancing, by its name."""
    every = options.every
    found = {"none": [f"{SECTION}/load balance method = none"],
             f"frequent, {every} steps": [f"{SECTION}/load balance method = frequent",
                                          f"{SECTION}/frequency = {every}"]}
    for weight in options.cell_weights.split(","):
        found[f"dynamic, cell weight {weight}"] = [f"{SECTION}/load balance method = dynamic",
                                                   f"{SECTION}/cell weight = {weight}"]
    return found


def row(name: str, ranks: int, summary: dict, values: list[float]) -> list[str]:
    if not values:
        raise Failure("The run left no pictures with particles. Give a smaller --every.")
    return [name, str(ranks), f"{100. * mean(values):.0f} %", f"{100. * max(values):.0f} %",
            str(summary["load_balances"]), str(summary["contact_searches"]),
            f"{100. * summary['seconds_contact_search'] / summary['loop_seconds']:.1f} %",
            f"{summary['loop_seconds']:.1f} s", f"{1e-6 * summary['particle_steps_per_second']:.2f}"]


def main(words: list[str]) -> int:
    arguments = parser(__doc__)
    arguments.add_argument("case", nargs="?", type=Path, default=CASES / "benchmarks" / "two_passes.prm")
    add_program(arguments)
    arguments.add_argument("--ranks", type=int, default=2)
    arguments.add_argument("--every", type=int, default=20000)
    arguments.add_argument("--cell-weights", default="1000,20")
    arguments.add_argument("--set", action="append", default=[])
    options = arguments.parse_args(words)
    eunoe = Eunoe(options.program)
    table: Table = [HEAD]
    for name, settings in methods(options).items():
        with tempfile.TemporaryDirectory(prefix="eunoe_balance_") as folder:
            summary = eunoe.compute(options.case.resolve(),
                                    [f"simulation control/output frequency = {options.every}", *options.set,
                                     *settings], options.ranks, Path(folder))
            table.append(row(name, options.ranks, summary,
                             imbalances(Path(folder) / "results", options.ranks)))
        print(f"  {name}", flush=True)
    print(f"\n{as_text(table)}\n\n{as_markdown(table)}")
    return 0
