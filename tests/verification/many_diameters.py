"""Diameters that were drawn use no memory once their particles are gone: a run that inserts a
million particles, 300 at a time, needs no more than one that inserts a tenth of them.
Regression: another program stored every diameter that it ever drew, eight bytes each.

Usage: many_diameters.py path/to/eunoe-particles folder
"""

import json
import os
import subprocess
import sys
from pathlib import Path

CASE = Path(__file__).with_name("many_diameters.prm")


def largest_memory(program: str, folder: Path, steps: int) -> tuple[float, int]:
    """Largest memory of a run (MB), and the number of particles that it inserted."""
    command = [program, str(CASE), "--quiet", "--set", f"simulation control/iteration end = {steps}",
               "--set", f"simulation control/output path = {folder}"]
    # The address sanitizer must not hold back memory that was freed.
    environment = {**os.environ, "ASAN_OPTIONS": os.environ.get("ASAN_OPTIONS", "") + ":quarantine_size_mb=0"}
    with subprocess.Popen(command, env=environment) as process:
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    assert process.returncode == 0, f"exit code {process.returncode}"
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    return usage.ru_maxrss / 1024., summary["inserted_particles"]


def main() -> int:
    program, folder = sys.argv[1], Path(sys.argv[2])
    few, n_few = largest_memory(program, folder / "few", 700)
    many, n_many = largest_memory(program, folder / "many", 7000)
    print(f"{few:.1f} MB for {n_few} particles, {many:.1f} MB for {n_many}")
    assert n_many > 1_000_000 and n_few < 0.2 * n_many
    stored = 8e-6 * (n_many - n_few)
    assert many - few < 0.4 * stored, f"memory grows by {many - few:.1f} MB"
    return 0


if __name__ == "__main__":
    sys.exit(main())
