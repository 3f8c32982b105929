"""Where the powder on the plate stays at rest during a pass: zones that begin at the two ends of the bed.

A column of the bed (a bin of x) rests in a pass if at least half of its particles moved by less than
RESTS_BELOW over the plate. Columns with fewer than `FEWEST` particles do not count.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .bed_maps import BedMaps

RESTS = 0.5
FEWEST = 5
# Of all particles in a pass that is at rest as a whole.
NEARLY_ALL = 0.9


@dataclass(frozen=True)
class Zones:
    """By weighing; lengths along the plate in m, 0 where nothing lay on the plate before."""

    layers: np.ndarray
    left: np.ndarray  # from the first column of the bed
    right: np.ndarray
    bed: np.ndarray  # from the first to the last column
    ends: np.ndarray  # x where the bed begins and ends, a row for each weighing; NaN where there is none
    resting: np.ndarray  # share of all particles

    @property
    def covered(self) -> np.ndarray:
        """Share of the bed's length that the two zones cover."""
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.where(self.bed > 0., (self.left + self.right) / self.bed, np.nan)

    @property
    def meet(self) -> int | None:
        """The first layer in whose pass the two zones cover the bed; None if they do not, or if they have not grown
        from both ends before."""
        covered = np.abs(self.covered - 1.) < 1e-9
        from_both = np.cumsum(~covered & (self.left > 0.) & (self.right > 0.)) > 0
        return self._first(covered & from_both)

    @property
    def first(self) -> int | None:
        """The first layer in whose pass there is a zone at rest."""
        return self._first(self.left + self.right > 0.)

    @property
    def at_rest_from(self) -> int | None:
        """The layer from which on nearly all of the bed is at rest in every pass; None if there is none."""
        moving = np.flatnonzero(~(self.resting >= NEARLY_ALL))
        first = moving[-1] + 1 if len(moving) else 0
        return int(self.layers[first]) if first < len(self.layers) else None

    def _first(self, found: np.ndarray) -> int | None:
        rows = np.flatnonzero(found)
        return int(self.layers[rows[0]]) if len(rows) else None


def _run_of(resting: np.ndarray) -> int:
    """How many columns from the first one rest."""
    moving = np.flatnonzero(~resting)
    return int(moving[0]) if len(moving) else len(resting)


def zones_of(maps: BedMaps, rests: float = RESTS) -> Zones:
    """@param rests share of its particles that have to rest for a column to do so"""
    width = np.diff(maps.x)
    shares = maps.resting_of_columns()
    filled = maps.tracked.sum(axis=2) >= FEWEST
    left, right, bed = np.zeros((3, len(maps.layers)))
    ends = np.full((len(maps.layers), 2), np.nan)
    for k, columns in enumerate(filled):
        places = np.flatnonzero(columns)
        if len(places) == 0:
            continue
        inside = slice(places[0], places[-1] + 1)
        # An emptier column within the bed neither rests nor ends a zone.
        resting = (shares[k] >= rests) | ~columns
        bed[k] = width[inside].sum()
        ends[k] = maps.x[places[0]], maps.x[places[-1] + 1]
        n_left, n_right = _run_of(resting[inside]), _run_of(resting[inside][::-1])
        left[k] = width[inside][:n_left].sum()
        # A bed that rests as a whole is counted once.
        right[k] = 0. if n_left == len(width[inside]) else width[inside][::-1][:n_right].sum()
    return Zones(maps.layers, left, right, bed, ends, maps.resting_of_layers())
