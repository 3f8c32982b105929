"""The result of a spreading run in a few sentences."""

from __future__ import annotations

import numpy as np

from .evidence import Evidence
from .layer_results import DensityNoise, Feed, feed_of
from .measured import Measured
from .quantities import SPACE, count, length, mass, percent
from .run_folder import Layers


def _span(numbers: np.ndarray) -> str:
    return f"layer {numbers[0]:.0f}" if len(numbers) == 1 else f"layers {numbers[0]:.0f} to {numbers[-1]:.0f}"


def _measured_words(layers: Layers, numbers: np.ndarray, measured: Measured | None) -> str:
    """The mean of the same layers in the measurement; where that lacks some, both means of those that it has.

    :param numbers: of the layers whose density the run knows
    """
    same = np.intersect1d(numbers, measured.layer) if measured else np.empty(0)
    if not measured or not len(same):
        return ""
    reference = percent(measured.mean_over(same))
    where = " at full size" if measured.is_of_paper else ""
    if len(same) == len(numbers):
        return f", against {reference} measured in the same layers{where}"
    mean = percent(layers.lrd[np.isin(layers.layer, same)].mean())
    return f", and {mean} in {_span(same)}, against {reference} measured there{where}"


def _density_sentence(layers: Layers, noise: DensityNoise | None, measured: Measured | None) -> str:
    known = np.isfinite(layers.lrd)
    if not known.any():
        return "A density takes two weighings, so there is none yet. "

    def with_noise(value: float, error: float | None) -> str:
        if error is None:
            return percent(value)
        return f"{100. * value:.1f}{SPACE}±{SPACE}{100. * error:.1f}{SPACE}%"

    numbers = layers.layer[known]
    text = "The layer relative density (LRD) is " if len(numbers) == 1 else \
        "The mean layer relative density (LRD) is "
    text += with_noise(layers.lrd[known].mean(), noise.mean_lrd if noise else None) + f" in {_span(numbers)}"
    text += _measured_words(layers, numbers, measured)
    if len(numbers) > 1:
        peak = int(np.nanargmax(layers.lrd))
        text += (f"; it is highest in layer {layers.layer[peak]:.0f}, at "
                 + with_noise(layers.lrd[peak], noise.lrd[peak] if noise else None))
    if noise is not None:
        text += " (±: counting noise)"
    return text + ". "


def _feed_sentence(feed: Feed, has_pictures: bool) -> str:
    if feed.total <= 0.:
        return ""
    text = (f"Of the {mass(feed.total)} of powder that "
            + ("left the feedstock platform, " if has_pictures else "came to a known place, ")
            + f"{percent(feed.plate / feed.total, 0)} lies on the plate, "
            f"{percent(feed.gap / feed.total, 0)} fell into the gaps and "
            f"{percent(feed.collector / feed.total, 0)} went to the collector")
    if has_pictures:
        text += (f"; {percent(feed.elsewhere / feed.total, 0)} is still on the other plates or "
                 "falling")
    return text + "."


def summary_text(layers: Layers, evidence: Evidence, noise: DensityNoise | None,
             measured: Measured | None) -> str:
    text = (f"After layer {layers.last}, {count(layers.particles[-1])} particles "
            f"({mass(layers.mass[-1])}) lie on the measuring plate")
    if evidence.apparatus is not None:
        text += (f", which is {length(evidence.apparatus.plate_length)} long and "
                 f"{length(evidence.apparatus.depth)} deep")
    text += ". " + _density_sentence(layers, noise, measured)
    if layers.layer[0] > 0:
        return text  # what fell and went to the collector before is in the table of another run; the plate holds all
    has_pictures = evidence.last is not None and evidence.apparatus is not None \
        and max(evidence.pictures) == layers.last
    feed = feed_of(layers, evidence.apparatus, evidence.last if has_pictures else None)
    return text + _feed_sentence(feed, has_pictures)
