"""A run gives the same bits whatever instruction set its kernels are compiled for.

Usage: instruction_sets.py folder path/to/eunoe-particles path/to/other/program ...
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

CASE = Path(__file__).parents[1] / "restart" / "stirred.prm"
STEPS = "simulation control/iteration end = 8000"


def state_after_run(program: str, folder: Path) -> bytes:
    dump = folder / Path(program).name
    subprocess.run([program, CASE, "--quiet", "--dump", dump, "--set", STEPS, "--set",
                    f"simulation control/output path = {folder / 'results'}"], check=True)
    return dump.read_bytes()


def main(folder: Path, reference: str, *others: str) -> int:
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    expected = state_after_run(reference, folder)
    differing = [program for program in others if state_after_run(program, folder) != expected]
    for program in differing:
        print(f"{program} ends in another state than {reference}.")
    return 1 if differing else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), *sys.argv[2:]))
