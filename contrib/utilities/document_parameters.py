#!/usr/bin/env python3
"""Writes doc/parameters.md, or doc/study_parameters.md: every entry of a program's input file with its
default, its kind and its documentation, as the program itself states them.

Usage: contrib/utilities/document_parameters.py path/to/eunoe-particles|eunoe-discovery [--check]

Names, defaults and documentation come from --print-parameters. That does not tell what values an
entry takes, so some of every kind are tried: the program names all that do not fit.

Exit code 1 with --check if the file is out of date; 0 otherwise.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Subject:
    """A program whose input is documented."""

    page: Path
    head: str
    counts: dict[str, str]  # one of each of the numbered subsections
    # Entries whose defaults the program refuses, as the user has to choose. Their defaults stand beside
    # these values in what it prints.
    chosen: dict[str, str]
    check: tuple[str, ...]  # arguments that have a file checked


HEAD = """# {title}

All entries of {what}. {link} says how such a file is written. This page is
written by `contrib/utilities/document_parameters.py` from what the program says of itself: do not
edit it. A complete input file with the same texts comes from

```sh
{program} --print-parameters
```

Subsections that end in a number are repeated: the first entry of the section around them says how
often, and they are numbered from 0. They are shown once, as number 0. Values are in SI units.
"""

SUBJECTS = {
    "eunoe-particles": Subject(
        ROOT / "doc" / "parameters.md",
        HEAD.format(title="Parameters", what="the input file", link="[input.md](input.md)",
                    program="eunoe-particles"),
        {"lagrangian physical properties/number of wall materials": "1",
         "DEM boundary conditions/number of boundary conditions": "1",
         "box refinement/number of refinement boxes": "1",
         "floating walls/number of floating walls": "1",
         "solid objects/solid surfaces/number of solids": "1"},
        {"lagrangian physical properties/wall material 0/surfaces": "floating wall",
         "floating walls/wall 0/end time": "1",
         "solid objects/solid surfaces/solid object 0/mesh/type": "shape"},
        ("--check",)),
    "eunoe-discovery": Subject(
        ROOT / "doc" / "study_parameters.md",
        HEAD.format(title="Parameters of a study", what="the study file of eunoe-discovery",
                    link="[discovery.md](discovery.md)", program="eunoe-discovery"),
        {"discovery/number of experiments": "1", "discovery/number of nuisances": "1"}, {},
        ("--check", "--make-twin")),
}


@dataclass
class Entry:
    path: tuple[str, ...]
    name: str
    default: str
    documentation: str

    @property
    def key(self) -> str:
        return "/".join((*self.path, self.name))


def run(program: str, *arguments: str) -> tuple[int, str]:
    done = subprocess.run([program, *arguments], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def subject_of(program: str) -> Subject:
    return SUBJECTS[Path(program).name]


def read_entries(program: str) -> list[Entry]:
    subject = subject_of(program)
    overrides = []
    for key, value in {**subject.counts, **subject.chosen}.items():
        overrides += ["--set", f"{key} = {value}"]
    code, text = run(program, "--print-parameters", *overrides)
    if code != 0:
        sys.exit(f"{program} --print-parameters failed:\n{text}")
    entries: list[Entry] = []
    path: list[str] = []
    comment: list[str] = []
    for line in map(str.strip, text.splitlines()):
        if line == "# Listing of Parameters" or line.startswith("# ----"):
            continue
        if line.startswith("#"):
            comment.append(line.lstrip("# ").strip())
            continue
        if line.startswith("subsection "):
            path.append(" ".join(line.split()[1:]))
        elif line == "end":
            path.pop()
        elif line.startswith("set "):
            name, value = line[4:].split("=", 1)
            value, *default = re.split(r"\s# default:", value)
            entry = Entry(tuple(path), " ".join(name.split()),
                          (default[0] if default else value).strip(), " ".join(comment).strip())
            if entry.key in subject.counts:
                entry.default = "0"
            entries.append(entry)
        comment = []
    return entries


def refused(program: str, trials: list[tuple[str, str]]) -> set[tuple[str, str]]:
    """Those of the trials (entry, value) whose value the program says does not fit."""
    lines = []
    at: dict[int, tuple[str, str]] = {}
    for key, value in [*subject_of(program).counts.items(), *trials]:
        *path, name = key.split("/")
        lines += [f"subsection {p}" for p in path]
        lines.append(f"set {name} = {value}")
        at[len(lines)] = (key, value)
        lines += ["end"] * len(path)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "trials.prm"
        file.write_text("\n".join(lines) + "\n")
        _, text = run(program, *subject_of(program).check, str(file))
    return {at[int(line)] for line in
            re.findall(r"trials\.prm:(\d+): [^\n]*which does not fit", text)}


def words_of_the_code(entries: list[Entry]) -> list[str]:
    """All that may be a choice: short texts of the code, alone or with bars between them."""
    names = {entry.name for entry in entries}
    words = set()
    for file in (ROOT / "source").rglob("*.cc"):
        for literal in re.findall(r'"([A-Za-z][\w |]*)"', file.read_text(encoding="utf-8")):
            words.update(literal.split("|"))
    return sorted(word for word in words - names
                  if word == word.strip() != "" and len(word.split()) <= 2)


NUMBERS = ("-1", "0", "0.5", "1", "1.5", "50")
LISTS = {"0.5, 0.5": "numbers", "0.5, 0.5, 0.5": "three numbers", "0, 1, 2": "three whole numbers",
         "0, 0, 0 : 1, 1, 1": "two points"}


def kind_of_number(fits: set[str]) -> str:
    """In words, of what takes these of NUMBERS."""
    kind = "number" if fits & {"0.5", "1.5"} else "whole number"
    if "-1" not in fits:
        kind += " of at least 0" if "0" in fits else \
            " above 0" if "0.5" in fits else " of at least 1" if "1" in fits else " above 1"
    if "50" not in fits and kind.startswith("number"):
        kind += f", at most {max(fits, key=float)}"
    return kind


def read_kinds(program: str, entries: list[Entry]) -> dict[str, str]:
    """The kinds of all entries in words, found by trying values."""
    values = ("?", "true", *NUMBERS, *LISTS)
    wrong = refused(program, [(entry.key, value) for entry in entries for value in values])
    kinds: dict[str, str] = {}
    for entry in entries:
        fits = {value for value in values if (entry.key, value) not in wrong}
        lists = [words for value, words in LISTS.items() if value in fits]
        if "?" in fits:
            kinds[entry.key] = "text"
        elif "true" in fits:
            kinds[entry.key] = "`true` or `false`"
        elif lists:
            kinds[entry.key] = lists[0]
        elif fits:
            kinds[entry.key] = kind_of_number(fits & set(NUMBERS))
    choices = [entry.key for entry in entries if entry.key not in kinds]
    words = words_of_the_code(entries)
    wrong = refused(program, [(key, word) for key in choices for word in words])
    for key in choices:
        kinds[key] = ", ".join(f"`{word}`" for word in words if (key, word) not in wrong)
    return kinds


def cell(text: str) -> str:
    return text.replace("|", "\\|")


def page(head: str, entries: list[Entry], kinds: dict[str, str]) -> str:
    text = head
    sections: dict[tuple[str, ...], list[Entry]] = {}
    for entry in entries:
        sections.setdefault(entry.path, []).append(entry)
    for path, listed in sections.items():
        title = " / ".join(path) if path else "Outside of all subsections"
        text += f"\n## {title}\n\n| Entry | Default | Value | Meaning |\n|---|---|---|---|\n"
        for entry in listed:
            default = f"`{entry.default}`" if entry.default else "(empty)"
            text += (f"| `{entry.name}` | {cell(default)} | {cell(kinds[entry.key])} "
                     f"| {cell(entry.documentation)} |\n")
    return text


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", 1)[0])
    parser.add_argument("program", help="eunoe-particles or eunoe-discovery")
    parser.add_argument("--check", action="store_true",
                        help="change nothing, and fail if the page is out of date")
    options = parser.parse_args()
    entries = read_entries(options.program)
    subject = subject_of(options.program)
    text = page(subject.head, entries, read_kinds(options.program, entries))
    if not options.check:
        subject.page.write_text(text, encoding="utf-8")
        return 0
    if not subject.page.exists() or subject.page.read_text(encoding="utf-8") != text:
        print(f"{subject.page} is out of date: run {Path(__file__).name} with the program.")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
