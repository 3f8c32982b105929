"""What contrib/slurm/reproduction.sbatch asks of contrib/tools on a node that has Python alone."""

from __future__ import annotations

import contextlib
import io
import sys
import tempfile
import unittest

for name in ("numpy", "matplotlib", "vtkmodules"):
    sys.modules[name] = None  # an import of it fails

from eunoe import commands
from eunoe.reproduction.cases import CASES


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


if __name__ == "__main__":
    unittest.main()
