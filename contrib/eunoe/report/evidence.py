"""What a spreading run leaves in addition to its tables: the geometry and the particles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .apparatus import Apparatus, ApparatusError
from .run_folder import Run
from eunoe.vtk_files import VtkError, read_vtu

Fields = dict[str, np.ndarray]  # fields of the particles, by name
FIELDS = ("diameter", "mass", "layer", "tracked", "displacement", "on_plate")


@dataclass(frozen=True)
class Evidence:
    """What is known of the run in addition to its tables; None or empty if unknown."""

    apparatus: Apparatus | None
    pictures: dict[int, Fields]  # of the first, a middle and the last layer
    problems: list[str]

    @property
    def last(self) -> Fields | None:
        return self.pictures[max(self.pictures)] if self.pictures else None


def gather(run: Run) -> Evidence:
    """Reads apparatus.json and the pictures; a sentence in `problems` says what is missing."""
    problems: list[str] = []
    apparatus, pictures = None, {}
    try:
        apparatus = Apparatus.read(run.folder / "apparatus.json")
    except ApparatusError as error:
        problems.append(f"{error} The plates and the size of the case are unknown.")
    try:
        files = run.layer_pictures()
        if not files:
            problems.append("There are no pictures of the particles ('layer pictures' is false, or "
                            "their files are missing).")
        numbers = sorted(files)
        chosen = {numbers[0], numbers[len(numbers) // 2], numbers[-1]} if numbers else set()
        for layer in sorted(chosen):
            fields = read_vtu(files[layer], FIELDS)
            missing = [name for name in FIELDS if name not in fields]
            if len(fields["points"]) == 0 or missing:
                problems.append(f"{files[layer].name} has no particles or lacks a field.")
            else:
                pictures[layer] = fields
    except VtkError as error:
        problems.append(str(error))
    return Evidence(apparatus, pictures, problems)
