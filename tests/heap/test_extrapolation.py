"""Tests of contrib/tools heap-extrapolation."""

from __future__ import annotations

import contextlib
import io
import math
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "contrib"))

from eunoe import commands
from eunoe.repository import DOC
from eunoe.studies.heap_extrapolation import FORMS, Heap, fit, table_of

KEPT = DOC / "heap" / "heap_size.csv"


class Lines(unittest.TestCase):
    def test_a_line_is_found_with_its_interval(self) -> None:
        line = fit([0., 1., 2., 3.], [1., 4., 5., 8.], 5.)
        # By hand: slope 2.2, residuals -0.2, 0.6, -0.6, 0.2; 4.303 is Student's t of two degrees of freedom.
        self.assertAlmostEqual(line.at.value, 1.2 + 2.2 * 5.)
        self.assertAlmostEqual(line.at.half, 4.303 * math.sqrt(0.8 / 2. * (1. / 4. + 3.5 ** 2 / 5.)))
        self.assertAlmostEqual(line.farthest, 0.6)

    def test_the_form_that_made_the_angles_fits_them(self) -> None:
        for name, form in FORMS.items():
            table = table_of([Heap("PS3", 6., disc, 30. + 4. * form(disc)) for disc in (1.4, 2., 3., 4.)], 10.)
            of_form = [row for row in table[1:] if row[3] == name]
            self.assertEqual([row[4:] for row in of_form], [["0.0", f"{30. + 4. * form(10.):.1f} ± 0.0"]])

    def test_other_fillings_are_not_pooled(self) -> None:
        heaps = [Heap("PS3", fill, disc, 40.) for fill, disc in ((6., 2.), (6., 3.), (12., 4.))]
        self.assertEqual(len(table_of(heaps, 10.)), 1)

    def test_what_is_refused(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            for lines in ("properties,disc_mm\nPS3,2\n", "properties,disc_mm,fill_ratio,heap_base_angle\nPS3,2,6,\n",
                          "properties,disc_mm,fill_ratio,heap_base_angle\nPS3,2\n"):
                file = Path(folder) / "other.csv"
                file.write_text(lines, encoding="utf-8")
                with contextlib.redirect_stderr(io.StringIO()) as errors:
                    self.assertEqual(commands.run("heap-extrapolation", [str(file)]), 1)
                self.assertIn("other.csv is no table of contrib/tools heap-size", errors.getvalue())
        with contextlib.redirect_stderr(io.StringIO()) as errors, self.assertRaises(SystemExit) as end:
            commands.run("heap-extrapolation", [str(KEPT), "--to", "0"])
        self.assertEqual(end.exception.code, 2)
        self.assertIn("a diameter is positive", errors.getvalue())

    def test_the_page_has_what_the_kept_heaps_give(self) -> None:
        output = io.StringIO()
        with contextlib.redirect_stdout(output):
            self.assertEqual(commands.run("heap-extrapolation", [str(KEPT)]), 0)
        page = (DOC / "heap.md").read_text(encoding="utf-8")
        for row in output.getvalue().splitlines():
            self.assertIn(row, page)


if __name__ == "__main__":
    unittest.main()
