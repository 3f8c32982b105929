"""Turns the output folder of a study of eunoe-discovery into one page, discovery.html.

Usage: contrib/tools discovery-report output/study [--out FILE] [--figures pdf|png|svg]

Needs numpy and matplotlib, as Debian's packages python3-numpy and python3-matplotlib have them.
"""

from __future__ import annotations

from pathlib import Path

from .command import write_page
from .discovery_report import discovery_report
from .discovery_results import Study
from .page import Page


def make_page(folder: Path) -> Page:
    return discovery_report(Study(folder))


def main(words: list[str]) -> int:
    return write_page(words, __doc__, make_page, "discovery.html")

