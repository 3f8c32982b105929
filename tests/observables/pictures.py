"""Pictures of mesh cells, contacts and particles, on one rank and on two: averages over particles
that were placed by hand, and Hertz's force of known overlaps, also across a periodic face.

Usage: pictures.py path/to/eunoe-particles folder
"""

from __future__ import annotations

import math
import subprocess
import sys
from pathlib import Path

import numpy as np

from eunoe.launch import SHARED, mpirun, overrides
from eunoe.vtk_files import read_pvd, read_vtu

CASE = Path(__file__).with_name("pictures.prm")
DIAMETER = 1e-3
WIDTH = 5e-3  # of a mesh cell; the mesh spans -1 cm to 1 cm
# Relative tolerance of pictures, which have single precision.
TOLERANCE = 3e-6
CELL_FIELDS = ("velocity", "granular_temperature", "solid_fraction", "particles")


def run(program: str, folder: Path, ranks: int, settings: tuple[str, ...] = ()) -> None:
    settings = (f"simulation control/output path = {folder}", *settings)
    subprocess.run([*mpirun(ranks, *SHARED), program, str(CASE), "--quiet", *overrides(settings)], check=True)


def last(folder: Path, name: str, fields: tuple[str, ...]) -> dict[str, np.ndarray]:
    return read_vtu(read_pvd(folder / f"{name}.pvd")[-1].file, fields)


def cells(folder: Path) -> dict[tuple[int, ...], dict[str, np.ndarray]]:
    """The fields of every mesh cell by its place; the eight corners of each must agree."""
    data = last(folder, "out_cells", CELL_FIELDS)
    found = {}
    for first in range(0, len(data["points"]), 8):
        centre = data["points"][first:first + 8].mean(axis=0)
        fields = {}
        for name in CELL_FIELDS:
            values = data[name][first:first + 8]
            assert (values == values[0]).all(), f"{name} varies in a cell"
            fields[name] = values[0]
        found[tuple(np.floor((centre + 1e-2) / WIDTH).astype(int).tolist())] = fields
    return found


def close(value, reference, what: str) -> None:
    assert np.allclose(value, reference, rtol=TOLERANCE, atol=1e-12), \
        f"{what}: {value} instead of {reference}"


def check_cells(folder: Path) -> None:
    found = cells(folder)
    assert len(found) == 64, f"{len(found)} cells"
    volume = math.pi / 6 * DIAMETER**3
    expected = {
        # Three particles with velocities (1, 0, 0), (0, 2, 0), (-1, 1, 3): mean (0, 1, 1); squares
        # of the deviations 1 + 1 + 1, 0 + 1 + 1, 1 + 0 + 4.
        (0, 0, 0): (3, (0, 1, 1), (3 + 2 + 5) / 9),
        # One that has crossed the face x = 0 since the last search, with 20 m/s, and one at rest that
        # lies on it: mean 10, deviations 10 and -10 in one direction.
        (2, 2, 2): (2, (10, 0, 0), (100 + 100) / 2 / 3),
        # Two that overlap, and two that do so across the periodic faces.
        (0, 3, 0): (1, (0, 0, 0), 0.), (3, 3, 0): (1, (0, 0, 0), 0.),
        (1, 1, 3): (2, (0, 0, 0), 0.),
    }
    for place, cell in found.items():
        number, velocity, temperature = expected.get(place, (0, (0, 0, 0), 0.))
        close(cell["particles"], number, f"particles in {place}")
        close(cell["solid_fraction"], number * volume / WIDTH**3, f"solid fraction in {place}")
        if place not in ((0, 3, 0), (3, 3, 0), (1, 1, 3)):  # these push each other
            close(cell["velocity"], velocity, f"velocity in {place}")
            close(cell["granular_temperature"], temperature, f"temperature in {place}")


def hertz(radius: float, overlap: float) -> float:
    young = 1e6 / (2 * (1 - 0.3**2))
    return 4 / 3 * young * math.sqrt(radius) * overlap**1.5


