"""Bulk laws of granular matter: the silo of Janssen and the discharge of Beverloo."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from eunoe.vtk_files import read_pvd, read_vtu

from .bench import Bench, Row, absolute, at_least, relative, row
from .rolling import FRICTION, G

DENSITY = 2500.
NUMBER = "lagrangian_physical_properties__particle_type_0__number_of_particles"
SEED = "simulation_control__seed"


def carried(bench: Bench, label: str, **settings) -> tuple[float, float, float]:
    """Mass filled in, force on the floor and on the wall, both downwards (kg, N), while the floor sinks."""
    results = bench.run("janssen", label, **settings)
    mass = 4. / 3. * np.pi * DENSITY * float(np.sum(results.particles.radius**3))
    forces = [results.solid_forces(solid) for solid in (1, 0)]
    floor, wall = (-float(np.mean(table["f_z"][table["time"] > 0.55])) for table in forces)
    return mass, floor, wall


def saturation(mass: np.ndarray, floor: np.ndarray) -> float:
    """The mass M_s of F = M_s g (1 - exp(-M / M_s)) by least squares."""
    tried = np.linspace(0.02, 5., 5000) * mass.max()
    errors = [np.sum((s * (1. - np.exp(-mass / s)) - floor / G)**2) for s in tried]
    return float(tried[int(np.argmin(errors))])


@row("janssen", "Janssen: the floor of a silo carries a limited mass", is_long=True)
def janssen(bench: Bench) -> Row:
    fillings, seeds = (300, 700, 1400, 2200), (1, 2, 3)
    # What a single filling puts on the floor scatters by a tenth.
    rough = np.mean([[carried(bench, f"{n}_seed{seed}", **{NUMBER: n, SEED: seed}) for n in fillings]
                     for seed in seeds], axis=0).T
    smooth = carried(bench, "smooth", **{NUMBER: 700, FRICTION[1]: 0})
    mass, floor, wall = rough
    limit = saturation(mass, floor)
    model = limit * (1. - np.exp(-mass / limit))
    # K in M_s = rho_b A D / (4 mu K): the share of the axial stress that acts on the wall.
    diameter, friction, bulk = 0.01, 0.5, 0.6 * DENSITY
    share = bulk * np.pi / 4. * diameter**3 / (4. * friction * limit)
    checks = [absolute("floor and wall carry the weight, worst relative error",
                       np.abs((floor + wall) / (mass * G) - 1.).max(), 0., 1e-2),
              relative("smooth wall: the floor carries all, force over the weight",
                       smooth[1] / (smooth[0] * G), 1., 1e-2),
              absolute("Janssen's curve with one fitted mass, worst error over that mass",
                       np.abs(floor / G - model).max() / limit, 0., 0.06),
              at_least("mass filled in over that on the floor, 2200 grains", mass[-1] * G / floor[-1], 3.),
              # Between the active and the passive state of a material with 30 degrees of friction, 1/3 to 3.
              absolute("logarithm of the stress ratio K that follows", np.log(share), 0., np.log(3.))]

    def draw(axes) -> None:
        fine = np.linspace(0., 1.05 * mass.max(), 200)
        axes[0].plot(1e3 * fine, 1e3 * limit * (1. - np.exp(-fine / limit)), color="#777777",
                     label=f"Janssen, {1e3 * limit:.2f} g")
        axes[0].plot(1e3 * fine, 1e3 * fine, ":", color="#777777", label="all of it")
        axes[0].plot(1e3 * mass, 1e3 * floor / G, "o", label="wall friction 0.5")
        axes[0].plot(1e3 * smooth[0], 1e3 * smooth[1] / G, "s", markerfacecolor="none", label="smooth wall")
        axes[0].set(xlabel="Mass filled in (g)", ylabel="Mass on the floor (g)", ylim=(0., 1.3e3 * smooth[0]))
        axes[0].legend()
    return Row(checks, 1, draw)


def bulk_density(folder: Path) -> float:
    """Bulk density before the hole is opened, between 3 mm and 12 mm over the floor."""
    particles = read_vtu(read_pvd(folder / "out.pvd")[0].file, ["mass"])
    inside = (particles["points"][:, 2] > 3e-3) & (particles["points"][:, 2] < 12e-3)
    return float(particles["mass"][inside].sum(dtype=float)) / (np.pi * 8e-3**2 * 9e-3)


@row("beverloo", "Beverloo: discharge through a hole", is_long=True)
def beverloo(bench: Bench) -> Row:
    holes = 1e-3 * np.array([5., 6., 7., 8.])
    mean_mass = np.pi / 6. * DENSITY * np.mean(np.array([0.8, 0.9, 1., 1.1, 1.2])**3) * 1e-9
    rates, halves, curves = [], [], {}
    for hole in holes:
        results = bench.run("beverloo", f"{1e3 * hole:g}mm", **{
            "solid_objects__solid_surfaces__solid_object_1__mesh__scale": hole / 2.})
        time, left = results.energies["time"], results.energies["particles"]
        curves[hole] = time, left
        # From the first 100 grains until 1300 are left, when the filling is still 6 mm high; or to
        # the end.
        window = (left < 2900) & (left > 1300)
        middle = time[window].mean()
        slope = [-np.polyfit(time[part], left[part], 1)[0]
                 for part in (window, window & (time < middle), window & (time >= middle))]
        rates.append(mean_mass * slope[0])
        halves.append(slope[2] / slope[1])
    rates = np.array(rates)
    density = bulk_density(results.folder)
    slope, offset = np.polyfit(holes, rates**0.4, 1)
    k, factor = -offset / slope / 1e-3, slope**2.5 / (density * np.sqrt(G))
    fitted = factor * density * np.sqrt(G) * (holes - k * 1e-3)**2.5
    # Beverloo, Leniger, van de Velde (1961): C = 0.58, k = 1.4 for spheres; Nedderman (1992): 1.5 +- 0.1.
    # The smallest hole, of five grains, is close to arching and flows in bursts.
    checks = [absolute("holes from 6 mm: rate of the second half of a discharge over the first, largest error",
                       np.abs(np.array(halves)[1:] - 1.).max(), 0., 0.1),
              absolute("rate against C rho_b sqrt(g) (D - k d)^5/2, worst relative error",
                       np.abs(rates / fitted - 1.).max(), 0., 0.05),
              absolute("k, in mean diameters", k, 1.4, 0.4),
              absolute("C", factor, 0.58, 0.1)]

    def draw(axes) -> None:
        for hole, (time, left) in curves.items():
            axes[0].plot(time, left, label=f"hole of {1e3 * hole:g} mm")
        axes[0].set(xlabel="Time (s)", ylabel="Grains left")
        axes[0].legend()
        fine = np.linspace(k * 1e-3, 8.5e-3, 50)
        axes[1].plot(1e3 * fine, (1e3 * factor * density * np.sqrt(G) * (fine - k * 1e-3)**2.5)**0.4,
                     color="#777777", label=f"C = {factor:.2f}, k = {k:.2f}")
        axes[1].plot(1e3 * fine, (1e3 * 0.58 * density * np.sqrt(G) * np.maximum(fine - 1.4e-3, 0.)**2.5)**0.4,
                     ":", color="#d55e00", label="C = 0.58, k = 1.4")
        axes[1].plot(1e3 * holes, (1e3 * rates)**0.4, "o", label="Eunoe")
        axes[1].set(xlabel="Hole (mm)", ylabel="(rate in g/s)$^{2/5}$")
        axes[1].legend()
    return Row(checks, 2, draw)
