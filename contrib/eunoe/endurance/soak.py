"""Runs a small case for millions of steps and watches the memory of the program, which must not grow.

Usage: contrib/tools soak build/release/eunoe-particles case.prm FOLDER
           [--steps 5000000] [--ranks 1] [--allowed-growth 2] [--set ENTRY=VALUE ...]

The case should go on for ever: insert what leaves, search, balance, write. The run is in the subfolder `soak`,
which is emptied first. Exit code 1 and a sentence
if the run fails, or if the largest memory of its last quarter exceeds that of its second one by more
than the allowed growth (MB, all ranks together).
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import time
from pathlib import Path

from eunoe.launch import Failure, mpirun, overrides, parser_with_case


def memory_of_tree(pid: int) -> float:
    """Resident memory of a process and its descendants that run the program (MB)."""
    total, todo = 0., [pid]
    while todo:
        one = todo.pop()
        try:
            status = Path(f"/proc/{one}/status").read_text(encoding="ascii")
            children = Path(f"/proc/{one}/task/{one}/children").read_text(encoding="ascii")
        except OSError:
            continue
        if "Name:\teunoe-particles" in status and (found := re.search(r"VmRSS:\s+(\d+)", status)):
            total += int(found[1]) / 1024.
        todo += [int(child) for child in children.split()]
    return total


def watch(process: subprocess.Popen, period: float) -> list[float]:
    samples = []
    while process.poll() is None:
        samples.append(memory_of_tree(process.pid))
        time.sleep(period)
    return [sample for sample in samples if sample > 0.]


def run(command: list[str], folder: Path) -> list[float]:
    """The memory of a run (MB), twice a second."""
    log = folder / "log.txt"
    with open(log, "w", encoding="utf-8") as output, subprocess.Popen(
            command, cwd=folder, stdout=output, stderr=subprocess.STDOUT) as process:
        samples = watch(process, 0.5)
    if process.returncode != 0:
        raise Failure(f"The run ended with exit code {process.returncode}; see {log}.")
    if len(samples) < 40:
        raise Failure(f"The run gave only {len(samples)} readings of its memory: take more steps.")
    return samples


def main(words: list[str]) -> int:
    arguments = parser_with_case(__doc__)
    arguments.add_argument("--steps", type=int, default=5_000_000)
    arguments.add_argument("--ranks", type=int, default=1)
    arguments.add_argument("--allowed-growth", type=float, default=2.)
    options = arguments.parse_args(words)
    folder = options.folder / "soak"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    settings = [f"simulation control/iteration end = {options.steps}",
                "simulation control/output path = results", *options.settings]
    samples = run([*mpirun(options.ranks, "--oversubscribe"), os.path.abspath(options.program),
                   os.path.abspath(options.case), *overrides(settings)], folder)
    quarter = len(samples) // 4
    early, late = max(samples[quarter:2 * quarter]), max(samples[3 * quarter:])
    summary = json.loads((folder / "results" / "summary.json").read_text(encoding="utf-8"))
    print(f"{summary['steps']} steps, {summary['contact_searches']} searches, "
          f"{summary['inserted_particles']} particles inserted, {summary['particles']} at the end; "
          f"memory {early:.1f} MB in the second quarter, {late:.1f} MB in the last")
    if late - early > options.allowed_growth:
        raise Failure(f"The memory has grown by {late - early:.1f} MB.")
    return 0
