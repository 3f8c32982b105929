"""What the paper found and measured, number by number, beside what the runs of the campaign give."""

from __future__ import annotations

import math

from eunoe.intervals import Interval
from eunoe.report.common_scatter import CommonScatter
from eunoe.report.comparison_text import layers_of, measured_group, text_of
from eunoe.report.measured import read_measured
from eunoe.report.spread_run import LATER, PLATEAU, YOUNG, Group, SpreadRun
from eunoe.tables import Table

from .cases import SETS
from .results import Findings

UNKNOWN = "not known yet"
# Densities nearer to each other than that are called equal; the effect in question is three times as large.
EQUAL = 0.02


def _said(found: Interval, size: float = 100., unit: str = " %") -> str:
    if math.isnan(found.value):
        return ""
    return text_of(found, size) + unit + ("" if not math.isnan(found.half) else " (no interval)")


def agreement(found: Interval) -> str:
    """Whether two means agree, by the interval of their difference."""
    if math.isnan(found.value):
        return UNKNOWN
    if math.isnan(found.half):
        return f"differs by {100. * found.value:+.1f} %; one run has no interval"
    if found.is_significant:
        return f"no: differs by {100. * found.value:+.1f} ± {100. * found.half:.1f} %"
    farthest = abs(found.value) + found.half
    if farthest > EQUAL:
        return f"cannot be told: differs by {100. * found.value:+.1f} ± {100. * found.half:.1f} %"
    return f"agrees within {100. * farthest:.1f} %"


def _sign(found: Interval, wanted: str) -> str:
    """Whether a difference has the wanted sign (+ or -), and significantly so."""
    if math.isnan(found.value):
        return UNKNOWN
    right = (found.value > 0.) == (wanted == "+")
    if math.isnan(found.half):
        return ("yes" if right else "no") + ", but one run has no interval"
    if not found.is_significant:
        return f"not significant: {100. * found.value:+.1f} ± {100. * found.half:.1f}"
    return "yes" if right else "no: the opposite"


def _plateau(run: SpreadRun) -> float:
    return run.mean_lrd(PLATEAU)


def _later(run: SpreadRun) -> float:
    return run.mean_lrd(LATER)


def _rise(run: SpreadRun) -> float:
    return run.rise


def _rise_below(run: SpreadRun) -> float:
    return run.lrd_below(LATER) - run.lrd_below(YOUNG)


def _peak(run: SpreadRun) -> float:
    return run.peak[0]


def _layer_of_peak(run: SpreadRun) -> float:
    return run.peak[1]


def _crd_early(run: SpreadRun) -> float:
    return run.crd(PLATEAU[1])


def _crd_late(run: SpreadRun) -> float:
    return run.crd(LATER[1])


def _fall(run: SpreadRun) -> float:
    """From the peak to the last layer."""
    return run.peak[0] - float(run.layers.lrd[-1])


def _by_group(groups: list[Group], measured: Group, scatter: CommonScatter) -> Table:
    rows = []
    for title, number in ((f"LRD of layers {PLATEAU[0]} to {PLATEAU[1]}", _plateau),
                          ("rise of LRD from there to layers 11 to 20", _rise),
                          ("peak of LRD", _peak),
                          ("fall of LRD from the peak to layer 20", _fall),
                          (f"CRD after layer {PLATEAU[1]}", _crd_early),
                          (f"CRD after layer {LATER[1]}", _crd_late)):
        rows += [[title, "measured: " + _said(scatter.mean(measured, number)),
                  f"{group.label}: {_said(scatter.mean(group, number))}",
                  agreement(scatter.difference(group, measured, number))]
                 for group in groups]
    return rows


def _differences(findings: Findings, scatter: CommonScatter) -> Table:
    rows = []
    for properties in ("PS1", "PS2", "PS3"):
        groups = findings.lengths(properties)
        for shorter, longer in zip(groups, groups[1:]):
            for title, number, size, unit in (("the rise grows with the length", _rise, 100., " %"),
                                              ("the rise of the bed, from layers 2 to 4 to 11 to 20, grows with the length",
                                               _rise_below, 100., " %"),
                                              ("the peak grows with the length", _peak, 100., " %"),
                                              ("its layer grows with the length", _layer_of_peak, 1., "")):
                found = scatter.difference(longer, shorter, number)
                rows.append([title, "simulated: yes", f"{longer.label}, less {shorter.label}: {_said(found, size, unit)}",
                             _sign(Interval(found.value * size / 100., found.half * size / 100.), "+")])
    for length in sorted({result.case.length for result in findings.all}):
        first, third = findings.of("PS1", length), findings.of("PS3", length)
        if first and third:
            for title, number in (("the peak of PS3 is lower than that of PS1", _peak),
                                  ("layers 11 to 20 of PS3 are looser", _later)):
                found = scatter.difference(third, first, number)
                rows.append([title, "simulated: yes", f"{third.label}, less {first.label}: {_said(found)}",
                             _sign(found, "-")])
    return rows


def _rest(groups: list[Group]) -> Table:
    rows = []
    for group in groups:
        zones = [run.zones for run in group.mapped]
        if not zones:
            continue
        meet = [zone.meet for zone in zones]
        number = sum(layer is not None for layer in meet)
        rows.append(["zones at rest grow from both ends and meet in layer", "simulated: PS1, L2: 9 to 13; PS3, L2: 8",
                     f"{group.label}: {layers_of(meet)}", f"in {number} of {len(zones)} runs"])
        rest = [zone.at_rest_from for zone in zones]
        number = sum(layer is not None for layer in rest)
        rows.append(["the bed is at rest from layer", "simulated: PS3, L2: 11", f"{group.label}: {layers_of(rest)}",
                     f"in {number} of {len(zones)} runs"])
    return rows


def _longest(findings: Findings) -> list[Group]:
    """The longest plate of each property set; before it, if that has one run, the longest that has several."""
    found = []
    for properties in SETS:
        groups = findings.lengths(properties)
        if groups and len(groups[-1].runs) == 1:
            found += [group for group in groups if len(group.runs) > 1][-1:]
        found += groups[-1:]
    return found


def verdict_table(findings: Findings) -> Table:
    groups = _longest(findings)
    measured, scatter = measured_group(read_measured()), CommonScatter(findings.plain())
    return [["what", "in the paper", "here", "verdict"],
            *_by_group(groups, measured, scatter), *_differences(findings, scatter), *_rest(groups)]
