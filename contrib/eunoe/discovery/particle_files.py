"""Particles in the files of other programs: dumps of LAMMPS and LIGGGHTS, pictures of VTK, tables."""

from __future__ import annotations

from pathlib import Path
from typing import TextIO

import numpy as np

from eunoe.launch import Failure

# Coordinates in a dump: wrapped, unwrapped, and as shares of the box.
PLAIN, SCALED = (("x", "y", "z"), ("xu", "yu", "zu")), (("xs", "ys", "zs"), ("xsu", "ysu", "zsu"))
MEND = "Write the places and the radii: 'dump ... custom N file id x y z radius'."


class Dump:
    """A text dump of LAMMPS or LIGGGHTS, read line by line."""

    def __init__(self, path: Path, file: TextIO) -> None:
        self.path, self.file, self.number = path, file, 0

    def complain(self, what: str, mend: str = "Write the dump again; perhaps the program was stopped.") -> Failure:
        return Failure(f"{self.path}:{self.number}: {what} {mend}")

    def line(self) -> str:
        self.number += 1
        text = self.file.readline()
        if not text:
            raise self.complain("the file ends within a snapshot.")
        return text.strip()

    def numbers(self, least: int) -> list[float]:
        text = self.line()
        try:
            values = [float(word) for word in text.split()]
        except ValueError:
            values = []
        if len(values) < least:
            raise self.complain(f"'{text[:40]}' stands where {least} numbers should.")
        return values

    def bounds(self, head: str) -> np.ndarray:
        """Lower and upper sides of the box."""
        sides = [self.numbers(2)[:2] for _ in range(3)]
        if "xy" in head.split():
            raise self.complain("the box is tilted.", "Give a dump of a box with right angles.")
        return np.array(sides)

    def atoms(self, columns: list[str], n: int, box: np.ndarray | None) -> np.ndarray:
        """Places and diameters of the particles of a snapshot."""
        names = next((names for names in PLAIN + SCALED if set(names) <= set(columns)), None)
        size = next((name for name in ("radius", "diameter") if name in columns), None)
        if names is None or size is None:
            raise self.complain(f"the dump has no {'places' if names is None else 'radii'}.", MEND)
        wanted = [columns.index(name) for name in (*names, size)]
        rows = np.empty((n, 4))
        for row in rows:
            words = self.line().split()
            try:
                row[:] = [float(words[k]) for k in wanted]
            except (ValueError, IndexError):
                raise self.complain(f"this is no particle with {len(columns)} numbers.") from None
        if names in SCALED:
            if box is None:
                raise self.complain("the places are shares of a box that the dump does not give.", MEND)
            rows[:, :3] = box[:, 0] + rows[:, :3] * (box[:, 1] - box[:, 0])
        if size == "radius":
            rows[:, 3] *= 2.
        return rows

    def snapshots(self) -> list[np.ndarray]:
        found: list[np.ndarray] = []
        n, box = -1, None
        while True:
            self.number += 1
            head = self.file.readline()
            if not head:
                return found
            head = head.strip()
            if head.startswith("ITEM: NUMBER OF ATOMS"):
                n = int(self.numbers(1)[0])
            elif head.startswith("ITEM: BOX BOUNDS"):
                box = self.bounds(head)
            elif head.startswith("ITEM: ATOMS"):
                if n < 0:
                    raise self.complain("particles come before their number.")
                found.append(self.atoms(head.split()[2:], n, box))
            elif head.startswith("ITEM:"):
                self.line()  # a time, or what only LIGGGHTS or LAMMPS says
            elif head:
                raise self.complain(f"'{head[:40]}' stands where an 'ITEM:' should.")


def from_dump(path: Path, snapshot: int) -> np.ndarray:
    with open(path, encoding="utf-8", errors="replace") as file:
        found = Dump(path, file).snapshots()
    try:
        return found[snapshot]
    except IndexError:
        raise Failure(f"{path}: it has {len(found)} snapshots. Give --snapshot a number between 0 and "
                      f"{len(found) - 1}, or -1 for the last.") from None


def from_vtk(path: Path, snapshot: int) -> np.ndarray:
    """Points with the field 'diameter' or 'radius' of a picture, or of the pictures in an index .pvd."""
    from eunoe.vtk_files import VtkError, files_by_time, joined, read_points
    files = [path]
    if path.suffix == ".pvd":
        try:
            files = files_by_time(path)[snapshot]
        except (VtkError, IndexError):
            raise Failure(f"{path}: it has no picture {snapshot}. Give the .vtu file itself.") from None
    try:
        fields = joined([read_points(file, ("diameter", "radius")) for file in files])
    except VtkError as error:
        raise Failure(f"{path}: {error}") from None
    if not len(fields["points"]):
        return np.empty((0, 4))
    if "diameter" not in fields and "radius" not in fields:
        raise Failure(f"{path}: the points have no field 'diameter' or 'radius'. Write it with them.")
    size = fields["diameter"] if "diameter" in fields else 2. * fields["radius"]
    return np.column_stack((fields["points"], size)).astype(float)


def cells_of(line: str, separator: str, n: int = 0) -> list[str]:
    """The cells of a line. Separators at its end make empty ones, which beyond the first n are none."""
    words = [word.strip() for word in line.split(separator)]
    while len(words) > n and not words[-1]:
        words.pop()
    return words


def from_table(path: Path) -> np.ndarray:
    """Columns x, y, z and diameter or radius of a table with a head, with commas or semicolons between."""
    names = (("x", "p_x"), ("y", "p_y"), ("z", "p_z"), ("diameter", "diameters", "d", "radius", "r"))
    with open(path, encoding="utf-8-sig", errors="replace") as file:
        lines = [(number, line.strip()) for number, line in enumerate(file, 1)]
    lines = [(number, line) for number, line in lines if line.strip(";, ") and not line.startswith("#")]
    if not lines:
        raise Failure(f"{path}: it is empty. Give a row for each particle under a head.")
    separator = ";" if ";" in lines[0][1] else ","
    head = cells_of(lines[0][1], separator)
    places = [next((head.index(name) for name in group if name in head), None) for group in names]
    if None in places:
        raise Failure(f"{path}:{lines[0][0]}: the head has no column '{names[places.index(None)][0]}'. Give "
                      "x, y, z and diameter.")
    rows = []
    for number, line in lines[1:]:
        words = cells_of(line, separator, len(head))
        try:
            if len(words) != len(head):
                raise ValueError
            rows.append([float(words[place]) for place in places])
        except ValueError:
            raise Failure(f"{path}:{number}: this is no row of {len(head)} numbers. Give one a column; perhaps the numbers "
                          "have decimal commas.") from None
    result = np.array(rows).reshape(-1, 4)
    if head[places[3]] in ("radius", "r"):
        result[:, 3] *= 2.
    return result


def read_particles(path: Path, snapshot: int = -1) -> np.ndarray:
    """Places and diameters, a row a particle, in the file's own units and frame."""
    if path.suffix.startswith((".vt", ".pvt", ".pvd")):
        rows = from_vtk(path, snapshot)
    else:
        with open(path, encoding="utf-8", errors="replace") as file:
            is_dump = file.readline().startswith("ITEM:")
        rows = from_dump(path, snapshot) if is_dump else from_table(path)
    if not len(rows):
        raise Failure(f"{path}: it has no particles. Give a file with some.")
    wrong = np.flatnonzero(~(np.isfinite(rows).all(axis=1) & (rows[:, 3] > 0.)))
    if len(wrong):
        raise Failure(f"{path}: particle {wrong[0] + 1} has no finite place or no positive size. Leave it out, "
                      "or correct it.")
    return rows
