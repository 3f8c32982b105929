#!/usr/bin/python3
"""Draws the whole apparatus of a spreading run when a layer was weighed, as the report does for the last.

Usage: contrib/eunoe_pictures/apparatus_at.py output/run layer file.png
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "postprocessing"))

from eunoe_report import style  # noqa: E402
from eunoe_report.apparatus import Apparatus  # noqa: E402
from eunoe_report.bed_pictures import overview_figure  # noqa: E402
from eunoe_report.evidence import FIELDS  # noqa: E402
from eunoe_report.run_folder import read_run  # noqa: E402
from eunoe_report.vtk_files import read_vtu  # noqa: E402


def main(words: list[str]) -> int:
    folder, layer, target = Path(words[0]), int(words[1]), Path(words[2])
    run = read_run(folder)
    figure, _ = overview_figure(read_vtu(run.layer_pictures()[layer], FIELDS),
                                Apparatus.read(folder / "apparatus.json"), layer, list(run.layers.time))
    figure.savefig(target, dpi=style.RESOLUTION)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
