"""Draws the whole apparatus of a spreading run when a layer was weighed, as the report does for the last.

Usage: contrib/tools apparatus output/run layer file.png
"""

from __future__ import annotations

from pathlib import Path

from eunoe.launch import Failure, parser
from eunoe.report import style
from eunoe.report.apparatus import Apparatus
from eunoe.report.bed_pictures import overview_figure
from eunoe.report.evidence import FIELDS
from eunoe.report.run_folder import read_run
from eunoe.vtk_files import read_vtu


def main(words: list[str]) -> int:
    arguments = parser(__doc__)
    arguments.add_argument("folder", type=Path)
    arguments.add_argument("layer", type=int)
    arguments.add_argument("picture", type=Path)
    options = arguments.parse_args(words)
    run, layer = read_run(options.folder), options.layer
    pictures = run.layer_pictures()
    if layer not in pictures:
        raise Failure(f"{options.folder} has no picture of layer {layer}; it has those of "
                      f"{', '.join(map(str, pictures)) or 'none'}.")
    figure, _ = overview_figure(read_vtu(pictures[layer], FIELDS),
                                Apparatus.read(run.folder / "apparatus.json"), layer, run.layers.weighings)
    figure.savefig(options.picture, dpi=style.RESOLUTION)
    return 0

