"""Measures the speed of Eunoe, LAMMPS and LIGGGHTS on the same cases, in turn and repeatedly.

Usage: contrib/tools benchmark [--program build/release/eunoe-particles] [--cases bed_20k,plough]
           [--ranks 1,2] [--repeats 5] [--steps N] [--peers lammps,liggghts|none]
           [--shares] [--memory] [--json FILE] [--markdown FILE]

doc/performance.md says what is compared and how to read it. If a peer is not installed, all results
say so; `contrib/install_dependencies.sh benchmarks` installs both. The speed is that of the time
loop alone, in million particle-steps/s: median (least to most); the ratio is Eunoe's median over
that of the faster peer.

--shares  adds how much of its time Eunoe spends in each part of a step
--memory  adds Eunoe's peak memory for each particle; needs one more run for each case
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from dataclasses import asdict, dataclass, field
from pathlib import Path
from statistics import median

from eunoe.launch import Failure, parser, rank_numbers
from eunoe.tables import Table, as_markdown, as_text

from . import machine, table
from .cases import Case
from .programs import CASES, Eunoe, Lammps, Liggghts, Run, add_program

PEERS = {"lammps": Lammps, "liggghts": Liggghts}


def chosen(text: str, known: list[str], what: str) -> list[str]:
    names = [name.strip() for name in text.split(",") if name.strip()]
    for name in names:
        if name not in known:
            raise Failure(f"There is no {what} '{name}'. Choose from: {', '.join(known)}.")
    return names


def parse(words: list[str]) -> argparse.Namespace:
    arguments = parser(__doc__)
    add_program(arguments)
    arguments.add_argument("--cases", default=",".join(CASES))
    arguments.add_argument("--ranks", default="1,2")
    arguments.add_argument("--repeats", type=int, default=5)
    arguments.add_argument("--steps", type=int, default=0, help="of all cases; 0: each its own number")
    arguments.add_argument("--peers", default="lammps,liggghts")
    arguments.add_argument("--shares", action="store_true")
    arguments.add_argument("--memory", action="store_true")
    arguments.add_argument("--json", type=Path)
    arguments.add_argument("--markdown", type=Path)
    options = arguments.parse_args(words)
    if options.repeats < 1:
        raise Failure("--repeats must be at least 1.")
    return options


def find_peers(names: list[str]) -> tuple[list, list]:
    """The peers that are installed, and the missing ones."""
    peers = [PEERS[name]() for name in names]
    return [peer for peer in peers if peer.path], [peer for peer in peers if not peer.path]


def complaint(missing: list) -> str:
    """A sentence for the results on requested peers that are missing; empty if none is missing."""
    if not missing:
        return ""
    which = " and ".join(f"{peer.name} (no program '{peer.executable}')" for peer in missing)
    return (f"WARNING: NOT COMPARED with {which}, which {'is' if len(missing) == 1 else 'are'} not "
            "installed. Run 'contrib/install_dependencies.sh benchmarks', or leave out with --peers.")


def measure(case: Case, ranks: int, steps: int, repeats: int,
            programs: list) -> dict[str, list[Run]]:
    """Runs all programs in turn, the whole round `repeats` times, so that slow minutes of the
    machine affect all of them."""
    runs: dict[str, list[Run]] = {program.name: [] for program in programs}
    for repeat in range(repeats):
        for program in programs:
            with tempfile.TemporaryDirectory(prefix="eunoe_benchmark_") as folder:
                run = program.run(case, ranks, steps, Path(folder))
            runs[program.name].append(run)
            print(f"  {case.name}, {ranks} rank(s), round {repeat + 1}: {program.name} "
                  f"{1e-6 * run.speed:.2f}", flush=True)
    return runs


def memory_row(case: Case, ranks: int, runs: list[Run], eunoe: Eunoe) -> list[str]:
    """Peak memory of all ranks together, and its excess over a run of the same mesh with a hundred
    particles."""
    total = median(run.memory for run in runs)
    n = runs[0].summary["particles"]
    row = [case.title, str(ranks), f"{total / 2**20:.0f} MiB", f"{total / n:.0f} B"]
    if not case.peers:
        return [*row, "-", "-"]
    with tempfile.TemporaryDirectory(prefix="eunoe_benchmark_") as folder:
        empty = eunoe.run(case, ranks, 1, Path(folder), particles=case.particles()[:100]).memory
    return [*row, f"{empty / 2**20:.0f} MiB", f"{(total - empty) / n:.0f} B"]


@dataclass
class Measurements:
    """The measurements behind all results: a row for each case and number of ranks."""

    facts: dict[str, str]
    programs: list
    missing: list
    speeds: list[table.Row] = field(default_factory=list)
    shares: list[tuple[str, int, list[dict]]] = field(default_factory=list)
    memory: Table = field(default_factory=list)

    def tables(self, with_shares: bool) -> dict[str, Table]:
        """The tables by their titles."""
        found = {"Million particle-steps/s, median (least to most)":
                 table.cells(self.speeds, [program.name for program in self.programs],
                             [peer.name for peer in self.missing])}
        if with_shares:
            found["Shares of Eunoe's time loop"] = table.share_cells(self.shares)
        if self.memory:
            found["Eunoe's peak memory"] = [["case", "ranks", "all ranks together", "a particle",
                                             "the mesh with 100 particles", "a particle beyond that"],
                                            *self.memory]
        return found

    def as_json(self, tables: dict[str, Table]) -> str:
        return json.dumps(
            {"machine": self.facts, "missing_peers": [peer.name for peer in self.missing],
             "speeds": [{**asdict(row), "ratio": row.ratio()} for row in self.speeds],
             "summaries": [{"case": c, "ranks": r, "runs": s} for c, r, s in self.shares],
             "tables": tables}, indent=2) + "\n"

    def as_page(self, tables: dict[str, Table], warning: str) -> str:
        text = [f"**{warning}**", ""] if warning else []
        text += [f"- {name}: {value}" for name, value in self.facts.items()]
        for title, content in tables.items():
            text += ["", f"{title}:", "", as_markdown(content)]
        return "\n".join(text) + "\n"


def measure_all(options: argparse.Namespace, eunoe: Eunoe, found: Measurements) -> None:
    ranks_of_runs = rank_numbers(options.ranks)
    for case in (CASES[name] for name in chosen(options.cases, list(CASES), "case")):
        for ranks in ranks_of_runs:
            runs = measure(case, ranks, options.steps or case.steps, options.repeats,
                           found.programs if case.peers else [eunoe])
            found.speeds.append(table.Row(case.title, ranks, {name: [run.speed for run in list_]
                                                              for name, list_ in runs.items()}))
            ours = runs[eunoe.name]
            found.shares.append((case.title, ranks, [run.summary for run in ours]))
            if options.memory:
                found.memory.append(memory_row(case, ranks, ours, eunoe))


def main(words: list[str]) -> int:
    options = parse(words)
    eunoe = Eunoe(options.program)
    names = [] if options.peers == "none" else chosen(options.peers, list(PEERS), "peer")
    peers, missing = find_peers(names)
    programs = [eunoe, *peers]
    facts = {**machine.facts(programs, eunoe.path), **{peer.name: "MISSING" for peer in missing}}
    warning = complaint(missing)
    if warning:
        print(warning, file=sys.stderr, flush=True)
    print("\n".join(f"{name}: {value}" for name, value in facts.items()), "\n", sep="")
    found = Measurements(facts, programs, missing)
    measure_all(options, eunoe, found)
    tables = found.tables(options.shares)
    print()
    for title, content in tables.items():
        print(f"{title}\n{as_text(content)}\n")
    if warning:
        print(warning, file=sys.stderr)
    if options.json:
        options.json.write_text(found.as_json(tables), encoding="utf-8")
    if options.markdown:
        options.markdown.write_text(found.as_page(tables, warning), encoding="utf-8")
    return 0
