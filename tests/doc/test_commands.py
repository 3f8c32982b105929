"""The commands of contrib/tools: each states its usage, pages and scripts name only commands that
exist, and errors are sentences.

Usage: test_commands.py
"""

from __future__ import annotations

import ast
import re
import subprocess
import sys
import unittest
from pathlib import Path

from eunoe.commands import MODULES

ROOT = Path(__file__).resolve().parents[2]
NAMED = re.compile(r"contrib/tools +([a-z][a-z-]*)")
# Files that name commands.
PATTERNS = ("*.md", "doc/*.md", "contrib/*.sh", "contrib/slurm/*", "contrib/eunoe/**/*.py", "source/**/*.cc",
            "tests/**/CMakeLists.txt", "tests/**/*.cc", "prm/**/*.prm")


def tools(*words: str) -> tuple[int, str]:
    done = subprocess.run([sys.executable, "-B", str(ROOT / "contrib" / "tools"), *words], capture_output=True,
                          text=True, check=False)
    return done.returncode, done.stdout + done.stderr


class Commands(unittest.TestCase):
    def test_each_says_how_it_is_called(self) -> None:
        for name, module in MODULES.items():
            file = ROOT / "contrib" / "eunoe" / (module.replace(".", "/") + ".py")
            tree = ast.parse(file.read_text(encoding="utf-8"))
            self.assertIn(f"Usage: contrib/tools {name}", ast.get_docstring(tree) or "", file)
            self.assertIn("main", [node.name for node in tree.body if isinstance(node, ast.FunctionDef)], file)

    def test_only_those_that_there_are_are_named(self) -> None:
        number = 0
        for file in {file for pattern in PATTERNS for file in ROOT.glob(pattern)}:
            for name in NAMED.findall(file.read_text(encoding="utf-8")):
                number += 1
                self.assertIn(name, MODULES, file)
        self.assertGreater(number, 50)

    def test_the_list(self) -> None:
        code, text = tools()
        self.assertEqual(code, 0)
        for name in MODULES:
            self.assertIn(f"\n  {name} ", text)

    def test_what_is_not_there(self) -> None:
        self.assertEqual(tools("reprot"), (2, "There is no command 'reprot'. Did you mean 'report'?\n"))

    def test_failures_are_sentences(self) -> None:
        code, text = tools("predict-scaling")
        self.assertEqual((code, text), (1, "Name a picture (.vtu) of a run, or give --length-factor.\n"))
        self.assertEqual(tools("score", "/nowhere"), (2, "/nowhere cannot be used: No such file or directory.\n"))


if __name__ == "__main__":
    unittest.main()
