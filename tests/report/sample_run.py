"""Makes the output folder of a small spreading run, as the program writes it."""

from __future__ import annotations

import base64
import json
import struct
import zlib
from pathlib import Path

import numpy as np

FIELDS = {"ID": 1, "diameter": 1, "mass": 1, "velocity": 3, "layer": 1, "tracked": 1,
          "displacement": 3, "on_plate": 1, "last_position": 3}

PARAMETERS = """
# Listing of Parameters
set process = powder spreading

subsection simulation control
  set output name = spreading
end
"""

APPARATUS = {
    "x_transfer": 1.5e-3, "x_gap": 2.0e-3, "x_plate": 2.1e-3, "x_plate_end": 3.6e-3,
    "x_exit": 3.7e-3, "x_end": 4.2e-3, "y_bottom": -1e-3, "y_top": 2e-3, "depth": 4e-4,
    "lip": 1e-4, "spreader": "half round", "x_start": -6e-4, "front": 4e-4, "rear": 4e-4,
    "spreader_height": 1.0e-3, "clearance": 1e-4, "n_layers": 3, "layer_thickness": 1e-4,
    "velocity": 0.1, "first_stroke": 5e-4, "stroke": 3e-4, "platform_velocity": 0.03,
    "rest_before_weighing": 0., "replenished": True, "bed_depth": 5e-4,
    "first_bed_depth": 7e-4, "density": 4386.}

LAYERS = """\
layer,time,mass,particles,LRD,CRD,mass_removed,mass_to_gap,mass_to_collector,\
spreader_force_mean,spreader_force_max,wall_seconds
0,0.1,4e-08,60,,,0,1e-08,4e-07,1e-05,1e-04,30
1,0.2,1.6e-07,240,0.5,,2e-08,1e-08,1e-07,2e-06,2e-05,15
2,0.3,2.92e-07,440,0.55,0.55,2e-08,2e-08,1e-07,1e-06,3e-05,16
"""

SUMMARY = {"version": "0.1.0", "git_revision": "abc1234", "particles": 9, "steps": 1000, "ranks": 2,
           "time_step": 2.8e-7, "simulated_time": 0.3, "particle_steps": 1e6,
           "particle_steps_per_second": 1e7, "loop_seconds": 60., "wall_seconds": 61.,
           "inside_mass": 1e-9, "inserted_particles": 20, "inserted_mass": 1e-8,
           "outlet_1_particles": 5, "outlet_1_mass": 3e-9, "mass_balance_error": 0.,
           "seconds_output": 1., "seconds_output_slowest_rank": 2.}


def encoded(values: np.ndarray, block_size: int = 64) -> str:
    """Base64 of the counts of zlib blocks, then of the blocks, as in files of VTK."""
    data = values.astype("<f4").tobytes()
    blocks = [data[k:k + block_size] for k in range(0, len(data), block_size)]
    packed = [zlib.compress(block) for block in blocks]
    counts = [len(blocks), block_size, len(data) % block_size, *map(len, packed)]
    return (base64.b64encode(struct.pack(f"<{len(counts)}I", *counts)).decode()
            + base64.b64encode(b"".join(packed)).decode())


def cells(n: int) -> str:
    """The cells of a VTK file: one vertex for each point."""
    arrays = {("Int32", "connectivity"): range(n), ("Int32", "offsets"): range(1, n + 1), ("UInt8", "types"): n * [1]}
    return "<Cells>\n" + "".join(
        f'<DataArray type="{kind}" Name="{name}" format="ascii">{" ".join(map(str, values))}</DataArray>\n'
        for (kind, name), values in arrays.items()) + "</Cells>\n"


def piece(points: np.ndarray, fields: dict[str, np.ndarray]) -> str:
    """The piece of a VTK file that one rank writes."""
    data = "".join(
        f'<DataArray type="Float32" Name="{name}" NumberOfComponents="{FIELDS[name]}" '
        f'format="binary">\n{encoded(values)}\n</DataArray>\n' for name, values in fields.items())
    return (f'<Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(points)}" >\n<Points>\n'
            '<DataArray type="Float32" NumberOfComponents="3" format="binary">\n'
            f"{encoded(points)}\n</DataArray>\n</Points>\n{cells(len(points))}<PointData>\n{data}</PointData>\n"
            "</Piece>\n")


EMPTY_PIECE = ('<Piece NumberOfPoints="0" NumberOfCells="0" >\n<Cells>\n<DataArray type="UInt8" '
               'Name="types"></DataArray>\n</Cells>\n<PointData>\n<DataArray type="Float32" '
               'Name="mass"></DataArray>\n</PointData>\n</Piece>\n')


def vtu(*pieces: str) -> str:
    time = ('<FieldData>\n<DataArray type="Float32" Name="TIME" NumberOfTuples="1" '
            'format="ascii">0.2</DataArray>\n</FieldData>\n')
    return ('<?xml version="1.0" ?>\n<!-- \n# vtk DataFile Version 3.0\n-->\n'
            '<VTKFile type="UnstructuredGrid" version="0.1" compressor="vtkZLibDataCompressor" '
            f'byte_order="LittleEndian">\n<UnstructuredGrid>\n{time}{time.join(pieces)}'
            "</UnstructuredGrid>\n</VTKFile>\n")


