"""contrib/check_floors.py refuses a tree in which a file includes a header that does not stand
beneath it, and accepts a good one.

Usage: test_floors.py
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "contrib" / "check_floors.py"
GOOD = {"include/eunoe/core/log.h": "#include <string>\n",
        "source/core/log.cc": "#include <eunoe/core/log.h>\n",
        "source/contact/laws/hertz.cc": '#include <eunoe/core/log.h>\n#include "table.h"\n',
        "source/main.cc": "#include <eunoe/contact/laws.h>\n"}


class Floors(unittest.TestCase):
    def check(self, **more: str) -> tuple[int, str]:
        """Exit code and output for the good tree with some more in it."""
        with tempfile.TemporaryDirectory() as folder:
            for name, text in {**GOOD, **more}.items():
                file = Path(folder) / name
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_text(text)
            done = subprocess.run([sys.executable, "-B", str(SCRIPT), folder], capture_output=True, text=True,
                                  check=False)
        return done.returncode, done.stdout + done.stderr

    def assert_refused(self, name: str, text: str, sentence: str) -> None:
        code, output = self.check(**{name: text})
        self.assertEqual((code, output), (1, sentence + "\n"))

    def test_a_good_tree(self) -> None:
        self.assertEqual(self.check(), (0, "4 files include only their own folder and what stands beneath it.\n"))

    def test_upwards(self) -> None:
        self.assert_refused("source/core/units.cc", "\n#include <eunoe/contact/laws.h>\n",
                            "source/core/units.cc:2: 'core' may not include 'contact', which does not stand "
                            "beneath it.")
        self.assert_refused("include/eunoe/contact/pair.h", '#  include "eunoe/engine/store.h"\n',
                            "include/eunoe/contact/pair.h:1: 'contact' may not include 'engine', which does not "
                            "stand beneath it.")

    def test_sideways(self) -> None:
        self.assert_refused("source/observables/heap.cc", "#include <eunoe/processes/heap/heap.h>\n",
                            "source/observables/heap.cc:1: 'observables' may not include 'processes', which does "
                            "not stand beneath it.")

    def test_a_relative_path(self) -> None:
        self.assert_refused("source/core/more/units.cc", '#include "../log.h"\n',
                            "source/core/more/units.cc:1: a header that other folders use belongs into "
                            "include/eunoe.")

    def test_a_folder_that_is_unknown(self) -> None:
        self.assert_refused("source/attic/old.cc", "",
                            "source/attic/old.cc: the folder 'attic' has no floor. Give it one in "
                            "contrib/check_floors.py.")
        self.assert_refused("source/contact/new.cc", "#include <eunoe/attic/old.h>\n",
                            "source/contact/new.cc:1: there is no folder 'attic'.")

    def test_an_empty_tree(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, "-B", str(SCRIPT), folder], capture_output=True, check=False)
        self.assertEqual(done.returncode, 1)


if __name__ == "__main__":
    unittest.main()
