"""Compares the collapse of a column in Eunoe and in LAMMPS: run-out, height, energies over time.

Usage: contrib/tools collapse [--program build/release/eunoe-particles]
           [--column 1e-3] [--time 0.016] [--samples 20] [--seeds 3] [--ranks 1]
           [--figure FILE] [--table FILE] [--keep FOLDER]

Both use the same physics: Hertz and Mindlin with the same damping, friction 0.2, no cohesion, no
rolling resistance. The motion is chaotic, so each program runs with several seeds, which move the
particles at the start by up to 10 nm. The difference of the means is compared with the difference
that the scatter over the seeds would explain. Exit code 1 if it is larger.
"""

from __future__ import annotations

import argparse
import re
import tempfile
from pathlib import Path

import numpy as np

from eunoe.launch import Failure, parser
from eunoe.tables import as_markdown, read_rows
from eunoe.vtk_files import read_pvd, read_vtu

from . import bed
from .programs import CASES, Eunoe, Lammps, add_program

CASE = CASES["collapse"]
PHYSICS = ("model parameters/particle particle contact force method = hertz_mindlin_limit_overlap",
           "model parameters/particle wall contact force method = nonlinear",
           "model parameters/rolling resistance torque method = none")
QUANTITIES = {"mean_x": "centre of mass in x (mm)", "front": "run-out: 99 % lie before (mm)",
              "mean_y": "centre of mass in y (mm)", "top": "height: 99 % lie below (mm)",
              "kinetic": "kinetic energy (nJ)", "rotational": "energy of rotation (nJ)"}
# Accepted difference of the means in units of its standard error. The margin is wide, as few seeds
# give a poor estimate of the scatter, and the largest of some hundred values is tested.
LIMIT = 6.
# Differences below this share of a quantity's largest value count as agreement.
RESOLUTION = 0.01


def measure(x: np.ndarray, y: np.ndarray, volume: np.ndarray) -> list[float]:
    """Centre of mass and 99 % quantile of the mass, first in x, then in y (mm)."""
    def quantile(values: np.ndarray) -> float:
        order = np.argsort(values)
        share = np.cumsum(volume[order]) / volume.sum()
        return float(values[order][np.searchsorted(share, 0.99)])

    return [1e3 * float(v) for v in (np.average(x, weights=volume), quantile(x),
                                     np.average(y, weights=volume), quantile(y))]


def run_eunoe(eunoe: Eunoe, particles: np.ndarray, options: argparse.Namespace,
              folder: Path) -> np.ndarray:
    """Rows of the six quantities, one a sample."""
    settings = (*PHYSICS, f"simulation control/output frequency = {options.every}",
                "post-processing/energies/calculation = true",
                f"post-processing/energies/output frequency = {options.every}")
    eunoe.run(CASE, options.ranks, options.steps, folder, settings, particles)
    rows = []
    energies = read_rows(folder / "results" / "energies.csv")
    for picture, energy in zip(read_pvd(folder / "results" / "spreading.pvd"), energies):
        data = read_vtu(picture.file, ["diameter"])
        points = data["points"].astype(float)
        rows.append([*measure(points[:, 0], points[:, 1], data["diameter"].astype(float) ** 3),
                     1e9 * energy["kinetic"], 1e9 * energy["rotational"]])
    return np.array(rows)


def run_lammps(lammps: Lammps, particles: np.ndarray, options: argparse.Namespace,
               folder: Path) -> np.ndarray:
    """Rows of the six quantities, one a sample."""
    log = lammps.start(CASE, particles, options.ranks,
                       {"steps": options.steps, "every": options.every, "check": 1,
                        "places": folder / "places"}, folder)
    energies = [[float(word) for word in line.split()] for line in log.splitlines()
                if re.match(r"\s*\d+ +\d+ +[\d.]\S* +[\d.]\S*\s*$", line)]
    blocks = (folder / "places").read_text(encoding="utf-8").split("ITEM: TIMESTEP")[1:]
    rows = []
    for block, (_, _, kinetic, rotational) in zip(blocks, energies):
        table = np.array(block.split("radius", 1)[1].split(), float).reshape(-1, 5)
        rows.append([*measure(table[:, 1], table[:, 2], table[:, 4] ** 3), 1e9 * kinetic,
                     1e9 * rotational])
    return np.array(rows)


def deviations(ours: np.ndarray, theirs: np.ndarray) -> np.ndarray:
    """Difference of the means over its standard error, shape (samples, quantities).

    The scatter of a quantity is taken as the root mean square of both programs' standard
    deviations, at this sample or over all samples, whichever is larger.
    """
    variance = 0.5 * (ours.var(axis=0, ddof=1) + theirs.var(axis=0, ddof=1))
    variance = np.maximum(variance, variance.mean(axis=0))
    error = np.sqrt(variance * (1. / len(ours) + 1. / len(theirs)))
    difference = ours.mean(axis=0) - theirs.mean(axis=0)
    scale = np.abs(np.concatenate((ours, theirs))).max(axis=(0, 1))
    error = np.maximum(error, RESOLUTION * scale / LIMIT)
    return difference / error


