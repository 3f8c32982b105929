"""Who owns which cells and particles, and what is sent as ghosts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .ghosts import Filling, messages
from .mesh import Mesh


def cut(weights: np.ndarray, n_ranks: int, family: int = 1) -> np.ndarray:
    """Starts of the ranks' parts of a curve of cells, with the end: shape (n_ranks + 1).

    Rank p begins at the first cell behind p/n_ranks of the weight. Cells of the same parent,
    `family` of them in a row, stay together; otherwise they could not be coarsened again.
    """
    behind = np.concatenate(([0], np.cumsum(weights, dtype=np.int64)))
    wanted = (int(behind[-1]) * np.arange(n_ranks + 1)) // n_ranks
    starts = np.searchsorted(behind, wanted, side="left")
    starts = family * ((starts + (family - 1) // 2) // family)
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
    weights = cell_weight + particle_weight * counts.ravel()[curve].astype(np.int64)
    starts = cut(weights, n_ranks, 8 if mesh.refinement > 0 else 1)
    owner = np.empty(counts.size, np.int32)
    owner[curve] = np.repeat(np.arange(n_ranks, dtype=np.int32), np.diff(starts))
    return Partition(cells=np.diff(starts),
                     owned=np.bincount(owner, counts.ravel(), n_ranks).astype(np.int64),
                     messages=messages(mesh, filling, owner.reshape(counts.shape), n_ranks))
