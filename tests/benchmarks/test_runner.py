"""The runner of the benchmarks: medians, ratios and tables from known numbers, the decks' input, and,
with the path of the program, runs of a few steps with the programs that are installed.

Usage: test_runner.py [path/to/eunoe-particles]
"""

import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

try:
    import numpy as np
except ImportError:
    print("skipped: numpy is missing")
    sys.exit(77)

from eunoe.benchmarks import bed, blade, kernel_cycles, slot, slot_rate, table
from eunoe.benchmarks.programs import CASES, Lammps, Liggghts, Peer, loop_seconds
from eunoe.launch import Failure
from eunoe.tables import as_markdown, as_text

CONTRIB = Path(__file__).resolve().parents[2] / "contrib"

PROGRAM = sys.argv.pop() if len(sys.argv) > 1 else None
LOG = """Step Atoms KinEng
       0    20000            0
Loop time of 9.5 on 1 procs for 10 steps with 20000 atoms
Loop time of 2.5 on 2 procs for 100 steps with 20000 atoms
Pair    | 1.2
"""
SUMMARY = {"loop_seconds": 10., "seconds_integration": 1., "seconds_contact_search": 0.5,
           "seconds_ghosts": 0.25, "seconds_particle_contacts": 7., "seconds_solid_contacts": 0.75,
           "seconds_loads": 0.1, "seconds_output": 0., "seconds_process": 0.2,
           "seconds_particle_contacts_slowest_rank": 8.4}


class Tables(unittest.TestCase):
    row = table.Row("bed", 2, {"Eunoe": [9e6, 12e6, 10e6], "LAMMPS": [3e6, 2e6, 2.5e6],
                               "LIGGGHTS": [4e6, 3.5e6, 9e6]})

    def test_the_ratio_is_of_medians_to_the_faster_peer(self):
        self.assertAlmostEqual(self.row.ratio(), 10. / 4.)

    def test_no_ratio_without_a_peer(self):
        self.assertIsNone(table.Row("bed", 1, {"Eunoe": [1e6]}).ratio())

    def test_cells(self):
        cells = table.cells([self.row], ["Eunoe", "LAMMPS", "LIGGGHTS"])
        self.assertEqual(cells[1], ["bed", "2", "10.00 (9.00 to 12.00)", "2.50 (2.00 to 3.00)",
                                    "4.00 (3.50 to 9.00)", "2.50"])
        self.assertEqual(as_markdown(cells[:1]).splitlines()[1], "|---|---|---|---|---|---|")
        self.assertEqual(len(as_text(cells).splitlines()), 2)

    def test_a_missing_peer_has_a_column_that_says_so(self):
        row = table.Row("bed", 1, {"Eunoe": [9e6], "LAMMPS": [3e6]})
        cells = table.cells([row], ["Eunoe", "LAMMPS"], ["LIGGGHTS"])
        self.assertEqual(cells[0], ["case", "ranks", "Eunoe", "LAMMPS", "LIGGGHTS", "ratio"])
        self.assertEqual(cells[1][4:], ["MISSING", "3.00"])

    def test_shares_add_up(self):
        shares = table.shares(SUMMARY)
        self.assertAlmostEqual(sum(shares.values()), 1.)
        self.assertAlmostEqual(shares["contact_search"], 0.05)
        self.assertAlmostEqual(shares["other"], 0.02)
        cells = table.share_cells([("bed", 2, [SUMMARY])])
        self.assertEqual(cells[1][-2:], ["2.0 %", "1.20"])


class Logs(unittest.TestCase):
    def test_the_last_loop_counts(self):
        self.assertEqual(loop_seconds(LOG, "LAMMPS"), 2.5)

    def test_speed_from_a_log(self):
        class Canned(Peer):
            name = "Canned"

            def start(self, case, particles, ranks, variables, folder):
                return LOG

        run = Canned().run(CASES["bed_20k"], 1, 100, Path("."))
        self.assertAlmostEqual(run.speed, 20000 * 100 / 2.5)

    def test_a_log_without_a_loop_is_refused(self):
        with self.assertRaises(Failure):
            loop_seconds("ERROR: Lost atoms", "LAMMPS")


