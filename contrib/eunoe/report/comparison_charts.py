"""Charts that compare groups of spreading runs, and maps of one group."""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from . import style
from .bed_maps import SMOOTHED_LAYERS, SMOOTHED_LENGTH
from .canvas import MM
from .layer_charts import draw_measured
from .layer_results import RESTS_BELOW
from .measured import Measured
from .spread_run import Group, mean_and_spread

COLOURS = (style.BLUE, style.VERMILLION, style.GREEN, style.ORANGE, "#cc79a7", "#56b4e9", style.GREY)
MARKERS = "osD^vPX"
MOST_GROUPS = len(COLOURS)


def draw_group(axes: Axes, number: int, layer: np.ndarray, rows: np.ndarray, label: str, size: float = 1.) -> None:
    """The mean over the runs, with a band of one standard deviation.

    :param rows: a row for each run
    """
    mean, spread = mean_and_spread(size * rows)
    known = np.isfinite(mean)
    colour = COLOURS[number % MOST_GROUPS]
    axes.plot(layer[known], mean[known], color=colour, marker=MARKERS[number % MOST_GROUPS], markersize=3.2,
              linewidth=1.1, label=label, zorder=4)
    if spread is not None:
        axes.fill_between(layer[known], (mean - spread)[known], (mean + spread)[known], color=colour, alpha=0.2,
                          linewidth=0., zorder=1.5)


