"""Turns the output folder of a run into one page, report.html, that any browser shows; or several spreading
runs into one page that compares them, comparison.html.

Usage: contrib/tools report output/quickstart [--out FILE] [--figures FORMAT|FOLDER] [--movie [PASS]]
                            [--measured FILE]
       contrib/tools report A B C [--label PS1 --label PS1 --label PS3] [--out FILE] [--figures FORMAT|FOLDER]
                            [--measured FILE]

Runs of one label, such as those that differ in the seed alone, are pooled: the page shows their means and
bands. Without --label a folder's name is its label, without an ending like _seed3; where several have one name,
as A/run and B/run, with the folder around it. --movie adds a movie of a
pass of which the run has pictures. --figures writes all figures as files as well: in a format (pdf, png, svg)
into the folder `figures` beside the page, or into a folder of your choice, as pdf.

Densities stand beside those of --measured: a table with a heading `layer,repeat 1,repeat 2,...` and fractions,
or `none`. Without it they stand beside the measured ones of Gaboriault et al. (2025) where a run has their layers, velocity
and density of the solid.

Needs numpy, matplotlib and VTK, as Debian's packages python3-numpy, python3-matplotlib and python3-vtk9 have
them; a movie needs Pillow (python3-pil).
"""

from __future__ import annotations

from pathlib import Path

from .command import page_parser, write
from .comparison_report import comparison_report
from .general_report import general_report
from .heap_report import heap_report
from .page import Page
from .run_folder import ReportError, read_run
from .spreading_report import add_movie, spreading_report


def make_page(folder: Path, movie: int | None = None, measured: str = "") -> Page:
    """:param movie: number of the pass for a movie; -1: the last one that has pictures; None: no movie"""
    run = read_run(folder)
    if run.layers is not None:
        page = spreading_report(run, run.layers, measured)
        if movie is not None:
            add_movie(page, run, run.layers, None if movie < 0 else movie)
        return page
    if movie is not None:
        raise ReportError(f"{folder} is no spreading run: a movie shows a pass of one.")
    if measured not in ("", "none"):
        raise ReportError(f"{folder} is no spreading run: {measured} would stand beside densities of layers, which only "
                          "those have.")
    return heap_report(run) if run.is_heap else general_report(run)


def main(words: list[str]) -> int:
    arguments = page_parser(__doc__, "report.html, or comparison.html for several runs", several=True)
    arguments.add_argument("--label", action="append", default=[], dest="labels", metavar="TEXT",
                           help="of a run, once for each")
    arguments.add_argument("--movie", type=int, nargs="?", const=-1, metavar="PASS", help="of one run")
    arguments.add_argument("--measured", default="", metavar="FILE", help="table of measured densities, or 'none'")
    options = arguments.parse_args(words)
    if len(options.folders) == 1 and not options.labels:
        return write(options, lambda: make_page(options.folders[0], options.movie, options.measured), "report.html")
    if options.movie is not None:
        arguments.error("--movie shows a pass of one run: name one folder, without --label.")
    return write(options, lambda: comparison_report(options.folders, options.labels, options.measured), "comparison.html")
