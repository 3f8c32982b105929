"""Which particles the ranks send to each other as ghosts."""

from __future__ import annotations

from itertools import product

import numpy as np

from .mesh import Mesh

DIRECTIONS = [offset for offset in product((-1, 0, 1), repeat=3) if offset != (0, 0, 0)]
CHUNK = 1 << 18  # particles that are processed together, which bounds the memory


def reach_of(diameters: np.ndarray, skin: float, cohesion: float = 0.) -> np.ndarray:
    """How far from its centre each particle is needed (m): up to the centre of the largest particle
    at a separation of the skin (a share of the largest diameter) plus the range of cohesion (m),
    and the program's 0.1 per thousand more. DMT of prm/spreading acts over 12 nm, which hardly
    changes the numbers of ghosts."""
    gap = skin * float(diameters.max()) + cohesion
    return 1.0001 * (0.5 * diameters + 0.5 * float(diameters.max()) + gap)


class Filling:
    """The particles in the cells of a mesh.

    `counts`: number in each cell, in the shape of the mesh. By particle, in the order of the cells:
    `cell`, a flat index; `place`, its distance from the cell's lower faces, shape (n, 3); `reach`,
    the distance at which it is needed as a ghost. Lengths in m.
    """

    def __init__(self, mesh: Mesh, points: np.ndarray, reach: np.ndarray | float) -> None:
        index = mesh.find(points)
        flat = np.ravel_multi_index(tuple(index.T), mesh.cells)
        order = np.argsort(flat, kind="stable")
        self.counts = np.bincount(flat, minlength=int(np.prod(mesh.cells))).reshape(mesh.cells)
        self.cell = flat[order]
        self.place = (points - (np.array(mesh.lower) + index * mesh.width))[order]
        self.reach = np.broadcast_to(np.asarray(reach, float), len(points))[order]


def shifted(array: np.ndarray, offset: tuple[int, ...], periodic: tuple[bool, ...]) -> np.ndarray:
    """The value at each cell's neighbour at `offset`; -1 where there is none."""
    result = array
    for axis, (step, wraps) in enumerate(zip(offset, periodic)):
        if step == 0:
            continue
        result = np.roll(result, -step, axis)
        if not wraps:
            edge = [slice(None)] * 3
            edge[axis] = slice(-1, None) if step > 0 else slice(0, 1)
            result[tuple(edge)] = -1
    return result


def receivers(near: np.ndarray, own: np.ndarray, place: np.ndarray, reach: np.ndarray,
              width: np.ndarray) -> np.ndarray:
    """The ranks that need each of n particles, each rank once, and -1 in the other places: shape
    (26, n).

    `near`: owners of the cells in the DIRECTIONS, -1 for none, shape (26, n); `own`: of the
    particle's cell.
    """
    below, above = np.maximum(place.T, 0.), np.maximum((width - place).T, 0.)
    square = {-1: below * below, 0: np.zeros_like(below), 1: above * above}
    for row, offset in zip(near, DIRECTIONS):
        distance2 = sum(square[step][axis] for axis, step in enumerate(offset))
        row[(row == own) | (distance2 > reach * reach)] = -1
    near.sort(axis=0)
    near[1:][near[1:] == near[:-1]] = -1
    return near


def messages(mesh: Mesh, filling: Filling, owner: np.ndarray, n_ranks: int) -> np.ndarray:
    """One row (sender, receiver, particles) for each message, shape (n_messages, 3).

    A particle goes to every other rank that owns a cell around its own, empty or not, over faces,
    edges and corners and across periodic faces, if the box of that cell is within its reach.
    """
    around = np.stack([shifted(owner, offset, mesh.periodic).ravel() for offset in DIRECTIONS])
    border = np.flatnonzero(((around != owner.ravel()) & (around >= 0)).any(axis=0))
    around = around[:, border]
    column = np.full(owner.size, -1, np.int64)
    column[border] = np.arange(len(border))
    outer = np.flatnonzero(column[filling.cell] >= 0)
    pairs, amounts = [np.empty(0, np.int64)], [np.empty(0, np.int64)]
    for start in range(0, len(outer), CHUNK):
        some = outer[start:start + CHUNK]
        cell = filling.cell[some]
        own = owner.ravel()[cell]
        needed = receivers(around[:, column[cell]], own, filling.place[some], filling.reach[some],
                           mesh.width)
        row, particle = np.nonzero(needed >= 0)
        pair, amount = np.unique(own[particle].astype(np.int64) * n_ranks + needed[row, particle],
                                 return_counts=True)
        pairs.append(pair)
        amounts.append(amount)
    links, position = np.unique(np.concatenate(pairs), return_inverse=True)
    amount = np.bincount(position, np.concatenate(amounts), len(links)).astype(np.int64)
    return np.column_stack((links // n_ranks, links % n_ranks, amount))
