"""What is run: the same cases for all programs, as nearly as they allow."""

from __future__ import annotations

from dataclasses import dataclass
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

    @property
    def depth(self) -> float:
        return self.copies * bed.PERIOD

    @property
    def collapse(self) -> bool:
        return self.length > bed.LENGTH

    def mesh(self) -> tuple[str, int]:
        """Arguments of Eunoe's background mesh and how often it is refined: as in settled_bed.prm,
        mesh cells of 1 mm that are cut twice. This gives ranks compact parts of the mesh."""
        cells = ", ".join(str(round(1e3 * size)) for size in (self.length, bed.HEIGHT, self.depth))
        return f"{cells} : 0, 0, 0 : {self.length}, {bed.HEIGHT}, {self.depth} : true", 2


CASES = {case.name: case for case in (
    Case("bed_20k", "settled bed, 20,000", "settled_bed.prm", 2000),
    Case("bed_200k", "settled bed, 200,000", "settled_bed.prm", 400, copies=10),
    Case("bed_1M", "settled bed, 1,000,000", "settled_bed.prm", 100, copies=50),
    Case("collapse", "column collapse, 20,000", "column_collapse.prm", 10000, length=16e-3),
    Case("plough", "plough, 20,000", "plough.prm", 10000, plough=True),
    Case("two_passes", "two passes of spreading", "two_passes.prm", 0, peers=False),
)}
