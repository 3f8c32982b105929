"""Runs eunoe-discovery."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

from eunoe.launch import Failure, mpirun, output_of

STOPPED = 3


class Stopped(Exception):
    """The program was asked to stop."""


class Program:
    def __init__(self, path: Path, ranks: int) -> None:
        self.path, self.ranks = path.resolve(), ranks

    def run(self, arguments: list[str], log: Path, lock: int) -> None:
        """Runs the program with its output in a file; it holds the lock of this descriptor. Failure unless it
        succeeds."""
        with open(log, "w", encoding="utf-8") as output:
            code = subprocess.run([*mpirun(self.ranks, "--oversubscribe"), str(self.path), *arguments], stdout=output,
                                  stderr=subprocess.STDOUT, check=False, pass_fds=[lock]).returncode
        if code == STOPPED:
            raise Stopped
        if code != 0:
            raise Failure(f"{self.path.name} gave exit code {code}; see {log}.")

    def effects(self, study: Path) -> dict[str, dict]:
        """The effects of a study by name: sign and confounders, as their files state them."""
        text = output_of([str(self.path), str(study), "--list-effects"], Path.cwd())
        effects = {}
        for name, sign, confounders in re.findall(
                r"^(\S+): .*\n  amplitude: .*; sign: (\w+); confounders: (.*); process: .*$",
                text, re.MULTILINE):
            effects[name] = {"sign": sign,
                             "confounders": [] if confounders == "none" else confounders.split(", ")}
        return effects
