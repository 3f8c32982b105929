"""Particles of other programs are measured as a run measures its own: a heap's and a spreading's particles
give the run's numbers again, dumps that LAMMPS and LIGGGHTS wrote are read rightly in any unit and frame, and
bad files are refused with a sentence.

Usage: measure.py path/to/many-runs folder
Exit code 77, which skips the test, if numpy or VTK is missing.
"""

import contextlib
import importlib.util
import io
import shutil
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from unittest import mock

if any(importlib.util.find_spec(name) is None for name in ("numpy", "vtkmodules")):
    sys.exit(77)
import numpy as np

from eunoe import commands
from eunoe.discovery.particle_files import read_particles
from eunoe.launch import Failure, overrides
from eunoe.repository import ROOT
from eunoe.vtk_files import read_vtu
from many_runs import ManyRuns

HERE = Path(__file__).resolve().parent
HEAP, SPREADING = HERE.parent / "heap" / "tiny.prm", HERE.parent / "spreading" / "tiny.prm"
# What the files of LAMMPS and LIGGGHTS beside this one hold: places and diameters (m), in any order.
GRAINS = np.array([[0., 4e-5, 0., 8e-5], [8e-5, 3e-5, 1e-5, 6e-5], [-2e-4, 5e-5, 1e-4, 1e-4],
                   [2e-5, 1.2e-4, -1e-5, 9e-5], [4e-4, -6e-4, 0., 9e-5]])


class Program:
    """eunoe-particles, also where the tool starts it; a process of its own for each start would take longer than
    the rest."""

    runs: ManyRuns

    @classmethod
    def start(cls, command: list[str], **_: object) -> subprocess.CompletedProcess:
        return cls.runs(*command[1:], cwd=Path.cwd())


def program(*words: str) -> subprocess.CompletedProcess:
    return Program.start(["eunoe-particles", *words])


def tool(*words: str) -> subprocess.CompletedProcess:
    output, errors = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(output), contextlib.redirect_stderr(errors):
        code = commands.run("measure", list(words))
    return subprocess.CompletedProcess(words, code, output.getvalue(), errors.getvalue())


def measured(*words: str) -> dict[tuple[str, str], float]:
    done = tool(*words)
    assert done.returncode == 0, done.stderr
    rows = [line.split(",") for line in done.stdout.splitlines()]
    assert rows[0] == ["observable", "index", "value", "unit"], rows[0]
    return {(name, index): float(value) for name, index, value, _ in rows[1:]}


def run(case: Path, folder: Path, *settings: str) -> dict[tuple[str, str], float]:
    """Runs a case; what it measured."""
    program(str(case), "--quiet", *overrides(
        [f"simulation control/output path = {folder}", "post-processing/final state/calculation = true",
         *settings])).check_returncode()
    lines = (folder / "measurements.csv").read_text(encoding="utf-8").splitlines()[1:]
    return {(name, index): float(value) for name, index, value, _ in (line.split(",") for line in lines)}


def check_heap(folder: Path) -> None:
    own = run(HEAP, folder)
    again = measured(str(HEAP), str(folder / "particles.csv"))
    assert set(own) - set(again) == {("mass_drained", "0")}, set(own) ^ set(again)
    for key, value in again.items():
        # The mass follows from the diameter again.
        assert value == own[key] or (key[0] == "mass_on_disc" and abs(value / own[key] - 1.) < 1e-12), (key, value)
    # The picture has floats; the heap turned, moved and in millimetres is the same heap.
    picture = measured(str(HEAP), str(folder / "heap_heap.pvd"))
    assert len(read_vtu(next(folder.glob("heap_heap*.vtu")), [])["points"]) == len(read_particles(folder / "particles.csv"))
    rows = read_particles(folder / "particles.csv")
    turned = np.column_stack((rows[:, 0] * 1e3 + 5., -rows[:, 2] * 1e3, rows[:, 1] * 1e3 + 1., rows[:, 3] * 1e3))
    np.savetxt(folder / "turned.csv", turned, delimiter=",", header="x,y,z,d", comments="", fmt="%.17g")
    moved = measured(str(HEAP), str(folder / "turned.csv"), "--up", "z", "--origin", "5", "-1e-12", "1", "--scale", "1e-3")
    # A grain that falls on the heap does not belong to it yet, although it is near.
    falling = rows[:, 1].max() + 2.5 * rows[:, 3].max()
    np.savetxt(folder / "falls.csv", np.vstack((rows, [1e-4, falling, 0., 7e-5])), delimiter=",", header="x,y,z,d", comments="",
               fmt="%.17g")
    falls = measured(str(HEAP), str(folder / "falls.csv"))
    for other, tolerance in ((picture, 1e-5), (moved, 1e-9), (falls, 1e-9)):
        assert set(other) == set(again)
        for key, value in other.items():
            scale = abs(again[key]) + (1e-3 if key[0] in ("base_angle_spread", "solid_fraction") else 0.)
            assert abs(value - again[key]) <= tolerance * scale * 30., (key, value, again[key])


