"""A small spreading run from its input file to its results, checked against itself: the mass on the
plate is that in the pictures, the densities follow from it, the plate sinks by one layer at a time,
and all mass is accounted for.

Usage: end_to_end.py path/to/eunoe-particles case.prm folder ranks
Exit code 77, which skips the test, if numpy or VTK is missing.
"""

import contextlib
import csv
import importlib.util
import io
import json
import math
import subprocess
import sys
from pathlib import Path

if any(importlib.util.find_spec(name) is None for name in ("numpy", "vtkmodules")):
    sys.exit(77)
import numpy as np

from eunoe.launch import mpirun, overrides
from eunoe.vtk_files import read_pvd, read_vtu


LAYER_THICKNESS, DENSITY, DEPTH = 100e-6, 4386., 0.25e-3
PLATE_LENGTH, GAP = 73e-3 * 0.01, 0.1e-3
PLATE_START = (69e-3 + 56e-3) * 0.01 + GAP
FIELDS = ["ID", "mass", "layer", "tracked", "displacement", "on_plate"]
FULL_LAYER = DENSITY * PLATE_LENGTH * DEPTH * LAYER_THICKNESS


def run(program: str, case: str, folder: Path, ranks: int) -> None:
    subprocess.run([*mpirun(ranks, "--oversubscribe"), program, case,
                    *overrides({"simulation control/output path": folder})], check=True, stdout=subprocess.DEVNULL)


def close(name: str, value: float, reference: float, relative: float) -> None:
    assert math.isclose(value, reference, rel_tol=relative, abs_tol=1e-30), \
        f"{name}: {value} instead of {reference}"


def check_displacements(before: dict, after: dict, kept: np.ndarray) -> None:
    """Displacements agree with the positions in the pictures, relative to the plate, which sinks by
    one layer."""
    order = np.argsort(before["ID"])
    rank = order[np.searchsorted(before["ID"], after["ID"][kept], sorter=order)]
    assert np.array_equal(before["ID"][rank], after["ID"][kept]) and (before["on_plate"][rank] == 1).all()
    way = after["points"][kept].astype(float) - before["points"][rank].astype(float)
    way[:, 1] += LAYER_THICKNESS
    way[:, 2] -= DEPTH * np.rint(way[:, 2] / DEPTH)
    # Positions in the pictures are single precision; the weighing is in the first step of a stroke.
    error = np.abs(after["displacement"][kept] - way).max()
    assert error < 1e-8, f"displacements are off by {error} m"
    # The spreader drags the powder along.
    assert way[:, 0].mean() > 0., "the layer moves against the spreader"


def check_layers(rows: list[dict[str, str]], folder: Path) -> None:
    masses = [float(row["mass"]) for row in rows]
    pictures = read_pvd(folder / "spreading_layers.pvd")
    solids = read_pvd(folder / "spreading_layers_solids.pvd")
    assert [int(row["layer"]) for row in rows] == [0, 1, 2]
    assert len(pictures) == len(solids) == len(rows)
    heights, previous = [], {}
    for k, (row, picture) in enumerate(zip(rows, pictures)):
        close("time of the picture", picture.time, float(row["time"]), 1e-15)
        particles = read_vtu(picture.file, FIELDS)
        x = particles["points"][:, 0].astype(float)
        on_plate = particles["on_plate"] == 1
        over = (x >= PLATE_START) & (x < PLATE_START + PLATE_LENGTH)
        # Positions in the pictures are single precision: those at the very edge may differ.
        assert np.count_nonzero(on_plate & ~over) <= 1
        assert int(row["particles"]) == np.count_nonzero(on_plate)
        close(f"mass of layer {k}", float(particles["mass"][on_plate].sum(dtype=float)),
              masses[k], 1e-6)
        layer = particles["layer"][on_plate]
        assert layer.min() >= 0 and layer.max() == k
        before, previous = previous, particles
        if k == 0:
            assert row["LRD"] == "" and row["CRD"] == ""
            continue
        close(f"LRD of layer {k}", float(row["LRD"]), (masses[k] - masses[k - 1]) / FULL_LAYER, 1e-9)
        if k >= 2:
            close(f"CRD of layer {k}", float(row["CRD"]),
                  (masses[k] - masses[1]) / (FULL_LAYER * (k - 1)), 1e-9)
        assert 0.2 < float(row["LRD"]) < 1., "a density that no powder has"
        kept = on_plate & (particles["tracked"] == 1)
        close("mass removed", float(row["mass_removed"]),
              masses[k - 1] - float(particles["mass"][kept].sum(dtype=float)), 1e-4)
        check_displacements(before, particles, kept)
    for picture in solids:
        surfaces = read_vtu(picture.file, [])
        # The measuring plate alone has its corners at this place.
        corners = np.isclose(surfaces["points"][:, 0], PLATE_START, rtol=1e-6)
        heights.append(float(surfaces["points"][corners, 1].max()))
    for k, height in enumerate(heights):
        # The weighing falls within the first step of the plate's next stroke.
        assert abs(height + k * LAYER_THICKNESS) < 1e-4 * LAYER_THICKNESS, f"plate at {height} m"


def check_summary(summary: dict, rows: list[dict[str, str]]) -> None:
    assert summary["mass_balance_error"] == 0., "mass is lost unaccounted"
    assert summary["inserted_particles"] == (summary["particles"] + summary["taken_out_particles"]
                                             + summary["outlet_particles"])
    for name, outlet in (("gap", 2), ("collector", 1)):
        mass = summary[f"outlet_{outlet}_mass"]
        assert mass > 0., f"nothing fell into the {name}"
        close(f"powder in the {name}", sum(float(row[f"mass_to_{name}"]) for row in rows), mass, 1e-12)


def check_report(folder: Path) -> None:
    """The report of a real run has all its figures and nothing to complain of."""
    from eunoe.report import of_run
    with contextlib.redirect_stdout(io.StringIO()):
        assert of_run.main([str(folder)]) == 0
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert 'class="notice"' not in page, "the report complains"
    assert page.count("<figure>") >= 5, f"{page.count('<figure>')} figures"


def main() -> int:
    program, case, folder, ranks = sys.argv[1:]
    run(program, case, Path(folder), int(ranks))
    with open(Path(folder) / "layers.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    check_layers(rows, Path(folder))
    check_summary(json.loads((Path(folder) / "summary.json").read_text()), rows)
    if importlib.util.find_spec("matplotlib"):
        check_report(Path(folder))
    print("ok")
    return 0


if __name__ == "__main__":
    sys.exit(main())