def as_table(times: np.ndarray, ours: np.ndarray, theirs: np.ndarray) -> str:
    table = [["time (ms)", *QUANTITIES.values()]]
    for k, time in enumerate(times):
        texts = [f"{ours[:, k, q].mean():.4g} ± {ours[:, k, q].std(ddof=1):.1g}, "
                 f"{theirs[:, k, q].mean():.4g} ± {theirs[:, k, q].std(ddof=1):.1g}"
                 for q in range(len(QUANTITIES))]
        table.append([f"{1e3 * time:.2f}", *texts])
    return as_markdown(table)


def draw(path: Path, times: np.ndarray, ours: np.ndarray, theirs: np.ndarray) -> None:
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(2, 3, figsize=(11, 6), sharex=True, constrained_layout=True)
    for q, (axis, label) in enumerate(zip(axes.T.flat, QUANTITIES.values())):
        for runs, colour, style, name in ((ours, "#0b4f8a", "-", "Eunoe"),
                                          (theirs, "#d1610a", "--", "LAMMPS")):
            for k, run in enumerate(runs):
                axis.plot(1e3 * times, run[:, q], style, color=colour, linewidth=1.2, alpha=0.7,
                          label=name if k == 0 else None)
        axis.set_ylabel(label)
        axis.grid(alpha=0.3)
    for axis in axes[-1]:
        axis.set_xlabel("time (ms)")
    axes[0, 0].legend()
    figure.savefig(path, dpi=120)


def parse(words: list[str]) -> argparse.Namespace:
    arguments = parser(__doc__)
    add_program(arguments)
    arguments.add_argument("--column", type=float, default=1e-3, help="length of the column (m)")
    arguments.add_argument("--time", type=float, default=0.016, help="simulated time (s)")
    arguments.add_argument("--samples", type=int, default=20)
    arguments.add_argument("--seeds", type=int, default=3)
    arguments.add_argument("--ranks", type=int, default=1)
    arguments.add_argument("--figure", type=Path)
    arguments.add_argument("--table", type=Path)
    arguments.add_argument("--keep", type=Path, help="file for the samples (.npz)")
    options = arguments.parse_args(words)
    if options.seeds < 2 or options.samples < 1:
        raise Failure("Give at least 2 seeds and 1 sample.")
    options.every = max(1, round(options.time / CASE.time_step / options.samples))
    options.steps = options.every * options.samples
    return options


def compute(options: argparse.Namespace) -> tuple[np.ndarray, np.ndarray]:
    """What both programs find, shape (seeds, samples, quantities)."""
    eunoe, lammps = Eunoe(options.program), Lammps()
    if lammps.path is None:
        raise Failure("LAMMPS is not installed (no program 'lmp'); it is what is compared with.")
    column = bed.narrow(bed.read(), options.column)
    print(f"{len(column)} particles, {options.steps} steps, {options.seeds} seeds each", flush=True)
    results: dict[str, list[np.ndarray]] = {"Eunoe": [], "LAMMPS": []}
    for seed in range(1, options.seeds + 1):
        particles = bed.jittered(column, seed)
        for name, function, program in (("Eunoe", run_eunoe, eunoe),
                                        ("LAMMPS", run_lammps, lammps)):
            with tempfile.TemporaryDirectory(prefix="eunoe_collapse_") as folder:
                rows = function(program, particles, options, Path(folder))
            if rows.shape != (options.samples + 1, len(QUANTITIES)):
                raise Failure(f"{name} gave {len(rows)} samples instead of {options.samples + 1}.")
            results[name].append(rows)
            print(f"  seed {seed}: {name}", flush=True)
    return np.array(results["Eunoe"]), np.array(results["LAMMPS"])


def main(words: list[str]) -> int:
    options = parse(words)
    ours, theirs = compute(options)
    times = CASE.time_step * options.every * np.arange(options.samples + 1)
    if options.keep:
        np.savez(options.keep, times=times, eunoe=ours, lammps=theirs)
    if options.figure:
        draw(options.figure, times, ours, theirs)
    table = as_table(times, ours, theirs)
    if options.table:
        options.table.write_text(table + "\n", encoding="utf-8")
    print(f"Eunoe, LAMMPS (mean ± standard deviation of {options.seeds} seeds)\n{table}\n")
    worst = np.abs(deviations(ours, theirs)).max(axis=0)
    for name, value in zip(QUANTITIES.values(), worst):
        print(f"{name}: largest difference {value:.1f} standard errors")
    agree = bool((worst <= LIMIT).all())
    print("The programs agree within the scatter." if agree else
          f"The programs differ by more than {LIMIT:g} standard errors.")
    return 0 if agree else 1
