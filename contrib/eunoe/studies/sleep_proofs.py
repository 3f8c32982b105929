"""Whether sleeping particles change what creeps or flows: runs small cases whose slopes stand at their angle of
repose, awake and with sleep, for several seeds, which draw sizes and places anew, and compares.

Usage: contrib/tools sleep-proofs path/to/eunoe-particles folder [--proofs slope creep trickle hourglass]
       [--variants sleep speed_alone coarse] [--seeds 1 2 3 4] [--jobs 1] [--table-only]

    slope      a periodic bed under a gravity that is turned in jumps, from below to above its angle of repose
    creep      the same with the rolling resistance `constant`, with which a slope never comes to rest
    trickle    a heap on which grains fall one by one
    hourglass  discharge through a hole that is close to arching

The cases are those of prm/sleep. Variants: `sleep` has the rest criterion that is the default, `speed_alone`
looks at nothing but a speed of 0.3 mm/s during 2 ms, `coarse` at nothing but 1 cm/s; `awake` is always made. A
run that has finished is not run again. sleep_proofs.csv in the folder has what each finished run measured,
sleep_proofs.md means and standard deviations over the seeds, and the difference from awake with a 95 % interval
(Welch's t).
"""

from __future__ import annotations

import argparse
import json
import math
import statistics
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from eunoe.intervals import difference_of
from eunoe.launch import Failure, logged, overrides
from eunoe.repository import CASES, ROOT
from eunoe.tables import Table, read_rows, write_csv

from .series import arguments, mean_and_spread, plus_minus, publish, summary_of

Settings = dict[str, object]
Rows = list[dict[str, float]]

SPARSE = "model parameters/adaptive sparse contacts"
ENABLE = {f"{SPARSE}/enable adaptive sparse contacts": "true"}
NO_LIMIT = {f"{SPARSE}/rest displacement": 1e3}
VARIANTS: dict[str, Settings] = {
    "awake": {},
    "sleep": ENABLE,
    "speed_alone": {**ENABLE, **NO_LIMIT, f"{SPARSE}/rest speed": 3e-4, f"{SPARSE}/rest time": 2e-3},
    "coarse": {**ENABLE, **NO_LIMIT, f"{SPARSE}/rest speed": 1e-2, f"{SPARSE}/rest time": 2e-3},
}
GRAVITY = 9.81
GRAIN = 1e-3  # mean diameter of prm/verification/parts/grains.prm (m)
GRAIN_MASS = math.pi / 6. * 2500. * statistics.mean(d**3 for d in (0.8e-3, 0.9e-3, 1e-3, 1.1e-3, 1.2e-3))  # (kg)


@dataclass(frozen=True)
class Stage:
    """A start of the program; it continues from the stage before it. `shared`: the same for all variants."""

    name: str
    settings: Settings
    shared: bool = False


@dataclass(frozen=True)
class Proof:
    """@param case file in prm/sleep
    @param measure what a run shows, from the energies.csv of each of its stages"""

    case: str
    stages: tuple[Stage, ...]
    measure: Callable[[dict[str, Rows]], dict[str, float]]


# A bed under a gravity that turns.

SETTLED, HOLD = 0.3, 0.3  # duration of the settling, and under each angle (s)
# Up until it flows, and down until it rests: a bed that flows stops at a smaller angle than the one at which
# it starts.
ANGLES = (20, 22, 24, 26, 28, 27, 26, 25, 24, 23, 22, 20)
HIGHEST = ANGLES.index(max(ANGLES))
RESTS = 22  # up to which the bed comes to rest, or creeps


def tilted(angle: float) -> str:
    radians = math.radians(angle)
    return f"{GRAVITY * math.sin(radians):.9g}, 0, {-GRAVITY * math.cos(radians):.9g}"


