"""Tests of contrib/tools reproduction, with a program that takes no time; they need numpy, matplotlib and VTK."""

from __future__ import annotations

import contextlib
import fcntl
import importlib.util
import io
import json
import math
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path
from types import SimpleNamespace
from unittest import mock

if any(importlib.util.find_spec(name) is None for name in ("numpy", "matplotlib", "vtkmodules")):
    print("skipped: numpy, matplotlib or VTK is missing")
    sys.exit(0)

import numpy as np

from eunoe import commands
from eunoe.intervals import Interval
from eunoe.pictures.record import digest, read_record
from eunoe.reproduction.cases import CASES, VARIANTS, Case
from eunoe.reproduction.page import BLOCKS, OTHER_ENDS, other_ends
from eunoe.reproduction.results import Findings, Result, length_name
from eunoe.reproduction.verdict import agreement, by_chance, in_layers, simulated_table
from eunoe.repository import DOC, ROOT

HERE = Path(__file__).resolve().parent
MARKED, OTHER = ("".join(f"<!-- {name}: generated -->\nstale\n<!-- end of {name} -->\n" for name in blocks)
                 for blocks in (BLOCKS, OTHER_ENDS))


class Cases(unittest.TestCase):
    def test_names_are_unique_and_seeds_are_grouped(self) -> None:
        self.assertEqual(len({case.name for case in CASES}), len(CASES))
        self.assertEqual(len({(case.group, case.seed) for case in CASES}), len(CASES))

    def test_settings(self) -> None:
        case = Case("PS1", 0.25, 1)
        self.assertTrue(case.is_plain)
        self.assertEqual(case.settings["powder spreading/length factor"], "0.0357142857")
        self.assertEqual(case.settings["simulation control/time step"], "1.78099e-06")
        forgets = Case("PS1", 0.25, 1, variant="forget")
        self.assertEqual(forgets.settings["model parameters/contact history/forget interval"], 3930)
        self.assertIn("forget", forgets.title)
        self.assertEqual((case.base, forgets.base), ("PS1_L0.25", "PS1_L0.25"))
        lips = Case("PS1", 0.25, 1, variant="lips")
        self.assertEqual((lips.base, lips.settings["powder spreading/gap"]), ("PS1_L0.25", "0.1e-3"))
        self.assertEqual(lips.settings["powder spreading/rim width"], "0")
        self.assertNotIn("powder spreading/rim width", case.settings)

    def test_stiff_grains_have_shorter_steps(self) -> None:
        soft, stiff = Case("PS1", 0.5, 1, variant="open"), Case("PS1", 0.5, 1, variant="open_stiff")
        wall, step = "lagrangian physical properties/young modulus wall", "simulation control/time step"
        self.assertEqual((soft.base, soft.settings[wall], soft.settings[step]),
                         ("PS1_L0.5", "2.625e+06", "1.78099e-06"))
        self.assertEqual((stiff.base, stiff.settings[step]), ("PS1_L0.5_open", "5.632e-07"))
        self.assertNotIn(wall, stiff.settings)
        for entry in ("rim width", "feedstock level"):
            self.assertEqual((stiff.settings[f"powder spreading/{entry}"], soft.settings[f"powder spreading/{entry}"]),
                             ("0", "0"))
        self.assertEqual((stiff.title, stiff.full_title),
                         ("the paper's Young's modulus", "without rims, fed less, the paper's Young's modulus"))
        self.assertTrue(soft.is_seen_closely and stiff.is_seen_closely)
        self.assertFalse(Case("PS1", 0.25, 1, variant="lips").is_seen_closely)
        deep = Case("PS1", 0.5, 1, depth=0.8)
        self.assertTrue(deep.keeps_maps and not deep.is_seen_closely)

    def test_names_of_lengths(self) -> None:
        self.assertEqual([length_name(length) for length in (0.25, 0.5, 1., 2.)], ["L1/4", "L1/2", "L1", "L2"])

    def test_the_page_has_its_markers(self) -> None:
        text = (DOC / "reproduction.md").read_text(encoding="utf-8")
        for name in BLOCKS:
            self.assertEqual(text.count(f"<!-- {name}: generated -->\n"), 1, name)
            self.assertEqual(text.count(f"<!-- end of {name} -->"), 1, name)

    def test_each_variant_is_run(self) -> None:
        self.assertEqual({case.variant for case in CASES}, set(VARIANTS))


