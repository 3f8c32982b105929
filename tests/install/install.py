"""A separate project uses an installed Eunoe: after cmake --install into an empty folder, the
project finds the package, adds the observable of CONTRIBUTING.md to the program and runs a case.

Usage: install.py path/to/cmake path/to/build folder
"""

from __future__ import annotations

import csv
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from contributing import CENTRE_OF_MASS, shown_files

HERE = Path(__file__).resolve().parent
CASE = """
subsection simulation control
  set time step = 1e-6
  set time end = 1e-6
  set log frequency = 0
  set output path = results
end
subsection insertion info
  set list x = 0, 4e-3
  set list y = 0, 0
  set list z = 0, 0
end
"""


def call(*command: str | Path, **options) -> None:
    run = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE,
                         stderr=subprocess.STDOUT, text=True, check=False, **options)
    if run.returncode != 0:
        sys.exit(f"{' '.join(str(word) for word in command)}\n{run.stdout}")


def main(cmake: str, build: Path, folder: Path) -> int:
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    prefix, own = folder / "prefix", folder / "build"
    call(cmake, "--install", build, "--prefix", prefix)
    code = next(text for name, text in shown_files().items() if name.startswith("source/observables"))
    observable = folder / "centre_of_mass.cc"
    observable.write_text(code, encoding="utf-8")
    call(cmake, "-S", HERE / "project", "-B", own, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
         f"-DCMAKE_PREFIX_PATH={prefix}", f"-DOBSERVABLE={observable}")
    call(cmake, "--build", own)
    # The program must use the installed library, not that of the build folder.
    libraries = subprocess.run(["ldd", own / "own-particles"], check=True, capture_output=True, text=True)
    used = [Path(path) for path in re.findall(r"libeunoe\.so => (\S+)", libraries.stdout)]
    assert used and all(prefix in path.parents for path in used), libraries.stdout
    (folder / "case.prm").write_text(CENTRE_OF_MASS + CASE, encoding="utf-8")
    call(own / "own-particles", "case.prm", "--quiet", cwd=folder, env=os.environ)
    with open(folder / "results" / "centre_of_mass.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    # The masses are as 1 to 8.
    assert len(rows) == 2 and abs(float(rows[1]["x"]) - 32e-3 / 9.) < 1e-12, rows
    call(prefix / "bin" / "eunoe-particles", "--version")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], Path(sys.argv[2]).resolve(), Path(sys.argv[3]).resolve()))
