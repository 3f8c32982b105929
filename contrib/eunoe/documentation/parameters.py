"""Writes doc/parameters.md, or doc/study_parameters.md: every entry of a program's input file with its
default, its kind and its documentation, as the program itself describes them.

Usage: contrib/tools document-parameters path/to/eunoe-particles|eunoe-discovery [--check]

Exit code 1 with --check if the page is out of date; 0 otherwise.
"""

from __future__ import annotations

import json
import re
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from eunoe.launch import Failure, parser
from eunoe.repository import DOC
from eunoe.tables import as_markdown

HEAD = """# {title}

All entries of {what}. {link} says how such a file is written. This page is
written by `contrib/tools document-parameters` from what the program says of itself: do not
edit it. A complete input file with the same texts comes from

```sh
{program} --print-parameters
```

and the same as JSON from `--describe-parameters`. Subsections that end in a number are repeated: the first
entry of the section around them says how often, and they are numbered from 0. They are shown once, as number
0. Values are in SI units.
"""


@dataclass(frozen=True)
class Subject:
    """A program whose input is documented."""

    page: Path
    head: str
    # Sections in the order in which a case is written. Those that are not named here, such as the
    # section of a new process or observable, come after these.
    order: tuple[str, ...]


SUBJECTS = {
    "eunoe-particles": Subject(
        DOC / "parameters.md",
        HEAD.format(title="Parameters", what="the input file", link="[input.md](input.md)",
                    program="eunoe-particles"),
        ("simulation control", "powder spreading", "heap", "mesh", "box refinement", "grid motion",
         "DEM boundary conditions", "lagrangian physical properties", "insertion info", "model parameters",
         "floating walls", "solid objects", "restart", "post-processing", "boundary forces")),
    "eunoe-discovery": Subject(
        DOC / "study_parameters.md",
        HEAD.format(title="Parameters of a study", what="the study file of eunoe-discovery",
                    link="[discovery.md](discovery.md)", program="eunoe-discovery"),
        ("discovery", "twin")),
}


def description_of(program: str) -> dict:
    done = subprocess.run([program, "--describe-parameters"], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise Failure(f"{program} --describe-parameters failed:\n{done.stdout}{done.stderr}")
    return json.loads(done.stdout)


def in_order(sections: dict[str, dict], order: tuple[str, ...]) -> dict[str, dict]:
    unknown = [name for name in order if name not in sections]
    if unknown:
        raise Failure(f"The program has no section '{unknown[0]}': correct the order in {Path(__file__).name}.")
    return {name: sections[name] for name in dict.fromkeys((*order, *sections))}


def cell(text: str) -> str:
    return text.replace("|", "\\|")


def kind(value: str) -> str:
    """The values that an entry accepts, in words; choices as code."""
    return re.sub(r"'([^']*)'", r"`\1`", value) if value else "text"


def sections_of(path: tuple[str, ...], section: dict) -> Iterator[str]:
    """The section's own table, then those of its subsections."""
    if section["entries"]:
        rows = [[f"`{name}`", cell(f"`{entry['default']}`") if entry["default"] else "(empty)",
                 cell(kind(entry["value"])), cell(entry["documentation"])]
                for name, entry in section["entries"].items()]
        title = " / ".join(path) if path else "Outside of all subsections"
        yield f"\n## {title}\n\n{as_markdown([['Entry', 'Default', 'Value', 'Meaning'], *rows])}\n"
    for name, inner in section["subsections"].items():
        yield from sections_of((*path, name), inner)


def main(words: list[str]) -> int:
    arguments = parser(__doc__)
    arguments.add_argument("program", help="eunoe-particles or eunoe-discovery")
    arguments.add_argument("--check", action="store_true",
                           help="change nothing, and fail if the page is out of date")
    options = arguments.parse_args(words)
    subject = SUBJECTS[Path(options.program).name]
    description = description_of(options.program)
    description["subsections"] = in_order(description["subsections"], subject.order)
    text = subject.head + "".join(sections_of((), description))
    if not options.check:
        subject.page.write_text(text, encoding="utf-8")
    elif not subject.page.exists() or subject.page.read_text(encoding="utf-8") != text:
        raise Failure(f"{subject.page} is out of date: contrib/tools document-parameters {options.program} "
                      "renews it.")
    return 0
