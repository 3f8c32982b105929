"""What the paper found and measured, number by number, beside what the runs of the campaign give."""

from __future__ import annotations

import math
from collections.abc import Iterator

from eunoe.intervals import Interval
from eunoe.report.common_scatter import CommonScatter, Number
from eunoe.report.comparison_text import layers_of, measured_group, text_of
from eunoe.report.measured import read_measured
from eunoe.report.spread_run import COMPARED, LATER, PLATEAU, YOUNG, Group, SpreadRun
from eunoe.tables import Table

from .cases import SETS
from .results import Findings, length_name

UNKNOWN = "not known yet"
# Densities nearer to each other than that are called equal; the effect in question is three times as large.
EQUAL = 0.02
LAST = (19, 20)  # layers after the measured peak
# What the paper tells of its simulations of plates of two L1.
SIMULATED_LENGTH = 2.
SIMULATED_MEETING = {"PS1": (9, 13), "PS3": (8, 8)}
SIMULATED_REST = {"PS3": (11, 11)}
SIMULATED_PEAK = {"PS1": (13, 13)}


def agreement(found: Interval, size: float = 100., unit: str = " %", equal: float = EQUAL) -> str:
    """Whether two means agree, by the interval of their difference."""
    if math.isnan(found.value):
        return UNKNOWN
    difference = f"{text_of(found, size, '+')}{unit}"
    if math.isnan(found.half):
        return f"{difference}; one run has no interval"
    if found.is_significant:
        return f"no: {difference}"
    farthest = abs(found.value) + found.half
    return f"cannot be told: {difference}" if farthest > equal else f"agrees within {size * farthest:.1f}{unit}"


def _sign(found: Interval, wanted: str, size: float) -> str:
    """Whether a difference has the wanted sign (+ or -), and significantly so."""
    if math.isnan(found.value):
        return UNKNOWN
    right = (found.value > 0.) == (wanted == "+")
    if math.isnan(found.half):
        return ("yes" if right else "no") + ", but one run has no interval"
    if not found.is_significant:
        return f"not significant: {text_of(found, size, '+')}"
    return "yes" if right else "no: the opposite"


def _later(run: SpreadRun) -> float:
    return run.mean_lrd(LATER)


def _rise_below(run: SpreadRun) -> float:
    return run.lrd_below(LATER) - run.lrd_below(YOUNG)


def _peak(run: SpreadRun) -> float:
    return run.peak[0]


def _layer_of_peak(run: SpreadRun) -> float:
    return run.peak[1]


# Numbers that were measured, their size in the unit of their title, and how near two of them are equal.
MEASURED: dict[str, tuple[Number, float, float]] = {
    "LRD of layer 1 (%)": (lambda run: run.mean_lrd((1, 1)), 100., EQUAL),
    f"LRD of layers {PLATEAU[0]} to {PLATEAU[1]}, which is CRD after layer {PLATEAU[1]} (%)":
        (lambda run: run.mean_lrd(PLATEAU), 100., EQUAL),
    f"rise from there to layers {LATER[0]} to {LATER[1]} (%)": (lambda run: run.rise, 100., EQUAL),
    "peak of LRD (%)": (_peak, 100., EQUAL),
    "its layer": (_layer_of_peak, 1., 2.),
    f"fall from the peak to layers {LAST[0]} and {LAST[1]} (%)": (lambda run: run.peak[0] - run.mean_lrd(LAST), 100., EQUAL),
    f"CRD after layer {LATER[1]} (%)": (lambda run: run.crd(LATER[1]), 100., EQUAL),
}


def measured_table(findings: Findings) -> tuple[Table, list[Interval]]:
    """The longest plates beside the measured one, and all differences from it."""
    groups, measured, scatter = _longest(findings), measured_group(read_measured()), CommonScatter(findings.alike())
    table: Table = [["", "measured", *(cell for group in groups for cell in (group.label, "agrees?"))]]
    differences = []
    for title, (number, size, equal) in MEASURED.items():
        row = [title, text_of(scatter.mean(measured, number), size)]
        for group in groups:
            found = scatter.difference(group, measured, number)
            differences.append(found)
            row += [text_of(scatter.mean(group, number), size), agreement(found, size, "", equal)]
        table.append(row)
    return table, differences


