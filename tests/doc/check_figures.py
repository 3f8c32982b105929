"""Figures of the documentation say where they come from: beside every table of measured numbers a
sentence "made by ... at revision ..." names the command and the revision, and the processor where
the table gives speeds; every picture in doc/ belongs to a rule of contrib/tools pictures and is
what that rule made.

A table is exempt if its head says that it explains (entries and their meaning, columns, options) and no
cell has a mean with its deviation.

Usage: check_figures.py
"""

from __future__ import annotations

import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
from eunoe.pictures.record import digest, read_record
from eunoe.pictures.rules import RULES
from eunoe.reproduction.pictures import RULE as CAMPAIGN

EXPLAINING = {"meaning", "means", "holds", "keys", "task", "what it does", "what to do", "what differs",
              "what may be behind it", "what is at work", "shares out", "particles come", "formula", "why",
              "effect to expect", "it says", "how Eunoe avoids it", "test", "read", "rule"}
MADE_BY = re.compile(r"\b[Mm]ade by (?P<command>(?:[^.]|\.(?=\S))*?) at revisions? "
                     r"(?P<revisions>[0-9a-f]{7}\b(?:(?:, | and )[0-9a-f]{7}\b)*)"
                     r"(?P<processor> on an? (?:AMD|Intel)\b)?")
SPEED = re.compile(r"particle-steps/s|core-hours|\bloop\b|\d (?:s|minutes?|hours?) \|")
PROGRAM_FILE = re.compile(r"(?:^|[\s`])((?:contrib|prm|tests)/[\w./*-]+)")


@dataclass(frozen=True)
class Table:
    """One table, or several with nothing but blank lines between them."""

    page: Path
    line: int
    head: list[str]
    body: str
    beside: str  # the paragraphs before and after

    @property
    def measured(self) -> bool:
        explains = not EXPLAINING.isdisjoint(self.head) or not any(self.head[1:])
        return not explains or "±" in self.body


def cells(line: str) -> list[str]:
    return [cell.strip() for cell in line.strip().strip("|").split("|")]


def tables(page: Path) -> list[Table]:
    text = re.sub(r"^```.*?^```", lambda block: re.sub(r"[^\n]+", "CODE", block[0]),
                  page.read_text(encoding="utf-8"), flags=re.M | re.S)
    found = []
    # Blocks are separated by blank lines; a heading is a block, too.
    blocks, line = [], 1
    for part in re.split(r"(\n\s*\n)", text):
        if part.strip():
            blocks.append((line, part.strip("\n")))
        line += part.count("\n")
    is_table = [block.lstrip().startswith("|") or "\n|" in block for _, block in blocks]
    for k, (line, block) in enumerate(blocks):
        if not is_table[k]:
            continue
        rows = [row for row in block.splitlines() if row.startswith("|")]
        first, last = k, k
        while first > 0 and is_table[first - 1]:
            first -= 1
        while last + 1 < len(blocks) and is_table[last + 1]:
            last += 1
        beside = [blocks[n][1] for n in (first - 1, last + 1) if 0 <= n < len(blocks)]
        prose = [row for row in block.splitlines() if not row.startswith("|")]
        found.append(Table(page, line, cells(rows[0]), "\n".join(rows[2:]),
                           " ".join("\n".join([*beside, *prose]).split())))
    return found


def known_revisions(revisions: set[str]) -> set[str]:
    """Those that the repository has; all of them where git cannot tell."""
    def git(*words: str) -> subprocess.CompletedProcess:
        return subprocess.run(["git", "-C", str(ROOT), *words], capture_output=True, text=True, check=False)

    try:
        if git("rev-parse", "--is-shallow-repository").stdout.strip() != "false":
            return revisions
    except OSError:
        return revisions
    return {name for name in revisions if git("cat-file", "-e", f"{name}^{{commit}}").returncode == 0}


def check_table(table: Table, revisions: dict[str, str]) -> list[str]:
    place = f"{table.page.relative_to(ROOT)}:{table.line}: "
    origins = list(MADE_BY.finditer(table.beside))
    if not origins:
        return [place + "no sentence beside the table says 'Made by ... at revision ...'."]
    wrong = []
    for origin in origins:
        command = origin["command"]
        if "`" not in command and not re.search(r"\bcommands? above\b", command):
            wrong.append(place + f"'Made by {command}' names no command.")
        for file in PROGRAM_FILE.findall(command):
            if not list(ROOT.glob(file)):
                wrong.append(place + f"the command names {file}, which does not exist.")
        for name in re.findall(r"[0-9a-f]{7}", origin["revisions"]):
            revisions.setdefault(name, place)
    if SPEED.search(" ".join(table.head) + table.body) and not any(o["processor"] for o in origins):
        wrong.append(place + "a table of speeds says on which processor: 'at revision ... on an AMD ...'.")
    return wrong


def check_tables() -> list[str]:
    wrong: list[str] = []
    revisions: dict[str, str] = {}
    generated = {"parameters.md", "study_parameters.md"}
    pages = [ROOT / "README.md", *(p for p in sorted((ROOT / "doc").glob("*.md")) if p.name not in generated)]
    measured = [table for page in pages for table in tables(page) if table.measured]
    for table in measured:
        wrong += check_table(table, revisions)
    for name in sorted(set(revisions) - known_revisions(set(revisions))):
        wrong.append(revisions[name] + f"there is no revision {name}.")
    if len(measured) < 10:
        wrong.append(f"Only {len(measured)} tables of measured numbers were found.")
    return wrong


def check_pictures() -> list[str]:
    folder = ROOT / "doc" / "pictures"
    files = {file.name for file in (ROOT / "doc").rglob("*") if file.suffix in (".png", ".svg", ".jpg")}
    rules = [picture for rule in RULES for picture in rule.pictures]
    pages = "".join(page.read_text(encoding="utf-8") for page in
                    [ROOT / "README.md", *(ROOT / "doc").glob("*.md")])
    record = read_record(folder)
    rule_of = {picture: rule.name for rule in RULES for picture in rule.pictures}
    # The campaign draws what the runs that have finished allow.
    of_campaign = [name for name, entry in record.items() if entry.rule == CAMPAIGN]
    rule_of.update({name: CAMPAIGN for name in of_campaign})
    rules += of_campaign
    wrong = [f"No rule of contrib/tools pictures makes {name}." for name in sorted(files - set(rules))]
    wrong += [f"{name} has more than one rule." for name in sorted(set(rules)) if rules.count(name) > 1]
    wrong += [f"The picture {name} of the rule {rule_of[name]} is not in doc/pictures."
              for name in sorted(set(rules) - files)]
    wrong += [f"No page shows {name}." for name in sorted(set(rules)) if f"pictures/{name})" not in pages]
    wrong += [f"doc/pictures/README.md names {name}, which does not exist."
              for name in sorted(set(record) - files)]
    for name in sorted(files & set(rules)):
        entry = record.get(name)
        if entry is None or entry.rule != rule_of[name]:
            wrong.append(f"doc/pictures/README.md does not say that the rule {rule_of[name]} made {name}.")
        elif entry.digest != digest(folder / name):
            wrong.append(f"{name} is not what its rule made: its digest differs from doc/pictures/README.md.")
    revisions = {name for entry in record.values() for name in entry.revisions}
    return wrong + [f"doc/pictures/README.md: there is no revision {name}."
                    for name in sorted(revisions - known_revisions(revisions))]


def main() -> int:
    wrong = check_tables() + check_pictures()
    print("\n".join(wrong) if wrong else "ok")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
