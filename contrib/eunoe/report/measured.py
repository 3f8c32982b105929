"""The measured layer densities, and the apparatus on which they were measured."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .apparatus import Apparatus
from .run_folder import ReportError

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

    def differing(self, apparatus: Apparatus) -> list[tuple[str, float, float, float, str]]:
        """Settings of a run that are not those of the measurement: in words, of the run, of the measurement, and the
        size and unit in which both are told."""
        settings = [("layers of", apparatus.layer_thickness, self.layer_thickness, 1e6, "µm"),
                    ("a velocity of", apparatus.velocity, self.velocity, 1e3, "mm/s"),
                    ("a density of", apparatus.density, self.density, 1., "kg/m³")]
        return [setting for setting in settings if abs(setting[1] / setting[2] - 1.) > 0.005]

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
    file: Path = TABLE

    @property
    def is_of_paper(self) -> bool:
        return self.file == TABLE

    @property
    def label(self) -> str:
        return "measured (full size)" if self.is_of_paper else "measured"

    @property
    def caption(self) -> str:
        if self.is_of_paper:
            return ("Measured: Ti-6Al-4V 45–106 µm, layers of 100 µm, 100 mm/s, full-size apparatus; mean and standard deviation "
                    "of three repeats. They are by the authors of Gaboriault et al. (2025), published in lethe-utils; that they are "
                    "the runs of that paper is an inference.")
        number = self.repeats.shape[1]
        return f"Measured: {self.file}" + (f", mean and standard deviation of {number} repeats." if number > 1 else ".")

    @property
    def mean(self) -> np.ndarray:
        return self.repeats.mean(axis=1)

    def cumulative(self) -> tuple[np.ndarray, np.ndarray]:
        """CRD of layers 2, 3, ... of every repeat: the mean of the LRD from layer 2 on. Without layer 2 there is none."""
        later = (self.layer >= 2) & (self.layer[0] <= 2)
        count = self.layer[later] - 1.
        return self.layer[later], np.cumsum(self.repeats[later], axis=0) / count[:, np.newaxis]

    def mean_over(self, layers: np.ndarray) -> float:
        """Mean LRD of those of the given layers that were measured; NaN if none was."""
        same = np.isin(self.layer, layers)
        return float(self.mean[same].mean()) if same.any() else float("nan")


def read_measured(path: Path = TABLE) -> Measured:
    """A table with a column `layer` and one or more whose names begin with `repeat`; lines that begin with # are
    comments. Throws a ReportError if it cannot be used."""
    try:
        lines = [line for line in path.read_text(encoding="utf-8-sig").splitlines() if line.strip() and not line.startswith("#")]
    except (OSError, UnicodeDecodeError) as error:
        raise ReportError(f"{path} cannot be read: {getattr(error, 'strerror', None) or 'it is no text'}.") from error
    names = [name.strip() for name in lines[0].split(",")] if lines else []
    columns = [k for k, name in enumerate(names) if name.startswith("repeat")]
    if "layer" not in names or not columns or len(lines) < 2:
        raise ReportError(f"{path} needs a heading 'layer,repeat 1,repeat 2,...' with one repeat at least, and a row for each layer.")
    try:
        rows = np.array([[float(word) for word in line.split(",")] for line in lines[1:]])
        layer, repeats = rows[:, names.index("layer")], rows[:, columns]
    except (ValueError, IndexError) as error:
        raise ReportError(f"{path} has a row that does not have {len(names)} numbers.") from error
    if not (np.diff(layer) == 1.).all():
        raise ReportError(f"{path} needs a row for each layer, in ascending order.")
    if not ((repeats > 0.) & (repeats < 1.)).all():
        raise ReportError(f"{path} has densities outside of 0 to 1. Give fractions of the density of the solid, not per cent.")
    return Measured(layer, repeats, path)


def measured_for(given: str, apparatuses: Iterable[Apparatus | None]) -> Measured | None:
    """What was measured, for runs with these apparatuses.

    :param given: a file; 'none'; or empty: the paper's measurement, where that is of the runs' settings
    """
    if given == "none":
        return None
    if given:
        return read_measured(Path(given))
    known = [apparatus for apparatus in apparatuses if apparatus]
    return None if any(FullSize().differing(apparatus) for apparatus in known) else read_measured()
