"""A small heap from its input file to its results: the same tables and the same state on one rank
and on two, and after an interruption in each phase; the masses add up, and the outlines agree with
those of the particles in the picture.

Usage: end_to_end.py path/to/eunoe-particles folder
Exit code 77, which skips the test, if numpy or VTK is missing.
"""

import importlib.util
import json
import math
import shutil
import signal
import subprocess
import sys
from pathlib import Path

if any(importlib.util.find_spec(name) is None for name in ("numpy", "vtkmodules")):
    sys.exit(77)
import numpy as np

from eunoe.launch import mpirun, overrides
from eunoe.tables import read_rows as read
from eunoe.vtk_files import read_pvd, read_vtu

HERE = Path(__file__).resolve().parent

DISC, N_VIEWS = 0.6e-3, 16
N_RINGS, N_LAYERS = 6, 3
TABLES = ("heap.csv", "heap_map.pgm", "heap_profile.csv", "measurements.csv", "state.dump")


def command(program: str, folder: Path, ranks: int, *settings: str) -> list[str]:
    return [*mpirun(ranks, "--oversubscribe"), program, str(HERE / "tiny.prm"), "--dump", f"{folder}/state.dump",
            *overrides([f"simulation control/output path = {folder}", *settings])]


def run(program: str, folder: Path, ranks: int = 1, *settings: str) -> None:
    subprocess.run(command(program, folder, ranks, *settings), check=True, stdout=subprocess.DEVNULL)


def summary(folder: Path) -> dict:
    return json.loads((folder / "summary.json").read_text())


def check_forecast(program: str, folder: Path) -> None:
    """The picture of the heap counts among what goes to the disk."""
    for wanted, said in (("true", "1 picture of"), ("false", "no pictures")):
        out = subprocess.run([*command(program, folder, 1, f"heap/heap picture = {wanted}"), "--check"], check=True,
                             text=True, stdout=subprocess.PIPE).stdout
        assert any(line.startswith("Disk:") and said in line for line in out.splitlines()), out


def check_same(reference: Path, other: Path, names: tuple[str, ...] = TABLES) -> None:
    for name in names:
        assert (reference / name).read_bytes() == (other / name).read_bytes(), f"{name} of {other} differs"
    keys = [key for key in summary(reference) if key.startswith("heap_")]
    assert keys and all(summary(reference)[key] == summary(other)[key] for key in keys)


def run_until(program: str, folder: Path, stage: str, *settings: str) -> None:
    """Runs until the log names a stage; there the run is asked to stop and leaves a checkpoint."""
    settings = ("restart/checkpoint = true", "simulation control/log frequency = 2000", *settings)
    with subprocess.Popen(command(program, folder, 1, *settings), text=True,
                          stdout=subprocess.PIPE) as process:
        for line in process.stdout:
            if line.rstrip().endswith(stage):
                process.send_signal(signal.SIGTERM)
                break
        process.stdout.read()
    assert process.returncode == 3, f"exit code {process.returncode} while {stage}"


def check_interrupted(program: str, reference: Path, folder: Path) -> None:
    run_until(program, folder, "filling the tube")
    again = "restart/restart = true"
    run_until(program, folder, "lifting the tube", again)
    run_until(program, folder, "the heap comes to rest", again)
    run(program, folder, 2, again)
    assert summary(folder)["first_step"] > 0
    check_same(reference, folder)


def outline_area(points: np.ndarray, radius: np.ndarray, direction: float) -> float:
    along = points[:, 0] * math.cos(direction) + points[:, 2] * math.sin(direction)
    places = np.linspace(-0.7 * DISC, 0.7 * DISC, 4000)
    chord = radius**2 - (places[:, None] - along)**2
    heights = np.where(chord > 0., points[:, 1] + np.sqrt(np.maximum(chord, 0.)), 0.).max(axis=1)
    return float(heights.sum() * (places[1] - places[0]))


def check_measurements(folder: Path, points: np.ndarray, radius: np.ndarray) -> None:
    """Rings and layers as the input asks for them; the solid fraction is that of random points in the middle."""
    with open(folder / "measurements.csv", encoding="utf-8") as file:
        rows = [line.split(",") for line in file.read().splitlines()[1:]]
    profile = [float(value) for name, _, value, _ in rows if name == "profile"]
    density = [float(value) for name, _, value, _ in rows if name == "solid_fraction"]
    assert len(profile) == N_RINGS and len(density) == N_LAYERS, (profile, density)
    random = np.random.default_rng(1)
    thickness = DISC / 2. * math.tan(math.radians(37.5)) / N_LAYERS
    for layer, value in enumerate(density):
        off_axis, turn = DISC / 4. * np.sqrt(random.uniform(size=10000)), random.uniform(0., 2. * math.pi, 10000)
        places = np.column_stack((off_axis * np.cos(turn), thickness * (layer + random.uniform(size=10000)),
                                  off_axis * np.sin(turn)))
        squares = ((places[:, None, :] - points[None, :, :])**2).sum(axis=2)
        solid = float((squares < radius**2).any(axis=1).mean())
        # Five deviations of the share of random points, and the overlaps, which count twice.
        assert abs(value - solid) < 0.03, (layer, value, solid)


