"""More layers, of another powder and with a faster spreader, on those of an earlier run: they are
counted on, the plate goes on where it was, all mass is accounted for, a stop within them changes no
bit, and what cannot be is refused.

Usage: series.py path/to/eunoe-particles series.prm folder
Exit code 77, which skips the test, if numpy or VTK is missing.
"""

from __future__ import annotations

import importlib.util
import csv
import json
import math
import shutil
import subprocess
import sys
from pathlib import Path

if any(importlib.util.find_spec(name) is None for name in ("numpy", "vtkmodules")):
    sys.exit(77)
import numpy as np

from attempts import Attempts
from eunoe.launch import SHARED, Failure, mpirun, overrides
from eunoe.vtk_files import read_pvd, read_vtu

SPREADING = "powder spreading/"
MORE = ("restart/restart = true", SPREADING + "number of layers = 4", SPREADING + "feedstock particle type = 1",
        SPREADING + "spreading velocity v_s = 0.15")
LENGTH, DEPTH, THICKNESS = 73e-3 * 0.01, 0.25e-3, 100e-6


class Series:
    def __init__(self, program: str, case: str, folder: Path) -> None:
        self.program, self.case, self.folder = program, case, folder
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)

    def run(self, name: str, *settings: str, ranks: int = 1, code: int = 0) -> str:
        done = subprocess.run(
            [*mpirun(ranks, *SHARED), self.program, self.case, "--dump", str(self.folder / f"{name}.dump"),
             *overrides((f"simulation control/output path = {self.folder / name}", *settings))],
            text=True, capture_output=True, check=False)
        if done.returncode != code:
            raise Failure(f"exit code {done.returncode}:\n{done.stdout}{done.stderr}")
        return done.stdout + done.stderr

    def checkpoints(self, name: str) -> list[Path]:
        return sorted((self.folder / name).glob("restart_0*.checkpoint"))

    def rows(self, name: str) -> list[dict[str, str]]:
        with open(self.folder / name / "layers.csv", encoding="utf-8") as file:
            return list(csv.DictReader(file))


def head_of(checkpoint: Path) -> dict:
    """What is small in a checkpoint: JSON between two lines and the rows."""
    text = checkpoint.read_bytes()
    return json.JSONDecoder().raw_decode(text[text.index(b"{"):].decode("utf-8", "replace"))[0]


def expect(condition: bool, sentence: str) -> None:
    if not condition:
        raise Failure(sentence)


def results(series: Series) -> None:
    """In the folder of the first layers, whose tables and pictures go on."""
    rows, first = series.rows("more"), series.rows("first")
    expect(rows[:2] == first and [row["layer"] for row in rows] == ["0", "1", "2", "3"],
           f"the table has {[row['layer'] for row in rows]}")
    pictures = read_pvd(series.folder / "more" / "spreading_layers.pvd")
    expect(len(pictures) == 4, f"{len(pictures)} pictures of layers")
    volumes = []
    for row, picture in zip(rows, pictures):
        grains = read_vtu(picture.file, ["diameter", "type", "layer", "on_plate"])
        on_plate = grains["on_plate"] == 1
        late = grains["layer"][on_plate] >= 2
        # What lay on the transfer plate comes with the first of the new powder.
        steel = grains["type"][on_plate] == 1
        expect(bool(late[steel].all()), "an early layer is of the new powder")
        expect(int(row["particles"]) == np.count_nonzero(on_plate), "the picture is not that of the weighing")
        volumes.append(math.pi / 6. * float((grains["diameter"][on_plate].astype(float)**3).sum()))
    full = LENGTH * DEPTH * THICKNESS
    for k in (1, 2, 3):
        lrd = (volumes[k] - volumes[k - 1]) / full
        expect(abs(float(rows[k]["LRD"]) - lrd) < 1e-5 and 0.1 < lrd < 1., f"LRD of layer {k}: {lrd}")
    expect(np.count_nonzero(steel) > 0.7 * np.count_nonzero(late) > 10, f"{np.count_nonzero(steel)} of {np.count_nonzero(late)} late grains are of the new powder")
    surfaces = read_vtu(read_pvd(series.folder / "more" / "spreading_layers_solids.pvd")[-1].file, [])
    corners = np.isclose(surfaces["points"][:, 0], (69e-3 + 56e-3) * 0.01 + 0.1e-3, rtol=1e-6)
    height = float(surfaces["points"][corners, 1].max())
    expect(abs(height + 3. * THICKNESS) < 1e-3 * THICKNESS, f"the plate is at {height} m")
    with open(series.folder / "more" / "measurements.csv", encoding="utf-8") as file:
        measured = [(row["observable"], row["index"]) for row in csv.DictReader(file)]
    expect(("solid_fraction", "3") in measured and len(set(measured)) == len(measured),
           "a measurement stands twice in measurements.csv")
    summary = json.loads((series.folder / "more" / "summary.json").read_text(encoding="utf-8"))
    expect(summary["mass_balance_error"] == 0., "mass is lost unaccounted")
    for column, outlet in (("mass_to_gap", 2), ("mass_to_collector", 1)):
        out = sum(float(row[column]) for row in rows)
        expect(math.isclose(out, summary[f"outlet_{outlet}_mass"], rel_tol=1e-12) and out > 0., f"{column}: {out} kg")
        expect(all(float(row[column]) >= 0. for row in rows), f"a negative {column}")