def check_contacts(folder: Path) -> None:
    names = ("normal_force", "tangential_force", "overlap", "first", "second", "solid")
    data = last(folder, "out_force_chains", names)
    lines = {(int(data["first"][k]), int(data["second"][k])): k
             for k in range(0, len(data["points"]), 2)}
    assert set(lines) == {(6, 7), (8, 9)}, f"contacts {sorted(lines)}"
    for (first, second), overlap in (((6, 7), 2e-5), ((8, 9), 4e-5)):
        k = lines[first, second]
        # In the two steps before the picture they have hardly moved.
        assert abs(data["overlap"][k] - overlap) < 2e-3 * overlap, f"overlap {data['overlap'][k]}"
        force = hertz(DIAMETER / 4, float(data["overlap"][k]))
        assert abs(data["normal_force"][k] - force) < 1e-3 * force, "not Hertz's force"
        assert data["tangential_force"][k] < 1e-6 * force and data["solid"][k] == -1
        length = np.linalg.norm(data["points"][k + 1] - data["points"][k])
        assert abs(length - (DIAMETER - overlap)) < 1e-3 * overlap + 1e-8, f"length {length}"
    assert data["points"][lines[8, 9] + 1][0] < -1e-2, "the line ends within the domain"

    fields = ("ID", "coordination_number", "normal_force_per_contact")
    particles = last(folder, "out", fields)
    for number, coordination, force in zip(*(particles[name] for name in fields)):
        assert coordination == (1 if number >= 6 else 0), f"particle {number}: {coordination}"
        if number >= 6:
            k = lines[(6, 7) if number < 8 else (8, 9)]
            close(force, data["normal_force"][k], "force per contact")


def check_tangential_force(program: str, folder: Path) -> None:
    """Mindlin's spring of two particles that overlap and spin in the same sense, after two
    steps."""
    spin, overlap, step = 10., 2e-5, 1e-6
    run(program, folder, 1, (f"insertion info/list omega z = 0, 0, 0, 0, 0, {spin}, {spin}, 0, 0",))
    data = last(folder, "out_force_chains", ("tangential_force", "first"))
    force = float(data["tangential_force"][list(data["first"]).index(6)])
    shear_modulus = 1e6 / (4 * (2 - 0.3) * (1 + 0.3))
    expected = 8 * shear_modulus * math.sqrt(DIAMETER / 4 * overlap) * DIAMETER * spin * 2 * step
    # In this time the spring slows the spins by three in a thousand.
    assert abs(force - expected) < 5e-3 * expected, f"tangential force {force} instead of {expected}"


def check_moving_mesh(program: str, folder: Path) -> None:
    """A mesh that turns by pi/2 + 0.2 rad while a particle rests near its middle."""
    angle = math.pi / 2 + 0.2
    lists = [f"insertion info/list {axis} = 1e-3" for axis in "xyz"]
    lists += [f"insertion info/list velocity {axis} = 0" for axis in "xyz"]
    run(program, folder, 1, ("DEM boundary conditions/boundary condition 0/type = fixed_wall",
                             "insertion info/list diameters = 1e-3", *lists,
                             "grid motion/motion type = rotational", "grid motion/grid rotational axis = 2",
                             f"grid motion/grid rotational speed = {angle / 1e-3}",
                             "simulation control/iteration end = 1000",
                             "simulation control/output frequency = 1000"))
    data = last(folder, "out_cells", ("particles",))
    corners = 1e-2 * np.array([(x, y) for x in (-1, 1) for y in (-1, 1)])
    turned = corners @ np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
    far = np.linalg.norm(data["points"][:, :2], axis=1) > 1.41e-2
    for corner in turned:
        nearest = np.linalg.norm(data["points"][far][:, :2] - corner, axis=1).min()
        assert nearest < 1e-8, f"no cell at {corner}"
    # The particle stays where it is and is counted in the cell that has moved there.
    holds = data["particles"] == 1
    assert np.count_nonzero(holds) == 8
    centre = data["points"][holds].mean(axis=0)
    away = 1e-3 - centre
    away[:2] = away[:2] @ np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    assert (np.abs(away) <= 0.5 * WIDTH).all(), f"the particle is {away} from the middle of its cell"


def main(program: str, folder: Path) -> int:
    for ranks in (1, 2):
        run(program, folder / str(ranks), ranks)
        check_cells(folder / str(ranks))
        check_contacts(folder / str(ranks))
    one, two = cells(folder / "1"), cells(folder / "2")
    for place, fields in one.items():
        for name, value in fields.items():
            assert (value == two[place][name]).all(), f"{name} in {place} differs on two ranks"
    check_tangential_force(program, folder / "tangential")
    check_moving_mesh(program, folder / "moving")
    print("ok")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], Path(sys.argv[2])))
