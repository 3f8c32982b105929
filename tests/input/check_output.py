"""The warnings of --check for doubtful cases, which a run repeats at its start, and the cases that
are refused.

Usage: check_output.py path/to/many-runs folder
"""

from __future__ import annotations

import math
import shutil
import sys
from pathlib import Path

from eunoe.launch import overrides
from many_runs import ManyRuns

ROOT = Path(__file__).resolve().parents[2]

ENTRY = "simulation control/time step"
# One glass sphere of 1 mm, two steps.
BASE = """\
subsection simulation control
  set time step     = 2e-6
  set end control   = iteration
  set iteration end = 2
  set output path   = results
end
subsection mesh
  set grid type      = subdivided_hyper_rectangle
  set grid arguments = 4, 4, 4 : 0, 0, 0 : 0.02, 0.02, 0.02 : true
end
subsection lagrangian physical properties
  set g = 0, 0, -9.81
  subsection particle type 0
    set diameter                = 1e-3
    set number of particles     = 1
    set density particles       = 2500
    set young modulus particles = 1e8
  end
  set young modulus wall = 1e8
end
subsection insertion info
  set insertion box points coordinates = 0.005, 0.005, 0.005 : 0.015, 0.015, 0.015
end
"""
LIST = ["lagrangian physical properties/particle type 0/number of particles = 2",
        "insertion info/insertion method = list", "insertion info/list x = 0.01, 0.01",
        "insertion info/list y = 0.01, 0.01", "insertion info/list z = 0.01, 0.012"]
SOLID = ["solid objects/solid surfaces/number of solids = 1",
         "solid objects/solid surfaces/solid object 0/mesh/type = shape",
         "solid objects/solid surfaces/solid object 0/mesh/grid type = box"]
BOX = "solid objects/solid surfaces/solid object 0/mesh/grid arguments = "
VELOCITY = "solid objects/solid surfaces/solid object 0/translational velocity/Function expression = "
# Two particles of 1 mm, and a third one in the second.
FILE = ["insertion info/insertion method = file", "insertion info/list of input files = three.csv"]
THREE = "p_x; p_y; p_z; diameters\n0.01; 0.01; 0.01; 1e-3\n0.01; 0.01; 0.012; 1e-3\n0.01; 0.01; 0.0121; 1e-3\n"
TYPE = "lagrangian physical properties/particle type 0/"
FEW = ["insertion info/insertion frequency = 1000",
       "insertion info/inserted number of particles at each time step = 5", TYPE + "number = 20"]
OPEN_END = "Solids have no periodic images"
OUTSIDE = "the solid lies outside the mesh during the whole run"

MODEL = "model parameters/"
PERIOD = ["DEM boundary conditions/number of boundary conditions = 1",
          *(f"DEM boundary conditions/boundary condition 0/{entry}" for entry in (
              "type = periodic", "periodic id 0 = 4", "periodic id 1 = 5", "periodic direction = 2"))]
DMT = MODEL + "particle particle contact force method = DMT"
DMT_OF_WALLS = MODEL + "particle wall contact force method = DMT"
ENERGY = TYPE + "surface energy particles = 1e-3"
ENERGY_OF_WALL = "lagrangian physical properties/surface energy wall = "
OWN = "lagrangian physical properties/wall material 0/"
OWN_MATERIAL = ["lagrangian physical properties/number of wall materials = 1", OWN + "surfaces = boundary"]
SLEEP = MODEL + "adaptive sparse contacts/"
CONDITION = "DEM boundary conditions/"

