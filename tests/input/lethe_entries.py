"""The program accepts every entry of Lethe: --check prints the sentences of lethe_entries.txt and
no others, and a run gives the same bits with and without the entries that it says it ignores.

Usage: lethe_entries.py path/to/eunoe-particles folder
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
SAID = re.compile(r"^Warning: lethe_entries\.prm:(\d+): (.*)$", re.MULTILINE)


def run(program: str, folder: Path, *arguments: str) -> str:
    done = subprocess.run([program, *arguments], cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"exit code {done.returncode} of {' '.join(arguments)}:\n{done.stdout}{done.stderr}")
    return done.stdout + done.stderr


def without(lines: list[str], numbers: set[int]) -> list[str]:
    """The lines of an input file without those with these numbers; without the first line of a
    subsection, the whole subsection is left out."""
    kept, depth_to_drop, depth = [], 0, 0
    for number, line in enumerate(lines, 1):
        words = line.split()
        opens, ends = words[:1] == ["subsection"], words == ["end"]
        depth += opens
        if opens and number in numbers and not depth_to_drop:
            depth_to_drop = depth
        if not depth_to_drop and number not in numbers:
            kept.append(line)
        if ends and depth == depth_to_drop:
            depth_to_drop = 0
        depth -= ends
    return kept


def main() -> int:
    program, folder = sys.argv[1], Path(sys.argv[2])
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    lines = (HERE / "lethe_entries.prm").read_text(encoding="utf-8").splitlines()
    (folder / "lethe_entries.prm").write_text("\n".join(lines) + "\n", encoding="utf-8")

    said = SAID.findall(run(program, folder, "lethe_entries.prm", "--check"))
    sentences = sorted(sentence for _, sentence in said)
    expected = sorted((HERE / "lethe_entries.txt").read_text(encoding="utf-8").splitlines())
    failures = [f"not said: {s}" for s in expected if s not in sentences]
    failures += [f"said and not expected: {s}" for s in sentences if s not in expected]

    ignored = {int(number) for number, sentence in said if sentence.endswith("It is ignored.")}
    less = without(lines, ignored)
    (folder / "less.prm").write_text("\n".join(less) + "\n", encoding="utf-8")
    if "ignored" in run(program, folder, "less.prm", "--check"):
        failures.append("less.prm, which lacks what is ignored, has something left that is")
    for name in ("lethe_entries", "less"):
        run(program, folder, f"{name}.prm", "--set", f"simulation control/output path = {name}",
            "--dump", f"{name}.dump")
    if (folder / "lethe_entries.dump").read_bytes() != (folder / "less.dump").read_bytes():
        failures.append("entries that are said to be ignored change the run")
    print("\n".join(failures))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
