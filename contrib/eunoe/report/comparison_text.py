"""Tables and sentences that compare groups of spreading runs, with 95 % intervals of the means (Student's t,
differences pair by pair of seeds, or by Welch)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import fields

import numpy as np

from eunoe.intervals import Interval, mean_of
from eunoe.tables import Table

from .common_scatter import CommonScatter, Number
from .measured import Measured
from .run_folder import Layers
from .spread_run import COMPARED, LATER, PLATEAU, Group, SpreadRun, farthest
from .static_zones import RESTS, zones_of


def measured_group(measured: Measured) -> Group:
    """The repeats of the measurement as runs, of which only densities are known."""
    runs = []
    from_layer, cumulative = measured.cumulative()
    for number, repeat in enumerate(measured.repeats.T, start=1):
        unknown = np.full(len(repeat), math.nan)
        crd = unknown.copy()
        crd[np.isin(measured.layer, from_layer)] = cumulative[:, number - 1]
        known = {"layer": measured.layer, "lrd": repeat, "crd": crd}
        layers = Layers(**{field.name: known.get(field.name, unknown) for field in fields(Layers)})
        runs.append(SpreadRun(f"repeat {number}", layers, None, None))
    return Group("measured, full size" if measured.is_of_paper else "measured", runs)


ALONE = CommonScatter()  # each group scatters by itself
SUPPLIED = (1, 10, 20)


def span(layers: tuple[int, int]) -> str:
    return f"LRD of layers {layers[0]} to {layers[1]} (%)"


DENSITIES: dict[str, tuple[Number, float]] = {
    span(PLATEAU): (lambda run: run.mean_lrd(PLATEAU), 100.),
    span(LATER): (lambda run: run.mean_lrd(LATER), 100.),
    f"of the middle half, layers {PLATEAU[0]} to {PLATEAU[1]} (%)": (lambda run: run.middle_lrd(PLATEAU), 100.),
    f"of the middle half, layers {LATER[0]} to {LATER[1]} (%)": (lambda run: run.middle_lrd(LATER), 100.),
    "rise (%)": (lambda run: run.rise, 100.),
    "peak (%)": (lambda run: run.peak[0], 100.),
    "its layer": (lambda run: run.peak[1], 1.),
}


def text_of(interval: Interval, size: float = 1., sign: str = "") -> str:
    """The number and its interval; a single run has none."""
    if math.isnan(interval.value):
        return ""
    value = f"{size * interval.value:{sign}.1f}"
    return value if math.isnan(interval.half) else f"{value} ± {size * interval.half:.1f}"


def _of_known(group: Group, number: Number, size: float, scatter: CommonScatter) -> str:
    """The mean over the runs, and of how many it is if some do not know the number."""
    text, known = text_of(scatter.mean(group, number), size), group.knowing(number)
    return f"{text} ({known})" if 0 < known < len(group.runs) else text


def densities_table(groups: Sequence[Group], scatter: CommonScatter = ALONE) -> Table:
    table = [["", "runs", *DENSITIES]]
    for group in groups:
        cells = [_of_known(group, number, size, scatter) for number, size in DENSITIES.values()]
        table.append([group.label, str(len(group.runs)), *cells])
    return table


def differences_table(groups: Sequence[Group], scatter: CommonScatter = ALONE) -> Table:
    """Of each group from the first one; bold where 0 lies outside of the interval."""
    numbers = {span(COMPARED): (lambda run: run.mean_lrd(COMPARED), 100.), **DENSITIES}
    table = [[f"less {groups[0].label}", "runs", *numbers]]
    for group in groups[1:]:
        cells = []
        for number, size in numbers.values():
            found = scatter.difference(group, groups[0], number)
            text = text_of(found, size, "+")
            cells.append(f"**{text}**" if found.is_significant else text)
        table.append([group.label, str(len(group.runs)), *cells])
    return table


def rise_sentence(group: Group, scatter: CommonScatter = ALONE) -> str:
    """Whether the layers become denser after layer 10."""
    known = group.knowing(lambda run: run.rise)
    label = f"{group.label} ({known} of {len(group.runs)} runs)" if 0 < known < len(group.runs) else group.label
    return change_sentence(label, scatter.mean(group, lambda run: run.rise))


def change_sentence(label: str, found: Interval) -> str:
    """The same by a change that is known."""
    if math.isnan(found.value):
        return f"{label}: too few layers to say whether they become denser."
    spans = f"from layers {PLATEAU[0]} to {PLATEAU[1]} to layers {LATER[0]} to {LATER[1]}"
    if math.isnan(found.half):
        return (f"{label}: the mean LRD changes by {100. * found.value:+.1f} % {spans}; one run has no "
                "interval.")
    half = f"± {100. * found.half:.1f} %"
    if not found.is_significant:
        return (f"{label}: {spans} the mean LRD changes by {100. * found.value:+.1f} {half}, which is not "
                "significant.")
    verb = "rises" if found.value > 0. else "falls"
    return f"{label}: {spans} the mean LRD {verb} by {abs(100. * found.value):.1f} {half}."


def supply_table(groups: Sequence[Group]) -> Table:
    """Where the powder of some passes went; means over the runs."""
    table: Table = [["", "layer", "stays on the plate (mg)", "falls into the gaps (mg)", "reaches the collector (mg)"]]
    for group in groups:
        for layer in SUPPLIED:
            rows = [(run.layers, int(np.flatnonzero(run.layers.layer == layer)[0])) for run in group.runs
                    if layer in run.layers.layer]
            if rows:
                ways = [(np.diff(layers.mass, prepend=0.)[k], layers.to_gap[k], layers.to_collector[k]) for layers, k in rows]
                table.append([group.label, str(layer), *(f"{1e6 * mass:.2f}" for mass in np.mean(ways, axis=0))])
    return table


def layers_of(values: Sequence[int | None]) -> str:
    """The layers of all runs, of which some may have none."""
    known = [value for value in values if value is not None]
    if not known:
        return "never"
    text = f"{known[0]}" if len(set(known)) == 1 else f"{min(known)} to {max(known)}"
    return text if len(known) == len(values) else f"{text} ({len(known)} of {len(values)} runs)"


def rest_table(groups: Sequence[Group]) -> Table:
    """From which layers on the bed rests, of the groups with maps: over those runs that have come farthest, as what has
    not happened in the others may yet do so."""
    table = [["", "runs", "first zone at rest", "zones meet", "90 % at rest from", "at rest in the last pass (%)",
              "removed by a pass from layer 11 on (% of the mass before)",
              *(f"gained five layers and more below, layers {first} to {last} (% of a layer a pass)" for first, last in (PLATEAU, LATER))]]
    for group in groups:
        runs = farthest(group.mapped)
        zones = [run.zones for run in runs]
        if not zones:
            continue
        late = [float(run.scraped[run.layers.layer >= LATER[0]].mean()) if run.layers.last >= LATER[0] else math.nan
                for run in runs]
        extent = str(len(runs)) if len(runs) == len(group.mapped) else f"{len(runs)} of {len(group.mapped)}"
        table.append([group.label, extent, layers_of([zone.first for zone in zones]),
                      layers_of([zone.meet for zone in zones]), layers_of([zone.at_rest_from for zone in zones]),
                      text_of(mean_of([float(zone.resting[-1]) for zone in zones]), 100.),
                      text_of(mean_of(late), 100.),
                      *(text_of(mean_of([run.compaction(layers) for run in runs]), 100.) for layers in (PLATEAU, LATER))])
    return table


def meeting_table(groups: Sequence[Group]) -> Table:
    """In which layer the zones at rest meet, by how much of a column has to rest for the column to do so."""
    shares = (0.3, 0.4, RESTS, 0.6, 0.7, 0.8)
    table = [["zones meet, where a column rests if so much of it does", *(f"{100. * share:.0f} %" for share in shares)]]
    for group in groups:
        runs = farthest(group.mapped)
        if runs:
            table.append([group.label, *(layers_of([zones_of(run.maps, share).meet for run in runs]) for share in shares)])
    return table
