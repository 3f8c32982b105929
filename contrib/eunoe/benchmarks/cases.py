"""What is run: the same cases for all programs, as nearly as they allow."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from . import bed


@dataclass(frozen=True)
class Case:
    """A benchmark.

    `length` is that of the box in x (m), `copies` the number of beds in a row along z. With `steps`
    0 the case sets its end; `peers` says whether the other programs run it, too.
    """

    name: str
    title: str
    input: str
    steps: int
    copies: int = 1
    length: float = bed.LENGTH
    plough: bool = False
    peers: bool = True
    deck: str = ""  # how the names of the other programs' decks begin
    density: float = bed.DENSITY  # kg/m3
    time_step: float = 2.816e-7  # s, that of prm/spreading/parts/model.prm
    skins: tuple[float, ...] = (1e-5,)  # m, of the other programs' lists, which take the best

    @property
    def depth(self) -> float:
        return self.copies * bed.PERIOD

    @property
    def box(self) -> tuple[float, float, float]:
        """Its size (m)."""
        return self.length, bed.HEIGHT, self.depth

    def particles(self) -> np.ndarray:
        """Columns diameter, x, y, z (m)."""
        return bed.read(self.copies)

    @property
    def collapse(self) -> bool:
        return self.length > bed.LENGTH

    def variables(self, folder: Path) -> dict:
        """Variables of the other programs' decks that belong to this case; their files go to the folder."""
        del folder
        return {}

    def mesh(self) -> str:
        """Arguments of Eunoe's mesh, a single cell."""
        return f"1, 1, 1 : 0, 0, 0 : {', '.join(str(size) for size in self.box)} : true"


BEDS = (
    Case("bed_20k", "settled bed, 20,000", "settled_bed.prm", 2000),
    Case("bed_200k", "settled bed, 200,000", "settled_bed.prm", 400, copies=10),
    Case("bed_1M", "settled bed, 1,000,000", "settled_bed.prm", 100, copies=50),
    Case("collapse", "column collapse, 20,000", "column_collapse.prm", 10000, length=16e-3),
    Case("plough", "plough, 20,000", "plough.prm", 10000, plough=True),
    Case("two_passes", "two passes of spreading", "two_passes.prm", 0, peers=False),
)
