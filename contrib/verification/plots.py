#!/usr/bin/env python3
"""Runs the cases of prm/verification and compares each with its reference: prints every number beside its
reference and tolerance, and draws both together.

Usage: contrib/verification/plots.py path/to/eunoe-particles folder [--rows NAME ...] [--long]
       [--reuse] [--pictures FOLDER] [--page doc/verification.md [--renew]]

Without --rows: all rows but the long ones, which --long adds. --page compares the numbers with those that
the table of a page has, and --renew writes them there. Exit code 1 if a number is beyond its tolerance or
is not that of the page. Needs numpy, and matplotlib for pictures.
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
from eunoe_verification import page
from eunoe_verification.bench import ROWS, Bench, Row, RowMaker


def draw(maker: RowMaker, row: Row, folder: Path) -> None:
    sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "postprocessing"))
    import matplotlib
    matplotlib.use("Agg")
    from eunoe_report import style
    from matplotlib.figure import Figure
    figure = Figure(figsize=(3.4 * row.n_panels, 2.5), layout="constrained")
    axes = figure.subplots(1, row.n_panels, squeeze=False)[0]
    row.draw(axes)
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / f"verification_{maker.name}.png", dpi=style.RESOLUTION)


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", 1)[0])
    parser.add_argument("program")
    parser.add_argument("folder", type=Path, help="of the runs")
    parser.add_argument("--rows", nargs="+", choices=list(ROWS))
    parser.add_argument("--long", action="store_true", help="the long rows, too")
    parser.add_argument("--reuse", action="store_true", help="does not run again what has finished")
    parser.add_argument("--pictures", type=Path, help="folder for .png files")
    parser.add_argument("--page", type=Path, help="page whose table is compared")
    parser.add_argument("--renew", action="store_true", help="writes the numbers into the page")
    options = parser.parse_args(arguments)
    bench = Bench(str(Path(options.program).resolve()), options.folder.resolve(), options.reuse)
    names = options.rows or [name for name, maker in ROWS.items() if options.long or not maker.is_long]
    failed = 0
    for name in names:
        start = time.monotonic()
        row = ROWS[name].make(bench)
        print(f"{ROWS[name].title} [{name}, {time.monotonic() - start:.0f} s]")
        for check in row.checks:
            failed += not check.passes
            print(f"  {'ok  ' if check.passes else 'FAIL'} {check}", flush=True)
        if options.page and options.renew:
            page.renew(options.page, ROWS[name], row)
        elif options.page:
            for sentence in page.differences(options.page, ROWS[name], row):
                failed += 1
                print(f"  FAIL {sentence}", flush=True)
        if options.pictures and row.draw:
            draw(ROWS[name], row, options.pictures)
    print(f"{failed} numbers do not agree." if failed else "All agree.")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
