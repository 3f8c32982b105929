"""Normal impacts: Chung and Ooi, Granular Matter 13 (2011) 643, tests 1 to 3."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .bench import Bench, Results, Row, absolute, relative, row

# Published numbers have three or four digits.
FOUR_DIGITS, THREE_DIGITS = 5e-4, 1e-3


@dataclass(frozen=True)
class Impact:
    """Course of a normal impact: time, closing speed, overlap and force."""
    time: np.ndarray
    speed: np.ndarray
    overlap: np.ndarray
    force: np.ndarray

    @classmethod
    def of(cls, results: Results, mass: float) -> Impact:
        """From the kinetic energy of equal spheres alone, without the contact law: the closing
        speed is positive until the energy is smallest, then negative.

        @param mass effective (kg)
        """
        table = results.energies
        speed = np.sqrt(2. * table["kinetic"] / mass)
        turn = int(np.argmin(table["kinetic"]))
        speed[turn + 1:] *= -1.
        if abs(speed[turn + 1] - 2. * speed[turn] + speed[turn - 1]) > \
           abs(speed[turn + 1] + 2. * speed[turn] + speed[turn - 1]):
            speed[turn] *= -1.
        step = table["time"][1]
        moving = np.abs(speed - speed[0]) > 1e-9 * speed[0]
        first = max(int(np.argmax(moving)) - 1, 0)
        way = np.concatenate(([0.], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * step)))
        force = np.zeros_like(speed)
        force[1:-1] = -mass * (speed[2:] - speed[:-2]) / (2. * step)
        return cls(table["time"] - table["time"][first], speed, way - way[first], force)

    @property
    def duration(self) -> float:
        """Time from the first touch until the overlap is zero again (s)."""
        apart = int(np.argmax((self.overlap < 0.) & (self.time > 0.)))
        start = self.time[np.argmax(self.overlap > 0.)] - self.overlap[self.overlap > 0.][0] / self.speed[0]
        return float(self.time[apart] - self.overlap[apart] / self.speed[apart] - start)


def sphere_mass(diameter: float, density: float) -> float:
    return math.pi / 6. * density * diameter**3


def elastic(bench: Bench, cases: tuple, effective_mass) -> Row:
    checks, impacts = [], {}
    for name, case, density, overlap, force, duration in cases:
        impact = Impact.of(bench.run(case), effective_mass(density))
        impacts[name] = impact
        checks += [
            relative(f"{name}: largest overlap", 1e6 * impact.overlap.max(), overlap, FOUR_DIGITS, "um"),
            relative(f"{name}: largest force", 1e-3 * impact.force.max(), force, FOUR_DIGITS, "kN"),
            relative(f"{name}: duration", 1e6 * impact.duration, duration, FOUR_DIGITS, "us"),
            relative(f"{name}: speed afterwards", -impact.speed[-1] / impact.speed[0], 1., 1e-6)]

    def draw(axes) -> None:
        for (name, _, _, overlap, force, _), colour in zip(cases, ("#0072b2", "#d55e00")):
            impact = impacts[name]
            axes[0].plot(1e6 * impact.overlap, 1e-3 * impact.force, color=colour, label=name)
            axes[0].plot(overlap, force, "o", color=colour, markerfacecolor="none")
        axes[0].plot([], [], "o", color="k", markerfacecolor="none", label="published maxima")
        axes[0].set(xlabel="Overlap (µm)", ylabel="Force (kN)", xlim=(0., None), ylim=(0., None))
        axes[0].legend()
    return Row(checks, 1, draw)


@row("chung_ooi_1", "Chung and Ooi, test 1: two equal spheres, elastic, head-on")
def pair(bench: Bench) -> Row:
    return elastic(bench, (("glass", "chung_ooi_1_glass", 2800., 274.1, 10.70, 40.34),
                           ("limestone", "chung_ooi_1_limestone", 2500., 368.3, 7.108, 54.20)),
                   lambda density: 0.5 * sphere_mass(20e-3, density))


@row("chung_ooi_2", "Chung and Ooi, test 2: sphere on a rigid plane, elastic")
def plane(bench: Bench) -> Row:
    return elastic(bench, (("aluminium alloy", "chung_ooi_2_aluminium", 2699., 49.72, 11.37, 731.7),
                           ("magnesium alloy", "chung_ooi_2_magnesium", 1800., 52.12, 7.233, 767.1)),
                   lambda density: sphere_mass(0.2, density))


@row("chung_ooi_3", "Chung and Ooi, test 3: normal impact with dissipation")
def restitution(bench: Bench) -> Row:
    checks, measured = [], {}
    given = (0.2, 0.4, 0.6, 0.8, 1.)
    for name, case, density, overlap, force, duration in (
            ("alumina", "chung_ooi_3_alumina", 4000., 8.09, 615., 6.10),
            ("cast iron", "chung_ooi_3_iron", 7000., 17.19, 507., 12.97)):
        measured[name] = []
        for e in given:
            results = bench.run(case, f"{e:g}", **{
                "lagrangian_physical_properties__particle_type_0__restitution_coefficient_particles": e,
                "lagrangian_physical_properties__restitution_coefficient_wall": e})
            after = results.particles.velocity[0, 2] / 3.9
            measured[name].append(after)
            checks.append(absolute(f"{name}: restitution for e = {e:g}", after, e, 1e-3))
        impact = Impact.of(results, sphere_mass(5e-3, density))
        checks += [
            relative(f"{name}: elastic overlap", 1e6 * impact.overlap.max(), overlap, THREE_DIGITS, "um"),
            relative(f"{name}: elastic force", impact.force.max(), force, THREE_DIGITS, "N"),
            relative(f"{name}: elastic duration", 1e6 * impact.duration, duration, THREE_DIGITS, "us")]

    def draw(axes) -> None:
        axes[0].plot((0., 1.), (0., 1.), color="#777777", label="as prescribed")
        for (name, values), mark in zip(measured.items(), ("o", "x")):
            axes[0].plot(given, values, mark, markerfacecolor="none", label=name)
        axes[0].set(xlabel="Prescribed restitution", ylabel="Restitution")
        axes[0].legend()
    return Row(checks, 1, draw)
