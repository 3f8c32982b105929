"""The style that all figures share, and their conversion for the page."""

from __future__ import annotations

import io
import re

import matplotlib
import matplotlib.ticker
from cycler import cycler
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure

# The page and the figures, whose text the browser sets, use the same fonts.
FONTS = ["Helvetica Neue", "Helvetica", "Arial", "Liberation Sans", "Nimbus Sans", "DejaVu Sans"]

# From the palette of Okabe and Ito, which the colour-blind can tell apart.
BLUE, ORANGE, VERMILLION, GREEN = "#0072b2", "#e69f00", "#d55e00", "#009e73"
PALE_BLUE = "#a9cbe3"
INK, GREY, PALE_GREY = "#222222", "#777777", "#cccccc"
SOLID_FACE, SOLID_EDGE = "#e4e4e4", "#555555"

WIDTH = 6.5  # of all figures (inch)
RESOLUTION = 260  # of bitmaps (dots per inch)

matplotlib.rcParams.update({
    "font.family": "sans-serif",
    "font.sans-serif": FONTS,
    "font.size": 8.5,
    "axes.titlesize": 8.5,
    "axes.titlelocation": "left",
    "axes.labelsize": 8.5,
    "axes.labelcolor": INK,
    "axes.edgecolor": INK,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.unicode_minus": True,
    "axes.axisbelow": True,
    "axes.prop_cycle": cycler(color=[BLUE, VERMILLION, GREEN, ORANGE]),
    "grid.color": "#e6e6e6",
    "grid.linewidth": 0.5,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.minor.width": 0.4,
    "ytick.minor.width": 0.4,
    "xtick.color": INK,
    "ytick.color": INK,
    "text.color": INK,
    "legend.frameon": False,
    "legend.fontsize": 8.,
    "lines.linewidth": 1.2,
    "hatch.linewidth": 0.5,
    "svg.fonttype": "none",
})


def layer_axis(axes: Axes, last: float) -> None:
    """A horizontal axis of layer numbers from 0 to the last one."""
    axes.set_xlim(-0.7, last + 0.7)
    axes.xaxis.set_major_locator(
        matplotlib.ticker.MaxNLocator(nbins=7, integer=True, min_n_ticks=1))
    axes.set_xlabel("Layer")
    axes.grid(axis="y")


def plain_log_axis(axis: Axis) -> None:
    """Labels a logarithmic axis with plain numbers."""
    low, high = axis.get_view_interval()
    if high < 100. * low:
        axis.set_major_locator(matplotlib.ticker.LogLocator(subs=(1., 2., 5.)))
    axis.set_major_formatter(matplotlib.ticker.FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(matplotlib.ticker.NullFormatter())


def to_svg(figure: Figure, name: str, description: str) -> str:
    """The figure as an svg element for a page, with ids that no other figure there has."""
    buffer = io.StringIO()
    no_metadata = dict.fromkeys(("Date", "Creator", "Format", "Type"))
    with matplotlib.rc_context({"svg.hashsalt": name}):
        figure.savefig(buffer, format="svg", dpi=RESOLUTION, metadata=no_metadata)
    svg = buffer.getvalue()
    svg = svg[svg.index("<svg"):]
    svg = re.sub(r'\bid="', f'id="{name}-', svg)
    svg = re.sub(r'(url\(|xlink:href=")#', rf"\1#{name}-", svg)
    svg = re.sub(r' (?:width|height)="[^"]*pt"', "", svg, count=2)  # the page gives the size
    return svg.replace("<svg ", f'<svg role="img" aria-label="{description}" ', 1)
