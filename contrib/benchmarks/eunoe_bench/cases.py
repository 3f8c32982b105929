"""What is run: the same cases for all programs, as nearly as they allow."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from . import bed

INPUTS = Path(__file__).resolve().parents[3] / "prm" / "benchmarks"


@dataclass(frozen=True)
class Case:
    """A benchmark.

    `length` is that of the box in x (m), `copies` the number of beds behind each other in z;
    `steps` 0 lets the run come to its own end; `peers` says whether other programs run it, too.
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
        """Arguments of Eunoe's background mesh and how often it is refined: cells of about 1/6 mm.

        Large beds need a coarse mesh of few cells, as every rank holds and orders all of these.
        """
        corners = f"0, 0, 0 : {self.length}, {bed.HEIGHT}, {self.depth} : true"
        refinement = 2 if self.copies % 2 == 0 else 0
        cells = [round(size * 6e3) >> refinement for size in (self.length, bed.HEIGHT, self.depth)]
        if refinement == 0:
            cells[1] = 37  # as in settled_bed.prm
        return f"{cells[0]}, {cells[1]}, {cells[2]} : {corners}", refinement


CASES = {case.name: case for case in (
    Case("bed_20k", "settled bed, 20,000", "settled_bed.prm", 2000),
    Case("bed_200k", "settled bed, 200,000", "settled_bed.prm", 400, copies=10),
    Case("bed_1M", "settled bed, 1,000,000", "settled_bed.prm", 100, copies=50),
    Case("collapse", "column collapse, 20,000", "column_collapse.prm", 10000, length=16e-3),
    Case("plough", "plough, 20,000", "plough.prm", 10000, plough=True),
    Case("two_passes", "two passes of spreading", "two_passes.prm", 0, peers=False),
)}
