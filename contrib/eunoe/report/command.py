"""The command line of the scripts that turn an output folder into a page."""

from __future__ import annotations

import logging
import sys
from collections.abc import Callable
from pathlib import Path

from eunoe.launch import parser

from .page import Page
from .run_folder import ReportError


def write_page(words: list[str], documentation: str, make_page: Callable[[Path], Page], name: str) -> int:
    """Makes the page of the folder that the command line names and writes it there under the given
    name. Returns the exit code. If no page can be made, one sentence says why."""
    arguments = parser(documentation)
    arguments.add_argument("folder", type=Path, help="output folder")
    arguments.add_argument("--out", type=Path, help=f"file to write (default: FOLDER/{name})")
    arguments.add_argument("--figures", choices=("pdf", "png", "svg"),
                        help="write the figures as files too, into 'figures' beside the page")
    options = arguments.parse_args(words)
    # matplotlib logs that it builds its font cache, which says nothing about the run.
    logging.getLogger("matplotlib").setLevel(logging.ERROR)
    target = options.out or options.folder / name
    try:
        page = make_page(options.folder)
        target.write_text(page.html(), encoding="utf-8")
        if options.figures:
            page.write_figures(target.parent / "figures", options.figures)
    except ReportError as error:
        print(error, file=sys.stderr)
        return 2
    print(f"{Path(name).stem.capitalize()}: {target}")
    return 0