# Name: settings, and the warnings that they must give once each.
DOUBTFUL = {
    "nothing doubtful": ([], []),
    "walls with other laws": ([DMT, ENERGY], ["is 'nonlinear' while particles use 'DMT', so that they touch walls"]),
    "adhesion of all": ([DMT, DMT_OF_WALLS, ENERGY, ENERGY_OF_WALL + "1e-3"], []),
    "a surface energy that no law reads": ([ENERGY], ["is 0.001 J/m2, and no law has adhesion"]),
    "adhesion without a surface energy": ([DMT, DMT_OF_WALLS], ["and all particles have a surface energy of 0"]),
    "walls without a surface energy": ([DMT, DMT_OF_WALLS, ENERGY], ["so that they do not stick to walls and solids"]),
    "walls that are not to stick": ([DMT, DMT_OF_WALLS, ENERGY, ENERGY_OF_WALL + "0"], []),
    "walls of a material with a surface energy": (
        [DMT, DMT_OF_WALLS, ENERGY, *OWN_MATERIAL, OWN + "surface energy wall = 1e-3"], []),
    "walls of a material without a surface energy": (
        [DMT, DMT_OF_WALLS, ENERGY, *OWN_MATERIAL, OWN + "friction coefficient wall = 0.2"],
        ["so that they do not stick to walls and solids"]),
    "a list that comes once": ([*LIST, TYPE + "number of particles = 5"],
                               ["entry 'insertion frequency': is 0, so that the particles come once: 2 of 5."]),
    "files of which only the first comes": (
        [FILE[0], FILE[1] + ", three.csv", TYPE + "number = 2"],
        ["names 2 files, one an event, and with an 'insertion frequency' of 0 there is one event",
         "so that only the first 2 particles of the files come"]),
    "no such boundary": ([CONDITION + "number of boundary conditions = 1",
                          CONDITION + "boundary condition 0/boundary id = 17"],
                         ["the mesh has no boundary 17, so the condition has no effect."]),
    "a wall that never acts": (["floating walls/number of floating walls = 1"],
                               ["is 0 s, not after the start time of 0 s, so the wall does not act."]),
    "a box that reaches out": (["insertion info/insertion box points coordinates = "
                                "0.01, 0.01, 0.01 : 0.03, 0.012, 0.012", TYPE + "number = 18",
                                "insertion info/insertion distance threshold = 1.1"],
                               ["% of the particles are to be inserted outside the mesh and will be left out."]),
    "much too large a step": ([ENTRY + " = 2e-3"],
                              ["exceeds 25 % of the Rayleigh time of particle type 0"]),
    "a stiff wall": (["lagrangian physical properties/young modulus wall = 1e13",
                      TYPE + "poisson ratio particles = 0.45", ENTRY + " = 3.3e-6"],
                     ["the stiffest contact of particle type 0 takes"]),
    "small particles in a list": ([*LIST, "insertion info/list diameters = 1e-5, 1e-3"],
                                  ["exceeds 25 % of the Rayleigh time"]),
    "small particles of the second type in a list": (
        [*LIST, "lagrangian physical properties/number of particle types = 2",
         "insertion info/insertion frequency = 1", TYPE.replace("0", "1") + "diameter = 1e-5",
         TYPE.replace("0", "1") + "number of particles = 2"],
        ["exceeds 25 % of the Rayleigh time of particle type 1", "between two events, the particles move by no more"]),
    "no particles but a solid": ([TYPE + "number = 0", *SOLID, BOX + "0.004, 0.004, 0.004 : 0.006, 0.006, 0.006"],
                                 ["no particles come into the run."]),
    "a solid in millimetres": ([*SOLID, BOX + "-5000, -5000, 0.001 : 5000, 5000, 5000"],
                               ["10000 m long, 500000 times as long as the mesh"]),
    "a solid outside": ([*SOLID, BOX + "1, 1, 1 : 1.01, 1.01, 1.01"], [OUTSIDE]),
    "a solid that comes in": ([*SOLID, BOX + "0.021, 0.005, 0.005 : 0.022, 0.006, 0.006",
                               VELOCITY + "-0.1; 0; 0", "simulation control/iteration end = 10000"], []),
    "a solid from end to end of a period": ([*PERIOD, *SOLID, BOX + "0.005, 0.005, 0 : 0.015, 0.01, 0.02"], [OPEN_END]),
    "a solid beyond both ends of a period": ([*PERIOD, *SOLID, BOX + "0.005, 0.005, -0.0011 : 0.015, 0.01, 0.0211"], []),
    "a solid that crosses the end of a period": ([*PERIOD, *SOLID, BOX + "0.005, 0.005, 0.01 : 0.01, 0.01, 0.012",
                                                  VELOCITY + "0; 0; 0.01", "simulation control/iteration end = 600000"],
                                                 [OPEN_END]),
    # 500 looks at even intervals would see it at rest only.
    "a vibration": ([*SOLID, BOX + "0.004, 0.004, 0.004 : 0.005, 0.005, 0.005", VELOCITY + "0; 5*sin(2*pi*50*t); 0",
                     "simulation control/iteration end = 5000000"], ["searches for contacts will take much of the time"]),
    "a tiny solid": ([*SOLID, BOX + "0.004, 0.004, 0.004 : 0.00401, 0.00401, 0.00401"],
                     ["the solid is only 1e-05 m long, while the mesh is 0.02 m long"]),
    "a fast solid": ([*SOLID, BOX + "0.004, 0.004, 0.004 : 0.005, 0.005, 0.005", VELOCITY + "5; 0; 0"],
                     ["searches for contacts will take much of the time"]),
    "particles that touch": ([*LIST, "insertion info/list z = 0.01, 0.0109"],
                             ["a particle overlaps another by 0.2 of its radius"]),
    "a file that is cut short": ([*FILE, TYPE + "number of particles = 2"],
                                 ["'number of particles': is 2, so that only the first 2 particles of the files come."]),
    "a particle in a wall": ([*LIST, "insertion info/list z = 0.0004, 0.01"],
                             ["a particle overlaps a wall or solid by 0.2 of its radius"]),
    "a fast particle": (["insertion info/initial velocity = 0, 0, -100"],
                        ["moves by 0.4 of its radius in a time step"]),
    "too few events": (FEW, ["only 5 of 20 particles come until the run ends, in 1 event."]),
    "events upon each other": ([*FEW, "simulation control/iteration end = 4000"],
                               ["between two events, the particles move by no more than 1.962e-05 m"]),
    "a list upon itself": ([*LIST, "lagrangian physical properties/particle type 0/number of particles = 4",
                            "insertion info/list z = 0.01, 0.015", "insertion info/list velocity z = 0.1",
                            "insertion info/insertion frequency = 100", "simulation control/iteration end = 100"],
                           ["between two events, the particles move by no more than 1.962e-07 m",
                            "and a list of velocities 1: the other particles have 0 there."]),
    "a deviation of equal sizes": (
        [TYPE + "standard deviation = 1e-4"],
        ["entry 'standard deviation' has no effect, as the 'size distribution type' is 'uniform'."]),
    "a deviation of 0": ([TYPE + "standard deviation = 0"], []),
    "classes beside a normal distribution": (
        [TYPE + "size distribution type = normal", TYPE + "standard deviation = 1e-5",
         TYPE + "custom diameters = 1e-3, 2e-3"],
        ["entry 'custom diameters' has no effect, as the 'size distribution type' is 'normal'."]),
    "another distribution than a file before had": (
        [TYPE + "custom diameters = 1e-3, 2e-3", TYPE + "size distribution type = uniform"], []),
    "a file of sizes that is not read": (
        [ENTRY + " = 1e-6", TYPE + "size distribution type = custom", TYPE + "custom distribution filename = sizes.txt"],
        ["entry 'custom distribution filename' has no effect, as 'custom distribution from file' is false."]),
    "pictures without end": (["simulation control/output frequency = 1",
                              "simulation control/iteration end = 2000000"],
                             ["pictures would be written."]),
    "sleep in the air": ([SLEEP + "enable adaptive sparse contacts = true", SLEEP + "rest time = 1e-4"],
                         ["is so short that a particle falls asleep in the air at the top of its path"]),
    "sleep on the ground": ([SLEEP + "enable adaptive sparse contacts = true"], []),
    "a run without end": (["simulation control/end control = time", "simulation control/time end = 1e308",
                           "simulation control/output frequency = 0"],
                          ["the run would take 9.22337e+18 steps. Shorten it"]),
    "two at once": ([ENTRY + " = 2e-3", *SOLID, BOX + "1, 1, 1 : 1.01, 1.01, 1.01"],
                    ["exceeds 25 % of the Rayleigh time", OUTSIDE]),
}
LONG = {"a run without end", "a solid that comes in", "events upon each other", "pictures without end", "too few events",
        "a solid that crosses the end of a period", "a vibration"}

