#!/usr/bin/python3
"""Measures what sleeping particles save: a spreader begins a pass over a thick bed at rest, with and
without adaptive sparse contacts, in turn.

Usage: contrib/benchmarks/late_pass.py [--program build/release/eunoe-particles] [--copies 4]
           [--ranks 1] [--repeats 1] [--set ENTRY=VALUE ...]

The bed is the settled one, `copies` times behind each other in x. Prints the speed of the time loop,
the share of particle steps that were slept, and the ratio of the medians.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from pathlib import Path
from statistics import median

try:
    import numpy as np
    from eunoe_bench import bed, table
    from eunoe_bench.programs import Eunoe, Failure, launch
except ImportError as error:
    sys.exit(f"{error}. The benchmarks need Python 3 with numpy.")

ROOT = Path(__file__).resolve().parents[2]
CASE = ROOT / "prm" / "benchmarks" / "late_pass.prm"
ENABLE = "model parameters/adaptive sparse contacts/enable adaptive sparse contacts"


def run(eunoe: Eunoe, options: argparse.Namespace, sleep: bool, folder: Path) -> dict:
    shift = np.array([0., bed.LENGTH, 0., 0.])
    particles = bed.read()
    bed.write_for_eunoe(folder / "bed.csv", np.concatenate(
        [particles + k * shift for k in range(options.copies)]))
    settings = [f"{ENABLE} = {'true' if sleep else 'false'}",
                f"simulation control/output path = {folder / 'results'}",
                f"insertion info/list of input files = {folder / 'bed.csv'}",
                f"mesh/grid arguments = {6 * options.copies}, 9, 1 : 0, 0, 0 : "
                f"{options.copies * bed.LENGTH}, {bed.HEIGHT}, {bed.PERIOD} : true",
                "mesh/initial refinement = 2", *options.set]
    words = [word for setting in settings for word in ("--set", setting)]
    launch([eunoe.path, str(CASE), "--quiet", *words], options.ranks, folder)
    return json.loads((folder / "results" / "summary.json").read_text(encoding="utf-8"))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=str(ROOT / "build/release/eunoe-particles"))
    parser.add_argument("--copies", type=int, default=4)
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--repeats", type=int, default=1)
    parser.add_argument("--set", action="append", default=[])
    options = parser.parse_args()
    eunoe = Eunoe(options.program)
    summaries: dict[bool, list[dict]] = {False: [], True: []}
    for _ in range(options.repeats):
        for sleep, list_ in summaries.items():
            with tempfile.TemporaryDirectory(prefix="eunoe_late_pass_") as folder:
                list_.append(run(eunoe, options, sleep, Path(folder)))
    rows = [["", "million particle-steps/s", "loop", "asleep", "search", "deciding who sleeps"]]
    for sleep, list_ in summaries.items():
        middle = sorted(list_, key=lambda s: s["loop_seconds"])[len(list_) // 2]
        share = [f"{100. * middle[key] / middle['loop_seconds']:.1f} %"
                 for key in ("seconds_contact_search", "seconds_sleep")]
        rows.append(["with sleep" if sleep else "all awake",
                     f"{1e-6 * middle['particle_steps_per_second']:.2f}",
                     f"{middle['loop_seconds']:.1f} s", f"{100. * middle['share_asleep']:.1f} %",
                     *share])
    ratio = (median(s["loop_seconds"] for s in summaries[False]) /
             median(s["loop_seconds"] for s in summaries[True]))
    print(f"{table.as_text(rows)}\n\nWith sleep it takes {ratio:.2f} times less.")
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except Failure as failure:
        sys.exit(str(failure))