class Verdict(unittest.TestCase):
    def test_densities_agree_only_where_the_interval_says_so(self) -> None:
        for difference, half, said in ((0.002, 0.01, "agrees within 1.2 %"),
                                       (-0.205, 0.298, "cannot be told: -20.5 ± 29.8 %"),
                                       (0.005, 0.018, "cannot be told: +0.5 ± 1.8 %"),
                                       (-0.22, 0.073, "no: -22.0 ± 7.3 %"),
                                       (0.1, math.nan, "+10.0 %; one run has no interval"),
                                       (math.nan, math.nan, "not known yet")):
            self.assertEqual(agreement(Interval(difference, half)), said)


    def test_layers_on_plates_of_other_lengths(self) -> None:
        for layers, length, said in (([17], 1., "later, on 0.5 of that length"), ([11, 12], 2., "then"),
                                     ([7, None], 0.5, "earlier, in 1 of 2 runs, on 0.25 of that length"),
                                     ([None, None], 1., "no: in none of 2 runs")):
            self.assertEqual(in_layers(layers, (9, 13), length), said)

    def test_runs_that_cannot_tell_say_nothing(self) -> None:
        findings = Findings(Path("nowhere"), ())
        case = Case("PS1", 0.5, 1)
        for n_layers, rows in ((3, 0), (21, 1)):  # without maps, and of too few layers for a peak
            layers = SimpleNamespace(layer=np.arange(n_layers), lrd=np.linspace(0.5, 0.6, n_layers))
            findings.results[case.group] = [Result(case.name, layers, None, None, case, {})]
            table, differences = simulated_table(findings)
            self.assertEqual([row[0] for row in table[1:]], ["LRD peaks in layer"] * rows)
            self.assertEqual(by_chance(differences), "")


