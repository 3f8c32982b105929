#!/usr/bin/env python3
"""Writes doc/parameters.md: every entry of the input file with its default, its kind and its
documentation, as the program itself states them.

Usage: contrib/utilities/document_parameters.py path/to/eunoe-particles [--check]

Names, defaults and documentation come from --print-parameters. That does not tell the kind of a
value; the message with which the program refuses a wrong one does, so every entry is given a wrong
one, all at once.

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

PAGE = Path(__file__).resolve().parents[2] / "doc" / "parameters.md"

# One of each of the numbered subsections.
COUNTS = {
    "DEM boundary conditions/number of boundary conditions": "1",
    "floating walls/number of floating walls": "1",
    "solid objects/solid surfaces/number of solids": "1",
}
# Entries whose defaults the program refuses, as the user has to choose: what to give instead. The
# default is then what stands beside the value.
CHOSEN = {
    "floating walls/wall 0/end time": ("1", "0"),
    "solid objects/solid surfaces/solid object 0/mesh/type": ("shape", "gmsh"),
}
NONSENSE = "?"

HEAD = """# Parameters

All entries of the input file. [input.md](input.md) says how such a file is written. This page is
written by `contrib/utilities/document_parameters.py` from what the program says of itself: do not
edit it. A complete input file with the same texts comes from

```sh
eunoe-particles --print-parameters
```

Subsections that end in a number are repeated: the first entry of the section around them says how
often, and they are numbered from 0. They are shown once, as number 0. Values are in SI units.
"""


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


def read_entries(program: str) -> list[Entry]:
    overrides = []
    for key, value in {**COUNTS, **{k: v[0] for k, v in CHOSEN.items()}}.items():
        overrides += ["--set", f"{key} = {value}"]
    code, text = run(program, "--print-parameters", *overrides)
    if code != 0:
        sys.exit(f"{program} --print-parameters failed:\n{text}")
    entries: list[Entry] = []
    path: list[str] = []
    comment: list[str] = []
    for line in map(str.strip, text.splitlines()):
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
            if entry.key in COUNTS:
                entry.default = "0"
            elif entry.key in CHOSEN:
                entry.default = CHOSEN[entry.key][1]
            entries.append(entry)
        comment = []
    return entries


def read_patterns(program: str, entries: list[Entry]) -> dict[str, str]:
    """What the program asks for where it is given nonsense; texts accept anything and are missing."""
    lines = []
    for path, name, value in ([(*key.split("/")[:-1],), key.split("/")[-1], value]
                              for key, value in COUNTS.items()):
        lines += [f"subsection {p}" for p in path] + [f"set {name} = {value}"] + ["end"] * len(path)
    at: dict[int, str] = {}
    for entry in entries:
        lines += [f"subsection {p}" for p in entry.path]
        lines.append(f"set {entry.name} = {NONSENSE}")
        at[len(lines)] = entry.key
        lines += ["end"] * len(entry.path)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "nonsense.prm"
        file.write_text("\n".join(lines) + "\n")
        _, text = run(program, str(file), "--check")
    patterns = {}
    for line in text.splitlines():
        found = re.search(r"nonsense\.prm:(\d+): .*which does not fit\.\s*(?:Give (.*)\.)?$", line)
        if found:
            patterns[at[int(found[1])]] = found[2] or ""
    return patterns


def limits(low: str, high: str) -> str:
    """ "from 0", "0 to 5", or nothing."""
    has_low = low not in ("", "-MAX_DOUBLE", "-2147483648")
    has_high = high not in ("", "MAX_DOUBLE", "2147483647", "4294967295", "18446744073709551615")
    if has_low and has_high:
        return f", {low} to {high}"
    if has_low:
        return f", at least {low}"
    return f", at most {high}" if has_high else ""


def kind(pattern: str) -> str:
    """A pattern of deal.II in words."""
    pattern = pattern.strip().strip("[]").strip()
    if pattern == "":
        return "text"
    if pattern.startswith("Bool"):
        return "true or false"
    found = re.match(r"(?:DirectoryName|FileName|Anything)", pattern)
    if found:
        return "text"
    found = re.match(r"Selection\s+(.*)$", pattern)
    if found:
        return " or ".join(f"`{word.strip()}`" for word in found[1].split("|"))
    found = re.match(r"(Double|Integer)(?: range)?\s*(\S*?)\.\.\.(\S*)\s*(?:\(inclusive\))?$", pattern)
    if found:
        return ("number" if found[1] == "Double" else "whole number") + limits(found[2], found[3])
    if re.match(r"(Double|Integer)", pattern):
        return "number" if pattern.startswith("Double") else "whole number"
    found = re.match(r"List of <(.*)> of length (\S+)\.\.\.(\S+) \(inclusive\)"
                     r"(?: separated by <(.*)>)?$", pattern)
    if found:
        inner = kind(found[1])
        many = "list of" if found[2] != found[3] else f"{found[2]} times"
        between = f", separated by `{found[4]}`" if found[4] else ""
        return f"{many}: {inner}{between}"
    return pattern


def cell(text: str) -> str:
    return text.replace("|", "\\|")


def page(entries: list[Entry], patterns: dict[str, str]) -> str:
    text = HEAD
    sections: dict[tuple[str, ...], list[Entry]] = {}
    for entry in entries:
        sections.setdefault(entry.path, []).append(entry)
    for path, listed in sections.items():
        title = " / ".join(path) if path else "Outside of all subsections"
        text += f"\n## {title}\n\n| Entry | Default | Value | Meaning |\n|---|---|---|---|\n"
        for entry in listed:
            default = f"`{entry.default}`" if entry.default else "(empty)"
            text += (f"| `{entry.name}` | {cell(default)} | {cell(kind(patterns.get(entry.key, '')))} "
                     f"| {cell(entry.documentation)} |\n")
    return text


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", 1)[0])
    parser.add_argument("program", help="eunoe-particles")
    parser.add_argument("--check", action="store_true",
                        help="change nothing, and fail if the page is out of date")
    options = parser.parse_args()
    entries = read_entries(options.program)
    text = page(entries, read_patterns(options.program, entries))
    if not options.check:
        PAGE.write_text(text, encoding="utf-8")
        return 0
    if not PAGE.exists() or PAGE.read_text(encoding="utf-8") != text:
        print(f"{PAGE} is out of date: run {Path(__file__).name} with the program.")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
