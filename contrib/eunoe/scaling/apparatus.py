"""The mesh and the powder of the spreading process, from its lengths alone.

The same formulas as in source/processes/powder_spreading (apparatus.cc, section.cc).
"""

from __future__ import annotations

import math

import numpy as np

from .mesh import Mesh

SLOPE = math.tan(math.radians(35.))
# From prm/spreading: full lengths, strokes, spreader and powder (m).
W1, W2, W3, W4 = 69e-3, 56e-3, 73e-3, 46.5e-3
GAP, RIM, LIP, STROKE, FIRST_STROKE, MARGIN = 0.5e-3, 0.1e-3, 0.1e-3, 0.6e-3, 2.2e-3, 1e-3
LAYER, CLEARANCE, RADIUS, N_LAYERS = 100e-6, 100e-6, 2.5e-3, 21
LEVEL = CLEARANCE  # of the feedstock bed
FIRST_LAYER = LAYER  # depth of the plate in the first pass
LARGEST = 101.096e-6
DIAMETERS = np.array([52.622, 57.7666, 63.4141, 69.6138, 76.4196, 83.8907, 92.0923, 101.096]) * 1e-6
SHARES = np.array([0.146168, 0.168842, 0.168577, 0.152019, 0.129519, 0.105404, 0.078927, 0.050544])
BED_FRACTION = 0.55  # solid fraction


def apparatus(length_factor: float, depth: float) -> dict[str, float]:
    """Positions of the parts (m), by their names in a run's apparatus.json."""
    a = {"x_transfer": length_factor * W1, "depth": depth}
    a["x_gap"] = a["x_transfer"] + length_factor * W2
    a["x_plate"] = a["x_gap"] + GAP + RIM
    a["x_plate_end"] = a["x_plate"] + length_factor * W3
    a["x_exit"] = a["x_plate_end"] + RIM + GAP
    a["x_end"] = a["x_exit"] + length_factor * W4
    a["bed_depth"] = STROKE + MARGIN
    a["first_bed_depth"] = FIRST_STROKE + MARGIN
    pile = math.sqrt(2. * FIRST_STROKE * a["x_transfer"] * SLOPE)
    height = max(1.2 * RADIUS, FIRST_STROKE + pile)
    a["y_bottom"] = -max(a["first_bed_depth"], FIRST_LAYER + N_LAYERS * LAYER + LIP) - 4. * LARGEST
    a["y_top"] = max(CLEARANCE + height, 4.2 * (a["bed_depth"] + LEVEL)) + 2. * LARGEST
    return a


def mesh_of(a: dict[str, float], largest: float = LARGEST, skin: float = 0.13) -> Mesh:
    """The mesh over an apparatus, for the largest diameter (m) and the skin as a share of it."""
    return Mesh.over((0., a["y_bottom"], 0.), (a["x_end"], a["y_top"], a["depth"]),
                     (False, False, not a.get("side_walls", False)), (1. + skin) * largest)


def lattice(lower: tuple[float, ...], upper: tuple[float, ...], density: float,
            random: np.random.Generator) -> np.ndarray:
    """Points in a box, `density` per cubic metre, on a grid with random shifts."""
    size = np.array(upper) - np.array(lower)
    number = np.maximum(1, np.round(size * density ** (1. / 3.))).astype(int)
    # A thin box holds whole layers of points; the spacing in x makes up for the rounding.
    number[0] = max(1, round(density * float(np.prod(size)) / float(number[1] * number[2])))
    grid = np.indices(number).reshape(3, -1).T
    return np.array(lower) + (grid + random.uniform(0., 1., grid.shape)) / number * size


def powder(a: dict[str, float], layers: int) -> np.ndarray:
    """Centres of the particles (m) while layer `layers` is spread from a replenished reservoir: the
    bed in it, the heap before the spreader in the middle of the transfer plate, the film that the
    clearance leaves behind, and the layers on the plate."""
    density = BED_FRACTION / (math.pi / 6.) * float(np.sum(SHARES / DIAMETERS**3) / SHARES.sum())
    random = np.random.default_rng(1)
    depth = a["depth"]
    middle = 0.5 * (a["x_transfer"] + a["x_gap"])
    boxes = [((0., -a["bed_depth"] + STROKE), (a["x_transfer"], LEVEL)),
             ((a["x_transfer"], 0.), (middle, CLEARANCE)),
             ((a["x_plate"], -FIRST_LAYER - layers * LAYER), (a["x_plate_end"], 0.)),
             ((a["x_exit"], 0.), (a["x_end"], CLEARANCE))]
    parts = [lattice((*low, 0.), (*high, depth), density, random) for low, high in boxes if
             high[1] > low[1]]
    length = math.sqrt(2. * STROKE * a["x_transfer"] / SLOPE)
    heap = lattice((middle, 0., 0.), (middle + length, length * SLOPE, depth), density, random)
    parts.append(heap[heap[:, 1] < SLOPE * (middle + length - heap[:, 0])])
    return np.concatenate(parts)


def sizes(number: int) -> np.ndarray:
    """Diameters (m) for so many particles; the paper's shares are of the volume."""
    numbers = SHARES / DIAMETERS**3
    return np.random.default_rng(2).choice(DIAMETERS, number, p=numbers / numbers.sum())
