"""Tables: columns of .csv files, and texts. A table as text is a list of rows, the head first."""

from __future__ import annotations

import csv
import math
from pathlib import Path
from typing import Any

Table = list[list[str]]


def read_rows(path: Path) -> list[dict[str, float]]:
    """The rows of a .csv file of numbers by the names in its head; NaN where a cell is empty."""
    with open(path, newline="", encoding="utf-8") as file:
        return [{name: float(cell) if cell else math.nan for name, cell in row.items()}
                for row in csv.DictReader(file)]


def read_columns(path: Path) -> dict[str, Any]:
    """The columns, as arrays of numpy; none of a file without rows."""
    import numpy as np
    rows = read_rows(path)
    return {name: np.array([row[name] for row in rows]) for name in (rows[0] if rows else ())}


def write_csv(path: Path, rows: list[list[Any]]) -> None:
    with open(path, "w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows(rows)


def as_text(table: Table) -> str:
    widths = [max(len(row[c]) for row in table) for c in range(len(table[0]))]
    return "\n".join("  ".join(value.ljust(width) for value, width in zip(row, widths)).rstrip()
                     for row in table)


def as_markdown(table: Table) -> str:
    lines = ["| " + " | ".join(row) + " |" for row in table]
    return "\n".join([lines[0], "|---" * len(table[0]) + "|", *lines[1:]])
