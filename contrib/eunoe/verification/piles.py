"""A pile comes to rest with EPSD's rolling resistance, and creeps with a constant torque (Ai et al. 2011)."""

from __future__ import annotations

import numpy as np

from .bench import Bench, Row, absolute, at_least, row
from .rolling import G, METHOD

MEAN_DIAMETER = 1e-3
FROM, TO = 0.8, 1.6  # interval that is evaluated (s)


@row("pile", "Pile at rest with EPSD, creep with a constant torque")
def pile(bench: Bench) -> Row:
    curves, sunk, speed = {}, {}, {}
    for name in ("epsd", "constant"):
        results = bench.run("pile", name, **{METHOD: name})
        table, radius = results.energies, results.particles.radius
        mass = 4. / 3. * np.pi * 2500. * np.sum(radius**3)
        time, height = table["time"], table["potential"] / (mass * G)
        curves[name] = time, height, np.sqrt(2. * table["kinetic"] / mass)
        sunk[name] = (height[np.argmax(time >= FROM)] - height[-1]) / MEAN_DIAMETER
        speed[name] = float(curves[name][2][time >= FROM].max())
    checks = [absolute(f"EPSD: sinking of the centre of mass from {FROM:g} to {TO:g} s, over a diameter",
                       sunk["epsd"], 0., 1e-4),
              # No law resists a spin about a contact's normal: a grain that turns in place wobbles.
              absolute("EPSD: largest root mean square speed from then on", speed["epsd"], 0., 1e-4, "m/s"),
              # Far beyond the limit for EPSD, so that the row distinguishes the two.
              at_least("constant torque: sinking over a diameter", sunk["constant"], 1e-3),
              at_least("constant torque: largest root mean square speed", speed["constant"], 1e-4, "m/s")]

    def draw(axes) -> None:
        for name, label, colour in (("epsd", "EPSD", "#0072b2"), ("constant", "constant torque", "#d55e00")):
            time, height, rms = curves[name]
            late = time >= FROM
            axes[0].plot(time[late], 1e6 * (height[late] - height[late][0]), color=colour,
                         label=label)
            axes[1].semilogy(time, np.maximum(rms, 1e-12), color=colour)
        axes[0].set(xlabel="Time (s)", ylabel="Rise of the centre of mass (µm)")
        axes[1].set(xlabel="Time (s)", ylabel="RMS speed (m/s)")
        axes[0].legend()
    return Row(checks, 2, draw)
