"""A whole study of a cheap process: data of a hidden truth, the study without any way to that truth, its
answer and files; the same answer on two ranks, after a kill and after a full disk; other data answered from the
table of runs; a plan of measurements; and what is refused.

Usage: end_to_end.py path/to/drop-discovery folder
"""

import contextlib
import hashlib
import json
import shutil
import signal
import sqlite3
import subprocess
import sys
import time
from pathlib import Path

from attempts import HANGING
from eunoe.launch import mpirun, overrides

HERE = Path(__file__).resolve().parent
NAMED, BAD_INPUT, FAILED, STOPPED = 10, 2, 1, 3
# Keys that belong to one start of the program, not to the answer.
PASSING = ("simulations", "ledger")


class Program:
    def __init__(self, path: str, folder: Path) -> None:
        self.path, self.folder = path, folder

    def command(self, *arguments: str, ranks: int = 1) -> list[str]:
        return [*mpirun(ranks, "--oversubscribe"), self.path, *arguments]

    def run(self, *arguments: str, ranks: int = 1) -> tuple[int, str]:
        done = subprocess.run(self.command(*arguments, ranks=ranks), cwd=self.folder, text=True,
                              capture_output=True, check=False, timeout=HANGING)
        return done.returncode, done.stdout + done.stderr


def settings(**entries: str) -> list[str]:
    # Drawing the page takes seconds, and one is enough.
    entries = {"write_page": "false", **entries}
    return overrides({f"discovery/{name.replace('_', ' ')}": value for name, value in entries.items()})


def answer(folder: Path) -> dict:
    content = json.loads((folder / "discovery.json").read_text())
    return {key: value for key, value in content.items() if key not in PASSING}


def expect(result: tuple[int, str], code: int, *words: str) -> None:
    assert result[0] == code, f"exit code {result[0]} instead of {code}:\n{result[1]}"
    for word in words:
        assert word in result[1], f"'{word}' is missing in:\n{result[1]}"


def prepare(folder: Path) -> None:
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for name in ("study.prm", "truth.prm", "drop.prm"):
        shutil.copy(HERE / name, folder)
    shutil.copytree(HERE / "effects", folder / "effects")


def make_data(program: Program) -> None:
    folder = program.folder
    expect(program.run("--make-twin", "truth.prm"), 0, "cells to fit")
    sealed = (folder / "truth.sealed.json").read_bytes()
    data = (folder / "measured.csv").read_text()
    assert f"sealed truth sha256: {hashlib.sha256(sealed).hexdigest()}" in data
    assert json.loads(sealed)["effects"] == {"tilt": 0.7}
    assert "tilt" not in data and ",held-out\n" in data and ",fit\n" in data
    expect(program.run("--make-twin", "truth.prm"), BAD_INPUT, "is there already")
    expect(program.run("--make-twin", "truth.prm", "--set", "twin/observables = drift, heigth", "--set",
                       "discovery/measured data = few/few.csv", "--set", "twin/sealed file = few.json"), FAILED,
           "no experiment measures 'heigth'")
    few = ("twin/observables = drift, height: 2", "discovery/measured data = few/few.csv", "twin/sealed file = few.json")
    expect(program.run("--make-twin", "truth.prm", *(word for entry in few for word in ("--set", entry))), 0)
    rows = [line.split(",") for line in (folder / "few" / "few.csv").read_text().splitlines() if line[0] != "#"]
    assert {tuple(row[1:3]) for row in rows[1:]} == {("drift", "0"), ("height", "2")}, rows
    for name in ("few/few.csv", "few.json", "few.json.runs.sqlite"):
        (folder / name).unlink()
    # What only some runs of the model give is left out of a study, with a note.
    (folder / "measured.csv").write_text(data + "box,height,4,0.02,0.001,4,fit\n")
    # From here on no program can read the truth.
    for name in ("truth.sealed.json", "truth.prm"):
        (folder / name).unlink()
    (folder / "truth.sealed.json.runs.sqlite").unlink()


