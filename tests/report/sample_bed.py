"""Beds whose density, displacements and zones at rest are known, without a simulation."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

import sample_run
from eunoe.report.apparatus import Apparatus

APPARATUS = Apparatus(**sample_run.APPARATUS)
DIAMETER = 40e-6
SPACING = 50e-6
N_X, N_Z = 30, 8  # on the plate of 1.5 mm, in the depth of 0.4 mm
MEETS = 6  # layer in whose pass the zones at rest first meet


def static_columns(layer: int) -> int:
    """How many columns of 0.1 mm, from either end, rest in the pass of a layer; 15 make the bed."""
    return 0 if layer < 3 else min(2 * (layer - 2), 15)


def bed(layer: int, apparatus: Apparatus = APPARATUS, n_z: int = N_Z) -> dict[str, np.ndarray]:
    """A cubic grid with two rows of grains to each layer. What lay there before has moved by 50 um, but not in
    the columns at the two ends that rest."""
    i, j, k = (axis.ravel() for axis in np.meshgrid(range(N_X), range(2 * (layer + 1)), range(n_z), indexing="ij"))
    points = np.column_stack((apparatus.x_plate + (i + 0.5) * SPACING,
                              apparatus.plate_height(layer) + (j + 0.5) * SPACING, (k + 0.5) * SPACING))
    old = j < 2 * layer
    column = np.minimum(i // 2, 14 - i // 2)
    moved = np.where(old & (column >= static_columns(layer)), 50e-6, 0.)
    n = len(points)
    return {"points": points, "ID": np.arange(n), "diameter": np.full(n, DIAMETER),
            "mass": np.full(n, APPARATUS.density * np.pi / 6. * DIAMETER**3), "velocity": np.zeros((n, 3)),
            "layer": j // 2, "tracked": 1. * old, "on_plate": np.ones(n),
            "displacement": np.column_stack((moved, np.zeros(n), np.full(n, 1e-3)))}


FRACTION = np.pi / 6. * (DIAMETER / SPACING)**3  # of solid in the grid


LAYERS = 21
HEAD = sample_run.LAYERS.splitlines()[0]


def densities(peak: int, seed: int) -> list[float]:
    """LRD of layers 1 to 20: 0.6 with a rise of 0.05 to a peak, the same for all seeds but for a small shift."""
    return [0.6 + 0.001 * seed + 0.05 * max(0., 1. - abs(layer - peak) / 4.) for layer in range(1, LAYERS)]


def write_run(folder: Path, peak: int, seed: int, layers: int = LAYERS) -> None:
    """The output folder of a run of 21 layers with such densities and beds, finished if all layers are there."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "used.prm").write_text(sample_run.PARAMETERS)
    (folder / "apparatus.json").write_text(json.dumps({**sample_run.APPARATUS, "n_layers": LAYERS}))
    lrd = densities(peak, seed)
    rows, entries = [HEAD], []
    for layer in range(layers):
        known = lrd[:layer]
        cells = (layer, 0.1 * (layer + 1), 1e-7 * (layer + 1), 100 * (layer + 1), lrd[layer - 1] if layer else "",
                 sum(known[1:]) / (layer - 1) if layer > 1 else "", 2e-9 if layer else "", 1e-8, 1e-7, 1e-5, 1e-4, 10)
        rows.append(",".join(map(str, cells)))
        entries.append((0.1 * (layer + 1), f"spreading_layers_{layer:05d}.vtu"))
        fields = bed(layer, n_z=2)
        points = fields.pop("points")
        (folder / entries[-1][1]).write_text(sample_run.vtu(sample_run.piece(points, fields)))
    (folder / "layers.csv").write_text("\n".join(rows) + "\n")
    (folder / "spreading_layers.pvd").write_text(sample_run.pvd(entries))
    if layers == LAYERS:
        (folder / "summary.json").write_text(json.dumps({**sample_run.SUMMARY, "git_revision": "abc1234567", "share_asleep": 0.5,
                                                         "simulated_time": 0.1 * LAYERS, "lost_particles": 0}))