STOP = "model parameters/excessive overlap = stop"
AUTO = ENTRY + " = auto"
# The Rayleigh time is pi R sqrt(rho/G) / (0.1631 nu + 0.8766).
RAYLEIGH = math.pi * 0.5e-3 * math.sqrt(2500. / (1e8 / 2.6)) / (0.1631 * 0.3 + 0.8766)
# Name: settings, exit code 2, and a part of the sentence.
REFUSED = {
    "a whole file": ([*FILE, TYPE + "number of particles = 0"], "a particle overlaps another by 1.8 of its radius"),
    "no particles and no solids": ([TYPE + "number = 0"],
                                   "no particles come into the run, and there are no solids to be seen."),
    "particles in one place": ([*LIST, "insertion info/list z = 0.01, 0.0101"],
                               "a particle overlaps another by 1.8 of its radius"),
    "a particle deep in a wall": ([*LIST, STOP, "insertion info/list z = 0.0001, 0.01"],
                                  "a particle overlaps a wall or solid by 0.8 of its radius"),
    "a particle in a solid": ([*LIST, *SOLID, STOP, BOX + "0.0101, 0.005, 0.005 : 0.015, 0.015, 0.015"],
                              "a particle overlaps a wall or solid by 0.8 of its radius"),
    "a solid that gets too fast": ([*SOLID, BOX + "0.004, 0.004, 0.004 : 0.005, 0.005, 0.005",
                                    VELOCITY + "if(t > 5e-6, 500, 0); 0; 0",
                                    "simulation control/iteration end = 5"],
                                   "a solid moves by 0.001 m in a time step at t ="),
    "an automatic step and smaller particles": ([*LIST, AUTO, "insertion info/list diameters = 1e-5, 1e-3"],
                                                "and smaller particles, of 10 um, are inserted."),
    "no share of the Rayleigh time": ([AUTO, ENTRY + " share = 0"], "entry 'time step share' is 0."),
    "an automatic step of nonsense": ([AUTO, TYPE + "young modulus particles = 0"],
                                      "entry 'young modulus particles' is 0 Pa."),
    "a path through a file": (["simulation control/output path = case.prm/results"], "case.prm is a file"),
    "too many particles": (["insertion info/insertion method = plane", "insertion info/insertion frequency = 1",
                            "insertion info/insertion plane point = 0.01, 0.01, 0.01",
                            "lagrangian physical properties/number of particle types = 3",
                            *(f"lagrangian physical properties/particle type {k}/number = 2000000000"
                              for k in range(3))], "At most 4.29497e+09 are possible."),
}