def check_refusals(program: Program) -> None:
    folder = program.folder
    before = {path for path in folder.rglob("*") if path.is_file()}
    expect(program.run("study.prm", *overrides((
        "discovery/effects = tlit", "discovery/nuisance 0/entries = /lagrangian physical properties/g",
        "discovery/experiment 0/overrides = restart/restart = true"))), BAD_INPUT, "Did you mean 'tilt'?",
           "Nuisance 'density' / entry 'entries': '/lagrangian physical properties/g': its path has an empty part",
           "entry 'restart' is true, and a study simulates a case from its beginning")
    expect(program.run("study.prm", "--set", "discovery/measured data = no.csv"), BAD_INPUT,
           "no.csv cannot be read")
    expect(program.run("study.prm", "--set", "twin/seed = 1"), BAD_INPUT, "subsection 'twin' is unknown")
    expect(program.run("study.prm", "--set", "discovery/nuisance 0/value = ${base * 1.1}"), BAD_INPUT,
           "does not depend on the amplitude")
    expect(program.run("no.prm"), BAD_INPUT, "no.prm cannot be read")
    expect(program.run(), BAD_INPUT, "An input file is missing")
    (folder / "effects" / "bad.prm").write_text(
        (folder / "effects" / "tilt.prm").read_text().replace("set g =", "set gg ="))
    expect(program.run("study.prm"), BAD_INPUT, "Experiment 'box': effects/bad.prm:",
           "entry 'gg' needs 'base', and the case has no such entry")
    (folder / "effects" / "bad.prm").unlink()
    (folder / "more.csv").write_text((folder / "measured.csv").read_text()
                                     + "box,height,9,1,1,3,fit\n")
    expect(program.run("study.prm", "--check"), 0, "The study is in order", "experiment box (drop)",
           "3 effects and 1 nuisance: ", "core-hours")
    expect(program.run("study.prm", "--check", *settings(budget_of_runs="10")), 0,
           "The budget has no room for the 16 first runs of the base model", "There is 1 warning: see above")
    expect(program.run("--list-observables"), 0, "drift (m): Mean place along x")
    expect(program.run("study.prm", "--list-effects"), 0, "bounce: contacts lose less energy")
    expect(program.run("study.prm", "--print-parameters"), 0, "set null runs")
    after = {path for path in folder.rglob("*") if path.is_file()}
    assert after - before == {folder / "more.csv"}, "what was refused or only checked left files"
    expect(program.run("study.prm", *settings(measured_data="more.csv", output_path="more")), FAILED,
           "index 9 of 'height' is not measured by experiment 'box'", "0, 1, 2, 3")


def check_answer(folder: Path) -> None:
    content = json.loads((folder / "discovery.json").read_text())
    assert content["verdict"] == "named"
    assert content["candidates"][0]["effect"] == "tilt"
    assert any("not every run" in note and "height, index 4" in note for note in content["notes"])
    size = content["amplitudes"][0]
    assert size["lower"] < 0.7 < size["upper"] < 3. * size["lower"], size
    assert content["provenance"]["sha256"].keys() >= {"measured data", "case of box", "effect tilt"}
    assert {row["name"]: row["core_seconds"] > 0. for row in content["experiments"]} == {"box": True, "short": True}
    ledger = content["ledger"]
    assert len(ledger) == content["simulations"]["made_now"] + content["simulations"]["from_table"]
    assert content["learning curve"][-1]["first"] == "tilt"
    assert content["decisive"] and content["amplitudes"][0]["posterior"]
    before = (folder / "model_before_box.prm").read_text()
    after = (folder / "model_after_box.prm").read_text()
    changes = (folder / "model_box.diff").read_text()
    assert before != after and "# before: 1, -9.81, 0" in changes, changes
    assert (folder / "model_after_short.prm").exists()
    assert "experiment,observable,index" in (folder / "envelopes.csv").read_text()


def n_rows(table: Path) -> int:
    if not table.exists():
        return 0
    with contextlib.closing(sqlite3.connect(f"file:{table}?mode=ro", uri=True, timeout=60.)) as base:
        try:
            return base.execute("SELECT COUNT(*) FROM runs").fetchone()[0]
        except sqlite3.OperationalError:
            return 0  # not made yet


def check_full_disk(program: Program, file: Path, arguments: list[str], *words: str) -> None:
    """A result that cannot be written ends all ranks, and nothing of it is left."""
    link = file.with_name(file.name + ".new")
    link.symlink_to("/dev/full")
    expect(program.run(*arguments, ranks=2), FAILED, f"{file.name} cannot be written: No space left on device", *words)
    assert not link.is_symlink(), "it left a file that is not complete"


