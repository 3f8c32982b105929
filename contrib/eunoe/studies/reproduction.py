"""The campaign that reproduces Gaboriault et al. (2025): goes on with its runs, keeps their small results
in the repository, and rebuilds doc/reproduction.md and its pictures.

Usage: contrib/tools reproduction path/to/eunoe-particles folder [--only CASE ...] [--jobs 1] [--ranks 1]
       contrib/tools reproduction path/to/eunoe-particles folder --plan [--speed MILLIONS]
       contrib/tools reproduction path/to/eunoe-particles folder --only CASE --command
       contrib/tools reproduction path/to/eunoe-particles folder --collect
       contrib/tools reproduction --list | --page-only

The states of the runs lie in the folder, which should stand outside the repository. A run whose results
are kept is not made again; one that was stopped or killed continues from its checkpoint. SIGTERM, SIGINT and SIGUSR1
ask all runs to leave a checkpoint and end; the exit code is then 3. Several of these commands may work in one folder: a case that
another one runs is left out. --only takes names of cases, or of groups of seeds. --command
prints the command that a batch job on this machine starts with its own launcher. --collect runs nothing: it
takes over what there is, of runs that go on, too, and rebuilds page and pictures; --page-only does so from the small results alone.
"""

from __future__ import annotations

import argparse
import os
import shlex
import sys
from pathlib import Path

from eunoe.folders import alone_with
from eunoe.launch import Failure, parser
from eunoe.reproduction.cases import CASES, Case, chosen
from eunoe.reproduction.kept import is_kept
from eunoe.reproduction.places import DATA, PAGE
from eunoe.reproduction.plan import measured_speed, plan_of
from eunoe.reproduction.runs import STOPPED, Campaign
from eunoe.repository import DOC
from eunoe.studies.series import at_least
from eunoe.tables import as_text


# What draws and reads pictures is imported where it is used: a batch job, which only asks for its command, may
# be on a node without these packages.


def parse(words: list[str]) -> argparse.Namespace:
    arguments = parser(__doc__)
    arguments.add_argument("program", nargs="?")
    arguments.add_argument("folder", type=Path, nargs="?")
    arguments.add_argument("--only", nargs="+", default=[], metavar="CASE")
    arguments.add_argument("--jobs", type=at_least(1), default=1, help="runs at the same time")
    arguments.add_argument("--ranks", type=int, default=1, help="of each run")
    arguments.add_argument("--speed", type=float, help="million particle-steps per second and core, for --plan")
    for name, default in (("data", DATA), ("page", PAGE), ("pictures", DOC / "pictures")):
        arguments.add_argument(f"--{name}", type=Path, default=default, help="default: %(default)s")
    what = arguments.add_mutually_exclusive_group()
    for name, text in (("list", "names the cases"),
                       ("plan", "says what is missing and what it costs; runs nothing"),
                       ("command", "prints the command of a run, for a batch job"),
                       ("collect", "runs nothing"), ("page-only", "reads the small results alone")):
        what.add_argument(f"--{name}", action="store_true", help=text)
    options = arguments.parse_args(words)
    if not (options.list or options.page_only) and options.folder is None:
        raise Failure("Name the program and the folder of the runs: contrib/tools reproduction PROGRAM FOLDER.")
    return options


def show_plan(campaign: Campaign, cases: list[Case], data: Path, speed: float | None) -> None:
    table, sentence = plan_of(campaign, cases, data, 1e6 * speed if speed else measured_speed(campaign, list(CASES)))
    print(as_text(table), sentence, sep="\n")


def rebuild(options: argparse.Namespace, campaign: Campaign | None) -> None:
    """Page and pictures from the small results, and from the states if they are there."""
    from eunoe.reproduction.page import renew
    from eunoe.reproduction.pictures import draw, draw_movies
    from eunoe.reproduction.results import Findings
    findings = Findings(options.data)
    draw(findings, campaign, options.pictures)
    renew(options.page, findings, options.pictures)
    print(f"{len(findings.all)} finished runs are in {options.page}")
    for movie in draw_movies(campaign, findings) if campaign else ():
        print(f"A movie is in {movie}")


def go_on(options: argparse.Namespace, campaign: Campaign, cases: list[Case]) -> bool:
    """Runs, takes over the results of each run when it has finished, and rebuilds; false if one of that failed."""
    from eunoe.reproduction.collect import collect

    untaken = set()

    def take(case: Case) -> None:
        try:
            with alone_with(lock, wait=True):
                collect(campaign, case, options.data)
            untaken.discard(case.name)
        except Failure as failure:  # the other runs go on
            untaken.add(case.name)
            print(failure, file=sys.stderr, flush=True)

    lock = campaign.folder / "results.lock"  # of commands that work in one folder

    for case in cases:
        campaign.check(case)
    for case in cases:
        take(case)
    good = True
    if not options.collect:
        missing = [case for case in cases if not is_kept(case, options.data)]
        if len(missing) < len(cases):
            print(f"Finished before: {len(cases) - len(missing)} runs, whose results {options.data} keeps. With an "
                  "empty folder as --data they are made again.", flush=True)
        good = campaign.work(missing, options.jobs, take)
        for case in missing:  # a run that was stopped, or has died
            if not campaign.is_finished(case):
                take(case)
    with alone_with(lock, wait=True):
        rebuild(options, campaign)
    return good and not untaken


def main(words: list[str]) -> int:
    options = parse(words)
    cases = chosen(options.only)
    if options.list:
        print("\n".join(case.name for case in cases))
        return 0
    if options.page_only:
        rebuild(options, None)
        return 0
    campaign = Campaign(str(Path(options.program).resolve()), options.folder.resolve(), options.ranks, options.jobs)
    os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    if options.plan:
        show_plan(campaign, cases, options.data, options.speed)
        return 0
    if options.command:
        for case in cases:
            campaign.note(case)
            print(shlex.join([*campaign.command(case), *campaign.filmed(case)]))
        return 0
    good = go_on(options, campaign, cases)
    return STOPPED if campaign.stopping.is_set() else 0 if good else 1
