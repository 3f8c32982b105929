"""The page: one HTML file that carries its figures and its style."""

from __future__ import annotations

import base64
from html import escape
from pathlib import Path
from typing import Iterable, Sequence

from matplotlib.figure import Figure

from . import style

CSS = """
:root { color-scheme: light; }
body { font: 16px/1.55 %(fonts)s; color: #222; background: #fff; max-width: 800px;
  margin: 2.5rem auto 4rem; padding: 0 1.2rem; }
h1 { font-size: 1.65rem; line-height: 1.25; font-weight: 600; margin: 0 0 .3rem; }
h2 { font-size: 1.15rem; font-weight: 600; margin: 2.4rem 0 .5rem; }
p { margin: .6rem 0; }
.subtitle { color: #666; margin: 0 0 1.2rem; }
.notice { border-left: 3px solid #d55e00; padding: .1rem 0 .1rem .9rem; }
figure { margin: 1.2rem 0 1.6rem; break-inside: avoid; }
figure svg, figure img { display: block; width: 100%%; height: auto; }
figcaption { font-size: .86rem; line-height: 1.45; color: #444; margin-top: .4rem; }
table { border-collapse: collapse; width: 100%%; font-size: .88rem; margin: .8rem 0;
  font-variant-numeric: tabular-nums; break-inside: avoid; }
th, td { padding: .22rem .8rem .22rem 0; text-align: right; vertical-align: baseline; }
th:first-child, td:first-child { text-align: left; }
th:last-child, td:last-child { padding-right: 0; }
thead th { font-weight: 600; border-bottom: 1px solid #222; }
tbody tr + tr td { border-top: 1px solid #eee; }
td.bar { width: 34%%; text-align: left; padding-left: .4rem; }
td.bar span { display: inline-block; height: .62rem; background: #0072b2; }
details { margin: 1rem 0; }
summary { cursor: pointer; color: #0072b2; }
pre { font: .76rem/1.4 "DejaVu Sans Mono", Menlo, Consolas, monospace; background: #f7f7f7;
  padding: .8rem; overflow-x: auto; }
@media print { body { max-width: none; margin: 0; font-size: 10.5pt; } }
""" % {"fonts": ", ".join(f'"{font}"' for font in style.FONTS) + ", sans-serif"}


class Page:
    """Collects the parts of a page from top to bottom."""

    def __init__(self, title: str, subtitle: str) -> None:
        self.title = title
        self.parts = [f"<h1>{escape(title)}</h1>", f'<p class="subtitle">{escape(subtitle)}</p>']
        self.figures: list[Figure] = []
        self.movies: list[bytes] = []

    def heading(self, text: str) -> None:
        self.parts.append(f"<h2>{escape(text)}</h2>")

    def paragraph(self, text: str) -> None:
        self.parts.append(f"<p>{escape(text)}</p>")

    def notice(self, text: str) -> None:
        """Adds a notice of something that limits what the report shows."""
        self.parts.append(f'<p class="notice">{escape(text)}</p>')

    def figure(self, figure: Figure, caption: str) -> None:
        self.figures.append(figure)
        number = len(self.figures)
        name = f"figure-{number}"
        svg = style.to_svg(figure, name, escape(caption.split(".")[0], quote=True))
        self.parts.append(f"<figure>{svg}<figcaption>Figure {number}. {escape(caption)}"
                          "</figcaption></figure>")

    def movie(self, gif: bytes, caption: str) -> None:
        self.movies.append(gif)
        data = base64.b64encode(gif).decode()
        self.parts.append(f'<figure><img alt="{escape(caption.split(".")[0], quote=True)}" '
                          f'src="data:image/gif;base64,{data}"><figcaption>Movie {len(self.movies)}. '
                          f"{escape(caption)}</figcaption></figure>")

    def write_figures(self, folder: Path, file_format: str) -> None:
        """Writes each figure as a file of its own: figure-1.pdf, ..., movie-1.gif, ..."""
        folder.mkdir(parents=True, exist_ok=True)
        for number, figure in enumerate(self.figures, start=1):
            figure.savefig(folder / f"figure-{number}.{file_format}", dpi=style.RESOLUTION)
        for number, gif in enumerate(self.movies, start=1):
            (folder / f"movie-{number}.gif").write_bytes(gif)

    def table(self, head: Sequence[str], rows: Iterable[Sequence[str]]) -> None:
        self.parts.append(table(head, rows))

    def timing_table(self, rows: Iterable[tuple[str, str, str, float]]) -> None:
        """Columns: name, seconds, seconds of the slowest rank, and share, also drawn as a bar."""
        body = "".join(
            f"<tr><td>{escape(name)}</td><td>{mean}</td><td>{slowest}</td>"
            f"<td>{100. * share:.1f}\u00a0%</td>"
            f'<td class="bar"><span style="width:{100. * share:.1f}%"></span></td></tr>'
            for name, mean, slowest, share in rows)
        self.parts.append("<table><thead><tr><th>Part of the time loop</th><th>mean (s)</th>"
                          "<th>slowest rank (s)</th><th>share</th><th></th></tr></thead>"
                          f"<tbody>{body}</tbody></table>")

    def fold(self, summary: str, content: str) -> None:
        """Adds content (HTML) that is shown on demand."""
        self.parts.append(f"<details><summary>{escape(summary)}</summary>{content}</details>")

    def html(self) -> str:
        return ('<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
                '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
                f"<title>{escape(self.title)}</title>\n<style>{CSS}</style>\n</head>\n<body>\n"
                + "\n".join(self.parts) + "\n</body>\n</html>\n")


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table of text, with titles of the columns if there are any."""
    titles = "".join(f"<th>{escape(cell)}</th>" for cell in head)
    top = f"<thead><tr>{titles}</tr></thead>" if head else ""
    body = "".join("<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>"
                   for row in rows)
    return f"<table>{top}<tbody>{body}</tbody></table>"


def preformatted(text: str) -> str:
    return f"<pre>{escape(text)}</pre>"
