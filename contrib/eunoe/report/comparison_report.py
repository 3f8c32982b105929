"""The report of several spreading runs in one page."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from eunoe.vtk_files import VtkError

from .apparatus import Apparatus, ApparatusError
from .bed_maps import read_maps
from .comparison_charts import (MOST_GROUPS, densities_figure, last_common_layer, maps_figure, mechanism_figure,
                                middle_figure, profiles_figure)
from .comparison_text import densities_table, differences_table, measured_group, rest_table, rise_sentence
from .measured import Measured, measured_for
from .page import Page
from .quantities import length
from .run_folder import ReportError, Run, read_run
from .spread_run import Group, SpreadRun
from .spreading_report import progress_notice

BAND = "Lines: means over the runs; bands: one standard deviation of a single run."


def spread_run(run: Run, problems: list[str]) -> SpreadRun:
    """The run with the maps of its pictures; sentences in `problems` say why it has none, and what is still to come."""
    if run.layers is None:
        raise ReportError(f"{run.folder} is no spreading run: only those are compared.")
    apparatus, maps = None, None
    try:
        apparatus = Apparatus.read(run.folder / "apparatus.json")
        pictures = run.layer_pictures()
        lacking = set(range(max(pictures, default=-1) + 1)) - set(pictures)
        if lacking:
            problems.append(f"{run.name} has no maps, as the picture of layer {min(lacking)} is missing.")
        elif pictures:
            maps = read_maps(pictures, apparatus)
        else:
            problems.append(f"{run.name} has no pictures of its layers, so it has no maps.")
    except (ApparatusError, VtkError, KeyError) as error:
        problems.append(f"{run.name} has no maps: {error}")
    notice = progress_notice(run, run.layers, apparatus)
    if notice:
        problems.append(f"{run.name}: {notice}")
    return SpreadRun(run.name, run.layers, apparatus, maps)


def _without_seed(name: str) -> str:
    return re.sub(r"[_-]?seed[_-]?\d+$", "", name) or name


def default_labels(folders: Sequence[Path]) -> list[str]:
    """The folders' names; names that differ in the seed alone have one label. Where several folders have runs of one
    such name, as A/run_seed1 and B/run_seed2, those of the folders around them come before it, as many as tell them
    apart."""
    names = [tuple(map(_without_seed, folder.resolve().parts)) for folder in folders]

    def label(name: tuple[str, ...], length: int = 1) -> str:
        alike = {other for other in names if other[-length:] == name[-length:]}
        return "/".join(name[-length:]) if len(alike) == 1 else label(name, length + 1)

    return [label(name) for name in names]


def groups_of(folders: Sequence[Path], labels: Sequence[str], problems: list[str]) -> list[Group]:
    """Runs of one label are one group, in the order in which labels appear."""
    if labels and len(labels) != len(folders):
        raise ReportError(f"There are {len(labels)} labels for {len(folders)} runs: give --label once for each "
                          "run, in the same order, or not at all. Runs of one label are pooled.")
    runs: dict[str, list[SpreadRun]] = {}
    for folder, label in zip(folders, labels or default_labels(folders)):
        runs.setdefault(label, []).append(spread_run(read_run(folder), problems))
    for label, found in runs.items():
        if len({run.plate_length for run in found}) > 1:
            raise ReportError(f"The runs of '{label}' have plates of different lengths, which cannot be pooled: give each "
                              "length a --label of its own.")
        for name in ("layer_thickness", "depth", "n_layers"):
            if len({getattr(run.apparatus, name) for run in found if run.apparatus}) > 1:
                raise ReportError(f"The runs of '{label}' differ in {name.replace('_', ' ')}, so they cannot be pooled: "
                                  "give each a --label of its own.")
    if len(runs) > MOST_GROUPS:
        raise ReportError(f"{len(runs)} labels are too many for one page: give at most {MOST_GROUPS}.")
    return [Group(label, found) for label, found in runs.items()]


def _plates(groups: Sequence[Group]) -> str:
    """A warning where plates differ in length."""
    lengths = {run.apparatus.plate_length for group in groups for run in group.runs if run.apparatus}
    if len(lengths) < 2:
        return ""
    return ("The plates differ in length (" + ", ".join(map(length, sorted(lengths)))
            + "): slopes at the two ends take a larger share of a shorter one.")


def _unmarked(table: list[list[str]]) -> list[list[str]]:
    return [[cell.replace("**", "") for cell in row] for row in table]


def _add_densities(page: Page, groups: Sequence[Group], measured: Measured | None) -> None:
    page.heading("Density of the layers")
    page.figure(densities_figure(groups, measured), f"Relative density of the layers. {BAND}"
                + (f" {measured.caption}" if measured else ""))
    if any(group.mapped for group in groups):
        page.figure(middle_figure(groups, measured), "LRD of the middle half of the plate, which the slopes at its two "
                    f"ends reach last{', beside the measured LRD of a whole plate' if measured else ''}. {BAND}")
    everyone = [*groups, *([measured_group(measured)] if measured else [])]
    head, *rows = densities_table(everyone)
    page.table(head, rows)
    page.paragraph("Means over the runs with their 95 % intervals (Student's t); a number in brackets says over how many "
                   "runs, where the others lack the layers or maps. The peak is the largest mean of three layers in a "
                   "row, from layer 2 on, of runs that have made all their layers. Densities are in % of that of the solid, "
                   "and their differences in points of that: from 60 to 65 % they rise by 5 %.")
    for group in everyone:
        page.paragraph(rise_sentence(group))
    if len(groups) > 1:
        head, *rows = _unmarked(differences_table(groups))
        page.table(head, rows)
        page.paragraph("Differences of the means with their 95 % intervals: of pairs with one seed where every run "
                       "of the smaller group has a partner on a plate of its length, as these spread the same grains, else by "
                       "Welch's t. Where 0 lies within, "
                       "the runs do not show a difference.")


def _add_mechanism(page: Page, groups: Sequence[Group]) -> None:
    mapped = [group for group in groups if group.mapped]
    page.heading("What a pass does to the powder that lies on the plate")
    page.figure(mechanism_figure(groups), "By pass: (a) mean displacement over the plate of the particles that lay on "
                "it; (b) share of them that moved by less than 10 µm; (c) mass that the pass removed; (d) length "
                f"of the zones at the two ends of the bed in which most particles rest. {BAND}")
    if not mapped:
        return
    head, *rows = rest_table(mapped)
    page.table(head, rows)
    for group in mapped:
        page.figure(maps_figure(group), f"{group.label}: (a) mean displacement in the pass of what lay on the "
                    "plate, by place and layer; grey: less than 10 µm; lines: inner ends of the zones at rest; (b) "
                    "what the pass added, as density of its layer. Means over the runs.")
    layer = last_common_layer(mapped)
    if layer is not None:
        page.figure(profiles_figure(mapped), f"After layer {layer}, the last of which all runs have a picture: (a) volume of "
                    "the solid over the plate's area, along the plate; (b) solid fraction over the height, in the middle "
                    "half of the plate. Means over the runs.")


def comparison_report(folders: Sequence[Path], labels: Sequence[str], given: str = "") -> Page:
    """:param given: what was measured, as `measured_for` takes it"""
    problems: list[str] = []
    groups = groups_of(folders, labels, problems)
    measured = measured_for(given, [run.apparatus for group in groups for run in group.runs])
    page = Page("Spreading runs compared", "; ".join(
        f"{group.label}: {', '.join(run.name for run in group.runs)}" for group in groups))
    for text in (*problems, *filter(None, [_plates(groups)])):
        page.notice(text)
    _add_densities(page, groups, measured)
    _add_mechanism(page, groups)
    return page
