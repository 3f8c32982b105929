#!/usr/bin/python3
"""Turns the output folder of a study of eunoe-discovery into one page, discovery.html.

Usage: contrib/postprocessing/discovery_report.py output/study [--out FILE] [--figures pdf|png|svg]

Needs numpy and matplotlib, as Debian's packages python3-numpy and python3-matplotlib have them.
"""

from __future__ import annotations

import argparse
import logging
import sys
from pathlib import Path

try:
    import matplotlib  # noqa: F401
    import numpy  # noqa: F401
except ImportError as error:
    sys.exit(f"{sys.executable} has no {error.name}: install python3-numpy and "
             "python3-matplotlib, and run this script with Debian's /usr/bin/python3.")

from eunoe_report.discovery_report import discovery_report
from eunoe_report.discovery_results import Study
from eunoe_report.run_folder import ReportError


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("folder", type=Path, help="output folder of a study")
    parser.add_argument("--out", type=Path, help="file to write (default: FOLDER/discovery.html)")
    parser.add_argument("--figures", choices=("pdf", "png", "svg"),
                        help="write the figures as files too, into 'figures' beside the page")
    options = parser.parse_args(arguments)
    logging.getLogger("matplotlib").setLevel(logging.ERROR)
    target = options.out or options.folder / "discovery.html"
    try:
        page = discovery_report(Study(options.folder))
        target.write_text(page.html(), encoding="utf-8")
        if options.figures:
            page.write_figures(target.parent / "figures", options.figures)
    except ReportError as error:
        print(error, file=sys.stderr)
        return 2
    except OSError as error:
        print(f"{error.filename} cannot be used: {error.strerror}.", file=sys.stderr)
        return 2
    print(f"Page: {target}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
