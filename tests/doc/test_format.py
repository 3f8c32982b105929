"""contrib/check_format.sh judges and mends the layout with clang-format 14 only.

Usage: test_format.py
"""

from __future__ import annotations

import os
import subprocess
import tempfile
import unittest
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "contrib" / "check_format.sh"
# Notes what it is asked to lay out.
CLANG_FORMAT = """#!/bin/sh
if [ "$1" = --version ]; then
  echo "Debian clang-format version {version}"
else
  echo "$@" >> "$(dirname "$0")/asked"
fi
"""


class Format(unittest.TestCase):
    def run_with(self, version: str, *options: str) -> tuple[int, str, str]:
        """Exit code, what is said, and the first words that clang-format of this version is asked with."""
        with tempfile.TemporaryDirectory() as folder:
            program, asked = Path(folder) / "clang-format", Path(folder) / "asked"
            program.write_text(CLANG_FORMAT.format(version=version))
            program.chmod(0o755)
            done = subprocess.run(["bash", str(SCRIPT), *options], capture_output=True, text=True, check=False,
                                  env={**os.environ, "PATH": f"{folder}:{os.environ['PATH']}"})
            words = asked.read_text().split() if asked.exists() else []
        return done.returncode, done.stdout + done.stderr, " ".join(words[:2])

    def test_the_version_of_the_layout(self) -> None:
        self.assertEqual(self.run_with("14.0.6"), (0, "", "--style=file --dry-run"))
        self.assertEqual(self.run_with("14.0.6", "--fix"), (0, "", "--style=file -i"))

    def test_another_version(self) -> None:
        for version in ("19.1.7 (3+b1)", "140.0.6"):
            reason = f"the layout is that of clang-format 14, and here is version {version.partition('.')[0]}.\n"
            self.assertEqual(self.run_with(version), (0, f"The layout is not checked: {reason}", ""))
            self.assertEqual(self.run_with(version, "--fix"), (1, f"Nothing is mended: {reason}", ""))


if __name__ == "__main__":
    unittest.main()
