"""The mesh and the particles' positions of a run."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from eunoe.launch import Failure
from eunoe.prm_file import MissingEntry, Parameters, parse_prm
from eunoe.vtk_files import read_vtu

from .apparatus import mesh_of
from .mesh import Mesh


def _numbers(text: str) -> list[float]:
    return [float(word) for word in text.split(",")]


def _mesh_of_input(prm: Parameters, reach: float) -> Mesh:
    mesh = prm.section("mesh")
    if mesh.text("grid type") != "subdivided_hyper_rectangle":
        raise Failure("Only meshes of the grid type 'subdivided_hyper_rectangle' can be looked at.")
    _, lower, upper = (mesh.text("grid arguments").split(":") + ["", ""])[:3]
    scale = mesh.number("scale")
    periodic = [False, False, False]
    conditions = prm.section("DEM boundary conditions")
    for section in conditions.sections.values():
        if section.text("type") == "periodic":
            periodic[int(section.number("periodic direction"))] = True
    return Mesh.over(tuple(scale * v for v in _numbers(lower)),
                     tuple(scale * v for v in _numbers(upper)), tuple(periodic), reach)


def read(file: Path, skin: float) -> tuple[Mesh, np.ndarray, np.ndarray]:
    """Mesh, centres and diameters (m) of a picture in the output folder of a run, for a skin as a
    share of the largest diameter: the mesh is that over the box of its used.prm, or over its
    apparatus."""
    folder = file.resolve().parent
    try:
        data = read_vtu(file, ["diameter"])
        points = data["points"].astype(float)
        if len(points) == 0:
            raise Failure(f"{file} holds no particles. Choose a later picture.")
        diameters = data["diameter"].astype(float)
        apparatus = folder / "apparatus.json"
        if apparatus.is_file():
            mesh = mesh_of(json.loads(apparatus.read_text(encoding="utf-8")), diameters.max(), skin)
        else:
            mesh = _mesh_of_input(parse_prm((folder / "used.prm").read_text(encoding="utf-8")),
                                  (1. + skin) * diameters.max())
        return mesh, points, diameters
    except OSError as error:
        raise Failure(f"{error.filename} cannot be read. A picture is looked at in the output "
                      "folder of its run, beside used.prm.") from error
    except (MissingEntry, ValueError, KeyError) as error:
        raise Failure(f"The mesh of {folder} is not understood: {error}") from error
