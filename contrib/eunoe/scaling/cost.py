"""The cost of a step, from costs measured on one core and the figures of a network."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import ceil, log2

import numpy as np

from .partition import Partition

GHOST_BYTES = 9 * 8  # position, velocity and spin of a ghost at every step


@dataclass(frozen=True)
class Costs:
    """Seconds and bytes; doc/performance.md says how they were measured.

    `speeds`: particle-steps/s of a core by the number of its particles, as fewer fit better into
    its caches. `ghost`: work for a ghost over that for an own particle; `paired`: share of the
    ghosts that are in listed pairs; only these are sent at every step. `search`: cost of a search
    in steps of the same particles; `interval`: steps between searches; `collectives`: collective
    operations in a search; `step_allreduces`: those in every step. `bandwidth`: of a node to
    others, in each direction, shared by its ranks; `copy`: bandwidth between two ranks of a node.
    `memory`: bandwidth of a node's memory, shared by its ranks; `traffic`: bytes of it that a step
    of a particle takes if it is not in a cache, of which a rank has `cache` bytes.
    """

    speeds: tuple[tuple[float, float], ...] = ((2e4, 28.2e6), (2e5, 18.4e6), (1e6, 15.1e6))
    ghost: float = 0.22
    paired: float = 0.6
    search: float = 8.
    interval: float = 160.
    collectives: int = 40
    step_allreduces: int = 1
    latency: float = 1.5e-6
    bandwidth: float = 12e9
    copy: float = 4e9
    ranks_per_node: int = 64
    memory: float = 200e9
    traffic: float = 1e3
    cache: float = 4e6
    bytes_rank: float = 170e6
    bytes_cell: float = 2.1e3
    bytes_particle: float = 1.1e3

    def seconds_per_particle(self, owned: np.ndarray) -> np.ndarray:
        """Seconds of a step, interpolated over the logarithm of the size; constant beyond the
        ends."""
        sizes, speeds = np.array(self.speeds).T
        return 1. / np.interp(np.log(np.maximum(owned, 1)), np.log(sizes), speeds)


@dataclass(frozen=True)
class Prediction:
    """For a number of ranks: seconds of a step (total, and of each part on the slowest rank),
    efficiency, bytes that a rank sends in a step (mean, largest), memory of the largest rank
    (bytes)."""

    n_ranks: int
    seconds: float
    parts: dict[str, float] = field(default_factory=dict)
    efficiency: float = 0.
    mean_bytes: float = 0.
    largest_bytes: float = 0.
    memory: float = 0.


def message_seconds(partition: Partition, costs: Costs) -> np.ndarray:
    """Seconds of the exchange of ghosts in a step, shape (n_ranks): a latency for each neighbour,
    copies within the node, and the node's traffic with others, for which all its ranks wait."""
    sender, receiver, number = partition.messages.T
    n_ranks, per_node = len(partition.owned), costs.ranks_per_node
    inside = sender // per_node == receiver // per_node
    seconds = costs.latency * partition.neighbours.astype(float)
    for end in (sender, receiver):
        copied = np.bincount(end[inside], number[inside], n_ranks)
        seconds += 0.5 * costs.paired * GHOST_BYTES * copied / costs.copy
    n_nodes = -(-n_ranks // per_node)
    traffic = np.maximum(*(np.bincount(end[~inside] // per_node, number[~inside], n_nodes)
                           for end in (sender, receiver)))
    return (seconds + costs.paired * GHOST_BYTES * traffic[np.arange(n_ranks) // per_node]
            / costs.bandwidth)


def memory_seconds(partition: Partition, costs: Costs) -> np.ndarray:
    """Seconds that a node's memory takes for a step, shape (n_ranks): all particles of its ranks that do
    not fit into their caches."""
    number = np.maximum(1., partition.owned + costs.ghost * partition.ghosts)
    uncached = number - np.minimum(number, costs.cache / costs.bytes_particle)
    node = np.arange(len(number)) // costs.ranks_per_node
    return costs.traffic / costs.memory * np.bincount(node, uncached)[node]


def predict(partition: Partition, n_trees: int, costs: Costs) -> Prediction:
    """The efficiency is relative to one core that has all particles, even if they would not fit."""
    owned, n_ranks = partition.owned, len(partition.owned)
    per_particle = costs.seconds_per_particle(owned)
    rounds = ceil(log2(n_ranks)) if n_ranks > 1 else 0
    searches = costs.search / costs.interval
    waiting = costs.latency * rounds * (costs.step_allreduces + costs.collectives / costs.interval)
    parts = {
        "particles": owned * per_particle,
        "ghosts": costs.ghost * partition.ghosts * per_particle,
        "search": searches * (owned + costs.ghost * partition.ghosts) * per_particle,
        "messages": message_seconds(partition, costs),
        "collectives": np.full(n_ranks, waiting),
    }
    # Cores wait for the memory where together they ask for more than it gives.
    computing = parts["particles"] + parts["ghosts"]
    parts["memory"] = np.maximum(0., memory_seconds(partition, costs) - computing)
    total = sum(parts.values())
    slowest = int(np.argmax(total))
    everything = owned.sum()
    alone = float(everything * costs.seconds_per_particle(np.array([everything]))[0])
    memory = (costs.bytes_rank + costs.bytes_cell * (n_trees + partition.cells)
              + costs.bytes_particle * (owned + partition.ghosts))
    return Prediction(n_ranks, float(total[slowest]),
                      {name: float(values[slowest]) for name, values in parts.items()},
                      alone * (1. + searches) / (n_ranks * float(total[slowest])),
                      costs.paired * GHOST_BYTES * float(partition.sent.mean()),
                      costs.paired * GHOST_BYTES * float(partition.sent.max()), float(memory.max()))
