"""Tests of the page of a study and of the suite's scripts; they need numpy, the page matplotlib too."""

from __future__ import annotations

import contextlib
import importlib.util
import io
import json
import re
import sys
import tempfile
import unittest
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path

if any(importlib.util.find_spec(name) is None for name in ("numpy", "matplotlib")):
    print("skipped: numpy or matplotlib is missing")
    sys.exit(0)

from eunoe.discovery import foreign_heaps
from eunoe.discovery import score as score_script
from eunoe.discovery.case import TIERS, Case, make_cases
from eunoe.discovery.outcomes import REFUTED, Outcome, outcome_of, read, read_lines, score, wilson
from eunoe.discovery.strength import Strengths
from eunoe.discovery.suite import Suite, parse
from eunoe.folders import alone_with, occupy
from eunoe.launch import Failure
from eunoe.report import discovery_text, of_study
from eunoe.report.discovery_charts import envelope_figure, gap_figure
from eunoe.report.discovery_report import add_tie_breakers
from eunoe.report.discovery_results import Study
from eunoe.report.discovery_text import DOUBTFUL, TITLES, gap_text, held_out_text, title_of, verdict_text
from eunoe.report.page import Page
from eunoe.repository import DOC, ROOT
from sample_study import CHANGES, make_study

EFFECTS = {"cohesion": {"sign": "above", "confounders": ["rolling_resistance"]},
           "rolling_resistance": {"sign": "both", "confounders": []}}


class InFolder(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)


def said(study: Study) -> str:
    return " ".join(verdict_text(study)).replace("\u00a0", " ")


