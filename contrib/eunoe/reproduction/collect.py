"""The small results of a run: what the analysis needs of it, as text, in a folder of the repository."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

from eunoe.folders import read_json, write_whole
from eunoe.launch import Failure
from eunoe.report.apparatus import Apparatus, ApparatusError
from eunoe.report.bed_maps import n_bins_of, read_maps, write_table
from eunoe.report.run_folder import read_run
from eunoe.studies.series import summary_of
from eunoe.vtk_files import VtkError

from .cases import Case
from .kept import RECORD
from .places import DATA
from .runs import LAYERS, Campaign, layers_weighed, processor_of, revision_of, settings_of

LEAST_LAYERS = 3  # of a run that goes on; fewer say nothing
TABLES = (LAYERS, "measurements.csv", "apparatus.json")
BED = "bed.csv"
# Of summary.json.
KEPT = ("version", "git_revision", "ranks", "first_step", "steps", "time_step", "simulated_time", "particle_steps",
        "particle_steps_per_second", "loop_seconds", "share_asleep", "inserted_mass", "inside_mass", "lost_particles",
        "mass_balance_error")


def record_of(case: Case, folder: Path, layers: int, n_bins: int) -> dict[str, Any]:
    """What was run, by what, and what it took. A run that goes on has no timings yet."""
    summary = summary_of(folder) or {}
    return {"case": case.name, "finished": bool(summary), "layers": layers, "processor": processor_of(folder),
            "settings": settings_of(case), "git_revision": revision_of(folder), "x_bins": n_bins,
            **{key: summary[key] for key in KEPT if key in summary}}


def _is_new(case: Case, is_finished: bool, layers: int, target: Path) -> bool:
    """Whether a run has more to say than what is kept of a run of this name. Its states may have been lost since
    then, and it may have begun anew."""
    if is_finished or layers < LEAST_LAYERS:
        return is_finished
    if not (target / RECORD).exists():
        return True
    kept = read_json(target / RECORD)
    return not kept["finished"] and (kept["settings"] != settings_of(case) or layers > kept["layers"])


def collect(campaign: Campaign, case: Case, data: Path = DATA) -> Path | None:
    """Writes the small results of a run, finished or not, and returns their folder; None if there is nothing new."""
    folder = campaign.of(case)
    target = data / case.name
    if not _is_new(case, campaign.is_finished(case), layers_weighed(folder), target):
        return None
    campaign.check(case)
    run = read_run(folder)
    try:
        apparatus = Apparatus.read(folder / "apparatus.json")
        # Maps are for the questions of the mechanism; other variants are compared by their densities alone.
        pictures = run.layer_pictures() if case.keeps_maps else {}
        maps = read_maps(pictures, apparatus) if pictures else None
    except (ApparatusError, VtkError) as error:
        raise Failure(f"{case.name}: {error}") from error
    # From here on all that is read is in order, so that old and new results are not mixed.
    target.mkdir(parents=True, exist_ok=True)
    for name in TABLES:
        if (folder / name).exists():
            shutil.copyfile(folder / name, target / name)
    if maps is not None:
        write_table(target / BED, maps)
    else:
        (target / BED).unlink(missing_ok=True)
    record = record_of(case, folder, len(run.layers), n_bins_of(apparatus))
    write_whole(target / RECORD, json.dumps(record, indent=1) + "\n")
    return target
