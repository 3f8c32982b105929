"""The small results of the campaign as the analysis reads them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from eunoe.folders import read_json
from eunoe.report.apparatus import Apparatus
from eunoe.report.bed_maps import read_table
from eunoe.report.run_folder import read_layers
from eunoe.report.spread_run import Group, SpreadRun

from .cases import CASES, VARIANTS, Case
from .collect import BED
from .kept import RECORD
from .places import DATA
from .runs import UNKNOWN

OPEN, HELD = ("open", "open_stiff"), ("lips_stiff",)  # the variants whose ends nothing holds, and those with lips


@dataclass(frozen=True)
class Result(SpreadRun):
    """A run that has finished, or goes on."""

    case: Case
    record: dict[str, Any]

    @classmethod
    def read(cls, case: Case, folder: Path) -> Result:
        apparatus = Apparatus.read(folder / "apparatus.json")
        record = read_json(folder / RECORD)
        maps = read_table(folder / BED, apparatus, record.get("x_bins")) if (folder / BED).exists() else None
        return cls(case.name, read_layers(folder / "layers.csv"), apparatus, maps, case, record)

    @property
    def revision(self) -> str:
        revision = str(self.record["git_revision"])
        return revision if revision == UNKNOWN else revision[:7]


class Findings:
    """All finished runs whose small results are there, by groups in the order of the campaign, and those that go on."""

    def __init__(self, data: Path = DATA, cases: Iterable[Case] = CASES) -> None:
        self.cases = tuple(cases)
        self.results: dict[str, list[Result]] = {}
        self.under_way: list[Result] = []
        for case in self.cases:
            if not (data / case.name / RECORD).exists():
                continue
            result = Result.read(case, data / case.name)
            if result.record["finished"]:
                self.results.setdefault(case.group, []).append(result)
            else:
                self.under_way.append(result)

    def __bool__(self) -> bool:
        return bool(self.results)

    @property
    def all(self) -> list[Result]:
        return [result for results in self.results.values() for result in results]

    def plain(self) -> list[Group]:
        """The groups without a variant, shorter plates first."""
        found = [results for results in self.results.values() if results[0].case.is_plain]
        found.sort(key=lambda results: (results[0].case.length, results[0].case.properties))
        return [Group(plain_label(results[0].case), results) for results in found]

    def alike(self) -> list[Group]:
        """Those, and the variants of them whose beds end at rims, too: all are taken to scatter alike between seeds."""
        return [*self.plain(),
                *(Group(f"{base.label}, {group.label}", group.runs) for base, variants in self.variants()
                  for group in variants if base.runs[0].case.is_plain and group.runs[0].case.has_rims)]

    def of(self, properties: str, length: float) -> Group | None:
        """The group without a variant."""
        results = self.results.get(Case(properties, length, 1).group)
        return Group(plain_label(results[0].case), results) if results else None

    def lengths(self, properties: str) -> list[Group]:
        """The groups of a property set without a variant, shorter plates first."""
        return [group for group in self.plain() if group.runs[0].case.properties == properties]

    def of_variants(self, variants: Iterable[str]) -> list[Group]:
        """The groups of some variants, shorter plates first; their labels say what differs among these variants."""
        names = set(variants)
        found = [results for results in self.results.values() if results[0].case.variant in names]
        found.sort(key=lambda results: results[0].case.length)
        cases = [results[0].case for results in found]
        return [Group(", ".join([plain_label(case), *([case.title] if VARIANTS[case.variant].base in names else [])]),
                      results) for case, results in zip(cases, found)]

    def variants(self) -> list[tuple[Group, list[Group]]]:
        """Groups with variants, with the group that they are to be compared with, as far as that is there."""
        found: dict[str, tuple[Group, list[Group]]] = {}
        for name, results in self.results.items():
            case = results[0].case
            base = self.results.get(case.base)
            if name == case.base or not base:
                continue
            label = ", ".join(filter(None, [plain_label(base[0].case), base[0].case.title]))
            found.setdefault(case.base, (Group(label, base), []))[1].append(Group(case.title, results))
        return list(found.values())


def plain_label(case: Case) -> str:
    return f"{case.properties}, {length_name(case.length)}"


def length_name(length: float) -> str:
    """As the paper names its lengths."""
    if length == int(length):
        return f"L{length:g}"
    return f"L1/{1. / length:g}"


def origin_of(results: Iterable[Result], command: str = "contrib/tools reproduction") -> str:
    """The sentence that says what made a table."""
    found = list(results)
    revisions = sorted({result.revision for result in found})
    processors = sorted({result.record["processor"] for result in found})
    return (f"Made by `{command}` at revision{'s' if len(revisions) > 1 else ''} {', '.join(revisions)} on an "
            f"{' and an '.join(processors)}.")