class PageOfAStudy(InFolder):
    def study(self, verdict: str) -> Study:
        make_study(self.folder / verdict, verdict)
        return Study(self.folder / verdict)

    def test_every_verdict_has_a_page(self) -> None:
        for verdict, title in TITLES.items():
            folder = self.folder / verdict.replace(" ", "_")
            make_study(folder, verdict)
            with contextlib.redirect_stdout(io.StringIO()):
                self.assertEqual(of_study.main([str(folder)]), 0)
            page = (folder / "discovery.html").read_text(encoding="utf-8")
            for text in ("friction of walls", "0.0213", "+0.71"):
                self.assertIn(text, page)
            self.assertIn(f"<h1>{title}</h1>", page)
            self.assertIn("a &lt;particle&gt; went wrong", page)
            self.assertIn("before: 0", page)

    def test_words(self) -> None:
        expected = {"named": "confidence of 90", "tie": "0.8 of the 0.97 bits",
                    "off catalogue": "resembles cohesion (cosine 0.7)", "none": "Of 2 effects, 2 would",
                    "underpowered": "says little"}
        for verdict, words in expected.items():
            self.assertIn(words, said(self.study(verdict)))

    def test_nothing_in_the_fit_beside_held_out_data_that_differ(self) -> None:
        study = self.study("none")
        self.assertEqual(title_of(study), "Nothing is missing")
        study.content["gaps"]["held-out"] = {"p before": 1e-6, "result": "the base model does not describe the held-out data"}
        self.assertIn("held-out data differ", title_of(study))
        words = said(study)
        self.assertIn("the held-out data do not (p = 1e-06)", words)
        self.assertNotIn("The measured data agree", words)

    def test_a_tie_whose_first_model_fits_badly_says_so(self) -> None:
        study = self.study("tie")
        self.assertNotIn("none of them", said(study))
        study.content["p of the fit"] = 0.03
        self.assertIn("describes the data badly (p = 0.03)", said(study))

    def test_what_breaks_a_tie_has_a_cost(self) -> None:
        make_study(self.folder / "tie", "tie")
        study = Study(self.folder / "tie")
        for costs, known in ((study.costs, True), ({}, False)):  # an older answer does not tell them
            study.costs = costs
            words = " ".join(verdict_text(study)).replace("\u00a0", " ")
            self.assertEqual("A run of heap takes about 4.5 s of one core." in words, known, words)
            page = Page("", "")
            add_tie_breakers(page, study)
            row = next(row for row in page.parts[-1].split("<tr>") if "profile" in row)
            self.assertIn(">4.5<" if known else ">–<", row)

    def test_one_effect_or_none_of_the_catalogue(self) -> None:
        study = self.study("tie")
        self.assertEqual(title_of(study), "Several effects explain the data alike")
        study.content["tie"] = [{"effects": "cohesion", "probability": 0.9},
                                {"effects": "none of the catalogue", "probability": 0.1}]
        self.assertEqual(title_of(study), "One effect, or something that the catalogue lacks")
        words = said(study)
        self.assertIn("would tell whether it is this effect", words)
        self.assertNotIn("bits that are open", words)
        self.assertNotIn("would look like it", words)

    def test_a_name_that_an_effect_off_the_catalogue_could_have(self) -> None:
        study = self.study("tie")
        study.content["tie"] = [{"effects": "cohesion", "probability": 0.9},
                                {"effects": "none of the catalogue", "probability": 0.1}]
        study.content["amplitudes"] = [{"effect": "cohesion", "unit": "J/m2", "amplitude": 1.1e-4,
                                        "lower": 0.9e-4, "upper": 1.3e-4}]
        study.content["calibration"] = {"lookalikes": {"strength": 8., "recognised": 0.7,
                                                     "taken for": {"cohesion": 0.3}}}
        words = said(study)
        self.assertIn("If it is cohesion (size of it): 0.00011 J/m2 (95 % interval", words)
        self.assertIn("left out of it in turn, 30 % are taken for this one", words)
        study.content["calibration"]["lookalikes"]["taken for"]["cohesion"] = 0.001
        self.assertNotIn("would look like it", said(study))

    def test_effects_that_were_not_tried(self) -> None:
        for verdict, title, sentence in (
                ("tie", "One effect, or something that was not tried", "cannot say which of these it is"),
                ("off catalogue", TITLES["off catalogue"], "no effect of the catalogue that was simulated, nor"),
                ("underpowered", "Something is missing, and most effects were not tried", "no effect that was simulated")):
            study = self.study(verdict)
            study.content |= {"detected": True, "untried": ["wall_friction", "air_drag"]}
            if verdict == "tie":
                study.content["tie"] = [{"effects": "cohesion", "probability": 0.99},
                                        {"effects": "none of the catalogue", "probability": 0.01}]
            self.assertEqual(title_of(study), title)
            words = said(study)
            self.assertIn(sentence, words)
            self.assertIn("There is no simulation with wall friction, air drag, so what is missing may be that", words)
            self.assertNotIn("Nothing was found", words)

    def test_what_the_effects_of_a_tie_have_in_common(self) -> None:
        study = self.study("tie")
        self.assertNotIn("in common", said(study))
        for name in ("cohesion", "rolling_resistance"):
            study.effects[name]["family"] = "contacts that hold"
        self.assertIn("All of them have one thing in common, contacts that hold: an effect of this kind is missing "
                      "with a probability of 100", said(study))
        study.content["tie"] += [{"effects": "none of the catalogue", "probability": 0.1}]
        self.assertIn("cohesion, rolling resistance have one thing in common", said(study))
        study.content["tie"][2]["probability"] = 1.5
        self.assertNotIn("in common", said(study))

    def test_a_member_of_a_tie_has_the_probability_of_models_with_more_effects(self) -> None:
        study = self.study("tie")
        study.content["tie"] = [{"effects": "cohesion", "probability": 0.4},
                                {"effects": "rolling_resistance", "probability": 0.2}]
        study.content["models"] = [*study.content["tie"],
                                   {"effects": "cohesion + wall_friction", "probability": 0.3},
                                   {"effects": "none of the catalogue", "probability": 0.1}]
        words = said(study)
        self.assertIn("cohesion (70 %), rolling resistance (20 %)", words)
        for name in ("cohesion", "rolling_resistance"):
            study.effects[name]["family"] = "contacts that hold"
        words = said(study)
        self.assertIn("with a probability of 90 %", words)

    def test_small_probabilities_are_told(self) -> None:
        study = self.study("named")
        self.assertIn("probability 0.012.", said(study))
        study.content["p of nothing missing"] = 3e-9
        self.assertIn("probability 3e-09.", said(study))
        self.assertIn("refute with a probability of: nothing 90", held_out_text(study))

    def test_what_held_out_data_say_of_a_tie(self) -> None:
        study = self.study("tie")
        table = study.content["gaps"]["held-out"]
        members = [{"effects": "cohesion", "p": 0.4, "result": "the gap shrinks"},
                   {"effects": "rolling_resistance", "p": 0.06, "result": "the gap shrinks"}]
        table["members of the tie"] = members
        self.assertIn("refute none of the candidates (p of cohesion 0.4, rolling resistance 0.06)",
                      held_out_text(study))
        table["members of the tie"] = [member | {"p": None} for member in members]
        self.assertNotIn("refute none", held_out_text(study))
        table["members of the tie"] = members
        members[1]["result"] = "the held-out data refute it; the name is withdrawn"
        self.assertIn("left 2 candidates; the held-out data speak against rolling resistance.",
                      held_out_text(study))

    def test_without_held_out_data(self) -> None:
        study = self.study("none")
        study.content["gaps"]["held-out"] = {"result": "no held-out data"}
        self.assertIn("No data were held out", held_out_text(study))
        figure = envelope_figure(study, True)
        self.assertEqual([t.get_text() for t in figure.axes[0].texts], ["No data were held out."])

    def test_a_gap_that_grows_is_explained(self) -> None:
        study = self.study("off catalogue")
        self.assertEqual(gap_text(study), "")
        study.content["gaps"]["fit"]["gap after"] = 3.5
        study.content["gaps"]["held-out"]["gap after"] = 3.2
        self.assertIn("larger than before", gap_text(study))
        self.assertIn("the gap grows from 2.5 to 3.2", held_out_text(study))
        labels = [t.get_text() for t in gap_figure(study).axes[0].get_yticklabels()]
        self.assertIn("data of the fit, with the closest model", labels)

    def test_fingerprints_are_read(self) -> None:
        cells, prints = self.study("named").fingerprints()
        self.assertEqual(len(cells), 4)
        for fingerprint in prints:
            self.assertEqual(list(fingerprint.change), list(5. * CHANGES[fingerprint.effect]))

    def test_a_folder_without_a_study(self) -> None:
        with contextlib.redirect_stderr(io.StringIO()) as errors:
            self.assertEqual(of_study.main([str(self.folder)]), 2)
        self.assertIn("discovery.json is missing", errors.getvalue())


