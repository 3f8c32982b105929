"""The spreading apparatus as a run describes it in apparatus.json.

x runs along the passes with the feedstock platform's left end at 0, y upwards with the transfer
plate's surface at 0. SI units.
"""

from __future__ import annotations

import json
from dataclasses import MISSING, dataclass, fields
from pathlib import Path
from typing import Mapping

import numpy as np

from eunoe.launch import Failure


class ApparatusError(Failure):
    """The file is missing or no run wrote it; the text is a sentence for the user."""


@dataclass(frozen=True)
class Apparatus:
    """Places and lengths in m, velocities in m/s, density in kg/m3."""

    x_transfer: float
    x_gap: float
    x_plate: float
    x_plate_end: float
    x_exit: float
    x_end: float
    y_bottom: float
    y_top: float
    depth: float
    lip: float
    spreader: str  # 'half round' or 'flat blade'
    x_start: float  # of the spreader's lowest line when a pass begins
    front: float  # reach of the spreader before its lowest line
    rear: float  # and behind it
    spreader_height: float
    clearance: float
    n_layers: int
    layer_thickness: float
    velocity: float
    first_stroke: float
    stroke: float
    platform_velocity: float
    rest_before_weighing: float
    replenished: bool
    bed_depth: float
    first_bed_depth: float
    density: float
    plate_stroke: float | None = None  # None: the layer thickness
    first_thickness: float = 0.  # depth of the plate below the transfer plate in the first pass
    side_walls: bool = False  # at the ends of the depth, which is periodic without them
    rim: float = 0.  # width of the walls between the measuring plate and its gaps

    @classmethod
    def read(cls, file: Path) -> Apparatus:
        try:
            values = json.loads(file.read_text(encoding="utf-8"))
            return cls(**{field.name: values[field.name] for field in fields(cls)
                          if field.name in values or field.default is MISSING})
        except FileNotFoundError as error:
            raise ApparatusError(f"{file.name} is missing.") from error
        except (OSError, ValueError, TypeError) as error:
            raise ApparatusError(f"{file.name} cannot be read: {error}.") from error
        except KeyError as error:
            raise ApparatusError(f"{file.name} lacks {error}.") from error

    @property
    def platform_length(self) -> float:
        return self.x_transfer

    @property
    def transfer_length(self) -> float:
        return self.x_gap - self.x_transfer

    @property
    def gap(self) -> float:
        return self.x_plate - self.rim - self.x_gap

    @property
    def plate_length(self) -> float:
        return self.x_plate_end - self.x_plate

    @property
    def exit_length(self) -> float:
        return self.x_end - self.x_exit

    @property
    def full_layer_mass(self) -> float:
        """Mass of solid material that fills a layer on the plate (kg)."""
        return self.density * self.plate_length * self.depth * self.layer_thickness

    def plate_height(self, layer: int) -> float:
        """Height of the measuring plate when this layer is weighed."""
        stroke = self.plate_stroke or self.layer_thickness
        return -layer * stroke - self.first_thickness * stroke / self.layer_thickness

    def spreader_tip(self) -> float:
        """x of a spreader's lowest line when the layer that it has made is weighed."""
        return self.x_plate_end + self.rear + self.velocity * self.rest_before_weighing

    def spreader_tips(self, layer: int, weighings: Mapping[int, float]) -> list[float]:
        """x of the lowest lines of all spreaders at work when a layer is weighed.

        :param weighings: times (s) at which layers were weighed, by their numbers
        """
        tips = [self.spreader_tip()]
        if layer + 1 in weighings:
            behind = self.velocity * (weighings[layer + 1] - weighings[layer])
            if self.spreader_tip() - behind > self.x_start:
                tips.append(self.spreader_tip() - behind)
        return tips

    def spreader_outline(self, tip: float) -> np.ndarray:
        """Corners of the spreader's side view with its lowest line at x = tip."""
        x = np.array([tip - self.rear, tip - self.rear, tip, tip])
        y = np.array([self.spreader_height, 0., 0., self.spreader_height])
        if self.spreader == "half round":
            angle = np.linspace(np.pi, 2. * np.pi, 61)
            x = tip + self.rear * np.concatenate(([-1.], np.cos(angle), [1.]))
            y = np.concatenate(([self.spreader_height], self.rear * (1. + np.sin(angle)),
                                [self.spreader_height]))
        return np.column_stack((x, self.clearance + y))

    def platform_height(self, layer: int, weighings: Mapping[int, float]) -> float:
        """Height of the feedstock platform when a layer is weighed.

        A pass begins a fixed time before its weighing, and the platform's stroke ends when the
        pass begins; the next pass may have begun already.

        :param weighings: times (s) at which layers were weighed, by their numbers, in their order
        """
        path_to_weighing = self.spreader_tip() - self.x_start
        first = min(weighings)  # not 0 in a run that goes on with the layers of another one
        height = -self.first_bed_depth + (self.first_stroke + (first - 1) * self.stroke if first > 0 else 0.)
        for k, weighing in weighings.items():
            stroke = self.first_stroke if k == 0 else self.stroke
            rise = stroke / self.platform_velocity
            feed = weighing - path_to_weighing / self.velocity - rise
            if feed > weighings[layer]:
                break
            if k > 0 and self.replenished:
                height = -self.bed_depth
            s = min(1., (weighings[layer] - feed) / rise)
            height += stroke * s * s * (3. - 2. * s)
        return height
