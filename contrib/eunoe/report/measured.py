"""The measured layer densities, and the apparatus on which they were measured."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

TABLE = Path(__file__).with_name("measured_lrd.csv")


@dataclass(frozen=True)
class FullSize:
    """The apparatus and the procedure of Gaboriault et al. (2025), SI units."""

    platform_length: float = 69e-3
    transfer_length: float = 56e-3
    plate_length: float = 73e-3
    plate_area: float = 5329e-6
    exit_length: float = 46.5e-3
    gap: float = 0.5e-3
    spreader_radius: float = 5e-3
    clearance: float = 100e-6
    n_layers: int = 21
    layer_thickness: float = 100e-6
    velocity: float = 0.1
    first_stroke: float = 2.2e-3
    stroke: float = 0.6e-3
    density: float = 4386.
    angle_of_repose: float = 37.5  # degrees, of the powder, measured

    @property
    def plate_depth(self) -> float:
        return self.plate_area / self.plate_length

    @property
    def full_layer_mass(self) -> float:
        """Mass of solid material that fills a layer on the plate (kg)."""
        return self.density * self.plate_area * self.layer_thickness


@dataclass(frozen=True)
class Measured:
    """Layer relative density, measured, as fractions."""

    layer: np.ndarray
    repeats: np.ndarray  # one column a repeat
    mean: np.ndarray
    std: np.ndarray

    def cumulative(self) -> tuple[np.ndarray, np.ndarray]:
        """CRD of layers 2, 3, ... of every repeat: the mean of the LRD from layer 2 on."""
        later = self.layer >= 2
        count = self.layer[later] - 1.
        return self.layer[later], np.cumsum(self.repeats[later], axis=0) / count[:, np.newaxis]

    def mean_over(self, layers: np.ndarray) -> float:
        """Mean LRD of those of the given layers that were measured; NaN if none was."""
        same = np.isin(self.layer, layers)
        return float(self.mean[same].mean()) if same.any() else float("nan")


def read_measured(path: Path = TABLE) -> Measured:
    with path.open() as stream:
        lines = [line for line in stream if not line.startswith("#")]
    table = np.genfromtxt(lines, delimiter=",", names=True)
    repeats = [name for name in table.dtype.names if name.startswith("repeat")]
    return Measured(table["layer"], np.column_stack([table[name] for name in repeats]),
                    table["mean"], table["std"])
