"""The report of a spreading run."""

from __future__ import annotations

import numpy as np

from eunoe.vtk_files import VtkError

from . import bed_pictures
from .apparatus import Apparatus, ApparatusError
from .bed_maps import read_maps, write_for_others
from .case_section import add_case_section
from .comparison_charts import maps_figure
from .evidence import Evidence, Fields, gather
from .layer_charts import budget_figure, density_figure
from .layer_results import RESTS_BELOW, STATIC_BELOW, DensityNoise, counting_noise, moved_over_plate
from .measured import Measured, measured_for
from .movie import movie_of, pass_of, strip_figure
from .page import Page, table
from .quantities import SPACE, count, length, number, percent
from .run_folder import Layers, ReportError, Run
from .run_section import add_run_section
from .spread_run import Group, SpreadRun
from .summary_text import summary_text

OUTLETS = {"1": "Went to the collector", "2": "Fell into the gaps"}


def noise_of(layers: Layers, evidence: Evidence) -> DensityNoise | None:
    """The counting noise, from the sizes of the particles on the plate if they are known."""
    if evidence.apparatus is None or layers.particles[-1] == 0:
        return None
    grain = layers.mass[-1] / layers.particles[-1]
    if evidence.last is not None:
        masses = evidence.last["mass"][evidence.last["on_plate"] > 0].astype(float)
        if len(masses):
            grain = float((masses**2).sum() / masses.sum())
    return counting_noise(layers, evidence.apparatus.full_layer_mass, grain)


def progress_notice(run: Run, layers: Layers, apparatus: Apparatus | None) -> str:
    """A notice of what an unfinished run lacks; empty for a finished one."""
    if run.summary is None:
        expected = f" of {apparatus.n_layers}" if apparatus else ""
        return (f"The run has not finished (there is no summary.json): {len(layers)}{expected} "
                "layers are weighed so far.")
    if float(run.summary.get("simulated_time", np.inf)) < layers.time[-1] * (1. - 1e-9):
        return "summary.json is of an earlier run in this folder: layers.csv is newer."
    if apparatus and layers.last + 1 < apparatus.n_layers:
        return (f"{layers.last + 1} of {apparatus.n_layers} layers are weighed: the run was stopped, or it "
                "goes on and summary.json is of an earlier run in this folder.")
    return ""


def _layer_rows(layers: Layers, noise: DensityNoise | None) -> list[list[str]]:
    def density(value: float, error: float) -> str:
        if not np.isfinite(value):
            return ""
        return f"{100. * value:.1f}" + (f" ± {100. * error:.1f}" if np.isfinite(error) else "")

    unknown = np.full(len(layers), np.nan)
    lrd_noise, crd_noise = (noise.lrd, noise.crd) if noise else (unknown, unknown)
    return [[count(layers.layer[k]), f"{layers.time[k]:.4f}", count(layers.particles[k]),
             density(layers.lrd[k], lrd_noise[k]), density(layers.crd[k], crd_noise[k]),
             number(1e6 * layers.mass[k], 4), number(1e6 * layers.removed[k]),
             number(1e6 * layers.to_gap[k]), number(1e6 * layers.to_collector[k])]
            for k in range(len(layers))]


def _add_densities(page: Page, layers: Layers, noise: DensityNoise | None,
                   measured: Measured | None) -> None:
    page.heading("Density of the layers")
    caption = "Relative density of the layers." + (f" {measured.caption}" if measured else "")
    if noise is not None:
        caption += (" Bars: one standard deviation of counting noise, for particles that come and "
                    "leave independently; in a packing they do not, so it is an upper estimate.")
    page.figure(density_figure(layers, noise, measured), caption)
    page.fold("Numbers of all layers", table(
        ("Layer", "Time (s)", "Particles", "LRD (%)", "CRD (%)", "Mass (mg)", "Removed (mg)",
         "To gaps (mg)", "To collector (mg)"), _layer_rows(layers, noise)))


def _drawn(share: float, apparatus: Apparatus) -> str:
    """A sentence on how much of the depth a picture shows."""
    if share < 1.:
        return (f" Of the {length(apparatus.depth)} in depth the front "
                f"{length(share * apparatus.depth)} are drawn.")
    return f" The whole depth of {length(apparatus.depth)} is drawn."


def _add_pictures(page: Page, layers: Layers, evidence: Evidence) -> None:
    apparatus, last = evidence.apparatus, evidence.last
    if apparatus is None or last is None:
        return
    page.heading("The powder bed")
    layer = max(evidence.pictures)
    figure, share = bed_pictures.layers_figure(evidence.pictures, apparatus, layer + 1)
    page.figure(figure, "Side views of the measuring plate when layers were weighed, to scale; "
                "circles are the particles. The colour tells the pass that first brought a "
                "particle onto the plate; pale grey: not yet weighed there. Grey: plates and "
                "spreader. The newest layers are in front." + _drawn(share, apparatus))
    if layer > 0 and (last["tracked"] > 0).any():
        _add_displacement(page, last, apparatus, layer)
    figure, share = bed_pictures.overview_figure(last, apparatus, layer,
                                                 _weighing_times(layers, apparatus))
    page.figure(figure, f"The whole apparatus when layer {layer} was weighed: feedstock platform, "
                "transfer plate, measuring plate between its gaps, exit plate. Colours as above."
                + _drawn(share, apparatus))


