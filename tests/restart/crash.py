"""Checkpoints as a crash of the machine may leave them: `restart = auto` continues from the newest
intact one, with the same bits as an uninterrupted run, and says so; intact ones are kept. If none
is intact, it says so and changes nothing.

Usage: crash.py path/to/eunoe-particles path/to/many-runs folder
"""

from __future__ import annotations

import os
import re
import shutil
import signal
import sys
import time
from pathlib import Path
from typing import Callable

from attempts import HANGING, Attempts
from bad_input.forged import of_version_6
from eunoe.endurance.kill_and_restart import compare
from eunoe.launch import Failure
from many_runs import QuickCase, SharedProcesses

CASE = str(Path(__file__).with_name("stirred.prm"))
LAST = "simulation control/iteration end = 3000"
EVERY = ("restart/checkpoint = true", "restart/frequency = 700", "restart/number of checkpoints = 2")
WITHOUT = "restart/checkpoint = false"
AUTO = (*EVERY, "restart/restart = auto")
NEWEST, OLDER = "restart_000000002100.checkpoint", "restart_000000001400.checkpoint"
INDEX = "restart.latest"
Change = Callable[[Path], None]


def cut(name: str, share: float) -> Change:
    """Keeps only the first part of a file; a negative share counts bytes from the end."""
    def change(results: Path) -> None:
        data = (results / name).read_bytes()
        (results / name).write_bytes(data[:int(share) if share < 0 else int(share * len(data))])
    return change


def zero_tail(name: str, length: int) -> Change:
    """Leaves a file like a file system that had recorded its length but not written its
    contents."""
    def change(results: Path) -> None:
        data = (results / name).read_bytes()
        kept = max(0, len(data) - length)
        (results / name).write_bytes(data[:kept] + bytes(len(data) - kept))
    return change


def flip(name: str, place: int) -> Change:
    def change(results: Path) -> None:
        data = bytearray((results / name).read_bytes())
        data[place] ^= 1
        (results / name).write_bytes(data)
    return change


def write(name: str, text: bytes) -> Change:
    return lambda results: (results / name).write_bytes(text) and None


def remove(name: str) -> Change:
    return lambda results: (results / name).unlink()


def both(*changes: Change) -> Change:
    def change(results: Path) -> None:
        for each in changes:
            each(results)
    return change


INDICES = {
    "empty index": write(INDEX, b""), "missing index": remove(INDEX),
    "garbage in the index": write(INDEX, bytes(range(256))),
    "zeros in the index": write(INDEX, bytes(66)),
    "half an index": cut(INDEX, 0.4),
    "index of half a name": write(INDEX, b"restart_0000\n" + OLDER.encode() + b"\n"),
}
POINTING = {"index that names a missing file": write(INDEX, b"restart_000000009900.checkpoint\n")}
DAMAGES = {
    "missing": remove(NEWEST), "empty": cut(NEWEST, 0.), "10 bytes": write(NEWEST, b"Eunoe chec"),
    "half": cut(NEWEST, 0.5), "without its last byte": cut(NEWEST, -1),
    "without its checksum": cut(NEWEST, -8), "zeros": zero_tail(NEWEST, 1 << 40),
    "zeros behind 4096": lambda results: zero_tail(
        NEWEST, (results / NEWEST).stat().st_size - 4096)(results),
    "zeros at the end": zero_tail(NEWEST, 512), "one bit of the title": flip(NEWEST, 3),
    "one bit of the version": flip(NEWEST, 17), "one bit of the head": flip(NEWEST, 300),
    "one bit of the particles": flip(NEWEST, -3000), "one bit of the checksum": flip(NEWEST, -1),
    "one bit of the checksums of chunks": flip(NEWEST, -10),
}
HOPELESS = {
    "both cut short": both(cut(NEWEST, 0.5), cut(OLDER, -1)),
    "both cut short, index missing": both(cut(NEWEST, 0.5), cut(OLDER, -1), remove(INDEX)),
    "both empty": both(cut(NEWEST, 0.), cut(OLDER, 0.)),
    "both missing": both(remove(NEWEST), remove(OLDER)),
    "both missing, index empty": both(remove(NEWEST), remove(OLDER), write(INDEX, b"")),
}


