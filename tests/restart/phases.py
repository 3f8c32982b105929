"""A run goes on with another input: other walls, laws, time steps, another output folder. It gives the
same bits on any number of ranks, changes nothing that it need not, says what differs, and refuses what
cannot be.

Usage: phases.py path/to/eunoe-particles path/to/many-runs folder
"""

from __future__ import annotations

import copy
import json
import shutil
import subprocess
import sys
from pathlib import Path

from attempts import Attempts
from eunoe.launch import SHARED, Failure, mpirun, overrides
from many_runs import SharedProcesses

HERE = Path(__file__).resolve().parent
END = "simulation control/iteration end = "
OUTPUT = "simulation control/output path = "
CONTINUE = "restart/restart = true"
BOUNDARY = "DEM boundary conditions/boundary condition "
# Rain into a closed box, of which the second phase opens a side, drops the paddle, stops the rain and
# makes friction weaker.
LOAD = (END + "6000", "restart/checkpoint = true", "restart/frequency = 6000", BOUNDARY + "1/type = fixed_wall")
MOTION = "solid objects/solid surfaces/solid object 0/translational velocity/Function expression = "
FAR_AWAY = ("floating walls/number of floating walls = 1", "floating walls/wall 0/point on wall = 1, 0, 0",
            "floating walls/wall 0/normal vector = 1, 0, 0", "floating walls/wall 0/end time = 1")
OPEN = (END + "12000", CONTINUE, "solid objects/solid surfaces/number of solids = 0",
        "lagrangian physical properties/particle type 0/friction coefficient particles = 0.1")


class Program:
    def __init__(self, path: str, many_runs: str, folder: Path) -> None:
        self.path, self.folder = str(Path(path).resolve()), folder
        self.on_one_rank = SharedProcesses(many_runs, folder / "printed")
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        text = (HERE / "stirred.prm").read_text(encoding="utf-8")
        (folder / "case.prm").write_text(text, encoding="utf-8")
        # Without the paddle, of which an input may not even have the section.
        begin = text.index("subsection solid objects")
        (folder / "open.prm").write_text(text[:begin] + text[text.index("subsection post-processing"):],
                                         encoding="utf-8")

        begin = text.index("  subsection particle type 1")
        end = text.index("  set friction coefficient wall")
        (folder / "one_type.prm").write_text(text[:begin] + text[end:], encoding="utf-8")

    def run(self, case: str, *settings: str, ranks: int = 1, code: int = 0) -> str:
        words = [case, "--dump", "dump", *overrides(settings)]
        done = self.on_one_rank(*words, cwd=self.folder) if ranks == 1 else subprocess.run(
            [*mpirun(ranks, *SHARED), self.path, *words], cwd=self.folder, text=True, capture_output=True, check=False)
        if done.returncode != code:
            raise Failure(f"exit code {done.returncode}:\n{done.stdout}{done.stderr}")
        return done.stdout + done.stderr

    def dump(self) -> bytes:
        return (self.folder / "dump").read_bytes()

    def summary(self, folder: str) -> dict:
        return json.loads((self.folder / folder / "summary.json").read_text(encoding="utf-8"))


def expect(text: str, *parts: str) -> None:
    for part in parts:
        if part not in text:
            raise Failure(f"'{part}' is missing in:\n{text}")


def other_walls(program: Program) -> None:
    """The same bits on any ranks, with a mass balance of its own, in another folder."""
    said = program.run("open.prm", *OPEN[:2], OPEN[3], OUTPUT + "open1", "restart/restart folder = load")
    expect(said, "with another input. What differs:", "entry 'type' is 'outlet', and was 'fixed_wall'",
           "friction coefficient particles' is '0.1', and was '0.4'", "Gone are 'boundary 1', 'solid object 0'.",
           "step 6000, t = 0.006 s")
    first = program.dump()
    summary = program.summary("open1")
    if summary["outlet_particles"] == 0 or summary["mass_balance_error"] != 0. or summary["first_step"] != 6000:
        raise Failure(f"not what was expected: {summary}")
    if not (program.folder / "open1" / "energies.csv").read_text().splitlines()[1].startswith("0.006"):
        raise Failure("the new tables do not begin with the beginning of the phase")
    for ranks in (2, 4):
        program.run("open.prm", *OPEN[:2], OPEN[3], OUTPUT + f"open{ranks}", "restart/restart folder = load",
                    ranks=ranks)
        if program.dump() != first:
            raise Failure(f"other bits on {ranks} ranks")


