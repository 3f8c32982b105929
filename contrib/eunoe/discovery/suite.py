"""Makes a blind suite: hidden truths, their data, and a study of each.

Usage: contrib/tools suite path/to/eunoe-discovery study.prm folder [--tier ci|small|full|range]
       [--seeds ci|development|reported|again|third|fourth|fifth|sixth] [--study-seeds N] [--ranks N] [--label NAME]
       [--set "discovery/entry = value" ...] [--part I/N]

A pilot study of data in which nothing is missing says how strong each effect is; the strengths of the
suite are amplitudes from it. It must have simulated all that is hidden; if its budget is too small for
that, fill the table first. Then the twins are made, then the studies, and in the end the pilot's study
once more, as the table knows more by then: scores are by the strengths that this one finds. What is there
already is not made again, and what was interrupted goes on, so the command may be given again at any time; what
another command is making is left out.
--label keeps the studies of an ablation beside the others: they use the same data. score.py makes the tables.

Thresholds are tuned on development seeds only; the reported suite is made afterwards, and once what it
shows has changed the rules, one of the seeds "again", then of the "third" to the "sixth".
"""

from __future__ import annotations

import argparse
import math
import shutil
import sys
from pathlib import Path

from eunoe.folders import alone_with
from eunoe.launch import Failure, overrides, parser

from .case import FIRST_SEED, TIERS, Case, make_cases
from .program import Program, Stopped
from .strength import PILOT_AT_THE_END, Strengths

TRUTH = """include {study}

subsection discovery
  set measured data = ../measured.csv
end
subsection twin
  set effects     = {effects}
  set seed        = {seed}
  set sealed file = truth.json
{more}end
"""


def parse(words: list[str]) -> argparse.Namespace:
    arguments = parser(__doc__)
    arguments.add_argument("program", type=Path)
    arguments.add_argument("study", type=Path, help="study file; its measured data are not used")
    arguments.add_argument("folder", type=Path)
    arguments.add_argument("--tier", choices=TIERS, default="small")
    arguments.add_argument("--seeds", choices=FIRST_SEED, default="development")
    arguments.add_argument("--study-seeds", type=int, default=1, metavar="N",
                        help="different seeds of studies; with one, studies share most of their runs")
    arguments.add_argument("--ranks", type=int, default=1)
    arguments.add_argument("--label", default="study", help="name of this set of studies")
    arguments.add_argument("--set", action="append", default=[], metavar="ENTRY",
                        help="entry of the study, such as an ablation")
    arguments.add_argument("--twin", action="append", default=[], metavar="ENTRY",
                        help="entry of the twins, such as 'overrides = powder spreading/depth = 4e-4'")
    arguments.add_argument("--only", default="", help="only cases whose name contains this")
    arguments.add_argument("--part", type=part, default=(1, 1), metavar="I/N",
                           help="only the I-th case of each N, so that N commands may share a suite once its "
                                "pilot is done")
    return arguments.parse_args(words)


def part(text: str) -> tuple[int, int]:
    number, of = (int(word) for word in text.split("/"))
    if not 1 <= number <= of:
        raise ValueError(text)
    return number, of


class Busy(Failure):
    """Another command is at it."""


