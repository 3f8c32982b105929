"""The job script for SLURM, with a launcher and a queue that stand in for the cluster's: a job that was stopped goes
back into the queue, the one that comes back continues it, so does another job that names its folder, and a job with
another input goes on from where one has finished.

Usage: slurm.py path/to/eunoe-particles folder
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

from eunoe.launch import Failure
from eunoe.repository import ROOT

CASE = ROOT / "prm" / "examples" / "falling_particles.prm"
QUIET = ("--set", "simulation control/output frequency = 0")
# Of a run that is stopped at its first checkpoint. It takes longer to write than hundreds of steps.
OFTEN = ("--set", "restart/frequency = 100")
# The launcher stops a run when the file `stop` is there; the queue notes what comes back into it. On clusters that
# kill all ranks when the first ends with another code than 0, that of a run that was stopped is lost. The case is checked
# by all ranks, as it is run.
SRUN = """#!/bin/sh
[ "$1 $2" = "--kill-on-bad-exit=0 --wait=60" ] || exit 137
shift 2
case "$*" in *--check*) exec "$@" ;; esac
"$@" & child=$!
if [ -e stop ]; then
  until ls output/*/restart_0*.checkpoint > /dev/null 2> /dev/null; do sleep 0.05; done
  kill -USR1 $child
fi
wait $child
"""
SCONTROL = """#!/bin/sh
echo "$@" >> requeued
"""


def job(program: str, folder: Path, number: int, *options: str, **variables: str) -> str:
    """What a job of this number says; its exit code is to be 0."""
    for name, text in (("srun", SRUN), ("scontrol", SCONTROL)):
        file = folder / "bin" / name
        file.parent.mkdir(exist_ok=True)
        file.write_text(text, encoding="utf-8")
        file.chmod(0o755)
    environment = {**os.environ, "PATH": f"{folder / 'bin'}:{os.environ['PATH']}", "EUNOE_PROGRAM": program,
                   "SLURM_JOB_ID": str(number), **variables}
    done = subprocess.run(["bash", str(ROOT / "contrib" / "slurm" / "spreading.sbatch"), str(CASE), *QUIET, *options],
                          cwd=folder, env=environment, text=True, capture_output=True, check=False)
    if done.returncode != 0:
        raise Failure(f"exit code {done.returncode}:\n{done.stdout}{done.stderr}")
    return done.stdout + done.stderr


def main() -> int:
    program, folder = str(Path(sys.argv[1]).resolve()), Path(sys.argv[2])
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    results = folder / "output" / "falling_particles-7"
    (folder / "stop").touch()
    job(program, folder, 7, *OFTEN)
    if (results / "summary.json").exists() or (folder / "requeued").read_text(encoding="utf-8") != "requeue 7\n":
        raise Failure("a job that was stopped is not in the queue again")
    kept = folder / "kept"
    shutil.copytree(results, kept)
    (folder / "stop").unlink()
    for number, place, variables in ((7, results, {}), (8, kept, {"EUNOE_OUTPUT": str(kept)})):
        if "Continuing from" not in job(program, folder, number, **variables):
            raise Failure(f"job {number} began anew")
        if json.loads((place / "summary.json").read_text(encoding="utf-8"))["first_step"] == 0:
            raise Failure(f"the results of job {number} are not in {place}")
    if sorted(path.name for path in (folder / "output").iterdir()) != ["falling_particles-7"]:
        raise Failure("a job that goes on with another one's folder has made one of its own")
    end = json.loads((results / "summary.json").read_text(encoding="utf-8"))["steps"]
    job(program, folder, 9, "--set", f"restart/restart folder = {results}", "--set", "simulation control/time end = 0.065",
        "--set", "lagrangian physical properties/friction coefficient wall = 0.4")
    longer = json.loads((folder / "output" / "falling_particles-9" / "summary.json").read_text(encoding="utf-8"))
    if longer["first_step"] < end or not (results / "summary.json").exists():
        raise Failure(f"a job with another input goes on from step {longer['first_step']}, not from {end} of the one before")
    return 0


if __name__ == "__main__":
    sys.exit(main())
