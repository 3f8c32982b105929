"""All files that a restart needs are on the disk before the index names the checkpoint, so that a
crash of the machine loses no more than one interval; at other times the run does not wait for the
disk.

Usage: sync.py path/to/eunoe-particles path/to/liblog-syncs.so folder
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from eunoe.endurance.kill_and_restart import Case

CASE = str(Path(__file__).with_name("stirred.prm"))
STEPS = (700, 1400, 1500)  # the last is the end


def main(program: str, library: str, folder: Path) -> int:
    case = Case(program, CASE, folder, [])
    log = folder / "calls"
    subprocess.run(case.command(1, "restart/checkpoint = true", "restart/frequency = 700",
                                "simulation control/iteration end = 1500",
                                "simulation control/output frequency = 100"),
                   check=True, capture_output=True,
                   env={**os.environ, "LD_PRELOAD": library, "SYNC_LOG": str(log)})
    prefix = f"{case.results}/"
    lines = [line for line in log.read_text().splitlines() if str(case.results) in line]
    calls = [line.replace(prefix, "") for line in lines]
    failures = []
    begin = 0
    for last, step in zip((0, *STEPS), STEPS):
        name = f"restart_{step:012}.checkpoint"
        steps = [f"sync {name}.new", f"name {name}", f"sync {case.results}", "sync restart.latest.new",
                 "name restart.latest", f"sync {case.results}"]
        here = calls[begin:]
        if steps[0] not in here:
            failures.append(f"{name} is not brought to the disk")
            break
        at = here.index(steps[0])
        if here[at:at + len(steps)] != steps:
            failures.append(f"checkpoint and index: {here[at:at + len(steps)]}")
        tables = {f"sync {table}.csv" for table in ("energies", "solid_forces_00", "force_0")}
        pictures = {f"sync {series}_{number:05}.vtu" for series in
                    ("out", "out_solids", "out_cells", "out_force_chains")
                    for number in range(last // 100 + (last > 0), step // 100 + 1)}
        before = {line for line in here[:at] if line.startswith("sync ")}
        missing = (tables | pictures) - before
        if missing:
            failures.append(f"before the checkpoint of step {step} it lacks: {sorted(missing)}")
        begin += at + len(steps)
    late = [line for line in calls[begin:] if line.startswith("sync ") and "dump" not in line]
    if late:
        failures.append(f"after the last checkpoint it waits for the disk: {late}")
    syncs = [line for line in calls[:begin] if line.startswith("sync ") and line.endswith(".vtu")]
    if len(syncs) != len(set(syncs)):
        failures.append("pictures are synced twice")
    print(*failures, sep="\n")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(str(Path(sys.argv[1]).resolve()), sys.argv[2], Path(sys.argv[3]).resolve()))
