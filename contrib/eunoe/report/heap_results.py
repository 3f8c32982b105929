"""What a run of the heap instrument leaves in its folder: tables, map and apparatus. SI units."""

from __future__ import annotations

import json
import math
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from eunoe.tables import read_columns

from .run_folder import ReportError

SETTLED = 0.55  # solid fraction of settled powder, as in the process's apparatus.cc


@dataclass(frozen=True)
class Views:
    """The rows of heap.csv, one for each view; the last row has the means."""

    direction: np.ndarray  # degrees
    base_angle: np.ndarray  # degrees
    height: np.ndarray  # m
    mean_angle: float  # degrees
    angle_spread: float  # standard deviation over the views, degrees
    mean_height: float  # m
    mass_on_disc: float  # kg
    mass_drained: float  # kg


@dataclass(frozen=True)
class Profile:
    """The rows of heap_profile.csv (m); NaN where nothing was measured."""

    x: np.ndarray
    mean: np.ndarray
    spread: np.ndarray
    measured: np.ndarray


@dataclass(frozen=True)
class HeapMap:
    """The share of the views in which each place is covered, from the base line upwards."""

    share: np.ndarray
    left: float  # m
    pixel: float  # m

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """Left, right, bottom and top (m)."""
        rows, columns = self.share.shape
        return self.left, self.left + columns * self.pixel, 0., rows * self.pixel


def _columns(path: Path) -> dict[str, np.ndarray]:
    try:
        return read_columns(path)
    except (OSError, TypeError, ValueError) as error:
        raise ReportError(f"{path} cannot be read: {error}.") from error


def read_views(path: Path) -> Views:
    table = _columns(path)
    try:
        views = np.isfinite(table["view"])
        if views[-1] or not views.any():
            raise ReportError(f"{path} has no row of means: the run was stopped while writing it.")
        means = {name: float(values[-1]) for name, values in table.items()}
        return Views(table["direction"][views], table["base_angle"][views], table["height"][views],
                     means["base_angle"], means["base_angle_spread"], means["height"],
                     means["mass_on_disc"], means["mass_drained"])
    except KeyError as error:
        raise ReportError(f"{path} has no column {error}: it is no table of views.") from error


def read_profile(path: Path) -> Profile:
    table = _columns(path)
    try:
        return Profile(*(table[name] for name in ("x", "mean", "spread", "measured")))
    except KeyError as error:
        raise ReportError(f"{path} has no column {error}: it is no profile.") from error


def read_map(path: Path) -> HeapMap:
    """The grey map (PGM) with its scale in a comment."""
    try:
        data = path.read_bytes()
    except OSError as error:
        raise ReportError(f"{path} cannot be read: {error.strerror}.") from error
    head = re.match(rb"P5\n# left edge at x = (\S+) m,.* pixel of (\S+) m\n(\d+) (\d+)\n255\n", data)
    if head is None or len(data) != head.end() + int(head[3]) * int(head[4]):
        raise ReportError(f"{path} is not the map of a heap.")
    grey = np.frombuffer(data, np.uint8, offset=head.end()).reshape(int(head[4]), int(head[3]))
    return HeapMap(1. - grey[::-1] / 255., float(head[1]), float(head[2]))


@dataclass(frozen=True)
class Disc:
    diameter: float  # m
    rim: float  # its height, m
    density: float  # of the grains that were filled in, kg/m3

    def heap_mass(self, angle: float) -> float:
        """Mass (kg) of a heap with a base angle (degrees), as the process takes it for the fill ratio."""
        return math.pi / 3. * (self.diameter / 2.)**3 * math.tan(math.radians(angle)) * SETTLED * self.density


def read_disc(path: Path) -> Disc:
    try:
        values = json.loads(path.read_text(encoding="utf-8"))
        return Disc(*(float(values[name]) for name in ("disc_diameter", "rim_height", "density")))
    except (OSError, ValueError, TypeError, KeyError) as error:
        raise ReportError(f"{path} cannot be read: {error}.") from error