class Kernels(unittest.TestCase):
    LOOP = [(0, "vmovapd (%rdi),%zmm0"), (4, "vdivpd %zmm1,%zmm0,%zmm2"), (8, "jne 4 <kernel+0x4>"), (12, "ret")]

    def test_instructions_are_read(self):
        text = "kernel():\n    10:\tvmulpd 0x8(%rip),%zmm0,%zmm0        # 20 <x>\n    16:\tret\n"
        self.assertEqual(kernel_cycles.instructions(text), [(16, "vmulpd 0x8(%rip),%zmm0,%zmm0"), (22, "ret")])

    def test_the_loop_with_the_divisions_counts(self):
        lines, contacts = kernel_cycles.hot_part(self.LOOP)
        self.assertEqual(lines, ["vdivpd %zmm1,%zmm0,%zmm2", "jne 4 <kernel+0x4>"])
        self.assertEqual(contacts, 8)
        self.assertEqual(kernel_cycles.readable(lines), "vdivpd %zmm1,%zmm0,%zmm2\nnop\n")

    def test_without_a_loop_a_block_is_unrolled(self):
        straight = [self.LOOP[0], self.LOOP[1], self.LOOP[3]]
        self.assertEqual(kernel_cycles.hot_part(straight), ([text for _, text in straight], 32))

    def test_a_missing_analyser_is_named(self):
        with self.assertRaisesRegex(Failure, "There is no program 'llvm-mca-0'"):
            kernel_cycles.cycles("llvm-mca-0", "znver4", "nop")


class Bed(unittest.TestCase):
    def test_copies_lie_behind_each_other_and_do_not_overlap(self):
        two = bed.read(2)
        self.assertEqual(two.shape, (40000, 4))
        np.testing.assert_allclose(two[20000:, 3] - two[:20000, 3], bed.PERIOD)
        # The seam is that of the period, so particles overlap by no more than at rest.
        near = two[(two[:, 3] > 0.9e-3) & (two[:, 3] < 1.1e-3) & (two[:, 1] < 0.5e-3)]
        distance = np.linalg.norm(near[:, None, 1:] - near[None, :, 1:], axis=2)
        overlap = 0.5 * (near[:, None, 0] + near[None, :, 0]) - distance
        np.fill_diagonal(overlap, 0.)
        self.assertLess(overlap.max(), 0.5e-6)

    def test_seeds_differ_by_little(self):
        column = bed.narrow(bed.read(), 1e-3)
        self.assertLess((column[:, 1] + 0.5 * column[:, 0]).max(), 1e-3)
        self.assertIs(bed.jittered(column, 0), column)
        moved = bed.jittered(column, 1) - column
        self.assertTrue(0. < np.abs(moved).max() <= 1e-8 and not moved[:, 0].any())

    def test_data_files(self):
        particles = bed.read()[:2]
        with tempfile.TemporaryDirectory() as folder:
            bed.write_for_peer(Path(folder) / "data", particles, (4e-3, 6e-3, 1e-3), 4386., "Atoms")
            lines = (Path(folder) / "data").read_text().splitlines()
            bed.write_for_eunoe(Path(folder) / "csv", particles)
            table_lines = (Path(folder) / "csv").read_text().splitlines()
        self.assertIn("2 atoms", lines)
        last = [float(word) for word in lines[-1].split()]
        np.testing.assert_allclose(last, [2, 1, particles[1, 0], 4386., *particles[1, 1:]])
        self.assertEqual(table_lines[0], "p_x; p_y; p_z; diameters")
        self.assertEqual(len(table_lines), 3)

    def test_the_blade_is_a_half_round(self):
        corners = blade.triangles(1e-3).reshape(-1, 3)
        distance = np.hypot(corners[:, 0] - blade.TIP_X, corners[:, 1] - blade.TIP_Y - blade.RADIUS)
        np.testing.assert_allclose(distance, blade.RADIUS)
        self.assertAlmostEqual(corners[:, 1].min(), blade.TIP_Y)
        self.assertEqual(len(corners), 3 * 2 * blade.FACETS)


