"""Scores a suite.

Usage: contrib/tools score folder [--label NAME ...]
       contrib/tools score answers.jsonl

Of a folder that suite.py has made it opens the sealed truths and compares them with the studies'
answers, and writes scores_<label>.md, scores_<label>.csv (one row a case) and answers_<label>.jsonl into
it. The last has all that is scored, so that it can be kept without the folder; the suites on synthetic
simulators and on recorded simulations (tests/discovery) print such lines, too. Scores of lines go beside
their file.
"""

from __future__ import annotations

import json
from pathlib import Path

from eunoe.launch import Failure, parser
from eunoe.tables import as_markdown, write_csv

from .outcomes import Outcome, Scores, outcome_of, read, read_lines, score
from .strength import PILOT_AT_THE_END, Strengths


def table(head: list[str], rows: list[list[str]]) -> str:
    return as_markdown([head, *rows]) + "\n"


def truth_of(outcome: Outcome) -> str:
    effects = [f"{name.replace('_', ' ')} {value:.3g}" for name, value in outcome.case.amplitudes.items()]
    return " and ".join(effects or ["nothing"]) + (", left out of the catalogue" if outcome.case.excluded else "")


def answer_of(outcome: Outcome) -> str:
    """Names of the effects among which the answer leaves the choice, the likeliest first."""
    return ", ".join(" and ".join(sorted(name.replace("_", " ") for name in members))
                     for members in outcome.covering if members)


def interval_of(outcome: Outcome) -> str:
    """Amplitudes of the effects that are rightly named, or lead."""
    return ", ".join(f"{row['amplitude']:.3g} ({row['lower']:.3g} to {row['upper']:.3g})"
                     for name, row in outcome.amplitudes.items() if name in outcome.truth_in_catalogue)


def each_truth(outcomes: list[Outcome]) -> str:
    ordered = sorted(outcomes, key=lambda o: (o.case.kind, sorted(o.truth), o.strength))
    return table(["truth", "strength", "verdict", "answer", "amplitude of a true effect"],
                 [[truth_of(o), f"{o.strength:.1f}" if o.truth else "", o.verdict, answer_of(o), interval_of(o)]
                  for o in ordered])


def page(scores: Scores, label: str, outcomes: list[Outcome]) -> str:
    text = f"# Scores of {label}: {len(outcomes)} cases\n\n"
    text += table(["", "rate", "95 % interval (Wilson)", "cases", "target"],
                  [r.row() for r in scores.rates]) + "\n"
    text += table(["", "value"], [[name, f"{value:.3g}"] for name, value in scores.numbers.items()])
    text += "\n## Answers to each truth (one effect or none)\n\n"
    answers = sorted({answer for row in scores.confusion.values() for answer in row})
    text += table(["truth", *answers],
                  [[truth, *(str(row[a]) if row[a] else "" for a in answers)]
                   for truth, row in sorted(scores.confusion.items())])
    text += "\n## Stated confidence of the first name, and how often it was right\n\n"
    text += table(["confidence", "cases", "mean stated", "right"],
                  [[name, str(number), f"{stated:.2f}", f"{right:.2f}"]
                   for name, number, stated, right in scores.calibration])
    if scores.learning:
        text += "\n## First name right by the number of runs, strength 4 and more\n\n"
        text += table(["runs", "right", "studies that go on"],
                      [[str(runs), f"{100. * right / number:.0f} %, {right} of {number}", str(going)]
                       for runs, number, right, going in scores.learning])
    return text + "\n## Each truth\n\n" + each_truth(outcomes)


def rows_of_cases(outcomes: list[Outcome]) -> list[list]:
    return [["case", "kind", "truth", "strength", "verdict", "named", "first", "confidence", "covers", "shrink",
             "runs"],
            *([o.case.name, o.case.kind, " + ".join(sorted(o.truth)), round(o.strength, 2), o.verdict,
               " + ".join(sorted(o.named)), o.first, o.confidence.get(o.first, 0.), o.covers,
               "" if o.shrink is None else o.shrink, o.runs] for o in outcomes)]


def measure_strengths(lines: list[dict], suite: Path) -> None:
    """Strengths of the truths as the suite's last study knows them."""
    pilot = suite / "pilot" / PILOT_AT_THE_END
    if not (pilot / "discovery.json").exists():
        return
    known = Strengths(pilot)
    for line in lines:
        case = line["case"]
        for name, value in case["amplitudes"].items():
            if known.knows(name, value - known.null.get(name, 0.)):
                case["strengths"][name] = known.strength(name, value)


def write(outcomes: list[Outcome], label: str, folder: Path) -> None:
    text = page(score(outcomes), label, outcomes)
    (folder / f"scores_{label}.md").write_text(text, encoding="utf-8")
    write_csv(folder / f"scores_{label}.csv", rows_of_cases(outcomes))
    print(text)


def main(words: list[str]) -> int:
    arguments = parser(__doc__)
    arguments.add_argument("suite", type=Path)
    arguments.add_argument("--label", action="append", default=[])
    options = arguments.parse_args(words)
    suite = options.suite
    if suite.is_file():
        write(read_lines(suite), suite.stem, suite.parent)
        return 0
    for label in options.label or ["study"]:
        lines = [line for line in (read(path, label) for path in sorted(suite.iterdir())
                                   if path.is_dir() and path.name != "pilot") if line is not None]
        if not lines:
            raise Failure(f"There are no finished studies '{label}' in {suite}.")
        measure_strengths(lines, suite)
        (suite / f"answers_{label}.jsonl").write_text("".join(json.dumps(line) + "\n" for line in lines),
                                                      encoding="utf-8")
        write([outcome_of(line) for line in lines], label, suite)
    return 0

