"""Runs the cases of prm/verification and compares each with its reference: prints every number beside its
reference and tolerance, and draws both together.

Usage: contrib/tools verification path/to/eunoe-particles folder [--rows NAME ...] [--long]
       [--reuse] [--rayleigh-share 0.2] [--pictures FOLDER] [--page doc/verification.md [--renew]]

Without --rows: all rows but the long ones, which --long adds. --page compares the numbers with those that
the table of a page has, and --renew writes them there. --rayleigh-share sets the time step of all cases to that
share of the Rayleigh time. Exit code 1 if a number is beyond its tolerance or
is not that of the page. Needs numpy, and matplotlib for pictures.
"""

from __future__ import annotations

import argparse
import importlib
import time
from pathlib import Path

from eunoe.launch import parser

from . import page
from .bench import ROWS, Bench, Row, RowMaker

# Each registers its rows, in the order of the table.
for name in ("adhesion", "bulk", "impacts", "integrated", "oblique", "piles", "rolling"):
    importlib.import_module(f".{name}", __package__)


def draw(maker: RowMaker, row: Row, folder: Path) -> None:
    from eunoe.report import style
    from matplotlib.figure import Figure
    figure = Figure(figsize=(3.4 * row.n_panels, 2.5), layout="constrained")
    axes = figure.subplots(1, row.n_panels, squeeze=False)[0]
    row.draw(axes)
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / f"verification_{maker.name}.png", dpi=style.RESOLUTION)


def parse(words: list[str]) -> argparse.Namespace:
    arguments = parser(__doc__)
    arguments.add_argument("program")
    arguments.add_argument("folder", type=Path, help="of the runs")
    arguments.add_argument("--rows", nargs="+", choices=list(ROWS))
    arguments.add_argument("--long", action="store_true", help="the long rows, too")
    arguments.add_argument("--reuse", action="store_true", help="does not run again what has finished")
    arguments.add_argument("--rayleigh-share", type=float, help="time step of all cases")
    arguments.add_argument("--pictures", type=Path, help="folder for .png files")
    arguments.add_argument("--page", type=Path, help="page whose table is compared")
    arguments.add_argument("--renew", action="store_true", help="writes the numbers into the page")
    return arguments.parse_args(words)


def compare(maker: RowMaker, bench: Bench, options: argparse.Namespace) -> int:
    """Makes and prints a row; checks, renews or draws it as the options say. Number of failures."""
    start = time.monotonic()
    row = maker.make(bench)
    print(f"{maker.title} [{maker.name}, {time.monotonic() - start:.0f} s]")
    for check in row.checks:
        print(f"  {'ok  ' if check.passes else 'FAIL'} {check}", flush=True)
    failed = sum(not check.passes for check in row.checks)
    if options.page and options.renew:
        page.renew(options.page, maker, row)
    elif options.page:
        for sentence in page.differences(options.page, maker, row):
            failed += 1
            print(f"  FAIL {sentence}", flush=True)
    if options.pictures and row.draw:
        draw(maker, row, options.pictures)
    return failed


def main(words: list[str]) -> int:
    options = parse(words)
    bench = Bench(str(Path(options.program).resolve()), options.folder.resolve(), options.reuse,
                  options.rayleigh_share)
    names = options.rows or [name for name, maker in ROWS.items() if options.long or not maker.is_long]
    failed = sum(compare(ROWS[name], bench, options) for name in names)
    print(f"{failed} numbers do not agree." if failed else "All agree.")
    return 1 if failed else 0
