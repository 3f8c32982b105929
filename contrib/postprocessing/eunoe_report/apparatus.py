"""The spreading apparatus, rebuilt from used.prm as source/processes/powder_spreading makes it.

x runs along the passes with the feedstock platform's left end at 0, y upwards with the transfer
plate's surface at 0. SI units.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import radians, sqrt, tan
from typing import Sequence

import numpy as np

from .prm_file import MissingEntry, Parameters

PILE_SLOPE = tan(radians(35.))  # with which the simulation estimates the pile before the spreader


@dataclass(frozen=True)
class Apparatus:
    """Lengths in m, velocities in m/s, density in kg/m3."""

    platform_length: float
    transfer_length: float
    plate_length: float
    exit_length: float
    gap: float
    depth: float
    lip: float
    y_bottom: float
    spreader: str  # 'half round' or 'flat blade'
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

    @classmethod
    def of(cls, parameters: Parameters) -> Apparatus:
        """A MissingEntry says what used.prm lacks."""
        p = parameters.section("powder spreading")
        powder = parameters.section("lagrangian physical properties", "particle type 0")
        corners = parameters.section("mesh").text("grid arguments").split(":")
        if len(corners) < 3:
            raise MissingEntry("used.prm does not tell the corners of the domain.")
        factor = p.number("length factor")
        platform_length = factor * p.number("feedstock platform length W1")
        clearance = p.number("spreader clearance delta_s")
        first, stroke = p.number("first feedstock stroke"), p.number("feedstock stroke delta_f")
        n_layers = int(p.number("number of layers"))
        replenished = p.text("feedstock") == "replenished"
        round_bar = p.text("spreader") == "half round"
        radius = p.number("spreader radius R_s")
        front = radius if round_bar else 0.
        pile = sqrt(2. * max(first, stroke) * platform_length * PILE_SLOPE)
        margin = p.number("feedstock margin")
        bed_depth = p.number("feedstock bed depth") or stroke + margin
        strokes = first if replenished else first + (n_layers - 1) * stroke
        return cls(
            platform_length=platform_length,
            transfer_length=factor * p.number("transfer plate length W2"),
            plate_length=factor * p.number("measuring plate length W3"),
            exit_length=factor * p.number("exit plate length W4"),
            gap=p.number("gap"),
            depth=p.number("depth"),
            lip=p.number("lip height"),
            y_bottom=float(corners[1].split(",")[1]),
            spreader=p.text("spreader"),
            front=front,
            rear=radius if round_bar else p.number("spreader thickness"),
            spreader_height=p.number("spreader height")
            or max(1.2 * front, max(first, stroke) + pile),
            clearance=clearance,
            n_layers=n_layers,
            layer_thickness=p.number("layer thickness delta_l"),
            velocity=p.number("spreading velocity v_s"),
            first_stroke=first,
            stroke=stroke,
            platform_velocity=p.number("feedstock platform velocity"),
            rest_before_weighing=p.number("rest before weighing"),
            replenished=replenished,
            bed_depth=bed_depth,
            first_bed_depth=max(bed_depth, strokes + margin),
            density=powder.number("density particles"),
        )

    @property
    def x_transfer(self) -> float:
        return self.platform_length

    @property
    def x_gap(self) -> float:
        return self.x_transfer + self.transfer_length

    @property
    def x_plate(self) -> float:
        return self.x_gap + self.gap

    @property
    def x_plate_end(self) -> float:
        return self.x_plate + self.plate_length

    @property
    def x_exit(self) -> float:
        return self.x_plate_end + self.gap

    @property
    def x_end(self) -> float:
        return self.x_exit + self.exit_length

    @property
    def full_layer_mass(self) -> float:
        """Of solid material that fills a layer on the plate (kg)."""
        return self.density * self.plate_length * self.depth * self.layer_thickness

    def plate_height(self, layer: int) -> float:
        """Of the measuring plate when this layer is weighed."""
        return -layer * self.layer_thickness

    def spreader_tip(self) -> float:
        """Place of the lowest line of the spreader that has made a layer when that is weighed."""
        return self.x_plate_end + self.rear + self.velocity * self.rest_before_weighing

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

    def platform_height(self, layer: int, weighings: Sequence[float]) -> float:
        """Of the feedstock platform when a layer is weighed.

        A pass begins a fixed time before its weighing, and the platform's stroke ends when the
        pass begins; the next pass may have begun already.

        :param weighings: times (s) at which layers 0, 1, ... were weighed
        """
        path_to_weighing = self.spreader_tip() - self.x_start
        height = -self.first_bed_depth
        for k, weighing in enumerate(weighings):
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

    @property
    def x_start(self) -> float:
        """Place of the spreader's lowest line when a pass begins."""
        run_up = 0.2e-3
        return -run_up - self.front
