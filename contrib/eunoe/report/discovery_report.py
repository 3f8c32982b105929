"""The page of a study: its answer, where it comes from, and what it could not have seen."""

from __future__ import annotations

import json
from html import escape

import numpy as np

from .discovery_charts import (cosine_figure, envelope_figure, fingerprint_figure, gap_figure,
                               learning_figure, posterior_figure, ranking_figure)
from .discovery_results import Study
from .discovery_text import (detectability_rows, gap_text, held_out_text, plain, title_of,
                             verdict_text)
from .page import Page, preformatted, table
from .quantities import SPACE, duration, number


def _add_fingerprints(page: Page, study: Study) -> None:
    cells, prints = study.fingerprints()
    if not prints:
        return
    envelopes = {(c["experiment"], c["observable"], c["index"]): c
                 for c in study.content["envelopes"]}
    deviation = np.array([(envelopes[c]["measured"] - envelopes[c]["base"])
                          / max(envelopes[c]["base deviation"], 1e-300) for c in cells])
    page.heading("Fingerprints")
    page.figure(fingerprint_figure(cells, prints, deviation),
                "What each effect changes at the end of its range, and what was measured (first row). All in standard deviations of one run of the base model; each "
                "column is a cell.")
    if study.content.get("similarity", {}).get("effects"):
        page.figure(cosine_figure(study),
                    "How alike the effects are in this study: cosine between their changes, in units "
                    "of the noise of the comparison. Two effects near 1 or -1 cannot be told apart by "
                    "these data.")


def add_tie_breakers(page: Page, study: Study) -> None:
    rows = study.content.get("measurements that would break the tie", [])
    if not rows:
        return
    page.heading("What would break the tie")
    page.table(["Experiment", "Observable", "expected information (bit)", "standard deviations apart",
                "core-seconds of a run"],
               [[row["experiment"] + (" (again)" if row["again"] else ""), plain(row["observable"]),
                 f"{number(row['information'], 2)} of {number(row['of'], 2)}",
                 number(row["separation"], 2), number(study.costs[row["experiment"]], 2) if study.costs else "–"]
                for row in rows[:8]])


def _add_decisive(page: Page, study: Study) -> None:
    rows = study.content.get("decisive", [])
    if not rows:
        return
    page.paragraph("The cells that decided: by how much each speaks for the likeliest model against the "
                   "next one (logarithm of the ratio of likelihoods, cell by cell).")
    page.table(["Experiment", "Observable", "index", "measured", "likeliest", "next", "speaks for it by"],
               [[row["experiment"], plain(row["observable"]), str(row["index"]), number(row["measured"]),
                 number(row["first"]), number(row["second"]), number(row["log likelihood ratio"], 2)]
                for row in rows[:8]])


def _changes(study: Study) -> dict[str, list[str]]:
    """What the found effects change in the cases, and in which experiments' cases they change that."""
    changes: dict[str, list[str]] = {}
    for path in sorted(study.folder.glob("model_*.diff")):
        lines = path.read_text(encoding="utf-8").splitlines()
        text = "\n".join(line for line in lines if not line.startswith("#"))
        changes.setdefault(text, []).append(path.stem.removeprefix("model_"))
    return changes


def _add_origin(page: Page, study: Study) -> None:
    content = study.content
    made, origin = content["simulations"], content["provenance"]
    failed = [run for run in content["ledger"] if "failure" in run]
    page.heading("Simulations")
    page.paragraph(f"{len(content['ledger'])} simulations, {len(failed)} of which failed, cost "
                   f"{duration(3600. * made['core_hours'])} of one core. In this start of the program "
                   f"{made['made_now']} were made; the others came from the table of runs.")
    for note in content.get("notes", []):
        page.notice(note)
    if failed:
        page.fold("Runs that failed", table(
            ["Experiment", "Amplitudes", "Seed", "Why"],
            [[run["experiment"], json.dumps(run["amplitudes"]), str(run["seed"]), run["failure"]]
             for run in failed[:40]]))
    for text, experiments in _changes(study).items():
        page.fold(f"What is added to the model of {', '.join(experiments)}", preformatted(text))
    page.fold("Provenance", preformatted(json.dumps(origin, indent=1)))
    used = study.folder / "used.prm"
    if used.exists():
        page.fold("Study file as used", preformatted(used.read_text(encoding="utf-8")))


def discovery_report(study: Study) -> Page:
    experiments = sorted({c["experiment"] for c in study.content["envelopes"]})
    page = Page(title_of(study),
                f"{len(study.content['envelopes'])} measured cells of "
                f"{', '.join(map(escape, experiments))}; {len(study.content.get('effects', []))} "
                "effects looked for")
    for sentence in verdict_text(study):
        page.paragraph(sentence)
    page.paragraph(held_out_text(study))
    if study.verdict in ("named", "tie", "off catalogue"):
        page.heading("Which effect")
        page.figure(ranking_figure(study),
                    "How sure the study is of each effect. The last bar: that it is none of them.")
    if study.content["amplitudes"]:
        page.figure(posterior_figure(study), "What the data say of the amplitude: posterior probability, "
                                             f"median and 95{SPACE}% interval.")
    _add_decisive(page, study)
    add_tie_breakers(page, study)
    page.heading("Where model and measurement differ")
    page.figure(envelope_figure(study, False),
                "Measured values (points, with two standard errors) and the runs of the models (bands of "
                "two standard deviations of a single run). Flagged cells stand out at the study's level "
                "by themselves, all cells taken into account.")
    if study.content.get("nuisances"):
        page.paragraph("Uncertain numbers of the base model have the values with which the model of the answer, or the base "
                       "model without one, describes the data best:")
        page.table(["Nuisance", "amplitude", "standard deviations from its null value"],
                   [[row["nuisance"], f"{row['value']:.3g}", f"{row['prior deviations']:+.2f}"]
                    for row in study.content["nuisances"]])
    if "gap after" in study.content["gaps"].get("fit", {}):
        page.heading("How much is gained")
        page.figure(gap_figure(study),
                    "Distance between model and measurement, with the part that noise explains taken "
                    "off; below 0 noise explains more than there is.")
        if gap_text(study):
            page.paragraph(gap_text(study))
    if study.envelopes(True):
        page.figure(envelope_figure(study, True),
                    "Held-out experiments, which the study did not look at before the answer stood.")
    _add_fingerprints(page, study)
    page.heading("What could have been seen")
    page.paragraph("The smallest amplitude of each effect that this study would have detected with a "
                   f"probability of 80{SPACE}%, and the bounds within which the amplitude lies, were it "
                   "the only effect.")
    page.table(["Effect", "detectable from", "bound", "log Bayes factor"], detectability_rows(study))
    if study.content.get("learning curve"):
        page.heading("What more runs have changed")
        page.figure(learning_figure(study), "The answer by the number of runs that it rests on.")
    _add_origin(page, study)
    return page
