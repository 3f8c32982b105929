#!/usr/bin/python3
"""Measures what load balancing does over a spreading run: how uneven the ranks' parts are, and what
the sharing out costs.

Usage: contrib/benchmarks/balance.py [case.prm] [--program build/release/eunoe-particles] [--ranks 2]
           [--every 20000] [--cell-weights 1000,20] [--set ENTRY=VALUE ...]

The case (prm/benchmarks/two_passes.prm) runs with the methods none, frequent (every so many steps)
and dynamic; dynamic with each cell weight, of which 20 is the program's default. Pictures every so
many steps tell how many particles each rank owns. The imbalance is the largest number over the mean,
less 1; it does not depend on the machine's load, the seconds do. With more ranks than cores the
seconds tell nothing.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from pathlib import Path
from statistics import mean
from xml.etree import ElementTree

try:
    from eunoe_bench import table
    from eunoe_bench.programs import Eunoe, Failure, Run, launch
except ImportError as error:
    sys.exit(f"{error}. The benchmarks need Python 3 with numpy.")

ROOT = Path(__file__).resolve().parents[2]
SECTION = "model parameters/load balancing"
sys.path.insert(0, str(ROOT / "contrib" / "postprocessing"))
from eunoe_report.vtk_files import read_pvd  # noqa: E402


def imbalances(folder: Path, n_ranks: int) -> list[float]:
    """Of each picture of a run with particles in it."""
    result = []
    for series in folder.glob("*.pvd"):
        if series.stem.endswith(("_solids", "_layers")):
            continue
        for picture in read_pvd(series):
            pieces = ElementTree.parse(picture.file).getroot().iter("Piece")
            owned = [int(piece.get("NumberOfPoints", 0)) for piece in pieces]
            if sum(owned) > 0:
                result.append(max(owned) * n_ranks / sum(owned) - 1.)
    return result


def run(eunoe: Eunoe, options: argparse.Namespace, settings: list[str],
        folder: Path) -> tuple[Run, list[float]]:
    everything = [f"simulation control/output path = {folder / 'results'}",
                  f"simulation control/output frequency = {options.every}", *options.set, *settings]
    words = [word for setting in everything for word in ("--set", setting)]
    launch([eunoe.path, str(options.case.resolve()), "--quiet", *words], options.ranks, folder)
    summary = json.loads((folder / "results" / "summary.json").read_text(encoding="utf-8"))
    return Run(summary["particle_steps_per_second"], summary), imbalances(folder / "results",
                                                                        options.ranks)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("case", nargs="?", type=Path,
                        default=ROOT / "prm" / "benchmarks" / "two_passes.prm")
    parser.add_argument("--program", default=str(ROOT / "build/release/eunoe-particles"))
    parser.add_argument("--ranks", type=int, default=2)
    parser.add_argument("--every", type=int, default=20000)
    parser.add_argument("--cell-weights", default="1000,20")
    parser.add_argument("--set", action="append", default=[])
    options = parser.parse_args()
    eunoe = Eunoe(options.program)
    methods = [("none", [f"{SECTION}/load balance method = none"]),
               (f"frequent, {options.every} steps",
                [f"{SECTION}/load balance method = frequent", f"{SECTION}/frequency = {options.every}"])]
    methods += [(f"dynamic, cell weight {weight}",
                 [f"{SECTION}/load balance method = dynamic", f"{SECTION}/cell weight = {weight}"])
                for weight in options.cell_weights.split(",")]
    rows = [["load balancing", "ranks", "imbalance, mean", "worst", "times shared out", "searches",
             "share of search", "loop", "million particle-steps/s"]]
    for name, settings in methods:
        with tempfile.TemporaryDirectory(prefix="eunoe_balance_") as folder:
            result, values = run(eunoe, options, settings, Path(folder))
        if not values:
            raise Failure("The run left no pictures with particles. Give a smaller --every.")
        s = result.summary
        rows.append([name, str(options.ranks), f"{100. * mean(values):.0f} %",
                     f"{100. * max(values):.0f} %", str(s["load_balances"]),
                     str(s["contact_searches"]),
                     f"{100. * s['seconds_contact_search'] / s['loop_seconds']:.1f} %",
                     f"{s['loop_seconds']:.1f} s", f"{1e-6 * result.speed:.2f}"])
        print(f"  {name}", flush=True)
    print(f"\n{table.as_text(rows)}\n\n{table.as_markdown(rows)}")
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except Failure as failure:
        sys.exit(str(failure))
