"""The batch jobs of the campaign that reproduces the paper: what contrib/slurm/reproduction.sbatch asks of
contrib/tools on a node that has Python alone, and what it does with a run that was asked to stop."""

from __future__ import annotations

import contextlib
import io
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

for name in ("numpy", "matplotlib", "vtkmodules"):
    sys.modules[name] = None  # an import of it fails

from eunoe import commands
from eunoe.reproduction.cases import CASES
from eunoe.repository import ROOT

# Like a cluster's that kills all ranks, unless told otherwise, when the first ends with another code than 0.
SRUN = """#!/bin/sh
[ "$1 $2" = "--kill-on-bad-exit=0 --wait=60" ] || exit 137
shift 2
exec "$@"
"""
SCONTROL = """#!/bin/sh
echo "$@"
"""
STOPPED = """#!/bin/sh
exit 3
"""


def said(*words: str) -> str:
    output, errors = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(output), contextlib.redirect_stderr(errors):
        code = commands.run("reproduction", list(words))
    if code != 0:
        raise AssertionError(errors.getvalue())
    return output.getvalue()


class WithoutPackages(unittest.TestCase):
    def test_cases_are_named(self) -> None:
        self.assertEqual(said("--list").split(), [case.name for case in CASES])

    def test_the_command_of_a_case(self) -> None:
        # Nor does a program for MPI start there without the cluster's launcher.
        with tempfile.TemporaryDirectory() as folder:
            command = said("/bin/false", folder, "--only", "PS1_L1_seed1", "--command")
        self.assertIn("PS1_L1.prm --seed 1 ", command)
        self.assertEqual(command.count("\n"), 1)


class Job(unittest.TestCase):
    def test_a_run_that_was_stopped_is_queued_again(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            for name, text in (("srun", SRUN), ("scontrol", SCONTROL), ("program", STOPPED)):
                (Path(folder) / name).write_text(text)
                (Path(folder) / name).chmod(0o755)
            environment = {**os.environ, "PATH": f"{folder}:{os.environ['PATH']}", "EUNOE_PYTHON": sys.executable,
                           "EUNOE_PROGRAM": f"{folder}/program", "PYTHONDONTWRITEBYTECODE": "1",
                           "SLURM_ARRAY_JOB_ID": "7", "SLURM_ARRAY_TASK_ID": "2"}
            done = subprocess.run(["bash", "contrib/slurm/reproduction.sbatch", f"{folder}/campaign", "PS1_L1_seed1",
                                   "PS3_L1_seed1"], cwd=ROOT, env=environment, text=True, capture_output=True, check=False)
            folders = [place.name for place in (Path(folder) / "campaign").iterdir()]
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "requeue 7_2\n", ""))
        self.assertEqual(folders, ["PS3_L1_seed1"])


if __name__ == "__main__":
    unittest.main()
