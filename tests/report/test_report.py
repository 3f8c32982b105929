"""Tests of contrib/tools report; they need numpy, matplotlib and VTK."""

from __future__ import annotations

import contextlib
import importlib.util
import io
import json
import os
import re
import sys
import tempfile
import unittest
from dataclasses import replace
from pathlib import Path
from unittest import mock

if any(importlib.util.find_spec(name) is None for name in ("numpy", "matplotlib", "vtkmodules")):
    print("skipped: numpy, matplotlib or VTK is missing")
    sys.exit(0)

import numpy as np

import sample_run
from eunoe.report import of_run
from eunoe.report.apparatus import Apparatus
from eunoe.report.case_section import slopes_sentence
from eunoe.report.evidence import Evidence
from eunoe.report.general_report import speed_figure
from eunoe.report.heap_results import read_map
from eunoe.report.layer_results import counting_noise, moved_over_plate
from eunoe.report.measured import TABLE, FullSize, measured_for, read_measured
from eunoe.report.quantities import number
from eunoe.report.run_folder import ReportError, read_layers
from eunoe.report.summary_text import summary_text
from eunoe.vtk_files import VtkError, read_pvd, read_vtu


class InFolder(unittest.TestCase):
    """A test with a folder of its own."""

    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name) / "run"
        self.folder.mkdir()

    def file(self, name: str, text: str) -> Path:
        path = self.folder / name
        path.write_text(text)
        return path