def check_study_table(folder: Path) -> None:
    one, taller = str(folder / "particles.csv"), str(folder / "taller.csv")
    rows = read_particles(folder / "particles.csv") * (1., 1.01, 1., 1.)
    np.savetxt(taller, rows, delimiter=",", header="x,y,z,d", comments="", fmt="%.17g")
    done = tool(str(HEAP), "--experiment", "pile", "--held-out", "--only", "height", one, taller)
    assert done.returncode == 0, done.stderr
    head, row = done.stdout.split()
    assert head == "experiment,observable,index,value,std,repeats,use"
    *_, std, repeats, use = row.split(",")
    assert row.startswith("pile,height,0,") and float(std) > 0. and (repeats, use) == ("2", "held-out"), row
    # What does not scatter is left out, as a study refuses it.
    done = tool(str(HEAP), "--experiment", "pile", "--only", "height", one, one)
    assert done.returncode == 0 and done.stdout.split() == [head], (done.stdout, done.stderr)
    done = tool(str(HEAP), "--only", "beauty", one)
    assert done.returncode == 1 and "does not measure 'beauty'" in done.stderr, done.stderr


def check_spreading(folder: Path) -> None:
    own = run(SPREADING, folder, "powder spreading/layer pictures = true")
    again = measured(str(SPREADING), str(folder / "particles.csv"))
    last = max(int(index) for name, index in own if name == "mass")
    assert {key for key in own if key[0] in ("surface_height", "surface_roughness", "mean_diameter", "solid_fraction")
            or key in (("mass", str(last)), ("particles", str(last)))} == set(again), again
    for key, value in again.items():
        # When a run weighs, in the first step after the time for it, the plate has begun its next stroke.
        assert abs(value - own[key]) <= 1e-6 * abs(own[key]), (key, value, own[key])
    beside = read_particles(folder / "particles.csv") + (0., 0., 1., 0.)
    np.savetxt(folder / "beside.csv", beside, delimiter=",", header="x,y,z,d", comments="", fmt="%.17g")
    done = tool(str(SPREADING), str(folder / "beside.csv"))
    assert done.returncode == 1 and "On the measuring plate there is a particle at z = 1" in done.stderr, done.stderr
    layers = sorted(folder.glob("*_layers*.vtu"))
    layers = [file for file in layers if "solids" not in file.name]
    assert len(layers) == last + 1, layers
    weighed = measured(str(SPREADING), ",".join(map(str, layers)))
    for name, first in (("mass", 0), ("particles", 0), ("LRD", 1), ("CRD", 2)):
        for layer in range(first, last + 1):
            value, wanted = weighed[name, str(layer)], own[name, str(layer)]
            assert abs(value - wanted) <= 1e-5 * abs(wanted) + 1e-12, (name, layer, value, wanted)
    done = tool(str(SPREADING), ",".join(map(str, layers[:-1])) if len(layers) > 2 else ",".join([str(layers[0])] * 9))
    assert done.returncode == 1 and "one for each layer" in done.stderr, done.stderr


def check_others() -> None:
    for name in ("lammps.dump", "liggghts.dump", "liggghts.vtk"):
        rows = read_particles(HERE / name)
        rows = rows[np.lexsort((rows[:, 0], rows[:, 3]))]
        wanted = GRAINS[np.lexsort((GRAINS[:, 0], GRAINS[:, 3]))]
        assert np.abs(rows - wanted).max() < 2e-9, f"{name}:\n{rows}"
    found = measured(str(HEAP), str(HERE / "liggghts.dump"))
    # The highest sphere is seen in every view; the sphere below the disc counts for nothing.
    assert abs(found["height", "0"] - 165e-6) < 1e-6, found
    volume = np.pi / 6. * (GRAINS[:4, 3]**3).sum()
    density = 4386.
    assert abs(found["mass_on_disc", "0"] / (density * volume) - 1.) < 1e-6, found
    first = read_particles(HERE / "liggghts.dump", 0)
    assert (first[:, :3] != read_particles(HERE / "liggghts.dump", -1)[:, :3]).any(), "the snapshots are alike"


