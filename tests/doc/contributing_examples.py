"""The three additions that CONTRIBUTING.md shows, from its text: they are compiled with the commands of
this build, linked with the library, and run. Nothing else is compiled: each addition is one file.

- the law: in one step a sphere that overlaps a floor gets the velocity of Hertz's force less a
  share of 2 pi g_e R;
- the observable: the centre of mass of two spheres of unlike mass, one of which flies;
- the motion: positions and velocities of a solid of an input text (vibration_example.cc).

Usage: contributing_examples.py path/to/ninja path/to/build folder
Exit code 77, which skips the test, if the build does not use Ninja.
"""

import csv
import json
import math
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

from contributing import CENTRE_OF_MASS, shown_files

ROOT = Path(__file__).resolve().parents[2]

CASE = """
subsection simulation control
  set time step = 1e-9
  set time end = 1e-9
  set log frequency = 0
  set output path = {folder}/results
end
subsection floating walls
  set number of floating walls = 1
  subsection wall 0
    set point on wall = 0, 0, 0
    set normal vector = 0, 0, 1
    set end time = 1
  end
end
subsection lagrangian physical properties
  set g = 0, 0, 0
  set young modulus wall = 1e7
  set poisson ratio wall = 0.3
  set restitution coefficient wall = 1
  set surface energy wall = 0.05
  subsection particle type 0
    set diameter = 2e-3
    set density particles = 1000
    set young modulus particles = 1e7
    set poisson ratio particles = 0.3
    set restitution coefficient particles = 1
    set surface energy particles = 0.05
  end
end
subsection model parameters
  set particle particle contact force method = BRADLEY
  set particle wall contact force method = BRADLEY
  subsection rough adhesion
    set asperity height = 3e-9
    set least distance = 2e-9
  end
end
subsection insertion info
  set list x = 0, 4e-3
  set list y = 0, 1e-3
  set list z = 0.499e-3, 5e-3
  set list velocity x = 0, 300
end
subsection post-processing
  subsection final state
    set calculation = true
    set filename = state
  end
end
"""


class Page:
    """The files that CONTRIBUTING.md adds, each of which it shows as a whole after its name."""

    def __init__(self) -> None:
        self.files = shown_files()
        for name in self.files:
            assert not (ROOT / name).exists(), f"CONTRIBUTING.md adds {name}, which exists"

    def file_in(self, folder: str) -> str:
        return next(name for name in self.files if name.startswith(folder))


def write_tree(page: Page, tree: Path) -> None:
    """Writes the additions, and the program that evaluates the motion, into a separate tree."""
    files = {**page.files, "source/solids/vibration_example.cc":
             Path(__file__).with_name("vibration_example.cc").read_text(encoding="utf-8")}
    for name, content in files.items():
        path = tree / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(content, encoding="utf-8")


class Build:
    """Compiles and links as the build folder does."""

    def __init__(self, ninja: str, folder: Path, tree: Path) -> None:
        self.ninja, self.folder, self.tree = ninja, folder, tree
        self.commands = {entry["file"]: entry["command"] for entry in reversed(json.loads(
            self.ask("-t", "compdb")))}

    def ask(self, *arguments: str) -> str:
        return subprocess.run([self.ninja, "-C", str(self.folder), *arguments], check=True,
                              capture_output=True, text=True).stdout

    def compile(self, name: str, like: str) -> str:
        """Compiles a file of the tree with the options of another file."""
        words = shlex.split(self.commands[str(ROOT / like)])
        target = str(self.tree / (Path(name).name + ".o"))
        for option, value in (("-o", target), ("-MF", target + ".d"), ("-MT", target)):
            words[words.index(option) + 1] = value
        words[words.index(str(ROOT / like))] = str(self.tree / name)
        words.insert([word[0] for word in words].index("-"), f"-I{self.tree / 'include'}")
        subprocess.run(words, check=True, cwd=self.folder)
        return target

    def link(self, program: str, objects: list[str], with_main: bool) -> Path:
        """Links a program like eunoe-particles: its own objects come before those of the library."""
        line = [line for line in self.ask("-t", "commands", "eunoe-particles").splitlines()
                if "-o eunoe-particles" in line][-1]
        target = self.tree / program
        main = re.search(r"\S*main\.cc\.o", line).group()
        line = line.replace("-o eunoe-particles", f"-o {shlex.quote(str(target))}")
        line = line.replace(main, " ".join([main] * with_main + [shlex.quote(o) for o in objects]))
        subprocess.run(["sh", "-c", line], check=True, cwd=self.folder)
        return target


def close(what: str, value: float, reference: float, relative: float) -> None:
    print(f"{what}: {value:.12g}, reference {reference:.12g}")
    assert math.isclose(value, reference, rel_tol=relative), what


def check_case(program: Path, folder: Path) -> None:
    (folder / "case.prm").write_text(CENTRE_OF_MASS + CASE.format(folder=folder), encoding="utf-8")
    subprocess.run([program, folder / "case.prm", "--quiet"], check=True)
    radius, overlap, step = 0.5e-3, 1e-6, 1e-9
    young = 1e7 / (2. * (1. - 0.3**2))
    mass = 4. / 3. * math.pi * 1000. * radius**3
    # The work of adhesion of two equal bodies is twice their surface energy; asperities leave a
    # share of (2 nm / 5 nm)^2.
    force = 4. / 3. * young * math.sqrt(radius) * overlap**1.5 - 0.16 * 2. * math.pi * 0.1 * radius
    with open(folder / "results" / "state.csv", encoding="utf-8") as file:
        state = [[float(cell) for cell in line.strip(";\n").split(";")] for line in list(file)[1:]]
    close("velocity of the sphere on the floor", state[0][5], force / mass * step, 1e-6)
    with open(folder / "results" / "centre_of_mass.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["time"]) for row in rows] == [0., step], rows
    # The masses are as 1 to 8; the larger sphere flies 300 nm.
    for name, places in (("x", (0., 4e-3 + 300. * step)), ("y", (0., 1e-3)), ("z", (0.499e-3, 5e-3))):
        close(f"centre of mass, {name}", float(rows[1][name]), (places[0] + 8. * places[1]) / 9., 1e-12)


def main() -> int:
    ninja, build_folder, folder = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3])
    if not (build_folder / "build.ninja").exists():
        return 77
    shutil.rmtree(folder, ignore_errors=True)
    tree = folder / "tree"
    page = Page()
    write_tree(page, tree)
    build = Build(ninja, build_folder, tree)
    objects = [build.compile(page.file_in("source/contact/laws"), "source/contact/laws/dmt.cc"),
               build.compile(page.file_in("source/observables"), "source/observables/energies.cc")]
    check_case(build.link("eunoe-particles-with-additions", objects, True), folder)
    objects = [build.compile(name, "source/solids/motions/expression_motion.cc")
               for name in (page.file_in("source/solids/motions"), "source/solids/vibration_example.cc")]
    subprocess.run([build.link("vibration-example", objects, False)], check=True)
    print("ok")
    return 0


if __name__ == "__main__":
    sys.exit(main())
