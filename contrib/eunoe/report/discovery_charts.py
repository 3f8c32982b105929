"""Pictures of a study: where model and measurement differ, what effects look like, and what is gained."""

from __future__ import annotations

from math import ceil

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter

from . import style
from .discovery_results import Fingerprint, Study

COLUMNS = 3  # of panels
LEGEND = 0.3  # height of the legend above them (inch)
MOST_EFFECTS = 12  # in the picture of the ranking


def _panels(n: int, height: float) -> tuple[Figure, list[Axes]]:
    rows = ceil(n / COLUMNS)
    total = LEGEND + height * rows
    figure = Figure(figsize=(style.WIDTH, total), layout="constrained")
    figure.get_layout_engine().set(rect=(0., 0., 1., 1. - LEGEND / total))
    axes = figure.subplots(rows, COLUMNS, squeeze=False).ravel()
    for unused in axes[n:]:
        unused.set_axis_off()
    return figure, list(axes[:n])


def _sentence(text: str) -> Figure:
    """A sentence in place of a picture that has nothing to show."""
    figure = Figure(figsize=(style.WIDTH, 0.6), layout="constrained")
    axes = figure.subplots()
    axes.set_axis_off()
    axes.text(0.5, 0.5, text, ha="center", va="center")
    return figure


def _draw_band(axes: Axes, x: np.ndarray, rows: list[dict], name: str, colour: str,
               shift: float) -> None:
    """Draws the band of two standard deviations of single runs about their mean."""
    if name not in rows[0]:
        return
    mean = np.array([row[name] for row in rows])
    spread = 2. * np.array([row[f"{name} deviation"] for row in rows])
    if len(rows) == 1:
        axes.errorbar(x + shift, mean, spread, color=colour, fmt="_", markersize=9, linewidth=5.,
                      alpha=0.7)
        return
    axes.fill_between(x, mean - spread, mean + spread, color=colour, alpha=0.25, linewidth=0.)
    axes.plot(x, mean, color=colour, linewidth=1.1)


def _label_values(axes: Axes, unit: str) -> None:
    """Power of ten in the label instead of above the axes, where it would move the title."""
    exponent = int(np.floor(np.log10(max(np.abs(axes.get_ylim())))))
    exponent = exponent if exponent < -2 or exponent > 3 else 0
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value / 10.**exponent:.5g}"))
    axes.set_ylabel((f"$10^{{{exponent}}}$ " if exponent else "") + (unit if unit != "1" else ""),
                    fontsize=7.5)


def envelope_figure(study: Study, held_out: bool) -> Figure:
    """Measured cells and the scatter of the model's runs, before and after."""
    groups = study.envelopes(held_out)
    if not groups:
        return _sentence("No data were held out." if held_out else "No cells were compared.")
    flagged = set() if held_out else study.flagged()
    figure, panels = _panels(len(groups), 1.55)
    for axes, ((experiment, observable), rows) in zip(panels, groups.items()):
        x = np.array([row["index"] for row in rows], dtype=float)
        _draw_band(axes, x, rows, "base", style.BLUE, -0.15)
        _draw_band(axes, x, rows, "after", style.GREEN, 0.15)
        for row in rows:
            is_flagged = (experiment, observable, row["index"]) in flagged
            axes.errorbar(row["index"], row["measured"],
                          2. * row["measured deviation"] / row["repeats"]**0.5, fmt="o",
                          markersize=3.6 if is_flagged else 2.6, linewidth=0.8,
                          color=style.VERMILLION if is_flagged else style.INK)
        description = study.observables[experiment, observable]
        axes.set_title(f"{experiment}: {observable.replace('_', ' ')}", fontsize=7.5)
        axes.tick_params(labelsize=7)
        _label_values(axes, description["unit"])
        if len(rows) == 1:
            axes.set_xlim(x[0] - 1., x[0] + 1.)
            axes.set_xticks([])
        else:
            axes.xaxis.get_major_locator().set_params(integer=True)
    handles = [Line2D([], [], color=style.INK, marker="o", markersize=3, label="measured",
                      linewidth=0.8),
               Patch(color=style.BLUE, alpha=0.4, label="base model")]
    if flagged:
        handles.insert(1, Line2D([], [], color=style.VERMILLION, marker="o", markersize=4,
                                 linewidth=0.8, label="measured, flagged"))
    if any("after" in row for rows in groups.values() for row in rows):
        handles.append(Patch(color=style.GREEN, alpha=0.4, label="with what was added"))
    figure.legend(handles=handles, loc="upper center", ncol=len(handles))
    return figure


def ranking_figure(study: Study) -> Figure:
    """The probability that each effect is the missing one, or one of the missing ones."""
    rows = study.content["candidates"][:MOST_EFFECTS]
    bars = [(row["effect"].replace("_", " "), row["confidence"], style.BLUE) for row in rows]
    bars.append(("none of the catalogue", study.content["confidence off catalogue"], style.GREY))
    figure = Figure(figsize=(style.WIDTH, 0.6 + 0.22 * len(bars)), layout="constrained")
    axes = figure.subplots()
    names, values, colours = zip(*bars)
    axes.barh(range(len(bars)), values, color=colours, height=0.66)
    axes.set_yticks(range(len(bars)), names)
    axes.invert_yaxis()
    axes.set_xlim(0., 1.08)
    axes.set_xlabel("Confidence")
    for k, value in enumerate(values):
        axes.text(value + 0.01, k, f"{value:.2f}", va="center", fontsize=7.5)
    return figure


