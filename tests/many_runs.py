"""eunoe-particles in one process for many runs (tests/many_runs.cc)."""

from __future__ import annotations

import atexit
import contextlib
import itertools
import subprocess
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import ClassVar

from attempts import HANGING
from eunoe.endurance.kill_and_restart import Case
from eunoe.launch import SHARED, Failure, mpirun


class ManyRuns:
    """Replaces subprocess.run for eunoe-particles; if a run ends the process, the next starts it
    anew."""

    def __init__(self, program: str, folder: Path, n_ranks: int = 1) -> None:
        self.folder, self.n_ranks = Path(folder).resolve(), n_ranks
        self.folder.mkdir(parents=True, exist_ok=True)
        self.command = [*mpirun(n_ranks, *SHARED), str(Path(program).resolve()), str(self.folder)]
        self.process: subprocess.Popen | None = None

    def __call__(self, *words: Path | str, cwd: Path) -> subprocess.CompletedProcess:
        """The exit code, and the output of all ranks."""
        arguments = [str(word) for word in (Path(cwd).resolve(), *words)]
        for stream in ("out", "err"):
            for rank in range(self.n_ranks):
                (self.folder / f"{rank}.{stream}").write_bytes(b"")
        if self.process is None:
            self.process = subprocess.Popen(self.command, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                            text=True)
        alarm = threading.Timer(HANGING, self.process.kill)
        alarm.start()
        self.process.stdin.write("\t".join(arguments) + "\n")
        self.process.stdin.flush()
        code = self.process.stdout.readline()
        alarm.cancel()
        if not code:
            code = self.process.wait()
            self.process = None
        return subprocess.CompletedProcess(arguments, int(code), self.printed("out"), self.printed("err"))

    def printed(self, stream: str) -> str:
        return "".join((self.folder / f"{rank}.{stream}").read_text(errors="replace")
                       for rank in range(self.n_ranks))

    def close(self) -> None:
        if self.process is not None:
            self.process.stdin.close()
            self.process.wait()
            self.process = None


class SharedProcesses:
    """As many of these processes as there are runs at the same time, with the names of their files in a folder."""

    def __init__(self, program: str, folder: Path) -> None:
        self.program, self.folder = program, folder
        self.idle: list[ManyRuns] = []
        self.numbers = itertools.count()
        atexit.register(self.close)

    @contextlib.contextmanager
    def one(self) -> Iterator[ManyRuns]:
        try:
            process = self.idle.pop()
        except IndexError:
            process = ManyRuns(self.program, self.folder / str(next(self.numbers)))
        yield process
        self.idle.append(process)

    def __call__(self, *words: Path | str, cwd: Path) -> subprocess.CompletedProcess:
        with self.one() as process:
            return process(*words, cwd=cwd)

    def close(self) -> None:
        for process in self.idle:
            process.close()


class QuickCase(Case):
    """A case whose runs on one rank need no process of their own, unless they are to be stopped."""

    processes_at_hand: ClassVar[SharedProcesses]

    def answer(self, ranks: int, *settings: str) -> subprocess.CompletedProcess:
        words = self.command(ranks, *settings)
        if ranks > 1:
            return subprocess.run(words, text=True, check=False, capture_output=True)
        return self.processes_at_hand(*words[1:], cwd=self.folder)

    def run(self, ranks: int, *settings: str) -> None:
        if ranks > 1:
            super().run(ranks, *settings)
            return
        done = self.answer(ranks, *settings)
        if done.returncode != 0:
            raise Failure(f"The run ended with exit code {done.returncode}:\n{done.stdout}{done.stderr}")
