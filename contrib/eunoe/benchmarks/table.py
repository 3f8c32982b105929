"""Medians, ratios and tables of repeated measurements."""

from __future__ import annotations

from dataclasses import dataclass
from statistics import median

SECTIONS = ("integration", "contact_search", "ghosts", "particle_contacts", "solid_contacts",
            "loads", "output", "process")


@dataclass
class Row:
    """A case on a number of ranks: each program's speeds (particle-steps/s), one for each
    repeat."""

    title: str
    ranks: int
    speeds: dict[str, list[float]]

    def ratio(self) -> float | None:
        """Eunoe's median over that of the fastest peer; None without a peer."""
        peers = [median(values) for name, values in self.speeds.items() if name != "Eunoe" and values]
        ours = self.speeds.get("Eunoe", [])
        return median(ours) / max(peers) if peers and ours else None


def cell(speeds: list[float]) -> str:
    """'median (least to most)' in million particle-steps/s."""
    if not speeds:
        return "-"
    low, middle, high = (1e-6 * f(speeds) for f in (min, median, max))
    return f"{middle:.2f} ({low:.2f} to {high:.2f})"


def cells(rows: list[Row], names: list[str], missing: list[str] | None = None) -> list[list[str]]:
    """Head and rows of the table of speeds; a missing peer's column says that it is missing."""
    missing = missing or []
    table = [["case", "ranks", *names, *missing, "ratio"]]
    for row in rows:
        ratio = row.ratio()
        table.append([row.title, str(row.ranks), *(cell(row.speeds.get(n, [])) for n in names),
                      *("MISSING" for _ in missing), "-" if ratio is None else f"{ratio:.2f}"])
    return table


def shares(summary: dict) -> dict[str, float]:
    """Shares of the loop's time, mean over ranks; 'other' is the time outside all timers."""
    loop = summary["loop_seconds"]
    result = {name: summary[f"seconds_{name}"] / loop for name in SECTIONS}
    result["other"] = 1. - sum(result.values())
    return result


def share_cells(cases: list[tuple[str, int, list[dict]]]) -> list[list[str]]:
    """Head and rows of the table of shares; each share is the median over the runs."""
    table = [["case", "ranks", *(name.replace("_", " ") for name in (*SECTIONS, "other")),
              "slowest rank"]]
    for title, ranks, summaries in cases:
        parts = [shares(summary) for summary in summaries]
        slow = median(s["seconds_particle_contacts_slowest_rank"]
                      / max(s["seconds_particle_contacts"], 1e-300) for s in summaries)
        table.append([title, str(ranks),
                      *(f"{100. * median(p[name] for p in parts):.1f} %" for name in parts[0]),
                      f"{slow:.2f}"])
    return table