class Campaign(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        # Most of the time would go into pictures: they are coarse where they are looked at, and empty elsewhere.
        coarse = mock.patch("eunoe.reproduction.pictures.RESOLUTION", 10.)
        self.empty = mock.patch("matplotlib.figure.Figure.savefig", lambda figure, file, **options: file.touch())
        for patch in (coarse, self.empty):
            patch.start()
            self.addCleanup(patch.stop)
        self.folder = Path(temporary.name)
        self.states = self.folder / "states"
        self.states.mkdir()
        self.program = self.folder / "program"
        self.program.write_text(f"#!/bin/sh\nexec {sys.executable} -B {HERE / 'sample_program.py'} \"$@\"\n")
        self.program.chmod(0o755)
        self.page = self.folder / "page.md"
        self.page.write_text(MARKED)
        other_ends(self.page).write_text(OTHER)

    def words(self, *more: str) -> list[str]:
        return [str(self.program), str(self.states), "--data", str(self.folder / "data"), "--page", str(self.page),
                "--pictures", str(self.folder / "pictures"), *more]

    def run_it(self, *more: str) -> tuple[int, str, str]:
        output, errors = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(output), contextlib.redirect_stderr(errors):
            code = commands.run("reproduction", self.words(*more))
        return code, output.getvalue(), errors.getvalue()

    def starts(self) -> int:
        return sum(log.read_text().count("starts") for log in self.states.glob("*.log"))

    def test_runs_page_and_pictures(self) -> None:
        only = ("--only", "PS1_L0.25", "PS3_L0.25", "PS1_L0.25_forget_seed1", "PS1_L0.25_lips_stiff_seed1",
                "PS1_L1_open_seed1")
        self.empty.stop()
        self.assertEqual(self.run_it(*only, "--jobs", "2")[::2], (0, ""))
        self.empty.start()
        self.check_data()
        self.check_page()
        self.check_pictures()
        # Nothing is run twice, and the same results give the same page.
        before = self.page.read_text()
        self.assertEqual(self.run_it(*only)[0], 0)
        self.assertEqual((self.starts(), self.page.read_text()), (9, before))
        # The small results are enough for the page.
        self.page.write_text(MARKED)
        self.assertEqual(self.run_it("--page-only")[0], 0)
        self.assertEqual(self.page.read_text(), before)

    def check_data(self) -> None:
        data = self.folder / "data"
        self.assertEqual(len(list(data.iterdir())), 9)
        names = sorted(file.name for file in (data / "PS1_L0.25_seed1").iterdir())
        self.assertEqual(names, ["apparatus.json", "bed.csv", "layers.csv", "run.json"])
        self.assertFalse((data / "PS1_L0.25_forget_seed1" / "bed.csv").exists())
        self.assertTrue((data / "PS1_L0.25_lips_stiff_seed1" / "bed.csv").exists())
        record = json.loads((data / "PS1_L0.25_seed1" / "run.json").read_text())
        self.assertEqual((record["git_revision"], record["finished"], record["layers"]), ("abc1234567", True, 21))
        self.assertEqual(record["x_bins"], Findings(data).of("PS1", 0.25).runs[0].maps.x.size - 1)
        self.assertNotEqual(record["processor"], "unknown")
        result = Findings(data).of("PS1", 0.25).runs[1]
        self.assertEqual((round(result.peak[0], 4), result.peak[1]), (0.6437, 14.))
        self.assertEqual((result.zones.first, result.zones.meet), (3, 6))

    def check_page(self) -> None:
        text = self.page.read_text()
        # Means of 0.001 to 0.003 more than 0.6, and what the peak adds to each span of layers.
        self.assertRegex(text, r"\| PS1, L1/4 \| 3 \| 60\.2 ± 0\.2 \| .* \| 64\.4 ± 0\.2 \| 14\.0 \|")
        self.assertRegex(text, r"\| PS3, L1/4 \| 3 \| .* \| 64\.4 ± 0\.2 \| 10\.0 \|")
        self.assertRegex(text, r"\| PS1, L1/4 \| 3 \| 3 \| 6 \| 6 \| 100\.0 \|")
        self.assertRegex(text, r"PS1 and PS3, L1/4, their mean for each of 3 seeds: .* the mean LRD (changes|rises|falls) by ")
        self.assertIn("| contacts forget every 7 ms | 1 |", text)
        self.assertIn("Made by `contrib/tools reproduction` at revision abc1234 on an ", text)
        self.assertRegex(text, r"\| `PS1_L0\.25` \| 3, 3 \| 1\.5 \|")
        self.assertNotIn("stale", text)
        self.assertNotIn("stale", other_ends(self.page).read_text())
        self.assertIn("](pictures/reproduction_density.png)", text)
        self.assertNotIn("reproduction_pass.png", text)  # the runs have no pictures of a pass

    def check_pictures(self) -> None:
        folder = self.folder / "pictures"
        record = read_record(folder)
        self.assertEqual(sorted(record), [f"reproduction_{name}.png" for name in
                                          ("density", "held", "held_layers", "held_maps_PS1", "held_mechanism", "layers", "levels",
                                           "maps_PS1", "maps_PS3", "mechanism", "middle", "open", "open_layers",
                                           "open_maps_PS1", "open_mechanism", "open_middle", "profiles", "variants_1")])
        for name, entry in record.items():
            self.assertEqual((entry.rule, entry.revision, entry.digest),
                             ("reproduction", "abc1234", digest(folder / name)))

    def test_a_run_that_died_goes_on(self) -> None:
        (self.states / "die").touch()
        self.assertEqual(self.run_it("--only", "PS1_L0.25_seed1")[0], 1)
        self.assertIn("No run of these has finished yet.", self.page.read_text())
        self.assertRegex(self.page.read_text(), r"\| `PS1_L0\.25_seed1` \| 5 of 21 \| +\| +\| 60\.1 \| +\| +\|")
        self.assertIn("5 of 21 layers", self.run_it("--plan", "--only", "PS1_L0.25_seed1")[1])
        self.assertEqual(self.run_it("--only", "PS1_L0.25_seed1")[0], 0)
        self.assertEqual(self.starts(), 2)

    def test_what_a_run_has_shown_outlives_its_states(self) -> None:
        only = ("--only", "PS1_L0.25_seed1")
        record = self.folder / "data" / "PS1_L0.25_seed1" / "run.json"
        for layers, kept in ((5, 5), (12, 12), (4, 12), (2, 12)):
            if layers == 2:  # too few, even if those that are kept are of other settings
                record.write_text(record.read_text().replace('"settings": {', '"settings": {"some": "other",'))
            shutil.rmtree(self.states)
            self.states.mkdir()
            (self.states / "die").write_text(str(layers))
            self.assertEqual(self.run_it(*only)[0], 1)
            found = json.loads(record.read_text())
            self.assertEqual((found["finished"], found["layers"], found["git_revision"]), (False, kept, "9876543210"))
        text = self.page.read_text()
        self.assertRegex(text, r"`PS1_L0\.25_seed1` \| 12 of 21 \| 60\.1 \| 61\.3 \| .* \| 1\.2 \| .*\|\n")
        # Zones that meet in layer 6.
        self.assertRegex(text, r"`PS1_L0\.25_seed1` \| 10 \| \d+ \| 100\.0 \| ")
        self.assertIn("at revision 9876543", self.page.read_text())
        self.assertEqual(self.run_it(*only)[0], 0)
        self.assertTrue(json.loads(record.read_text())["finished"])
        self.assertIn("None.", self.page.read_text())
        # One that had finished is not made again, and nothing that has not finished takes its place.
        before = record.read_text().replace('"settings": {', '"settings": {"some": "other",')
        record.write_text(before)
        shutil.rmtree(self.states)
        self.states.mkdir()
        code, output, _ = self.run_it(*only)
        self.assertEqual((code, self.starts()), (0, 0))
        self.assertIn("Finished before: 1 runs", output)
        self.assertRegex(self.run_it("--plan", *only)[1], r"PS1_L0\.25_seed1 .* finished")
        (self.states / "die").write_text("15")
        elsewhere = [str(self.folder / "elsewhere") if word.endswith("data") and "/" in word else word
                     for word in self.words(*only)]
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            self.assertEqual(commands.run("reproduction", elsewhere), 1)
        self.assertEqual(self.run_it("--collect", *only)[0], 0)
        self.assertEqual(record.read_text(), before)

    def test_results_that_cannot_be_read_change_nothing(self) -> None:
        only = ("--only", "PS1_L0.25_seed1")
        kept = self.folder / "data" / "PS1_L0.25_seed1"
        (self.states / "die").write_text("5")
        self.assertEqual(self.run_it(*only)[0], 1)
        before = {file.name: file.read_bytes() for file in kept.iterdir()}
        self.assertEqual(len(before["layers.csv"].splitlines()), 6)
        elsewhere = [word.replace("/data", "/elsewhere") for word in self.words(*only)]
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            self.assertEqual(commands.run("reproduction", elsewhere), 0)
        picture = next((self.states / "PS1_L0.25_seed1").glob("*_layers_*3.vtu"))
        picture.write_bytes(picture.read_bytes()[:200])
        code, _, errors = self.run_it("--collect", *only)
        self.assertEqual(code, 1)
        self.assertIn("PS1_L0.25_seed1: ", errors)
        self.assertEqual({file.name: file.read_bytes() for file in kept.iterdir()}, before)

    def test_a_run_of_another_process_is_left_alone(self) -> None:
        with open(self.states / "PS1_L0.25_seed1.lock", "w", encoding="utf-8") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            code, output, _ = self.run_it("--only", "PS1_L0.25_seed1")
        self.assertEqual((code, self.starts()), (0, 0))
        self.assertIn("PS1_L0.25_seed1 runs already", output)

    def test_a_run_with_other_settings_is_refused(self) -> None:
        only = ("--only", "PS1_L0.25_seed1")
        self.assertEqual(self.run_it(*only)[0], 0)
        note = self.states / "PS1_L0.25_seed1" / "case.json"
        settings = json.loads(note.read_text())
        for text in (json.dumps({**settings, "powder spreading/rim width": "0"}), None):
            note.unlink() if text is None else note.write_text(text)
            code, _, errors = self.run_it(*only)
            self.assertEqual(code, 1)
            self.assertIn("Move it away.", errors)
        note.write_text("")
        self.assertIn("case.json is damaged", self.run_it(*only)[2])
        self.assertEqual(self.starts(), 1)

    def test_runs_are_asked_to_stop(self) -> None:
        (self.states / "wait").touch()
        process = subprocess.Popen([sys.executable, "-B", str(ROOT / "contrib" / "tools"), "reproduction",
                                    *self.words("--only", "PS1_L0.25")], stdout=subprocess.DEVNULL)
        deadline = time.monotonic() + 60.
        while not (self.states / "waits").exists() and time.monotonic() < deadline:
            time.sleep(0.05)
        os.kill(process.pid, signal.SIGTERM)
        self.assertEqual(process.wait(60.), 3)
        self.assertEqual(self.starts(), 1)

    def test_plan(self) -> None:
        code, output, _ = self.run_it("--plan", "--only", "PS1_L0.25", "PS1_L2_seed1")
        self.assertEqual(code, 0)
        # 3.6e10 particle-steps at 16 million a second.
        self.assertRegex(output, r"PS1_L2_seed1 +16525 +2\.00 +36 +0\.62 +missing")
        self.assertIn("Left to do: about 2.5 core-hours at the speed that --check assumes.", output)
        self.assertIn("about 10 core-hours at 4.0 million", self.run_it(
            "--plan", "--speed", "4", "--only", "PS1_L0.25", "PS1_L2_seed1")[1])

    def test_command_for_a_batch_job(self) -> None:
        output = self.run_it("--command", "--only", "PS3_L1_seed1")[1]
        self.assertIn("PS3_L1.prm --seed 1 --set 'powder spreading/length factor = 0.1428571429'", output)
        self.assertEqual(output.count("\n"), 1)

    def test_what_is_wrong_is_said(self) -> None:
        done = subprocess.run([sys.executable, "-B", str(ROOT / "contrib" / "tools"), "reproduction",
                               *self.words("--only", "PS9")], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 1)
        self.assertEqual(done.stderr, "There is no case 'PS9': contrib/tools reproduction --list names them.\n")
        self.page.write_text(MARKED.replace("<!-- end of runs -->", ""))
        done = subprocess.run([sys.executable, "-B", str(ROOT / "contrib" / "tools"), "reproduction",
                               *self.words("--page-only")], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, r"must have '<!-- runs: generated -->' and '<!-- end of runs -->' once")


if __name__ == "__main__":
    unittest.main()
