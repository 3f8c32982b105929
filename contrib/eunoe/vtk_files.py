"""Reader of the pictures that Eunoe writes: .vtu, by VTK itself, and their index .pvd."""

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


def read_points(path: Path, names: Iterable[str]) -> dict[str, np.ndarray]:
    """The same of points in any file of VTK: .vtu, .vtp, or the older .vtk."""
    if path.suffix == ".vtu":
        return read_vtu(path, names)
    reader = vtkXMLPolyDataReader() if path.suffix == ".vtp" else vtkDataSetReader()
    reader.SetFileName(str(path))
    if isinstance(reader, vtkDataSetReader):
        reader.ReadAllScalarsOn()
        reader.ReadAllFieldsOn()
    complaint = _complaint(reader.Update) if path.is_file() else "no file"
    data = reader.GetOutput()
    if complaint or data is None or data.GetNumberOfPoints() == 0:
        raise VtkError(f"{path.name} cannot be read: it is missing, not complete, or has no points.")
    points = np.array([data.GetPoint(k) for k in range(data.GetNumberOfPoints())])
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
