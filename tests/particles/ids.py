"""Ids beyond those that single precision represents (16.7 million) and that 31 bits hold: pictures
have them exactly, a run continues with them from a checkpoint on any number of ranks, and when no
id is left it stops with a sentence. The test forges a checkpoint that claims so many insertions.

Usage: ids.py path/to/eunoe-particles folder
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np

from attempts import HANGING
from bad_input.forged import forged, set_head
from eunoe.endurance.kill_and_restart import Case
from eunoe.vtk_files import read_pvd, read_vtu

CASE = str(Path(__file__).with_suffix(".prm"))
RESTART = "restart/restart = true"
OLD = [1, 2, 3, 4]


def continued(begun: Case, folder: Path, next_id: int) -> Case:
    """A case that continues from the checkpoint of another one, as if more ids had been used."""
    case = Case(begun.program, CASE, folder, [])
    shutil.copytree(begun.results, case.results)
    checkpoint = case.results / "restart_000000000010.checkpoint"
    checkpoint.write_bytes(forged(checkpoint.read_bytes(), set_head("insertion/next_id", next_id)))
    return case


def last(case: Case, name: str, fields: tuple[str, ...]) -> dict[str, np.ndarray]:
    return read_vtu(read_pvd(case.results / f"{name}.pvd")[-1].file, fields)


def check_pictures(case: Case, first: int) -> None:
    ids = last(case, "out", ("ID",))["ID"]
    assert ids.dtype == np.int64, f"ids are written as {ids.dtype}"
    expected = [*OLD, *range(first, first + 4)]
    assert sorted(ids.tolist()) == expected, f"{sorted(ids.tolist())} instead of {expected}"
    contacts = last(case, "out_force_chains", ("first", "second"))
    pairs = set(zip(contacts["first"][::2].tolist(), contacts["second"][::2].tolist()))
    assert pairs, "no contacts are drawn"
    assert pairs <= {(a, b) for a in expected for b in expected if a < b}, f"contacts {pairs}"
    assert any(a >= first for a, _ in pairs), f"no contact of the new ones: {pairs}"


def check_exhausted(begun: Case, folder: Path, ranks: int) -> None:
    case = continued(begun, folder, 2**32 - 4)  # the last id is 2^32 - 2
    before = {file.name: file.read_bytes() for file in case.results.glob("restart*")}
    run = subprocess.run(case.command(ranks, RESTART, "restart/frequency = 1000"), text=True,
                         check=False, capture_output=True, timeout=HANGING)
    assert run.returncode == 1, f"exit code {run.returncode}:\n{run.stdout}{run.stderr}"
    for part in ("4 particles are to be inserted, but of the 4294967294 ids",
                 "only 3 are left. Nothing was inserted,"):
        assert part in run.stderr, f"no '{part}' in:\n{run.stderr}"
    for name, content in before.items():
        assert (case.results / name).read_bytes() == content, f"{name} has changed"


def main(program: str, folder: Path) -> int:
    begun = Case(str(Path(program).resolve()), CASE, folder / "begun", [])
    begun.run(1, "simulation control/iteration end = 10")
    for first in (2**24 + 6, 2**31 + 8, 2**32 - 5):  # 2**32 - 5 leaves just four ids
        name = f"{first}_"
        alone = continued(begun, folder / (name + "1"), first)
        alone.run(1, RESTART)
        check_pictures(alone, first)
        two = continued(begun, folder / (name + "2"), first)
        two.run(2, RESTART, "simulation control/iteration end = 30")
        two.run(2, RESTART)
        check_pictures(two, first)
        assert two.dump.read_bytes() == alone.dump.read_bytes(), \
            f"from id {first} on the state differs on two ranks, restarted"
    for ranks in (1, 2):
        check_exhausted(begun, folder / f"exhausted_{ranks}", ranks)
    print("ok")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], Path(sys.argv[2])))