def check_results(folder: Path) -> None:
    *views, mean = read(folder / "heap.csv")
    results = summary(folder)
    assert len(views) == N_VIEWS and math.isnan(mean["view"])
    particles = read_vtu(read_pvd(folder / "heap_heap.pvd")[0].file, ["diameter", "mass"])
    points, radius = (np.asarray(particles[name], dtype=float) for name in ("points", "diameter"))
    radius = radius / 2.
    # The tube has been lifted off the powder; particles that cling to it hang far above the heap.
    on_disc = (points[:, 1] > 0.) & (np.hypot(points[:, 0], points[:, 2]) < DISC / 2. + radius)
    if results["heap_mass_clinging"] > 0.:
        on_disc &= points[:, 1] < 1.1 * mean["height"]
    assert results["heap_particles_on_disc"] == np.count_nonzero(on_disc)
    check_measurements(folder, points[on_disc], radius[on_disc])
    mass = float(particles["mass"][on_disc].sum(dtype=float))
    assert math.isclose(mean["mass_on_disc"], mass, rel_tol=1e-5)
    assert math.isclose(results["inserted_mass"], results["heap_mass_on_disc"]
                        + results["heap_mass_drained"] + results["heap_mass_clinging"], rel_tol=1e-12)
    assert results["mass_balance_error"] == 0.
    for view in views:
        area = outline_area(points[on_disc], radius[on_disc], math.radians(view["direction"]))
        assert math.isclose(view["projected_area"], area, rel_tol=2e-3), (view, area)
        assert math.isclose(view["base_angle"],
                            math.degrees(math.atan(4. * view["projected_area"] / DISC**2)),
                            rel_tol=1e-12)
    angles = np.array([view["base_angle"] for view in views])
    assert math.isclose(mean["base_angle"], angles.mean(), rel_tol=1e-12)
    assert math.isclose(mean["base_angle_spread"], angles.std(ddof=1), rel_tol=1e-9)
    assert results["heap_base_angle"] == mean["base_angle"]
    assert 15. < mean["base_angle"] < 75., "an angle that no heap has"
    assert results["heap_rest_time"] < 0.3, "the powder did not come to rest"


def check_comparison(program: str, folder: Path, reference: Path) -> None:
    """Two ranks give the same heap, which differs by 10 um from its own profile raised by 10 um."""
    rows = read(reference / "heap_profile.csv")
    measured = folder.with_suffix(".csv")
    measured.write_text("x,height\n" + "".join(f"{row['x']!r},{row['mean'] + 10e-6!r}\n"
                                               for row in rows))
    run(program, folder, 2, f"heap/measured profile = {measured}")
    check_same(reference, folder, TABLES[:2])
    assert math.isclose(summary(folder)["heap_profile_difference"], 10e-6, rel_tol=1e-6)
    area = sum((a["mean"] + b["mean"] + 20e-6) / 2. * (b["x"] - a["x"])
               for a, b in zip(rows, rows[1:]))
    assert math.isclose(summary(folder)["heap_measured_base_angle"],
                        math.degrees(math.atan(4. * area / DISC**2)), rel_tol=1e-9)


def check_clock(program: str, folder: Path) -> None:
    """With a delay the heap is measured so long after the tube has come to a stop, interrupted or not, although it moves."""
    delay, step = 1e-3, 4.4e-7
    settings = (f"heap/measurement delay = {delay}", "restart/restart = true")
    run_until(program, folder, "the heap comes to rest", settings[0])
    run(program, folder, 1, *settings)
    results = summary(folder)
    assert results["first_step"] * step > results["heap_lifted_time"], "interrupted too early to tell"
    late = results["heap_rest_time"] - results["heap_lifted_time"] - delay
    assert -1e-12 < late < 2. * step, f"measured {late} s too late"


def check_other_runs(program: str, phase: Path, finished: Path) -> None:
    """A run that begins where another one has finished leaves nothing by which it would be taken for that one, and a
    phase in a folder of its own says what its apparatus is."""
    run_until(program, finished, "filling the tube")
    left = [name for name in ("heap.csv", "heap_profile.csv", "heap_map.pgm", "measurements.csv", "summary.json")
            if (finished / name).exists()]
    assert not left, f"results of the run before: {left}"
    phase.mkdir()
    (phase / "heap.csv").write_text("of another run")
    run_until(program, phase, "lifting the tube", "restart/restart = true", f"restart/restart folder = {finished}",
              "lagrangian physical properties/particle type 0/friction coefficient particles = 0.3")
    assert (phase / "apparatus.json").read_bytes() == (finished / "apparatus.json").read_bytes()
    assert not (phase / "heap.csv").exists(), "results of the run before are in the folder of a phase"


def main() -> int:
    program, folder = sys.argv[1], Path(sys.argv[2])
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    check_forecast(program, folder / "one")
    run(program, folder / "one")
    check_results(folder / "one")
    check_comparison(program, folder / "two", folder / "one")
    check_interrupted(program, folder / "one", folder / "interrupted")
    check_clock(program, folder / "clock")
    check_other_runs(program, folder / "phase", folder / "interrupted")
    print("ok")
    return 0


if __name__ == "__main__":
    sys.exit(main())
