"""Ranks that fail end those that wait for them, and one of them says why; and only the first rank
needs to see the files of a case.

Usage: lone_error.py path/to/lone-error path/to/eunoe-particles folder
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from attempts import HANGING
from eunoe.launch import SHARED, mpirun

SENTENCE = "The file is not here."
BOX = Path(__file__).resolve().parents[1] / "meshes" / "gmsh" / "hexahedra.msh"
CASE = """subsection simulation control
  set time step = 1e-5
  set time end = 1e-3
  set output path = results
end
subsection mesh
  set type = gmsh
  set file name = hexahedra.msh
end
subsection lagrangian physical properties
  subsection particle type 0
    set size distribution type = custom
    set custom distribution from file = true
    set custom distribution filename = sizes.txt
  end
end
subsection insertion info
  set insertion method = list
  set list x = 0.5
  set list y = 0.5
  set list z = 0.5
end
"""
failures: list[str] = []


def fail(text: str) -> None:
    failures.append(text)
    print(text)


def lone_error(program: str, ranks: str) -> None:
    place = f"Error on rank(s) {ranks} of 3"
    try:
        run = subprocess.run([*mpirun(3, *SHARED), program, *ranks.split()], timeout=HANGING, text=True,
                             capture_output=True, check=False)
    except subprocess.TimeoutExpired:
        fail(f"{place}: it hangs")
        return
    if run.returncode != 1:
        fail(f"{place}: exit code {run.returncode}")
    if run.stderr.count(SENTENCE) != 1:
        fail(f"{place}: not one '{SENTENCE}' in\n{run.stderr}")


def one_sees_the_files(program: str, folder: Path) -> None:
    """Only the first rank sees the mesh, the sizes and the input, as on nodes that share no folder."""
    shutil.rmtree(folder, ignore_errors=True)
    for name in ("first", "second"):
        (folder / name).mkdir(parents=True)
    shutil.copy(BOX, folder / "first")
    (folder / "first" / "case.prm").write_text(CASE)
    (folder / "first" / "sizes.txt").write_text("diameter; share\n0.001; 1\n")
    launch = mpirun(2, *SHARED)[:-2]  # each rank has a number and a folder of its own
    command = []
    for before, name in ((launch, "first"), ([":"], "second")):
        command += [*before, "-np", "1", "--wdir", str(folder / name), program, "case.prm"]
    try:
        run = subprocess.run(command, timeout=HANGING, text=True, capture_output=True, check=False)
    except subprocess.TimeoutExpired:
        fail("Files that one rank sees: it hangs")
        return
    if run.returncode != 0 or not (folder / "first" / "results" / "summary.json").is_file():
        fail(f"Files that one rank sees: exit code {run.returncode}\n{run.stdout}{run.stderr}")
    if any((folder / "second").iterdir()):
        fail("A rank that does not write has left files.")


def main(program: str, particles: str, folder: Path) -> int:
    # Ranks wait for each other and the launcher for them, so all runs take little more than one.
    with ThreadPoolExecutor() as pool:
        waiting = [pool.submit(lone_error, program, ranks) for ranks in ("0", "1", "1 2", "0 1 2")]
        waiting.append(pool.submit(one_sees_the_files, str(Path(particles).resolve()), folder))
        for one in waiting:
            one.result()
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2], Path(sys.argv[3])))
