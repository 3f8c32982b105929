"""Reader of deal.II's parameter files, as a run writes them in used.prm."""

from __future__ import annotations

from eunoe.launch import Failure


class MissingEntry(Failure):
    """A subsection or an entry that the parameter file lacks."""


class Parameters:
    """A section of a parameter file: its entries as text, and its subsections."""

    def __init__(self, name: str = "") -> None:
        self.name = name
        self.entries: dict[str, str] = {}
        self.sections: dict[str, Parameters] = {}

    def section(self, *names: str) -> Parameters:
        found = self
        for name in names:
            if name not in found.sections:
                raise MissingEntry(f"used.prm has no subsection '{name}'.")
            found = found.sections[name]
        return found

    def text(self, entry: str) -> str:
        if entry not in self.entries:
            raise MissingEntry(f"used.prm has no entry '{entry}' in '{self.name}'.")
        return self.entries[entry]

    def number(self, entry: str) -> float:
        return float(self.text(entry))

    def flat(self) -> dict[str, str]:
        """All entries by "subsection/.../entry"."""
        found = dict(self.entries)
        for name, section in self.sections.items():
            found.update({f"{name}/{entry}": value for entry, value in section.flat().items()})
        return found


def parse_prm(text: str) -> Parameters:
    """The sections and entries of the text of a parameter file; comments are dropped."""
    top = Parameters()
    open_sections = [top]
    for line in text.splitlines():
        words = line.split("#", 1)[0].strip()
        if words.startswith("subsection "):
            name = words[len("subsection "):].strip()
            section = open_sections[-1].sections.setdefault(name, Parameters(name))
            open_sections.append(section)
        elif words == "end" and len(open_sections) > 1:
            open_sections.pop()
        elif words.startswith("set ") and "=" in words:
            entry, value = words[len("set "):].split("=", 1)
            open_sections[-1].entries[" ".join(entry.split())] = value.strip()
    return top
