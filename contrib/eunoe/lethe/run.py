"""Runs Lethe's own examples as they are and compares what comes out with published numbers.

Usage: contrib/tools lethe path/to/eunoe-particles path/to/lethe/examples/dem FOLDER
           [--only NAME ...] [--ranks 2] [--set ENTRY=VALUE ...]
       contrib/tools lethe path/to/eunoe-particles path/to/lethe FOLDER --first-steps 1000
       contrib/tools lethe path/to/eunoe-particles path/to/lethe/applications_tests/lethe-particles FOLDER --last-states

The inputs are copied into the folder. An example that has finished is not run again. lethe.md in the
folder has the table. With --first-steps, every input beneath the second path goes through --check and so
many steps, and the table says of each whether it runs, or why not. With --last-states it runs to its end, whose
particles are compared with those that Lethe prints.
"""

from __future__ import annotations

import argparse
import json
import shutil
import subprocess
import time
from pathlib import Path

from eunoe.launch import Failure, mpirun, overrides, parser
from eunoe.tables import Table, as_markdown

from . import last_states
from .examples import EXAMPLES, Example


def input_of(example: Example, part: str, place: Path) -> Path:
    """The input file of a part; of a template, the file that it makes."""
    path = place / part
    if not example.template:
        return path
    text = path.read_text(encoding="utf-8")
    for word, value in example.template.items():
        text = text.replace("{{" + word + "}}", value)
    made = path.with_suffix(".prm")
    made.write_text(text, encoding="utf-8")
    return made


def run(name: str, options: argparse.Namespace) -> Path:
    """Runs the parts that have not finished yet; returns the example's folder."""
    example = EXAMPLES[name]
    place = options.folder / name.replace(" ", "_").replace(",", "")
    if not place.exists():
        shutil.copytree(options.examples / example.folder, place)
    for part in example.parts:
        done = place / (part + ".seconds")
        if done.exists():
            continue
        command = [*mpirun(options.ranks), str(Path(options.program).resolve()), input_of(example, part, place).name,
                   *overrides(example.settings.get(part, {})), *overrides(options.settings)]
        start = time.monotonic()
        with open(place / (part + ".log"), "w", encoding="utf-8") as log:
            code = subprocess.run(command, cwd=place, stdout=log, stderr=subprocess.STDOUT, check=False).returncode
        if code != 0:
            raise Failure(f"{name}: {part} ended with exit code {code}, see {place / part}.log.")
        done.write_text(f"{time.monotonic() - start:.0f}\n", encoding="utf-8")
    return place


def rows_of(name: str, place: Path) -> Table:
    example = EXAMPLES[name]
    seconds = sum(int((place / (part + ".seconds")).read_text(encoding="utf-8")) for part in example.parts)
    minutes = f"{seconds / 60.:.1f} min"
    return [[name if k == 0 else "", result.what, result.published, result.ours,
             example.time_of_lethe if k == 0 else "", minutes if k == 0 else ""]
            for k, result in enumerate(example.measure(place))]


def attempt(path: Path, options: argparse.Namespace) -> list[str]:
    """Whether an input passes --check and goes through its first steps, or all of them."""
    program, name = str(Path(options.program).resolve()), path.name
    place = options.folder / path.relative_to(options.examples).parent
    # Tests of Lethe run one level beneath their files.
    files = place / f"{path.stem}_files"
    if files.is_dir():
        name, place = str((place / name).resolve()), files / "run"
        place.mkdir(exist_ok=True)
    control = "simulation control/"
    few = [control + "end control = iteration", control + f"iteration end = {options.first_steps}"]
    settings = overrides([*(few if options.first_steps > 0 else ["post-processing/final state/calculation = true"]),
                          control + "output frequency = 0", "restart/checkpoint = false",
                          control + f"output path = results_{path.stem}", *options.settings])
    for words in ([program, "--check", name], [program, "--quiet", name, *settings]):
        done = subprocess.run(words, cwd=place, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            problems = [line for line in done.stderr.splitlines() if line and not line.startswith("Warning")]
            return ["refused" if words[1] == "--check" else "stops", problems[0] if problems else "?"]
    results = place / f"results_{path.stem}"
    if options.last_states:
        theirs = last_states.published(path)
        return ["runs", last_states.compared(theirs, last_states.ours(results)) if theirs else "nothing to compare"]
    summary = json.loads((results / "summary.json").read_text(encoding="utf-8"))
    return ["runs", f"{summary['particles']} particles, {summary['lost_particles']} lost"]


def main(words: list[str]) -> int:
    arguments = parser(__doc__)
    arguments.add_argument("program")
    arguments.add_argument("examples", type=Path)
    arguments.add_argument("folder", type=Path)
    arguments.add_argument("--only", nargs="+", default=list(EXAMPLES), choices=EXAMPLES, metavar="NAME")
    arguments.add_argument("--ranks", type=int, default=1)
    arguments.add_argument("--first-steps", type=int, default=0)
    arguments.add_argument("--last-states", action="store_true")
    arguments.add_argument("--set", action="append", default=[], dest="settings", metavar="ENTRY=VALUE")
    options = arguments.parse_args(words)
    if options.first_steps > 0 or options.last_states:
        if not options.folder.exists():
            shutil.copytree(options.examples, options.folder)
        table = [["input", "", ""]]
        for path in sorted(options.examples.rglob("*.prm")):
            table.append([str(path.relative_to(options.examples)), *attempt(path, options)])
            print(*table[-1], sep=": ", flush=True)
    else:
        options.folder.mkdir(parents=True, exist_ok=True)
        table = [["example", "number", "published", "ours", "time of Lethe", "our time"]]
        for name in options.only:
            table += rows_of(name, run(name, options))
    (options.folder / "lethe.md").write_text(as_markdown(table), encoding="utf-8")
    print(as_markdown(table))
    return 0
