"""What the campaign still lacks, and what that costs."""

from __future__ import annotations

from pathlib import Path

from eunoe.studies.series import summary_of
from eunoe.tables import Table

from .cases import N_LAYERS, Case
from .cost import Cost, cost_of
from .kept import is_kept
from .runs import LAYERS, Campaign, layers_weighed


def measured_speed(campaign: Campaign, cases: list[Case]) -> float | None:
    """Particle-steps per second and core of the finished runs together; None if there is none yet."""
    done = [summary for case in cases if (summary := summary_of(campaign.of(case)))]
    seconds = sum(summary["loop_seconds"] * summary["ranks"] for summary in done)
    return sum(summary["particle_steps"] for summary in done) / seconds if seconds > 0. else None


def state_of(campaign: Campaign, case: Case, data: Path) -> tuple[str, float]:
    """In words, and the share that is left to do, by layers."""
    if campaign.is_finished(case) or is_kept(case, data):
        return "finished", 0.
    folder = campaign.of(case)
    layers = layers_weighed(folder)
    return (f"{layers} of {N_LAYERS} layers" if (folder / LAYERS).exists() else "missing"), 1. - layers / N_LAYERS


def plan_of(campaign: Campaign, cases: list[Case], data: Path, speed: float | None) -> tuple[Table, str]:
    """A row for each case, and a sentence on what is left.

    :param data: where results are kept
    :param speed: particle-steps per second and core; None: what --check assumes
    """
    costs: dict[str, Cost] = {}
    table = [["case", "particles", "steps (million)", "particle-steps (1e9)", "core-hours", "state"]]
    left = 0.
    for case in cases:
        if case.group not in costs:
            costs[case.group] = cost_of(campaign.command(case))
        cost = costs[case.group]
        hours = cost.particle_steps / (speed or cost.speed) / 3600.
        state, share = state_of(campaign, case, data)
        left += share * hours
        table.append([case.name, str(cost.particles), f"{1e-6 * cost.steps:.2f}", f"{1e-9 * cost.particle_steps:.0f}",
                      f"{hours:.2g}", state])
    origin = ("the speed that --check assumes" if speed is None else
              f"{1e-6 * speed:.1f} million particle-steps per second and core, sleepers included, as the finished "
              "runs made")
    return table, f"Left to do: about {left:.3g} core-hours at {origin}."
