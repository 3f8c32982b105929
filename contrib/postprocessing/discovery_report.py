#!/usr/bin/python3
"""Turns the output folder of a study of eunoe-discovery into one page, discovery.html.

Usage: contrib/postprocessing/discovery_report.py output/study [--out FILE] [--figures pdf|png|svg]

Needs numpy and matplotlib, as Debian's packages python3-numpy and python3-matplotlib have them.
"""

from __future__ import annotations

import sys
from pathlib import Path

from eunoe_report.command import write_page
from eunoe_report.discovery_report import discovery_report
from eunoe_report.discovery_results import Study
from eunoe_report.page import Page


def make_page(folder: Path) -> Page:
    return discovery_report(Study(folder))


def main(arguments: list[str]) -> int:
    return write_page(arguments, __doc__.split("\n", 1)[0], make_page, "discovery.html")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
