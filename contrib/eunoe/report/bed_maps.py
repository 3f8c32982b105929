"""What lies in each cell of the bed on the measuring plate at each weighing, and how far the pass before it
moved that. A cell is a bin of x, from the plate's left end, by a layer's thickness in height over the plate,
over the whole depth."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from eunoe.tables import read_columns, write_csv
from eunoe.vtk_files import read_vtu

from .apparatus import Apparatus
from .evidence import FIELDS, Fields
from .layer_results import RESTS_BELOW, moved_over_plate

BIN = 0.1e-3  # wanted width of the bins in x (m)
MOST_BINS = 104
DEEP = 5  # rows of height below the new layer from which on it no longer reaches there
SMOOTHED_LAYERS, SMOOTHED_LENGTH = 3, 0.5e-3  # over which a map of densities is averaged; m
# Points by which a sphere is shared out among the cells that it reaches into.
N_POINTS = 64


def n_bins_of(apparatus: Apparatus) -> int:
    """The number of bins in x."""
    return int(np.clip(round(apparatus.plate_length / BIN), 1, MOST_BINS))


def edges_of(apparatus: Apparatus, n_bins: int | None = None) -> tuple[np.ndarray, np.ndarray]:
    """The bounds of the bins in x and in height (m), for all that can lie below the spreader in the last pass,
    and a layer more."""
    height = apparatus.layer_thickness
    highest = apparatus.clearance - apparatus.plate_height(apparatus.n_layers - 1)
    n_rows = max(apparatus.n_layers + 3, int(np.ceil(highest / height)) + 1)
    return (np.linspace(0., apparatus.plate_length, (n_bins or n_bins_of(apparatus)) + 1),
            height * np.arange(n_rows + 1))


def _first_row(apparatus: Apparatus) -> int:
    return int(apparatus.first_thickness / apparatus.layer_thickness + 1e-6)


def points_of_sphere() -> np.ndarray:
    """Points of equal volume of a sphere of radius 1 seen from the side: the share of the volume within the
    distance r of its axis is 1 - (1 - r^2)^(3/2)."""
    rank = (np.arange(N_POINTS) + 0.5) / N_POINTS
    r, angle = np.sqrt(1. - (1. - rank) ** (2. / 3.)), np.pi * (3. - np.sqrt(5.)) * np.arange(N_POINTS)
    return np.column_stack((r * np.cos(angle), r * np.sin(angle)))


@dataclass(frozen=True)
class BedMaps:
    """Arrays by weighing, bin in x and bin in height; SI units."""

    layers: np.ndarray  # numbers of the weighings
    x: np.ndarray  # bounds of the bins, from the plate's left end
    y: np.ndarray  # above the plate
    fraction: np.ndarray  # volume of solid over that of the cell
    tracked: np.ndarray  # number of the particles that were on the plate at the weighing before
    moved: np.ndarray  # mean of their displacements; 0 where there are none
    resting: np.ndarray  # share of them that moved by less than RESTS_BELOW
    first_row: int = 0  # of height in which layer 0 ends: the plate has fallen before the first pass

    def _mean(self, values: np.ndarray, axes: tuple[int, ...]) -> np.ndarray:
        """Mean over the tracked particles; NaN where there are none."""
        number = self.tracked.sum(axis=axes)
        with np.errstate(invalid="ignore", divide="ignore"):
            return (self.tracked * values).sum(axis=axes) / number

    def moved_of_columns(self) -> np.ndarray:
        """Mean displacement of what lay there before, by weighing and x (m)."""
        return self._mean(self.moved, (2,))

    def resting_of_columns(self) -> np.ndarray:
        return self._mean(self.resting, (2,))

    def moved_of_layers(self) -> np.ndarray:
        return self._mean(self.moved, (1, 2))

    def resting_of_layers(self) -> np.ndarray:
        return self._mean(self.resting, (1, 2))

    def columns(self) -> np.ndarray:
        """Height of the solid without pores, by weighing and x (m)."""
        return (self.fraction * np.diff(self.y)).sum(axis=2)

    def middle(self) -> np.ndarray:
        """Which bins of x lie in the middle half of the plate."""
        x = 0.5 * (self.x[1:] + self.x[:-1]) / self.x[-1]
        return (x > 0.25) & (x < 0.75)

    def middle_lrd(self) -> np.ndarray:
        """LRD of the middle half of the plate, by weighing."""
        return self.local_lrd()[:, self.middle()].mean(axis=1)

    def local_lrd(self) -> np.ndarray:
        """LRD of every bin in x; NaN for a layer whose last one is not known."""
        found = np.full((len(self.layers), len(self.x) - 1), np.nan)
        for k in range(1, len(self.layers)):
            if self.layers[k] == self.layers[k - 1] + 1:
                found[k] = (self.columns()[k] - self.columns()[k - 1]) / np.diff(self.y)[0]
        return found

    def smoothed_lrd(self) -> np.ndarray:
        """Its means over SMOOTHED_LAYERS and SMOOTHED_LENGTH, without which the packing of single grains hides all else;
        over what there is of them at the borders."""
        values = self.local_lrd()
        over = (SMOOTHED_LAYERS // 2, max(0, round(0.5 * (SMOOTHED_LENGTH / np.diff(self.x).mean() - 1.))))
        border, windows = [(n, n) for n in over], tuple(2 * n + 1 for n in over)
        total, number = (sliding_window_view(np.pad(each, border), windows).sum(axis=(2, 3))
                         for each in (np.nan_to_num(values), np.isfinite(values).astype(float)))
        return np.divide(total, number, out=np.full_like(values, np.nan), where=np.isfinite(values))

    def above_level(self) -> np.ndarray:
        """Solid above the level of the transfer plate, where the spreader leaves room, as density of a layer, by weighing."""
        return np.array([self.fraction[k, :, self.first_row + int(layer):].mean(axis=0).sum()
                         for k, layer in enumerate(self.layers)])

    def crd_below(self) -> np.ndarray:
        """CRD without what lies above that level, by weighing: the mean density of layers 2 to k in the bed below; NaN
        where it is not known."""
        below = (self.fraction.mean(axis=1).sum(axis=1) - self.above_level())[:, np.newaxis]
        first = below[self.layers == 1]
        with np.errstate(invalid="ignore", divide="ignore"):
            found = (below - first) / (self.layers[:, np.newaxis] - 1.) if len(first) else np.full_like(below, np.nan)
        return np.where(self.layers >= 2, found[:, 0], np.nan)

    def compaction(self) -> np.ndarray:
        """What the rows of height that lie `DEEP` and more below the new layer gained since the weighing before, as
        density of a layer, by weighing; NaN where that is not known."""
        found = np.full(len(self.layers), np.nan)
        for k in range(1, len(self.layers)):
            if self.layers[k] == self.layers[k - 1] + 1:
                new = self.first_row + int(self.layers[k])
                rows = max(new + 1 - DEEP, 0)
                found[k] = (self.fraction[k, :, :rows] - self.fraction[k - 1, :, :rows]).mean(axis=0).sum()
        return found


def map_of(particles: Fields, apparatus: Apparatus, layer: int) -> tuple[np.ndarray, ...]:
    """Fraction, tracked, moved and resting of one weighing."""
    x_edges, y_edges = edges_of(apparatus)
    on = particles["on_plate"] > 0
    place = particles["points"][on, :2].astype(float) - (apparatus.x_plate, apparatus.plate_height(layer))
    radius = 0.5 * particles["diameter"][on].astype(float)
    points = place[:, np.newaxis] + radius[:, np.newaxis, np.newaxis] * points_of_sphere()
    share = np.repeat(4. / 3. * np.pi * radius**3 / N_POINTS, N_POINTS)
    bins = (x_edges, y_edges)
    solid = np.histogram2d(*points.reshape(-1, 2).T, bins, weights=share)[0]
    cell = np.outer(np.diff(x_edges), np.diff(y_edges)) * apparatus.depth
    known = particles["tracked"][on] > 0
    moved = moved_over_plate(particles)[on][known]

    def sum_of(weights: np.ndarray) -> np.ndarray:
        return np.histogram2d(*place[known].T, bins, weights=weights)[0]

    tracked = sum_of(np.ones(len(moved)))
    count = np.maximum(tracked, 1.)
    return solid / cell, tracked, sum_of(moved) / count, sum_of(moved < RESTS_BELOW) / count


def read_maps(pictures: dict[int, Path], apparatus: Apparatus) -> BedMaps:
    """:param pictures: the files with the particles at the weighings, by the number of the layer"""
    return maps_of({layer: read_vtu(pictures[layer], FIELDS) for layer in sorted(pictures)}.items(), apparatus)


def maps_of(pictures: Iterable[tuple[int, Fields]], apparatus: Apparatus) -> BedMaps:
    x, y = edges_of(apparatus)
    layers, arrays = [], []
    for layer, particles in pictures:
        layers.append(layer)
        arrays.append(map_of(particles, apparatus, layer))
    stacks = [np.array([found[k] for found in arrays]) for k in range(4)]
    return BedMaps(np.array(layers), x, y, *stacks, _first_row(apparatus))


COLUMNS = ("layer", "x_bin", "y_bin", "solid_fraction", "tracked", "displacement_um", "static_share")


def write_table(file: Path, maps: BedMaps) -> None:
    """A row for each cell that holds something."""
    rows = [[int(maps.layers[k]), i, j, f"{maps.fraction[k, i, j]:.4f}", int(maps.tracked[k, i, j]),
             f"{1e6 * maps.moved[k, i, j]:.4g}", f"{maps.resting[k, i, j]:.3g}"]
            for k, i, j in np.argwhere((maps.fraction > 5e-5) | (maps.tracked > 0))]
    write_csv(file, [list(COLUMNS), *rows])


def write_for_others(file: Path, maps: BedMaps) -> None:
    """The same in metres: x from the beginning of the plate, y from its surface, middles of the cells."""
    x, y = 0.5 * (maps.x[1:] + maps.x[:-1]), 0.5 * (maps.y[1:] + maps.y[:-1])
    rows = [[int(maps.layers[k]), f"{x[i]:.6g}", f"{y[j]:.6g}", f"{maps.fraction[k, i, j]:.4f}",
             f"{maps.moved[k, i, j]:.4g}" if maps.tracked[k, i, j] > 0 else ""]
            for k, i, j in np.argwhere((maps.fraction > 5e-5) | (maps.tracked > 0))]
    write_csv(file, [["layer", "x", "y", "solid_fraction", "displacement"], *rows])


def read_table(file: Path, apparatus: Apparatus, n_bins: int | None = None) -> BedMaps:
    """:param n_bins: in x, if they are not those that a table has today"""
    columns = read_columns(file)
    x, y = edges_of(apparatus, n_bins)
    layers = np.unique(columns["layer"]).astype(int) if columns else np.empty(0, int)
    shape = (len(layers), len(x) - 1, len(y) - 1)
    arrays = [np.zeros(shape) for _ in range(4)]
    if columns:
        rows = (np.searchsorted(layers, columns["layer"]), columns["x_bin"].astype(int), columns["y_bin"].astype(int))
        for array, name, size in zip(arrays, COLUMNS[3:], (1., 1., 1e-6, 1.)):
            array[rows] = size * columns[name]
    return BedMaps(layers, x, y, *arrays, _first_row(apparatus))
