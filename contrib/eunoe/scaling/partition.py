"""Who owns which cells and particles, and what is sent as ghosts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .ghosts import Filling, messages
from .mesh import Mesh


def most_particles(n_particles: int, n_ranks: int) -> int:
    """In a mesh cell that can be refined, as in the program."""
    return min(24, max(8, n_particles // n_ranks // 128))


def leaves(counts: np.ndarray, refinement: int, most: int) -> tuple[np.ndarray, np.ndarray]:
    """The mesh cells, from the numbers of particles in the lattice cells along the curve: where
    each starts, and how often it can still be refined. A cell with more than `most` particles is
    refined.

    (The program also keeps neighbours within one level of each other; such cells hold few
    particles and hardly count.)
    """
    starts, levels = [], []
    refined = np.ones(len(counts) >> (3 * refinement), bool)  # whether the parent is
    for level in range(refinement, -1, -1):
        size = 1 << (3 * level)
        splits = refined & (np.add.reduceat(counts, np.arange(0, len(counts), size))
                            > most) & (level > 0)
        here = np.flatnonzero(refined & ~splits)
        starts.append(here * size)
        levels.append(np.full(len(here), level))
        refined = np.repeat(splits, 8)
    order = np.argsort(np.concatenate(starts), kind="stable")
    return np.concatenate(starts)[order], np.concatenate(levels)[order]


def families(starts: np.ndarray, levels: np.ndarray, refinement: int) -> np.ndarray:
    """Number of the cell at which each cell's family starts: eight cells of the same parent, or the
    cell alone."""
    first = np.arange(len(starts))
    size = 8 << (3 * levels)
    opens = (starts % size == 0) & (levels < refinement)
    opens[max(0, len(starts) - 7):] = False
    for k in np.flatnonzero(opens):
        if (levels[k:k + 8] == levels[k]).all():
            first[k:k + 8] = k
    return first


def cut(weights: np.ndarray, n_ranks: int, first: np.ndarray | None = None) -> np.ndarray:
    """Starts of the ranks' parts of a curve of cells, with the end: shape (n_ranks + 1).

    Rank p begins at the first cell behind p/n_ranks of the weight. The eight cells of a family,
    which starts at the cell `first`, stay together; otherwise they could not be coarsened again.
    """
    behind = np.concatenate(([0], np.cumsum(weights, dtype=np.int64)))
    wanted = (int(behind[-1]) * np.arange(n_ranks + 1)) // n_ranks
    starts = np.searchsorted(behind, wanted, side="left")
    if first is not None:
        inside = starts < len(weights)
        begin = first[starts[inside]]
        place = starts[inside] - begin
        starts[inside] = np.where(place == 0, starts[inside], np.where(place > 4, begin + 8, begin))
    starts[0], starts[-1] = 0, len(weights)
    return np.maximum.accumulate(starts)


@dataclass(frozen=True)
class Partition:
    """What each rank owns, shape (n_ranks): cells and particles; and what is sent as ghosts,
    one row (sender, receiver, particles) for each message, shape (n_messages, 3)."""

    cells: np.ndarray
    owned: np.ndarray
    messages: np.ndarray

    def _sum(self, column: int) -> np.ndarray:
        totals = np.bincount(self.messages[:, column], self.messages[:, 2], len(self.owned))
        return totals.astype(np.int64)

    @property
    def sent(self) -> np.ndarray:
        """Particles that each rank sends, counted once for each receiver."""
        return self._sum(0)

    @property
    def ghosts(self) -> np.ndarray:
        return self._sum(1)

    @property
    def neighbours(self) -> np.ndarray:
        """Ranks with which each rank exchanges messages, which go both ways."""
        there = self.messages[:, :2]
        both = np.unique(np.concatenate((there, there[:, ::-1])), axis=0)
        return np.bincount(both[:, 0], minlength=len(self.owned))

    @property
    def imbalance(self) -> float:
        """Largest number of own particles over the mean, less 1."""
        return float(self.owned.max() / self.owned.mean() - 1.)

    @property
    def ghost_fraction(self) -> float:
        return float(self.ghosts.sum() / self.owned.sum())


def divide(mesh: Mesh, filling: Filling, curve: np.ndarray, n_ranks: int,
           cell_weight: int = 20, particle_weight: int = 2000) -> Partition:
    """Divides the cells with their particles among the ranks."""
    counts = filling.counts
    along = counts.ravel()[curve].astype(np.int64)
    begins, levels = leaves(along, mesh.refinement, most_particles(int(along.sum()), n_ranks))
    weights = cell_weight + particle_weight * np.add.reduceat(along, begins)
    starts = cut(weights, n_ranks, families(begins, levels, mesh.refinement))
    in_lattice = np.append(begins, counts.size)[starts]
    owner = np.empty(counts.size, np.int32)
    owner[curve] = np.repeat(np.arange(n_ranks, dtype=np.int32), np.diff(in_lattice))
    return Partition(cells=np.diff(starts),
                     owned=np.bincount(owner, counts.ravel(), n_ranks).astype(np.int64),
                     messages=messages(mesh, filling, owner.reshape(counts.shape), n_ranks))
