"""Contacts without a closed formula: an impact that sticks, whose tangential spring is stretched at one
load and relaxes at another, and a pair in three contacts at once. The references integrate the few
equations of motion by themselves."""

from __future__ import annotations

import numpy as np

from .bench import Bench, Row, absolute, row
from .rolling import G, MASS, RADIUS

POISSON = ("lagrangian_physical_properties__particle_type_0__poisson_ratio_particles",
           "lagrangian_physical_properties__poisson_ratio_wall")


def rebound(poisson: np.ndarray, step: float = 2e-4) -> np.ndarray:
    """Tangential velocity of the surface after an elastic impact over that before, of a sphere against a
    wall of its own material that it grips throughout.

    Without units: x'' = -x^(3/2) for the overlap and s'' = -7/2 r x^(1/2) s for the spring, with
    r = 8 G / (4/3 Y) of the effective moduli; friction moves the surface as if it had 2/7 of the mass.
    """
    ratio = 3. * (1. - poisson) / (2. - poisson)
    overlap, speed = np.zeros_like(poisson), np.ones_like(poisson)
    spring, slip = np.zeros_like(poisson), np.ones_like(poisson)
    while True:
        speed = speed - 0.5 * step * overlap**1.5
        slip = slip - 0.5 * step * 3.5 * ratio * np.sqrt(overlap) * spring
        overlap, spring = np.maximum(overlap + step * speed, 0.), spring + step * slip
        speed = speed - 0.5 * step * overlap**1.5
        slip = slip - 0.5 * step * 3.5 * ratio * np.sqrt(overlap) * spring
        if overlap.max() == 0.:
            return slip


@row("sticking", "Impact at 1 degree from the normal that sticks: Mindlin's spring under a changing load")
def sticking(bench: Bench) -> Row:
    poisson = np.array([0., 0.1, 0.2, 0.3, 0.4, 0.49])
    along, radius = 3.9 * np.sin(np.radians(1.)), 2.5e-3
    found = []
    for value in poisson:
        after = bench.run("sticking", f"{value:g}", **dict.fromkeys(POISSON, value)).particles
        found.append((after.velocity[0, 0] - radius * after.spin[0, 1]) / along)
    reference = rebound(poisson)
    checks = [absolute(f"surface velocity after over that before, Poisson's ratio {value:g}", a, b, 2e-4)
              for value, a, b in zip(poisson, found, reference)]

    def draw(axes) -> None:
        fine = np.linspace(0., 0.5, 51)
        axes[0].plot(fine, 2. / 7. * (rebound(fine)**2 - 1.) * 100., color="#777777", label="integrated apart from Eunoe")
        axes[0].plot(poisson, 2. / 7. * (np.array(found)**2 - 1.) * 100., "o", label="Eunoe")
        axes[0].axhline(0., color="k", linewidth=0.5)
        axes[0].set(xlabel="Poisson's ratio", ylabel="Gain of tangential energy (%)")
        axes[0].legend()
    return Row(checks, 1, draw)


def stacked(time: np.ndarray, restitution: float) -> np.ndarray:
    """Heights and velocities (m, m/s) of the two spheres of stacked_pair.prm at equidistant times, by the
    fourth-order method of Runge and Kutta; shape (n, 4)."""
    damping = -np.log(restitution) / np.hypot(np.log(restitution), np.pi)
    young = 1e6 / (2. * (1. - 0.3**2))

    def contact(overlap: float, closing: float, radius: float, mass: float) -> float:
        if overlap <= 0.:
            return 0.
        slope = 2. * young * np.sqrt(radius * overlap)
        return (2. / 3. * slope * overlap
                + 2. * np.sqrt(5. / 6.) * damping * np.sqrt(slope * mass) * closing)

    def rate(state: np.ndarray) -> np.ndarray:
        z, v = state[:2], state[2:]
        floor = contact(RADIUS - z[0], -v[0], RADIUS, MASS)
        between = contact(2. * RADIUS - z[1] + z[0], v[0] - v[1], RADIUS / 2., MASS / 2.)
        ceiling = contact(z[1] + RADIUS - 1.8e-3, v[1], RADIUS, MASS)
        return np.array([*v, (floor - between) / MASS - G, (between - ceiling) / MASS - G])

    states = [np.array([0.475e-3, 1.4e-3, 0., 0.])]
    step = time[1] - time[0]
    for _ in time[1:]:
        y = states[-1]
        a = rate(y)
        b = rate(y + 0.5 * step * a)
        c = rate(y + 0.5 * step * b)
        states.append(y + step / 6. * (a + 2. * b + 2. * c + rate(y + step * c)))
    return np.array(states)


@row("stacked_pair", "Two spheres squeezed between two walls")
def stacked_pair(bench: Bench) -> Row:
    checks, curves = [], {}
    for restitution in (1., 0.8):
        table = bench.run("stacked_pair", f"{restitution:g}", **{
            "lagrangian_physical_properties__particle_type_0__restitution_coefficient_particles": restitution,
            "lagrangian_physical_properties__restitution_coefficient_wall": restitution}).energies
        time = table["time"]
        reference = stacked(time, restitution)
        energy = 0.5 * MASS * np.sum(reference[:, 2:]**2, axis=1)
        found = {"height": (table["potential"] / (MASS * G), reference[:, :2].sum(axis=1)),
                 "velocity": (table["momentum_z"] / MASS, reference[:, 2:].sum(axis=1)),
                 "kinetic energy": (table["kinetic"], energy)}
        curves[restitution] = time, *found["height"]
        for name, (values, expected) in found.items():
            checks.append(absolute(f"e = {restitution:g}: {name} of both, worst error over its range",
                                   np.abs(values - expected).max() / np.ptp(expected), 0., 1e-3))

    def draw(axes) -> None:
        for (restitution, (time, values, expected)), colour in zip(curves.items(), ("#0072b2", "#d55e00")):
            axes[0].plot(1e3 * time, 1e3 * values, color=colour, label=f"Eunoe, e = {restitution:g}")
            axes[0].plot(1e3 * time, 1e3 * expected, "--", color="k", linewidth=0.7)
        axes[0].plot([], [], "--", color="k", linewidth=0.7, label="reference")
        axes[0].set(xlabel="Time (ms)", ylabel="Sum of the heights (mm)")
        # The legend is above the panel, as the curves fill the panel.
        axes[0].legend(loc="lower center", bbox_to_anchor=(0.5, 1.), ncol=3, columnspacing=0.9,
                       handlelength=1.2)
    return Row(checks, 1, draw)
