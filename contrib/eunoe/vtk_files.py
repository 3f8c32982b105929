"""Reader of the pictures that Eunoe writes: .vtu, by VTK itself, and their index .pvd; and of points of other programs."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Iterable
from xml.etree import ElementTree

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLogger, vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkIOLegacy import vtkDataSetReader
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader

from eunoe.launch import Failure


class VtkError(Failure):
    """A file that cannot be read, with a sentence that says why."""


@dataclass(frozen=True)
class Snapshot:
    """An entry of a .pvd file: the time (s) and the file with the particles."""

    time: float
    file: Path


# VTK would print its complaints; the caller gets one sentence instead.
vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
GHOST = "vtkGhostType"  # ParaView's point data: not 0 for ghosts
# Beginning of VTK's message for a picture without particles, for which deal.II writes no points.
WITHOUT_POINTS = "No Points element available in first piece"


def _complaint(step: Callable[[], None]) -> str:
    """Runs a step of VTK and returns its complaint."""
    complaints, window = vtkStringOutputWindow(), vtkOutputWindow.GetInstance()
    vtkOutputWindow.SetInstance(complaints)
    try:
        step()
    finally:
        vtkOutputWindow.SetInstance(window)
    return complaints.GetOutput()


def read_vtu(path: Path, names: Iterable[str] | None) -> dict[str, np.ndarray]:
    """Points and point data of a .vtu file, from all its pieces (one for each rank) together.

    The coordinates (m) come under the name 'points'; of the point data only those named are read (None: all),
    and those that the file lacks are left out.
    """
    wanted = None if names is None else set(names)
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    complaint = _complaint(reader.UpdateInformation) if path.is_file() else "no file"
    if not complaint:
        fields = reader.GetPointDataArraySelection()
        for k in range(fields.GetNumberOfArrays()):
            name = fields.GetArrayName(k)
            fields.SetArraySetting(name, wanted is None or name in wanted)
        complaint = _complaint(reader.Update)
    if WITHOUT_POINTS in complaint:
        return {"points": np.empty((0, 3), np.float32)}
    if complaint:
        raise VtkError(f"{path.name} cannot be read: it is missing or not complete.")
    grid = reader.GetOutput()
    data = grid.GetPointData()
    arrays = {data.GetArrayName(k): vtk_to_numpy(data.GetArray(k)) for k in range(data.GetNumberOfArrays())}
    return {"points": vtk_to_numpy(grid.GetPoints().GetData()), **arrays}


def joined(parts: list[dict[str, np.ndarray]]) -> dict[str, np.ndarray]:
    """Points and point data of several files together, of the fields that all with points have."""
    full = [part for part in parts if len(part["points"])] or parts[:1]
    names = set.intersection(*map(set, full))
    return {name: np.concatenate([part[name] for part in full]) for name in names}


def files_of_pieces(path: Path) -> list[Path]:
    """The files that a .pvtu or .pvtp file names, one for each rank that wrote."""
    try:
        found = [path.parent / piece.attrib["Source"] for piece in ElementTree.parse(path).getroot().iter("Piece")]
    except (OSError, ElementTree.ParseError, KeyError) as error:
        raise VtkError(f"{path.name} cannot be read: it is missing or not complete.") from error
    if not found:
        raise VtkError(f"{path.name} names no file of a piece.")
    return found


def read_points(path: Path, names: Iterable[str]) -> dict[str, np.ndarray]:
    """The same of points in any file of VTK: .vtu, .vtp, their lists of pieces .pvtu and .pvtp, or the older .vtk; without
    ghosts, which are copies of the points of another piece, or hidden."""
    if path.suffix in (".pvtu", ".pvtp"):
        return joined([read_points(piece, names) for piece in files_of_pieces(path)])
    fields = (read_vtu if path.suffix == ".vtu" else _read_others)(path, (*names, GHOST))
    ghosts = fields.pop(GHOST, np.zeros(len(fields["points"])))
    return {name: values[ghosts == 0] for name, values in fields.items()}


def _read_others(path: Path, names: Iterable[str]) -> dict[str, np.ndarray]:
    """Of .vtp and .vtk files."""
    if path.suffix not in (".vtp", ".vtk"):
        raise VtkError(f"{path.name} is of a kind that is not read. Give .vtu, .vtp, .pvtu, .pvtp, .vtk or .pvd.")
    reader = vtkXMLPolyDataReader() if path.suffix == ".vtp" else vtkDataSetReader()
    reader.SetFileName(str(path))
    if isinstance(reader, vtkDataSetReader):
        reader.ReadAllScalarsOn()
        reader.ReadAllFieldsOn()
    complaint = _complaint(reader.Update) if path.is_file() else "no file"
    data = reader.GetOutput()
    if complaint or data is None:
        raise VtkError(f"{path.name} cannot be read: it is missing or not complete.")
    points = np.array([data.GetPoint(k) for k in range(data.GetNumberOfPoints())]).reshape(-1, 3)
    arrays = data.GetPointData()
    return {"points": points, **{name: vtk_to_numpy(arrays.GetArray(name)) for name in names if arrays.HasArray(name)}}


def points_of_pieces(path: Path) -> list[int]:
    """How many points each piece (rank) of a .vtu file has."""
    return [int(piece.get("NumberOfPoints", 0)) for piece in ElementTree.parse(path).getroot().iter("Piece")]


def read_pvd(path: Path) -> list[Snapshot]:
    """The entries of a .pvd file; none if the file does not exist."""
    if not path.is_file():
        return []
    try:
        root = ElementTree.parse(path).getroot()
        return [Snapshot(float(entry.attrib["timestep"]), path.parent / entry.attrib["file"])
                for entry in root.iter("DataSet")]
    except (ElementTree.ParseError, KeyError, ValueError) as error:
        raise VtkError(f"{path.name} cannot be read: it is not complete.") from error


def files_by_time(path: Path) -> list[list[Path]]:
    """The files of each time in a .pvd file: where a picture has several parts, each is an entry of its own."""
    found: dict[float, dict[Path, None]] = {}
    for entry in read_pvd(path):
        found.setdefault(entry.time, {})[entry.file] = None
    return [list(files) for files in found.values()]