def check_tables(folder: Path) -> None:
    """Separators at the end of lines are no cells, where they are not those of a last column that is empty."""
    for text in ("x,y,z,d\n1,2,3,4\n", "p_x; p_y; p_z; diameters;\n1; 2; 3; 4;\n", "x;y;z;d;\n1;2;3;4\n", "x,y,z,d\n1,2,3,4,\n",
                 "x,y,z,d,,\n1,2,3,4,,\n,,,,,\n", "# grains\nx,y,z,d,note\n1,2,3,4,\n", "note,x,y,z,r\nbig,1,2,3,2\n"):
        (folder / "table.csv").write_text(text, encoding="utf-8")
        assert read_particles(folder / "table.csv").tolist() == [[1., 2., 3., 4.]], text


def write_vtu(path: Path, rows: np.ndarray, ghosts: list[int] | None = None) -> None:
    """A file of points as deal.II and ParaView write it."""
    def array(kind: str, name: str, values: np.ndarray, n: int = 1) -> str:
        text = " ".join(map(str, np.ravel(values)))
        return f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{n}" format="ascii">{text}</DataArray>'
    n = len(rows)
    fields = array("Float64", "radius", rows[:, 3] / 2.) + (array("UInt8", "vtkGhostType", ghosts) if ghosts else "")
    cells = (array("Int32", "connectivity", range(n)) + array("Int32", "offsets", range(1, n + 1))
             + array("UInt8", "types", [1] * n))
    path.parent.mkdir(exist_ok=True)
    path.write_text('<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"><UnstructuredGrid>'
                    f'<Piece NumberOfPoints="{n}" NumberOfCells="{n}">'
                    f'<Points>{array("Float64", "Points", rows[:, :3], 3)}</Points><Cells>{cells}</Cells>'
                    f"<PointData>{fields}</PointData></Piece></UnstructuredGrid></VTKFile>", encoding="utf-8")


def check_pictures_in_parts(folder: Path) -> None:
    """A picture in several files, one for each rank that wrote, is read as a whole, without its ghosts."""
    write_vtu(folder / "parts" / "0.vtu", GRAINS[:2])
    write_vtu(folder / "parts" / "1.vtu", GRAINS[1:4], [1, 0, 0])
    write_vtu(folder / "parts" / "2.vtu", GRAINS[:0])
    write_vtu(folder / "parts" / "3.vtu", GRAINS[4:])

    def pvtu(name: str, *pieces: str) -> None:
        (folder / name).write_text('<VTKFile type="PUnstructuredGrid"><PUnstructuredGrid>' + "".join(
            f'<Piece Source="{piece}"/>' for piece in pieces) + "</PUnstructuredGrid></VTKFile>", encoding="utf-8")

    def pvd(name: str, *entries: tuple[str, str]) -> None:
        (folder / name).write_text('<VTKFile type="Collection"><Collection>' + "".join(
            f'<DataSet timestep="{time}" part="{part}" file="{file}"/>' for part, (time, file) in enumerate(entries))
            + "</Collection></VTKFile>", encoding="utf-8")

    pvtu("all.pvtu", *(f"parts/{k}.vtu" for k in (2, 0, 1, 3)))
    pvtu("parts/last.pvtu", "3.vtu")
    pvtu("none.pvtu", "parts/2.vtu")
    pvd("parts.pvd", ("0", "parts/0.vtu"), ("0", "parts/1.vtu"), ("0", "parts/3.vtu"), ("1", "parts/0.vtu"),
        ("1.0", "parts/2.vtu"))
    pvd("lists.pvd", ("0", "all.pvtu"), ("0.5", "parts/last.pvtu"))
    for name, snapshot, wanted in (("all.pvtu", -1, GRAINS), ("parts.pvd", 0, GRAINS), ("parts.pvd", 1, GRAINS[:2]),
                                   ("parts.pvd", -1, GRAINS[:2]), ("lists.pvd", 0, GRAINS), ("lists.pvd", -1, GRAINS[4:])):
        found = read_particles(folder / name, snapshot)
        # Ghosts are no grains, and what is a ghost in one piece is a grain of another.
        assert found.shape == wanted.shape and np.abs(found - wanted).max() < 1e-12, f"{name}, {snapshot}:\n{found}"
    pvtu("lacks.pvtu", "parts/0.vtu", "parts/9.vtu")
    (folder / "blocks.vtm").write_text("<VTKFile/>", encoding="utf-8")
    for name, sentence in (("none.pvtu", "none.pvtu: it has no particles."), ("lacks.pvtu", "9.vtu cannot be read"),
                           ("blocks.vtm", "blocks.vtm is of a kind that is not read."), ("parts.pvd", "it has no picture 2")):
        try:
            read_particles(folder / name, 2)
        except Failure as error:
            assert sentence in str(error), error
        else:
            raise AssertionError(f"{name} was read.")