# Name: settings, and beginnings of lines, with whole numbers and their nouns.
FACTS = {
    "one particle": ([], ["Particle type 0: diameter 1000 um; the time step",
                          "Memory: about 0.0014 MB for 1 particle,",
                          "  particles:  1 at most, 1 on average", "  steps:      2 of 2e-06 s",
                          "  core-hours: about 3.5e-11 ("]),
    "an automatic step": ([AUTO], [f"Particle type 0: diameter 1000 um; the time step of {0.2 * RAYLEIGH:.6g} s is "
                                   "20 % of the Rayleigh time"]),
    "a tenth of the Rayleigh time": ([AUTO, ENTRY + " share = 0.1"],
                                     ["Particle type 0: diameter 1000 um; the time step of "
                                      f"{0.1 * RAYLEIGH:.6g} s is 10 % of the Rayleigh time"]),
    "an automatic step and a stiff wall": ([AUTO, ENTRY + " share = 0.5",
                                            "lagrangian physical properties/young modulus wall = 1e13"],
                                           ["Particle type 0: diameter 1000 um; the time step of 3."]),
    "two sizes, one picture": ([*LIST, "insertion info/list diameters = 5e-4, 1e-3",
                                "simulation control/output frequency = 1500000",
                                "simulation control/iteration end = 1200001"],
                               ["Particle type 0: diameters 500 to 1000 um; the time step",
                                "Disk: 1 picture of about", "  particles:  2 at most, 2 on average",
                                "  steps:      1200001 of 2e-06 s", "  core-hours: about 4.2e-05 ("]),
    "a short period": ([*LIST, *PERIOD, "mesh/grid arguments = 4, 4, 1 : 0, 0, 0 : 0.02, 0.02, 0.0021 : true",
                        "insertion info/list x = 0.005, 0.015", "insertion info/list z = 0.001, 0.001"],
                       ["A period of the domain is short: the skin is 5e-05 m instead of 0.0003 m"]),
    "a threshold that follows the flow": ([MODEL + "contact detection/neighborhood threshold = auto"],
                                          ["Neighborhood threshold: 1.3 at first, then as the flow needs it"]),
}

