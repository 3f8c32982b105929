"""Rebuilds the pictures of doc/pictures from their cases.

Usage: contrib/tools pictures --list
       contrib/tools pictures [folder] [--only NAME ...] [--ranks N] [--build build/release]
                           [--pictures doc/pictures]

Each picture belongs to one rule: the commands that compute what it shows, and the one that draws it.
--only takes names of rules and of pictures; without it all rules are followed, which takes days of
one core for the studies, so look at --list first. A rule keeps its runs in a folder of its own
under the given one (output/pictures); what has been computed there is not computed again. Each
picture goes to doc/pictures, and a line about it to README.md there: the rule, the revision that
computed it, and the digest of the file. By the digest a test notices a picture that no rule has
made.

The runs of one revision give the same bits on any number of ranks, so the pictures are the same
everywhere but for computing times and for fonts. Needs numpy, matplotlib and Pillow.
"""

from __future__ import annotations

import argparse
import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

from eunoe.launch import Failure, mpirun, parser
from eunoe.repository import DOC, PROGRAM, ROOT

from .record import Entry, digest, read_record, write_record
from .rules import RULES, Rule


def listing() -> str:
    """All rules as text."""
    lines = []
    for rule in RULES:
        lines.append(f"{rule.name}: {rule.cost}")
        lines += [f"    {picture}" for picture in rule.pictures]
        lines += [f"    $ {command}" for command in (*rule.compute, *rule.draw)]
    return "\n".join(lines)


def chosen(names: list[str]) -> list[Rule]:
    for name in names:
        if not any(name == rule.name or name in rule.pictures for rule in RULES):
            raise Failure(f"There is no rule and no picture '{name}': see --list.")
    return [rule for rule in RULES
            if not names or rule.name in names or not set(names).isdisjoint(rule.pictures)]


def revision_of(program: Path) -> str:
    """The revision of the sources from which a program was built, seven digits."""
    try:
        done = subprocess.run([program, "--version"], capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        raise Failure(f"{program} does not start: build it first (contrib/build.sh).") from None
    match = re.search(r"revision ([0-9a-f]{7})[0-9a-f]*", done.stdout)
    if not match:
        raise Failure(f"{program} does not know its revision: build it in a clone of the repository.")
    return match[1]


def words_of(command: str, rule_folder: Path, options: argparse.Namespace) -> list[str]:
    """The command with the names of programs and folders filled in, which may have spaces."""
    build = options.build.resolve()
    programs = {f"{{{name}}}": [*mpirun(options.ranks), str(build / f"eunoe-{name}")]
                for name in ("particles", "discovery")}
    names = {"program": str(build / "eunoe-particles"), "python": sys.executable, "folder": str(rule_folder)}
    quoted = {name: shlex.quote(value) for name, value in names.items()}
    words: list[str] = []
    for word in shlex.split(command):
        is_script = words[-1:] == ["-c"]
        words += programs.get(word) or [word.format(**(quoted if is_script else names))]
    return words


def run(command: str, rule_folder: Path, options: argparse.Namespace) -> None:
    words = words_of(command, rule_folder, options)
    print("  $", shlex.join(words), flush=True)
    with open(rule_folder / "log", "a", encoding="utf-8") as log:
        code = subprocess.run(words, cwd=ROOT, stdout=log, stderr=log, check=False).returncode
    # A study's verdict is an exit code of 10 or more.
    if code != 0 and not (code >= 10 and "{discovery}" in command):
        raise Failure(f"The command ended with exit code {code}: see {rule_folder / 'log'}.")


def check_revision(rule_folder: Path, revision: str) -> None:
    """Throws unless all runs of a folder come from one revision."""
    note = rule_folder / "revision"
    if not note.exists():
        note.write_text(revision + "\n", encoding="utf-8")
    elif note.read_text(encoding="utf-8").strip() != revision:
        raise Failure(f"{rule_folder} holds runs of revision {note.read_text().strip()}, the program is "
                      f"of {revision}: name another folder, or remove this one.")


def follow(rule: Rule, options: argparse.Namespace, revision: str) -> dict[str, Entry]:
    """Computes and draws; returns the pictures' entries for the record."""
    rule_folder = options.folder.resolve() / rule.name
    rule_folder.mkdir(parents=True, exist_ok=True)
    check_revision(rule_folder, revision)
    for number, command in enumerate(rule.compute, start=1):
        computed = rule_folder / f"computed-{number}"
        if not computed.exists():
            run(command, rule_folder, options)
            computed.touch()
    for command in rule.draw:
        run(command, rule_folder, options)
    entries = {}
    for picture, made in rule.pictures.items():
        if not (rule_folder / made).exists():
            raise Failure(f"The commands of {rule.name} have not made {rule_folder / made}.")
        shutil.copyfile(rule_folder / made, options.pictures / picture)
        # Commands that draw what other revisions have computed have their own record beside the picture.
        stated = read_record((rule_folder / made).parent).get(picture)
        entries[picture] = Entry(rule.name, stated.revision if stated else revision, digest(options.pictures / picture))
    return entries


def parse(words: list[str]) -> argparse.Namespace:
    arguments = parser(__doc__)
    arguments.add_argument("folder", type=Path, nargs="?", default=ROOT / "output" / "pictures")
    arguments.add_argument("--list", action="store_true", help="prints the rules and their cost")
    arguments.add_argument("--only", nargs="+", default=[], metavar="NAME", help="rules or pictures")
    arguments.add_argument("--ranks", type=int, default=1)
    arguments.add_argument("--build", type=Path, default=PROGRAM.parent)
    arguments.add_argument("--pictures", type=Path, default=DOC / "pictures")
    return arguments.parse_args(words)


def main(words: list[str]) -> int:
    options = parse(words)
    if options.list:
        print(listing())
        return 0
    os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    rules = chosen(options.only)
    revision = revision_of(options.build / "eunoe-particles")
    options.pictures.mkdir(parents=True, exist_ok=True)
    for rule in rules:
        print(f"{rule.name} ({rule.cost})", flush=True)
        entries = follow(rule, options, revision)
        # Read behind the hours that this may take, in which others write the record, too.
        write_record(options.pictures, {**read_record(options.pictures), **entries})
    return 0
