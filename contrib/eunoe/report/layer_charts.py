"""Charts of what was measured layer by layer."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from . import style
from .layer_results import DensityNoise
from .measured import Measured
from .quantities import FORCE, MASS, TIME, unit_for
from .run_folder import Layers


def draw_measured(axes: Axes, layer: np.ndarray, repeats: np.ndarray, label: str) -> None:
    """Repeats, mean and standard deviation band of a measured density (fractions)."""
    mean = 100. * repeats.mean(axis=1)
    axes.plot(layer, mean, color=style.INK, linewidth=1.1, zorder=3, label=label)
    if repeats.shape[1] < 2:
        return
    std = 100. * repeats.std(axis=1, ddof=1)
    axes.fill_between(layer, mean - std, mean + std, color="#dddddd", linewidth=0.,
                      label="± std. deviation")
    for k, repeat in enumerate(repeats.T):
        axes.plot(layer, 100. * repeat, color="#9a9a9a", linewidth=0.5, zorder=2,
                  label="its repeats" if k == 0 else None)


def _draw_simulated(axes: Axes, layer: np.ndarray, density: np.ndarray,
                    noise: np.ndarray | None) -> None:
    known = np.isfinite(density)
    axes.errorbar(layer[known], 100. * density[known],
                  yerr=None if noise is None else 100. * noise[known], color=style.BLUE,
                  marker="o", markersize=3.8, linewidth=1.1, elinewidth=0.8, capsize=1.8,
                  label="simulated" + ("" if noise is None else " ± counting noise"), zorder=4)


def density_figure(layers: Layers, noise: DensityNoise | None, measured: Measured | None) -> Figure:
    """LRD and CRD of the layers, beside the measured ones if there are any."""
    figure = Figure(figsize=(style.WIDTH, 3.1))
    left, right = figure.subplots(1, 2, sharey=True)
    figure.subplots_adjust(left=0.08, right=0.985, top=0.92, bottom=0.255, wspace=0.08)
    if measured:
        draw_measured(left, measured.layer, measured.repeats, measured.label)
        draw_measured(right, *measured.cumulative(), measured.label)
    _draw_simulated(left, layers.layer, layers.lrd, noise.lrd if noise else None)
    _draw_simulated(right, layers.layer, layers.crd, noise.crd if noise else None)
    left.set_ylabel("Relative density (%)")
    left.yaxis.set_major_locator(MaxNLocator(nbins=8, steps=[1, 2, 5, 10]))
    left.set_title("(a) Layer relative density, LRD")
    right.set_title("(b) Cumulative relative density, CRD")
    for axes in (left, right):
        style.layer_axis(axes, max(layers.last, measured.layer[-1]) if measured else layers.last)
    handles, labels = left.get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncol=4, columnspacing=1.1, handlelength=1.3)
    return figure


def _draw_plate_mass(axes: Axes, layers: Layers) -> None:
    size, unit = unit_for(layers.mass.max(), MASS)
    kept = (layers.mass - layers.arrived) / size
    arrived, removed = layers.arrived / size, layers.removed / size
    axes.bar(layers.layer, kept, color=style.PALE_BLUE, label="from before")
    axes.bar(layers.layer, arrived, bottom=kept, color=style.BLUE, label="new")
    axes.bar(layers.layer, -removed, color=style.VERMILLION, label="removed")
    axes.axhline(0., color=style.INK, linewidth=0.6)
    axes.set_ylabel(f"Mass ({unit})")
    axes.set_title("(a) Powder on the measuring plate")


def _draw_losses(axes: Axes, layers: Layers) -> None:
    size, unit = unit_for(max(layers.to_gap.max(), layers.to_collector.max()), MASS)
    width = 0.4
    axes.bar(layers.layer - width / 2., layers.to_gap / size, width, color=style.ORANGE,
             label="into the gaps")
    axes.bar(layers.layer + width / 2., layers.to_collector / size, width, color=style.GREY,
             label="to the collector")
    axes.set_ylabel(f"Mass ({unit})")
    axes.set_title("(b) Powder that left in the pass")


def _draw_force(axes: Axes, layers: Layers) -> None:
    size, unit = unit_for(np.nanmax(layers.force_max, initial=0.), FORCE)
    for force, face, label in ((layers.force_max, "white", "largest"),
                               (layers.force_mean, style.BLUE, "mean")):
        axes.plot(layers.layer, force / size, color=style.BLUE, marker="o", markersize=3.8,
                  linewidth=0.8, markerfacecolor=face, label=label)
    if (layers.force_mean > 0.).all():
        axes.set_yscale("log")
    axes.set_ylabel(f"Force ({unit})")
    axes.set_title("(c) Force on the spreader over the plate")


def _draw_wall_time(axes: Axes, layers: Layers) -> None:
    size, unit = unit_for(layers.wall_seconds.max(), TIME)
    settling = layers.layer == 0
    for rows, colour, label in ((settling, style.PALE_GREY, "with settling of the feedstock"),
                                (~settling, style.GREY, None)):
        if rows.any():
            axes.bar(layers.layer[rows], layers.wall_seconds[rows] / size, color=colour,
                     label=label)
    axes.set_ylabel(f"Wall-clock time ({unit})")
    axes.set_title("(d) Computing time of the layer")


def budget_figure(layers: Layers) -> Figure:
    """Mass, force and computing time of the layers."""
    figure = Figure(figsize=(style.WIDTH, 4.9), layout="constrained")
    figure.get_layout_engine().set(hspace=0.06, wspace=0.04)
    panels = figure.subplots(2, 2).flat
    for axes, draw in zip(panels, (_draw_plate_mass, _draw_losses, _draw_force, _draw_wall_time)):
        draw(axes, layers)
        style.layer_axis(axes, layers.last)
        low, high = axes.get_ylim()
        # Room for the legend above the data.
        if axes.get_yscale() == "log":
            axes.set_ylim(low, high * (high / low)**0.25)
            style.plain_log_axis(axes.yaxis)
        else:
            axes.set_ylim(low, high + 0.2 * (high - low))
        if axes.get_legend_handles_labels()[0]:
            axes.legend(loc="upper center", ncol=3, handlelength=1.2, columnspacing=1.2,
                        borderaxespad=0.1)
    return figure
