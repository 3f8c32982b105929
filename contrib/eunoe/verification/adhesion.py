"""Pull-off of a sphere from a plate, quasi-static: DMT with its van der Waals tail, and JKR."""

from __future__ import annotations

import numpy as np

from .bench import Bench, Row, absolute, relative, row

SURFACE_ENERGY = ("lagrangian_physical_properties__particle_type_0__surface_energy_particles",
                  "lagrangian_physical_properties__surface_energy_wall")
# For each property set, for two particles of 75 um: surface energy (J/m2), pull-off force (N), end
# of the plateau and cut-off (nm).
PAPER_SETS = {"PS1": (35e-5, 8.25e-8, 3.89, 12.3), "PS2": (25e-5, 5.89e-8, 4.61, 14.6),
              "PS3": (8e-5, 1.88e-8, 8.14, 25.8)}


@row("pull_off_dmt", "Pull-off, DMT: the paper's powder, 75 um")
def dmt(bench: Bench) -> Row:
    checks, curves = [], {}
    start, radius, hamaker = 18.8e-6, 18.75e-6, 4e-19
    for name, (energy, force, plateau, cut_off) in PAPER_SETS.items():
        table = bench.run("pull_off_dmt", name, **dict.fromkeys(SURFACE_ENERGY, energy)).solid_forces(0)
        time = table["time"]
        separation = start - radius - 1e-4 * time
        pull = table["f_z"]  # on the plate, upwards while the sphere attracts it
        rises = (time < 0.549e-3) & (separation > 0.)
        separation, pull = 1e9 * separation[rises], pull[rises]
        curves[name] = separation, pull
        largest = pull.max()
        checks += [relative(f"{name}: pull-off force", 1e9 * largest, 1e9 * force, 1e-2, "nN"),
                   relative(f"{name}: end of the plateau", separation[pull > 0.9999 * largest].max(), plateau,
                            1e-2, "nm"),
                   relative(f"{name}: end of the tail", separation[pull > 0.].max(), cut_off, 1e-2, "nm")]
        tail = (separation > 1.02 * plateau) & (separation < 0.98 * cut_off)
        reference = hamaker * radius / (6. * (1e-9 * separation[tail])**2)
        checks.append(absolute(f"{name}: tail, worst relative error to A R / (6 s^2)",
                               np.abs(pull[tail] / reference - 1.).max(), 0., 1e-5))

    def draw(axes) -> None:
        for (name, (separation, pull)), colour in zip(curves.items(), ("#0072b2", "#d55e00", "#009e73")):
            _, force, plateau, cut_off = PAPER_SETS[name]
            axes[0].plot(separation, 1e9 * pull, color=colour, label=name)
            axes[0].plot((plateau, cut_off), (1e9 * force, 1e8 * force), "o", color=colour,
                         markerfacecolor="none")
        axes[0].plot([], [], "o", color="k", markerfacecolor="none", label="reference")
        axes[0].set(xlabel="Gap (nm)", ylabel="Attraction (nN)", xlim=(0., 32.))
        axes[0].legend()
    return Row(checks, 1, draw)


def jkr_curve(work: float, radius: float, young: float) -> tuple[np.ndarray, np.ndarray]:
    """Overlap and force (repulsion positive) for contact radii from that of the tearing neck on."""
    torn = np.cbrt(np.pi * work * radius**2 / (8. * young))
    area = torn * np.linspace(1., 12., 50000)
    overlap = area**2 / radius - np.sqrt(2. * np.pi * work * area / young)
    force = 4. / 3. * young * area**3 / radius - np.sqrt(8. * np.pi * work * young * area**3)
    return overlap, force


@row("pull_off_jkr", "Pull-off, JKR")
def jkr(bench: Bench) -> Row:
    work, radius, young = 0.1, 0.5e-3, 1e7 / (2. * (1. - 0.3**2))
    table = bench.run("pull_off_jkr").solid_forces(0)
    time = table["time"]
    separation = 1e-6 - 1e-3 * np.minimum(time, 6e-3 - time)
    repulsion = -table["f_z"]
    rises = time <= 3e-3
    pull_off = 1.5 * np.pi * work * radius
    overlap, force = jkr_curve(work, radius, young)
    neck = 3. * np.cbrt(np.pi * work * radius**2 / (8. * young))**2 / radius
    made = ~rises & (separation < 0.98 * neck) | rises & (separation < -1e-9)
    reference = np.interp(-separation, overlap, force)
    # The plate turns back within a step of 1 nm, so the way down is shifted by as much.
    checks = [
        relative("pull-off force", -1e3 * repulsion.min(), 1e3 * pull_off, 1e-2, "mN"),
        relative("separation at which the neck tears", 1e6 * separation[~rises & (repulsion < 0.)].max(), 1e6 * neck, 1e-2,
                 "um"),
        absolute("force before the touch over the pull-off force",
                 np.abs(repulsion[rises & (separation > 0.)]).max() / pull_off, 0., 0.),
        relative("attraction at the touch over the pull-off force",
                 -repulsion[rises & (separation < -1e-12)][0] / pull_off, 8. / 9., 1e-2),
        absolute("force at all separations, worst error over the pull-off force",
                 np.abs(repulsion - reference)[made].max() / pull_off, 0., 2e-3)]

    def draw(axes) -> None:
        axes[0].plot(1e6 * separation[rises], 1e3 * repulsion[rises], color="#d55e00", label="Eunoe, approach")
        axes[0].plot(1e6 * separation[~rises], 1e3 * repulsion[~rises], color="#0072b2", label="Eunoe, pull")
        axes[0].plot(-1e6 * overlap, 1e3 * force, "--", color="#777777", label="theory")
        axes[0].set(xlabel="Gap (µm)", ylabel="Force, repulsion positive (mN)", xlim=(-2.1, 1.5),
                    ylim=(-0.3, 0.5))
        axes[0].legend()
    return Row(checks, 1, draw)
