"""The prediction of scaling: order of the mesh cells, cuts, ghosts and costs, against results found
by hand.

Usage: test_scaling.py
"""

import subprocess
import sys
import unittest
from dataclasses import replace
from itertools import product
from pathlib import Path
from unittest.mock import patch

try:
    import numpy as np
except ImportError:
    print("skipped: numpy is missing")
    sys.exit(77)

CONTRIB = Path(__file__).resolve().parents[2] / "contrib"
BED = CONTRIB / "benchmarks" / "settled_bed.csv.gz"
from eunoe.launch import Failure
from eunoe.scaling import ghosts
from eunoe.scaling.apparatus import apparatus, mesh_of, powder, sizes
from eunoe.scaling.cost import GHOST_BYTES, Costs, message_seconds, predict
from eunoe.scaling.ghosts import Filling, reach_of
from eunoe.scaling.mesh import Mesh
from eunoe.scaling.partition import cut, divide, families, leaves, most_particles


def box(trees, refinement=0, periodic=(False, False, False)):
    cells = [n << refinement for n in trees]
    return Mesh(tuple(trees), (0., 0., 0.), tuple(float(n) for n in cells), refinement, periodic)


def filled(mesh, counts):
    """So many particles in the middle of each mesh cell, each within reach of all cells around."""
    index = np.argwhere(np.ones(mesh.cells, bool))
    points = np.array(mesh.lower) + (index + 0.5) * mesh.width
    return Filling(mesh, np.repeat(points, counts.ravel(), axis=0), np.inf)


class Order(unittest.TestCase):
    def test_z_order_within_a_tree(self):
        curve = box((1, 1, 1), 1).curve()
        cells = [tuple(int(v) for v in np.unravel_index(c, (2, 2, 2))) for c in curve]
        self.assertEqual(cells, [(x, y, z) for z, y, x in product((0, 1), repeat=3)])

    def test_the_curve_visits_every_cell_once_and_trees_as_wholes(self):
        mesh = box((5, 3, 2), 2)
        curve = mesh.curve()
        self.assertEqual(sorted(curve), list(range(30 * 64)))
        trees = np.array(np.unravel_index(curve, mesh.cells)).T >> 2
        for k in range(30):
            self.assertEqual(len(np.unique(trees[64 * k:64 * (k + 1)], axis=0)), 1)

    def test_a_row_of_trees_is_followed_from_its_end(self):
        place = box((9, 1, 1)).tree_order()[:, 0, 0]
        np.testing.assert_array_equal(place, np.arange(9))

    def test_too_many_trees_are_refused(self):
        with self.assertRaises(Failure):
            box((1000, 100, 1)).tree_order()


class Cuts(unittest.TestCase):
    def test_even_weights(self):
        self.assertEqual(cut(np.ones(12, int), 4).tolist(), [0, 3, 6, 9, 12])

    def test_a_cut_within_a_cell_moves_to_its_end(self):
        # Half of 14 is reached within the third cell.
        self.assertEqual(cut(np.array([3, 3, 5, 3]), 2).tolist(), [0, 3, 4])

    def test_families_stay_together(self):
        starts = cut(np.ones(32, int), 3, np.repeat([0, 8, 16, 24], 8))
        self.assertEqual(starts.tolist(), [0, 8, 24, 32])

    def test_cells_are_fine_where_particles_are(self):
        # Two trees of 4 x 4 x 4 lattice cells. In the first, all 30 particles are in one of them,
        # so that its parent and that one's parent are refined; the other tree stays one cell.
        counts = np.zeros(128, int)
        counts[3], counts[100] = 30, 24
        starts, levels = leaves(counts, 2, 24)
        self.assertEqual(starts.tolist(), [*range(8), *range(8, 64, 8), 64])
        self.assertEqual(levels.tolist(), [0] * 8 + [1] * 7 + [2])
        # Only the eight lattice cells are a whole family.
        self.assertEqual(families(starts, levels, 2).tolist(), [0] * 8 + list(range(8, 16)))

    def test_more_ranks_than_cells(self):
        starts = cut(np.ones(3, int), 5)
        self.assertEqual((starts[0], starts[-1]), (0, 3))
        self.assertTrue((np.diff(starts) >= 0).all())


