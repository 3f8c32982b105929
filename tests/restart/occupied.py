"""A second run in a folder in which one is running is refused before it touches anything; a run that was
killed keeps nobody out.

Usage: occupied.py path/to/eunoe-particles folder
"""

from __future__ import annotations

import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

from attempts import PATIENCE, Attempts
from eunoe.launch import Failure, mpirun, overrides

CASE = str(Path(__file__).with_name("endless.prm"))
LONG = "simulation control/iteration end = 1000000000"
SHORT = ("simulation control/iteration end = 20",)
# Until a run has begun.
PATIENT_SECONDS = 60 * PATIENCE


def command(program: str, results: Path, *settings: str) -> list[str]:
    entries = (f"simulation control/output path = {results}", *settings)
    return [program, CASE, *overrides(entries)]


def answer(words: list[str], code: int, *texts: str) -> None:
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode != code or any(text not in done.stdout + done.stderr for text in texts):
        raise Failure(f"exit code {done.returncode}\n{done.stdout}{done.stderr}")


def names(folder: Path) -> set[str]:
    """Of all files but those that a run still writes beside their place (new_file.h): they get another name."""
    return {path.name for path in folder.rglob("*") if path.suffix != ".new"}


class Running:
    """A run without an end, for as long as the block lasts; then it is killed."""

    def __init__(self, program: str, results: Path, *settings: str) -> None:
        self.words, self.results = command(program, results, LONG, *settings), results

    def __enter__(self) -> Running:
        self.process = subprocess.Popen(self.words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        end = time.monotonic() + PATIENT_SECONDS
        # The table comes first, the input that was used when the run begins.
        while not all((self.results / name).exists() for name in ("energies.csv", "used.prm")):
            if time.monotonic() > end or self.process.poll() is not None:
                self.process.kill()
                raise Failure("the first run does not begin")
            time.sleep(0.05)
        return self

    def __exit__(self, *_: object) -> None:
        self.process.kill()
        self.process.wait()

    def pause(self) -> None:
        """Leaves the processor to the runs that are refused, which need not wait for this one."""
        self.process.send_signal(signal.SIGSTOP)

    def must_go_on(self) -> None:
        """After a pause. It has gone on when it has written more."""
        table = self.results / "energies.csv"
        before = table.stat().st_size
        self.process.send_signal(signal.SIGCONT)
        end = time.monotonic() + PATIENT_SECONDS
        while table.stat().st_size == before:
            if time.monotonic() > end or self.process.poll() is not None:
                raise Failure("the first run does not go on")
            time.sleep(0.05)


def second_run(program: str, folder: Path) -> None:
    results = folder / "results"
    with Running(program, results) as first:
        first.pause()
        used, before = (results / "used.prm").read_bytes(), names(results)
        for ranks in (1, 2):
            answer([*mpirun(ranks), *command(program, results, *SHORT)], 2,
                   f"The folder {results} is in use by another run (process {first.process.pid} on ",
                   "choose another 'output path'.")
        # Nothing of a run that is refused is seen, and a look at a case does no harm.
        answer([*command(program, results), "--check"], 0)
        if (results / "used.prm").read_bytes() != used or not before <= names(results):
            raise Failure("the second run has changed files")
        first.must_go_on()
    if "running.lock" not in names(results):
        raise Failure("a run that is killed should leave its file behind, or this test tests nothing")
    answer(command(program, results, *SHORT, "restart/checkpoint = false"), 0, "Finished 20 steps")
    if {"running.lock", "restart.lock"} & names(results) != {"restart.lock"}:
        raise Failure(f"what is left is {names(results)}")


def place_of_checkpoints(program: str, folder: Path) -> None:
    """Two runs with folders of their own may share one for checkpoints, under different names."""
    place = folder / "checkpoints"
    with Running(program, folder / "one", f"restart/filename = {place}/same") as first:
        first.pause()
        answer(command(program, folder / "two", *SHORT, f"restart/filename = {place}/same"), 2,
               f"The place of the checkpoints {place}/same is in use by another run",
               "choose another 'filename'")
        answer(command(program, folder / "two", *SHORT, f"restart/filename = {place}/other"), 0)
        first.must_go_on()


def comes_back(program: str, folder: Path) -> None:
    """As a queue does it: the run is killed and started again at once."""
    results = folder / "results"
    frequent = ("restart/frequency = 50", "restart/restart = auto")
    with Running(program, results, *frequent):
        end = time.monotonic() + PATIENT_SECONDS
        while not (results / "restart.latest").exists() and time.monotonic() < end:
            time.sleep(0.05)
    newest = (results / "restart.latest").read_text().split()[0]
    step = int(newest.split("_")[1].split(".")[0])
    answer(command(program, results, *frequent, f"simulation control/iteration end = {step + 1000}"), 0,
           "Continuing from ")
    if {"running.lock", "restart.lock"} & names(results):
        raise Failure("files of the locks are left behind")


def main(program: str, folder: Path) -> int:
    shutil.rmtree(folder, ignore_errors=True)
    attempts = Attempts()
    attempts.make_at_once((what.__name__, what, program, folder / what.__name__)
                          for what in (second_run, place_of_checkpoints, comes_back))
    return attempts.exit_code()


if __name__ == "__main__":
    sys.exit(main(str(Path(sys.argv[1]).resolve()), Path(sys.argv[2])))
