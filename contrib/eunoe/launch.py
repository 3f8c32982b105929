"""Starting Eunoe's programs."""

from __future__ import annotations

import argparse
import os
import subprocess
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

# Options for ranks that share cores with other programs, as in tests.
SHARED = ("--oversubscribe", "--bind-to", "none")


class Failure(Exception):
    """What went wrong, in a sentence."""


def cores() -> int:
    """Cores of this machine, which Open MPI counts; several threads of one are one."""
    found = set()
    for number in os.sched_getaffinity(0):
        place = Path(f"/sys/devices/system/cpu/cpu{number}/topology")
        try:
            found.add(tuple((place / name).read_text(encoding="ascii") for name in ("physical_package_id", "core_id")))
        except OSError:
            return os.cpu_count() or 1
    return len(found)


def mpirun(ranks: int, *options: str) -> list[str]:
    """The words before a program that runs on so many ranks; none for one rank. Unless options say otherwise,
    each rank has a core of its own as long as there are enough."""
    if ranks <= 1:
        return []
    spare = ["--oversubscribe"] if "--oversubscribe" not in options and ranks > cores() else []
    root = ["--allow-run-as-root"] if os.geteuid() == 0 else []
    return ["mpirun", *root, *spare, *options, "-np", str(ranks)]


def beside(jobs: int) -> tuple[str, ...]:
    """Options of `mpirun` where so many programs run at the same time: each would bind its ranks to the same cores."""
    return ("--bind-to", "none") if jobs > 1 else ()


def overrides(entries: Mapping[str, Any] | Iterable[str]) -> list[str]:
    """Options that override entries: values by "subsection/entry", or texts "subsection/entry = value"."""
    texts = (f"{entry} = {value}" for entry, value in entries.items()) if isinstance(entries, Mapping) else entries
    return [word for text in texts for word in ("--set", text)]


def output_of(command: list[str], folder: Path) -> str:
    """What a command prints when it runs in a folder. Failure if its exit code is not 0."""
    done = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          check=False)
    if done.returncode != 0:
        raise Failure(f"'{' '.join(command)}' ended with exit code {done.returncode}:\n{done.stdout[-2000:]}")
    return done.stdout


def logged(command: list[str], log: Path, folder: Path | None = None) -> int:
    """Runs a command, in a folder or in the present one, and appends its output to a file; returns the exit code."""
    with open(log, "a", encoding="utf-8") as output:
        return subprocess.run(command, stdout=output, stderr=subprocess.STDOUT, check=False, cwd=folder).returncode


def parser(documentation: str) -> argparse.ArgumentParser:
    """The parser of a command; the first paragraph of its module's docstring describes it."""
    return argparse.ArgumentParser(description=" ".join(documentation.split("\n\n", 1)[0].split()))


def parser_with_case(documentation: str) -> argparse.ArgumentParser:
    """The parser of a command that runs a user's case in a folder."""
    arguments = parser(documentation)
    arguments.add_argument("program")
    arguments.add_argument("case")
    arguments.add_argument("folder", type=Path)
    arguments.add_argument("--set", action="append", default=[], dest="settings", metavar="ENTRY=VALUE")
    return arguments


def rank_numbers(text: str) -> list[int]:
    """The numbers in the argument of --ranks."""
    try:
        ranks = [int(word) for word in text.split(",")]
    except ValueError:
        ranks = [0]
    if min(ranks) < 1:
        raise Failure(f"--ranks {text}: give whole numbers above 0, as in 1,2.")
    return ranks
