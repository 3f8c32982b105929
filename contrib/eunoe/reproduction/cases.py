"""The table of cases: what is run, in which order, with which settings.

All cases have the paper's proportions, gaps, rims, spreader, strokes and powder, from
prm/spreading/PS*_L1.prm. What they change to be affordable is in `CHEAP`; doc/reproduction.md gives the
reasons. A variant changes one thing more, or goes back to the apparatus before an error in it was found.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from eunoe.launch import Failure
from eunoe.powder import PAPER, PARTICLES, TIME_STEP, WALL
from eunoe.repository import CASES as INPUT_FILES

L1 = 1. / 7.  # of the full size
SPREADING, MODEL = "powder spreading", "model parameters"
SLEEP = f"{MODEL}/adaptive sparse contacts/enable adaptive sparse contacts"
FORGET = f"{MODEL}/contact history/forget interval"
FORGETFUL = f"{MODEL}/contact history/forgetful contacts"
BALANCE_INTERVAL = 7.0e-3  # s between two load balances of the published input files
NEIGHBORHOOD = f"{MODEL}/contact detection/neighborhood threshold"
SETS = ("PS1", "PS2", "PS3")
N_LAYERS = 21

CHEAP = {SLEEP: "true", f"{SPREADING}/feedstock platform velocity": "11e-3"}
SOFTER = 10.  # what Young's modulus is divided by, unless a variant has the paper's


@dataclass(frozen=True)
class Variant:
    """@param title in words, beside the cases that it is compared with
    @param settings entries of the input and their values
    @param base the variant that it is compared with and whose settings it shares; empty: none
    @param forgets seconds after which contacts forget all; 0: never
    @param stiff whether Young's modulus is the paper's. Where it is divided by `SOFTER`, the pull-off force
        stays, and the time step keeps its share of the Rayleigh time, which goes with the inverse root of the modulus
    @param closely whether maps of its runs are kept and a pass is drawn, as of those without a variant"""

    title: str
    settings: dict[str, Any] = field(default_factory=dict)
    base: str = ""
    forgets: float = 0.
    stiff: bool = False
    closely: bool = False


RADIUS, RIMS = f"{SPREADING}/spreader radius R_s", f"{SPREADING}/rim width"
# Until a1e5cd3 and 065a860 cases had no rims, and a bed level with the transfer plate: a stroke of 0.6 mm fed 0.5.
# They had the radius of the paper's text, and spread layer 0 on a plate at the level of the transfer plate.
BEFORE = {RIMS: "0", f"{SPREADING}/feedstock level": "0",
          f"{SPREADING}/first layer thickness": "0", RADIUS: "5e-3"}
LIPS = {f"{SPREADING}/lip height": "3e-3", f"{SPREADING}/gap": "0.1e-3"}
VARIANTS = {
    "": Variant("as the published input files, at the cheap settings", closely=True),
    "stiff": Variant("the paper's Young's modulus", stiff=True),
    "forget": Variant("contacts forget every 7 ms", forgets=BALANCE_INTERVAL),
    # Contacts with walls and solids only feel how fast they slip then.
    "gliding": Variant("contacts with walls and solids forget at every step", {FORGET: "1", FORGETFUL: "solids"}),
    "radius5": Variant("a spreader of 5 mm of radius, as in the paper's text", {RADIUS: "5e-3"}),
    "unopened": Variant("velocity Verlet without its opening half step",
                        {f"{MODEL}/integration method": "symplectic_euler"}),
    "full": Variant("one deep reservoir", {f"{SPREADING}/feedstock": "full"}),
    "awake": Variant("without sleep", {SLEEP: "false"}),
    "damping": Variant("rolling viscous damping of 0.1, which the input files leave to Lethe",
                       {f"{PARTICLES}/rolling viscous damping particles": "0.1",
                        f"{WALL}/rolling viscous damping wall": "0.1"}),
    # Sleepers give way only when they wake, so that several losses act as one. As often in a layer as on the paper's L4:
    "awake_forget": Variant("without sleep, contacts forget every 1.6 ms", {SLEEP: "false"}, forgets=1.6e-3),
    "slow_feed": Variant("platform at 2 mm/s", {f"{SPREADING}/feedstock platform velocity": "2e-3"}),
    "open": Variant("without rims, fed less", BEFORE, closely=True),
    "open_stiff": Variant("the paper's Young's modulus", base="open", stiff=True, closely=True),
    "ends": Variant("lips and gap of the small cases alone", {RIMS: "0", **LIPS}),
    "lips": Variant("lips and gap of the small cases, fed less",
                    {**BEFORE, **LIPS}),
    "lips_forget": Variant("contacts forget every 10.5 ms", base="lips", forgets=10.5e-3),
    "lips_stiff": Variant("the paper's Young's modulus", base="lips", stiff=True, closely=True),
}


@dataclass(frozen=True)
class Case:
    """One run."""

    properties: str  # the paper's property set
    length: float  # of the plates, in units of L1
    seed: int
    depth: float = 0.4  # mm
    percent: float = 30.  # time step, of the Rayleigh time
    variant: str = ""

    @property
    def group(self) -> str:
        """What the runs that differ in the seed alone have in common."""
        parts = [self.properties, f"L{self.length:g}"]
        if self.depth != 0.4:
            parts.append(f"depth{self.depth:g}")
        if self.percent != 30.:
            parts.append(f"step{self.percent:g}")
        return "_".join([*parts, *([self.variant] if self.variant else [])])

    @property
    def name(self) -> str:
        return f"{self.group}_seed{self.seed}"

    @property
    def title(self) -> str:
        """What differs from the group that it is compared with, in words."""
        parts = [f"depth of {self.depth:g} mm"] if self.depth != 0.4 else []
        if self.percent != 30.:
            parts.append(f"step of {self.percent:g} % of the Rayleigh time")
        if self.variant:
            parts.append(VARIANTS[self.variant].title)
        return ", ".join(parts)

    @property
    def full_title(self) -> str:
        """What differs from the cases without a variant, in words."""
        base = VARIANTS[self.variant].base
        return ", ".join([*([VARIANTS[base].title] if base else []), *([self.title] if self.title else [])])

    @property
    def base(self) -> str:
        """The group that this one is compared with; its own if it is compared with none."""
        if self.is_plain:
            return self.group
        return Case(self.properties, self.length, self.seed, variant=VARIANTS[self.variant].base).group

    @property
    def is_plain(self) -> bool:
        return not self.title

    @property
    def has_rims(self) -> bool:
        """Whether walls hold the ends of its bed, as in the paper."""
        return RIMS not in self.settings

    @property
    def is_seen_closely(self) -> bool:
        """Whether a pass of its runs is drawn."""
        variant = VARIANTS[self.variant]
        return variant.closely and (self.is_plain or self.title == variant.title)

    @property
    def keeps_maps(self) -> bool:
        return VARIANTS[self.variant].closely

    @property
    def input_file(self) -> str:
        return str(INPUT_FILES / "spreading" / f"{self.properties}_L1.prm")

    @cached_property
    def settings(self) -> dict[str, Any]:
        """Entries that differ from the input file's."""
        variant = VARIANTS[self.variant]
        powder = PAPER.softened(1. if variant.stiff else 1. / SOFTER, self.percent)
        step = powder[TIME_STEP]
        found = {f"{SPREADING}/length factor": f"{self.length * L1:.10f}",
                 f"{SPREADING}/depth": f"{self.depth:g}e-3", TIME_STEP: step, **CHEAP}
        if not variant.stiff:
            # In a longer step grains move farther, so that searches would come three times as often.
            found.update({**powder, NEIGHBORHOOD: "1.3"})
        if variant.forgets:
            found[FORGET] = math.floor(variant.forgets / float(step))
        return {**found, **VARIANTS[variant.base].settings, **variant.settings}


