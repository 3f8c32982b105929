"""Tests of maps, zones at rest, movies, and the page that compares runs; they need numpy, matplotlib and VTK."""

from __future__ import annotations

import contextlib
import importlib.util
import io
import re
import sys
import tempfile
import unittest
from dataclasses import fields, replace
from pathlib import Path
from types import SimpleNamespace
from unittest import mock

if any(importlib.util.find_spec(name) is None for name in ("numpy", "matplotlib", "vtkmodules")):
    print("skipped: numpy, matplotlib or VTK is missing")
    sys.exit(0)

import numpy as np

import sample_bed
import sample_run
from eunoe.intervals import common_scatter, difference_of, difference_within, mean_of
from eunoe.report import of_run
from eunoe.report.apparatus import Apparatus
from eunoe.report.bed_maps import maps_of, read_maps, read_table, write_table
from eunoe.report.comparison_charts import last_common_layer, profiles_figure
from eunoe.report.comparison_report import default_labels
from eunoe.report.common_scatter import CommonScatter
from eunoe.report.comparison_text import (densities_table, differences_table, measured_group, meeting_table,
                                          rise_sentence, supply_table)
from eunoe.report.layer_results import moved_over_plate
from eunoe.report.measured import Measured, read_measured
from eunoe.report.movie import Frame, moved_since, pass_of
from eunoe.report.run_folder import Layers, read_run
from eunoe.report.spread_run import Group, SpreadRun, difference, peak_of
from eunoe.report.static_zones import zones_of
from eunoe.vtk_files import Snapshot

APPARATUS = replace(sample_bed.APPARATUS, n_layers=9)


def maps(layers=range(9)):
    return maps_of(((layer, sample_bed.bed(layer)) for layer in layers), APPARATUS)