def slope(case: str, settings: Settings) -> Proof:
    angles = [Stage(f"{angle} {'up' if k <= HIGHEST else 'down'}", {**settings, "lagrangian physical properties/g": tilted(angle),
                                 "simulation control/time end": SETTLED + HOLD * (k + 1)})
              for k, angle in enumerate(ANGLES)]
    return Proof(case, (Stage("settle", settings, shared=True), *angles), slope_measures)


def slope_measures(stages: dict[str, Rows]) -> dict[str, float]:
    """How far the bed moves along the slope under each angle, and below the angle of repose how much of that
    in the last third of the time, in diameters."""
    def way(rows: Rows, share: float) -> float:
        late = rows[-int(share * len(rows)):]
        speed = statistics.mean(row["momentum_x"] / (row["particles"] * GRAIN_MASS) for row in late)
        return speed * share * HOLD / GRAIN
    angles = {name: rows for name, rows in stages.items() if name != "settle"}
    return {**{f"{name}: moves (d)": way(rows, 1.) for name, rows in angles.items()},
            **{f"{name}: in the end (d)": way(rows, 1. / 3.) for name, rows in angles.items()
               if int(name.split()[0]) <= RESTS}}


# A heap that grows grain by grain.

FULL, TRICKLED = 5., 25.  # time after which the heap has all that it can hold, and at the end (s)
PLATE = 20e-3  # (m)
FILLED = 251  # grains that have come then
PER_SECOND, STEP = 8, 8e-6  # grains that trickle (1/s), and the time step (s)
TRICKLE = (Stage("fill", {"simulation control/time end": FULL}, shared=True),
           Stage("trickle", {"simulation control/time end": TRICKLED,
                             "insertion info/insertion frequency": round(1. / (PER_SECOND * STEP)),
                             "lagrangian physical properties/particle type 0/number of particles":
                                 FILLED + round(PER_SECOND * (TRICKLED - FULL))}))


def trickle_measures(stages: dict[str, Rows]) -> dict[str, float]:
    rows = stages["trickle"]
    height = [row["potential"] / (GRAVITY * GRAIN_MASS * row["particles"]) for row in rows]
    # The centre of a wedge lies at a third of its height.
    angles = [math.degrees(math.atan(6. * h / PLATE)) for h in height]
    return {"grains on the plate": statistics.mean(row["particles"] for row in rows),
            "angle from the mean height (degrees)": statistics.mean(angles)}


# An hourglass.

OPENED = 0.2  # (s)


def hourglass_measures(stages: dict[str, Rows]) -> dict[str, float]:
    rows = stages["run"]
    flow = [row for row in rows if 2800. > row["particles"] > 1500.]
    last = rows[-1]["particles"]
    emptied = next(row["time"] for row in rows if row["particles"] <= last + 0.02 * (3000. - last))
    return {"rate (grains/s)": (flow[0]["particles"] - flow[-1]["particles"]) / (flow[-1]["time"] - flow[0]["time"]),
            "98 % have left after (s)": emptied - OPENED, "grains that stay": last}


PROOFS = {
    "slope": slope("slope", {}),
    "creep": slope("slope", {"model parameters/rolling resistance torque method": "constant"}),
    "trickle": Proof("trickle", TRICKLE, trickle_measures),
    "hourglass": Proof("hourglass", (Stage("run", {}),), hourglass_measures),
}


