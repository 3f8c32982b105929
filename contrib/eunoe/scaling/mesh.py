"""The mesh that distributes the particles, as p4est orders its cells.

The mesh is a box of trees over a lattice of 2^r x 2^r x 2^r cells each; its cells are unions of
lattice cells. Within a tree the cells follow the z-order (Morton) curve; the trees follow the order
that deal.II gives to coarse cells: groups of neighbours, and groups of groups.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from eunoe.launch import Failure

MOST_TREES = 60000  # beyond, ordering them takes minutes
# As in the program (source/engine/forest.cc).
MOST_COARSE, MOST_LEVELS, LOST_TO_ROUNDING = 4000, 16, 0.25
WIDER = 1.001  # a lattice cell is that much wider than the reach of the search, at least


def group_order(neighbours: list[list[int]]) -> list[int]:
    """An order of the nodes of a graph in which neighbours are close.

    It starts at a node with the fewest neighbours and groups, again and again, a node that has few
    neighbours left with those that are still free. Then the same is done with the groups, until no
    group joins another. This is the order that deal.II 9.4 documents as
    SparsityTools::reorder_hierarchical.

    `neighbours[k]`, in ascending order, includes k itself.
    """
    n = len(neighbours)
    left = [len(row) for row in neighbours]
    group = [-1] * n
    members: list[list[int]] = []
    for start in sorted(range(n), key=lambda k: (len(neighbours[k]), k)):
        front = {start} if group[start] < 0 else set()
        while front:
            pivot = min(front, key=lambda k: (left[k], -len(neighbours[k]), k))
            new = [pivot] + [k for k in neighbours[pivot] if group[k] < 0 and k != pivot]
            for node in new:
                group[node] = len(members)
            members.append(new)
            for node in new:
                for other in neighbours[node]:
                    left[other] -= 1
                    if group[other] < 0:
                        front.add(other)
                front.discard(node)
    if len(members) == n:
        return [new[0] for new in members]
    links = [sorted({group[other] for node in new for other in neighbours[node]})
             for new in members]
    return [node for g in group_order(links) for node in members[g]]


@dataclass(frozen=True)
class Mesh:
    """A box of `trees` (counts in x, y, z) between two corners (m), each of which can be refined
    `refinement` times; which directions are periodic."""

    trees: tuple[int, int, int]
    lower: tuple[float, float, float]
    upper: tuple[float, float, float]
    refinement: int
    periodic: tuple[bool, bool, bool]

    @classmethod
    def over(cls, lower: tuple[float, ...], upper: tuple[float, ...], periodic: tuple[bool, ...],
             reach: float) -> Mesh:
        """The mesh that the program makes over a box (m), for the reach of its search (m)."""
        number = [max(1, int((u - l) / (WIDER * reach))) for l, u in zip(lower, upper)]
        levels, trees = 0, list(number)
        for level in range(1, MOST_LEVELS + 1):
            coarse = [n >> level for n in number]
            if min(coarse) == 0:
                break
            kept = np.prod([(c << level) / n for c, n in zip(coarse, number)])
            if kept < 1. - LOST_TO_ROUNDING and np.prod(np.float64(trees)) <= MOST_COARSE:
                break
            levels, trees = level, coarse
        while np.prod(np.float64(trees)) > MOST_COARSE:
            longest = trees.index(max(trees))
            trees[longest] = -(-trees[longest] // 2)
        return cls(tuple(trees), tuple(lower), tuple(upper), levels, tuple(periodic))

    @property
    def cells(self) -> np.ndarray:
        """Numbers of lattice cells."""
        return np.array(self.trees) << self.refinement

    @property
    def width(self) -> np.ndarray:
        return (np.array(self.upper) - np.array(self.lower)) / self.cells

    def tree_order(self) -> np.ndarray:
        """Place of each tree on the curve, in the shape of the trees."""
        nx, ny, nz = self.trees
        if nx * ny * nz > MOST_TREES:
            raise Failure(f"The mesh has {nx * ny * nz} coarse cells; their order is only computed "
                          f"for up to {MOST_TREES}. Take a coarser mesh with more refinement.")
        near = [[(k * ny + j) * nx + i
                 for k in range(max(0, c - 1), min(nz, c + 2))
                 for j in range(max(0, b - 1), min(ny, b + 2))
                 for i in range(max(0, a - 1), min(nx, a + 2))]
                for c in range(nz) for b in range(ny) for a in range(nx)]
        place = np.empty(len(near), np.int64)
        place[group_order(near)] = np.arange(len(near))
        return place.reshape(nz, ny, nx).transpose(2, 1, 0)

    def curve(self) -> np.ndarray:
        """Lattice cells in the order of the curve, as flat indices into an array of the shape of the
        cells."""
        index = np.indices(self.cells)
        inner = np.zeros(self.cells, np.int64)
        for bit in range(self.refinement):
            for d in range(3):
                inner |= ((index[d] >> bit) & 1) << (3 * bit + d)
        outer = self.tree_order()[tuple(index >> self.refinement)]
        return np.argsort(((outer << (3 * self.refinement)) + inner).ravel(), kind="stable")

    def find(self, points: np.ndarray) -> np.ndarray:
        """Indices of each point's cell, shape (n, 3); for points beyond the box, of the cell at its
        edge."""
        cell = ((points - np.array(self.lower)) / self.width).astype(np.int64)
        return np.clip(cell, 0, self.cells - 1)
