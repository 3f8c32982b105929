#!/usr/bin/python3
"""Measures the speed of Eunoe, LAMMPS and LIGGGHTS on the same cases, in turn and repeatedly.

Usage: contrib/benchmarks/run.py [--program build/release/eunoe-particles] [--cases bed_20k,plough]
           [--ranks 1,2] [--repeats 5] [--steps N] [--peers lammps,liggghts|none]
           [--shares] [--memory] [--json FILE] [--markdown FILE]

doc/performance.md tells what is compared and how to read it. Of a peer that is not installed all
results say so; `contrib/install_dependencies.sh benchmarks` installs both. The speed is that of the time loop alone, in million particle-steps/s: median (least to most);
the ratio is Eunoe's median over that of the faster peer.

--shares  adds how much of its time Eunoe spends in each part of a step
--memory  adds Eunoe's peak memory for each particle; takes one more run a case
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from dataclasses import asdict
from pathlib import Path
from statistics import median

try:
    from eunoe_bench import bed, machine, table
    from eunoe_bench.cases import CASES, Case
    from eunoe_bench.programs import Eunoe, Failure, Lammps, Liggghts, Run
except ImportError as error:
    sys.exit(f"{error}. The benchmarks need Python 3 with numpy.")

ROOT = Path(__file__).resolve().parents[2]
PEERS = {"lammps": Lammps, "liggghts": Liggghts}


def chosen(text: str, known: list[str], what: str) -> list[str]:
    names = [name.strip() for name in text.split(",") if name.strip()]
    for name in names:
        if name not in known:
            raise Failure(f"There is no {what} '{name}'. Choose from: {', '.join(known)}.")
    return names


def numbers(text: str) -> list[int]:
    try:
        values = [int(word) for word in text.split(",")]
    except ValueError:
        values = [0]
    if min(values) < 1:
        raise Failure(f"--ranks {text}: give whole numbers above 0, as in 1,2.")
    return values


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=str(ROOT / "build/release/eunoe-particles"))
    parser.add_argument("--cases", default=",".join(CASES))
    parser.add_argument("--ranks", default="1,2")
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--steps", type=int, default=0, help="of all cases; 0: each its own number")
    parser.add_argument("--peers", default="lammps,liggghts")
    parser.add_argument("--shares", action="store_true")
    parser.add_argument("--memory", action="store_true")
    parser.add_argument("--json", type=Path)
    parser.add_argument("--markdown", type=Path)
    return parser.parse_args()


def find_peers(names: list[str]) -> tuple[list, list]:
    """Peers that are installed, and those that are missing."""
    peers = [PEERS[name]() for name in names]
    return [peer for peer in peers if peer.path], [peer for peer in peers if not peer.path]


def complaint(missing: list) -> str:
    """What all results say of peers that were asked for and are not there; empty if all are."""
    if not missing:
        return ""
    which = " and ".join(f"{peer.name} (no program '{peer.executable}')" for peer in missing)
    return (f"WARNING: NOT COMPARED with {which}, which {'is' if len(missing) == 1 else 'are'} not "
            "installed. Run 'contrib/install_dependencies.sh benchmarks', or leave out with --peers.")


def measure(case: Case, ranks: int, steps: int, repeats: int,
            programs: list) -> dict[str, list[Run]]:
    """All programs in turn, the whole round `repeats` times, so that slow minutes of the machine
    fall on all of them."""
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
    """Peak memory of all ranks together, also less that of a run of the same mesh with a hundred
    particles."""
    total = median(run.memory for run in runs)
    n = runs[0].summary["particles"]
    row = [case.title, str(ranks), f"{total / 2**20:.0f} MiB", f"{total / n:.0f} B"]
    if not case.peers:
        return [*row, "-", "-"]
    with tempfile.TemporaryDirectory(prefix="eunoe_benchmark_") as folder:
        empty = eunoe.run(case, ranks, 1, Path(folder), particles=bed.read()[:100]).memory
    return [*row, f"{empty / 2**20:.0f} MiB", f"{(total - empty) / n:.0f} B"]


def main() -> int:
    options = arguments()
    eunoe = Eunoe(options.program)
    cases = [CASES[name] for name in chosen(options.cases, list(CASES), "case")]
    all_ranks = numbers(options.ranks)
    if options.repeats < 1:
        raise Failure("--repeats must be at least 1.")
    names = [] if options.peers == "none" else chosen(options.peers, list(PEERS), "peer")
    peers, missing = find_peers(names)
    programs = [eunoe, *peers]
    facts = machine.facts(programs, eunoe.path)
    facts.update({peer.name: "MISSING" for peer in missing})
    warning = complaint(missing)
    if warning:
        print(warning, file=sys.stderr, flush=True)
    print("\n".join(f"{name}: {value}" for name, value in facts.items()), "\n", sep="")

    rows, share_rows, memory_rows = [], [], []
    for case in cases:
        for ranks in all_ranks:
            runs = measure(case, ranks, options.steps or case.steps, options.repeats,
                           programs if case.peers else [eunoe])
            rows.append(table.Row(case.title, ranks,
                                  {name: [run.speed for run in list_] for name, list_ in
                                   runs.items()}))
            ours = runs[eunoe.name]
            share_rows.append((case.title, ranks, [run.summary for run in ours]))
            if options.memory:
                memory_rows.append(memory_row(case, ranks, ours, eunoe))

    tables = {"Million particle-steps/s, median (least to most)":
              table.cells(rows, [program.name for program in programs],
                          [peer.name for peer in missing])}
    if options.shares:
        tables["Shares of Eunoe's time loop"] = table.share_cells(share_rows)
    if options.memory:
        tables["Eunoe's peak memory"] = [["case", "ranks", "all ranks together", "a particle",
                                          "the mesh with 100 particles", "a particle beyond that"],
                                         *memory_rows]
    print()
    for title, content in tables.items():
        print(f"{title}\n{table.as_text(content)}\n")
    if warning:
        print(warning, file=sys.stderr)
    if options.json:
        options.json.write_text(json.dumps(
            {"machine": facts, "missing_peers": [peer.name for peer in missing], "speeds": [{**asdict(row), "ratio": row.ratio()} for row in rows],
             "summaries": [{"case": c, "ranks": r, "runs": s} for c, r, s in share_rows],
             "tables": tables}, indent=2) + "\n", encoding="utf-8")
    if options.markdown:
        text = [f"**{warning}**", ""] if warning else []
        text += [f"- {name}: {value}" for name, value in facts.items()]
        for title, content in tables.items():
            text += ["", f"{title}:", "", table.as_markdown(content)]
        options.markdown.write_text("\n".join(text) + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except Failure as failure:
        sys.exit(str(failure))