def nothing_else(program: Program) -> None:
    """A difference without an effect changes next to nothing: contacts keep their memory. The forces
    of the first half step are those of the complete velocities."""
    longer = (END + "6300", *LOAD[1:])
    program.run("case.prm", *longer, OUTPUT + "alone")
    program.run("case.prm", *longer, OUTPUT + "walled", CONTINUE, "restart/restart folder = load", *FAR_AWAY)
    alone, walled = (program.summary(name)["kinetic_energy"] for name in ("alone", "walled"))
    if not abs(walled - alone) < 1e-5 * alone:
        raise Failure(f"kinetic energy of {walled} instead of {alone} J")


def other_steps(program: Program) -> None:
    """Time goes on with steps of another length, to the end that the input gives."""
    said = program.run("case.prm", *LOAD[1:], CONTINUE, "restart/restart folder = load", OUTPUT + "steps",
                       "simulation control/time step = 5e-7", "simulation control/end control = time",
                       "simulation control/time end = 0.0065")
    # The forecast counts those that have come, too.
    expect(said, "step 6000, t = 0.006 s", "for 270 particles")
    summary = program.summary("steps")
    if summary["steps"] != 7000 or abs(summary["simulated_time"] - 0.0065) > 1e-12:
        raise Failure(f"{summary['steps']} steps to {summary['simulated_time']} s")
    # Its own checkpoint continues it, with its own clock.
    program.run("case.prm", *LOAD[1:], "restart/restart = auto", OUTPUT + "steps",
                "restart/frequency = 500", "restart/restart folder = load", "restart/wall time interval = 0",
                "simulation control/time step = 5e-7", "simulation control/end control = time",
                "simulation control/time end = 0.0067")
    if abs(program.summary("steps")["simulated_time"] - 0.0067) > 1e-12:
        raise Failure("the second phase does not go on from its own checkpoint")


def other_laws(program: Program) -> None:
    said = program.run("case.prm", *LOAD[1:], END + "6100", CONTINUE, "restart/restart folder = load",
                       OUTPUT + "laws", "model parameters/rolling resistance torque method = none")
    expect(said, "Contacts of particles obey other laws now and begin anew.",
           "Contacts with walls and solids obey other laws now and begin anew.")


def same_folder(program: Program) -> None:
    """Tables go on, and those of walls and solids that are gone stay."""
    shutil.copytree(program.folder / "load", program.folder / "same")
    kept = program.folder / "same" / "restart_phase_000000006000.checkpoint"
    kept.write_text("what a phase of another run began with", encoding="utf-8")
    before = (program.folder / "same" / "energies.csv").read_text()
    program.run("open.prm", *OPEN[:2], OPEN[3], "restart/checkpoint = true", "restart/frequency = 1000",
                OUTPUT + "same")
    if not (program.folder / "same" / "energies.csv").read_text().startswith(before):
        raise Failure("the table of energies was not continued")
    for name in ("solid_forces_00.csv", "force_1.csv"):
        if not (program.folder / "same" / name).read_text().startswith((program.folder / "load" / name).read_text()):
            raise Failure(f"{name} of the first phase is not what it was")
    if kept.read_bytes() != (program.folder / "load" / "restart_000000006000.checkpoint").read_bytes():
        raise Failure("the checkpoint from which the phase began is not kept")


def old_results(program: Program) -> None:
    """What another run has measured does not stay beside what a run that measures nothing has done."""
    old = program.folder / "nothing_measured" / "measurements.csv"
    old.parent.mkdir()
    old.write_text("what another run has measured", encoding="utf-8")
    program.run("case.prm", END + "10", OUTPUT + "nothing_measured", "post-processing/energies/calculation = false")
    if old.exists():
        raise Failure("the measurements of another run are left")


def own_path(program: Program) -> None:
    """Checkpoints that have a path of their own serve runs with different output folders."""
    marks = ("restart/filename = marks/dem", "restart/checkpoint = true", "restart/frequency = 6000")
    program.run("case.prm", *LOAD, *marks, OUTPUT + "one")
    before = (program.folder / "one" / "energies.csv").read_text()
    program.run("open.prm", *OPEN[:2], OPEN[3], *marks, OUTPUT + "two")
    if (program.folder / "one" / "energies.csv").read_text() != before:
        raise Failure("the second run has changed a table of the first")
    if not (program.folder / "two" / "energies.csv").read_text().splitlines()[1].startswith("0.006"):
        raise Failure("the second run has no tables of its own")
    names = sorted(path.name for path in (program.folder / "marks").glob("*.checkpoint"))
    if names != ["dem_000000006000.checkpoint", "dem_000000012000.checkpoint", "dem_phase_000000006000.checkpoint"]:
        raise Failure(f"the checkpoints are {names}")
    # However the path is written, the tables are its own.
    more = (*OPEN[1:2], OPEN[3], *marks[:2], "restart/frequency = 500", END + "12500")
    program.run("open.prm", *more, OUTPUT + "./two/")
    rows = (program.folder / "two" / "energies.csv").read_text().splitlines()
    if not rows[1].startswith("0.006") or abs(float(rows[-1].split(",")[0]) - 0.0125) > 1e-12:
        raise Failure("a table is not continued in a folder that is written in another way")


