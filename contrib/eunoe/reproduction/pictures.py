"""The pictures of doc/reproduction.md."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from matplotlib.figure import Figure

from eunoe.pictures.record import Entry, digest, read_record, write_record
from eunoe.report.apparatus import Apparatus
from eunoe.report.bed_pictures import layers_figure
from eunoe.report.comparison_charts import (MOST_GROUPS, densities_figure, maps_figure, mechanism_figure,
                                              middle_figure, profiles_figure)
from eunoe.report.evidence import FIELDS
from eunoe.report.measured import read_measured
from eunoe.report.movie import movie_of, pass_of, strip_figure
from eunoe.report.run_folder import ReportError, read_run
from eunoe.report.spread_run import Group
from eunoe.vtk_files import read_vtu

from .results import Findings, Result
from .runs import Campaign

RULE = "reproduction"
SHOWN_LAYERS = (2, 8, 14, 20)
MOVIE = "reproduction_pass.gif"  # in the folder of the states, as it is large
RESOLUTION = 180  # dots per inch


def picture_name(name: str) -> str:
    return f"reproduction_{name}.png"


def _longest(findings: Findings, properties: str) -> Group | None:
    groups = findings.lengths(properties)
    return groups[-1] if groups else None


def _of_results(findings: Findings) -> dict[str, tuple[Callable[[], Figure], list[Result]]]:
    """Pictures that the small results suffice for, with the runs that they show."""
    plain = findings.plain()[:MOST_GROUPS]
    found: dict[str, tuple[Callable[[], Figure], list[Result]]] = {}

    def add(name: str, draw: Callable[[], Figure], groups: list[Group]) -> None:
        found[picture_name(name)] = (draw, [run for group in groups for run in group.runs])

    if plain:
        add("density", lambda: densities_figure(plain, read_measured()), plain)
        add("middle", lambda: middle_figure(plain, read_measured()), plain)
        add("mechanism", lambda: mechanism_figure(plain), plain)
        add("profiles", lambda: profiles_figure(plain), plain)
    for properties in ("PS1", "PS3"):
        if group := _longest(findings, properties):
            add(f"maps_{properties}", lambda group=group: maps_figure(group), [group])
    for base, variants in findings.variants()[:1]:
        groups = [base, *variants][:MOST_GROUPS]
        add("variants", lambda: densities_figure(groups, None), groups)
    return found


def _of_states(campaign: Campaign, findings: Findings) -> dict[str, tuple[Callable[[], Figure], list[Result]]]:
    """Pictures of the particles, from the first run of the longest plate of PS1 whose states are there."""
    for group in reversed(findings.lengths("PS1")):
        result = group.runs[0]
        run = read_run(campaign.of(result.case)) if campaign.is_finished(result.case) else None
        if run is None or run.layers is None:
            continue
        try:
            found = pass_of(run, run.layers, None)
        except ReportError:
            continue
        apparatus = Apparatus.read(run.folder / "apparatus.json")
        pictures = {layer: read_vtu(file, FIELDS) for layer, file in run.layer_pictures().items()
                    if layer in SHOWN_LAYERS}
        return {picture_name("pass"): (lambda: strip_figure(found, apparatus), [result]),
                picture_name("layers"): (lambda: layers_figure(pictures, apparatus, len(run.layers))[0], [result])}
    return {}


def draw(findings: Findings, campaign: Campaign | None, folder: Path) -> None:
    """Draws what can be drawn, and records what made it."""
    folder.mkdir(parents=True, exist_ok=True)
    record = read_record(folder)
    todo = {**_of_results(findings), **(_of_states(campaign, findings) if campaign else {})}
    for name, (make, results) in todo.items():
        make().savefig(folder / name, dpi=RESOLUTION)
        revisions = ", ".join(sorted({result.revision for result in results}))
        record[name] = Entry(RULE, revisions, digest(folder / name))
    write_record(folder, record)


def draw_movie(campaign: Campaign, findings: Findings) -> Path | None:
    """The movie of a pass of the longest plate of PS1 of which there are pictures; None if there are none."""
    for group in reversed(findings.lengths("PS1")):
        case = group.runs[0].case
        run = read_run(campaign.of(case)) if campaign.is_finished(case) else None
        if run is None or run.layers is None:
            continue
        try:
            movie = movie_of(pass_of(run, run.layers, None), Apparatus.read(run.folder / "apparatus.json"))
        except ReportError:
            continue
        (campaign.folder / MOVIE).write_bytes(movie)
        return campaign.folder / MOVIE
    return None