class CasesOfASuite(unittest.TestCase):
    def test_numbers_and_seeds(self) -> None:
        cases = make_cases(EFFECTS, "small", "development", 3)
        kinds = Counter(case.kind for case in cases)
        numbers = TIERS["small"]
        self.assertEqual(kinds, {"none": numbers.none, "single": 6 * numbers.single, "two": numbers.two,
                                 "deleted": numbers.deleted, "confounded": numbers.confounded})
        self.assertEqual(cases, make_cases(EFFECTS, "small", "development", 3))
        self.assertEqual(len({case.seed for case in cases}), len(cases))
        self.assertEqual(len({case.study_seed for case in cases}), 3)
        reported = make_cases(EFFECTS, "full", "reported", 3)
        self.assertFalse({case.seed for case in cases} & {case.seed for case in reported})
        self.assertFalse({case.study_seed for case in cases} & {case.study_seed for case in reported})

    def test_what_is_hidden(self) -> None:
        for case in make_cases(EFFECTS, "full", "ci", 1):
            self.assertGreater(case.strengths.get("cohesion", 1.), 0.)  # its sign is fixed
            self.assertEqual(case.excluded, list(case.strengths) if case.kind == "deleted" else [])
            self.assertEqual(len(case.strengths), {"none": 0, "two": 2}.get(case.kind, 1))
            if case.kind == "confounded":
                self.assertEqual(list(case.strengths), ["cohesion"])


    def test_truths_that_are_deleted_differ(self) -> None:
        effects = {name: {"sign": "both" if name == "c" else "above", "confounders": ["a"]} for name in "abcdefghijkl"}
        for tier in TIERS:
            for few_or_many in (EFFECTS, effects):
                cases = make_cases(few_or_many, tier, "sixth", 1)
                deleted = [(*case.strengths, *case.strengths.values()) for case in cases if case.kind == "deleted"]
                self.assertEqual(len(deleted), TIERS[tier].deleted)
                self.assertEqual(len(set(deleted)), len(deleted))
        # Only what came twice is drawn anew: a suite that was begun before goes on with its other cases.
        names = [case.name for case in make_cases(EFFECTS, "small", "ci", 1)]
        for name in ("deleted_rolling_resistance+8_24", "deleted_rolling_resistance-8_25", "deleted_cohesion+8_28",
                     "confounded_cohesion+4_30"):
            self.assertIn(name, names)