# Name, file, settings, a warning or fact, and the number of all warnings. The widest case needs 2.6 TB.
PROCESSES = [
    ("clearance", "prm/spreading/quickstart.prm", ["powder spreading/spreader clearance delta_s = 60e-6"],
     "leaves 6e-05 m below the spreader, less than the largest grain of 0.000101096 m", 1),
    ("tilt", "prm/spreading/quickstart.prm", ["powder spreading/spreader tilt = 60e-6"],
     "leaves 7e-05 m below the spreader", 1),
    ("thin layer", "prm/spreading/own_powder.prm", ["powder spreading/layer thickness delta_l = 25e-6"],
     "is 2.5e-05 m: a layer of this solid, packed to 60 %, stands lower than the largest grain of 4.3e-05 m", 1),
    # W1 (delta_f + feedstock level - delta_s) over W3 delta_l, and over W3 delta_l + (W2 + W3) delta_s.
    ("short strokes", "prm/spreading/own_powder.prm", ["powder spreading/feedstock stroke delta_f = 0.05e-3"],
     "entry 'feedstock stroke delta_f' feeds 94.5205 % of what a layer takes", 1),
    ("short first stroke", "prm/spreading/own_powder.prm", ["powder spreading/first feedstock stroke = 0.1e-3"],
     "entry 'first feedstock stroke' feeds 68.3168 % of what the first layer", 1),
    ("short strokes of a bed that stays", "prm/spreading/own_powder.prm",
     ["powder spreading/feedstock stroke delta_f = 0.06e-3", "powder spreading/feedstock = full"],
     "The case is in order", 0),
    ("coarse step", "prm/spreading/quickstart.prm", [ENTRY + " = 1e-5"],
     "exceeds 25 % of the Rayleigh time of particle type 0", 2),
    ("too wide for the machine", "prm/spreading/PS1_L4.prm",
     ["powder spreading/depth = 1.2", "powder spreading/layer pictures = false"],
     "Memory: the run needs about", 1),
    ("numbers that nobody asks for", "prm/spreading/quickstart.prm",
     ["lagrangian physical properties/number of particle types = 2",
      *(TYPE.replace("0", "1") + entry for entry in (
          "number of particles = 5", "diameter = 80e-6", "density particles = 4430",
          "young modulus particles = 26.25e6"))],
     "subsection 'particle type 1' / entry 'number of particles' has no effect", 1),
    # An event is 8 layers of 1.5 mm high.
    ("showers into each other", "prm/examples/packing_in_box.prm", ["insertion info/insertion frequency = 600"],
     "by no more than 0.00155301 m, while an event is 0.0173223 m long in that direction", 1),
    ("showers one after the other", "prm/examples/packing_in_box.prm", [], "The case is in order", 0),
    ("pictures of six layers", "prm/spreading/quickstart.prm", ["powder spreading/number of layers = 6"],
     "Disk: 6 pictures of about", 0),
]
failures = 0


def fail(name: str, text: str) -> None:
    global failures
    failures += 1
    print(f"{name}: {text}", flush=True)


def call(program: ManyRuns, file: Path | str, *options: str, settings: list[str], cwd: Path) -> tuple[int, str, str]:
    done = program(file, *options, *overrides(settings), cwd=cwd)
    return done.returncode, done.stdout, done.stderr