class Ghosts(unittest.TestCase):
    def test_a_row_of_cells(self):
        # 6 cells with 1 ... 6 particles, 21 in all; cells have no weight, so the cuts are after 7
        # and 14 particles and move to the ends of their cells.
        mesh, counts = box((6, 1, 1)), np.arange(1, 7).reshape(6, 1, 1)
        part = divide(mesh, filled(mesh, counts), mesh.curve(), 3, cell_weight=0, particle_weight=1)
        self.assertEqual(part.owned.tolist(), [10, 5, 6])
        self.assertEqual(part.ghosts.tolist(), [5, 4 + 6, 5])
        self.assertEqual(part.sent.tolist(), [4, 5 + 5, 6])
        self.assertEqual(part.neighbours.tolist(), [1, 2, 1])
        self.assertAlmostEqual(part.imbalance, 10. / 7. - 1.)
        self.assertAlmostEqual(part.ghost_fraction, 20. / 21.)

    def test_a_period_makes_the_ends_neighbours(self):
        mesh = box((6, 1, 1), periodic=(True, False, False))
        part = divide(mesh, filled(mesh, np.ones((6, 1, 1), int)), mesh.curve(), 3)
        self.assertEqual(part.ghosts.tolist(), [2, 2, 2])
        self.assertEqual(part.neighbours.tolist(), [2, 2, 2])

    def test_only_cells_within_reach_count(self):
        # Two cells, one for each rank, and a period in z, where each cell is its own neighbour.
        # With a reach of 0.25 a particle 0.7 from the face is no ghost, one 0.25 from it just is
        # one, on either side.
        mesh = box((2, 1, 1), periodic=(False, False, True))
        x = [0.3, 0.75, 0.8, 1.25, 1.5, 1.9]
        points = np.array([[v, 0.5, 0.5] for v in x])
        part = divide(mesh, Filling(mesh, points, 0.25), mesh.curve(), 2)
        self.assertEqual(part.owned.tolist(), [3, 3])
        self.assertEqual(part.messages.tolist(), [[0, 1, 2], [1, 0, 1]])

    def test_each_particle_has_its_own_reach(self):
        mesh = box((2, 1, 1))
        points = np.array([[0.5, 0.5, 0.5], [0.75, 0.5, 0.5], [1.25, 0.5, 0.5], [1.75, 0.5, 0.5]])
        part = divide(mesh, Filling(mesh, points, np.array([0.5, 0.2, 0.2, 0.8])), mesh.curve(), 2)
        self.assertEqual(part.messages.tolist(), [[0, 1, 1], [1, 0, 1]])

    def test_a_corner_is_as_far_as_its_diagonal(self):
        # Four ranks around an edge at (1, 1), with particles on the diagonal: 0.2 and 0.3 from both
        # faces are 0.283 and 0.424 from the edge, so with 0.35 only the first goes to all three.
        mesh = box((2, 2, 1))
        points = np.array([[1. + s * u, 1. + t * u, 0.5] for s in (-1., 1.) for t in (-1., 1.)
                           for u in (0.3, 0.2)])
        part = divide(mesh, Filling(mesh, points, 0.35), mesh.curve(), 4)
        self.assertEqual(part.owned.tolist(), [2, 2, 2, 2])
        self.assertEqual(part.sent.tolist(), [5, 5, 5, 5])
        self.assertEqual(int(part.ghosts.sum()), 20)

    def test_a_receiver_in_many_cells_has_a_particle_once(self):
        # The other rank owns nine cells around the particle.
        mesh = box((2, 3, 3))
        points = np.array([[0.9, 1.5, 1.5], [1.1, 1.5, 1.5]])
        filling = Filling(mesh, points, 5.)
        owner = np.zeros(mesh.cells, np.int32)
        owner[1] = 1
        self.assertEqual(ghosts.messages(mesh, filling, owner, 2).tolist(), [[0, 1, 1], [1, 0, 1]])

    def test_the_reach_of_the_program(self):
        # Both radii, a tenth of the largest diameter, and the range; 0.1 per thousand on top.
        np.testing.assert_allclose(reach_of(np.array([1., 2.]), 0.1, 0.05) / 1.0001,
                                   [0.5 + 1. + 0.25, 1. + 1. + 0.25])

    def test_against_the_definition(self):
        mesh, n_ranks = box((3, 2, 1), 2, (False, False, True)), 7
        random = np.random.default_rng(3)
        points = random.uniform(0., 1., (400, 3)) * np.array(mesh.upper)
        for reach in (np.full(400, np.inf), random.uniform(0.1, 1., 400)):
            for chunk in (ghosts.CHUNK, 30):
                with patch.object(ghosts, "CHUNK", chunk):
                    filling = Filling(mesh, points, reach)
                    part = divide(mesh, filling, mesh.curve(), n_ranks)
                expected = self.by_definition(mesh, points, reach, n_ranks)
                np.testing.assert_array_equal(part.ghosts, expected)
                self.assertEqual(int(part.owned.sum()), 400)

    @staticmethod
    def by_definition(mesh, points, reach, n_ranks):
        """Ghosts of each rank, from the cells around each particle one by one."""
        cells = np.floor(points).astype(int)
        counts = np.zeros(mesh.cells, int)
        np.add.at(counts, tuple(cells.T), 1)
        curve = mesh.curve()
        along = counts.ravel()[curve]
        begins, levels = leaves(along, mesh.refinement, most_particles(400, n_ranks))
        ends = [*begins[1:], len(along)]
        weights = np.array([20 + 2000 * along[b:e].sum() for b, e in zip(begins, ends)])
        starts = cut(weights, n_ranks, families(begins, levels, mesh.refinement))
        owner = np.empty(counts.size, int)
        for rank in range(n_ranks):
            for leaf in range(starts[rank], starts[rank + 1]):
                owner[curve[begins[leaf]:ends[leaf]]] = rank
        owner = owner.reshape(mesh.cells)
        result = np.zeros(n_ranks, int)
        for point, cell, limit in zip(points, cells, reach):
            receivers = set()
            for step in product((-1, 0, 1), repeat=3):
                x, y, z = near = [c + s for c, s in zip(cell, step)]
                away = [max(low - v, 0., v - low - 1.) for low, v in zip(near, point)]
                if 0 <= x < mesh.cells[0] and 0 <= y < mesh.cells[1] \
                        and np.linalg.norm(away) <= limit:
                    receivers.add(owner[x, y, z % mesh.cells[2]])
            for rank in receivers - {owner[tuple(cell)]}:
                result[rank] += 1
        return result

    def test_particles_are_counted_in_their_cells(self):
        counts = Filling(box((2, 2, 2)), np.array([[0.5, 0.5, 0.5], [1.5, 0.5, 0.5],
                                                   [1.9, 0.1, 0.1]]), 0.).counts
        self.assertEqual((counts[0, 0, 0], counts[1, 0, 0], counts.sum()), (1, 2, 3))