def pvd(entries: list[tuple[float, str]]) -> str:
    lines = "".join(f'<DataSet timestep="{time}" part="0" file="{name}"/>\n'
                    for time, name in entries)
    return f'<VTKFile type="Collection">\n<Collection>\n{lines}</Collection>\n</VTKFile>\n'


def bed(layer: int, n: int = 12) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """A row of particles on the plate after a layer, of which the first half was there before."""
    rows = np.arange(n)
    old = rows < n // 2 if layer > 0 else np.zeros(n, bool)
    points = np.column_stack((np.linspace(0.0022, 0.0035, n), np.full(n, 3e-5 - layer * 1e-4),
                              np.linspace(0., 4e-4, n)))
    displacement = np.zeros((n, 3))
    displacement[old] = [3e-6, 4e-6, 1e-3]  # only x and y count
    return points, {"ID": rows, "diameter": np.full(n, 6e-5), "mass": np.full(n, 5e-10),
                    "velocity": np.ones((n, 3)), "layer": np.where(old, 0, layer),
                    "tracked": 1. * old, "displacement": displacement, "on_plate": np.ones(n)}


def write_run(folder: Path, layers: int = 3, pictures: bool = True, summary: bool = True) -> None:
    """The folder of a run that has weighed so many layers."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "used.prm").write_text(PARAMETERS)
    (folder / "apparatus.json").write_text(json.dumps(APPARATUS))
    rows = LAYERS.splitlines(keepends=True)[:1 + layers]
    (folder / "layers.csv").write_text("".join(rows))
    if summary:
        (folder / "summary.json").write_text(json.dumps(SUMMARY))
    if not pictures:
        return
    entries = []
    for layer in range(layers):
        entries.append((0.1 * (layer + 1), f"spreading_layers_{layer:05d}.vtu"))
        (folder / entries[-1][1]).write_text(vtu(piece(*bed(layer))))
    (folder / "spreading_layers.pvd").write_text(pvd(entries))


def write_pass(folder: Path) -> None:
    """Adds four pictures of particles and solids between the last two weighings of a run of three layers."""
    a = APPARATUS
    level = np.array([[a["x_plate"], 0., 0.], [a["x_plate_end"], 0., 0.], [a["x_plate"], 0., a["depth"]]])
    entries = [(0.2 + 0.02 * k, f"spreading_{k:05d}.vtu") for k in range(1, 5)]
    for k, (_, name) in enumerate(entries):
        points, fields = bed(1)
        fields["last_position"] = points - [1e-5 * k, 0., 0.]
        (folder / name).write_text(vtu(piece(points - [0., 1e-4, 0.], fields)))
        (folder / name.replace("spreading", "spreading_solids")).write_text(vtu(piece(level - [0., 2e-4, 0.], {})))
    (folder / "spreading.pvd").write_text(pvd(entries))
    (folder / "spreading_solids.pvd").write_text(
        pvd([(time, name.replace("spreading", "spreading_solids")) for time, name in entries]))


HEAP = """\
view,direction,projected_area,base_angle,height,base_angle_spread,mass_on_disc,mass_drained
0,0,1.9e-07,37.235,0.0004,,,
1,90,1.9e-07,37.235,0.0004,,,
,,1.9e-07,37.235,0.0004,0,4.5e-07,1.35e-06
"""


def write_heap(folder: Path, inserted_mass: float = 1.8e-6, density: float = 4386.) -> None:
    """The folder of a run of the heap instrument with a disc of 1 mm, on which 0.45 mg lie."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "used.prm").write_text("set process = heap\n\nsubsection simulation control\n"
                                     "  set output name = heap\nend\n")
    (folder / "apparatus.json").write_text(json.dumps({"disc_diameter": 1e-3, "rim_height": 5e-4, "density": density}))
    (folder / "heap.csv").write_text(HEAP)
    (folder / "heap_profile.csv").write_text("x,mean,spread,measured\n-4e-4,1e-4,1e-5,\n"
                                             "0,4e-4,1e-5,4.1e-4\n4e-4,1e-4,1e-5,\n")
    head = "P5\n# left edge at x = -0.0006 m, base line at the lower edge, pixel of 0.0004 m\n3 2\n255\n"
    (folder / "heap_map.pgm").write_bytes(head.encode() + bytes([255, 0, 255, 0, 0, 102]))
    summary = {**SUMMARY, "inserted_mass": inserted_mass, "heap_measured_base_angle": 40.,
               "heap_profile_difference": 1e-5}
    (folder / "summary.json").write_text(json.dumps(summary))
    points, fields = bed(0)
    points[:, 0] -= 2.85e-3
    (folder / "heap_heap_00000.vtu").write_text(vtu(piece(points, fields)))
    (folder / "heap_heap.pvd").write_text(pvd([(0.1, "heap_heap_00000.vtu")]))