def crashed(stopped: QuickCase, folder: Path, change: Change) -> QuickCase:
    case = QuickCase(stopped.program, CASE, folder, [])
    shutil.copytree(stopped.results, case.results)
    change(case.results)
    return case


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def goes_on(reference: QuickCase, stopped: QuickCase, folder: Path, change: Change, ranks: int, step: int) -> None:
    case = crashed(stopped, folder, change)
    # Until the first new checkpoint is complete, the intact old ones must stay.
    before = contents(case.results)
    short = case.answer(ranks, *AUTO, WITHOUT, "simulation control/iteration end = 2110")
    if short.returncode != 0:
        raise Failure(f"exit code {short.returncode}\n{short.stdout}{short.stderr}")
    if f"Continuing from {case.results / f'restart_{step:012}.checkpoint'}: step {step}," not in short.stdout:
        raise Failure(f"it did not continue from step {step}:\n{short.stdout}")
    said = re.search(r"Warning: The newest checkpoint that is whole is .*"
                     rf"{step:012}\.checkpoint, written on \d{{4}}-\d\d-\d\d \d\d:", short.stdout)
    if not said:
        raise Failure(f"it does not say so:\n{short.stdout}")
    if contents(case.results).get(OLDER) != before[OLDER]:
        raise Failure("a good checkpoint is gone")
    case.run(ranks, *AUTO, LAST)
    compare(reference, case, "continued")


def older_format(reference: QuickCase, stopped: QuickCase, folder: Path, ranks: int) -> None:
    """A run continues with the same bits from checkpoints of the version before."""
    def change(results: Path) -> None:
        for name in (NEWEST, OLDER):
            (results / name).write_bytes(of_version_6((results / name).read_bytes()))
    case = crashed(stopped, folder, change)
    run = case.answer(ranks, *AUTO, LAST)
    if run.returncode != 0 or f"Continuing from {case.results / NEWEST}: step 2100," not in run.stdout:
        raise Failure(f"exit code {run.returncode}\n{run.stdout}{run.stderr}")
    compare(reference, case, "continued")


def stays_as_it_is(stopped: QuickCase, folder: Path, change: Change, ranks: int) -> None:
    case = crashed(stopped, folder, change)
    before = contents(case.results)
    run = case.answer(ranks, *AUTO, LAST)
    if run.returncode != 2 or run.stderr.count("that is whole, and nothing in it was touched.") != 1:
        raise Failure(f"exit code {run.returncode}\n{run.stdout}{run.stderr}")
    if contents(case.results) != before:
        raise Failure("files were changed")


def spoilt_table(stopped: QuickCase, folder: Path, change: Change, sentence: str) -> None:
    case = crashed(stopped, folder, change)
    run = case.answer(1, *AUTO, LAST)
    sentence = f"{case.results / 'energies.csv'} cannot be continued: {sentence}"
    if run.returncode != 2 or run.stderr.count(sentence) != 1 or "Put it back as it was" not in run.stderr:
        raise Failure(f"exit code {run.returncode}\n{run.stdout}{run.stderr}")
    if not (case.results / NEWEST).is_file() or not (case.results / OLDER).is_file():
        raise Failure("a good checkpoint is gone")


