"""What a run leaves in its output folder, except the particles themselves."""

from __future__ import annotations

import csv
import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from eunoe.launch import Failure
from eunoe.prm_file import Parameters, parse_prm
from eunoe.vtk_files import Snapshot, read_pvd


class ReportError(Failure):
    """No report can be made; the text is a sentence for the user that says why."""


@dataclass(frozen=True)
class Layers:
    """The rows of layers.csv, one for each weighing, in SI units; NaN where undefined."""

    layer: np.ndarray  # number of the pass, from 0
    time: np.ndarray  # s
    mass: np.ndarray  # on the measuring plate, kg
    particles: np.ndarray  # on the measuring plate
    lrd: np.ndarray  # layer relative density, a fraction
    crd: np.ndarray  # cumulative relative density, a fraction
    removed: np.ndarray  # from the plate since the last weighing, kg
    to_gap: np.ndarray  # since the last weighing, kg
    to_collector: np.ndarray  # likewise, kg
    force_mean: np.ndarray  # on the spreader while over the plate, N
    force_max: np.ndarray  # likewise, N
    wall_seconds: np.ndarray  # since the last weighing, s

    def __len__(self) -> int:
        return len(self.layer)

    @property
    def last(self) -> int:
        """Number of the last layer."""
        return int(self.layer[-1])

    @property
    def weighings(self) -> dict[int, float]:
        """Times (s) by the numbers of the layers."""
        return {int(layer): float(time) for layer, time in zip(self.layer, self.time)}

    @property
    def arrived(self) -> np.ndarray:
        """Mass that came onto the plate since the last weighing and stayed (kg); NaN for the first layer of a run that
        goes on with the layers of another one."""
        return np.diff(self.mass, prepend=0. if self.layer[0] == 0. else np.nan) + self.removed


COLUMNS = {
    "layer": "layer", "time": "time", "mass": "mass", "particles": "particles", "lrd": "LRD",
    "crd": "CRD", "removed": "mass_removed", "to_gap": "mass_to_gap",
    "to_collector": "mass_to_collector", "force_mean": "spreader_force_mean",
    "force_max": "spreader_force_max", "wall_seconds": "wall_seconds",
}


def read_layers(path: Path) -> Layers:
    """Reads layers.csv; a last row that a stopped run left incomplete is dropped."""
    with path.open(newline="") as stream:
        rows = list(csv.reader(stream))
    header = rows[0] if rows else []
    missing = [column for column in COLUMNS.values() if column not in header]
    if missing:
        raise ReportError(f"{path} has no column {', '.join(missing)}: it is no table of layers.")
    rows = [row for row in rows[1:] if len(row) == len(header)]
    if not rows:
        raise ReportError(f"{path} has no rows yet: no layer has been weighed.")
    try:
        values = np.array([[float(cell) if cell.strip() else np.nan for cell in row]
                           for row in rows])
    except ValueError as error:
        raise ReportError(f"{path} cannot be read: {error}.") from error
    return Layers(**{name: values[:, header.index(column)] for name, column in COLUMNS.items()})


@dataclass(frozen=True)
class Run:
    """An output folder."""

    folder: Path
    layers: Layers | None  # None if the run did not spread powder
    summary: dict[str, float | str] | None  # None if the run has not finished
    parameters: Parameters | None
    parameters_text: str

    @property
    def name(self) -> str:
        return self.folder.resolve().name

    @property
    def is_heap(self) -> bool:
        return (self.folder / "heap.csv").is_file()

    def _picture_index(self, ending: str) -> Path | None:
        """The .pvd file with this ending after the output name."""
        if self.parameters and "simulation control" in self.parameters.sections:
            output_name = self.parameters.section("simulation control").text("output name")
            return self.folder / f"{output_name}{ending}.pvd"
        known = ("_layers", "_heap", "_solids")
        found = [path for path in sorted(self.folder.glob(f"*{ending}.pvd"))
                 if ending or not path.stem.endswith(known)]
        return found[0] if found else None

    def layer_pictures(self) -> dict[int, Path]:
        """The files with the particles at the weighings, by the number of the layer."""
        index = self._picture_index("_layers")
        if self.layers is None or index is None:
            return {}
        pictures = {}
        for snapshot in read_pvd(index):
            # Matched by time, as some files may come from an earlier run in the same folder.
            same = np.isclose(self.layers.time, snapshot.time, rtol=1e-9, atol=0.)
            if same.any() and snapshot.file.is_file():
                pictures[int(self.layers.layer[same][0])] = snapshot.file
        return pictures

    def pictures(self, ending: str = "") -> list[Snapshot]:
        """The pictures of the particles, or of the '_solids', whose files are there."""
        index = self._picture_index(ending)
        return [entry for entry in (read_pvd(index) if index else []) if entry.file.is_file()]

    def last_picture(self, ending: str = "") -> tuple[float, Path] | None:
        """Time (s) and file of the last one."""
        found = self.pictures(ending)
        return (found[-1].time, found[-1].file) if found else None


def read_run(folder: Path) -> Run:
    """Reads the folder; a ReportError says what is missing if no report is possible."""
    if not folder.is_dir():
        raise ReportError(f"{folder} is no folder: give the output folder of a run.")
    table, summary_file, prm = (folder / name
                                for name in ("layers.csv", "summary.json", "used.prm"))
    text = prm.read_text(errors="replace") if prm.is_file() else ""
    parameters = parse_prm(text) if text else None
    spreading = parameters is not None and parameters.entries.get("process") == "powder spreading"
    if not table.is_file() and spreading:
        raise ReportError(f"{folder} has no layers.csv yet: the run has not started its first layer.")
    if not any(file.is_file() for file in (table, prm, summary_file)):
        raise ReportError(f"{folder} is not the output folder of a run: it has neither layers.csv nor used.prm.")
    try:
        summary = json.loads(summary_file.read_text()) if summary_file.is_file() else None
    except ValueError as error:
        raise ReportError(f"{summary_file} cannot be read: {error}.") from error
    return Run(folder, read_layers(table) if table.is_file() else None, summary, parameters, text)
