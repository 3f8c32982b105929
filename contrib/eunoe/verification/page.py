"""Reads the table of doc/verification.md, compares it with the rows' results, and renews it."""

from __future__ import annotations

import re
from pathlib import Path

from eunoe.launch import Failure

from .bench import Check, Row, RowMaker

# Processors and libraries may round the last digits differently. A difference above this share of
# the tolerance (or of the number, if there is no tolerance) is not rounding.
SHARE = 0.02


def _number(value: float) -> str:
    return f"{value:.5g}" if abs(value) > 1e-13 else "0"


def _cells(maker: RowMaker, row: Row) -> list[list[str]]:
    lines = []
    for k, check in enumerate(row.checks):
        unit = f" {check.unit}" if check.unit else ""
        tolerance = "at least" if check.tolerance is None else f"{check.tolerance:.2g}{unit}"
        lines.append([f"{maker.title}: `{maker.name}`" if k == 0 else "", check.what,
                      _number(check.reference) + unit, _number(check.result) + unit, tolerance])
    return lines


def _block(text: str, name: str) -> tuple[int, int]:
    """Where the lines of a row begin and end in the text of the page; an empty range if there are none."""
    match = re.search(rf"^\| [^|\n]*: `{name}` \|.*\n(?:\|  \|.*\n)*", text, re.M)
    return match.span() if match else (0, 0)


def _agrees(cell: str, check: Check) -> bool:
    """Whether the page's result agrees with the row's."""
    try:
        value = float(cell.split()[0])
    except (ValueError, IndexError):
        return False
    allowed = SHARE * (abs(check.result) if check.tolerance is None else check.tolerance)
    # The page has five digits, so half of the last one may be lost.
    return abs(value - check.result) <= allowed + 6e-5 * abs(check.result) + 1e-13


def differences(file: Path, maker: RowMaker, row: Row) -> list[str]:
    """Sentences on the differences between the page and a row."""
    text = file.read_text(encoding="utf-8")
    first, last = _block(text, maker.name)
    there = [[cell.strip() for cell in line.strip("|").split(" | ")]
             for line in text[first:last].replace("|  |", "|   |").splitlines()]
    here = _cells(maker, row)
    renew = f"renew it with --rows {maker.name} --page {file} --renew"
    if len(there) != len(here):
        return [f"{file.name} has {len(there)} lines of {maker.name} instead of {len(here)}: {renew}."]
    wrong = []
    for ours, theirs, check in zip(here, there, row.checks):
        same = [ours[k] == theirs[k] for k in (0, 1, 2, 4)] if len(theirs) == 5 else [False]
        if not all(same) or not _agrees(theirs[3], check):
            wrong.append(f"{file.name} has '{' | '.join(theirs)}' instead of '{' | '.join(ours)}': {renew}.")
    return wrong


def renew(file: Path, maker: RowMaker, row: Row) -> None:
    """Writes the lines of a row in place of those that the page has; new ones go to the table's end."""
    text = file.read_text(encoding="utf-8")
    lines = "".join(f"| {' | '.join(cells)} |\n" for cells in _cells(maker, row))
    first, last = _block(text, maker.name)
    if first == last:
        table = re.search(r"^\| row \| quantity \|.*\n(?:\|.*\n)*", text, re.M)
        if not table:
            raise Failure(f"{file} has no table that begins with '| row | quantity |'.")
        first = last = table.end()
    file.write_text(text[:first] + lines + text[last:], encoding="utf-8")
