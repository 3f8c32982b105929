"""Impacts that stick: what Mindlin's spring gives back when the load on it rises and falls. No closed
formula is known; the reference integrates the two equations of motion by itself."""

from __future__ import annotations

import numpy as np

from .bench import Bench, Row, absolute, row

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
        axes[0].plot(fine, 2. / 7. * (rebound(fine)**2 - 1.) * 100., color="#777777", label="own integration")
        axes[0].plot(poisson, 2. / 7. * (np.array(found)**2 - 1.) * 100., "o", label="Eunoe")
        axes[0].axhline(0., color="k", linewidth=0.5)
        axes[0].set(xlabel="Poisson's ratio", ylabel="Gain of tangential energy (%)")
        axes[0].legend()
    return Row(checks, 1, draw)