@dataclass(frozen=True)
class Run:
    proof: str
    variant: str
    seed: int

    @property
    def name(self) -> str:
        return f"{self.proof}_{self.variant}_seed{self.seed}"

    def folder_of(self, folder: Path, stage: Stage) -> Path:
        return folder / f"{self.proof}_seed{self.seed}_{stage.name}" if stage.shared else folder / self.name / stage.name.replace(" ", "_")

    def make(self, options: argparse.Namespace, only_shared: bool = False) -> bool:
        """Makes the stages that have not finished, or only the first ones, which variants share; false if one
        failed."""
        proof, before = PROOFS[self.proof], None
        for stage in (stage for stage in proof.stages if stage.shared or not only_shared):
            here = self.folder_of(options.folder, stage)
            if not summary_of(here):
                settings = {"simulation control/output path": here.resolve(), "simulation control/log frequency": 0,
                            **stage.settings, **({} if stage.shared else VARIANTS[self.variant])}
                if len(proof.stages) > 1:
                    settings["restart/checkpoint"] = "true"
                if before:
                    settings |= {"restart/restart": "true", "restart/restart folder": before.resolve()}
                command = [options.program, str(CASES / "sleep" / f"{proof.case}.prm"), "--seed", str(self.seed),
                           *overrides(settings)]
                if logged(command, options.folder / f"{self.name}.log", ROOT) != 0:
                    return False
            before = here
        return True

    def result(self, folder: Path) -> dict[str, float] | None:
        """What the run measured, and the share of particle steps that were slept; None if it has not finished."""
        stages = [(stage, self.folder_of(folder, stage)) for stage in PROOFS[self.proof].stages]
        summaries = [summary_of(path) for _, path in stages]
        if not all(summaries):
            return None
        measures = PROOFS[self.proof].measure({stage.name: read_rows(path / "energies.csv") for stage, path in stages})
        steps = sum(s["particle_steps"] for s in summaries)
        return {**measures,
                "share asleep": sum(s["share_asleep"] * s["particle_steps"] for s in summaries) / steps}


def table_of(found: dict[tuple[str, str], list[dict[str, float]]], proofs: list[str], variants: list[str]) -> Table:
    """A row for each quantity: awake, then each variant and its difference."""
    table = [["case", "quantity", "awake", *(text for name in variants for text in (name, "difference"))]]
    for proof in proofs:
        awake = found.get((proof, "awake"), [])
        for k, quantity in enumerate(awake[0] if awake else ()):
            reference = [run[quantity] for run in awake]
            cells = [mean_and_spread(reference)]
            for name in variants:
                values = [run[quantity] for run in found.get((proof, name), [])]
                if not values:
                    cells += ["", ""]
                    continue
                gap = difference_of(values, reference)
                cells += [mean_and_spread(values), plus_minus(gap.value, gap.half, "+.2g")]
            table.append([f"{proof} ({len(awake)} seeds)" if k == 0 else "", quantity, *cells])
    return table


def main(words: list[str]) -> int:
    parser = arguments(__doc__, [1, 2, 3, 4])
    parser.add_argument("--proofs", nargs="+", choices=PROOFS, default=list(PROOFS))
    parser.add_argument("--variants", nargs="*", choices=[name for name in VARIANTS if name != "awake"],
                        default=["sleep"])
    options = parser.parse_args(words)
    options.program = str(Path(options.program).resolve())
    options.folder.mkdir(parents=True, exist_ok=True)
    runs = [Run(proof, variant, seed) for seed in options.seeds for proof in options.proofs
            for variant in ("awake", *options.variants)]

    def make(run: Run) -> bool:
        good = run.make(options)
        print(f"{run.name}: {json.dumps(run.result(options.folder)) if good else 'failed, see its log'}", flush=True)
        return good

    with ThreadPoolExecutor(options.jobs) as pool:
        if not options.table_only:
            list(pool.map(lambda run: run.make(options, only_shared=True),
                          [run for run in runs if run.variant == "awake"]))
        good = all(list(pool.map(make, () if options.table_only else runs)))
    done = [(run, result) for run in runs if (result := run.result(options.folder))]
    if not done:
        raise Failure("No run has finished.")
    found: dict[tuple[str, str], list[dict[str, float]]] = {}
    for run, result in done:
        found.setdefault((run.proof, run.variant), []).append(result)
    write_csv(options.folder / "sleep_proofs.csv",
              [["proof", "variant", "seed", "quantity", "value"],
               *([run.proof, run.variant, run.seed, quantity, value] for run, result in done
                 for quantity, value in result.items())])
    publish(table_of(found, options.proofs, options.variants), options.folder / "sleep_proofs.md")
    return 0 if good else 1
