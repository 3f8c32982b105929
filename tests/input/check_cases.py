"""--check answers for every case and study that comes with the program, and for a layer of full length that
is fifty times as wide as the paper's, and says of each that it is in order. No answer is a hang.

Usage: check_cases.py path/to/eunoe-particles path/to/eunoe-discovery
"""

from __future__ import annotations

import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
# Far above what a check takes, on a busy machine, too; making the mesh of the widest case would take many minutes.
HANG = 120
# Beds that are made first by a script, and data that are measured first on a twin.
MADE_FIRST = {"column_collapse", "settled_bed", "plough", "late_pass", "study", "heap_study", "angle_only", "rolling"}
# What is meant, and is doubtful elsewhere; and what the machine decides.
MEANT = {"stacked_pair": "would be shot off."}
OF_THE_MACHINE = "Warning: Memory:"


def is_input(file: Path) -> bool:
    """Parts are included by cases, effects are patches, and a hidden truth makes data."""
    return not {"parts", "effects"} & set(file.parts) and "\nsubsection twin" not in file.read_text()


def complaint(programs: dict[bool, str], file: Path, *settings: str) -> str:
    is_study = "\nsubsection discovery" in file.read_text()
    options = [word for setting in settings for word in ("--set", setting)]
    place = f"{file.relative_to(ROOT)} {' '.join(settings)}"
    try:
        # Files that a case names are relative to the folder where the program starts.
        done = subprocess.run([programs[is_study], str(file), "--check", *options], cwd=ROOT,
                              text=True, capture_output=True, check=False, timeout=HANG)
    except subprocess.TimeoutExpired:
        return f"{place}: it hangs"
    in_order = f"The {'study' if is_study else 'case'} is in order."
    doubts = [line for line in done.stdout.splitlines() if line.startswith("Warning:")]
    strange = [line for line in doubts if not line.startswith(OF_THE_MACHINE)
               and MEANT.get(file.stem, "nothing") not in line]
    says_so = (done.stdout.splitlines() or [""])[-1] == in_order
    if done.returncode == 0 and not strange and says_so == (not doubts):
        return ""
    if file.stem in MADE_FIRST and done.returncode == 2 and "cannot be read" in done.stderr:
        return ""
    return f"{place}: exit code {done.returncode}\n{done.stdout}{done.stderr}"


def main(particles: str, discovery: str) -> int:
    programs = {False: particles, True: discovery}
    files = [file for file in sorted((ROOT / "prm").rglob("*.prm")) if is_input(file)]
    wide = (ROOT / "prm/spreading/PS1_L4.prm", "powder spreading/length factor = 1",
            "powder spreading/depth = 0.1")
    with ThreadPoolExecutor(2) as pool:
        answers = [pool.submit(complaint, programs, *case)
                   for case in [wide, *((file,) for file in files)]]
        wrong = [text for text in (answer.result() for answer in answers) if text]
    print("\n".join(wrong) if wrong else f"{len(answers)} cases are in order")
    return 1 if wrong or len(files) < 60 else 0


if __name__ == "__main__":
    sys.exit(main(*(str(Path(path).resolve()) for path in sys.argv[1:])))