class PilotOfASuite(InFolder):
    """What a suite hides must have been simulated by its pilot."""

    def suite_with(self, **changes: object) -> tuple[Suite, Strengths]:
        pilot = self.folder / "pilot" / "study"
        make_study(pilot, "none")
        content = json.loads((pilot / "discovery.json").read_text(encoding="utf-8"))
        (pilot / "discovery.json").write_text(json.dumps(content | changes), encoding="utf-8")
        suite = Suite(parse(["program", "study.prm", str(self.folder), "--tier", "range"]))
        return suite, Strengths(pilot)

    def run_with(self, experiment: str, **amplitudes: float) -> dict:
        return {"experiment": experiment, "amplitudes": amplitudes}

    def gives(self, suite: Suite, case: Case, strengths: Strengths) -> tuple[bool, str]:
        with contextlib.redirect_stdout(io.StringIO()) as words:
            return suite.gives_amplitudes(case, strengths), words.getvalue()

    def test_a_pilot_that_is_not_ready_is_refused(self) -> None:
        known = {"cohesion": [[1e-4, 5.]]}
        suite, strengths = self.suite_with(strengths=known, untried=["rolling_resistance"],
                                           ledger=[self.run_with("layers", cohesion=1e-4)])
        cohesion = Case("c", "single", 1, 1, {"cohesion": 4.})
        rolling = Case("r", "single", 1, 1, {"rolling_resistance": -4.})
        suite.refuse_unready_pilot([cohesion], strengths)
        with self.assertRaisesRegex(Failure, "not ready: .* simulated rolling_resistance below its null value. Fill"):
            suite.refuse_unready_pilot([cohesion, rolling], strengths)
        self.assertEqual(self.gives(suite, cohesion, strengths), (True, ""))
        self.assertAlmostEqual(cohesion.amplitudes["cohesion"], 0.8e-4)

    def test_so_is_one_that_knows_one_side(self) -> None:
        suite, strengths = self.suite_with()
        both = [Case(str(side), "single", 1, 1, {"rolling_resistance": side * 4.}) for side in (1., -1.)]
        suite.refuse_unready_pilot(both[:1], strengths)
        with self.assertRaisesRegex(Failure, "simulated rolling_resistance below its null value"):
            suite.refuse_unready_pilot(both, strengths)

    def test_runs_of_held_out_experiments_do_not_make_it_ready(self) -> None:
        rolling = Case("r", "single", 1, 1, {"rolling_resistance": 4.})
        held_out = self.run_with("thick", rolling_resistance=0.1)
        for run in (held_out, held_out | {"failure": "broken"}):
            self.folder /= "suite"
            suite, strengths = self.suite_with(strengths={}, untried=["rolling_resistance"], ledger=[run])
            with self.assertRaisesRegex(Failure, "not ready: .* simulated rolling_resistance above its null value"):
                suite.refuse_unready_pilot([rolling], strengths)

    def test_what_cannot_be_simulated_is_left_out_and_said_why(self) -> None:
        run = self.run_with("layers", rolling_resistance=0.1) | {"failure": "broken"}
        suite, strengths = self.suite_with(strengths={}, untried=["rolling_resistance"], ledger=[run])
        for name, why in (("rolling_resistance", "rolling_resistance failed in all of its runs"),
                          ("cohesion", "cohesion acts in none of its measured experiments"),
                          ("charge", "charge is not of its catalogue")):
            case = Case(name, "single", 1, 1, {name: 4.})
            suite.refuse_unready_pilot([case], strengths)
            found, words = self.gives(suite, case, strengths)
            self.assertFalse(found)
            self.assertIn(f"left out, as by the pilot {why}", words)

    def test_what_is_weak_in_its_range_is_another_matter(self) -> None:
        suite, strengths = self.suite_with()
        suite.options.tier = "small"
        case = Case("c", "single", 1, 1, {"cohesion": 1e6})
        suite.refuse_unready_pilot([case], strengths)
        found, words = self.gives(suite, case, strengths)
        self.assertFalse(found)
        self.assertIn("cohesion cannot be so strong in its range", words)

    def test_a_truth_at_the_end_of_its_range_is_deleted_once(self) -> None:
        suite, strengths = self.suite_with()
        cases = [Case(f"deleted_{value}", "deleted", 1, 1, {"cohesion": value}, ["cohesion"]) for value in (1e5, 1e6)]
        self.assertTrue(self.gives(suite, cases[0], strengths)[0])
        found, words = self.gives(suite, cases[1], strengths)
        self.assertFalse(found)
        self.assertIn("its truth was deleted in an earlier case", words)