def _series(properties: str, length: float, seeds: int, **others: Any) -> list[Case]:
    return [Case(properties, length, seed, **others) for seed in range(1, seeds + 1)]


def _in_turn(*series: list[Case]) -> list[Case]:
    """The first case of each series, then the second of each, and so on."""
    return [cases[k] for k in range(max(map(len, series))) for cases in series if k < len(cases)]


# In the order in which they are run: the longest plate that a night affords first, then its like, then what the
# shortcuts do on shorter plates.
CASES = (
    *_series("PS1", 1., 1),
    *_series("PS1", 0.25, 3, variant="lips_forget"),  # beside runs that there are
    *_in_turn(_series("PS1", 0.5, 2), _series("PS3", 0.5, 2)),
    *_in_turn(_series("PS1", 0.25, 3), _series("PS3", 0.25, 3)),
    *_series("PS3", 1., 1),
    *_series("PS1", 1., 3)[1:],
    *_series("PS2", 0.5, 1),
    *_in_turn(_series("PS1", 0.25, 3, variant="awake_forget"), _series("PS1", 0.25, 3, variant="radius5"),
              _series("PS1", 0.25, 3, variant="damping")),
    *_in_turn(_series("PS1", 0.25, 3, variant="forget"), _series("PS1", 0.25, 3, variant="unopened")),
    *_series("PS1", 0.25, 1, variant="gliding"),
    *_in_turn(_series("PS1", 0.25, 3, variant="lips"), _series("PS1", 0.25, 3, variant="lips_stiff"),
              _series("PS3", 0.25, 3, variant="lips_stiff")),
    *_series("PS1", 1., 1, variant="open"),
    *_in_turn(_series("PS1", 0.25, 2, variant="open_stiff"), _series("PS3", 0.25, 1, variant="open_stiff")),
    *_series("PS1", 0.5, 1, variant="open_stiff"),
    *_in_turn(_series("PS1", 0.5, 2, depth=0.8), _series("PS1", 0.5, 2, depth=1.6)),
    *_series("PS1", 0.25, 3, variant="stiff"),
    *_in_turn(_series("PS1", 0.25, 3, variant="slow_feed"), _series("PS1", 0.25, 3, variant="awake"),
              _series("PS1", 0.25, 3, percent=15.)),
    *_in_turn(_series("PS1", 0.25, 3, variant="full"), _series("PS1", 0.25, 3, variant="ends")),
    *_series("PS1", 2., 1),
)


def chosen(words: list[str]) -> list[Case]:
    """The cases that the words name, each by its name or group; all of them if there is no word."""
    for word in words:
        if not any(word in (case.name, case.group) for case in CASES):
            raise Failure(f"There is no case '{word}': contrib/tools reproduction --list names them.")
    return [case for case in CASES if not words or case.name in words or case.group in words]