def _growing_with_length(findings: Findings, scatter: CommonScatter) -> Iterator[tuple[list[str], Interval]]:
    wanted = {"the rise grows with the length": (lambda run: run.rise, 100., " %"),
              f"the rise of the bed, from layers {YOUNG[0]} to {YOUNG[1]} to {LATER[0]} to {LATER[1]}, grows with the length":
                  (_rise_below, 100., " %"),
              "the peak grows with the length": (_peak, 100., " %"),
              "its layer grows with the length": (_layer_of_peak, 1., "")}
    for properties in SETS:
        groups = findings.lengths(properties)
        for shorter, longer in zip(groups, groups[1:]):
            label = f"{longer.label}, less {shorter.label}"
            for title, (number, size, unit) in wanted.items():
                found = scatter.difference(longer, shorter, number)
                simulated = "of LRD: yes" if number is _rise_below else "yes"
                yield [title, simulated, f"{label}: {text_of(found, size)}{unit}", _sign(found, "+", size)], found
            if properties == "PS3":
                found = scatter.difference(longer, shorter, lambda run: run.mean_lrd(COMPARED))
                yield [f"PS3 changes little with the length (layers {COMPARED[0]} to {COMPARED[1]})", "yes",
                       f"{label}: {text_of(found, 100.)} %", agreement(found)], found


def _third_set(findings: Findings, scatter: CommonScatter) -> Iterator[tuple[list[str], Interval]]:
    for length in sorted({result.case.length for result in findings.all}):
        first, third = findings.of("PS1", length), findings.of("PS3", length)
        if first and third:
            for title, number in (("the peak of PS3 is lower than that of PS1", _peak),
                                  (f"layers {LATER[0]} to {LATER[1]} of PS3 are looser", _later)):
                found = scatter.difference(third, first, number)
                yield [title, "yes", f"{third.label}, less {first.label}: {text_of(found, 100.)} %",
                       _sign(found, "-", 100.)], found


def in_layers(layers: list[int | None], simulated: tuple[int, int], length: float) -> str:
    """When something happens, beside when it does on the paper's plate, which may have another length."""
    known = [layer for layer in layers if layer is not None]
    if not known:
        return f"no: in none of {len(layers)} runs"
    when = ("later" if min(known) > simulated[1] else "earlier" if max(known) < simulated[0] else "then")
    number = "" if len(known) == len(layers) else f", in {len(known)} of {len(layers)} runs"
    relative = length / SIMULATED_LENGTH
    return f"{when}{number}" + ("" if relative == 1. else f", on {relative:g} of that length")


def _when(groups: list[Group]) -> Iterator[list[str]]:
    """In which layers things happen on the paper's plates of another length, and here: of the runs that can tell."""
    wanted = {"zones at rest grow from both ends and meet in layer":
                  (SIMULATED_MEETING, lambda group: [run.zones.meet for run in group.mapped]),
              "the bed is at rest from layer": (SIMULATED_REST, lambda group: [run.zones.at_rest_from for run in group.mapped]),
              "LRD peaks in layer":
                  (SIMULATED_PEAK, lambda group: [int(run.peak[1]) for run in group.runs if not math.isnan(run.peak[1])])}
    for title, (simulated, found_in) in wanted.items():
        for group in groups:
            case, layers = group.runs[0].case, found_in(group)
            if case.properties not in simulated or not layers:
                continue
            first, last = simulated[case.properties]
            there = f"{first}" if first == last else f"{first} to {last}"
            yield [title, f"{case.properties}, {length_name(SIMULATED_LENGTH)}: {there}", f"{group.label}: {layers_of(layers)}",
                   in_layers(layers, (first, last), case.length)]


def simulated_table(findings: Findings) -> tuple[Table, list[Interval]]:
    """What the paper says of its simulations, and all differences by which it is judged."""
    scatter = CommonScatter(findings.alike())
    rows, differences = [], []
    for row, found in (*_growing_with_length(findings, scatter), *_third_set(findings, scatter)):
        rows.append(row)
        differences.append(found)
    return [["what", "simulated in the paper", "here", "verdict"], *rows, *_when(_longest(findings))], differences


def _longest(findings: Findings) -> list[Group]:
    """The longest plate of each property set; before it, if that has one run, the longest that has several."""
    found = []
    for properties in SETS:
        groups = findings.lengths(properties)
        if groups and len(groups[-1].runs) == 1:
            found += [group for group in groups if len(group.runs) > 1][-1:]
        found += groups[-1:]
    return found


def by_chance(differences: list[Interval]) -> str:
    """How many of so many comparisons would seem to be differences though there is none; nothing if none has an interval."""
    known = [found for found in differences if not math.isnan(found.half)]
    if not known:
        return ""
    significant = sum(found.is_significant for found in known)
    return (f"{significant} of the {len(known)} differences in these tables that have an interval are significant; if there were "
            f"none, about {max(1, round(0.05 * len(known)))} would be by chance.")