class Maps(unittest.TestCase):
    def test_all_solid_is_counted(self) -> None:
        found = maps([4])
        cell = np.outer(np.diff(found.x), np.diff(found.y)) * APPARATUS.depth
        bed = sample_bed.bed(4)
        np.testing.assert_allclose((found.fraction[0] * cell).sum(), np.pi / 6. * (bed["diameter"]**3).sum())

    def test_fraction_of_a_grid(self) -> None:
        # Two rows of grains fill the bins without a remainder.
        found = maps([4]).fraction[0]
        np.testing.assert_allclose(found[:, :5], sample_bed.FRACTION)
        self.assertEqual(found[:, 5:].max(), 0.)

    def test_a_bed_in_a_deep_first_layer_is_counted_to_its_top(self) -> None:
        height = APPARATUS.layer_thickness
        for changes in ({"first_thickness": 9. * height}, {"clearance": 12. * height}, {"plate_stroke": 2. * height}):
            deep = replace(APPARATUS, **changes)
            bed = sample_bed.bed(8)
            top = deep.clearance - 0.5 * bed["diameter"][0]  # below the spreader
            bed["points"] = np.full_like(bed["points"], 0.) + (0.5 * (deep.x_plate + deep.x_plate_end), top, 0.)
            found = maps_of([(8, bed)], deep)
            cell = np.outer(np.diff(found.x), np.diff(found.y)) * deep.depth
            np.testing.assert_allclose((found.fraction[0] * cell).sum(), np.pi / 6. * (bed["diameter"]**3).sum())

    def test_a_sphere_on_a_corner_belongs_to_four_cells(self) -> None:
        bed = {name: values[:1] for name, values in sample_bed.bed(0).items()}
        bed["points"] = np.array([[APPARATUS.x_plate + 0.3e-3, APPARATUS.plate_height(0) + 0.2e-3, 0.]])
        found = maps_of([(0, bed)], APPARATUS).fraction[0]
        quarter = np.pi / 6. * sample_bed.DIAMETER**3 / 4. / (0.1e-3**2 * APPARATUS.depth)
        np.testing.assert_allclose(found[2:4, 1:3], quarter, rtol=0.07)
        self.assertEqual(np.count_nonzero(found), 4)

    def test_what_is_not_on_the_plate_does_not_count(self) -> None:
        bed = sample_bed.bed(2)
        bed["on_plate"] = np.zeros_like(bed["on_plate"])
        self.assertEqual(maps_of([(2, bed)], APPARATUS).fraction.max(), 0.)

    def test_displacement_of_the_tracked(self) -> None:
        found = maps([4])
        self.assertEqual(found.tracked.sum(), 30 * 8 * 8)
        self.assertEqual(found.tracked[0, :, 4].sum(), 0.)  # the new layer
        np.testing.assert_allclose(found.moved[0, 5, :4], 50e-6)
        np.testing.assert_allclose(found.moved[0, 3, :4], 0.)
        np.testing.assert_allclose(found.moved_of_layers(), 50e-6 * 7 / 15)
        np.testing.assert_allclose(found.resting_of_layers(), 8 / 15)
        np.testing.assert_allclose(moved_over_plate(sample_bed.bed(4)).mean(), 50e-6 * 7 / 15 * 4 / 5)

    def test_density_of_a_layer_along_the_plate(self) -> None:
        found = maps([0, 1, 2, 4]).local_lrd()
        np.testing.assert_allclose(found[1:3], sample_bed.FRACTION)
        self.assertTrue(np.isnan(found[[0, 3]]).all())  # the layer before is not known

    def test_a_dense_place_is_spread_over_its_neighbours(self) -> None:
        found = maps(range(5))  # bins of 0.1 mm, so that means are over three layers and five bins
        dense = replace(found, fraction=found.fraction.copy())
        dense.fraction[2:, 7, 2] += 0.15  # in layer 2 and at one place
        change = dense.smoothed_lrd() - found.smoothed_lrd()
        np.testing.assert_allclose(change[1:4, 5:10], [[0.15 / 10.] * 5, [0.15 / 15.] * 5, [0.15 / 15.] * 5], atol=1e-12)
        np.testing.assert_allclose(change[1:4, [4, 10]], 0., atol=1e-12)
        np.testing.assert_allclose(change[4], 0., atol=1e-12)
        self.assertTrue(np.isnan(change[0]).all())

    def test_what_is_pressed_together_far_below(self) -> None:
        found = maps(range(8))
        np.testing.assert_allclose(found.compaction()[1:], 0., atol=1e-12)
        # The new layer of weighing 7 lies in row 7, or in row 8 where the plate has fallen by a layer before layer 0.
        for first_row in (0, 1):
            deep = replace(found, fraction=found.fraction.copy(), first_row=first_row)
            deep.fraction[7:, :, 2 + first_row] += 0.03  # five rows below
            deep.fraction[7:, :, 3 + first_row:] += 0.3
            np.testing.assert_allclose(deep.compaction()[[4, 7]], [0., 0.03], atol=1e-12)
        self.assertTrue(np.isnan(maps([0, 2]).compaction()[1]))

    def test_what_lies_above_the_level_of_the_plates(self) -> None:
        found = maps(range(8))
        for first_row in (0, 1):
            filling = replace(found, fraction=np.zeros_like(found.fraction), first_row=first_row)
            for k in range(8):  # a bed of 0.6, and under the spreader ever more until layer 5
                filling.fraction[k, :, :k + first_row] = 0.6
                filling.fraction[k, :, k + first_row] = 0.3 + 0.02 * min(k, 5)
            np.testing.assert_allclose(filling.above_level(), 0.3 + 0.02 * np.minimum(np.arange(8), 5))
            np.testing.assert_allclose(filling.crd_below(), [np.nan, np.nan, *[0.6] * 6])
        self.assertTrue(np.isnan(maps([0, 2]).crd_below()).all())  # layer 1 is not known

    def test_density_of_the_middle_half(self) -> None:
        beds = [sample_bed.bed(layer) for layer in range(3)]
        for bed in beds:  # the new layers of the first 0.4 mm, outside the middle half, are missing
            bed["on_plate"] = np.where((bed["points"][:, 0] < APPARATUS.x_plate + 0.4e-3) & (bed["layer"] > 0), 0., 1.)
        found = maps_of(enumerate(beds), APPARATUS)
        np.testing.assert_allclose(found.middle_lrd()[1:], sample_bed.FRACTION)
        self.assertLess(found.local_lrd()[1].mean(), 0.8 * sample_bed.FRACTION)

    def test_table(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            write_table(Path(folder) / "bed.csv", maps())
            again = read_table(Path(folder) / "bed.csv", APPARATUS)
        for name, tolerance in (("fraction", 5e-5), ("tracked", 0.), ("moved", 1e-8), ("resting", 5e-4)):
            np.testing.assert_allclose(getattr(again, name), getattr(maps(), name), atol=tolerance)
        np.testing.assert_array_equal(again.layers, range(9))


class ZonesAtRest(unittest.TestCase):
    def test_they_grow_from_the_ends_and_meet(self) -> None:
        zones = zones_of(maps())
        np.testing.assert_allclose(1e3 * zones.left[3:6], [0.2, 0.4, 0.6])
        np.testing.assert_allclose(zones.left[3:6], zones.right[3:6])
        np.testing.assert_allclose(1e3 * zones.bed[1:], 1.5)
        np.testing.assert_allclose(zones.covered[1:7], [0., 0., 4 / 15, 8 / 15, 12 / 15, 1.])
        self.assertEqual((zones.first, zones.meet, zones.at_rest_from), (3, sample_bed.MEETS, sample_bed.MEETS))

    def test_the_table_tells_what_the_share_of_resting_grains_does(self) -> None:
        found = maps()
        found.resting[sample_bed.MEETS] *= 0.55  # in whose pass the zones meet
        head, row = meeting_table([Group("bed", [SpreadRun("run", run_with([0.6] * 8).layers, None, found)])])
        self.assertEqual(head[3:5], ["50 %", "60 %"])
        self.assertEqual(row[3:5], [f"{sample_bed.MEETS}", f"{sample_bed.MEETS + 1}"])

    def test_they_may_never_meet(self) -> None:
        zones = zones_of(maps(range(5)))
        self.assertEqual((zones.first, zones.meet, zones.at_rest_from), (3, None, None))
        self.assertIsNone(zones_of(maps(range(3))).first)

    def test_they_meet_only_if_they_have_grown_from_both_ends(self) -> None:
        found = maps()
        columns = np.arange(len(found.x) - 1)

        def meet(*resting: np.ndarray) -> int | None:
            stack = [np.zeros(found.resting.shape[1:]), *(np.outer(rest, np.ones(found.resting.shape[2])) for rest in resting)]
            of_layers = replace(found, layers=found.layers[:len(stack)], resting=np.array(stack),
                                tracked=np.full((len(stack), *found.tracked.shape[1:]), 9.))
            return zones_of(of_layers).meet

        everywhere = np.ones(len(columns))
        self.assertEqual(meet((columns < 2) | (columns > 3), everywhere), 2)
        self.assertIsNone(meet(columns < 2, everywhere))
        self.assertIsNone(meet(everywhere))

    def test_a_rest_that_does_not_last(self) -> None:
        found = maps()
        found.resting[8] = 0.
        zones = zones_of(found)
        self.assertEqual((zones.meet, zones.at_rest_from), (sample_bed.MEETS, None))

    def test_an_empty_plate(self) -> None:
        zones = zones_of(maps([0]))
        self.assertTrue(np.isnan(zones.covered[0]) and zones.left[0] == zones.right[0] == 0.)


def run_with(lrd: list[float], name: str = "run") -> SpreadRun:
    """Densities of layers 1, 2, ..."""
    number = np.arange(1., len(lrd) + 1.)
    others = {key: np.ones(len(lrd)) for key in Layers.__dataclass_fields__ if key not in ("layer", "lrd")}
    return SpreadRun(name, Layers(layer=number, lrd=np.array(lrd), **others), None, None)


class Numbers(unittest.TestCase):
    def test_intervals(self) -> None:
        found = mean_of([1., 2., 3., float("nan")])
        self.assertEqual((found.value, round(found.half, 3)), (2., 2.484))  # 4.303 / sqrt(3)
        self.assertFalse(found.is_significant)
        self.assertTrue(np.isnan(mean_of([1.]).half) and np.isnan(mean_of([]).value))
        # Welch: 2 degrees of freedom remain of 2 and 2, and of a group without scatter.
        found = difference_of([3., 4., 5.], [1., 1., 1.])
        self.assertEqual((found.value, round(found.half, 3)), (3., 2.484))
        self.assertFalse(difference_of([1., 3.], [1., 2.]).is_significant)
        self.assertFalse(difference_of([1.], [2., 3.]).is_significant)
        # Equal values do not tell how they scatter.
        self.assertTrue(np.isnan(mean_of([3., 3.]).half))
        self.assertFalse(difference_of([1., 1.], [2., 2.]).is_significant)

    def test_groups_that_scatter_alike(self) -> None:
        scatter = common_scatter([[1., 3.], [5.], [2., 4., float("nan"), 6.]])
        assert scatter is not None
        # The squares about the means of their groups are 2 and 8, with 1 and 2 degrees of freedom.
        self.assertEqual((round(scatter.deviation ** 2, 6), scatter.freedom), (round(10. / 3., 6), 3))
        self.assertAlmostEqual(mean_of([5.], scatter).half, 3.182 * (10. / 3.) ** 0.5)
        self.assertAlmostEqual(mean_of([5., 6.], scatter).half, 3.182 * (10. / 6.) ** 0.5)
        within = difference_within(scatter, [5.], [1., 3.])
        self.assertEqual((within.value, round(within.half, 3)), (3., 7.115))  # 3.182 sqrt(10 / 3 * 3 / 2)
        # Of a reference that scatters by itself: Welch, with 3.99 degrees of freedom.
        apart = difference_of([5.], [1., 3.], scatter)
        self.assertEqual((apart.value, round(apart.half, 3)), (3., 6.624))  # 3.182 sqrt(10 / 3 + 1)
        # Single runs alone tell nothing.
        self.assertIsNone(common_scatter([[1.], [2.], []]))
        self.assertTrue(np.isnan(difference_within(None, [1.], [2.]).half))

    def test_differences_of_runs_that_spread_the_same_grains(self) -> None:
        def group(label: str, *densities: float, first: int = 1) -> Group:
            return Group(label, [run_with([lrd] * 20, f"{label}_seed{seed}") for seed, lrd in enumerate(densities, first)])
        def of(run: SpreadRun) -> float:
            return float(run.layers.lrd[0])
        # Each seed differs by 0.01 and a little, while the seeds scatter by ten times that.
        reference, softer = group("a", 0.5, 0.6, 0.7), group("b", 0.51, 0.611, 0.709)
        found = difference(softer, reference, of)
        self.assertAlmostEqual(found.value, 0.01)
        self.assertTrue(found.is_significant and found.half < 0.003)
        # Without a partner for each run of the smaller group nothing pairs them.
        other = difference(group("c", 0.51, 0.611, 0.709, first=2), reference, of)
        self.assertFalse(other.is_significant)
        self.assertTrue(np.isnan(difference(group("d", 0.51), reference, of).half))
        # Nor where a seed comes twice.
        twice = Group("e", [*reference.runs, *group("f", 0.3).runs])
        self.assertAlmostEqual(difference(softer, twice, of).value, 0.61 - 0.525)

    def test_a_single_run_has_the_scatter_of_other_groups(self) -> None:
        def rise(run: SpreadRun) -> float:
            return run.rise
        def group(label: str, *rises: float) -> Group:
            return Group(label, [run_with([0.5] * 10 + [0.5 + rise] * 10) for rise in rises])
        single, several, measured = group("a", 0.05), group("b", 0.01, 0.02), group("measured", 0.05, 0.06)
        alone, common = CommonScatter(), CommonScatter([single, several])
        self.assertTrue(np.isnan(alone.mean(single, rise).half))
        scatter = common_scatter([[0.01, 0.02]])
        for found, wanted in ((common.mean(single, rise), mean_of([0.05], scatter)),
                              (common.difference(single, several, rise), difference_within(scatter, [0.05], [0.01, 0.02])),
                              (common.difference(single, measured, rise), difference_of([0.05], [0.05, 0.06], scatter)),
                              # What is not among the groups scatters by itself.
                              (common.mean(measured, rise), mean_of([0.05, 0.06]))):
            self.assertFalse(np.isnan(wanted.half))
            np.testing.assert_allclose([found.value, found.half], [wanted.value, wanted.half], atol=1e-12)
        self.assertIn("one run has no interval", rise_sentence(single))
        self.assertNotIn("no interval", rise_sentence(single, common))

    def test_the_pass_that_is_shown(self) -> None:
        """The last one of which all was filmed; else that of which most was."""
        def shown(*times: float) -> int:
            entries = [Snapshot(time, Path("unused")) for time in times]
            run = SimpleNamespace(pictures=lambda ending="": entries, folder=Path("unused"))
            numbers = {key: np.arange(4.) for key in Layers.__dataclass_fields__}
            layers = Layers(**numbers)
            return pass_of(run, layers, None).layer
        self.assertEqual(shown(0.05, 0.5, 1., 1.05, 1.5, 2., 2.1, 2.2, 2.3), 2)
        self.assertEqual(shown(0.5, 0.7, 1., 1.05, 1.1, 1.15), 1)

    def test_peak(self) -> None:
        # A single high layer is no peak of three.
        lrd = [0.9, 0.5, 0.5, 0.58, 0.5, 0.5, 0.54, 0.56, 0.55, 0.5]
        value, layer = peak_of(np.arange(1., 11.), np.array(lrd))
        self.assertEqual((round(value, 6), layer), (0.55, 8.))
        self.assertTrue(np.isnan(peak_of(np.arange(1., 4.), np.array([0.5, 0.5, 0.5]))[0]))

    def test_measured_curve(self) -> None:
        group = measured_group(read_measured())
        np.testing.assert_allclose(np.mean(group.of_runs(lambda run: run.peak[1])), 17.33, atol=0.7)
        self.assertIn("rises by 5.5 ± 0.8 %.", rise_sentence(group))

    def test_measured_tables_that_begin_elsewhere(self) -> None:
        for first, begins in ((0, 2), (1, 2), (2, 2)):
            measured = Measured(np.arange(first, 9.), np.full((9 - first, 2), 0.55))
            crd = measured_group(measured).runs[0].layers.crd
            np.testing.assert_allclose(crd, [0.55 if k >= begins else np.nan for k in range(first, 9)])
        unknown = Measured(np.arange(5., 9.), np.full((4, 2), 0.55))  # the mean from layer 2 on is not known
        self.assertEqual([len(array) for array in unknown.cumulative()], [0, 0])
        self.assertTrue(np.isnan(measured_group(unknown).runs[0].layers.crd).all())

    def test_rise(self) -> None:
        flat, steps = [0.5] * 20, [0.5] * 10 + [0.6] * 10
        self.assertAlmostEqual(run_with(steps).rise, 0.1)
        self.assertTrue(np.isnan(run_with(flat[:15]).rise))
        group = Group("flat", [run_with(flat), run_with([0.5] * 10 + [0.51] * 10)])
        self.assertIn("not significant", rise_sentence(group))
        self.assertIn("one run has no interval", rise_sentence(Group("one", [run_with(steps)])))
        self.assertIn("too few layers", rise_sentence(Group("short", [run_with(flat[:5])])))

    def test_significant_differences_are_bold(self) -> None:
        groups = [Group("a", [run_with([0.50] * 20), run_with([0.502] * 20)]),
                  Group("b", [run_with([0.60] * 20), run_with([0.602] * 20)]),
                  Group("c", [run_with([0.50] * 20), run_with([0.504] * 20)])]
        table = differences_table(groups)
        self.assertEqual([table[1][2], table[2][2]], ["**+10.0 ± 0.6**", "+0.1 ± 2.8"])
        self.assertEqual(densities_table(groups)[1][:3], ["a", "2", "50.1 ± 1.3"])


class Supply(unittest.TestCase):
    def test_where_the_powder_goes(self) -> None:
        def of(shift: float) -> SpreadRun:
            one = run_with([0.5] * 12)
            number = one.layers.layer
            return replace(one, layers=replace(one.layers, mass=1e-6 * number**2, to_gap=1e-6 * (number + shift),
                                               to_collector=np.full(12, 3e-6)))
        table = supply_table([Group("a", [of(0.), of(1.)])])
        # Layer 20 has not been spread.
        self.assertEqual(table[1:], [["a", "1", "1.00", "1.50", "3.00"], ["a", "10", "19.00", "10.50", "3.00"]])


class Movie(unittest.TestCase):
    def frame(self, plate: float) -> Frame:
        """A moment of pass 2 in which the plate has come down to a height, and all grains with it; one has also
        moved by 30 and 40 um. The other solid is a spreader above the plate."""
        a, fall = APPARATUS, plate - APPARATUS.plate_height(1)
        last = np.array([[a.x_plate + 1e-4, -1e-5, 0.], [a.x_plate + 2e-4, -1e-5, 0.], [0., 0., 0.]])
        here = last + [[0., fall, 0.], [3e-5, fall + 4e-5, 0.], [a.x_plate, 1e-4, 0.]]
        triangle = np.array([[a.x_plate, 0., 0.], [a.x_plate_end, 0., 0.], [a.x_plate, 0., a.depth]])
        solids = np.array([triangle + [0., plate, 0.], triangle + [0., a.clearance, 0.]])
        return Frame(0.2, {"points": here, "last_position": last, "layer": np.array([0., 1., -1.]),
                           "on_plate": np.array([1., 1., 0.])}, solids)

    def test_displacement_is_over_the_plate(self) -> None:
        for plate in (-1e-4, -1.4e-4, -2e-4):
            moved = moved_since(self.frame(plate), APPARATUS, 2)
            np.testing.assert_allclose(moved[:2], [0., 5e-5], atol=1e-12)
            self.assertTrue(np.isnan(moved[2]))


class Page(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        # Much of the time would go into pixels.
        coarse = mock.patch("eunoe.report.style.RESOLUTION", 40.)
        coarse.start()
        self.addCleanup(coarse.stop)
        self.folder = Path(temporary.name)
        self.names = ["PS1_seed1", "PS1_seed2", "PS3_seed1"]
        for name in self.names:
            sample_run.write_run(self.folder / name)

    def make(self, *options: str, names=None) -> tuple[int, str, str]:
        output, errors = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(output), contextlib.redirect_stderr(errors):
            code = of_run.main([*(str(self.folder / name) for name in names or self.names), *options])
        return code, output.getvalue(), errors.getvalue()

    def without_drawing(self) -> contextlib.AbstractContextManager:
        """Pages without what their figures show, where another test has drawn the same ones."""
        return mock.patch("eunoe.report.style.to_svg", lambda *_: "<svg></svg>")

    def test_runs_are_pooled(self) -> None:
        page = self.folder / "PS1_seed1" / "comparison.html"
        self.assertEqual(self.make(), (0, f"Comparison: {page}\n", ""))
        text = page.read_text(encoding="utf-8")
        # Densities, also of the middle half, what a pass does, a map of each of two groups, profiles.
        self.assertEqual(text.count("<figure>"), 6)
        for words in ("<td>PS1</td><td>2</td>", "<td>PS3</td><td>1</td>", "measured, full size",
                      "differences in points of that"):
            self.assertIn(words, text)

    def test_runs_that_have_not_finished_are_told_of(self) -> None:
        # The third one would have its peak, of those layers that it has, in layer 10.
        for seed, layers in ((1, 21), (2, 21), (3, 12)):
            sample_bed.write_run(self.folder / f"A_seed{seed}", peak=14, seed=seed, layers=layers)
        sample_bed.write_run(self.folder / "B_seed1", peak=14, seed=1)
        out = self.folder / "page.html"
        self.assertEqual(self.make("--out", str(out), names=["A_seed1", "A_seed2", "A_seed3", "B_seed1"])[0], 0)
        text = out.read_text(encoding="utf-8")
        self.assertEqual(text.count("The run has not finished"), 1)
        row = re.search("<td>A</td><td>3</td><td>(.*?)</td></tr>", text)[1]
        cells = row.split("</td><td>")
        self.assertEqual([*cells[:4], *cells[5:]],
                         ["60.2 ± 0.2", "62.2 ± 0.6 (2)", "6.7", "6.7 (2)", "64.3 ± 0.6 (2)", "14.0 (2)"])
        self.assertTrue(cells[4].startswith("2.0") and cells[4].endswith(" (2)"))
        for words in ("A_seed3: The run has not finished (there is no summary.json): 12 of 21 layers are weighed so far.",
                      "A (2 of 3 runs): from layers 2 to 10 to", "After layer 11, the last of which all runs have a picture",
                      "<td>A</td><td>2 of 3</td><td>3</td><td>6</td><td>6</td><td>100.0</td>"):
            self.assertTrue(words in text, words)

    def test_profiles_are_of_one_layer(self) -> None:
        found = maps()
        short, other = (replace(run_with([0.5] * 8), maps=replace(found, layers=found.layers[rows], **{
            name: getattr(found, name)[rows] for name in ("fraction", "tracked", "moved", "resting")}))
            for rows in (slice(0, 6), slice(2, 9)))
        groups = [Group("short", [short]), Group("other", [other])]
        self.assertEqual(last_common_layer(groups), 5)
        for line in profiles_figure(groups).axes[0].lines:
            np.testing.assert_allclose(line.get_ydata(), 1e3 * found.columns()[5])
        self.assertIsNone(last_common_layer([Group("none", [run_with([0.5])])]))

    def test_runs_that_go_on_with_the_layers_of_others_are_pooled_by_layer(self) -> None:
        def run(first: int) -> SpreadRun:
            whole = run_with([0.5 + 0.01 * k for k in range(9)])
            return SpreadRun("", Layers(**{field.name: getattr(whole.layers, field.name)[first:] for field in fields(Layers)}),
                             None, None)
        group = Group("a", [run(0), run(3), run(1)])
        np.testing.assert_array_equal(group.layer, run(3).layers.layer)
        np.testing.assert_allclose(group.stacked("lrd"), 3 * [run(0).layers.lrd[3:]])

    def test_labels(self) -> None:
        out = self.folder / "page.html"
        with self.without_drawing():
            self.assertEqual(self.make("--label", "a", "--label", "b", "--label", "a", "--out", str(out))[0], 0)
        self.assertIn("a: PS1_seed1, PS3_seed1; b: PS1_seed2", out.read_text(encoding="utf-8"))
        code, _, errors = self.make("--label", "a")
        self.assertEqual(code, 2)
        self.assertIn("There are 1 labels for 3 runs", errors)

    def test_labels_of_folders_with_one_name(self) -> None:
        for names, labels in (
                (("A_seed1/run", "A_seed2/run", "B/run", "C_seed3"), ["A/run", "A/run", "B/run", "C"]),
                (("A/PS1_seed1", "A/PS1_seed2", "B/PS1_seed1"), ["A/PS1", "A/PS1", "B/PS1"]),
                (("L1/run_seed1", "L2/run_seed2"), ["L1/run", "L2/run"]),
                (("x/A/run_seed1", "y/A/run_seed1", "y/B/run_seed1"), ["x/A/run", "y/A/run", "B/run"])):
            self.assertEqual(default_labels([Path(name) for name in names]), labels)

    def test_figures_go_to_a_folder(self) -> None:
        self.assertEqual(self.make("--figures", str(self.folder / "paper"))[0], 0)
        self.assertEqual(sorted(file.name for file in (self.folder / "paper").iterdir()),
                         [f"figure-{k}.pdf" for k in range(1, 7)])

    def test_run_without_pictures(self) -> None:
        sample_run.write_run(self.folder / "bare", pictures=False)
        self.assertEqual(self.make(names=["bare", "PS3_seed1"])[0], 0)
        self.assertIn("bare has no pictures of its layers", (self.folder / "bare" / "comparison.html").read_text())

    def test_what_cannot_be_compared(self) -> None:
        sample_run.write_heap(self.folder / "heap")
        code, _, errors = self.make(names=["PS1_seed1", "heap"])
        self.assertEqual(code, 2)
        self.assertRegex(errors, r"heap is no spreading run: only those are compared\.\n$")
        code, _, errors = self.make(*(word for k in range(8) for word in ("--label", str(k))), names=["PS1_seed1"] * 8)
        self.assertEqual(code, 2)
        self.assertIn("8 labels are too many for one page", errors)

    def test_movie_without_pictures(self) -> None:
        with self.without_drawing():
            code, _, errors = self.make("--movie", names=["PS1_seed1"])
        self.assertEqual(code, 2)
        self.assertIn("has no pictures of a pass for a movie", errors)

    def test_movie(self) -> None:
        if importlib.util.find_spec("PIL") is None:
            self.skipTest("Pillow is missing")
        from PIL import Image
        sample_run.write_pass(self.folder / "PS1_seed1")
        self.assertEqual(self.make("--movie", "--figures", "png", names=["PS1_seed1"])[::2], (0, ""))
        movie = self.folder / "PS1_seed1" / "figures" / "movie-1.gif"
        with Image.open(movie) as image:
            self.assertEqual(image.n_frames, 4)
        page = self.folder / "PS1_seed1" / "report.html"
        shown = re.search("data:image/gif;base64,[^\"]*", page.read_text())[0]
        page.unlink()
        with self.without_drawing():
            self.assertEqual(self.make("--movie", "2", names=["PS1_seed1"])[::2], (0, ""))
            self.assertIn(shown, page.read_text())
            code, _, errors = self.make("--movie", "1", names=["PS1_seed1"])
        self.assertEqual(code, 2)
        self.assertRegex(errors, r"no pictures of pass 1 for a movie.* It has those of 2\.\n$")

    def test_maps_of_a_whole_run(self) -> None:
        self.assertEqual(self.make(names=["PS1_seed1"])[0], 0)
        self.assertIn("Displacement and density along the plate", (self.folder / "PS1_seed1/report.html").read_text())
        head, *rows = (self.folder / "PS1_seed1" / "bed.csv").read_text().splitlines()
        self.assertEqual(head, "layer,x,y,solid_fraction,displacement")
        pictures = read_run(self.folder / "PS1_seed1").layer_pictures()
        found = read_maps(pictures, Apparatus.read(self.folder / "PS1_seed1" / "apparatus.json"))
        self.assertAlmostEqual(sum(float(row.split(",")[3]) for row in rows), found.fraction.sum(), delta=1e-4 * len(rows))
        places = [float(row.split(",")[1]) for row in rows]
        self.assertTrue(found.x[0] < min(places) and max(places) < found.x[-1])
        self.assertEqual(sum(row.endswith(",") for row in rows), np.count_nonzero((found.fraction > 5e-5) & (found.tracked == 0)))


if __name__ == "__main__":
    unittest.main()
