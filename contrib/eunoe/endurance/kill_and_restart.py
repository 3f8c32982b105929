"""Kills a run again and again at random moments, lets it continue from its last checkpoint, and
compares the end with that of a run that was left alone: state, tables and pictures.

Usage: contrib/tools kill-and-restart build/release/eunoe-particles case.prm FOLDER
           [--kills 100] [--ranks 1,2] [--frequency 1000] [--seed 1] [--set ENTRY=VALUE ...]

Exit code 1 and a sentence if a restart failed, lost more than one interval, or ended differently.
"""

from __future__ import annotations

import contextlib
import importlib.util
import math
import os
import random
import re
import shutil
import signal
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path
from typing import IO

from eunoe.launch import SHARED, Failure, mpirun, overrides, parser_with_case, rank_numbers


class Case:
    """A case of the program, with a folder of its own."""

    def __init__(self, program: str, case: str, folder: Path, settings: list[str]) -> None:
        self.program, self.case, self.folder, self.settings = program, case, folder, settings
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        self.results = folder / "results"
        self.dump = folder / "dump"

    def command(self, ranks: int, *settings: str) -> list[str]:
        entries = (f"simulation control/output path = {self.results}", *self.settings, *settings)
        return [*mpirun(ranks, *SHARED, "--mca", "mpi_yield_when_idle", "1"), self.program, self.case, "--dump",
                str(self.dump), *overrides(entries)]

    def start(self, ranks: int, *settings: str, output: int | IO = subprocess.PIPE) -> subprocess.Popen:
        return subprocess.Popen(self.command(ranks, *settings), start_new_session=True, stdout=output,
                                stderr=subprocess.STDOUT, text=True)

    def run(self, ranks: int, *settings: str) -> None:
        process = self.start(ranks, *settings)
        with none_left(self, process):
            output = process.communicate()[0]
        if process.returncode != 0:
            raise Failure(f"The run ended with exit code {process.returncode}:\n{output}")

    def processes(self) -> list[int]:
        """Process numbers of the ranks that run the case, without the launcher."""
        found = subprocess.run(["pgrep", "-f", f"^{re.escape(self.program)} .*{re.escape(str(self.results))}( |$)"], text=True,
                               capture_output=True, check=False)
        return [int(word) for word in found.stdout.split()]

    def last_step(self) -> int:
        """The step of the newest checkpoint, 0 if there is none."""
        index = self.results / "restart.latest"
        names = index.read_text().split() if index.is_file() else []
        return int(re.search(r"_(\d+)\.", names[0]).group(1)) if names else 0


def tables_of(folder: Path) -> dict[str, str]:
    """Tables and lists of pictures, without the columns of wall-clock time."""
    found = {}
    for file in sorted([*folder.glob("*.csv"), *folder.glob("*.pvd")]):
        lines = file.read_text().splitlines()
        if lines and lines[0].endswith(",wall_seconds"):
            lines = [line.rsplit(",", 1)[0] for line in lines]
        found[file.name] = "\n".join(lines)
    return found


def pictures_of(folder: Path) -> dict[str, tuple[list[str], bytes]]:
    """What is at the points of all pictures, whatever their order. None without numpy and VTK."""
    if any(importlib.util.find_spec(name) is None for name in ("numpy", "vtkmodules")):
        return {}
    import numpy as np
    from eunoe.vtk_files import read_vtu
    found = {}
    for file in sorted(folder.glob("*.vtu")):
        fields = read_vtu(file, None)
        n_points = len(fields["points"])
        rows = np.column_stack([np.asarray(fields[name], dtype=float).reshape(n_points, -1)
                                for name in sorted(fields)]) if n_points else np.empty((0, 1))
        found[file.name] = (sorted(fields), rows[np.lexsort(rows.T)].tobytes())
    return found


def compare(reference: Case, other: Case, what: str, has_same_mesh: bool = True) -> None:
    """Failure if the results differ. Pictures of mesh cells do with another mesh."""
    if reference.dump.read_bytes() != other.dump.read_bytes():
        raise Failure(f"{what}: the final state differs from that of the run left alone.")
    for contents_of in (tables_of, pictures_of):
        files, others = contents_of(reference.results), contents_of(other.results)
        for name in sorted(files.keys() | others.keys()):
            is_of_mesh = "_cells_" in name or name.endswith("_cells.pvd")
            if files.get(name) != others.get(name) and (has_same_mesh or not is_of_mesh):
                raise Failure(f"{what}: {name} differs from that of the run left alone.")


@contextlib.contextmanager
def none_left(case: Case, process: subprocess.Popen) -> Iterator[None]:
    """Someone who interrupts this command interrupts the run, which has a session of its own."""
    try:
        yield
    except KeyboardInterrupt:
        kill_all(case, process)
        raise


