"""The pictures of doc/reproduction.md."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

from matplotlib.figure import Figure

from eunoe.pictures.record import Entry, digest, read_record, write_record
from eunoe.report.apparatus import Apparatus
from eunoe.report.bed_pictures import layers_figure
from eunoe.report.comparison_charts import (MOST_GROUPS, densities_figure, levels_figure, maps_figure, mechanism_figure,
                                              middle_figure, profiles_figure)
from eunoe.report.evidence import FIELDS
from eunoe.report.measured import Measured, read_measured
from eunoe.report.movie import movie_of, pass_of, strip_figure
from eunoe.report.run_folder import ReportError, Run, read_run
from eunoe.report.spread_run import Group, SpreadRun
from eunoe.vtk_files import read_vtu

from .results import HELD, OPEN, Findings, Result
from .runs import Campaign

RULE = "reproduction"
SHOWN_LAYERS = (2, 8, 14, 20)
RESOLUTION = 180  # dots per inch


def picture_name(name: str) -> str:
    return f"reproduction_{name}.png"


def _longest(findings: Findings, properties: str) -> Group | None:
    groups = findings.lengths(properties)
    return groups[-1] if groups else None


Todo = dict[str, tuple[Callable[[], Figure], Sequence[SpreadRun]]]  # by name: how to draw, and the runs shown


def _of_results(findings: Findings) -> Todo:
    """Pictures that the small results suffice for."""
    found: Todo = {}

    def add(name: str, draw: Callable[..., Figure], groups: list[Group], *more: Measured | None) -> None:
        groups = groups[-MOST_GROUPS:]  # the longest plates come last
        if groups:
            found[picture_name(name)] = (lambda: draw(groups, *more), [run for group in groups for run in group.runs])

    def add_map(name: str, group: Group | None) -> None:
        if group and group.mapped:
            found[picture_name(name)] = (lambda: maps_figure(group), group.runs)

    measured, plain = read_measured(), findings.plain()
    add("density", densities_figure, plain, measured)
    add("middle", middle_figure, plain, measured)
    add("levels", levels_figure, plain)
    add("mechanism", mechanism_figure, plain)
    add("profiles", profiles_figure, plain)
    for properties in ("PS1", "PS3"):
        add_map(f"maps_{properties}", _longest(findings, properties))
    for name, variants in (("held", HELD), ("open", OPEN)):
        groups = findings.of_variants(variants)
        add(name, densities_figure, groups, measured)
        add(f"{name}_mechanism", mechanism_figure, groups)
        for group in groups:
            add_map(f"{name}_maps_{group.runs[0].case.properties}", group)
    add("open_middle", middle_figure, findings.of_variants(OPEN), measured)
    shown = [[base, *groups[first:first + MOST_GROUPS - 1]] for base, groups in findings.variants()
             for first in range(0, len(groups), MOST_GROUPS - 1)]
    for number, groups in enumerate(shown, start=1):
        add(f"variants_{number}", densities_figure, groups, None)
    return found


def _state(campaign: Campaign, groups: Iterable[Group]) -> tuple[Result, Run, Apparatus] | None:
    """The first run, of the last of these groups, whose states are there."""
    for group in reversed(list(groups)):
        for result in group.runs:
            run = read_run(campaign.of(result.case)) if campaign.is_finished(result.case) else None
            if run and run.layers is not None and run.layer_pictures():
                return result, run, Apparatus.read(run.folder / "apparatus.json")
    return None


def _of_states(campaign: Campaign, groups: Iterable[Group], prefix: str = "") -> Todo:
    """Pictures of the particles."""
    state = _state(campaign, groups)
    if state is None:
        return {}
    result, run, apparatus = state
    pictures = {layer: read_vtu(file, FIELDS) for layer, file in run.layer_pictures().items() if layer in SHOWN_LAYERS}
    todo: Todo = {picture_name(f"{prefix}layers"): (
        lambda: layers_figure(pictures, apparatus, len(run.layers))[0], [result])}
    try:
        found = pass_of(run, run.layers, None)
    except ReportError:
        return todo
    return {**todo, picture_name(f"{prefix}pass"): (lambda: strip_figure(found, apparatus), [result])}


def draw(findings: Findings, campaign: Campaign | None, folder: Path) -> None:
    """Draws what can be drawn, and records what made it."""
    folder.mkdir(parents=True, exist_ok=True)
    entries = {}
    todo = _of_results(findings)
    if campaign:
        todo.update(_of_states(campaign, findings.lengths("PS1")))
        todo.update(_of_states(campaign, findings.of_variants(HELD)[:1], "held_"))
        todo.update(_of_states(campaign, findings.of_variants(OPEN), "open_"))
    for name, (make, results) in todo.items():
        make().savefig(folder / name, dpi=RESOLUTION)
        entries[name] = Entry(RULE, ", ".join(sorted({result.revision for result in results})), digest(folder / name))
    write_record(folder, {**read_record(folder), **entries})


def draw_movies(campaign: Campaign, findings: Findings) -> list[Path]:
    """Movies of a pass, as far as the runs have pictures of one. They stay beside the states, as they are large."""
    made = []
    for name, groups in (("pass", findings.lengths("PS1")), ("held_pass", findings.of_variants(HELD)[:1]),
                         ("open_pass", findings.of_variants(OPEN))):
        state = _state(campaign, groups)
        if state is None:
            continue
        _, run, apparatus = state
        try:
            movie = movie_of(pass_of(run, run.layers, None), apparatus)
        except ReportError:
            continue
        made.append(campaign.folder / f"reproduction_{name}.gif")
        made[-1].write_bytes(movie)
    return made
