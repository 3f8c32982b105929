"""What all studies share: runs that are made once, and statistics over several seeds."""

from __future__ import annotations

import argparse
import json
import math
import statistics
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

from eunoe.folders import occupy
from eunoe.launch import beside, logged, mpirun, overrides, parser
from eunoe.tables import Table, as_markdown, read_rows


class Run(Protocol):
    """One run of a series."""

    @property
    def name(self) -> str:
        """Name of the run's output folder."""

    def command(self, options: argparse.Namespace) -> list[str]:
        """The command that starts the run."""

    def result(self, folder: Path) -> Any:
        """The run's result; None if it has not finished."""


@dataclass(frozen=True)
class SeededVariant:
    """A variant of a case, by its name, with one seed."""

    variant: str
    seed: int

    @property
    def name(self) -> str:
        return f"{self.variant}_seed{self.seed}"


# Options that make other runs of the same names.
MAKE_OTHERS = ("case", "layers", "set")
# Settings of a run that is long enough to be interrupted: it continues from its checkpoint.
CONTINUED = {"restart/restart": "auto", "restart/checkpoint": "true", "restart/wall time interval": 5}


def at_least(least: int) -> Callable[[str], int]:
    """The type of an argument that is a whole number from a least one on."""
    def number(text: str) -> int:
        if int(text) < least:
            raise argparse.ArgumentTypeError(f"{text} is too few: give {least} or more")
        return int(text)
    return number


def arguments(documentation: str, seeds: Sequence[int]) -> argparse.ArgumentParser:
    """The command-line arguments that all studies share."""
    found = parser(documentation)
    found.add_argument("program")
    found.add_argument("folder", type=Path)
    found.add_argument("--seeds", type=int, nargs="+", default=list(seeds))
    found.add_argument("--jobs", type=at_least(1), default=1, help="runs at the same time")
    found.add_argument("--table-only", action="store_true", help="runs nothing")
    return found


def summary_of(folder: Path) -> dict | None:
    """The summary of a finished run; None if it has not finished."""
    try:
        return json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None


def spreading_command(options: argparse.Namespace, run: Run, seed: int, settings: Mapping[str, Any]) -> list[str]:
    """Starts a spreading case without pictures of the layers, or goes on with it."""
    settings = {**settings, "powder spreading/number of layers": options.layers,
                "powder spreading/layer pictures": "false",
                "simulation control/output path": options.folder / run.name, **CONTINUED}
    return [*mpirun(options.ranks, *beside(options.jobs)), options.program, str(options.case), "--seed", str(seed),
            *overrides(settings), *overrides(options.set)]


def layers_of(folder: Path) -> dict | None:
    """Densities of the layers from 1 on (CRD is NaN before its first), seconds of the loop and share of
    sleepers, which are NaN where a restart began their count anew; None if the run has not finished."""
    summary = summary_of(folder)
    try:
        rows = [row for row in read_rows(folder / "layers.csv") if row["layer"] >= 1]
    except (OSError, ValueError):
        return None
    if summary is None:
        return None
    is_whole = summary.get("first_step", 0) == 0
    return {**{key: [row[key] for row in rows] for key in ("LRD", "CRD")},
            "seconds": summary["loop_seconds"] if is_whole else math.nan,
            "asleep": summary.get("share_asleep", 0.) if is_whole else math.nan}


def mean_of_whole(runs: Sequence[dict], key: str, pattern: str, factor: float = 1.) -> str:
    """Mean of seconds or shares of sleepers over the runs that were not restarted."""
    values = [run[key] for run in runs if not math.isnan(run[key])]
    return format(factor * statistics.mean(values), pattern) if values else "restarted"


def compute(runs: Sequence[Run], options: argparse.Namespace,
            after_each: Callable[[], None] = lambda: None) -> bool:
    """Makes the runs that have not finished, unless only a table is wanted; false if one failed."""
    if not options.table_only:
        occupy(options.folder, {name: getattr(options, name) if name != "case" else str(options.case)
                                for name in MAKE_OTHERS if hasattr(options, name)}, "options.json")

    def make(run: Run) -> bool:
        if run.result(options.folder):
            return True
        code = logged(run.command(options), options.folder / f"{run.name}.log")
        print(f"{run.name} ended with exit code {code}", flush=True)
        after_each()
        return code == 0

    with ThreadPoolExecutor(options.jobs) as pool:
        return all(list(pool.map(make, () if options.table_only else runs)))


def publish(table: Table, file: Path, *sentences: str) -> None:
    """Writes a table and sentences about it into a file, and prints both."""
    text = "\n".join([as_markdown(table), *(word for sentence in sentences for word in ("", sentence))]) + "\n"
    file.write_text(text, encoding="utf-8")
    print(text, end="")


def spread(values: Sequence[float]) -> float:
    """Standard deviation; NaN of a single value."""
    return statistics.stdev(values) if len(values) > 1 else math.nan


def plus_minus(value: float, error: float, form: str = ".4g", of_error: str = ".2g") -> str:
    """A number and its error, which a single run does not tell."""
    return f"{value:{form}}" + ("" if math.isnan(error) else f" ± {error:{of_error}}")


def mean_and_spread(values: Sequence[float], form: str = ".4g", of_spread: str = ".2g") -> str:
    return plus_minus(statistics.mean(values), spread(values), form, of_spread)


def in_errors(values: Sequence[float], reference: Sequence[float]) -> float:
    """Difference of the means over its standard error; NaN if the error is unknown or zero."""
    error = math.hypot(*(spread(v) / math.sqrt(len(v)) for v in (values, reference)))
    return (statistics.mean(values) - statistics.mean(reference)) / error if error > 0. else math.nan