def _weighing_times(layers: Layers, apparatus: Apparatus) -> dict[int, float]:
    """Times of all weighings so far and of the next, for which the platform may already rise
    (s), by the numbers of the layers."""
    times = layers.weighings
    if len(layers) > 1 and layers.last + 1 < apparatus.n_layers:
        times[layers.last + 1] = 2. * layers.time[-1] - layers.time[-2]
    return times


def _add_displacement(page: Page, last: Fields, apparatus: Apparatus, layer: int) -> None:
    tracked = last["tracked"] > 0
    moved = moved_over_plate(last)[tracked]
    figure, share = bed_pictures.displacement_figure(last, apparatus, layer)
    threshold = length(STATIC_BELOW)
    page.figure(figure, f"Displacement in x-y of the powder on the plate in pass {layer}, relative "
                f"to the plate. Grey: static, moved by less than {threshold}; white: not on the plate at both "
                f"weighings. Of {count(len(moved))} particles {percent((moved < STATIC_BELOW).mean(), 0)} are "
                f"static; the median of all is {number(1e6 * np.median(moved))}{SPACE}µm."
                + _drawn(share, apparatus))


def spreading_report(run: Run, layers: Layers, given: str = "") -> Page:
    """The page for a run that has weighed at least one layer.

    :param given: what was measured, as `measured_for` takes it
    """
    evidence = gather(run)
    measured = measured_for(given, [evidence.apparatus])
    noise = noise_of(layers, evidence)
    n = len(layers)
    page = Page(f"Spreading of {n} {'layer' if n == 1 else 'layers'} of powder", f"Run {run.name}")
    notice = progress_notice(run, layers, evidence.apparatus)
    for text in [notice] * bool(notice) + evidence.problems:
        page.notice(text)
    page.paragraph(summary_text(layers, evidence, noise, measured))
    _add_densities(page, layers, noise, measured)
    if evidence.apparatus is not None and measured and measured.is_of_paper:
        largest = evidence.last["diameter"].max() if evidence.last else 0.
        add_case_section(page, layers, evidence.apparatus, measured, float(largest))
    _add_pictures(page, layers, evidence)
    page.heading("Mass, force and time of the layers")
    page.figure(budget_figure(layers),
                "Per layer: (a) powder on the plate at the weighing, what came new in the pass, "
                "and what the pass removed of the older powder (below 0); (b) powder that fell "
                "into the gaps and that went to the collector since the last weighing; (c) force "
                "on the spreader while its lowest line is over the plate; (d) wall-clock time "
                "since the last weighing.")
    _add_maps(page, run, layers, evidence.apparatus)
    add_run_section(page, run, OUTLETS)
    return page


def _add_maps(page: Page, run: Run, layers: Layers, apparatus: Apparatus | None) -> None:
    """Of runs whose layers all have pictures; also as a table, bed.csv."""
    pictures = run.layer_pictures()
    table_of_maps = run.folder / "bed.csv"
    if apparatus is None or len(pictures) < max(len(layers), 3):
        # It may be all that is left of the pictures, so it stays.
        if table_of_maps.exists() and table_of_maps.stat().st_mtime < (run.folder / "layers.csv").stat().st_mtime:
            page.notice("bed.csv is older than layers.csv: it may be of an earlier run in this folder.")
        return
    try:
        maps = read_maps(pictures, apparatus)
    except (VtkError, KeyError):
        return  # a broken picture has its notice above
    page.heading("Displacement and density along the plate")
    group = Group(run.name, [SpreadRun(run.name, layers, apparatus, maps)])
    page.figure(maps_figure(group), "By place and layer: (a) mean displacement in the pass of what lay on the plate; "
                f"grey: less than {length(RESTS_BELOW)}; lines: inner ends of the zones at rest; (b) what the pass "
                "added, as density of its layer.")
    try:
        write_for_others(table_of_maps, maps)
    except OSError as error:
        page.notice(f"The maps are not in numbers in bed.csv: {error.strerror}.")
    else:
        page.paragraph("bed.csv in the run's folder has the maps in numbers.")


def add_movie(page: Page, run: Run, layers: Layers, layer: int | None) -> None:
    """A movie of a pass and a strip of its pictures; of the last pass that has some if none is given."""
    found = pass_of(run, layers, layer)
    try:
        apparatus = Apparatus.read(run.folder / "apparatus.json")
    except ApparatusError as error:
        raise ReportError(f"No movie: {error}") from error
    page.heading(f"Pass {found.layer}")
    caption = (f"Pass {found.layer}, seen along z, to scale. Colours: how far a particle has moved over the plate "
               f"since the last weighing; grey: less than {length(STATIC_BELOW)}; white: new powder.")
    page.movie(movie_of(found, apparatus), caption)
    page.figure(strip_figure(found, apparatus), caption)