class VtkFiles(InFolder):
    def setUp(self) -> None:
        super().setUp()
        self.points = np.arange(30.).reshape(10, 3)
        self.fields = {"mass": np.arange(10.) + 100., "velocity": np.arange(30.).reshape(10, 3)}

    def piece(self, rows: slice) -> str:
        return sample_run.piece(self.points[rows],
                                {name: values[rows] for name, values in self.fields.items()})

    def test_pieces_of_several_ranks_are_joined(self) -> None:
        # 64 bytes a block: the points take two blocks, the masses one.
        text = sample_run.vtu(self.piece(slice(0, 4)), sample_run.EMPTY_PIECE,
                              self.piece(slice(4, 10)))
        found = read_vtu(self.file("a.vtu", text), ("mass", "velocity", "unknown"))
        self.assertEqual(set(found), {"points", "mass", "velocity"})
        np.testing.assert_array_equal(found["points"], self.points)
        for name, values in self.fields.items():
            np.testing.assert_array_equal(found[name], values)

    def test_only_wanted_fields_are_read(self) -> None:
        path = self.file("a.vtu", sample_run.vtu(self.piece(slice(0, 10))))
        self.assertEqual(set(read_vtu(path, ("mass",))), {"points", "mass"})

    def test_file_without_particles(self) -> None:
        path = self.file("a.vtu", sample_run.vtu(sample_run.EMPTY_PIECE))
        self.assertEqual(read_vtu(path, ("mass",))["points"].shape, (0, 3))

    def test_file_that_is_not_complete(self) -> None:
        text = sample_run.vtu(self.piece(slice(0, 10)))
        for part in (text[:len(text) // 2], text.replace("eJ", "eA", 1), ""):
            with self.assertRaises(VtkError):
                read_vtu(self.file("a.vtu", part), ("mass",))

    def test_index(self) -> None:
        path = self.file("a.pvd", sample_run.pvd([(0.1, "a_0.vtu"), (0.25, "a_1.vtu")]))
        self.assertEqual([(entry.time, entry.file.name) for entry in read_pvd(path)],
                         [(0.1, "a_0.vtu"), (0.25, "a_1.vtu")])
        self.assertEqual(read_pvd(self.folder / "none.pvd"), [])


class Tables(InFolder):
    def test_layers(self) -> None:
        layers = read_layers(self.file("layers.csv", sample_run.LAYERS))
        self.assertEqual(len(layers), 3)
        self.assertTrue(np.isnan(layers.lrd[0]) and np.isnan(layers.crd[1]))
        np.testing.assert_array_equal(layers.lrd[1:], [0.5, 0.55])
        np.testing.assert_allclose(layers.arrived, [4e-8, 1.4e-7, 1.52e-7])

    def test_row_that_is_not_complete_is_dropped(self) -> None:
        layers = read_layers(self.file("layers.csv", sample_run.LAYERS + "3,0.4,4e-"))
        self.assertEqual(layers.last, 2)

    def test_tables_without_layers(self) -> None:
        header = sample_run.LAYERS.splitlines()[0]
        for text in ("", header + "\n", "layer,time\n0,1\n", header + "\n" + 12 * "x," + "x\n"):
            with self.assertRaises(ReportError):
                read_layers(self.file("layers.csv", text))

    def test_measured_densities(self) -> None:
        measured = read_measured()
        np.testing.assert_array_equal(measured.layer, np.arange(1, 21))
        table = np.genfromtxt([line for line in TABLE.read_text().splitlines() if not line.startswith("#")], delimiter=",",
                              names=True)
        np.testing.assert_allclose(measured.mean, table["mean"], atol=2e-6)
        np.testing.assert_allclose(measured.repeats.std(axis=1, ddof=1), table["std"], atol=2e-6)
        self.assertEqual(measured.layer[measured.mean.argmax()], 18)

    def test_which_measured_densities(self) -> None:
        apparatus = Apparatus(**{**sample_run.APPARATUS, "density": FullSize.density, "velocity": FullSize.velocity,
                                 "layer_thickness": FullSize.layer_thickness})
        self.assertTrue(measured_for("", [apparatus, None]).is_of_paper)
        self.assertIsNone(measured_for("", [apparatus, replace(apparatus, density=7800.)]))
        self.assertIsNone(measured_for("none", [apparatus]))
        own = self.file("own.csv", "# steel\nlayer, repeat 1, repeat 2\n1,0.5,0.52\n2,0.55,0.57\n")
        found = measured_for(str(own), [replace(apparatus, density=7800.)])
        np.testing.assert_allclose(found.mean, [0.51, 0.56])
        np.testing.assert_allclose(found.cumulative()[1], [[0.55, 0.57]])
        self.assertIn("own.csv, mean and standard deviation of 2 repeats", found.caption)
        own.write_text("\ufefflayer, repeat\n1,0.51\n", encoding="utf-8")  # as spreadsheets write it
        np.testing.assert_allclose(read_measured(own).mean, [0.51])
        for text, said in (("layer,LRD\n1,0.5\n", "heading"), ("", "heading"), ("layer,repeat\n1,x\n", "row that does not have 2"),
                           ("layer,repeat\n1\n", "row that does not have 2"),
                           ("layer,repeat\n2,0.5\n1,0.5\n", "ascending"), ("layer,repeat\n1,55\n", "not per cent")):
            with self.assertRaisesRegex(ReportError, said):
                measured_for(str(self.file("own.csv", text)), [apparatus])
        with self.assertRaisesRegex(ReportError, "No such file"):
            measured_for(str(own.with_name("nowhere.csv")), [apparatus])

    def test_counting_noise(self) -> None:
        layers = read_layers(self.file("layers.csv", sample_run.LAYERS))
        noise = counting_noise(layers, full_layer_mass=2.4e-7, grain=5e-10)
        self.assertTrue(np.isnan(noise.lrd[0]) and np.isnan(noise.crd[1]))
        np.testing.assert_allclose(noise.lrd[1], np.sqrt((1.4e-7 + 2e-8) * 5e-10) / 2.4e-7)
        np.testing.assert_allclose(noise.crd[2], noise.lrd[2])

    def test_numbers(self) -> None:
        self.assertEqual([number(value) for value in (0., 0.12345, -1.5, 1234567., 2.816e-7)],
                         ["0", "0.123", "\u22121.5", "1\u202f230\u202f000",
                          "2.82\u00a0×\u00a010⁻⁷"])


class Geometry(unittest.TestCase):
    def setUp(self) -> None:
        self.apparatus = Apparatus(**sample_run.APPARATUS)

    def test_places(self) -> None:
        a = self.apparatus
        np.testing.assert_allclose([a.x_gap, a.x_plate, a.x_plate_end, a.x_exit, a.x_end],
                                   [2.0e-3, 2.1e-3, 3.6e-3, 3.7e-3, 4.2e-3])
        np.testing.assert_allclose(a.full_layer_mass, 4386. * 1.5e-3 * 4e-4 * 1e-4)
        self.assertAlmostEqual(a.spreader_tip(), 4.0e-3)
        self.assertAlmostEqual(a.spreader_outline(a.spreader_tip())[:, 1].min(), 1e-4)

    def test_rims_stand_between_gap_and_plate(self) -> None:
        held = replace(self.apparatus, rim=2e-5)
        self.assertAlmostEqual(held.gap, 8e-5)
        full = FullSize()
        self.assertIn("slopes into the gaps", slopes_sentence(self.apparatus, full, 20))
        self.assertEqual(slopes_sentence(held, full, 20), "")

    def test_next_spreader_is_under_way_where_passes_overlap(self) -> None:
        a = self.apparatus
        np.testing.assert_allclose(a.spreader_tips(0, {0: 0.1, 1: 0.12}), [4.0e-3, 2.0e-3])
        np.testing.assert_allclose(a.spreader_tips(0, {0: 0.1, 1: 0.2}), [4.0e-3])
        np.testing.assert_allclose(a.spreader_tips(0, {0: 0.1}), [4.0e-3])

    def test_platform_has_made_its_stroke_at_the_weighing(self) -> None:
        for layer in range(3):
            self.assertAlmostEqual(self.apparatus.platform_height(layer, {0: 0.1, 1: 0.2, 2: 0.3}), -2e-4)

    def test_displacement_counts_in_the_plane_of_the_passes(self) -> None:
        _, fields = sample_run.bed(1)
        moved = moved_over_plate(fields)[fields["tracked"] > 0]
        np.testing.assert_allclose(moved, 5e-6)


class Views(unittest.TestCase):
    def drawn(self, vertical: int, upwards: float, wide: int) -> list[float]:
        """Depths, in order, of two spheres that overlap in the view along the third axis, when they are drawn."""
        depth = 3 - vertical - wide
        points = np.zeros((2, 3))
        points[:, depth] = (1e-3, -1e-3)
        points[:, wide] = (0., 1e-4)  # tells which is which
        triangle = np.zeros((3, 3))
        triangle[1, wide] = 1e-2
        figure, _ = speed_figure({"points": points, "diameter": np.full(2, 1e-3), "velocity": np.zeros((2, 3))},
                                  triangle, vertical, upwards)
        circles = figure.axes[0].collections[-1].get_offsets()
        return [points[int(place > 0.05), depth] for place, _ in circles]

    def test_the_front_is_drawn_over_the_back(self) -> None:
        x, y, z = range(3)
        for wide, vertical, upwards, nearest in ((x, y, 1., 1e-3), (x, z, 1., -1e-3), (y, z, 1., 1e-3), (z, y, 1., -1e-3),
                                                 (x, z, -1., 1e-3), (x, y, -1., -1e-3), (z, x, 1., 1e-3)):
            with self.subTest(wide=wide, vertical=vertical, upwards=upwards):
                self.assertEqual(self.drawn(vertical, upwards, wide)[-1], nearest)
                with mock.patch("eunoe.report.canvas.MOST_CIRCLES", 1):
                    self.assertEqual(self.drawn(vertical, upwards, wide), [nearest])


class Report(InFolder):
    def setUp(self) -> None:
        super().setUp()
        # Much of the time would go into pixels.
        coarse = mock.patch("eunoe.report.style.RESOLUTION", 40.)
        coarse.start()
        self.addCleanup(coarse.stop)

    def make(self, *options: str) -> tuple[int, str, str]:
        """Exit code, output and errors of the script for the folder of the test."""
        output, errors = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(output), contextlib.redirect_stderr(errors):
            code = of_run.main([str(self.folder), *options])
        return code, output.getvalue(), errors.getvalue()

    def page(self) -> str:
        """The page, after the checks that hold for every report."""
        code, output, errors = self.make()
        self.assertEqual((code, errors), (0, ""))
        self.assertEqual(output, f"Report: {self.folder / 'report.html'}\n")
        page = (self.folder / "report.html").read_text(encoding="utf-8")
        links = re.findall(r"""(?i)(?:\b(?:src|href|srcset)\s*=|url\()\s*["']?([^"')\s]*)""", page)
        self.assertEqual([link[:80] for link in links if not link.startswith(("#", "data:"))], [])
        self.assertEqual(re.findall(r"(?i)@import|<script|<link", page), [])
        ids = re.findall(r'\bid="([^"]+)"', page)
        self.assertEqual(len(ids), len(set(ids)))
        return page

    def assert_says(self, *texts: str) -> None:
        """Asserts that the page has these texts; a failure does not print the page."""
        page = self.page()
        for text in texts:
            self.assertTrue(text in page, f"The page lacks '{text}'.")

    def test_whole_run(self) -> None:
        sample_run.write_run(self.folder)
        page = self.page()
        self.assertEqual(page.count("<figure>"), 6)
        for text in ("52.5", "in layers 1 to 2", "highest in layer 2", "full-size apparatus",
                     "abc1234", "left the feedstock platform", "Went to the collector", "0\u00a0% are static",
                     "set process = powder spreading"):
            self.assertTrue(text in page, f"The page lacks '{text}'.")
        self.assertFalse('class="notice"' in page)

    def test_run_that_goes_on_with_the_layers_of_another_one(self) -> None:
        sample_run.write_run(self.folder)
        head, *rows = (self.folder / "layers.csv").read_text().splitlines()
        mass = ("1.5e-06", "1.62e-06", "1.752e-06")
        rows = [",".join([str(21 + k), *[time, mass[k]], *rest])
                for k, (_, time, _, *rest) in enumerate(row.split(",") for row in rows)]
        (self.folder / "layers.csv").write_text("\n".join([head, *rows]) + "\n")
        (self.folder / "apparatus.json").write_text(json.dumps({**sample_run.APPARATUS, "n_layers": 24}))
        page = self.page()
        self.assertFalse('class="notice"' in page)
        # Where the powder of all layers is, this run's table does not tell.
        self.assertFalse("left the feedstock platform" in page)
        layers = read_layers(self.folder / "layers.csv")
        self.assertTrue(np.isnan(layers.arrived[0]))  # the bed that was there is not new
        np.testing.assert_allclose(layers.arrived[1:], [1.4e-7, 1.52e-7])
        noise = counting_noise(layers, 2e-7, 1e-9)
        self.assertTrue(np.isfinite(noise.mean_lrd) and np.isnan(noise.lrd[0]))

    def test_what_is_left_of_an_earlier_run_is_told(self) -> None:
        sample_run.write_run(self.folder)
        bed = self.file("bed.csv", "of an earlier run")
        (self.folder / "spreading_layers.pvd").unlink()
        after = (self.folder / "layers.csv").stat().st_mtime
        for time, is_old in ((after - 10., True), (after + 10., False)):
            os.utime(bed, (time, time))
            self.assertEqual("bed.csv is older than layers.csv" in self.page(), is_old)
        self.assertEqual(bed.read_text(), "of an earlier run")

    def test_last_picture_of_a_longer_run(self) -> None:
        self.file("used.prm", "set process = general\nsubsection simulation control\n  set output name = out\nend\n")
        self.file("summary.json", json.dumps(sample_run.SUMMARY))
        self.file("out_00000.vtu", sample_run.vtu(sample_run.piece(*sample_run.bed(0))))
        self.file("out.pvd", sample_run.pvd([(0.3, "out_00000.vtu")]))
        self.assert_says("The last picture")
        self.file("out.pvd", sample_run.pvd([(0.5, "out_00000.vtu")]))
        self.assert_says("is of an earlier run in this folder")

    def test_run_of_one_layer(self) -> None:
        sample_run.write_run(self.folder, layers=1)
        self.assert_says("takes two weighings")

    def test_run_without_pictures_that_has_not_finished(self) -> None:
        sample_run.write_run(self.folder, layers=2, pictures=False, summary=False)
        self.assert_says("The run has not finished (there is no summary.json): 2 of 3 layers", "no pictures of the particles")

    def test_run_with_a_broken_picture(self) -> None:
        sample_run.write_run(self.folder)
        self.file("spreading_layers_00002.vtu", "<VTKFile>")
        self.assert_says("spreading_layers_00002.vtu cannot be read")

    def test_run_without_its_apparatus(self) -> None:
        sample_run.write_run(self.folder)
        (self.folder / "apparatus.json").write_text('{"x_end": 1}')
        self.assert_says("apparatus.json lacks")
        (self.folder / "apparatus.json").write_text("[")
        self.assert_says("apparatus.json cannot be read")
        (self.folder / "apparatus.json").unlink()
        self.assert_says("apparatus.json is missing")

    def test_run_of_another_powder(self) -> None:
        sample_run.write_run(self.folder)
        (self.folder / "apparatus.json").write_text(json.dumps({**sample_run.APPARATUS, "density": 7800.}))
        page = self.page()
        for text in ("full-size", "full size", "Ti-6Al-4V"):
            self.assertFalse(text in page, f"The page has '{text}'.")
        own = self.file("own.csv", "layer,repeat\n1,0.51\n2,0.56\n")
        page = of_run.make_page(self.folder, measured=str(own)).html()
        self.assertTrue("own.csv" in page and "against 53.5" in page)

    def test_means_are_compared_over_the_layers_that_both_have(self) -> None:
        sample_run.write_run(self.folder)
        layers = read_layers(self.folder / "layers.csv")
        for rows, said in (("2,0.56\n3,0.9\n", "52.5 % in layers 1 to 2, and 55.0 % in layer 2, against 56.0 % measured there; "),
                           ("0,0.9\n1,0.5\n2,0.56\n", "in layers 1 to 2, against 53.0 % measured in the same layers; "),
                           ("3,0.9\n", "is 52.5 % in layers 1 to 2; ")):
            measured = read_measured(self.file("own.csv", f"layer,repeat\n{rows}"))
            text = summary_text(layers, Evidence(None, {}, []), None, measured)
            self.assertIn(said, text.replace("\u00a0", " "))

    def test_run_that_was_no_spreading(self) -> None:
        self.file("summary.json", json.dumps(sample_run.SUMMARY))
        self.file("heap_00000.vtu", sample_run.vtu(sample_run.piece(*sample_run.bed(0))))
        self.file("heap.pvd", sample_run.pvd([(0.3, "heap_00000.vtu")]))
        self.assert_says("The last picture", "abc1234")

    def test_measured_densities_of_a_run_that_was_no_spreading(self) -> None:
        own = str(self.file("own.csv", "layer,repeat\n1,0.51\n2,0.56\n"))
        self.file("summary.json", json.dumps(sample_run.SUMMARY))
        self.assertEqual(self.make("--measured", own), (2, "", f"{self.folder} is no spreading run: {own} would stand beside "
                                                               "densities of layers, which only those have.\n"))
        self.assertFalse((self.folder / "report.html").exists())
        self.assertEqual(self.make("--measured", "none")[0], 0)

    def test_other_run_that_has_not_finished(self) -> None:
        self.file("used.prm", "set process = general\n")
        self.assert_says("The run has not finished")

    def test_heap(self) -> None:
        sample_run.write_heap(self.folder)
        page = self.page()
        self.assertEqual(page.count("<figure>"), 3)
        for text in ("37.2", "mean of 2 views", "450\u00a0µg of powder lie on the disc", "abc1234",
                     "Black: the measured profile", "40.0\u00a0degrees; the heights differ by 10\u00a0µm",
                     "as the 37.5\u00a0degrees that Gaboriault et al. (2025) measured of their Ti-6Al-4V powder on 10\u00a0mm"):
            self.assertTrue(text in page, f"The page lacks '{text}'.")
        self.assertFalse("as a column" in page)

    def test_heap_that_did_not_flow(self) -> None:
        # On the disc of 1 mm a heap of 37.5 degrees has 55.2e-12 m3 of solid: 0.14 mg of 2500 kg/m3, of which 0.45 mg are 3.3.
        sample_run.write_heap(self.folder, inserted_mass=5e-7, density=2500.)
        self.assert_says("90\u00a0% of the powder stayed on the disc")

    def test_heap_of_a_small_filling(self) -> None:
        # 1.9 heaps of 37.5 degrees, of 2.8: most stays, but no more than a heap can hold.
        sample_run.write_heap(self.folder, inserted_mass=6.7e-7)
        self.assertFalse("as a column" in self.page())

    def test_heap_without_picture(self) -> None:
        sample_run.write_heap(self.folder)
        (self.folder / "heap_heap.pvd").unlink()
        self.assertEqual(self.page().count("<figure>"), 2)

    def test_heap_with_broken_files(self) -> None:
        for name, text in (("heap_map.pgm", "P5\n2 2\n255\n"), ("heap_profile.csv", "x,mean\n0,1\n"),
                           ("heap.csv", "\n".join(sample_run.HEAP.splitlines()[:-1])),
                           ("apparatus.json", "{}")):
            sample_run.write_heap(self.folder)
            self.file(name, text)
            code, output, errors = self.make()
            self.assertEqual((code, output), (2, ""))
            self.assertRegex(errors, rf"^[^\n]*{name}[^\n]*\.\n$")

    def test_map_of_a_heap(self) -> None:
        sample_run.write_heap(self.folder)
        found = read_map(self.folder / "heap_map.pgm")
        np.testing.assert_allclose(found.share, [[1., 1., 0.6], [0., 1., 0.]])
        np.testing.assert_allclose(found.extent, (-0.6e-3, 0.6e-3, 0., 0.8e-3))

    def test_other_place_of_the_page(self) -> None:
        sample_run.write_run(self.folder, layers=1, pictures=False)
        target = self.folder / "other.html"
        self.assertEqual(self.make("--out", str(target))[0], 0)
        self.assertTrue(target.is_file())

    def test_figures_as_files(self) -> None:
        sample_run.write_run(self.folder)
        self.assertEqual(self.make("--figures", "png")[0], 0)
        files = sorted((self.folder / "figures").iterdir())
        self.assertEqual([file.name for file in files], [f"figure-{k}.png" for k in range(1, 7)])
        self.assertTrue(all(file.read_bytes().startswith(b"\x89PNG") for file in files))

    def test_folders_without_a_run(self) -> None:
        for prepare in (lambda: None, lambda: self.file("used.prm", sample_run.PARAMETERS),
                        lambda: self.file("layers.csv", sample_run.LAYERS.splitlines()[0])):
            prepare()
            code, output, errors = self.make()
            self.assertEqual((code, output), (2, ""))
            self.assertRegex(errors, r"^[^\n]*layers\.csv[^\n]*\.\n$")
            self.assertFalse((self.folder / "report.html").exists())


if __name__ == "__main__":
    unittest.main()