def warnings(text: str) -> list[str]:
    return [line for line in text.splitlines() if line.startswith("Warning: ")]


def last_line(n_warnings: int) -> str:
    if n_warnings == 0:
        return "The case is in order."
    count = "There is 1 warning" if n_warnings == 1 else f"There are {n_warnings} warnings"
    return f"The case can be run. {count}: see above."


def check_doubtful(program: ManyRuns, folder: Path) -> None:
    for name, (settings, expected) in DOUBTFUL.items():
        code, out, errors = call(program, "case.prm", "--check", settings=settings, cwd=folder)
        found = warnings(out)
        if code != 0 or errors:
            fail(name, f"exit code {code}\n{out}{errors}")
        elif len(found) != len(expected) or any(sum(text in line for line in found) != 1 for text in expected):
            fail(name, f"{expected} and nothing else should be in\n{out}")
        elif out.splitlines()[-1] != last_line(len(expected)):
            fail(name, f"the last line is {out.splitlines()[-1]}")
        if (folder / "results").exists():
            fail(name, "a check has written something")
        if name not in LONG:
            code, out, errors = call(program, "case.prm", settings=settings, cwd=folder)
            if code != 0 and (code != 1 or not expected):
                fail(name, f"the run ends with exit code {code}\n{out}{errors}")
            if [line for line in warnings(out) if line not in found] or not set(found) <= set(warnings(out)):
                fail(name, f"the run says something else than\n{found}\n{out}{errors}")
            shutil.rmtree(folder / "results", ignore_errors=True)


def check_facts(program: ManyRuns, folder: Path) -> None:
    for name, (settings, expected) in FACTS.items():
        code, out, errors = call(program, "case.prm", "--check", settings=settings, cwd=folder)
        for start in expected:
            if code != 0 or sum(line.startswith(start) for line in out.splitlines()) != 1:
                fail(name, f"exit code {code}, no line '{start}' in\n{out}{errors}")


def check_refused(program: ManyRuns, folder: Path) -> None:
    for name, (settings, sentence) in REFUSED.items():
        for options in (["--check"], []):
            code, out, errors = call(program, "case.prm", *options, settings=settings, cwd=folder)
            if code != 2 or errors.count(sentence) != 1 or (folder / "results").exists():
                fail(name, f"exit code {code}, no '{sentence}' in\n{out}{errors}")
    (folder / "empty.prm").write_text("")
    code, out, errors = call(program, "empty.prm", settings=[], cwd=folder)
    if code != 2 or "no particles come into the run" not in errors:
        fail("an empty file", f"exit code {code}\n{out}{errors}")


def check_processes(program: ManyRuns, folder: Path) -> None:
    for name, file, settings, sentence, number in PROCESSES:
        code, out, errors = call(program, ROOT / file, "--check", settings=settings, cwd=folder)
        if code != 0 or sentence not in out or out.splitlines()[-1] != last_line(number):
            fail(name, f"exit code {code}, no '{sentence}' in\n{out}{errors}")


def main(many_runs: str, folder: Path) -> int:
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    program = ManyRuns(many_runs, folder / "printed")
    (folder / "case.prm").write_text(BASE)
    (folder / "three.csv").write_text(THREE)
    check_doubtful(program, folder)
    check_facts(program, folder)
    check_refused(program, folder)
    check_processes(program, folder)
    # Without the entry for gravity nothing falls; if that is intended, the entry must say so.
    (folder / "floating.prm").write_text(BASE.replace("  set g = 0, 0, -9.81\n", ""))
    _, out, _ = call(program, "floating.prm", "--check", settings=[], cwd=folder)
    if len(warnings(out)) != 1 or "entry 'g' (left at its default) is zero" not in out:
        fail("no gravity", out)
    _, out, _ = call(program, "floating.prm", "--check", cwd=folder,
                     settings=["lagrangian physical properties/g = 0, 0, 0"])
    if warnings(out):
        fail("no gravity, and it is meant", out)
    program.close()
    print(f"{len(DOUBTFUL)} doubtful, {len(REFUSED)} refused cases")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], Path(sys.argv[2])))
