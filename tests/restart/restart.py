"""A run gives the same bits on any number of ranks, with any load balancing, and however often it
is stopped and continued.

Usage: restart.py path/to/eunoe-particles path/to/many-runs folder
"""

from __future__ import annotations

import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

from attempts import Attempts
from eunoe.endurance.kill_and_restart import Case, compare, kill_and_restart
from eunoe.launch import Failure
from many_runs import QuickCase, SharedProcesses

CASE = str(Path(__file__).with_name("stirred.prm"))
EVERY = ("restart/checkpoint = true", "restart/frequency = 1700")
# Runs on more ranks than a machine may have cores are slow, so these are shorter. All particles have
# come by then, and half of them have fallen.
BRIEF = "simulation control/iteration end = 12000"
BALANCING = "model parameters/load balancing/"
FREQUENT = (BALANCING + "load balance method = frequent", BALANCING + "frequency = 300")
DYNAMIC = (BALANCING + "load balance method = dynamic", BALANCING + "threshold = 0.1",
           BALANCING + "dynamic check frequency = 200")
OTHER_MESH = ("mesh/grid arguments = 3, 2, 1 : 0, 0, 0 : 10e-3, 8e-3, 4e-3 : true",)
SPARSE = "model parameters/adaptive sparse contacts/"
# Particles fall asleep far more easily than is physical, so that many sleep.
SLEEPY = (SPARSE + "enable adaptive sparse contacts = true", SPARSE + "rest time = 2e-4",
          SPARSE + "rest speed = 0.7", SPARSE + "rest displacement = 1e3", SPARSE + "check frequency = 20")
# Particles are inserted where the mesh cells at a plane are empty.
ON_PLANE = ("insertion info/insertion method = plane",
            "insertion info/insertion plane point = 0, 7e-3, 0",
            "insertion info/insertion plane normal vector = 0, 1, 0",
            "insertion info/insertion maximum offset = 1",
            "insertion info/insertion frequency = 2000")
# Every law that acts across a separation, with the memory of its contacts, and drag.
PHYSICS = "lagrangian physical properties/"
ALL_LAWS = ("model parameters/particle particle contact force method = JKR",
            "model parameters/particle wall contact force method = JKR",
            "model parameters/capillary bridges/surface tension = 0.01",
            "model parameters/electrostatic charge/cut-off share = 0.2",
            PHYSICS + "particle type 0/surface charge density particles = 2e-5",
            "model parameters/drag/dynamic viscosity = 1e-3", "model parameters/drag/density = 10")
# The skin follows the flow, which is so fast that it changes.
TUNED = ("model parameters/contact detection/neighborhood threshold = auto",
         "insertion info/initial velocity = 0, -3, 0.2")
# A background mesh that turns and pours out its particles.
DRUM = str(Path(__file__).with_name("drum.prm"))
BOUNDARY = "DEM boundary conditions/boundary condition 0/"
POURED = (BOUNDARY + "type = outlet", BOUNDARY + "boundary id = 1",
          "grid motion/motion type = rotational", "grid motion/grid rotational speed = -80",
          "grid motion/grid rotational axis = 2")
COLLISIONS = ("post-processing/particle wall collision statistics/"
              "enable particle wall collision statistics = true",)


def same(reference: QuickCase, folder: Path, ranks: int, *settings: str) -> None:
    other = QuickCase(reference.program, CASE, folder, reference.settings)
    other.run(ranks, *settings)
    compare(reference, other, f"On {ranks} ranks", not set(OTHER_MESH) & set(settings))


