"""A row of the table of verification, all runs of which share a process.

Usage: row.py path/to/many-runs folder row page
Exit code 77, which skips the test, if numpy is missing.
"""

from __future__ import annotations

import importlib.util
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from unittest import mock

from eunoe import commands
from many_runs import ManyRuns


def main(many_runs: str, folder: str, row: str, page: str) -> int:
    if importlib.util.find_spec("numpy") is None:
        return commands.MISSING_PACKAGE
    program = ManyRuns(many_runs, Path(folder) / "printed" / row)

    def run(command: list[str], cwd: Path, **_: object) -> subprocess.CompletedProcess:
        return program(*command[1:], cwd=cwd)

    with mock.patch("eunoe.verification.bench.subprocess", SimpleNamespace(run=run)):
        code = commands.run("verification", [many_runs, folder, "--rows", row, "--page", page])
    program.close()
    return code


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