def begun_anew(stopped: QuickCase, folder: Path) -> None:
    """A run that began anew and was killed before its first checkpoint is not continued from those of the run
    before it, which stay until it has one of its own."""
    case = crashed(stopped, folder, lambda results: None)
    # Tables would tell the two runs apart.
    quiet = ("post-processing/energies/calculation = false", "post-processing/solid forces/calculation = false",
             "boundary forces/calculation = false", "simulation control/output frequency = 0")
    seldom = ("restart/checkpoint = true", "restart/frequency = 0", "simulation control/iteration end = 10000000")
    process = case.start(1, *seldom, *quiet)
    deadline = time.monotonic() + HANGING
    while b"begun anew" not in (case.results / INDEX).read_bytes():
        if process.poll() is not None or time.monotonic() > deadline:
            raise Failure("it does not say that it began anew")
        time.sleep(0.02)
    for rank in case.processes():
        os.kill(rank, signal.SIGKILL)
    process.communicate()

    def answer(code: int, sentence: str, *settings: str) -> None:
        run = case.answer(1, *quiet, *settings)
        if run.returncode != code or sentence not in run.stdout + run.stderr:
            raise Failure(f"exit code {run.returncode}\n{run.stdout}{run.stderr}")

    end = "simulation control/iteration end = "
    # Nor from those of a run beside it.
    shutil.copytree(stopped.results, case.folder / "beside")
    answer(2, "was stopped before its first checkpoint.", "restart/restart = true", LAST)
    shutil.rmtree(case.folder / "beside")
    for name in (NEWEST, OLDER):
        if (case.results / name).read_bytes() != (stopped.results / name).read_bytes():
            raise Failure("a checkpoint of the run before is gone")
    answer(0, "Finished 100 steps", *AUTO, WITHOUT, end + "100")
    answer(0, "Finished 200 steps", *AUTO, *EVERY, "restart/frequency = 150", end + "200")
    answer(0, "Continuing from " + str(case.results / "restart_000000000200.checkpoint"), *AUTO, *EVERY,
           "restart/frequency = 150", end + "300")
    if (case.results / NEWEST).exists():
        raise Failure("the checkpoints of the run before are still there")


def main(program: str, many_runs: str, folder: Path) -> int:
    QuickCase.processes_at_hand = SharedProcesses(many_runs, folder / "printed")
    reference = QuickCase(program, CASE, folder / "reference", [LAST])
    reference.run(1)
    stopped = QuickCase(program, CASE, folder / "stopped", [])
    stopped.run(1, *EVERY, "restart/number of checkpoints = 3", "simulation control/iteration end = 2200")
    # As it was before the checkpoint of its end.
    (stopped.results / "restart_000000002200.checkpoint").unlink()
    (stopped.results / INDEX).write_text(f"{NEWEST}\n{OLDER}\n", encoding="utf-8")
    work = []
    for number, (name, change) in enumerate((INDICES | POINTING).items()):
        work.append((name, goes_on, reference, stopped, folder / name, change, 2 if number % 4 == 1 else 1, 2100))
    for number, (name, change) in enumerate(DAMAGES.items()):
        work.append((name, goes_on, reference, stopped, folder / name, change, 2 if number % 4 == 1 else 1, 1400))
    for index, damage in (("missing index", "half"), ("garbage in the index", "zeros at the end"),
                          ("empty index", "one bit of the head")):
        name = f"{index}, {damage}"
        work.append((name, goes_on, reference, stopped, folder / name,
                     both(INDICES[index], DAMAGES[damage]), 1, 1400))
    for number, (name, change) in enumerate(HOPELESS.items()):
        work.append((name, stays_as_it_is, stopped, folder / name, change, 2 if number % 4 == 1 else 1))
    table = "energies.csv"
    work += [("shorter table", spoilt_table, stopped, folder / "shorter", cut(table, 0.5),
              "it has "),
             ("missing table", spoilt_table, stopped, folder / "gone", remove(table), "No such file"),
             ("edited table", spoilt_table, stopped, folder / "edited",
              lambda results: write(table, b"x" + (results / table).read_bytes())(results),
              "no row ends after its first ")]
    work.append(("begun anew", begun_anew, stopped, folder / "anew"))
    work += [(f"version 6, {ranks} ranks", older_format, reference, stopped, folder / f"version_6_{ranks}", ranks)
             for ranks in (1, 2)]
    attempts = Attempts()
    attempts.make_at_once(work)
    return attempts.exit_code()


if __name__ == "__main__":
    sys.exit(main(str(Path(sys.argv[1]).resolve()), sys.argv[2], Path(sys.argv[3]).resolve()))
