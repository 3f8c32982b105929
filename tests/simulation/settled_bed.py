"""A settled bed of 20,000 particles stays at rest: read without the memory of its contacts, it
moves by far less than a particle's size and loses no particle.

Usage: settled_bed.py path/to/eunoe-particles bed.csv.gz folder
The bed has the columns diameter, x, y, z (um).
"""

import csv
import gzip
import json
import subprocess
import sys
from pathlib import Path

CASE = Path(__file__).resolve().parents[2] / "prm" / "benchmarks" / "settled_bed.prm"
STEPS = 2000


def main() -> int:
    program, bed, folder = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3])
    folder.mkdir(parents=True, exist_ok=True)
    with gzip.open(bed, "rt") as file:
        before = [{name: 1e-6 * float(value) for name, value in row.items()}
                  for row in csv.DictReader(file)]
    with open(folder / "bed.csv", "w", encoding="utf-8") as file:
        file.write("p_x; p_y; p_z; diameters;\n")
        for row in before:
            file.write(f"{row['x']}; {row['y']}; {row['z']}; {row['diameter']};\n")
    subprocess.run([program, str(CASE), "--quiet",
                    "--set", f"simulation control/output path = {folder / 'results'}",
                    "--set", f"simulation control/iteration end = {STEPS}",
                    "--set", f"insertion info/list of input files = {folder / 'bed.csv'}",
                    "--set", "post-processing/final state/calculation = true"], check=True)
    summary = json.loads((folder / "results" / "summary.json").read_text())
    assert summary["particles"] == len(before), "particles are lost"
    with open(folder / "results" / "particles.csv", encoding="utf-8") as file:
        after = [[float(cell) for cell in line.strip(";\n").split(";")] for line in list(file)[1:]]
    period = 1e-3
    moved = []
    for row, now in zip(before, after):
        shift = [now[c] - float(row[axis]) for c, axis in enumerate("xyz")]
        shift[2] -= period * round(shift[2] / period)
        moved.append(sum(s * s for s in shift) ** 0.5)
    moved.sort()
    # The friction springs start relaxed, so the bed sags a little before they carry load, and some
    # particles on the surface roll.
    half = moved[len(moved) // 2]
    assert half < 0.2e-6, f"half of all moved by {1e6 * half:.2f} um or more"
    assert moved[-20] < 5e-6, f"one in a thousand moved by {1e6 * moved[-20]:.2f} um"
    assert moved[-1] < 50e-6, f"a particle moved by {1e6 * moved[-1]:.2f} um"
    weight_work = 1.529e-5 * 9.81 * 70e-6  # of the whole bed falling by one diameter
    assert summary["kinetic_energy"] < 1e-2 * weight_work, "the bed does not rest"
    print("ok")
    return 0


if __name__ == "__main__":
    sys.exit(main())
