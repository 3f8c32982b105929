"""What the program itself says of a case before it runs: --check."""

from __future__ import annotations

import re
from dataclasses import dataclass

from eunoe.launch import Failure, output_of
from eunoe.repository import ROOT

PARTICLES = re.compile(r"particles:\s+(\d+) at most")
STEPS = re.compile(r"steps:\s+(\d+) of ([0-9.e+-]+) s")
PARTICLE_STEPS = re.compile(r"\(([0-9.e+]+) particle-steps at ([0-9.]+) million")


@dataclass(frozen=True)
class Cost:
    """What --check says of a case."""

    particles: int  # at most
    steps: int
    time_step: float  # s
    particle_steps: float
    speed: float  # particle-steps per second and core that --check assumes

    @classmethod
    def parse(cls, text: str) -> Cost:
        found = [pattern.search(text) for pattern in (PARTICLES, STEPS, PARTICLE_STEPS)]
        if None in found:
            raise Failure(f"--check does not say what the case costs:\n{text[-1000:]}")
        return cls(int(found[0][1]), int(found[1][1]), float(found[1][2]), float(found[2][1]), 1e6 * float(found[2][2]))


def cost_of(command: list[str]) -> Cost:
    """:param command: starts the case"""
    return Cost.parse(output_of([*command, "--check"], ROOT))
