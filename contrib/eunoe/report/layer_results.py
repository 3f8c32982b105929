"""Results from the table of layers: counting noise, and where the powder went."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .apparatus import Apparatus
from .run_folder import Layers

STATIC_BELOW = 1e-6  # distance over the plate (m) under which a particle counts as static
# Under which it rests in a map: a seventh of a mean grain. A bed gives way by some um wherever it carries the
# spreader's load; grains that slide along go much farther.
RESTS_BELOW = 10e-6


@dataclass(frozen=True)
class DensityNoise:
    """Standard deviations (fractions) that the small number of particles gives the densities."""

    lrd: np.ndarray
    crd: np.ndarray
    mean_lrd: float  # of the mean over all layers but 0


def counting_noise(layers: Layers, full_layer_mass: float, grain: float) -> DensityNoise:
    """The noise if particles came and left independently of each other.

    The mass M that came or left then has the variance M * grain. Particles of a packing make room
    for each other, so the true noise is smaller.

    :param full_layer_mass: of solid material that fills a layer (kg)
    :param grain: mean square of the particles' masses over their mean (kg)
    """
    variance = (layers.arrived + layers.removed) * grain / full_layer_mass**2
    variance[layers.layer < 1] = np.nan
    # Of a run that goes on with the layers of another one no noise is known up to its first weighing.
    later = np.where((layers.layer >= 2) & np.isfinite(variance), variance, 0.)
    with np.errstate(invalid="ignore", divide="ignore"):
        crd = np.sqrt(np.cumsum(later)) / (layers.layer - 1.)
    crd[layers.layer < 2] = np.nan
    known = variance[np.isfinite(variance)]
    mean = np.sqrt(known.sum()) / len(known) if len(known) else np.nan
    return DensityNoise(np.sqrt(variance), crd, float(mean))


@dataclass(frozen=True)
class Feed:
    """Where the powder from the feedstock platform went, until the last weighing (kg)."""

    plate: float
    gap: float
    collector: float
    elsewhere: float  # on the other plates or on its way; 0 if there are no pictures to count it

    @property
    def total(self) -> float:
        return self.plate + self.gap + self.collector + self.elsewhere


def feed_of(layers: Layers, apparatus: Apparatus | None,
            particles: dict[str, np.ndarray] | None) -> Feed:
    """:param particles: fields of all particles at the last weighing, if they are known"""
    elsewhere = 0.
    if particles is not None and apparatus is not None:
        x = particles["points"][:, 0]
        away = (x >= apparatus.x_transfer) & (particles["on_plate"] == 0)
        elsewhere = float(particles["mass"][away].sum(dtype=float))
    return Feed(float(layers.mass[-1]), float(layers.to_gap.sum()),
                float(layers.to_collector.sum()), elsewhere)


def moved_over_plate(particles: dict[str, np.ndarray]) -> np.ndarray:
    """Distance in x-y that particles moved over the plate between two weighings (m)."""
    moved = particles["displacement"].astype(float)
    return np.hypot(moved[:, 0], moved[:, 1])
