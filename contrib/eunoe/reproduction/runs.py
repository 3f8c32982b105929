"""Makes the runs of the campaign. Their states lie in a folder outside the repository, one folder a case."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import cached_property
from pathlib import Path

from eunoe.benchmarks.machine import processor
from eunoe.folders import alone_with, read_json, write_whole
from eunoe.launch import Failure, beside, mpirun, output_of, overrides
from eunoe.studies.series import CONTINUED, summary_of

from .cases import Case
from .cost import cost_of

# Shares of a run between which pictures for a movie are written: a pass and a half after the tenth layer.
FILMED = (0.62, 0.7)
FILM_INTERVAL = 4e-3  # s
STOP = signal.SIGUSR1  # mpirun hands it on; after SIGTERM it would not wait for the checkpoint
NOTE = "case.json"  # the settings of a run, beside its output
LAYERS = "layers.csv"
PROCESSORS, REVISIONS = "processors.json", "revisions.json"  # on and of which it was made
UNKNOWN = "unknown"  # a revision or processor that nothing tells
STOPPED = 3  # exit code of a run that was asked to stop and has left a checkpoint


def settings_of(case: Case) -> dict[str, str]:
    """What differs from the case's input file."""
    return {name: str(value) for name, value in case.settings.items()}


class Campaign:
    """The folder of the states, and the program that makes them."""

    def __init__(self, program: str, folder: Path, ranks: int = 1, jobs: int = 1) -> None:
        self.program, self.folder, self.ranks = program, folder, ranks
        self.binding = beside(jobs)
        self.stopping = threading.Event()
        self.children: dict[str, subprocess.Popen] = {}

    @cached_property
    def revision(self) -> str:
        """Of the program; unknown where it does not start without the launcher of a batch job."""
        try:
            found = re.search(r"revision (\w+)", output_of([self.program, "--version"], Path.cwd()))
        except Failure:
            found = None
        return found[1] if found else UNKNOWN

    def of(self, case: Case) -> Path:
        """The output folder of a case."""
        return self.folder / case.name

    def command(self, case: Case) -> list[str]:
        """The command that starts a case or goes on with it."""
        settings = {**case.settings, "simulation control/output path": self.of(case), **CONTINUED}
        return [*mpirun(self.ranks, *self.binding), self.program, case.input_file, "--seed", str(case.seed),
                *overrides(settings)]

    def filmed(self, case: Case) -> list[str]:
        """Options for pictures of a pass of one run of a kind, for a movie: none of the other runs. Pictures
        change no particle's path."""
        if not case.is_seen_closely or case.seed != 1:
            return []
        try:
            cost = cost_of(self.command(case))
        except Failure:  # as for `revision`
            return []
        first, last = (share * cost.steps * cost.time_step for share in FILMED)
        return overrides({"simulation control/output control": "time",
                          "simulation control/output time": FILM_INTERVAL,
                          "simulation control/output time interval": f"{first:.4g}, {last:.4g}"})

    def is_finished(self, case: Case) -> bool:
        return summary_of(self.of(case)) is not None

    def make(self, case: Case) -> int | None:
        """Goes on with a case until it has finished. Returns its exit code; None if it had finished before or if
        another process runs it. The lock is the program's, too, so it outlives this process."""
        with alone_with(self.folder / f"{case.name}.lock") as lock:
            if lock is None:
                print(f"{case.name} runs already", flush=True)
                return None
            if self.stopping.is_set() or self.is_finished(case):
                return None
            self.note(case)
            with open(self.folder / f"{case.name}.log", "a", encoding="utf-8") as log:
                # In a session of its own, as a signal to all, such as Ctrl-C's, would let mpirun kill its ranks
                # before they have left a checkpoint.
                child = subprocess.Popen([*self.command(case), *self.filmed(case)], stdout=log, stderr=log,
                                         pass_fds=[lock], start_new_session=True)
            self.children[case.name] = child
            if self.stopping.is_set():  # since it was looked at
                child.send_signal(STOP)
            code = child.wait()
            del self.children[case.name]
        print(f"{case.name} ended with exit code {code}", flush=True)
        return code

    def note(self, case: Case) -> None:
        """Keeps with which settings, on which processors and by which programs a case runs; a program says so in the
        end, if at all. A folder of the same name with other settings, as the cases were once, is refused."""
        self.check(case)
        self.of(case).mkdir(parents=True, exist_ok=True)
        write_whole(self.of(case) / NOTE, json.dumps(settings_of(case), indent=1) + "\n")
        for name, new in ((PROCESSORS, processor()), (REVISIONS, self.revision)):
            others = [known for known in _listed(self.of(case) / name) if known != new]
            write_whole(self.of(case) / name, json.dumps([*others, new]))

    def check(self, case: Case) -> None:
        """Refuses a folder with a run of other settings."""
        folder = self.of(case)
        file = folder / NOTE
        if not file.exists() and (folder / LAYERS).exists():
            raise Failure(f"{folder} has a run, but no {NOTE} that says of which settings. Move it away.")
        if file.exists() and read_json(file) != settings_of(case):
            raise Failure(f"{folder} has a run with other settings than the case of this name: see its {NOTE}. Move it "
                          "away.")

    def stop(self, *_) -> None:
        """Asks all runs to leave a checkpoint and end; no further one starts."""
        self.stopping.set()
        for child in list(self.children.values()):
            child.send_signal(STOP)

    def work(self, cases: list[Case], jobs: int, after_each: Callable[[Case], None]) -> bool:
        """Makes the cases that have not finished, so many at a time; false if one failed."""
        before = {number: signal.signal(number, self.stop)
                  for number in (signal.SIGTERM, signal.SIGINT, signal.SIGUSR1)}
        turn = threading.Lock()

        def make(case: Case) -> bool:
            code = self.make(case)
            if code == 0:
                with turn:
                    after_each(case)
            return code in (None, 0, STOPPED)

        try:
            with ThreadPoolExecutor(jobs) as pool:
                return all(list(pool.map(make, cases)))
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)


def layers_weighed(folder: Path) -> int:
    """Number of layers that a run has weighed so far, also if it was stopped."""
    table = folder / LAYERS
    return max(0, len(table.read_text(encoding="utf-8").splitlines()) - 1) if table.exists() else 0


def _listed(file: Path) -> list[str]:
    return read_json(file) if os.path.exists(file) else []


def processor_of(folder: Path) -> str:
    """On which processors a run was made; unknown if it was not started by the campaign."""
    return ", ".join(_listed(folder / PROCESSORS)) or UNKNOWN


def revision_of(folder: Path) -> str:
    """By which program a run went on last; unknown if it was not started by the campaign."""
    return (_listed(folder / REVISIONS) or [UNKNOWN])[-1]