def stopped(reference: QuickCase, folder: Path, number: int, ranks: int, ranks_after: int) -> None:
    """A run stopped by a signal continues on another number of ranks."""
    other = QuickCase(reference.program, CASE, folder, [])
    longer = ["simulation control/iteration end = 10000000", *EVERY]
    process = other.start(ranks, *longer)
    while other.last_step() == 0 and process.poll() is None:
        time.sleep(0.02)
    os.kill(other.processes()[-1], number)  # one of the ranks is enough
    output = process.communicate()[0]
    if process.returncode != 3 or "The run continues from" not in output:
        raise Failure(f"Signal {number}: exit code {process.returncode}, output:\n{output}")
    step = other.last_step()
    last = f"simulation control/iteration end = {step + 3000}"
    other.run(ranks_after, *EVERY, "restart/restart = true", last)
    alone = QuickCase(reference.program, CASE, folder.with_name(folder.name + "_alone"), [])
    alone.run(1, last)
    compare(alone, other, f"After signal {number} at step {step}")


def write_failure(reference: QuickCase, folder: Path) -> None:
    """A checkpoint that cannot be written stops the run, and the previous one stays intact."""
    other = QuickCase(reference.program, CASE, folder, [])
    obstacle = other.results / "restart_000000005100.checkpoint.new"
    (obstacle / "full").mkdir(parents=True)
    run = subprocess.run(other.command(2, *EVERY), text=True, check=False, capture_output=True)
    if run.returncode != 1 or "cannot be written: Is a directory." not in run.stderr:
        raise Failure(f"Exit code {run.returncode}, errors:\n{run.stderr}")
    if other.last_step() != 3400:
        raise Failure(f"The newest checkpoint is of step {other.last_step()}.")
    shutil.rmtree(obstacle)
    other.run(1, *EVERY, "restart/restart = true")
    compare(reference, other, "After a checkpoint that could not be written")


def sleeping(program: str, folder: Path) -> None:
    """The same bits with particles that sleep and wake."""
    settings = [*SLEEPY, BRIEF]
    reference = QuickCase(program, CASE, folder / "reference", settings)
    reference.run(1)
    share = json.loads((reference.results / "summary.json").read_text())["share_asleep"]
    if not 0.1 < share < 0.9:
        raise Failure(f"A share of {share} slept, so little is tried.")
    for ranks, more in ((2, FREQUENT), (4, OTHER_MESH)):
        other = QuickCase(program, CASE, folder / str(ranks), settings)
        other.run(ranks, *more)
        compare(reference, other, f"With sleep, on {ranks} ranks", more is not OTHER_MESH)
    # Forces on solids include those of sleepers; evaluating them must not change the sleepers.
    quiet = QuickCase(program, CASE, folder / "no_forces", settings)
    quiet.run(1, "post-processing/solid forces/calculation = false")
    if quiet.dump.read_bytes() != reference.dump.read_bytes():
        raise Failure("With sleep, the state depends on whether forces on solids are written.")
    other = QuickCase(program, CASE, folder / "restarted", settings)
    other.run(2, *EVERY, "simulation control/iteration end = 5555")
    other.run(3, *EVERY, *DYNAMIC, "restart/restart = true")
    compare(reference, other, "With sleep, restarted")


def continued(program: str, prm: str, folder: Path, settings: tuple[str, ...], stop: int, ranks: int,
              what: str) -> QuickCase:
    """A run that is stopped on two ranks and continued gives the same bits as one without a stop,
    which is returned."""
    reference = QuickCase(program, prm, folder / "reference", list(settings))
    reference.run(1)
    other = QuickCase(program, prm, folder / "restarted", list(settings))
    other.run(2, *EVERY, *FREQUENT, f"simulation control/iteration end = {stop}")
    other.run(ranks, *EVERY, "restart/restart = true")
    compare(reference, other, f"{what}, restarted")
    return reference


def all_laws(program: str, folder: Path) -> None:
    """The same bits with every law, with sleep and without, stopped and continued."""
    for name, settings in (("awake", ALL_LAWS), ("asleep", ALL_LAWS + SLEEPY)):
        continued(program, CASE, folder / name, (*settings, BRIEF), 5555, 4, f"With all laws, {name}")