def check_resume(program: Program) -> None:
    """A study that is killed as soon as some runs are made goes on when it is started again, on two ranks, and
    again after its answer could not be written: all of its runs are in the table by then."""
    # Runs that follow from what the first ones have shown are among so many.
    budget = {"budget_of_runs": "90"}
    expect(program.run("study.prm", *settings(output_path="small", **budget)), 0)
    arguments = ["study.prm", *settings(output_path="killed", **budget)]
    results, table = program.folder / "killed", program.folder / "killed_runs.sqlite"
    results.mkdir()
    check_full_disk(program, results / "study.json", arguments)
    with subprocess.Popen(program.command(*arguments), cwd=program.folder,
                          stdout=subprocess.DEVNULL) as process:
        while process.poll() is None and n_rows(table) < 5:
            time.sleep(0.01)
        process.send_signal(signal.SIGTERM)
    assert process.returncode == STOPPED, process.returncode
    n_kept = n_rows(table)
    check_full_disk(program, results / "discovery.json", arguments, "Going on with the study")
    expect(program.run(*arguments, ranks=2), 0, "Going on with the study")
    simulations = json.loads((results / "discovery.json").read_text())["simulations"]
    assert simulations["made_now"] == 0 and simulations["from_table"] > n_kept, simulations
    assert answer(results) == answer(program.folder / "small")


def check_second_measurement(program: Program) -> None:
    """Other data of the same base model are answered from the table, with few runs."""
    data = (program.folder / "measured.csv").read_text()
    (program.folder / "again.csv").write_text(data.replace("# made by", "# again, made by"))
    expect(program.run("study.prm", *settings(measured_data="again.csv", output_path="again",
                                              table_of_runs="output_runs.sqlite",
                                              budget_of_runs="40")),
           0, "runs are in the table already")
    content = json.loads((program.folder / "again" / "discovery.json").read_text())
    assert content["runs"]["known"] > 100 and content["simulations"]["made_now"] <= 40
    assert content["verdict"] == "named" and content["candidates"][0]["effect"] == "tilt"


def check_larger_budget(program: Program) -> None:
    """A study whose budget is spent goes on with a larger one."""
    expect(program.run("study.prm", *settings(output_path="small", budget_of_runs="110")), 0, "Going on with the study")
    more = json.loads((program.folder / "small" / "discovery.json").read_text())
    # The same runs to fit; those that test the answer come later now, with other seeds.
    assert more["simulations"]["from_table"] > 20, more["simulations"]


def check_fill(program: Program) -> None:
    """A table is filled up to its size, however often the command is given, and answers a study."""
    table = program.folder / "filled.sqlite"
    filled = ("study.prm", "--fill-table", *settings(measured_data="none.csv", table_of_runs="filled.sqlite",
                                                     budget_of_runs="120"))
    expect(program.run(*filled, ranks=2), 0, "120 runs: least known is")
    rows = n_rows(table)
    expect(program.run(*filled), 0, "The table has 120 runs already")
    assert n_rows(table) == rows, "a table that is full has grown"
    expect(program.run("study.prm", "--fill-table", *settings(measured_data="none.csv", budget_of_runs="0")),
           FAILED, "Without a limit a table is never full")
    expect(program.run("study.prm", "--verdict-exit-code",
                       *settings(output_path="from_filled", table_of_runs="filled.sqlite", budget_of_runs="40")), NAMED)
    assert n_rows(table) <= rows + 41, "the study made many runs of its own"  # one looks at the data points


def check_fill_and_plan(program: Program) -> None:
    """A plan rests on what the same command has filled in before it."""
    def plan(*more: str) -> list[str]:
        result = program.run("study.prm", *more, "--plan",
                             *settings(measured_data="none.csv", table_of_runs="both.sqlite", budget_of_runs="80"))
        expect(result, 0, "bits  core-seconds of a run", "box, all", "short, all")
        return result[1][result[1].index("What a measurement"):].splitlines()
    assert plan("--fill-table") == plan(), "the second plan knows more than the first"


def main() -> None:
    folder = Path(sys.argv[2])
    prepare(folder)
    program = Program(sys.argv[1], folder.resolve())
    make_data(program)
    check_refusals(program)
    reference = folder / "output"
    expect(program.run("study.prm", "--verdict-exit-code"), NAMED)
    check_answer(reference)
    expect(program.run("study.prm", "--set", "discovery/seed = 2"), BAD_INPUT,
           "holds another study; what differs: study file")
    check_resume(program)
    check_second_measurement(program)
    check_larger_budget(program)
    check_fill(program)
    check_fill_and_plan(program)
    print("ok")


main()