def found_nearby(program: Program) -> None:
    place = program.folder / "nearby"
    shutil.copytree(program.folder / "load", place / "load")
    shutil.copy(program.folder / "case.prm", place)
    alone = copy.copy(program)
    # From the folder in which the program is started, too.
    (place / "here").mkdir()
    shutil.copy(program.folder / "case.prm", place / "here")
    alone.folder = place / "here"
    expect(alone.run("case.prm", *LOAD[1:], END + "6100", CONTINUE, OUTPUT + "."),
           "load/restart_000000006000.checkpoint")
    shutil.rmtree(place / "here")
    alone.folder = place
    said = alone.run("case.prm", *LOAD[1:], END + "6100", CONTINUE, OUTPUT + "more")
    expect(said, "load/restart_000000006000.checkpoint")
    shutil.copytree(place / "load", place / "load2")
    expect(alone.run("case.prm", *LOAD[1:], END + "6100", CONTINUE, OUTPUT + "third", code=2),
           "are in several folders: ", "Name one as 'restart folder'.")


# A grain that flies through an outlet between two searches, and one that stays.
LEAVING = """
subsection simulation control
  set end control   = iteration
  set time step     = 1e-5
  set iteration end = 50
end
subsection mesh
  set grid type      = subdivided_hyper_rectangle
  set grid arguments = 1, 1, 1 : 0, 0, 0 : 1e-2, 1e-2, 1e-2 : true
end
subsection DEM boundary conditions
  set number of boundary conditions = 1
  subsection boundary condition 0
    set type        = outlet
    set boundary id = 1
  end
end
subsection lagrangian physical properties
  set g = 0, 0, 0
  subsection particle type 0
    set diameter            = 1e-3
    set number of particles = 2
  end
end
subsection model parameters
  subsection contact detection
    set neighborhood threshold = 3
  end
end
subsection insertion info
  set insertion method = list
  set list x           = 9.8e-3, 2e-3
  set list y           = 5e-3, 5e-3
  set list z           = 5e-3, 5e-3
  set list velocity x  = 1, 0
  set list velocity y  = 0, 0
  set list velocity z  = 0, 0
end
"""


def leaving(program: Program) -> None:
    (program.folder / "leaving.prm").write_text(LEAVING, encoding="utf-8")
    program.run("leaving.prm", "restart/checkpoint = true", OUTPUT + "leaving")
    if program.summary("leaving")["particles"] != 2:
        raise Failure("the grain that leaves is gone before the phase begins, so nothing is tested")
    program.run("leaving.prm", CONTINUE, "restart/restart folder = leaving", END + "60", OUTPUT + "left",
                "lagrangian physical properties/g = 0, -1, 0")
    if program.summary("left")["particles"] != 1:
        raise Failure(f"{program.summary('left')['particles']} grains instead of one")


