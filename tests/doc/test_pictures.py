"""contrib/tools pictures: results are not computed twice, a folder does not mix revisions, and the
pictures made are recorded. The test has its own rules and its own program, so it takes no time.

Usage: test_pictures.py
"""

from __future__ import annotations

import contextlib
import io
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

from eunoe import commands
from eunoe.pictures import make
from eunoe.pictures.record import digest, read_record
from eunoe.pictures.rules import Rule
from eunoe.repository import ROOT

RULE = Rule("rule", "nothing", {"a.png": "drawn"},
            ('bash -c "echo computed >> {folder}/runs"',), ('cp {folder}/runs {folder}/drawn',))
EMPTY = Rule("empty", "nothing", {"c.png": "drawn"}, ("true",))
BROKEN = Rule("broken", "nothing", {"b.png": "drawn"}, ('bash -c "exit 3"',))


class Pictures(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        self.make_program("abcdef012")
        patch = mock.patch.object(make, "RULES", (RULE, EMPTY, BROKEN))
        patch.start()
        self.addCleanup(patch.stop)

    def make_program(self, revision: str) -> None:
        program = self.folder / "eunoe-particles"
        program.write_text(f"#!/bin/sh\necho 'Eunoe 1 (revision {revision}, deal.II 9)'\n")
        program.chmod(0o755)

    def make(self, *names: str) -> tuple[int, str]:
        """Exit code and what went to stderr."""
        stderr = io.StringIO()
        with contextlib.redirect_stderr(stderr), contextlib.redirect_stdout(io.StringIO()):
            code = commands.run("pictures", [str(self.folder / "my work"), "--build", str(self.folder), "--pictures",
                                             str(self.folder / "pictures"), "--only", *names])
        return code, stderr.getvalue()

    def test_computes_once_and_records(self) -> None:
        for _ in range(2):
            self.assertEqual(self.make("a.png"), (0, ""))
        file = self.folder / "pictures" / "a.png"
        self.assertEqual(file.read_text(), "computed\n")
        entry = read_record(file.parent)["a.png"]
        self.assertEqual((entry.rule, entry.revision, entry.digest), ("rule", "abcdef0", digest(file)))

    def test_a_folder_has_runs_of_one_revision(self) -> None:
        self.make("rule")
        self.make_program("1234567")
        code, message = self.make("rule")
        self.assertEqual(code, 1)
        self.assertIn("holds runs of revision abcdef0, the program is of 1234567", message)

    def test_failures_are_sentences(self) -> None:
        self.assertIn("There is no rule and no picture 'd.png'", self.make("d.png")[1])
        self.assertIn("The commands of empty have not made", self.make("empty")[1])
        for _ in range(2):  # a command that failed has not computed anything
            self.assertIn("ended with exit code 3", self.make("broken")[1])
        self.make_program("unknown")
        self.assertIn("does not know its revision", self.make("rule")[1])

    def test_the_list_names_pictures_and_commands(self) -> None:
        self.assertIn("rule: nothing\n    a.png\n    $ bash", make.listing())

    def test_a_reader_may_leave(self) -> None:
        reader, writer = os.pipe()
        os.close(reader)
        with os.fdopen(writer, "w") as output:
            done = subprocess.run([sys.executable, "-B", str(ROOT / "contrib" / "tools"), "pictures", "--list"], stdout=output,
                                  stderr=subprocess.PIPE, text=True, check=False)
        self.assertEqual(done.stderr, "")


if __name__ == "__main__":
    unittest.main()