def _blocks(cells: list[tuple[str, str, int]]) -> list[tuple[int, int, str]]:
    """Beginning, end and name of each sequence of data points that belong to one observable."""
    blocks: list[tuple[int, int, str]] = []
    for k, (experiment, observable, _) in enumerate(cells):
        name = f"{experiment}: {observable.replace('_', ' ')}"
        if blocks and blocks[-1][2] == name:
            blocks[-1] = (blocks[-1][0], k + 1, name)
        else:
            blocks.append((k, k + 1, name))
    return blocks


def fingerprint_figure(cells: list[tuple[str, str, int]], prints: list[Fingerprint],
                       deviation: np.ndarray) -> Figure:
    """What each effect changes, in standard deviations of one run, and what was measured."""
    rows = np.vstack([deviation, *[p.change for p in prints]])
    names = ["measured – base", *[p.effect.replace("_", " ") for p in prints]]
    figure = Figure(figsize=(style.WIDTH, 1.9 + 0.2 * len(names)), layout="constrained")
    axes = figure.subplots()
    limit = float(np.clip(np.nanpercentile(np.abs(rows), 98), 3., 30.))
    image = axes.imshow(rows, aspect="auto", cmap="RdBu_r", vmin=-limit, vmax=limit,
                        interpolation="nearest")
    axes.set_yticks(range(len(names)), names)
    blocks = _blocks(cells)
    axes.set_xticks([0.5 * (first + last - 1) for first, last, _ in blocks],
                    [name for _, _, name in blocks], rotation=90, fontsize=6.5)
    for first, _, _ in blocks[1:]:
        axes.axvline(first - 0.5, color=style.INK, linewidth=0.4)
    axes.axhline(0.5, color=style.INK, linewidth=1.)
    axes.tick_params(length=0)
    figure.colorbar(image, ax=axes, label="standard deviations of a run",
                    fraction=0.03).outline.set_linewidth(0.6)
    return figure


def cosine_figure(study: Study) -> Figure:
    """How similar the changes by each two effects are."""
    similarity = study.content["similarity"]
    names = [name.replace("_", " ") for name in similarity["effects"]]
    matrix = np.array([[np.nan if value is None else value for value in row]
                       for row in similarity["cosines"]], dtype=float)
    size = 1.9 + 0.24 * len(names)
    figure = Figure(figsize=(style.WIDTH, min(size, style.WIDTH)), layout="constrained")
    axes = figure.subplots()
    image = axes.imshow(matrix, cmap="RdBu_r", vmin=-1., vmax=1., interpolation="nearest")
    axes.set_xticks(range(len(names)), names, rotation=90)
    axes.set_yticks(range(len(names)), names)
    for (a, b), value in np.ndenumerate(matrix):
        if np.isfinite(value) and a != b and abs(value) >= 0.5:
            axes.text(b, a, f"{value:.1f}", ha="center", va="center", fontsize=6,
                      color="white" if abs(value) > 0.75 else style.INK)
    axes.tick_params(length=0)
    figure.colorbar(image, ax=axes, label="cosine", fraction=0.04).outline.set_linewidth(0.6)
    return figure


def gap_figure(study: Study) -> Figure:
    """Discrepancy between model and measurement before and after."""
    gaps = study.content["gaps"]
    figure = Figure(figsize=(style.WIDTH, 2.), layout="constrained")
    axes = figure.subplots()
    labels = []
    last = "with the closest model" if study.verdict == "off catalogue" else "after"
    for name in ("fit", "held-out"):
        table = gaps.get(name, {})
        for key, colour, when in (("gap before", style.BLUE, "before"), ("gap after", style.GREEN, last)):
            if key not in table:
                continue
            axes.barh(len(labels), table[key], color=colour, height=0.66)
            labels.append(f"{'data of the fit' if name == 'fit' else 'held-out data'}, {when}")
    axes.set_yticks(range(len(labels)), labels)
    axes.invert_yaxis()
    axes.set_xlabel("Gap (standard deviations of a run, root mean square over the cells)")
    return figure


def posterior_figure(study: Study) -> Figure:
    """Posterior probability of each amplitude, with its interval."""
    rows = study.content["amplitudes"]
    figure, panels = _panels(len(rows), 1.7)
    for axes, row in zip(panels, rows):
        amplitudes, weights = np.array(row["posterior"], dtype=float).reshape(-1, 2).T
        axes.plot(amplitudes, weights / max(weights.max(), 1e-300), color=style.BLUE, linewidth=1.2)
        axes.axvspan(row["lower"], row["upper"], color=style.BLUE, alpha=0.2, linewidth=0.)
        axes.axvline(row["amplitude"], color=style.INK, linewidth=0.8)
        axes.set_title(row["effect"].replace("_", " "), fontsize=7.5)
        axes.set_xlabel("amplitude" + ("" if row["unit"] == "1" else f" ({row['unit']})"), fontsize=7.5)
        axes.set_yticks([])
        axes.tick_params(labelsize=7)
    return figure


def learning_figure(study: Study) -> Figure:
    """The answer's probability and the p-value of nothing missing by the number of runs."""
    rows = study.content["learning curve"]
    figure = Figure(figsize=(style.WIDTH, 2.), layout="constrained")
    left, right = figure.subplots(1, 2)
    runs = [row["runs"] for row in rows]
    left.plot(runs, [row["probability"] for row in rows], marker="o", markersize=3, color=style.BLUE)
    left.set_ylim(0., 1.05)
    left.set_ylabel("probability of the likeliest")
    right.semilogy(runs, [max(row["p of nothing missing"], 1e-30) for row in rows], marker="o",
                   markersize=3, color=style.GREEN)
    right.set_ylabel("p of nothing missing")
    for axes in (left, right):
        axes.set_xlabel("runs")
    return figure
