"""eunoe-particles in one process for many runs (tests/many_runs.cc)."""

from __future__ import annotations

import subprocess
import threading
from pathlib import Path

from eunoe.launch import SHARED, mpirun

HANG = 120


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
        alarm = threading.Timer(HANG, self.process.kill)
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
