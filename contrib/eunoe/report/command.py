"""The command line of the scripts that turn output folders into a page."""

from __future__ import annotations

import argparse
import logging
import sys
from collections.abc import Callable
from pathlib import Path

from eunoe.launch import parser

from .page import Page
from .run_folder import ReportError

FORMATS = ("pdf", "png", "svg")


def page_parser(documentation: str, name: str, several: bool = False) -> argparse.ArgumentParser:
    """:param name: of the page's file, in the first folder"""
    arguments = parser(documentation)
    arguments.add_argument("folders", type=Path, nargs="+" if several else 1, metavar="folder", help="output folder")
    arguments.add_argument("--out", type=Path, help=f"file to write (default: FOLDER/{name})")
    arguments.add_argument("--figures", metavar="FORMAT|FOLDER",
                           help="writes the figures as files too: in a format (pdf, png or svg) into 'figures' beside "
                           "the page, or into a folder, as pdf")
    return arguments


def _write_figures(page: Page, target: Path, figures: str) -> None:
    if figures in FORMATS:
        page.write_figures(target.parent / "figures", figures)
    else:
        page.write_figures(Path(figures), "pdf")


def write(options: argparse.Namespace, make_page: Callable[[], Page], name: str) -> int:
    """Makes the page and writes it. Returns the exit code. If no page can be made, one sentence says why."""
    # matplotlib logs that it builds its font cache, which says nothing about the run.
    logging.getLogger("matplotlib").setLevel(logging.ERROR)
    target = options.out or options.folders[0] / name
    try:
        page = make_page()
        target.write_text(page.html(), encoding="utf-8")
        if options.figures:
            _write_figures(page, target, options.figures)
    except ReportError as error:
        print(error, file=sys.stderr)
        return 2
    print(f"{Path(name).stem.capitalize()}: {target}")
    return 0


def write_page(words: list[str], documentation: str, make_page: Callable[[Path], Page], name: str) -> int:
    """The page of one folder."""
    options = page_parser(documentation, name).parse_args(words)
    return write(options, lambda: make_page(options.folders[0]), name)
