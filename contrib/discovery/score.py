#!/usr/bin/env python3
"""Scores a suite.

Usage: contrib/discovery/score.py folder [--label NAME ...]
       contrib/discovery/score.py answers.jsonl

Of a folder that suite.py has made it opens the sealed truths and compares them with the studies'
answers, and writes scores_<label>.md and scores_<label>.csv (one row a case) into it. The suites on
synthetic laboratories and on recorded simulations (tests/discovery) print truths and answers as lines
of JSON instead; their scores go beside that file.
"""

from __future__ import annotations

import argparse
import csv
import sys
from pathlib import Path

from eunoe_suite.score import Outcome, Scores, read, read_lines, score


def table(head: list[str], rows: list[list[str]]) -> str:
    lines = ["| " + " | ".join(row) + " |" for row in [head, ["---"] * len(head), *rows]]
    return "\n".join(lines) + "\n"


def page(scores: Scores, label: str, n: int) -> str:
    text = f"# Scores of {label}: {n} cases\n\n"
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
    return text


def write_cases(path: Path, outcomes: list[Outcome]) -> None:
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["case", "kind", "truth", "strength", "verdict", "named", "first", "confidence",
                         "covers", "shrink", "runs"])
        for o in outcomes:
            writer.writerow([o.case.name, o.case.kind, " + ".join(sorted(o.truth)), o.strength, o.verdict,
                             " + ".join(sorted(o.named)), o.first, o.confidence.get(o.first, 0.),
                             o.covers, "" if o.shrink is None else o.shrink, o.runs])


def write(outcomes: list[Outcome], label: str, folder: Path) -> None:
    text = page(score(outcomes), label, len(outcomes))
    (folder / f"scores_{label}.md").write_text(text, encoding="utf-8")
    write_cases(folder / f"scores_{label}.csv", outcomes)
    print(text)


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("suite", type=Path)
    parser.add_argument("--label", action="append", default=[])
    options = parser.parse_args(arguments)
    suite = options.suite
    if suite.is_file():
        write(read_lines(suite), suite.stem, suite.parent)
        return 0
    for label in options.label or ["study"]:
        outcomes = [o for o in (read(path, label) for path in sorted(suite.iterdir())
                                if path.is_dir() and path.name != "pilot") if o is not None]
        if not outcomes:
            print(f"There are no finished studies '{label}' in {suite}.", file=sys.stderr)
            return 1
        write(outcomes, label, suite)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