def other_insertion(program: Program) -> None:
    """A single grain of another type, from a list, comes once on those that another method has brought."""
    insertion, kind = "insertion info/", "lagrangian physical properties/"
    brought = (kind + "particle type 0/number of particles = 4", OUTPUT + "brought")
    program.run("leaving.prm", "restart/checkpoint = true", *brought, insertion + "insertion method = volume",
                insertion + "insertion box points coordinates = 1e-3, 1e-3, 1e-3 : 9e-3, 9e-3, 3e-3")
    if program.summary("brought")["particles"] != 4:
        raise Failure("the first grains are not there, so nothing is tested")
    begin = (brought[0], "restart/restart folder = brought", OUTPUT + "intruder", "restart/checkpoint = true",
             *(insertion + f"list {name}" for name in ("x = 5e-3", "y = 5e-3", "z = 8e-3", "velocity x = 0", "velocity y = 0",
                                                       "velocity z = 0")),
             kind + "number of particle types = 2", kind + "particle type 1/diameter = 1e-3",
             kind + "particle type 1/number of particles = 1")
    often = insertion + "insertion frequency = 10"
    # And in a part of that phase.
    for part in ((CONTINUE, END + "60"), ("restart/restart = auto", END + "90")):
        program.run("leaving.prm", *begin, often, *part)
        if program.summary("intruder")["particles"] != 5:
            raise Failure(f"{program.summary('intruder')['particles']} grains instead of five")
    # A packing does not know of grains that are there.
    packed = (*begin[:2], OUTPUT + "packed", CONTINUE, END + "60", often, insertion + "insertion method = packed", *begin[-3:])
    box = insertion + "insertion box points coordinates = 1e-3, 1e-3, "
    expect(program.run("leaving.prm", *packed, box + "1e-3 : 9e-3, 9e-3, 3e-3", code=1),
           "4 particles are where others are to be packed")
    program.run("leaving.prm", *packed, box + "6e-3 : 9e-3, 9e-3, 9e-3")
    # Places outside the mesh are refused as long as anything is to come to them.
    outside = (often, insertion + "list z = 5", OUTPUT + "outside", CONTINUE)
    expect(program.run("leaving.prm", *begin, *outside, END + "60", code=2), "are to be inserted outside the mesh")
    program.run("leaving.prm", *begin, *outside, END + "100", "restart/restart folder = intruder")
    expect(program.run("leaving.prm", *begin, OUTPUT + "none", CONTINUE, END + "60"), "Nothing is inserted in this phase, although not all particles have come")


def refused(program: Program) -> None:
    start = (*LOAD[1:], CONTINUE, "restart/restart folder = load", OUTPUT + "refused")
    kind = "lagrangian physical properties/"
    for settings, sentence, code in (
            ((END + "6000", kind + "g = 0, -5, 0"), "is of step 6000, and the run ends at step 6000", 2),
            ((END + "7000", kind + "particle type 0/average diameter = 0.3e-3",
              kind + "particle type 0/standard deviation = 0.01e-3"),
             "m, and those of the input have 0.0005 m at most", 2),
            ((END + "7000", "mesh/grid arguments = 5, 4, 2 : 0, 0, 0 : 6e-3, 8e-3, 4e-3 : true"),
             "particles that lie outside the mesh of this input.", 2),
            ((END + "7000", kind + "particle type 0/number of particles = 1"),
             "Keep it, and give further particles as a type behind the others.", 2),
            ((END + "7000", "restart/restart folder = nowhere"), "nowhere holds no checkpoint 'restart'.", 2),
            ((END + "7000", "restart/restart folder = case.prm"),
             "The checkpoints in case.prm cannot be looked for: Not a directory.", 2)):
        expect(program.run("case.prm", *start, *settings, code=code), sentence)
    expect(program.run("one_type.prm", *start, END + "7000", kind + "number of particle types = 1", code=2),
           "holds particles of type 1, and the input has the types 0 to 0.")
    # Nothing of the earlier results is lost by that.
    names = ("summary.json", "energies.csv", "used.prm")
    before = [(program.folder / "load" / name).read_bytes() for name in names]
    expect(program.run("case.prm", *LOAD[1:], END + "7000", OUTPUT + "load", "restart/restart = auto",
                       kind + "g = 0, -5, 0", code=2), "entry 'g' is '0, -5, 0', and was '0, -9.81, 0'")
    expect(program.run("one_type.prm", *LOAD[1:], CONTINUE, OUTPUT + "load", END + "7000",
                       kind + "number of particle types = 1", code=2), "holds particles of type 1")
    if [(program.folder / "load" / name).read_bytes() for name in names] != before:
        raise Failure("a phase that is refused has changed the results before it")


def loads_at_the_beginning(program: Program) -> None:
    """Forces on walls at the moment at which a phase begins are those at which the part before it ended."""
    often = ("boundary forces/output frequency = 1000", "post-processing/solid forces/output frequency = 1000")
    program.run("case.prm", *LOAD, *often, OUTPUT + "often")
    program.run("case.prm", *LOAD[1:], *often, END + "6100", CONTINUE, "restart/restart folder = often", OUTPUT + "loads",
                "lagrangian physical properties/g = 0, -9.8, 0")
    for name in ("force_0.csv", "force_2.csv"):
        last = (program.folder / "often" / name).read_text().splitlines()[-1].split(",")
        first = (program.folder / "loads" / name).read_text().splitlines()[1].split(",")
        if not same_numbers(first, last, 0.05):
            raise Failure(f"{name} begins with {first}, and ended with {last}")