def kill_all(case: Case, process: subprocess.Popen) -> None:
    """Kills the launcher and every rank. The launcher puts ranks into process groups of their own,
    so killing its group is not enough."""
    os.killpg(process.pid, signal.SIGKILL)
    while case.processes():
        for number in case.processes():
            with contextlib.suppress(ProcessLookupError):
                os.kill(number, signal.SIGKILL)
        time.sleep(0.01)
    process.wait()


def ended_before(process: subprocess.Popen, log: Path, seconds: float, counts_from_first_step: bool) -> bool:
    """Waits for the end of a run, at most for a time that begins with it or with the first step that
    it reports: how long a run takes to begin has little to do with how long its steps take."""
    while counts_from_first_step and reached_step(log.read_text()) == 0:
        if process.poll() is not None:
            return True
        time.sleep(0.01)
    try:
        process.wait(timeout=None if math.isinf(seconds) else seconds)
    except subprocess.TimeoutExpired:
        return False
    return True


def reached_step(output: str) -> int:
    """The last step that a run has reported, 0 if none."""
    steps = re.findall(r" %  step (\d+)  t = .*", output)
    return int(steps[-1]) if steps else 0


def check_loss(case: Case, output: str, before: int, frequency: int, what: str) -> int:
    """Throws if more than an interval between checkpoints was lost.

    @return number of steps lost"""
    left = case.last_step()
    if left < before:
        raise Failure(f"{what} the newest checkpoint is of step {left}, and it had been of step {before}.")
    lost = reached_step(output) - left
    if lost > frequency:
        raise Failure(f"{what} the newest checkpoint is of step {left}, and the run had come to step "
                      f"{left + lost}: more than an interval of {frequency} steps is lost.")
    return lost


def kill_and_restart(reference: Case, case: Case, ranks: list[int], kills: int,
                     frequency: int, draw: random.Random) -> tuple[int, int, int]:
    """@param reference is run here, alone
    @return number of restarts from a checkpoint, number of finished runs that were compared, and
    the most steps that a kill has cost"""
    began = time.monotonic()
    reference.run(ranks[0])
    duration = time.monotonic() - began
    checkpoints = ("restart/checkpoint = true", f"restart/frequency = {frequency}",
                   f"simulation control/log frequency = {max(1, frequency // 20)}")
    done, restarts, ends, most_lost, fresh = 0, 0, 0, 0, True
    while done < kills or not fresh:
        mode = "restart/restart = " + ("false" if fresh else "auto")
        if fresh:
            shutil.rmtree(case.results, ignore_errors=True)
            case.dump.unlink(missing_ok=True)
        before = 0 if fresh else case.last_step()
        restarts += before > 0
        log = case.folder / "log"
        with log.open("w") as file:
            process = case.start(draw.choice(ranks), *checkpoints, mode, output=file)
        seconds = math.inf if done >= kills else draw.uniform(0.1, 1.1) * duration
        with none_left(case, process):
            ended = ended_before(process, log, seconds, draw.random() < 0.5)
        if not ended:
            kill_all(case, process)
            done += 1
            most_lost = max(most_lost, check_loss(case, log.read_text(), before, frequency, f"After kill {done}"))
            fresh = False
            continue
        output = log.read_text()
        if process.returncode != 0:
            raise Failure(f"After kill {done} the run ended with exit code {process.returncode}:\n"
                          f"{output}")
        if before > 0 and f"step {before}," not in output:
            raise Failure(f"After kill {done} the run did not continue from step {before}:\n{output}")
        compare(reference, case, f"After kill {done}")
        ends += 1
        fresh = True
    return restarts, ends, most_lost


def main(words: list[str]) -> int:
    arguments = parser_with_case(__doc__)
    arguments.add_argument("--kills", type=int, default=100)
    arguments.add_argument("--ranks", default="1,2", help="numbers of ranks to draw from")
    arguments.add_argument("--frequency", type=int, default=1000, help="steps between checkpoints")
    arguments.add_argument("--seed", type=int, default=1)
    options = arguments.parse_args(words)
    ranks = rank_numbers(options.ranks)
    program = str(Path(options.program).resolve())
    folder = options.folder.resolve()
    reference = Case(program, options.case, folder / "alone", options.settings)
    killed = Case(program, options.case, folder / "killed", options.settings)
    restarts, ends, lost = kill_and_restart(reference, killed, ranks, options.kills, options.frequency,
                                            random.Random(options.seed))
    print(f"{options.kills} kills, {restarts} restarts, each from the last checkpoint; a kill cost at most "
          f"{lost} steps of an interval of {options.frequency}; {ends} runs came to their end, with the same "
          "bits.")
    return 0
