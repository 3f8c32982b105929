"""Measures what sleeping particles save over real layers: spreads 21 layers on a plate of 10 mm with sleep, then
makes the last pass again, from the moment at which the layer before it was weighed, with and without
adaptive sparse contacts.

Usage: contrib/tools late-layers folder [--program build/release/eunoe-particles] [--layers 21] [--ranks 1]
           [--spread-only] [--set ENTRY=VALUE ...]

Spreading takes long; a call that was interrupted goes on where it stopped, and calls with different programs and
entries can share the layers of a folder. The last passes are made anew by each call. Prints the speed of the
time loop of the last pass, the share of particle steps that were slept, and the ratio of the two loops.
"""

from __future__ import annotations

import argparse
import json
import re
import shutil
from pathlib import Path

from eunoe.launch import Failure, logged, mpirun, overrides, parser
from eunoe.repository import CASES
from eunoe.tables import as_text, read_rows

from .late_pass import ENABLE, row
from .programs import Eunoe, add_program

CASE = CASES / "benchmarks" / "late_layers.prm"
PASSES = {"with_sleep": [], "all_awake": [f"{ENABLE} = false"]}
EVERY = 50000  # steps between checkpoints, of which all of the last pass are kept


def start(options: argparse.Namespace, name: str, settings: dict[str, object], more: list[str]) -> dict:
    """Starts or continues a run in the folder; returns its summary."""
    folder = options.folder / name
    entries = {"simulation control/output path": folder, "powder spreading/number of layers": options.layers,
               "restart/checkpoint": "true", **settings}
    command = [*mpirun(options.ranks), Eunoe(options.program).path, str(CASE), *overrides(entries), *overrides(more)]
    if not (folder / "summary.json").exists() and logged(command, options.folder / f"{name}.log") != 0:
        raise Failure(f"The run in {folder} has not ended well: see {options.folder / name}.log.")
    return json.loads((folder / "summary.json").read_text(encoding="utf-8"))


def begin_last_pass(options: argparse.Namespace) -> Path:
    """A folder with the first checkpoint after the weighing of the last layer but one."""
    times = {row["layer"]: row["time"] for row in read_rows(options.folder / "spread" / "layers.csv")}
    time_step = json.loads((options.folder / "spread" / "summary.json").read_text(encoding="utf-8"))["time_step"]
    checkpoints = {int(re.search(r"_(\d+)\.checkpoint", file.name)[1]): file
                   for file in (options.folder / "spread").glob("*.checkpoint")}
    later = sorted(step for step in checkpoints if step * time_step >= times[options.layers - 2])
    if len(later) < 2:
        raise Failure(f"There is no checkpoint of the last pass in {options.folder / 'spread'}: spread again.")
    place = options.folder / "last_pass"
    place.mkdir(exist_ok=True)
    shutil.copy(checkpoints[later[0]], place)
    return place


def main(words: list[str]) -> int:
    arguments = parser(__doc__)
    arguments.add_argument("folder", type=Path)
    add_program(arguments)
    arguments.add_argument("--layers", type=int, default=21)
    arguments.add_argument("--ranks", type=int, default=1)
    arguments.add_argument("--spread-only", action="store_true", help="makes the layers and measures nothing")
    arguments.add_argument("--set", action="append", default=[], help="entries of the last pass")
    options = arguments.parse_args(words)
    options.folder = options.folder.resolve()
    options.folder.mkdir(parents=True, exist_ok=True)
    start(options, "spread", {"restart/restart": "auto", "restart/frequency": EVERY,
                              "restart/number of checkpoints": 20}, [])
    if options.spread_only:
        return 0
    begin = {"restart/restart": "true", "restart/restart folder": begin_last_pass(options)}
    for name in PASSES:
        shutil.rmtree(options.folder / name, ignore_errors=True)
    asleep, awake = (start(options, name, begin, [*more, *options.set]) for name, more in PASSES.items())
    print(as_text([["", "million particle-steps/s", "loop", "asleep", "search", "deciding who sleeps"],
                   row("all awake", [awake]), row("with sleep", [asleep])]))
    print(f"\nWith sleep it takes {awake['loop_seconds'] / asleep['loop_seconds']:.2f} times less.")
    return 0