class Suite:
    def __init__(self, options: argparse.Namespace) -> None:
        self.options = options
        self.program = Program(options.program, options.ranks)
        self.folder = options.folder.resolve()
        self.study = options.study.resolve()
        self.failed: list[str] = []
        self.deleted: list[dict[str, float]] = []

    def make_data(self, case: Case, lock: int) -> Path:
        folder = self.folder / case.name
        if (folder / "measured.csv").exists():
            return folder
        (folder / "sealed").mkdir(parents=True, exist_ok=True)
        effects = ", ".join(f"{name}: {amplitude!r}" for name, amplitude in case.amplitudes.items())
        more = "".join(f"  set {entry}\n" for entry in self.options.twin)
        truth = folder / "sealed" / "truth.prm"
        truth.write_text(TRUTH.format(study=self.study, effects=effects, seed=case.seed, more=more),
                         encoding="utf-8")
        case.save(folder)
        (folder / "sealed" / "truth.json").unlink(missing_ok=True)
        self.program.run(["--make-twin", str(truth)], folder / "twin.log", lock)
        return folder

    def make_study(self, case: Case, folder: Path, label: str, settings: list[str], lock: int) -> None:
        target = folder / label
        sealed, away = folder / "sealed", self.folder / f".sealed_{case.name}"
        if away.exists() and not sealed.exists():  # the last command was killed
            away.rename(sealed)
        if (target / "discovery.json").exists():
            return
        entries = [f"discovery/measured data = {folder / 'measured.csv'}",
                   f"discovery/output path = {target}",
                   f"discovery/table of runs = {self.folder / 'runs.sqlite'}",
                   f"discovery/seed = {case.study_seed}",
                   "discovery/write page = false", *settings]
        if case.excluded:
            entries.append(f"discovery/excluded effects = {', '.join(case.excluded)}")
        # The study must not be able to read the truth.
        if sealed.exists():
            sealed.rename(away)
        try:
            self.program.run([str(self.study), *overrides(entries)], folder / f"{label}.log", lock)
        except Failure as error:
            print(f"  {error}")
            self.failed.append(case.name)
            shutil.rmtree(target, ignore_errors=True)
        finally:
            if away.exists():
                away.rename(sealed)

    def pilot(self, label: str, settings: list[str]) -> Strengths:
        first = FIRST_SEED[self.options.seeds]
        case = Case("pilot", "none", first - 1, first // 100)
        if not (self.folder / case.name / label / "discovery.json").exists():
            self.make(case, label, settings)
        return Strengths(self.folder / case.name / label)

    def make(self, case: Case, label: str, settings: list[str]) -> None:
        """Data and study of a case."""
        with alone_with(self.folder / f"{case.name}.lock") as lock:
            if lock is None:
                raise Busy(f"Another command is making {case.name} in {self.folder}.")
            self.make_study(case, self.make_data(case, lock), label, settings, lock)

    def run(self) -> None:
        effects = self.program.effects(self.study)
        if not effects:
            raise Failure("The study has no effects.")
        print("pilot", flush=True)
        is_ablation = self.options.label != "study"
        strengths = self.pilot("study", [] if is_ablation else self.options.set)
        number, of = self.options.part
        cases = make_cases(effects, self.options.tier, self.options.seeds, self.options.study_seeds)
        wanted = [case for case in cases if self.options.only in case.name]
        self.refuse_unready_pilot(wanted, strengths)
        wanted = [case for case in wanted if self.gives_amplitudes(case, strengths)]
        for case in wanted:
            if cases.index(case) % of != number - 1:
                continue
            print(case.name, flush=True)
            try:
                self.make(case, self.options.label, self.options.set)
            except Busy as error:
                print(f"  {error}")
            except Failure as error:
                print(f"  {error}")
                self.failed.append(case.name)
        # All is scored by the strengths that the studies themselves find when the table is full.
        answered = all((self.folder / case.name / "study" / "discovery.json").exists() or case.name in self.failed
                       for case in wanted)
        if answered and not self.options.only and not is_ablation:
            self.pilot(PILOT_AT_THE_END, self.options.set)

    def refuse_unready_pilot(self, cases: list[Case], strengths: Strengths) -> None:
        """Failure if the pilot has not simulated all that shall be hidden: how strong that can be is not known, and
        a suite without it would be another one."""
        missing = {f"{name} {'above' if value > 0. else 'below'} its null value" for case in cases
                   for name, value in case.strengths.items()
                   if not strengths.knows(name, value) and not strengths.why_unknown(name, value)}
        if missing:
            table = self.folder / "runs.sqlite"
            raise Failure(f"The pilot is not ready: its runs were spent before it had simulated "
                          f"{', '.join(sorted(missing))}. Fill its table ({self.program.path.name} {self.study} "
                          f"--fill-table --set \"discovery/table of runs = {table}\"), remove "
                          f"{self.folder / 'pilot' / 'study'}, and give this command again.")

    def gives_amplitudes(self, case: Case, strengths: Strengths) -> bool:
        """Amplitudes from strengths; false if an effect cannot be so strong, or the pilot does not know it."""
        unknown = [f"{name} {strengths.why_unknown(name, value)}" for name, value in case.strengths.items()
                   if not strengths.knows(name, value)]
        if unknown:
            print(f"{case.name}: left out, as by the pilot {', '.join(unknown)}")
            return False
        found = {name: strengths.amplitude(name, value) for name, value in case.strengths.items()}
        weak = [name for name, (_, reached) in found.items() if reached < abs(case.strengths[name])]
        if weak and (not TIERS[self.options.tier].drawn or min(s for _, s in found.values()) == 0.):
            print(f"{case.name}: left out, as {', '.join(weak)} cannot be so strong in its range")
            return False
        for name, (amplitude, reached) in found.items():
            case.amplitudes[name] = amplitude
            case.strengths[name] = math.copysign(reached, case.strengths[name])
        if case.kind == "deleted":
            if case.amplitudes in self.deleted:  # at the end of its range
                print(f"{case.name}: left out, as its truth was deleted in an earlier case")
                return False
            self.deleted.append(case.amplitudes)
        return True


def main(words: list[str]) -> int:
    suite = Suite(parse(words))
    suite.folder.mkdir(parents=True, exist_ok=True)
    try:
        suite.run()
    except (KeyboardInterrupt, Stopped):
        print("Stopped; the same command goes on.")
        return 3
    if suite.failed:
        print(f"{len(suite.failed)} studies failed: {', '.join(suite.failed)}", file=sys.stderr)
    return 1 if suite.failed else 0

