"""--check says of every case and study that comes with the program that it is in order, and of a
layer of full length that is fifty times as wide as the paper's. None hangs.

Usage: check_cases.py path/to/many-runs path/to/eunoe-discovery folder
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import tempfile
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from attempts import PATIENCE
from eunoe.launch import overrides
from many_runs import ManyRuns, SharedProcesses

ROOT = Path(__file__).resolve().parents[2]
# Far above what a check takes on a busy machine.
HANG = 120 * PATIENCE
HUNG = -signal.SIGKILL
# Processor time (s) of a check, whatever else the machine does. It takes one at most; making the mesh of a wide
# case would take more than ten.
MOST_WORK = 5. * PATIENCE
# Cases that read a bed that a script makes, and studies that read data measured on a twin.
MADE_FIRST = {"column_collapse", "soft_column", "settled_bed", "slot", "plough", "late_pass", "study", "heap_study",
              "angle_only", "rolling"}
# A warning that is right for this case, and one that depends on the machine.
MEANT = {"stacked_pair": "would be shot off."}
OF_THE_MACHINE = ("Warning: Memory:", "the disk lacks about")


def is_input(file: Path) -> bool:
    """Not parts, which cases include, effects, which are patches, and twins, which make data."""
    return not {"parts", "effects"} & set(file.parts) and "\nsubsection twin" not in file.read_text()


def work_of(program: ManyRuns) -> float:
    """Processor time (s) that its process has had."""
    if program.process is None:
        return 0.
    fields = Path(f"/proc/{program.process.pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def answer_on_case(particles: SharedProcesses, *words: str) -> tuple[int, str, str, float]:
    """Exit code, output, errors, and the processor time (s) of the check."""
    with particles.one() as program:
        before = work_of(program)
        # Files that a case names are relative to the folder where the program starts.
        done = program(*words, cwd=ROOT)
        return done.returncode, done.stdout, done.stderr, work_of(program) - before


def answer(*command: str) -> tuple[int, str, str, float]:
    """The same of a program that is started for it, with its children."""
    with tempfile.TemporaryFile("w+") as output, tempfile.TemporaryFile("w+") as errors:
        process = subprocess.Popen(command, cwd=ROOT, stdout=output, stderr=errors)
        alarm = threading.Timer(HANG, process.kill)
        alarm.start()
        _, status, usage = os.wait4(process.pid, 0)
        alarm.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
        output.seek(0)
        errors.seek(0)
        return process.returncode, output.read(), errors.read(), usage.ru_utime + usage.ru_stime


def complaint(particles: SharedProcesses, discovery: str, file: Path, *settings: str) -> str:
    is_study = "\nsubsection discovery" in file.read_text()
    place = f"{file.relative_to(ROOT)} {' '.join(settings)}"
    words = (str(file), "--check", *overrides(settings))
    code, output, errors, work = answer(discovery, *words) if is_study else answer_on_case(particles, *words)
    if code == HUNG:
        return f"{place}: it hangs"
    if work > MOST_WORK:
        return f"{place}: it takes {work:.1f} s of a processor, more than {MOST_WORK} s"
    in_order = f"The {'study' if is_study else 'case'} is in order."
    doubts = [line for line in output.splitlines() if line.startswith("Warning:")]
    allowed = (*OF_THE_MACHINE, MEANT.get(file.stem, "nothing"))
    strange = [line for line in doubts if not any(text in line for text in allowed)]
    says_so = (output.splitlines() or [""])[-1] == in_order
    if code == 0 and not strange and says_so == (not doubts):
        return ""
    if file.stem in MADE_FIRST and code == 2 and "cannot be read" in errors:
        return ""
    return f"{place}: exit code {code}\n{output}{errors}"


def main(many_runs: str, discovery: str, folder: str) -> int:
    particles = SharedProcesses(many_runs, Path(folder))
    files = [file for file in sorted((ROOT / "prm").rglob("*.prm")) if is_input(file)]
    wide = (ROOT / "prm/spreading/PS1_L4.prm", "powder spreading/length factor = 1",
            "powder spreading/depth = 0.1")
    with ThreadPoolExecutor(2) as pool:
        answers = [pool.submit(complaint, particles, discovery, *case)
                   for case in [wide, *((file,) for file in files)]]
        wrong = [text for text in (answer.result() for answer in answers) if text]
    print("\n".join(wrong) if wrong else f"{len(answers)} cases are in order")
    return 1 if wrong or len(files) < 60 else 0


if __name__ == "__main__":
    sys.exit(main(*(str(Path(path).resolve()) for path in sys.argv[1:])))