def tuned(program: str, folder: Path) -> None:
    """The same bits where the skin follows the flow, with sleep and without, stopped and continued."""
    for name, settings in (("awake", TUNED), ("asleep", TUNED + SLEEPY)):
        continued(program, CASE, folder / name, (*settings, BRIEF), 5555, 4, f"With a tuned skin, {name}")
        # Each part of a run counts its own.
        changes, behind = (
            json.loads((folder / name / part / "results" / "summary.json").read_text())["threshold_changes"]
            for part in ("reference", "restarted"))
        if not 0 < behind < changes:
            raise Failure(f"The skin has changed {changes} times, {behind} of them behind the restart, so little is "
                          "tried.")


def on_plane(program: str, folder: Path) -> None:
    """The same bits where the places of insertion depend on the particles already present."""
    continued(program, CASE, folder, (*ON_PLANE, *COLLISIONS), 11111, 1, "With insertion on a plane")


def curved(program: str, folder: Path) -> None:
    """The same bits in a mesh that is curved and finer in places, at rest and in motion."""
    continued(program, DRUM, folder / "at_rest", (), 2777, 1, "In a curved mesh, at rest")
    poured = continued(program, DRUM, folder / "poured", POURED, 2777, 1, "In a curved mesh, poured")
    left = json.loads((poured.results / "summary.json").read_text())["outlet_particles"]
    if not 0 < left < 400:
        raise Failure(f"{left} particles left through the outlet, so little is tried.")


def killed(program: str, folder: Path) -> None:
    longer = ["simulation control/iteration end = 30000"]
    alone = Case(program, CASE, folder.with_name("alone"), longer)
    restarts, _, lost = kill_and_restart(alone, Case(program, CASE, folder, longer), [1, 2], 4, 1700,
                                   random.Random(3))
    if restarts == 0:
        raise Failure("No kill came after a checkpoint, so nothing was tried.")
    if lost == 0:
        raise Failure("No kill cost a step as far as the log tells, so nothing was tried.")


def main(program: str, many_runs: str, folder: Path) -> int:
    QuickCase.processes_at_hand = SharedProcesses(many_runs, folder / "printed")
    reference = QuickCase(str(Path(program).resolve()), CASE, folder / "reference", [])
    reference.run(1)
    attempts = Attempts()
    attempts.make("checkpoints", same, reference, folder / "checkpoints", 1, *EVERY)
    attempts.make("2 ranks", same, reference, folder / "2", 2)
    attempts.make("2 ranks, frequent", same, reference, folder / "2f", 2, *FREQUENT)
    attempts.make("2 ranks, dynamic", same, reference, folder / "2d", 2, *DYNAMIC)
    attempts.make("4 ranks, other mesh", same, reference, folder / "4", 4, *OTHER_MESH)
    # At full length this run would take as long as all the others together.
    brief = QuickCase(reference.program, CASE, folder / "brief", ["simulation control/iteration end = 5000"])
    brief.run(1)
    attempts.make("8 ranks, dynamic", same, brief, folder / "8", 8, *DYNAMIC, *EVERY)
    attempts.make("SIGTERM", stopped, reference, folder / "term", signal.SIGTERM, 1, 2)
    attempts.make("SIGUSR1", stopped, reference, folder / "usr1", signal.SIGUSR1, 2, 1)
    attempts.make("write failure", write_failure, reference, folder / "full")
    attempts.make("sleep", sleeping, reference.program, folder / "sleep")
    attempts.make("all laws", all_laws, reference.program, folder / "laws")
    attempts.make("tuned skin", tuned, reference.program, folder / "tuned")
    attempts.make("plane", on_plane, reference.program, folder / "plane")
    attempts.make("curved mesh", curved, reference.program, folder / "curved")
    attempts.make("kill", killed, reference.program, folder / "killed")
    return attempts.exit_code()


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:3], Path(sys.argv[3]).resolve()))