def same_numbers(one: list[str], other: list[str], share: float) -> bool:
    """Whether two rows agree within a share of their largest number but the first, which is the time."""
    a, b = (list(map(float, row)) for row in (one, other))
    size = max(abs(value) for value in b[1:])
    return size > 0. and a[0] == b[0] and all(abs(x - y) <= share * size for x, y in zip(a[1:], b[1:]))


def walls_of_one_name(program: Program) -> None:
    """The sides of a box that share an id are told apart by their order."""
    text = (HERE / "stirred.prm").read_text(encoding="utf-8").replace("4e-3 : true", "4e-3 : false")
    begin, end = text.index("subsection DEM boundary"), text.index("subsection lagrangian")
    (program.folder / "plain.prm").write_text(text[:begin] + text[end:], encoding="utf-8")
    until = LOAD[1:3]
    program.run("plain.prm", END + "6000", *until, OUTPUT + "plain")
    program.run("plain.prm", END + "6300", *until, OUTPUT + "undisturbed")
    program.run("plain.prm", END + "6300", *until, OUTPUT + "phase", CONTINUE, "restart/restart folder = plain", *FAR_AWAY)
    alone, phase = (program.summary(name)["kinetic_energy"] for name in ("undisturbed", "phase"))
    if not abs(phase - alone) < 1e-5 * alone:
        raise Failure(f"kinetic energy of {phase} instead of {alone} J")


def only_the_balance(program: Program) -> None:
    """Where particles are computed changes nothing, so it begins no phase."""
    said = program.run("case.prm", *LOAD[1:], END + "6010", CONTINUE, "restart/restart folder = load", OUTPUT + "balance",
                       "model parameters/load balancing/cell weight function/Function expression = 2 + x")
    if "with another input" in said:
        raise Failure(said)


def turns_in_place(program: Program) -> None:
    """A flat wall that begins to turn about an axis anywhere has not moved."""
    said = program.run("case.prm", *LOAD[1:], END + "6010", CONTINUE, "restart/restart folder = load", OUTPUT + "turns",
                       *(BOUNDARY + "1/" + entry for entry in (
                           "type = rotational", "rotational speed = 3", "rotational vector = 1, 0, 0",
                           "point on rotational vector = 0, 4e-3, 2e-3")))
    expect(said, "with another input")
    if "from where it stood" in said:
        raise Failure(said)


def other_contents(program: Program) -> None:
    """What a file holds that the input names belongs to the input."""
    grains = program.folder / "grains.csv"
    grains.write_text("p_x; p_y; p_z; diameters\n5e-3; 4e-3; 2e-3; 1e-3\n", encoding="utf-8")
    text = (program.folder / "one_type.prm").read_text(encoding="utf-8")
    begin = text.index("subsection insertion info")
    (program.folder / "file.prm").write_text(
        text[:begin] + "subsection insertion info\n  set insertion method = file\n"
        "  set list of input files = grains.csv\nend\n" + text[text.index("subsection model parameters"):],
        encoding="utf-8")
    start = (*LOAD[1:2], "restart/frequency = 100", OUTPUT + "file")
    program.run("file.prm", *start, END + "100")
    program.run("file.prm", *start, END + "200", "restart/restart = auto", ranks=2)
    grains.write_text("p_x; p_y; p_z; diameters\n6e-3; 4e-3; 2e-3; 1e-3\n", encoding="utf-8")
    expect(program.run("file.prm", *start, END + "300", "restart/restart = auto", code=2),
           "entry 'list of input files' names a file that had other contents in the run that wrote")
    expect(program.run("file.prm", *start, END + "300", CONTINUE),
           "with another input. What differs:", "entry 'list of input files' names a file that had other contents")


def jumps(program: Program) -> None:
    """A motion that would have begun before the phase is told of."""
    said = program.run("case.prm", *LOAD[1:], END + "6010", CONTINUE, "restart/restart folder = load", OUTPUT + "jumps",
                       MOTION + "0.1; 0; 0")
    expect(said, "m from where it stood, as motions count from t = 0")


def main() -> int:
    program = Program(*sys.argv[1:3], Path(sys.argv[3]))
    program.run("case.prm", *LOAD, OUTPUT + "load", ranks=2)
    attempts = Attempts()
    for attempt in (other_walls, nothing_else, other_steps, other_laws, same_folder, old_results, own_path, found_nearby, leaving, other_insertion,
                    refused, loads_at_the_beginning, jumps, walls_of_one_name, only_the_balance, turns_in_place,
                    other_contents):
        attempts.make(attempt.__name__.replace("_", " "), attempt, program)
    return attempts.exit_code()


if __name__ == "__main__":
    sys.exit(main())
