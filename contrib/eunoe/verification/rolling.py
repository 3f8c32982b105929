"""A sphere on a plane: from slip to roll, down an incline, braked by rolling resistance."""

from __future__ import annotations

import numpy as np

from .bench import Bench, Row, absolute, relative, row

G, RADIUS, DENSITY = 9.81, 0.5e-3, 1000.
MASS = 4. / 3. * np.pi * DENSITY * RADIUS**3
LABELS = {"constant": "constant torque", "epsd": "EPSD"}
METHOD = "model_parameters__rolling_resistance_torque_method"
GRAVITY = "lagrangian_physical_properties__g"
FRICTION = ("lagrangian_physical_properties__particle_type_0__friction_coefficient_particles",
            "lagrangian_physical_properties__friction_coefficient_wall")


@row("slip_to_roll", "From slip to roll on a plane")
def slip_to_roll(bench: Bench) -> Row:
    mu, u0 = 0.2, 0.1
    table = bench.run("slip_to_roll").energies
    time, speed = table["time"], table["momentum_x"] / MASS
    end = 2. * u0 / (7. * mu * G)
    slides = time < 0.98 * end
    reference = np.where(time < end, u0 - mu * G * time, 5. / 7. * u0)
    seen = time[np.argmax(np.abs(speed - 5. / 7. * u0) < 1e-3 * u0)]
    checks = [absolute("speed while it slides, worst error over the first speed",
                       np.abs(speed - reference)[slides].max() / u0, 0., 1e-3),
              relative("end of the slip", 1e3 * seen, 1e3 * end, 1e-2, "ms"),
              relative("speed in the end over the first", speed[-1] / u0, 5. / 7., 1e-4)]

    def draw(axes) -> None:
        axes[0].plot(1e3 * time, speed / u0, color="#0072b2", label="Eunoe")
        axes[0].plot(1e3 * time, reference / u0, "--", color="#d55e00", label="rigid sphere")
        axes[0].set(xlabel="Time (ms)", ylabel="Speed over the first one")
        axes[0].legend()
    return Row(checks, 1, draw)


def acceleration(bench: Bench, label: str, degrees: float, method: str, mu: float) -> float:
    """Acceleration along the incline in the last 5 ms (m/s2): by then EPSD's spring is
    mobilised."""
    angle = np.radians(degrees)
    settings = {GRAVITY: f"{G * np.sin(angle):.17g}, 0, {-G * np.cos(angle):.17g}", METHOD: method,
                **dict.fromkeys(FRICTION, mu)}
    table = bench.run("incline", f"{label}_{degrees:g}", **settings).energies
    time, speed = table["time"], table["momentum_x"] / MASS
    late = time > 0.015
    return float(np.polyfit(time[late], speed[late], 1)[0])


@row("incline", "Sphere on an incline, with and without rolling resistance")
def incline(bench: Bench) -> Row:
    mu, mu_r = 0.2, 0.1
    steep, flat = np.arange(5., 75., 7.5), np.degrees(np.arctan(mu_r * np.arange(0.4, 2.3, 0.4)))
    flat = np.append(flat, np.degrees(np.arctan(mu_r * np.array([0.95, 1.05]))))
    flat.sort()
    a, n = np.radians(steep), np.radians(flat)
    free = np.where(mu >= 2. / 7. * np.tan(a), 5. / 7. * G * np.sin(a), G * (np.sin(a) - mu * np.cos(a)))
    braked = np.where(np.tan(n) > mu_r, 5. / 7. * G * (np.sin(n) - mu_r * np.cos(n)), 0.)
    found = {"none": np.array([acceleration(bench, "none", d, "none", mu) for d in steep]),
             "constant": np.array([acceleration(bench, "constant", d, "constant", 0.5) for d in flat]),
             "epsd": np.array([acceleration(bench, "epsd", d, "epsd", 0.5) for d in flat])}
    holds = np.tan(n) < mu_r
    checks = [absolute("no resistance, friction 0.2: acceleration, worst relative error",
                       np.abs(found["none"] / free - 1.).max(), 0., 2e-3)]
    for name, tolerance in (("constant", 1e-3), ("epsd", 1e-2)):
        worst = np.abs(found[name] - braked)
        checks += [absolute(f"{name} torque: acceleration up to tan(angle) = 0.95 mu_r, largest",
                            worst[holds].max(), 0., 1e-2, "m/s2"),
                   absolute(f"{name} torque: acceleration beyond, worst error over g mu_r",
                            worst[~holds].max() / (G * mu_r), 0., tolerance)]

    def draw(axes) -> None:
        axes[0].plot(steep, free, color="#777777", label="rigid sphere")
        axes[0].plot(steep, found["none"], "o", markerfacecolor="none", label="friction 0.2")
        fine = np.linspace(0., flat.max(), 200)
        slope = np.radians(fine)
        axes[1].plot(fine, np.maximum(0., 5. / 7. * G * (np.sin(slope) - mu_r * np.cos(slope))),
                     color="#777777", label="rigid sphere")
        for name, mark in (("constant", "o"), ("epsd", "x")):
            axes[1].plot(flat, found[name], mark, markerfacecolor="none", label=f"{LABELS[name]}, 0.1")
        for panel in axes:
            panel.set(xlabel="Incline (degrees)", ylabel="Acceleration (m/s$^2$)")
            panel.legend()
    return Row(checks, 2, draw)


@row("rolling_decay", "Decay of rolling under rolling resistance")
def decay(bench: Bench) -> Row:
    w0, mu_r = 100., 0.1
    rate = 5. / 7. * mu_r * G / RADIUS
    checks, curves = [], {}
    for name in ("constant", "epsd"):
        table = bench.run("rolling_decay", name, **{METHOD: name}).energies
        time, spin = table["time"], np.sqrt(5. * table["rotational"] / MASS) / RADIUS
        curves[name] = time, spin
        # EPSD's spring is mobilised within the first 2 ms.
        window = (time > 2e-3) & (time < 0.06)
        slope = -np.polyfit(time[window], spin[window], 1)[0]
        checks.append(relative(f"{name}: slope of the spin", slope, rate, 1e-3, "rad/s2"))
        checks.append(absolute(f"{name}: spin at the end over the first", spin[-1] / w0, 0.,
                               1e-6 if name == "epsd" else 1e-3))

    def draw(axes) -> None:
        # The first line is wide enough to be seen behind the second.
        for width, (name, (time, spin)) in zip((3., 1.2), curves.items()):
            axes[0].plot(1e3 * time, spin, linewidth=width, label=LABELS[name])
        axes[0].plot(1e3 * time, np.maximum(0., w0 - rate * time), "--", color="#777777", label="rigid sphere")
        axes[0].set(xlabel="Time (ms)", ylabel="Spin (rad/s)")
        axes[0].legend()
    return Row(checks, 1, draw)