class StrengthOfAnEffect(InFolder):
    def test_amplitude_of_a_strength(self) -> None:
        make_study(self.folder / "pilot", "none")
        strengths = Strengths(self.folder / "pilot")
        # Data points are independent here, so the shift is the length of the change.
        length = float((CHANGES["cohesion"]**2).sum())**0.5
        found, reached = strengths.amplitude("cohesion", 4.)
        self.assertAlmostEqual(found / (4. / length * 1e-4), 1., delta=1e-6)
        self.assertEqual(reached, 4.)
        at_the_end, reached = strengths.amplitude("cohesion", 1000.)
        self.assertGreater(at_the_end, found)
        self.assertTrue(4. < reached < 1000.)
        self.assertEqual(strengths.amplitude("cohesion", -4.), (0., 0.))
        for amplitude, strength in ((found, 4.), (10. * at_the_end, reached), (0., 0.), (-found, 0.)):
            self.assertAlmostEqual(strengths.strength("cohesion", amplitude), strength, delta=1e-6)

    def test_a_suite_over_whole_ranges_can_be_cut_short(self) -> None:
        cases = make_cases(EFFECTS, "range", "ci", 1)
        first_half = cases[:len(cases) // 2]
        self.assertLess(1, sum(1 for case in first_half if case.kind == "none"))
        drawn = [abs(s) for case in cases if case.kind == "single" for s in case.strengths.values()]
        self.assertEqual(len(drawn), len(set(drawn)))
        self.assertTrue(3. <= min(drawn) <= max(drawn) <= 40.)


class SharedFolders(InFolder):
    def test_a_folder_has_runs_of_one_kind(self) -> None:
        heaps = self.folder / "heaps"
        occupy(heaps, {"friction": 0.3, "rolling": None}, "truth.json")
        occupy(heaps, {"friction": 0.3, "rolling": None}, "truth.json")
        with self.assertRaisesRegex(Failure, "heaps has runs with another friction. Give another folder"):
            occupy(heaps, {"friction": 0.4, "rolling": None}, "truth.json")

    def test_a_lock_is_held_by_one(self) -> None:
        lock = self.folder / "case.lock"
        with alone_with(lock) as first:
            self.assertIsNotNone(first)
            with alone_with(lock) as second:
                self.assertIsNone(second)
        with alone_with(lock) as again:
            self.assertIsNotNone(again)


class ForeignHeaps(unittest.TestCase):
    def test_other_powders_are_refused(self) -> None:
        foreign_heaps.check(foreign_heaps.Model({**foreign_heaps.BUILT_IN, "heap/mass": "0.0",
                                                 "lagrangian physical properties/g": "0,-9.81,0"}))
        for entry, value in (("size distribution type", "normal"), ("custom distribution from file", "true"),
                             ("custom distribution probability function type", "CDF"),
                             ("custom distribution interpolation", "true"), ("minimum diameter cutoff", "6e-5"),
                             ("maximum diameter cutoff", "9e-5"), ("size weighting exponent", "-1"), ("heap/mass", "1e-6"),
                             ("heap/number of particles", "100"), ("heap/gap below the tube", "1e-4"),
                             ("heap/disc rim height", "1e-3"), ("number of particle types", "2"),
                             ("lagrangian physical properties/g", "0, -1.62, 0")):
            name, = (name for name in foreign_heaps.BUILT_IN if name.endswith(entry))
            with self.assertRaisesRegex(Failure, f"'{name} = .*' only, and the case has {value}"):
                foreign_heaps.check(foreign_heaps.Model({**foreign_heaps.BUILT_IN, name: value}))

    def test_entries_have_the_names_of_the_input(self) -> None:
        entries = (DOC / "parameters.md").read_text(encoding="utf-8")
        for name in foreign_heaps.BUILT_IN:
            self.assertRegex(entries, rf"(?m)^\| `{name.rsplit('/', 1)[-1]}` \|")


def line_of(strength: float, answer: dict, kind: str = "single", truth: Sequence[str] = ("a",)) -> dict:
    """A case of a suite, and its answer, which has nothing else to say."""
    return {"case": {"name": "1", "kind": kind, "seed": 1, "study_seed": 1, "strengths": dict.fromkeys(truth, strength),
                     "excluded": list(truth) if kind == "deleted" else [], "amplitudes": dict.fromkeys(truth, 1.)},
            "answer": {"tie": [], "gaps": {}, "candidates": [{"effect": "a", "confidence": 0.9}], "amplitudes": [],
                       "runs": {"asked for": 100}, **answer}}


def rates_of(outcomes: Iterable[Outcome]) -> dict[str, tuple[int, int]]:
    return {r.name: (r.hits, r.number) for r in score(list(outcomes)).rates}


class TunedNumbers(unittest.TestCase):
    def test_those_of_the_program(self) -> None:
        text = (ROOT / "include/eunoe/discovery/tuned.h").read_text(encoding="utf-8")
        rule = {name: float(value) for name, value in re.findall(r"double (refuted|doubtful) = ([\d.]+);", text)}
        self.assertEqual(rule, {"refuted": REFUTED, "doubtful": DOUBTFUL})
        self.assertEqual(discovery_text.REFUTED, REFUTED)


class Scores(InFolder):
    def add(self, name: str, kind: str, verdict: str, truth: dict[str, float]) -> None:
        folder = self.folder / name
        make_study(folder / "study", verdict)
        case = Case(name, kind, 1, 1, {effect: 4. for effect in truth}, [], truth)
        case.save(folder)
        (folder / "sealed").mkdir()
        (folder / "sealed" / "truth.json").write_text(json.dumps({"effects": truth, "nuisances": {}}))

    def test_rates(self) -> None:
        self.add("a", "none", "none", {})
        self.add("b", "none", "named", {})
        self.add("c", "single", "named", {"cohesion": 1.2e-4})
        self.add("d", "single", "named", {"rolling_resistance": 0.1})
        self.add("e", "single", "tie", {"rolling_resistance": 0.1})
        self.add("f", "deleted", "off catalogue", {"rolling_resistance": 0.1})
        with contextlib.redirect_stdout(io.StringIO()):
            self.assertEqual(score_script.main([str(self.folder)]), 0)
        outcomes = [outcome_of(line) for line in (read(self.folder / name, "study") for name in "abcdef") if line]
        self.assertEqual(read_lines(self.folder / "answers_study.jsonl"), outcomes)
        rates = rates_of(outcomes)
        self.assertEqual(rates["named rightly at strength 4"], (1, 3))
        self.assertEqual(rates["named wrongly at strength 4"], (1, 3))
        self.assertEqual(rates["tied with the truth at strength 4"], (1, 3))
        self.assertEqual(rates["missed at strength 4"], (0, 3))
        self.assertEqual(rates["false alarms"], (1, 2))
        self.assertEqual(rates["detection at strength 4 and more"], (3, 3))
        self.assertEqual(rates["first name correct at strength 4 and more"], (1, 3))
        self.assertEqual(rates["set covers the truth"], (2, 3))
        self.assertEqual(rates["deleted effect recognised as off the catalogue"], (1, 1))
        self.assertEqual(rates["confident and wrong"], (1, 4))
        self.assertEqual(rates["amplitude within its interval"], (1, 1))
        page = (self.folder / "scores_study.md").read_text()
        self.assertIn("1 of 2", page)
        for row in ("| nothing |  | named | cohesion |  |",
                    "| cohesion 0.00012 | 4.0 | named | cohesion | 0.00011 (9e-05 to 0.00013) |",
                    "| rolling resistance 0.1 | 4.0 | tie | cohesion, rolling resistance |  |"):
            self.assertIn(row, page)

    def test_families(self) -> None:
        answer = {"verdict": "tie", "candidates": [{"effect": "c", "confidence": 0.4}],
                  "tie": [{"effects": "c", "probability": 0.4}, {"effects": "a", "probability": 0.3},
                          {"effects": "b", "probability": 0.3}],
                  "catalogue": [{"name": "a", "family": "f"}, {"name": "b", "family": "f"},
                                {"name": "c", "family": ""}]}

        def right() -> tuple[int, int]:
            return rates_of([outcome_of(line_of(4.7, answer))])["family right, named or leading, strength 4 and more"]
        self.assertEqual(right(), (1, 1))
        answer["gaps"] = {"held-out": {"members of the tie": [{"effects": "b", "p": 1e-3}, {"effects": "c", "p": 0.2}]}}
        rates = rates_of([outcome_of(line_of(4.7, answer))])
        self.assertEqual(rates["wrong name refuted by held-out data"], (1, 2))
        self.assertEqual(rates["name of a wrong family refuted by held-out data"], (0, 1))
        answer["tie"][0]["probability"] = 0.7
        self.assertEqual(right(), (0, 1))
        answer["catalogue"] = []
        self.assertEqual(right(), (0, 0))

    def test_what_held_out_data_refute(self) -> None:
        held_out = {"members of the tie": [{"effects": "a", "p": 0.4}, {"effects": "b", "p": 1e-3},
                                           {"effects": "a + c", "p": 1e-4}, {"effects": "d", "p": 0.3}],
                    "could have refuted": [{"effects": "nothing", "p": 1e-9}, {"effects": "b", "p": 1e-3},
                                           {"effects": "e", "p": 1e-5}]}
        answer = {"verdict": "tie", "tie": [{"effects": "a"}, {"effects": "d"}], "gaps": {"held-out": held_out}}
        rates = rates_of([outcome_of(line_of(4.7, answer))])
        # Models with the true effect are not wrong names.
        self.assertEqual(rates["wrong name refuted by held-out data"], (1, 2))
        self.assertEqual(rates["any wrong model refuted by held-out data"], (2, 3))
        self.assertEqual(rates["detection at strength 2.8 to 5.7"], (1, 1))

    def test_lines_of_answers(self) -> None:
        path = self.folder / "answers.jsonl"
        with path.open("w", encoding="utf-8") as file:
            for kind, verdict, truth, named in (("two", "named", "ab", "a"), ("two", "named", "ab", "ac"),
                                                ("two", "off catalogue", "ab", ""), ("deleted", "named", "a", "b"),
                                                ("single", "off catalogue", "a", "")):
                amplitudes = [{"effect": effect, "amplitude": 1., "lower": 0.5, "upper": 1.5} for effect in named]
                line = line_of(4., {"verdict": verdict, "amplitudes": amplitudes}, kind, truth)
                file.write(json.dumps(line) + "\n")
        rates = rates_of(read_lines(path))
        # A right name of several is incomplete, not wrong; a name that is not part of the truth is
        # wrong.
        self.assertEqual(rates["confident and wrong"], (2, 5))
        self.assertEqual(rates["confident and wrong, effect deleted"], (1, 1))
        self.assertEqual(rates["two effects: both named"], (0, 3))
        self.assertEqual(rates["two effects: off the catalogue"], (1, 3))
        self.assertEqual(rates["off the catalogue although it is in it, strength 4 and more"], (1, 1))
        # Off the catalogue nothing is named or leads, although the true effect comes closest.
        self.assertEqual(rates["first name, named or leading, correct at strength 4"], (0, 1))
        self.assertEqual(rates["first name correct at strength 4 and more"], (0, 1))
        self.assertEqual(rates["two effects: first name correct"], (2, 3))
        with contextlib.redirect_stdout(io.StringIO()):
            self.assertEqual(score_script.main([str(path)]), 0)
        self.assertTrue((self.folder / "scores_answers.md").exists())

    def test_the_learning_curve(self) -> None:
        curve = [{"runs": 250, "verdict": "none", "first": "a"}, {"runs": 380, "verdict": "tie", "first": "b"},
                 {"runs": 700, "verdict": "named", "first": "a + b"}]

        def learning() -> list[tuple[int, int, int, int]]:
            return score([outcome_of(line_of(4., {"verdict": "named", "learning curve": curve}))]).learning
        self.assertEqual(learning(),
                         [(300, 1, 0, 1), (400, 1, 0, 1), (600, 1, 0, 1), (900, 1, 1, 0), (1300, 1, 1, 0),
                          (2000, 1, 1, 0)])
        curve[2]["verdict"] = "off catalogue"
        self.assertEqual(learning()[-1], (2000, 1, 0, 0))

    def test_a_truth_that_was_changed_is_not_scored(self) -> None:
        self.add("a", "single", "named", {"cohesion": 1e-4})
        (self.folder / "a" / "sealed" / "truth.json").write_text(json.dumps({"effects": {}}))
        with self.assertRaises(Failure):
            read(self.folder / "a", "study")

    def test_a_truth_that_a_study_must_not_see_is_scored(self) -> None:
        self.add("a", "single", "named", {"cohesion": 1e-4})
        (self.folder / "a" / "sealed").rename(self.folder / ".sealed_a")
        self.assertEqual(read(self.folder / "a", "study")["case"]["amplitudes"], {"cohesion": 1e-4})

    def test_wilson(self) -> None:
        # From the formula's published table: 5 of 10 and 0 of 20.
        self.assertAlmostEqual(wilson(5, 10)[0], 0.2366, places=4)
        self.assertAlmostEqual(wilson(5, 10)[1], 0.7634, places=4)
        self.assertAlmostEqual(wilson(0, 20)[1], 0.1611, places=4)


if __name__ == "__main__":
    unittest.main()
