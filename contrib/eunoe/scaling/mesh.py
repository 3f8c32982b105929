"""The background mesh as p4est orders its cells.

The mesh is a box of trees, each refined into 2^r x 2^r x 2^r cells. Within a tree the cells follow
the z-order (Morton) curve; the trees follow the order that deal.II gives to coarse cells: groups of
neighbours, and groups of groups.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from eunoe.launch import Failure

MOST_TREES = 60000  # beyond, ordering them takes minutes


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
    """A box of `trees` (counts in x, y, z) between two corners (m), each refined `refinement`
    times; which directions are periodic."""

    trees: tuple[int, int, int]
    lower: tuple[float, float, float]
    upper: tuple[float, float, float]
    refinement: int
    periodic: tuple[bool, bool, bool]

    @property
    def cells(self) -> np.ndarray:
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
        """Cells in the order of the curve, as flat indices into an array of the shape of the
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