class SettledBed(unittest.TestCase):
    """Ghosts that the program counted (`ghosts` of summary.json) with a cell weight of 1000, where
    all particles cost the same."""

    def test_ghosts_of_the_benchmark(self):
        table = np.loadtxt(BED, delimiter=",", skiprows=1) * 1e-6
        # DMT is cut off at a tenth of the pull-off force: Hamaker's constant 4e-19 J, 2 x 0.35 mJ/m2.
        reach = reach_of(table[:, 0], 0.1, (4e-19 / 6. / (2. * np.pi * 7e-4) / 0.1) ** 0.5)
        mesh = Mesh.over((0., 0., 0.), (4e-3, 6e-3, 1e-3), (False, False, True),
                         reach.max() / 1.0001)
        filling, curve = Filling(mesh, table[:, 1:], reach), mesh.curve()
        counted = [int(divide(mesh, filling, curve, n, 1000).ghosts.sum()) for n in (2, 4)]
        self.assertEqual(counted[0], 1181)
        # One cut falls a cell beside the program's.
        self.assertAlmostEqual(counted[1] / 6819., 1., delta=0.015)


class Cost(unittest.TestCase):
    def setUp(self):
        self.mesh = box((6, 1, 1))
        self.counts = np.full((6, 1, 1), 100)

    def part(self, n_ranks):
        return divide(self.mesh, filled(self.mesh, self.counts), self.mesh.curve(), n_ranks)

    def test_one_rank_is_the_measure(self):
        costs = Costs(speeds=((1., 1e6),))
        one = predict(self.part(1), 6, costs)
        self.assertAlmostEqual(one.efficiency, 1.)
        self.assertAlmostEqual(one.seconds, 600e-6 * (1. + costs.search / costs.interval))

    def test_two_ranks_without_a_network_pay_for_ghosts_alone(self):
        costs = Costs(speeds=((1., 1e6),), ghost=0.3, search=0., latency=0., bandwidth=1e30,
                      copy=1e30)
        two = predict(self.part(2), 6, costs)
        self.assertAlmostEqual(two.seconds, (300. + 0.3 * 100.) * 1e-6)
        self.assertAlmostEqual(two.efficiency, 600. / 660.)

    def test_messages_on_a_node_and_between_nodes(self):
        part = self.part(2)
        inside = message_seconds(part, Costs(ranks_per_node=2, paired=0.5, latency=1., copy=1.,
                                            bandwidth=1e30))
        between = message_seconds(part, Costs(ranks_per_node=1, paired=0.5, latency=1., copy=1e30,
                                              bandwidth=2.))
        np.testing.assert_allclose(inside, 1. + 50. * GHOST_BYTES)
        np.testing.assert_allclose(between, 1. + 50. * GHOST_BYTES / 2.)

    def test_a_node_shares_its_memory(self):
        part = self.part(2)
        costs = Costs(speeds=((1., 1e30),), ghost=0.5, search=0., traffic=8., memory=2., cache=0.,
                      latency=0., copy=1e30, bandwidth=1e30)
        # Each rank has 300 particles and 100 ghosts.
        apart, together = (predict(part, 6, replace(costs, ranks_per_node=n)) for n in (1, 2))
        self.assertAlmostEqual(apart.seconds, 8. * 350. / 2.)
        self.assertAlmostEqual(together.seconds, 8. * 700. / 2.)
        self.assertEqual(predict(part, 6, replace(costs, cache=1e9)).parts["memory"], 0.)

    def test_speed_between_the_measured_sizes(self):
        costs = Costs(speeds=((1e4, 10e6), (1e6, 6e6)))
        speeds = 1. / costs.seconds_per_particle(np.array([1e3, 1e4, 1e5, 1e6, 1e7]))
        np.testing.assert_allclose(speeds, [10e6, 10e6, 8e6, 6e6, 6e6])


