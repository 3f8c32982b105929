"""Which runs have results that the repository keeps. A batch job asks, perhaps on a node without numpy and VTK, so
nothing that reads pictures is imported here."""

from __future__ import annotations

from pathlib import Path

from eunoe.folders import read_json

from .cases import Case

RECORD = "run.json"


def is_kept(case: Case, data: Path) -> bool:
    """Whether the results of a run that finished, perhaps elsewhere, are there."""
    record = data / case.name / RECORD
    return record.exists() and bool(read_json(record)["finished"])
