#!/usr/bin/env python3
"""Runs the cases of prm/verification and compares each with its reference: prints every number beside its
reference and tolerance, and draws both together.

Usage: contrib/verification/plots.py path/to/eunoe-particles folder [--rows NAME ...] [--long]
       [--reuse] [--pictures FOLDER] [--table FILE.md]

Without --rows: all rows but the long ones, which --long adds. Exit code 1 if a number is beyond its
tolerance. Needs numpy, and matplotlib for pictures.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

try:
    import numpy  # noqa: F401
except ImportError:
    sys.exit(77)

from eunoe_verification import adhesion, bulk, impacts, integrated, oblique, piles, rolling  # noqa: F401
from eunoe_verification.bench import ROWS, Bench, Row, RowMaker


def draw(maker: RowMaker, row: Row, folder: Path) -> None:
    sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "postprocessing"))
    import matplotlib
    matplotlib.use("Agg")
    from eunoe_report import style  # noqa: F401
    from matplotlib.figure import Figure
    figure = Figure(figsize=(3.4 * row.n_panels, 2.5), layout="constrained")
    axes = figure.subplots(1, row.n_panels, squeeze=False)[0]
    row.draw(axes)
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / f"verification_{maker.name}.png", dpi=100)


def table_lines(maker: RowMaker, row: Row) -> list[str]:
    def number(value: float) -> str:
        return f"{value:.5g}" if abs(value) > 1e-13 else "0"
    lines = []
    for k, check in enumerate(row.checks):
        unit = f" {check.unit}" if check.unit else ""
        first = f"{maker.title}: `{maker.name}`" if k == 0 else ""
        tolerance = "at least" if check.tolerance is None else f"{check.tolerance:.2g}{unit}"
        lines.append(f"| {first} | {check.what} | {number(check.reference)}{unit} | "
                     f"{number(check.result)}{unit} | {tolerance} |")
    return lines


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", 1)[0])
    parser.add_argument("program")
    parser.add_argument("folder", type=Path, help="of the runs")
    parser.add_argument("--rows", nargs="+", choices=list(ROWS))
    parser.add_argument("--long", action="store_true", help="the long rows, too")
    parser.add_argument("--reuse", action="store_true", help="does not run again what has finished")
    parser.add_argument("--pictures", type=Path, help="folder for .png files")
    parser.add_argument("--table", type=Path, help="file for the table")
    options = parser.parse_args(arguments)
    bench = Bench(str(Path(options.program).resolve()), options.folder.resolve(), options.reuse)
    names = options.rows or [name for name, maker in ROWS.items() if options.long or not maker.is_long]
    failed = 0
    lines = ["| row | quantity | reference | result | tolerance |", "|---|---|---|---|---|"]
    for name in names:
        start = time.monotonic()
        row = ROWS[name].make(bench)
        print(f"{ROWS[name].title} [{name}, {time.monotonic() - start:.0f} s]")
        for check in row.checks:
            failed += not check.passes
            print(f"  {'ok  ' if check.passes else 'FAIL'} {check}", flush=True)
        lines += table_lines(ROWS[name], row)
        if options.pictures and row.draw:
            draw(ROWS[name], row, options.pictures)
    if options.table:
        options.table.write_text("\n".join(lines) + "\n", encoding="utf-8")
    print(f"{failed} numbers are beyond their tolerance." if failed else "All agree.")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
