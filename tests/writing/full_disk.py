"""A full disk, at the start or while a run writes tables, pictures and checkpoints: one sentence
that says what could not be written, an exit code on all ranks, and results from which the run
continues with the same bits when there is space.

A file that is a link to /dev/full cannot be written, and neither can one that reaches the limit for
the size of files; both need no special rights.

Usage: full_disk.py path/to/eunoe-particles path/to/many-runs folder
"""

from __future__ import annotations

import resource
import subprocess
import sys
import time
from pathlib import Path

from attempts import HANGING, Attempts
from eunoe.endurance.kill_and_restart import compare, kill_all
from eunoe.launch import Failure
from many_runs import QuickCase, SharedProcesses

TESTS = Path(__file__).resolve().parents[1]
STIRRED = str(TESTS / "restart" / "stirred.prm")
LAST = 3000
SETTINGS = [f"simulation control/iteration end = {LAST}", "simulation control/output frequency = 600",
            "post-processing/final state/calculation = true"]
EVERY = ("restart/checkpoint = true", "restart/frequency = 700")
FULL = "cannot be written: No space left on device"
# The file that cannot be written, and the step of the last checkpoint before that.
FILES = {
    "used.prm.new": 0, "out_00000.vtu.new": 0, "out.pvd.new": 0, "out_solids.pvd.new": 0,
    "restart_000000000700.checkpoint.new": 0, "restart.latest.new": 0,
    "out_00002.vtu.new": 700, "out_solids_00003.vtu.new": 1400, "out_cells_00003.vtu.new": 1400,
    "out_force_chains_00004.vtu.new": 2100, "restart_000000002100.checkpoint.new": 1400,
    "measurements.csv.new": LAST, "particles.csv.new": LAST, "summary.json.new": LAST,
}
SPREADING = str(TESTS / "spreading" / "tiny.prm")
# Tables whose first line cannot be written, and files of processes, with settings that spare time.
FIRST_LINES = {"energies.csv": (STIRRED,), "force_0.csv": (STIRRED,), "apparatus.json.new": (SPREADING,),
               "layers.csv": (SPREADING,),
               "heap.csv": (str(TESTS / "heap" / "tiny.prm"), "heap/number of particles = 60")}


def fails(case: QuickCase, what: str, codes: tuple[int, ...], *settings: str) -> None:
    """Runs on two ranks, which must say once that there is no space for @p what."""
    try:
        run = subprocess.run(case.command(2, *settings), text=True, check=False, capture_output=True,
                             timeout=HANGING)
    except subprocess.TimeoutExpired:
        raise Failure("it hangs") from None
    if run.returncode not in codes:
        raise Failure(f"exit code {run.returncode}\n{run.stdout}{run.stderr}")
    sentence = f"{case.results / what} {FULL}"
    if run.stderr.count(sentence) != 1:
        raise Failure(f"not one '{sentence}' in\n{run.stderr}")


def file_is_full(reference: QuickCase, folder: Path, link: str, step: int) -> None:
    case = QuickCase(reference.program, STIRRED, folder, SETTINGS)
    case.results.mkdir()
    (case.results / link).symlink_to("/dev/full")
    fails(case, link.removesuffix(".new"), (1,), *EVERY)
    if case.last_step() != step:
        raise Failure(f"the newest checkpoint is of step {case.last_step()}, not {step}")
    if list(case.results.glob("*.new")):
        raise Failure("it left a file that is not complete")
    case.run(1, *EVERY, "restart/restart = auto")
    compare(reference, case, "continued")


def first_line_fails(program: str, folder: Path, link: str, prm: str, *settings: str) -> None:
    case = QuickCase(program, prm, folder, list(settings))
    case.results.mkdir()
    (case.results / link).symlink_to("/dev/full")
    fails(case, link.removesuffix(".new"), (1, 2))


def disk_fills(program: str, folder: Path, settings: list[str]) -> None:
    """From some step on no table can grow, as files have reached the limit of their size."""
    case = QuickCase(program, STIRRED, folder, [*settings, "simulation control/output frequency = 0"])
    table = case.results / "energies.csv"
    process = case.start(2, "restart/checkpoint = true", "restart/frequency = 3000",
                         "simulation control/iteration end = 10000000")
    end = time.monotonic() + HANGING
    while case.last_step() == 0 and time.monotonic() < end:
        time.sleep(0.01)
    limit = table.stat().st_size + 100
    for number in case.processes():
        resource.prlimit(number, resource.RLIMIT_FSIZE, (limit, limit))
    try:
        output = process.communicate(timeout=HANGING)[0]
    except subprocess.TimeoutExpired:
        kill_all(case, process)
        raise Failure("it hangs") from None
    sentence = f"{table} cannot be written: File too large."
    if process.returncode != 1 or output.count(sentence) != 1:
        raise Failure(f"exit code {process.returncode}, '{sentence}' wanted in\n{output}")
    if not table.read_text().endswith("\n"):
        raise Failure("the table ends with a part of a row")
    step = case.last_step()
    last = f"simulation control/iteration end = {step + 500}"
    case.run(2, last, "restart/restart = true")
    alone = QuickCase(program, STIRRED, folder.with_name(folder.name + "_alone"), case.settings)
    alone.run(1, last)
    compare(alone, case, f"continued from step {step}")


def main(program: str, many_runs: str, folder: Path) -> int:
    QuickCase.processes_at_hand = SharedProcesses(many_runs, folder / "printed")
    reference = QuickCase(program, STIRRED, folder / "reference", SETTINGS)
    reference.run(1)
    every_step = "post-processing/energies/output frequency = 1"
    work = [(f"{link}", file_is_full, reference, folder / link, link, step)
            for link, step in FILES.items()]
    work += [(f"{link}, first line", first_line_fails, program, folder / ("first_" + link), link, *case)
             for link, case in FIRST_LINES.items()]
    work.append(("tables", disk_fills, program, folder / "tables", [every_step]))
    attempts = Attempts()
    attempts.make_at_once(work)
    return attempts.exit_code()


if __name__ == "__main__":
    sys.exit(main(str(Path(sys.argv[1]).resolve()), sys.argv[2], Path(sys.argv[3]).resolve()))
