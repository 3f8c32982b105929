"""Towards which angle heaps go on larger discs: fits of lines in several functions of the diameter to the heaps of one
filling, none of which physics prefers, and what each has on another diameter.

Usage: contrib/tools heap-extrapolation heap_size.csv [more.csv ...] [--to 10]

The tables are those of contrib/tools heap-size. Only heaps of one property set and one fill ratio are compared, as the
filling changes the angle, too; there have to be three diameters. The intervals (95 %) are those of the line (Student's t
over what the heaps scatter about it): they hold if the form is right, which only the differences between forms judge.
"""

from __future__ import annotations

import argparse
import csv
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from eunoe.intervals import Interval, quantile
from eunoe.launch import Failure
from eunoe.tables import Table, as_markdown

FORMS: dict[str, Callable[[float], float]] = {
    "ln D": math.log,
    "1 / root of D": lambda disc: 1. / math.sqrt(disc),
    "1 / D": lambda disc: 1. / disc,
}


@dataclass(frozen=True)
class Heap:
    properties: str
    fill_ratio: float
    disc: float  # mm
    angle: float  # degrees


@dataclass(frozen=True)
class Line:
    at: Interval  # where it was asked for
    farthest: float  # of a heap from it


def read_heaps(files: Sequence[Path]) -> list[Heap]:
    heaps = []
    for file in files:
        with file.open(encoding="utf-8", newline="") as table:
            rows = csv.DictReader(line for line in table if not line.startswith("#"))
            try:
                heaps += [Heap(row["properties"], float(row["fill_ratio"]), float(row["disc_mm"]), float(row["heap_base_angle"]))
                          for row in rows]
            except (KeyError, TypeError, ValueError) as error:
                raise Failure(f"{file} is no table of contrib/tools heap-size: {type(error).__name__}: {error}.") from None
    return heaps


def fit(x: Sequence[float], y: Sequence[float], at: float) -> Line:
    """The line of least squares; three values or more, not all at one x."""
    n, mean_x, mean_y = len(x), sum(x) / len(x), sum(y) / len(y)
    spread = sum((each - mean_x) ** 2 for each in x)
    slope = sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y)) / spread
    residuals = [b - mean_y - slope * (a - mean_x) for a, b in zip(x, y)]
    deviation = math.sqrt(sum(residual ** 2 for residual in residuals) / (n - 2))
    half = quantile(n - 2) * deviation * math.sqrt(1. / n + (at - mean_x) ** 2 / spread)
    return Line(Interval(mean_y + slope * (at - mean_x), half), max(map(abs, residuals)))


def table_of(heaps: Sequence[Heap], to: float) -> Table:
    """A row for each property set, filling and form of which there are three diameters."""
    table: Table = [["", "heaps", "discs (mm)", "line in", "farthest heap from it (degrees)", f"on {to:g} mm (degrees)"]]
    for properties, fill_ratio in sorted({(heap.properties, heap.fill_ratio) for heap in heaps}):
        alike = [heap for heap in heaps if (heap.properties, heap.fill_ratio) == (properties, fill_ratio)]
        discs = sorted({heap.disc for heap in alike})
        if len(discs) < 3:
            continue
        for name, form in FORMS.items():
            line = fit([form(heap.disc) for heap in alike], [heap.angle for heap in alike], form(to))
            table.append([f"{properties}, fill ratio {fill_ratio:g}", str(len(alike)), ", ".join(f"{disc:g}" for disc in discs), name,
                          f"{line.farthest:.1f}", f"{line.at.value:.1f} ± {line.at.half:.1f}"])
    return table


def main(words: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tables", type=Path, nargs="+", help="heap_size.csv")
    parser.add_argument("--to", type=float, default=10., help="diameter of the disc in mm (10)")
    options = parser.parse_args(words)
    if options.to <= 0.:
        parser.error("argument --to: a diameter is positive")
    table = table_of(read_heaps(options.tables), options.to)
    if len(table) == 1:
        raise Failure("No property set has heaps of one fill ratio on three discs or more, so no line can be fitted. Run more "
                      "with contrib/tools heap-size --discs.")
    print(as_markdown(table))
    return 0
