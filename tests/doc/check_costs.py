"""The costs of cases (particles, steps, core-hours) in the tables of cluster.md and
powder_spreading.md are those that --check prints now, to the digits that the pages give.

Usage: check_costs.py path/to/many-runs
"""

from __future__ import annotations

import re
import sys
import tempfile
from functools import lru_cache
from pathlib import Path

from eunoe.launch import Failure, overrides
from many_runs import ManyRuns

ROOT = Path(__file__).resolve().parents[2]
NUMBER = r"([\d.,]+(?:e[+-]?\d+)?)"
PRINTED = {"particles": rf"particles:\s+{NUMBER} at most", "steps": rf"steps:\s+{NUMBER} of",
           "core-hours": rf"core-hours:\s+about {NUMBER}"}
UNITS = {"": 1., "thousand": 1e3, "million": 1e6}
PROCEDURE = "powder spreading/feedstock "


@lru_cache(maxsize=None)
def costs(program: ManyRuns, case: str, *settings: str) -> dict[str, float]:
    """The costs that --check prints for a case of prm/spreading."""
    done = program(f"prm/spreading/{case}.prm", "--check", *overrides(settings), cwd=ROOT)
    found = {name: re.search(pattern, done.stdout) for name, pattern in PRINTED.items()}
    if done.returncode != 0 or None in found.values():
        raise Failure(f"{case} {settings}: no costs in\n{done.stdout}{done.stderr}")
    return {name: float(match[1].replace(",", "")) for name, match in found.items()}


def agrees(text: str, value: float) -> bool:
    """Whether a page's number, such as '41 million', is the value rounded to the page's digits."""
    digits, _, unit = text.partition(" ")
    _, _, decimals = digits.partition(".")
    # In a whole number, trailing zeros may come from rounding; estimates have at least two digits.
    zeros = len(digits) - len(digits.rstrip("0")) if not decimals else 0
    power = min(zeros, max(len(digits) - 2, 0)) if zeros else -len(decimals)
    # Half of the last digit, and a little more because the program rounds, too.
    return abs(float(digits) * UNITS[unit] - value) <= 0.51 * 10.**power * UNITS[unit]


def rows(page: str, head: str) -> list[list[str]]:
    """The cells of the table with this head."""
    lines = (ROOT / "doc" / page).read_text(encoding="utf-8").splitlines()
    if lines.count(head) != 1:
        raise Failure(f"doc/{page}: there should be one table with the head {head}")
    found = []
    for line in lines[lines.index(head) + 2:]:
        if not line.startswith("|"):
            break
        found.append([cell.strip() for cell in line.strip("|").split("|")])
    return found


class Comparison:
    def __init__(self, program: ManyRuns) -> None:
        self.program = program
        self.wrong: list[str] = []
        self.number = 0

    def compare(self, page: str, said: dict[str, str], case: str, *settings: str) -> None:
        found = costs(self.program, case, *settings)
        for name, text in said.items():
            self.number += 1
            if not agrees(text, found[name]):
                self.wrong.append(f"doc/{page}: {case} {' '.join(settings)}: {text} {name}, "
                                  f"--check says {found[name]:g}")


def compare_all(program: ManyRuns) -> Comparison:
    result = Comparison(program)
    names = ("particles", "steps", "core-hours")
    for case, *cells in rows("cluster.md", "| case | particles at most | steps | core-hours |"):
        result.compare("cluster.md", dict(zip(names, cells)), case.strip("`"))
    page = "powder_spreading.md"
    for files, *_, takes in rows(page, "| file in `prm/spreading` | powder | plate | layers | takes |"):
        if takes.endswith(" core-hours"):
            for case in re.findall(r"`(\w+)(?:\.prm)?`", files):
                result.compare(page, {"core-hours": takes.removesuffix(" core-hours")}, case)
    for length, *cells in rows(page, "| | 11 mm/s | 2 mm/s |"):
        for velocity, cell in zip(("11e-3", "2e-3"), cells):
            result.compare(page, dict(zip(names[1:], cell.split(", "))), f"PS1_{length}",
                           f"{PROCEDURE}platform velocity = {velocity}")
    for margin, *cells in rows(page, "| `feedstock margin` | particles at most | steps | core-hours |"):
        result.compare(page, dict(zip(names, cells)), "PS1_L4",
                       f"{PROCEDURE}margin = {margin.strip('`')}")
    return result


def main(program: str) -> int:
    with tempfile.TemporaryDirectory() as folder:
        particles = ManyRuns(program, Path(folder))
        try:
            result = compare_all(particles)
        except Failure as failure:
            print(failure)
            return 1
        finally:
            particles.close()
    print("\n".join(result.wrong) if result.wrong else f"{result.number} numbers agree")
    return 1 if result.wrong or result.number < 41 else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
