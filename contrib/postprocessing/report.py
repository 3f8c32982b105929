#!/usr/bin/python3
"""Turns the output folder of a run into one page, report.html, that any browser shows.

Usage: contrib/postprocessing/report.py output/quickstart [--out FILE] [--figures pdf|png|svg]

Needs numpy and matplotlib, as Debian's packages python3-numpy and python3-matplotlib have them.
"""

from __future__ import annotations

import sys
from pathlib import Path

from eunoe_report.command import write_page
from eunoe_report.general_report import general_report
from eunoe_report.heap_report import heap_report
from eunoe_report.page import Page
from eunoe_report.run_folder import read_run
from eunoe_report.spreading_report import spreading_report


def make_page(folder: Path) -> Page:
    run = read_run(folder)
    if run.layers is not None:
        return spreading_report(run, run.layers)
    return heap_report(run) if run.is_heap else general_report(run)


def main(arguments: list[str]) -> int:
    return write_page(arguments, __doc__.split("\n", 1)[0], make_page, "report.html")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
