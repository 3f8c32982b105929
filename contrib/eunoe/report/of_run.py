"""Turns the output folder of a run into one page, report.html, that any browser shows.

Usage: contrib/tools report output/quickstart [--out FILE] [--figures pdf|png|svg]

Needs numpy, matplotlib and VTK, as Debian's packages python3-numpy, python3-matplotlib and python3-vtk9 have
them.
"""

from __future__ import annotations

from pathlib import Path

from .command import write_page
from .general_report import general_report
from .heap_report import heap_report
from .page import Page
from .run_folder import read_run
from .spreading_report import spreading_report


def make_page(folder: Path) -> Page:
    run = read_run(folder)
    if run.layers is not None:
        return spreading_report(run, run.layers)
    return heap_report(run) if run.is_heap else general_report(run)


def main(words: list[str]) -> int:
    return write_page(words, __doc__, make_page, "report.html")

