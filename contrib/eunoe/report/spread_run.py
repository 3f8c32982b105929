"""A spreading run as comparisons see it: its layers, its maps, and the numbers that sum them up."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, reduce

import numpy as np

from eunoe.intervals import Interval, difference_of, mean_of

from .apparatus import Apparatus
from .bed_maps import BedMaps
from .run_folder import Layers
from .static_zones import Zones, zones_of

# Layers of the measured plateau, of its rise and fall, and those by which settings are compared.
PLATEAU, LATER, COMPARED = (2, 10), (11, 20), (5, 20)
YOUNG = (2, 4)  # layers of a bed that passes drag as a whole
SMOOTHED = 3  # layers in the running mean whose largest value is the peak


def peak_of(layer: np.ndarray, lrd: np.ndarray) -> tuple[float, float]:
    """The largest running mean, and the layer in its middle; from layer 2 on, as layer 1 lies on a bare plate."""
    rows = np.flatnonzero((layer >= 2) & np.isfinite(lrd))
    if len(rows) < SMOOTHED:
        return np.nan, np.nan
    means = np.convolve(lrd[rows], np.full(SMOOTHED, 1. / SMOOTHED), mode="valid")
    best = int(np.argmax(means))
    return float(means[best]), float(layer[rows[best + SMOOTHED // 2]])


@dataclass(frozen=True)
class SpreadRun:
    """Without apparatus and maps if the run left none."""

    name: str
    layers: Layers
    apparatus: Apparatus | None
    maps: BedMaps | None

    @property
    def seed(self) -> int | None:
        """That of its name."""
        found = re.search(r"seed[_-]?(\d+)$", self.name)
        return int(found[1]) if found else None

    @property
    def plate_length(self) -> float | None:
        return self.apparatus.plate_length if self.apparatus else None

    @cached_property
    def zones(self) -> Zones | None:
        return zones_of(self.maps) if self.maps else None

    def mean_lrd(self, span: tuple[int, int]) -> float:
        """Of the first to the last of these layers; NaN if one of them has not been spread."""
        rows = (self.layers.layer >= span[0]) & (self.layers.layer <= span[1])
        return float(self.layers.lrd[rows].mean()) if rows.sum() == span[1] - span[0] + 1 else np.nan

    def middle_lrd(self, span: tuple[int, int]) -> float:
        """The same of the middle half of the plate; NaN without maps."""
        if self.maps is None:
            return np.nan
        rows = (self.maps.layers >= span[0]) & (self.maps.layers <= span[1])
        return float(self.maps.middle_lrd()[rows].mean()) if rows.sum() == span[1] - span[0] + 1 else np.nan

    def above_level(self, layer: int) -> float:
        """Solid above the level of the transfer plate after a layer, as density of a layer; NaN without maps."""
        found = self.maps.above_level()[self.maps.layers == layer] if self.maps else np.empty(0)
        return float(found[0]) if len(found) else np.nan

    def lrd_below(self, span: tuple[int, int]) -> float:
        """The mean LRD without what the room between that level and the spreader has gained meanwhile."""
        gained = self.above_level(span[1]) - self.above_level(span[0] - 1)
        return self.mean_lrd(span) - gained / (span[1] - span[0] + 1)

    def crd(self, layer: int) -> float:
        """NaN if the layer has not been spread."""
        found = self.layers.crd[self.layers.layer == layer]
        return float(found[0]) if len(found) else np.nan

    def compaction(self, span: tuple[int, int]) -> float:
        """Mean of what passes press together far below their layer, as density of a layer; NaN without maps."""
        if self.maps is None:
            return np.nan
        rows = (self.maps.layers >= span[0]) & (self.maps.layers <= span[1])
        return float(self.maps.compaction()[rows].mean()) if rows.sum() == span[1] - span[0] + 1 else np.nan

    @property
    def rise(self) -> float:
        """Of the mean LRD from the plateau's layers to the later ones."""
        return self.mean_lrd(LATER) - self.mean_lrd(PLATEAU)

    @property
    def is_whole(self) -> bool:
        """Whether it has made all layers of its case, as far as the apparatus tells how many these are."""
        return self.apparatus is None or self.layers.last + 1 >= self.apparatus.n_layers

    @cached_property
    def peak(self) -> tuple[float, float]:
        """NaN as long as layers are to come, of which any may be the densest."""
        return peak_of(self.layers.layer, self.layers.lrd) if self.is_whole else (np.nan, np.nan)

    @property
    def scraped(self) -> np.ndarray:
        """Share of the mass on the plate that a pass removed; NaN for layer 0."""
        before = np.concatenate(([np.nan], self.layers.mass[:-1]))
        with np.errstate(invalid="ignore", divide="ignore"):
            return self.layers.removed / before


def farthest(runs: Sequence[SpreadRun]) -> list[SpreadRun]:
    """Those that have made as many layers as any of them."""
    last = max((run.layers.last for run in runs), default=0)
    return [run for run in runs if run.layers.last == last]


@dataclass(frozen=True)
class Group:
    """Runs that differ in the seed alone."""

    label: str
    runs: Sequence[SpreadRun]

    @property
    def layer(self) -> np.ndarray:
        """Numbers of the layers that all runs have."""
        return reduce(np.intersect1d, (run.layers.layer for run in self.runs))

    def over_layers(self, values: Callable[[SpreadRun], np.ndarray]) -> np.ndarray:
        """What each run has for each of its layers, for those that all have: a row for each run."""
        layer = self.layer
        return np.array([values(run)[np.isin(run.layers.layer, layer)] for run in self.runs])

    def stacked(self, values: str) -> np.ndarray:
        """A column of layers.csv, a row for each run."""
        return self.over_layers(lambda run: getattr(run.layers, values))

    @property
    def mapped(self) -> list[SpreadRun]:
        return [run for run in self.runs if run.maps is not None and len(run.maps.layers)]

    def over_maps(self, values: str) -> np.ndarray:
        """What a method of BedMaps gives, for each run with maps; as many weighings as all have."""
        found = [getattr(run.maps, values)() for run in self.mapped]
        n = min(map(len, found), default=0)
        return np.array([array[:n] for array in found])

    def of_runs(self, number) -> list[float]:
        """A number of each run."""
        return [number(run) for run in self.runs]

    def knowing(self, number) -> int:
        """How many runs have made the layers, and left the maps, that a number takes."""
        return int(np.isfinite(self.of_runs(number)).sum())


def difference(group: Group, reference: Group, number) -> Interval:
    """Of the means of a number of each run. Runs of one seed on plates of one length spread the same grains, so where
    all runs have partners they are compared pair by pair; else both groups scatter by themselves (Welch)."""
    ours, theirs = ({run.seed: run for run in runs} for runs in (group.runs, reference.runs))
    seeds = [seed for seed in ours if seed in theirs]
    have_partners = (None not in ours and len(ours) == len(group.runs) and len(theirs) == len(reference.runs) and len(seeds) == min(len(ours), len(theirs))
                     and len({run.plate_length for run in (*group.runs, *reference.runs)}) == 1)
    if have_partners:
        return mean_of([number(ours[seed]) - number(theirs[seed]) for seed in seeds])
    return difference_of(group.of_runs(number), reference.of_runs(number))


def mean_and_spread(rows: np.ndarray) -> tuple[np.ndarray, np.ndarray | None]:
    """Over the first axis; the standard deviation is None for a single row."""
    return rows.mean(axis=0), rows.std(axis=0, ddof=1) if len(rows) > 1 else None
