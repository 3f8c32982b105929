"""The part of the page that every run has: what was run, how long it took, and its input."""

from __future__ import annotations

from .page import Page, preformatted
from .quantities import count, duration, mass, number
from .run_folder import Run

Summary = dict[str, float | str]


def _particles_and_mass(summary: Summary, key: str) -> str:
    return f"{count(float(summary[key + '_particles']))} ({mass(float(summary[key + '_mass']))})"


def _provenance_rows(summary: Summary, outlets: dict[str, str]) -> list[tuple[str, str]]:
    """:param outlets: what leaving through some outlets means, by their boundary ids"""
    def plain(key: str) -> str:
        return str(summary[key])

    def whole(key: str) -> str:
        return count(float(summary[key]))

    def seconds(key: str) -> str:
        return f"{number(float(summary[key]), 4)}\u00a0s"

    entries = [
        ("Eunoe", "version", plain),
        ("Git revision", "git_revision", plain),
        ("deal.II", "deal_ii_version", plain),
        ("Ranks", "ranks", whole),
        ("Time step", "time_step", seconds),
        ("Steps", "steps", whole),
        ("Simulated time", "simulated_time", seconds),
        ("Particle-steps", "particle_steps", lambda key: number(float(summary[key]))),
        ("Particle-steps per second", "particle_steps_per_second",
         lambda key: f"{number(float(summary[key]) * 1e-6)} million"),
        ("Wall-clock time", "wall_seconds", lambda key: duration(float(summary[key]))),
        ("Contact searches", "contact_searches", whole),
        ("Load balances", "load_balances", whole),
        ("Particles at the end", "particles",
         lambda key: f"{whole(key)} ({mass(float(summary['inside_mass']))})"),
        ("Inserted", "inserted_particles", lambda _: _particles_and_mass(summary, "inserted")),
        ("Taken out", "taken_out_particles", lambda _: _particles_and_mass(summary, "taken_out")),
    ]
    rows = [(name, text(key)) for name, key, text in entries if key in summary]
    for key in summary:
        if key.startswith("outlet_") and key.endswith("_mass"):
            outlet = key[len("outlet_"):-len("_mass")]
            rows.append((outlets.get(outlet, f"Left through outlet {outlet}"),
                         _particles_and_mass(summary, f"outlet_{outlet}")))
    if "mass_balance_error" in summary:
        rows.append(("Error of the mass balance",
                     f"{number(float(summary['mass_balance_error']))}\u00a0kg"))
    return rows


def _timing_rows(summary: Summary) -> list[tuple[str, str, str, float]]:
    slowest = "_slowest_rank"
    total = float(summary.get("loop_seconds", 0.))
    if total <= 0.:
        return []
    rows, known = [], 0.
    for key, value in summary.items():
        if key.startswith("seconds_") and not key.endswith(slowest):
            known += float(value)
            name = key[len("seconds_"):].replace("_", " ")
            rows.append((name, number(float(value)), number(float(summary[key + slowest])),
                         float(value) / total))
    rows.sort(key=lambda row: -row[3])
    rest = max(0., total - known)
    rows.append(("waiting for other ranks, and the rest", number(rest), "", rest / total))
    return rows


def add_run_section(page: Page, run: Run, outlets: dict[str, str]) -> None:
    """Adds provenance, timings and the input, as far as the run has them."""
    if run.summary is not None:
        page.heading("The run")
        page.table((), _provenance_rows(run.summary, outlets))
        timings = _timing_rows(run.summary)
        if timings:
            page.heading("Where the time went")
            page.timing_table(timings)
    if run.parameters_text:
        page.fold("All parameters of the run (used.prm)", preformatted(run.parameters_text))