def _legend_below(figure: Figure, axes: Axes, columns: int = 4) -> None:
    """The legend of a panel under all panels of a figure whose layout is constrained, in so many columns if the
    labels are short enough for that."""
    handles, labels = axes.get_legend_handles_labels()
    for number in range(columns, 0, -1):
        legend = figure.legend(handles, labels, loc="lower center", ncol=number, columnspacing=1.1, handlelength=1.5)
        if number == 1 or legend.get_window_extent().width <= figure.bbox.width:
            break
        legend.remove()
    rows = -(-len(labels) // number)
    room = (0.08 + 0.17 * rows) / figure.get_figheight()
    figure.get_layout_engine().set(rect=(0., room, 1., 1. - room))


def densities_figure(groups: Sequence[Group], measured: Measured | None) -> Figure:
    """LRD and CRD against the layer."""
    figure = Figure(figsize=(style.WIDTH, 3.3), layout="constrained")
    left, right = figure.subplots(1, 2, sharey=True)
    if measured:
        draw_measured(left, measured.layer, measured.repeats, measured.label)
        draw_measured(right, *measured.cumulative(), measured.label)
    for number, group in enumerate(groups):
        for axes, values in ((left, "lrd"), (right, "crd")):
            draw_group(axes, number, group.layer, group.stacked(values), group.label, 100.)
    left.set_ylabel("Relative density (%)")
    left.yaxis.set_major_locator(MaxNLocator(nbins=8, steps=[1, 2, 5, 10]))
    left.set_title("(a) Layer relative density, LRD")
    right.set_title("(b) Cumulative relative density, CRD")
    last = max(group.layer[-1] for group in groups)
    for axes in (left, right):
        style.layer_axis(axes, max(last, measured.layer[-1]) if measured else last)
    _legend_below(figure, left)
    return figure


def mechanism_figure(groups: Sequence[Group]) -> Figure:
    """What happens to the powder that lies on the plate when the spreader passes."""
    figure = Figure(figsize=(style.WIDTH, 4.9), layout="constrained")
    panels = list(figure.subplots(2, 2).flat)
    for number, group in enumerate(groups):
        scraped = group.over_layers(lambda run: run.scraped)
        draw_group(panels[2], number, group.layer, scraped, group.label, 100.)
        if not group.mapped:
            continue
        layers = group.mapped[0].maps.layers
        for axes, rows, size in ((panels[0], group.over_maps("moved_of_layers"), 1e6),
                                 (panels[1], group.over_maps("resting_of_layers"), 100.),
                                 (panels[3], _covered(group), 100.)):
            draw_group(axes, number, layers[:rows.shape[1]], rows, group.label, size)
    panels[0].set_yscale("log")
    for axes, title, label in zip(panels, (
            "(a) Displacement of what lay on the plate", "(b) Share of it at rest",
            "(c) Mass that the pass removed", "(d) Length of the zones at rest at the ends"),
            ("Mean displacement (µm)", "% of the particles", "% of the mass before", "% of the bed")):
        axes.set_title(title)
        axes.set_ylabel(label)
        style.layer_axis(axes, max(group.layer[-1] for group in groups))
    style.plain_log_axis(panels[0].yaxis)
    # Shares that are zero everywhere are drawn on an axis of percents.
    low, high = panels[3].get_ylim()
    panels[3].set_ylim(low if high > 1. else -0.5, max(high, 10.))
    _legend_below(figure, panels[2])
    return figure


def _covered(group: Group) -> np.ndarray:
    n = group.over_maps("resting_of_layers").shape[1]
    return np.array([run.zones.covered[:n] for run in group.mapped])


def _draw_map(figure: Figure, axes: Axes, group: Group, values: np.ndarray, label: str, **look) -> None:
    maps = group.mapped[0].maps
    layers = maps.layers[:len(values)]
    bounds = np.concatenate((layers - 0.5, layers[-1:] + 0.5))
    mesh = axes.pcolormesh(MM * maps.x, bounds, values, rasterized=True, **look)
    axes.set_facecolor("#ffffff")
    axes.set_xlabel("x from the plate's left end (mm)")
    axes.yaxis.set_major_locator(MaxNLocator(integer=True))
    figure.colorbar(mesh, ax=axes, label=label, extend="both").outline.set_linewidth(0.6)


def _draw_zones(axes: Axes, group: Group) -> None:
    """The inner ends of the zones at rest, mean over the runs."""
    n = group.over_maps("resting_of_layers").shape[1]
    for side in ("left", "right"):
        places = []
        for run in group.mapped:
            # A bed that rests as a whole has no zones that end within it.
            length = np.where(run.zones.covered < 1. - 1e-9, getattr(run.zones, side), 0.)
            places.append([(end[0] + zone if side == "left" else end[1] - zone) if zone > 0. else np.nan
                           for end, zone in zip(run.zones.ends[:n], length[:n])])
        mean = np.array(places).mean(axis=0)
        axes.plot(MM * mean, group.mapped[0].maps.layers[:n], color=style.INK, linewidth=0.9)


def maps_figure(group: Group) -> Figure:
    """Displacement and density in x and layer, means over the runs."""
    figure = Figure(figsize=(style.WIDTH, 2.9), layout="constrained")
    left, right = figure.subplots(1, 2, sharey=True)
    # Of the runs that have something at a place.
    moved = 1e6 * np.ma.masked_invalid(group.over_maps("moved_of_columns")).mean(axis=0).filled(np.nan)
    lrd = 100. * group.over_maps("smoothed_lrd").mean(axis=0)
    largest = max(np.nanmax(moved, initial=0.), 100. * 1e6 * RESTS_BELOW)
    moved = np.maximum(moved, 1e-3 * 1e6 * RESTS_BELOW)  # a logarithm has no 0, and NaN stays
    # Below the limit the scale is grey, as in the picture of the particles.
    colours = colormaps["plasma_r"].with_extremes(under=(0.6, 0.6, 0.6))
    _draw_map(figure, left, group, moved, "Displacement (µm)", cmap=colours, norm=LogNorm(1e6 * RESTS_BELOW, largest))
    _draw_zones(left, group)
    _draw_map(figure, right, group, lrd, "Mean LRD (%)", cmap="viridis",
              norm=Normalize(*np.nanquantile(lrd, (0.02, 0.98))) if np.isfinite(lrd).any() else Normalize(0., 100.))
    left.set_ylabel("Layer")
    left.set_title("(a) Displacement in the pass")
    right.set_title(f"(b) LRD, over {SMOOTHED_LAYERS} layers and {MM * SMOOTHED_LENGTH:g} mm")
    return figure


def middle_figure(groups: Sequence[Group], measured: Measured | None) -> Figure:
    """LRD of the middle half of the plate, which the slopes at the ends reach last."""
    figure = Figure(figsize=(style.WIDTH, 2.9), layout="constrained")
    axes = figure.subplots()
    if measured:
        draw_measured(axes, measured.layer, measured.repeats, measured.label)
    for number, group in enumerate(groups):
        if group.mapped:
            rows = group.over_maps("middle_lrd")
            draw_group(axes, number, group.mapped[0].maps.layers[:rows.shape[1]], rows, group.label, 100.)
    axes.set_ylabel("LRD of the middle half (%)")
    style.layer_axis(axes, max(group.layer[-1] for group in groups))
    _legend_below(figure, axes)
    return figure


def levels_figure(groups: Sequence[Group]) -> Figure:
    """What lies above the level of the transfer plate, and how dense the bed below it has become."""
    figure = Figure(figsize=(style.WIDTH, 3.1), layout="constrained")
    panels = figure.subplots(1, 2)
    for axes, values, label in zip(panels, ("above_level", "crd_below"),
                                   ("Solid above the level (% of a layer)", "Density below it from layer 2 on (%)")):
        for number, group in enumerate(groups):
            if group.mapped:
                rows = group.over_maps(values)
                draw_group(axes, number, group.mapped[0].maps.layers[:rows.shape[1]], rows, group.label, 100.)
        axes.set_ylabel(label)
        style.layer_axis(axes, max(group.layer[-1] for group in groups))
    for axes, title in zip(panels, ("(a) Room under the spreader", "(b) Bed")):
        axes.set_title(title)
    _legend_below(figure, panels[0])
    return figure


def last_common_layer(groups: Sequence[Group]) -> int | None:
    """The last layer of which all runs with maps have one."""
    layers = [run.maps.layers for group in groups for run in group.mapped]
    common = reduce(np.intersect1d, layers) if layers else layers
    return int(common[-1]) if len(common) else None


def profiles_figure(groups: Sequence[Group]) -> Figure:
    """Solid along the plate and over the height, after the last layer that all have."""
    layer = last_common_layer(groups)
    figure = Figure(figsize=(style.WIDTH, 3.1), layout="constrained")
    left, right = figure.subplots(1, 2)
    bulk: list[float] = []  # without floor and surface, where the fraction falls to nothing
    for number, group in enumerate(groups):
        colour = COLOURS[number % MOST_GROUPS]
        maps = [run.maps for run in group.mapped]
        if not maps:
            continue
        x = 0.5 * (maps[0].x[1:] + maps[0].x[:-1]) / maps[0].x[-1]
        y = 0.5 * (maps[0].y[1:] + maps[0].y[:-1])
        columns = np.mean([m.columns()[m.layers == layer][0] for m in maps], axis=0)
        left.plot(x, MM * columns, color=colour, label=group.label)
        fraction = np.mean([m.fraction[m.layers == layer][0][m.middle()].mean(axis=0) for m in maps], axis=0)
        right.plot(100. * fraction, MM * y, color=colour)
        inside = np.flatnonzero(fraction > 0.5 * fraction.max())[1:-1]
        bulk += [*(100. * fraction[inside])]
    left.set_xlabel("x over the plate's length")
    left.set_ylabel("Height of the solid without pores (mm)")
    left.set_title("(a) Along the plate")
    if bulk:
        right.set_xlim(min(bulk) - 2., max(bulk) + 2.)
    right.set_xlabel("Solid fraction (%)")
    right.set_ylabel("Height over the plate (mm)")
    right.set_title("(b) Over the height, middle half of the plate")
    for axes in (left, right):
        axes.grid()
    _legend_below(figure, left)
    return figure
