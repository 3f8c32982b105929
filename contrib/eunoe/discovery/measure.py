"""Measures particles of another program, or of a scan, as a run of a case measures its own.

Usage: contrib/tools measure case.prm heap.dump                                   # rows of measurements.csv
       contrib/tools measure case.prm --experiment heap 1.dump 2.dump 3.dump      # rows of measured.csv
       [--scale 1e-3] [--origin X Y Z] [--up y] [--snapshot -1] [--only profile,base_angle] [--held-out]

The case (.prm) says which process is measured and how large its apparatus is. Files are text dumps of LAMMPS
and LIGGGHTS ('dump ... custom N file id x y z radius'), pictures of points with a field 'diameter' or
'radius' (.vtu, .pvtu, .vtp, .pvtp, .vtk, .pvd), or tables with the columns x, y, z and diameter or radius. Places
are taken to metres by --scale, to the frame of the process by --origin (the place, in the file's units, of the
middle of the heap's disc, or of the left end of the feedstock platform at the transfer plate's level) and --up
(the axis that points upwards; the frame is turned to y).

With --experiment each file is a repetition, and the table of a study is printed: mean, standard
deviation and number of the repetitions. For spreading, a repetition may be a list of files with commas
between, one for each layer; one file is the plate after the last layer.
"""

from __future__ import annotations

import argparse
import csv
import io
import math
import re
import statistics
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from eunoe.launch import Failure, overrides, parser
from eunoe.repository import PROGRAM

from .particle_files import read_particles

HEAD = "experiment,observable,index,value,std,repeats,use"
# The axes of the file that become x, y and z of the process: turned, not mirrored.
AXES = {"x": (1, 0, 2), "y": (0, 1, 2), "z": (0, 2, 1)}
SIGNS = {"x": (-1., 1., 1.), "y": (1., 1., 1.), "z": (1., 1., -1.)}


def parse(words: list[str]) -> argparse.Namespace:
    arguments = parser(__doc__)
    # Older Pythons take a number like -1e-3 for an option.
    arguments._negative_number_matcher = re.compile(r"^-(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?$")
    arguments.add_argument("case", type=Path)
    arguments.add_argument("files", nargs="+", help="particles; commas between those of several layers")
    arguments.add_argument("--program", default=str(PROGRAM))
    arguments.add_argument("--set", action="append", default=[], metavar="ENTRY=VALUE")
    arguments.add_argument("--scale", type=float, default=1., help="metres in the files' unit of length")
    arguments.add_argument("--origin", type=float, nargs=3, default=(0., 0., 0.), metavar=("X", "Y", "Z"))
    arguments.add_argument("--up", choices=AXES, default="y")
    arguments.add_argument("--snapshot", type=int, default=-1, help="of files with several; -1 is the last")
    arguments.add_argument("--experiment", help="print rows of a study's measured data under this name")
    arguments.add_argument("--held-out", action="store_true", help="these rows are not for the fit")
    arguments.add_argument("--only", default="", help="observables, with commas between; else all")
    return arguments.parse_args(words)


def to_frame(rows: np.ndarray, options: argparse.Namespace) -> np.ndarray:
    """Places and diameters in metres and in the frame of the process."""
    moved = (rows[:, :3] - np.array(options.origin)) * options.scale
    turned = moved[:, AXES[options.up]] * np.array(SIGNS[options.up])
    return np.column_stack((turned, rows[:, 3] * options.scale))


def measure(moments: list[np.ndarray], options: argparse.Namespace, what: str) -> list[dict[str, str]]:
    """The rows that the case's process measures.

    @param moments: particles in the frame of the process, at each moment
    @param what: name for messages
    """
    with tempfile.TemporaryDirectory() as folder:
        files = []
        for k, rows in enumerate(moments):
            files.append(f"{folder}/{k}.csv")
            np.savetxt(files[-1], rows, fmt="%.17g", delimiter=",", header="x,y,z,diameter", comments="")
        done = subprocess.run([options.program, str(options.case), *overrides(options.set), "--measure", ",".join(files)],
                              capture_output=True, text=True, check=False)
        if done.returncode != 0:
            # Its own message, with the user's files instead of those between.
            message = (done.stderr + done.stdout).strip().replace(",".join(files), what)
            names = what.split(",")
            for file, name in zip(files, names if len(names) == len(files) else [what] * len(files)):
                message = message.replace(file, name)
            raise Failure(message)
    return list(csv.DictReader(io.StringIO(done.stdout)))


def measured_rows(repeats: list[list[dict[str, str]]], options: argparse.Namespace) -> list[str]:
    """Rows of a study's table, of what all repetitions have."""
    values: dict[tuple[str, str], list[float]] = {}
    for repeat in repeats:
        for row in repeat:
            values.setdefault((row["observable"], row["index"]), []).append(float(row["value"]))
    use = "held-out" if options.held_out else "fit"
    complete = {key: found for key, found in values.items()
                if len(found) == len(repeats) and all(map(math.isfinite, found))}
    # What is the same in all repeats has no scatter by which a study could weigh it.
    return [f"{options.experiment},{name},{index},{statistics.fmean(found):.9g},{statistics.stdev(found):.6g},"
            f"{len(found)},{use}"
            for (name, index), found in complete.items() if statistics.stdev(found) > 0.]


def chosen(rows: list[dict[str, str]], only: str) -> list[dict[str, str]]:
    names = {name.strip() for name in only.split(",") if name.strip()}
    unknown = names - {row["observable"] for row in rows}
    if unknown:
        raise Failure(f"--only: the process does not measure '{sorted(unknown)[0]}' of these particles, but "
                      f"{', '.join(dict.fromkeys(row['observable'] for row in rows))}.")
    return [row for row in rows if not names or row["observable"] in names]


def main(words: list[str]) -> int:
    options = parse(words)
    if options.scale <= 0.:
        raise Failure("--scale: give a positive number of metres.")
    repeats = []
    for files in options.files:
        moments = [to_frame(read_particles(Path(file.strip()), options.snapshot), options) for file in files.split(",")]
        repeats.append(chosen(measure(moments, options, files), options.only))
    if options.experiment:
        if len(repeats) < 2:
            raise Failure("--experiment: one repetition has no standard deviation. Give three or more files.")
        print("\n".join([HEAD, *measured_rows(repeats, options)]))
        return 0
    if len(repeats) > 1:
        raise Failure("Several files are repetitions of an experiment: name it with --experiment.")
    print("observable,index,value,unit")
    for row in repeats[0]:
        print(",".join(row[name] for name in ("observable", "index", "value", "unit")))
    return 0