class Plate(unittest.TestCase):
    def test_the_powder_lies_in_the_mesh_and_grows_with_the_layers(self):
        place = apparatus(1. / 7., 2e-3)
        mesh = mesh_of(place)
        few, many = powder(place, 1), powder(place, 20)
        for points in (few, many):
            self.assertTrue((points >= np.array(mesh.lower)).all())
            self.assertTrue((points <= np.array(mesh.upper)).all())
        # 19 layers of 73/7 mm x 2 mm x 0.1 mm, 55 % full, of grains of 1.71e-13 m3 in the mean.
        self.assertAlmostEqual((len(many) - len(few)) / (19 * 73e-3 / 7. * 2e-3 * 1e-4 * 0.55
                                                         / self.mean_volume()), 1., delta=0.01)

    def test_sizes_have_the_paper_s_mean_volume(self):
        diameters = sizes(100000)
        self.assertAlmostEqual((np.pi / 6. * diameters**3).mean() / self.mean_volume(), 1.,
                               delta=0.01)

    @staticmethod
    def mean_volume():
        diameters = np.array([52.622, 57.7666, 63.4141, 69.6138, 76.4196, 83.8907, 92.0923,
                              101.096]) * 1e-6
        shares = np.array([0.146168, 0.168842, 0.168577, 0.152019, 0.129519, 0.105404, 0.078927,
                           0.050544])
        return shares.sum() / (shares / (np.pi / 6. * diameters**3)).sum()


class Tool(unittest.TestCase):
    def test_without_numpy_it_says_what_to_install(self):
        tool = CONTRIB / "tools"
        without_numpy = ("import runpy, sys; sys.modules['numpy'] = None; "
                         f"sys.argv = ['{tool}', 'predict-scaling', '--length-factor=1']; "
                         f"runpy.run_path('{tool}', run_name='__main__')")
        done = subprocess.run([sys.executable, "-B", "-c", without_numpy], capture_output=True, text=True,
                              check=False)
        self.assertEqual(done.returncode, 77)
        self.assertIn("has no numpy: install python3-numpy", done.stderr)


if __name__ == "__main__":
    unittest.main()
