"""Runs the quickstart and compares the densities of its layers with the table of doc/first_run.md, which
promises them to the last digit.

Usage: check_quickstart.py path/to/eunoe-particles folder
"""

from __future__ import annotations

import csv
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def promised() -> dict[int, list[str]]:
    """LRD and CRD (%) by layer, as the page writes them."""
    text = (ROOT / "doc" / "first_run.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (\d+) \| ([\d.]+) \| ([\d.]*) ?\|$", text, re.M)
    return {int(layer): [lrd, crd] for layer, lrd, crd in rows}


def found(program: str, folder: Path) -> dict[int, list[str]]:
    subprocess.run([program, ROOT / "prm" / "spreading" / "quickstart.prm", "--quiet", "--set",
                    f"simulation control/output path = {folder}"], check=True)
    with open(folder / "layers.csv", encoding="utf-8") as file:
        return {int(row["layer"]): [f"{100. * float(row[key]):.3f}" if row[key] else ""
                                    for key in ("LRD", "CRD")]
                for row in csv.DictReader(file) if row["LRD"]}


def main(program: str, folder: str) -> int:
    page, run = promised(), found(program, Path(folder))
    if page != run or len(run) != 4:
        print(f"doc/first_run.md promises {page}, the run gave {run}. If that is meant: "
              "contrib/tools pictures --only quickstart, and the table of the page.")
        return 1
    print("ok")
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
