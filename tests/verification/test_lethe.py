"""contrib/tools lethe: what it measures in heaps, drums and tests of Lethe, on points whose answer is known, and what it
says of inputs that run, stop or are refused, with a program that takes no time.

Usage: test_lethe.py
"""

from __future__ import annotations

import contextlib
import importlib.util
import io
import math
import sys
import tempfile
import unittest
from pathlib import Path

if any(importlib.util.find_spec(name) is None for name in ("numpy", "vtkmodules")):
    print("skipped: numpy or VTK is missing")
    sys.exit(77)
import numpy as np

from eunoe import commands
from eunoe.lethe import examples, last_states
from eunoe.launch import Failure

PROGRAM = """#!/bin/sh
case "$*" in
  *bad.prm*--check* | *--check*bad.prm*) echo "Warning: never mind" >&2; echo "bad.prm: no such entry" >&2; exit 2 ;;
  *--check*) exit 0 ;;
  *late.prm*) echo "a particle was lost" >&2; exit 1 ;;
esac
grep -q "speed = 3" "$2" || exit 4
mkdir results_good && echo '{"particles": 7, "lost_particles": 2}' > results_good/summary.json
"""
PRINTED = """something else
id, type, dp, x, y, z
 1 0 0.0100 0.0000 0.0200 0.0000
 0 0 0.0100 0.0000 0.0000 0.0000
end
"""


def wedge(angle: float, half: float = 0.4, diameter: float = 0.01) -> np.ndarray:
    """Centres on a lattice below two slopes that fall from x = 0 to either side."""
    steps = np.arange(-half, half, 0.25 * diameter)
    x, y = (grid.ravel() for grid in np.meshgrid(steps, np.arange(0., half, 0.05 * diameter)))
    below = y < math.tan(math.radians(angle)) * (half - np.abs(x))
    return np.stack([x, y, 0. * x], axis=1)[below]


class Measures(unittest.TestCase):
    def test_slope_of_a_heap(self) -> None:
        for angle in (15., 30.):
            self.assertAlmostEqual(examples.slope_of_highest(wedge(angle), 0.15, 0.35, 0.01), angle, delta=0.3)
        with self.assertRaises(Failure):
            examples.slope_of_highest(wedge(15.)[:1], 0.15, 0.35, 0.01)

    def test_slope_of_a_bed_in_the_drum(self) -> None:
        z, y = (grid.ravel() for grid in np.meshgrid(np.arange(-0.024, 0.024, 5e-4), np.arange(-0.03, 0.03, 5e-4)))
        bed = np.stack([0. * z, y, z], axis=1)[y < math.tan(math.radians(25.)) * z]
        self.assertAlmostEqual(examples.surface_slope(bed), 25., delta=1.5)

    def test_height_of_a_deposit(self) -> None:
        y, z = (grid.ravel() for grid in np.meshgrid(np.arange(0.005, 0.2, 0.01), np.arange(0.005, 0.1, 0.01)))
        points = np.stack([0.4 + 0. * y, y, z], axis=1)
        self.assertAlmostEqual(examples.height_at(points, 0.4), 0.2)
        self.assertEqual(examples.height_at(points, 0.8), 0.)

    def test_mixing_index(self) -> None:
        points = np.random.default_rng(3).uniform(size=(3000, 3))
        apart = points[:, 0] < 0.5
        mixed = np.random.default_rng(4).uniform(size=len(points)) < 0.5
        self.assertAlmostEqual(examples.mixing_index(points, mixed), 1., delta=0.05)
        far = points + np.where(apart, 0., 9.)[:, None]
        self.assertEqual(examples.mixing_index(far, apart), 0.)

    def test_spring_of_the_linear_law(self) -> None:
        # k = 16/15 sqrt(R) E (15 m v^2 / (16 sqrt(R) E))^(1/5) at 1 m/s, with the wall's compliance in E.
        young = examples.young_of_spring(5e5)
        effective = 1. / (0.91 / young + 0.91 / 1e12)
        mass, root = 2600. * 4. / 3. * math.pi * 0.1**3, math.sqrt(0.1)
        stiffness = 16. / 15. * root * effective * (15. * mass / (16. * root * effective))**0.2
        self.assertAlmostEqual(stiffness / 5e5, 1., places=12)


class LastStates(unittest.TestCase):
    def test_particles_that_lethe_prints(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "case.prm").touch()
            (Path(folder) / "case.mpirun=1.output").write_text(PRINTED)
            (Path(folder) / "case_other.output").write_text(PRINTED.replace("0.0200", "0.0900"))
            found = last_states.published(Path(folder) / "case.prm")
        self.assertEqual(found, [(0.01, (0., 0., 0.)), (0.01, (0., 0.02, 0.))])

    def test_distances(self) -> None:
        theirs = [(0.01, (0., 0., 0.)), (0.01, (0., 0.02, 0.))]
        for moved, said in ((4e-5, "2 particles, in all digits"), (1e-3, "by number: median 0.1, largest 0.1 diam")):
            mine = [(d, (x + moved, y, z)) for d, (x, y, z) in theirs]
            self.assertIn(said, last_states.compared(theirs, mine))
        self.assertIn("to the nearest: median 0, largest 0", last_states.compared(theirs, theirs[::-1]))
        self.assertEqual(last_states.compared(theirs, theirs[:1]), "1 particles instead of 2")


class Runs(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        self.program = self.folder / "program"
        self.program.write_text(PROGRAM)
        self.program.chmod(0o755)

    def test_first_steps(self) -> None:
        inputs = self.folder / "lethe" / "some"
        inputs.mkdir(parents=True)
        for name in ("good", "bad", "late"):
            (inputs / f"{name}.prm").write_text("set speed = 3\n")
        with contextlib.redirect_stdout(io.StringIO()) as output:
            code = commands.run("lethe", [str(self.program), str(self.folder / "lethe"), str(self.folder / "runs"),
                                          "--first-steps", "10"])
        self.assertEqual(code, 0)
        for line in ("some/bad.prm: refused: bad.prm: no such entry", "some/late.prm: stops: a particle was lost",
                     "some/good.prm: runs: 7 particles, 2 lost"):
            self.assertIn(line, output.getvalue().splitlines())
        self.assertIn("| some/late.prm | stops |", (self.folder / "runs" / "lethe.md").read_text())
        self.assertEqual(sorted(file.name for file in inputs.iterdir()), ["bad.prm", "good.prm", "late.prm"])

    def test_input_of_a_template(self) -> None:
        (self.folder / "case.tpl").write_text("set speed = {{v}}\nset other = {{w}}\n")
        example = examples.Example("", ("case.tpl",), lambda _: [], template={"v": "3", "w": "0.5"})
        from eunoe.lethe import run
        self.assertEqual(run.input_of(example, "case.tpl", self.folder).read_text(), "set speed = 3\nset other = 0.5\n")


if __name__ == "__main__":
    unittest.main()