def check_refusals(folder: Path) -> None:
    text = (HERE / "liggghts.dump").read_text(encoding="utf-8")
    cut = len(text.splitlines()) - 2
    for name, content, sentence in (
            ("cut.dump", "\n".join(text.splitlines()[:cut]), f"cut.dump:{cut + 1}: the file ends within a snapshot."),
            ("words.dump", text.replace("4.5e-05", "wide"), "words.dump:10: this is no particle with 9 numbers."),
            ("blind.dump", text.replace("radius", "v_r"), "the dump has no radii. Write"),
            ("points.dump", text.replace(" x y z ", " a b c "), "the dump has no places. Write"),
            ("columns.csv", "x,y,depth\n1,2,3\n", "columns.csv:1: the head has no column 'z'"),
            ("words.csv", "x,y,z,d\n1,2,3,4\n1,2,3\n", "words.csv:3: this is no row of 4 numbers"),
            ("commas.csv", "x,y,z,d\n0,0003,0,0001,0,0,0,00008\n", "perhaps the numbers have decimal commas."),
            ("two_commas.csv", "x;y;z;d\n0,1;0;0;1\n", "perhaps the numbers have decimal commas."),
            ("flat.csv", "x,y,z,d\n0,0,0,0\n", "particle 1 has no finite place or no positive size"),
            ("far.csv", "x,y,z,d\n1,1,1,1e-4\n", "far.csv: None of the 1 particles lies on the disc"),
            ("large.csv", "x,y,z,diameter\n0,1e-4,0,2e-4\n", "a mean diameter of 200 um"),
            ("empty.vtu", "nothing", "cannot be read"),
            ("empty.csv", "", "it is empty")):
        (folder / name).write_text(content, encoding="utf-8")
        done = tool(str(HEAP), str(folder / name))
        assert done.returncode == 1 and sentence in done.stderr and len(done.stderr.splitlines()) == 1, (name, done.stderr)
        assert "Traceback" not in done.stderr
    done = tool(str(HEAP), str(folder / "missing.csv"))
    assert done.returncode == 2 and "missing.csv cannot be used" in done.stderr, done.stderr
    for words, sentence in ((["--measure", str(folder / "columns.csv")], "the header has no column 'z'"),
                            (["--measure", str(folder / "missing.csv")], "missing.csv")):
        done = program(str(HEAP), *words)
        assert done.returncode == 2 and sentence in done.stderr, (words, done.stderr)
    done = program(str(ROOT / "prm" / "examples" / "bouncing_sphere.prm"), "--measure", "no.csv")
    assert done.returncode == 2 and "has no process" in done.stderr, done.stderr


def main() -> int:
    folder = Path(sys.argv[2])
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    Program.runs = ManyRuns(sys.argv[1], folder / "printed")
    with mock.patch("eunoe.discovery.measure.subprocess", SimpleNamespace(run=Program.start)):
        check_others()
        check_tables(folder)
        check_pictures_in_parts(folder)
        check_refusals(folder)
        check_heap(folder / "heap")
        check_study_table(folder / "heap")
        check_spreading(folder / "spreading")
    Program.runs.close()
    print("ok")
    return 0


if __name__ == "__main__":
    sys.exit(main())