class TheSlot(unittest.TestCase):
    particles = CASES["slot"].particles()

    def test_the_bed_stands_on_its_floor_and_is_at_rest(self):
        self.assertEqual(self.particles.shape, (50000, 4))
        radius, (x, y, z) = 0.5 * self.particles[:, 0], self.particles[:, 1:].T
        deepest = max(float((radius - x).max()), float((x + radius).max()) - slot.LENGTH,
                      float((radius - y).max()) + slot.FLOOR)
        # At the bottom of 0.3 m of grains that are so soft.
        self.assertLess(deepest, 0.4e-3)
        self.assertTrue((0. <= z).all() and (z < CASES["slot"].box[2] + 1e-6).all())
        self.assertLess((y + radius).max(), slot.HEIGHT)

    def test_copies_fit_together(self):
        near = self.particles[(abs(self.particles[:, 3] - slot.PERIOD) < 0.01) & (self.particles[:, 1] < 0.1)]
        distance = np.linalg.norm(near[:, None, 1:] - near[None, :, 1:], axis=2)
        overlap = 0.5 * (near[:, None, 0] + near[None, :, 0]) - distance
        np.fill_diagonal(overlap, 0.)
        self.assertLess(overlap.max(), 0.4e-3)

    def test_the_floor_is_that_of_the_input(self):
        corners = slot.triangles(CASES["slot"].box[2]).reshape(-1, 3)
        text = (CONTRIB.parent / "prm" / "benchmarks" / "slot.prm").read_text()
        boxes = [[[float(word) for word in point.split(",")] for point in line.split("=")[1].split(":")]
                 for line in text.splitlines() if "grid arguments" in line and "true" not in line]
        self.assertEqual([boxes[0][1][0], boxes[1][0][0]], [slot.LEFT, slot.RIGHT])
        for lower, upper in boxes:
            self.assertEqual((lower[1], upper[1]), (slot.LIP, slot.FLOOR))
        self.assertEqual(set(corners[:, 0]), {0., slot.LEFT, slot.RIGHT, slot.LENGTH})
        self.assertEqual(set(corners[:, 1]), {slot.LIP, slot.FLOOR})

    def test_a_rate_is_that_of_the_second_half(self):
        self.assertAlmostEqual(slot_rate.rate(np.arange(5.), np.array([0., 0., 1., 3., 5.])), 2.)

    def test_what_has_left_is_weighed(self):
        mass = slot_rate.mass_out(np.array([[0., slot.LIP - 1e-3, 0.], [0., slot.LIP + 1e-3, 0.]]),
                                  np.array([0.01, 0.01]))
        self.assertAlmostEqual(mass, 2400. * np.pi / 6. * 1e-6)


@unittest.skipIf(PROGRAM is None, "no program is given")
class Runs(unittest.TestCase):
    def run_it(self, *arguments, **changes):
        environment = {**os.environ, **changes}
        return subprocess.run([sys.executable, "-B", str(CONTRIB / "tools"), "benchmark", "--program", PROGRAM,
                               *arguments], capture_output=True, text=True, check=False,
                              env=environment)

    def test_a_few_steps_of_all_that_are_installed(self):
        with tempfile.TemporaryDirectory() as folder:
            results = Path(folder) / "results.json"
            page = Path(folder) / "results.md"
            done = self.run_it("--cases", "bed_20k,collapse,plough,soft_column,slot", "--ranks", "1", "--repeats",
                               "1", "--steps", "3", "--shares", "--json", str(results),
                               "--markdown", str(page))
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            data = json.loads(results.read_text())
            self.assertIn("| case | ranks | Eunoe |", page.read_text())
            self.assertEqual("NOT COMPARED" in page.read_text(), bool(data["missing_peers"]))
        installed = {peer.name for peer in (Lammps(), Liggghts()) if peer.path}
        self.assertEqual(len(data["speeds"]), 5)
        for row in data["speeds"]:
            self.assertEqual(set(row["speeds"]), installed | {"Eunoe"})
            self.assertEqual(row["ratio"] is None, not installed)
            self.assertTrue(all(speed > 0. for values in row["speeds"].values() for speed in values))
        self.assertEqual(data["summaries"][0]["runs"][0]["particles"], 20000)
        self.assertEqual(data["summaries"][0]["runs"][0]["steps"], 3)

    def test_missing_peers_are_told_everywhere(self):
        with tempfile.TemporaryDirectory() as folder:
            results, page = Path(folder) / "results.json", Path(folder) / "results.md"
            done = self.run_it("--cases", "bed_20k", "--ranks", "1", "--repeats", "1", "--steps", "1",
                               "--json", str(results), "--markdown", str(page),
                               # Keeps Open MPI from looking for its daemon in that folder.
                               PATH=folder, OMPI_MCA_ess_singleton_isolated="1")
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            data, text = json.loads(results.read_text()), page.read_text()
        self.assertEqual(data["missing_peers"], ["LAMMPS", "LIGGGHTS"])
        self.assertEqual(data["machine"]["LAMMPS"], "MISSING")
        for said in (done.stderr, text):
            self.assertIn("NOT COMPARED with LAMMPS (no program 'lmp') and LIGGGHTS", said)
            self.assertIn("contrib/install_dependencies.sh benchmarks", said)
        self.assertIn("| MISSING | MISSING | - |", text)

    def test_what_the_installer_does_not_know_is_refused(self):
        done = subprocess.run([CONTRIB / "install_dependencies.sh", "benchmark"],
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 2)
        self.assertIn("'benchmarks'", done.stderr)

    def test_bad_arguments_are_answered_with_a_sentence(self):
        for arguments, what in ((["--cases", "bedd"], "There is no case 'bedd'."),
                                (["--ranks", "0"], "give whole numbers above 0"),
                                (["--program", "nowhere"], "is not a program")):
            done = self.run_it(*arguments)
            self.assertEqual(done.returncode, 1)
            self.assertIn(what, done.stderr)
            self.assertNotIn("Traceback", done.stderr)


if __name__ == "__main__":
    unittest.main()
