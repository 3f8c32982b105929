"""The report of a run of the heap instrument."""

from __future__ import annotations

import numpy as np

from .heap_charts import map_figure, particles_figure, profile_figure
from .heap_results import Disc, Profile, Views, read_disc, read_map, read_profile, read_views
from .page import Page
from .quantities import SPACE, length, mass, number, percent
from .run_folder import Run
from .run_section import add_run_section
from eunoe.vtk_files import VtkError, read_vtu

# Measured by Gaboriault et al. (2025) for their powder on a disc of 10 mm.
MEASURED_ANGLE = 37.5
# A column keeps more than this share of what was filled in, and this many heaps of the measured angle: heaps of cohesive
# powder on small discs have up to 1.8 of them, columns 3 and more, and of a small filling most stays on any disc.
COLUMN_SHARE, COLUMN_HEAPS = 0.6, 2.4


def _degrees(value: float) -> str:
    return f"{value:.1f}{SPACE}degrees"


def _summary_text(run: Run, views: Views, disc: Disc) -> str:
    text = (f"The heap on the disc of {length(disc.diameter)} has a base angle of "
            f"{_degrees(views.mean_angle)} (mean of {len(views.base_angle)} views, standard deviation "
            f"{_degrees(views.angle_spread)}) and is {length(views.mean_height)} high. "
            f"{mass(views.mass_on_disc)} of powder lie on the disc, {mass(views.mass_drained)} have "
            "drained.")
    if run.summary and "heap_measured_base_angle" in run.summary:
        text += (" The measured profile that was given has a base angle of "
                 f"{_degrees(float(run.summary['heap_measured_base_angle']))}; the heights differ "
                 "by " + length(float(run.summary["heap_profile_difference"])) + " (root mean square).")
    return text


def _size_notice(disc: Disc, particles: dict[str, np.ndarray] | None) -> str:
    if disc.diameter > 9e-3 or particles is None or len(particles["diameter"]) == 0:
        return ""
    ratio = disc.diameter / float(particles["diameter"].mean())
    return (f"The disc is {number(ratio, 2)} mean diameters wide. On so small a disc cohesion and the "
            "size of the particles raise the angle: it is to be compared with runs on a disc of the same size, not with "
            f"angles of large heaps, as the {_degrees(MEASURED_ANGLE)} that Gaboriault et al. (2025) measured of their "
            f"Ti-6Al-4V powder on 10{SPACE}mm.")


def _column_notice(run: Run, views: Views, disc: Disc) -> str:
    """A notice that there is no heap: a powder that flows leaves at most a cone on the disc."""
    inserted = float(run.summary["inserted_mass"]) if run.summary else 0.
    if inserted <= 0. or views.mass_on_disc < max(COLUMN_SHARE * inserted, COLUMN_HEAPS * disc.heap_mass(MEASURED_ANGLE)):
        return ""
    return (f"{percent(views.mass_on_disc / inserted, 0)} of the powder stayed on the disc: cohesion "
            "holds it up as a column, and the angle says only how much was filled in. Fill in more, or "
            "take a wider disc and tube.")


def _read_particles(page: Page, run: Run) -> dict[str, np.ndarray] | None:
    picture = run.last_picture("_heap")
    if picture is None:
        return None
    try:
        particles = read_vtu(picture[1], ("diameter",))
    except VtkError as error:
        page.notice(str(error))
        return None
    return particles if "diameter" in particles and len(particles["points"]) else None


def _add_profile(page: Page, profile: Profile, views: Views, disc: Disc) -> None:
    page.heading("Profile and angles")
    measured = " Black: the measured profile." if np.isfinite(profile.measured).any() else ""
    page.figure(profile_figure(profile, views, disc.diameter),
                "(a) Height of the outline across the disc, mean and standard deviation of the "
                f"views.{measured} (b) Base angle of each view: of the isosceles triangle with the "
                "disc's diameter as its base and the outline's area. The red lines show the mean.")


def heap_report(run: Run) -> Page:
    """The page for a run that has measured its heap."""
    views = read_views(run.folder / "heap.csv")
    profile = read_profile(run.folder / "heap_profile.csv")
    disc = read_disc(run.folder / "apparatus.json")
    page = Page(f"Heap of powder with a base angle of {_degrees(views.mean_angle)}",
                f"Run {run.name}")
    particles = _read_particles(page, run)
    for notice in (_column_notice(run, views, disc), _size_notice(disc, particles)):
        if notice:
            page.notice(notice)
    page.paragraph(_summary_text(run, views, disc))
    page.heading("The heap")
    page.figure(map_figure(read_map(run.folder / "heap_map.pgm"), views, disc.diameter, disc.rim),
                f"Mean of the {len(views.base_angle)} views, to scale: black where the heap is seen "
                "in all of them, white where in none. Red: the triangle of the same area, whose "
                "base angle is the result. Grey: the disc.")
    if particles is not None:
        figure, share = particles_figure(particles, float(views.height.max()), disc.diameter, disc.rim)
        drawn = "" if share == 1. else f" The front {percent(share, 0)} of them are drawn."
        page.figure(figure, "The particles when the heap was measured, seen along z, to scale; what clings "
                    "to the lifted tube is not shown." + drawn)
    _add_profile(page, profile, views, disc)
    add_run_section(page, run, {})
    return page
