"""Measures what sleeping particles save: a spreader begins a pass over a thick bed at rest, with and
without adaptive sparse contacts, in turn.

Usage: contrib/tools late-pass [--program build/release/eunoe-particles] [--copies 4] [--before 0]
           [--ranks 1] [--repeats 1] [--set ENTRY=VALUE ...]

The bed is the settled one, `copies` times behind each other in x. No particle sleeps before it has been
at rest for the rest time; in a spreading run the bed sleeps when a pass begins. With --before N the
first N steps are not timed. Prints the speed of the time loop,
the share of particle steps that were slept, and the ratio of the medians.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path
from statistics import median

import numpy as np

from eunoe.launch import parser
from eunoe.repository import CASES
from eunoe.tables import Table, as_text

from . import bed
from .programs import Eunoe, add_program

CASE = CASES / "benchmarks" / "late_pass.prm"
ENABLE = "model parameters/adaptive sparse contacts/enable adaptive sparse contacts"


def run(eunoe: Eunoe, options: argparse.Namespace, sleep: bool, folder: Path) -> dict:
    shift = np.array([0., bed.LENGTH, 0., 0.])
    particles = bed.read()
    bed.write_for_eunoe(folder / "bed.csv", np.concatenate(
        [particles + k * shift for k in range(options.copies)]))
    settings = [f"{ENABLE} = {'true' if sleep else 'false'}",
                f"insertion info/list of input files = {folder / 'bed.csv'}",
                f"mesh/grid arguments = {6 * options.copies}, 9, 1 : 0, 0, 0 : "
                f"{options.copies * bed.LENGTH}, {bed.HEIGHT}, {bed.PERIOD} : true",
                "mesh/initial refinement = 2", *options.set]
    if options.before > 0:
        settings += ["restart/checkpoint = true", "restart/restart = auto"]
        end = f"simulation control/iteration end = {options.before}"
        eunoe.compute(CASE, [*settings, end], options.ranks, folder)
    return eunoe.compute(CASE, settings, options.ranks, folder)


def row(name: str, summaries: list[dict]) -> list[str]:
    """The table's row, of the run whose loop took the median time; of an even number, the faster of
    the two in the middle."""
    middle = sorted(summaries, key=lambda s: s["loop_seconds"])[(len(summaries) - 1) // 2]
    shares = [f"{100. * middle[key] / middle['loop_seconds']:.1f} %"
              for key in ("seconds_contact_search", "seconds_sleep")]
    return [name, f"{1e-6 * middle['particle_steps_per_second']:.2f}", f"{middle['loop_seconds']:.1f} s",
            f"{100. * middle['share_asleep']:.1f} %", *shares]


def main(words: list[str]) -> int:
    arguments = parser(__doc__)
    add_program(arguments)
    arguments.add_argument("--copies", type=int, default=4)
    arguments.add_argument("--before", type=int, default=0)
    arguments.add_argument("--ranks", type=int, default=1)
    arguments.add_argument("--repeats", type=int, default=1)
    arguments.add_argument("--set", action="append", default=[])
    options = arguments.parse_args(words)
    eunoe = Eunoe(options.program)
    summaries: dict[bool, list[dict]] = {False: [], True: []}
    for _ in range(options.repeats):
        for sleep, list_ in summaries.items():
            with tempfile.TemporaryDirectory(prefix="eunoe_late_pass_") as folder:
                list_.append(run(eunoe, options, sleep, Path(folder)))
    table: Table = [["", "million particle-steps/s", "loop", "asleep", "search", "deciding who sleeps"],
                    row("all awake", summaries[False]), row("with sleep", summaries[True])]
    ratio = (median(s["loop_seconds"] for s in summaries[False]) /
             median(s["loop_seconds"] for s in summaries[True]))
    print(f"{as_text(table)}\n\nWith sleep it takes {ratio:.2f} times less.")
    return 0