def stopped(series: Series) -> None:
    """Continued from within the new series, in a folder of its own, on another number of ranks."""
    shutil.copytree(series.folder / "more", series.folder / "stopped")
    files = series.checkpoints("stopped")
    middle = [file for file in files if file.name > series.checkpoints("first")[-1].name]
    passes = 2  # the phase of the process in which the bed of the feedstock is remembered
    within = [file for file in middle if head_of(file)["powder spreading"]["phase"] == passes]
    expect(len(within) > 1 and head_of(within[0])["bed_depth"] > 0., "no checkpoint is from within the passes")
    for late in middle[middle.index(within[0]) + 1:]:
        late.unlink()
    said = series.run("stopped", "restart/restart = auto", *MORE[1:], ranks=2)
    expect("The newest checkpoint that is whole is" in said, said)
    expect((series.folder / "stopped.dump").read_bytes() == (series.folder / "more.dump").read_bytes(),
           "a stop within the new series changes bits")
    expect([row["layer"] for row in series.rows("stopped")] == ["0", "1", "2", "3"], "rows are lost")


def longer(series: Series) -> None:
    """A checkpoint from within the first layers takes more of them, without a new series."""
    first = series.folder / "first"
    middle = series.checkpoints("first")[-2]
    place = series.folder / "part"
    place.mkdir()
    shutil.copy(middle, place)
    (place / "restart.latest").write_text(middle.name + "\n", encoding="utf-8")
    source = f"restart/restart folder = {place}"
    series.run("longer", "restart/restart = true", SPREADING + "number of layers = 3", source)
    rows = series.rows("longer")
    expect([row["layer"] for row in rows] == ["1", "2"], f"the table has {[row['layer'] for row in rows]}")
    before, after = float(series.rows("first")[1]["mass"]), float(rows[0]["mass"])
    expect(abs(after / before - 1.) < 0.2, f"layer 1 weighs {after} instead of {before} kg")
    said = series.run("refused", *MORE, source, code=2)
    expect("of whose layers 1 are weighed and others are still to come." in said, said)
    said = series.run("refused", *MORE, SPREADING + "gap = 0.12e-3", f"restart/restart folder = {first}", code=2)
    expect("entry 'gap' is '0.12e-3', and was" in said, said)
    said = series.run("refused", *MORE[:1], MORE[2], f"restart/restart folder = {first}", code=2)
    expect("is 2, and 2 lie on the plate of the checkpoint." in said, said)
    said = series.run("refused", *MORE, SPREADING + "feedstock particle type = 2", code=2)
    expect("is 2, and 'number of particle types' is 2." in said, said)


def finished(series: Series) -> None:
    """What has been done to its end is not done again with other powder, and what is refused leaves its results."""
    place = series.folder / "finished"
    shutil.copytree(series.folder / "first", place)
    before = {file.name: file.read_bytes() for file in place.iterdir()}
    other = "lagrangian physical properties/particle type 0/friction coefficient particles = 0.9"
    said = series.run("finished", "restart/restart = true", other, code=2)
    expect("whose run has done all of it" in said, said)
    expect({file.name: file.read_bytes() for file in place.iterdir()} == before, "what was refused has changed files")
    # As a spreadsheet saves it.
    layers = before["layers.csv"].decode().replace("\n", ";\n", 1)
    (place / "layers.csv").write_text(layers, encoding="utf-8")
    said = series.run("finished", *MORE, code=1)
    expect("layers.csv cannot be continued" in said, said)
    for name in ("summary.json", "measurements.csv", "used.prm", "apparatus.json"):
        expect((place / name).read_bytes() == before[name], f"{name} of the finished run is gone")


def main() -> int:
    program, case, folder = sys.argv[1:]
    series = Series(program, case, Path(folder))
    series.run("first")
    shutil.copytree(series.folder / "first", series.folder / "more")
    series.run("more", *MORE)
    attempts = Attempts()
    for attempt in (results, stopped, longer, finished):
        attempts.make(attempt.__name__, attempt, series)
    return attempts.exit_code()


if __name__ == "__main__":
    sys.exit(main())
