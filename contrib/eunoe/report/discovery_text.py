"""A study's answer in plain words."""

from __future__ import annotations

from .discovery_results import Study
from .quantities import SPACE, duration, number, percent

TITLES = {"none": "Nothing is missing", "named": "A missing effect is named",
          "tie": "Several effects explain the data alike",
          "off catalogue": "Something is missing that is not in the catalogue",
          "underpowered": "The data cannot tell"}
ONE_OR_NONE = "One effect, or something that the catalogue lacks"
ONE_OR_UNTRIED = "One effect, or something that was not tried"
MOST_UNTRIED = "Something is missing, and most effects were not tried"
NONE = "none of the catalogue"
DOUBTFUL, REFUTED = 0.05, 0.01  # as in the program's tuned.h
LOOKALIKES = 0.02  # from here on effects that look like another one are worth a word
BUT_HELD_OUT = "Nothing is missing in the data of the fit, but the held-out data differ"


def _amount(value: float, unit: str) -> str:
    return number(value) + ("" if unit == "1" else SPACE + unit)


def _probability(value: float) -> str:
    return number(value, 2) if value >= 0.001 else f"{value:.0e}"


def is_one_or_none(study: Study) -> bool:
    """Whether the only alternative to one answer is that it is none of the catalogue."""
    names = [row["effects"] for row in study.content["tie"]]
    return study.verdict == "tie" and len(names) == 2 and NONE in names


def _held_out_differs(study: Study) -> float | None:
    """The held-out data's p of the base model where nothing was found in the fit, but that model is refuted there."""
    p = study.content["gaps"].get("held-out", {}).get("p before")
    return p if study.verdict == "none" and p is not None and p < REFUTED else None


def title_of(study: Study) -> str:
    if _held_out_differs(study) is not None:
        return BUT_HELD_OUT
    if study.verdict == "underpowered" and study.content.get("detected"):
        return MOST_UNTRIED
    if is_one_or_none(study) and study.content.get("untried"):
        return ONE_OR_UNTRIED
    return ONE_OR_NONE if is_one_or_none(study) else TITLES.get(study.verdict, study.verdict)


def plain(name: str) -> str:
    return name.replace("_", " ")


def amplitude_text(row: dict) -> str:
    lower = _amount(row["lower"], row["unit"]) if row.get("lower reached", True) else "its range's end"
    upper = _amount(row["upper"], row["unit"]) if row.get("upper reached", True) else "its range's end"
    return f"{_amount(row['amplitude'], row['unit'])} (95{SPACE}% interval {lower} to {upper})"


def _where(study: Study) -> str:
    places: dict[tuple[str, str], list[int]] = {}
    for experiment, observable, index in sorted(study.flagged()):
        places.setdefault((experiment, observable), []).append(index)
    if not places:
        return "No single cell stands out; it is their pattern that does."
    parts = [f"{plain(observable)} of {experiment}"
             + (f" (index {', '.join(map(str, indices))})" if len(indices) > 1 or indices[0] else "")
             for (experiment, observable), indices in places.items()]
    return "The cells that stand out by themselves: " + "; ".join(parts) + "."


def _named(study: Study) -> list[str]:
    sentences = []
    for row in study.content["amplitudes"]:
        effect = study.effects[row["effect"]]
        sentences.append(f"What the model lacks is {plain(row['effect'])} ({effect['mechanism']}), "
                         f"with a confidence of {percent(row['confidence'], 0)}. "
                         f"{effect['parameter'].capitalize()}: {amplitude_text(row)}.")
    return sentences


def _effects(row: dict) -> set[str]:
    return set(row["effects"].split(" + "))


def _families(study: Study, row: dict) -> set[str]:
    return {study.effects.get(name, {}).get("family", "") for name in _effects(row)} - {""}


def _shares(study: Study) -> list[float]:
    """The probability of each member of a tie, with that of models that have another effect besides.

    Such a model is not of the answer if a likelier one does without that effect.
    """
    tie = study.content["tie"]
    shares = [0.] * len(tie)
    for model in study.content.get("models", tie):
        of = next((k for k, row in enumerate(tie) if _effects(row) <= _effects(model)), None)
        if of is not None:
            shares[of] += model["probability"]
    return shares


def _in_common(study: Study) -> list[str]:
    """What is likely although the effects cannot be told apart: a family that most of them belong to."""
    tie = study.content["tie"]
    models = study.content.get("models", tie)
    families = [family for row in tie for family in sorted(_families(study, row))]
    for family in dict.fromkeys(families):
        rows = [row for row in tie if family in _families(study, row)]
        share = sum(model["probability"] for model in models if family in _families(study, model))
        if len(rows) > 1 and share > 0.5 * sum(model["probability"] for model in models):
            which = ("All of them have" if len(rows) == len(tie) else
                     ", ".join(plain(row["effects"]) for row in rows) + " have")
            return [f"{which} one thing in common, {family}: an effect of this kind is missing with a "
                    f"probability of {percent(share, 0)}."]
    return []


def _tie(study: Study) -> list[str]:
    members = ", ".join(f"{plain(row['effects'])} ({percent(share, 0)})"
                        for row, share in zip(study.content["tie"], _shares(study)))
    sentences = [f"Something is missing, and the data cannot say which of these it is: {members}.",
                 *_in_common(study)]
    fit, held_out = study.content.get("p of the fit", 1.), study.content["gaps"].get("held-out", {}).get("p after", 1.)
    if min(fit, held_out) < DOUBTFUL:
        sentences.append(f"The likeliest describes the {'data' if fit <= held_out else 'held-out data'} badly "
                         f"(p = {_probability(min(fit, held_out))}), so it may be none of them.")
    breakers = study.content.get("measurements that would break the tie", [])
    if is_one_or_none(study):
        sentences += _one_or_none(study)
    elif breakers:
        best = breakers[0]
        what = {"all": "everything", "all else": "everything else"}.get(best["observable"], plain(best["observable"]))
        again = " once more" if best["again"] else ""
        sentences.append(f"What would tell most: {what} of experiment {best['experiment']}{again}; it is "
                         f"expected to give {number(best['information'], 2)} of the "
                         f"{number(best['of'], 2)} bits that are open, and sets the nearest two "
                         f"{number(best['separation'], 2)} standard deviations apart.")
        if best["experiment"] in study.costs:
            sentences.append(f"A run of {best['experiment']} takes about {duration(study.costs[best['experiment']])} of "
                             "one core.")
    return sentences


def _one_or_none(study: Study) -> list[str]:
    """What is known of the only effect of an answer, and why it may be another one."""
    row = next(row for row in study.content["tie"] if row["effects"] != NONE)
    sentences = [f"If it is {plain(amount['effect'])} ({study.effects[amount['effect']]['parameter']}): "
                 f"{amplitude_text(amount)}." for amount in study.content["amplitudes"]]
    lookalikes = study.content.get("calibration", {}).get("lookalikes") or {"taken for": {}}
    share = lookalikes["taken for"].get(row["effects"], 0.)
    if share > LOOKALIKES:
        sentences.append("An effect of its kind that the catalogue lacks would look like it: of the catalogue's own "
                         f"effects of this strength, left out of it in turn, {percent(share, 0)} are taken for this one.")
    if study.content.get("untried"):
        return sentences  # what is said of these effects says what would tell
    return [*sentences, "More repeats, and held-out conditions, would tell whether it is this effect."]


def _untried(study: Study) -> list[str]:
    """Which effects may be what is missing because nothing is known of them."""
    names = [plain(name) for name in study.content.get("untried", [])]
    return [f"There is no simulation with {', '.join(names)}, so what is missing may be that as well; the notes say "
            "why there is none."] if names else []


def _off_catalogue(study: Study) -> list[str]:
    remainder = study.content.get("remainder", {})
    alike = [f"{plain(row['effect'])} (cosine {number(row['cosine'], 2)})"
             for row in remainder.get("resembles", [])]
    tried = " that was simulated" if study.content.get("untried") else ""
    sentences = [f"Model and measurement differ, and no effect of the catalogue{tried}, nor several together, "
                 "explain how."]
    if alike:
        sentences.append("What is missing resembles " + ", ".join(alike) + ".")
    if study.content["gaps"].get("held-out", {}).get("result", "").endswith("withdrawn"):
        sentences.append("An effect had been named, but the held-out data refute it; the name is withdrawn.")
    return sentences


def verdict_text(study: Study) -> list[str]:
    """Sentences that say what was found."""
    p = study.content["p of nothing missing"]
    chance = ("If nothing were missing, data as far off as these would be found with probability "
              f"{_probability(p)}.")
    if study.verdict == "named":
        return [*_named(study), chance, _where(study)]
    if study.verdict == "tie":
        return [*_tie(study), *_untried(study), chance, _where(study)]
    if study.verdict == "off catalogue":
        return [*_off_catalogue(study), *_untried(study), chance, _where(study)]
    if study.content.get("detected"):
        return ["Model and measurement differ, and no effect that was simulated explains how; but most effects of the "
                "catalogue were not simulated.", *_untried(study), chance, _where(study)]
    rows = study.content.get("effects", [])
    seen = sum(1 for row in rows if row.get("detectable"))
    if study.verdict == "none":
        differs = _held_out_differs(study)
        agrees = ("The measured data agree with the base model within the scatter of both. " if differs is None else
                  "The data of the fit agree with the base model within the scatter of both, the held-out data do not "
                  f"(p = {_probability(differs)}): an effect may act that only they show. Give some of them to the fit. ")
        return [agrees + chance,
                f"Of {len(rows)} effects, {seen} would have been seen within their ranges; the table "
                "of what could have been seen gives the bounds."]
    return ["Nothing was found, but that says little: only "
            f"{seen} of {len(rows)} effects would have been seen within their ranges. More repeats, or "
            "more observables, would help.", chance]


def _members(table: dict) -> str:
    """What the held-out data say of each member of a tie."""
    rows = table.get("members of the tie", [])
    refuted = [plain(row["effects"]) for row in rows if row["result"].endswith("withdrawn")]
    if not rows:
        return ""
    if not refuted:
        # p exists only if the held-out experiments were run.
        each = ", ".join(f"{plain(row['effects'])} {_probability(row['p'])}" for row in rows
                         if row["p"] is not None)
        return f" The held-out data refute none of the candidates (p of {each})." if each else ""
    return (f" The data of the fit alone left {len(rows)} candidates; the held-out data speak against "
            f"{', '.join(refuted)}.")


def held_out_text(study: Study) -> str:
    table = study.content["gaps"].get("held-out", {})
    if table.get("result", "no held-out data") == "no held-out data":
        return ("No data were held out, so nothing tests the answer but the data that it was found "
                "with.")
    if table.get("gap after") is None:
        return f"Held-out data: {table['result']}.{_members(table)}"
    chosen = "" if study.verdict != "tie" else (
        f" with {plain(study.content['tie'][0]['effects'])}, the likeliest by a little, added")
    change = "shrinks" if table["gap after"] <= table["gap before"] else "grows"
    return (f"On data that were held out, the gap {change} from {number(table['gap before'], 2)} to "
            f"{number(table['gap after'], 2)} standard deviations of a run{chosen} (below 0 where noise "
            f"explains more than there is): {table['result']}.{_members(table)}{_refutable(table)}")


def _refutable(table: dict) -> str:
    """Which other models the held-out data would refute, if the answer is right."""
    rows = [row for row in table.get("could have refuted", []) if row["would be refuted"] is not None]
    if not rows:
        return ""
    each = ", ".join(f"{plain(row['effects'])} {percent(row['would be refuted'], 0)}" for row in rows)
    return f" If the answer is right, these data refute with a probability of: {each}."


def gap_text(study: Study) -> str:
    """Explains why a discrepancy is larger with an effect than without; empty if it is not."""
    table = study.content["gaps"].get("fit", {})
    if table.get("gap after", 0.) <= table["gap before"]:
        return ""
    return ("With the closest model the gap on the data of the fit is larger than before. That is no "
            "mistake: the fit weighs patterns by how they scatter together, so that a small deviation "
            "that runs hardly ever show counts more than a large one that they often show, while the "
            "gap counts every cell alike. It is one more sign that the catalogue lacks the effect.")


def detectability_rows(study: Study) -> list[list[str]]:
    """Effect, smallest amplitudes that would have been seen, and bounds of what can be there."""
    rows = []
    alone = {row["effect"]: row.get("log Bayes factor alone") for row in study.content["candidates"]}
    for row in study.content.get("effects", []):
        unit = study.effects[row["effect"]]["unit"]

        def ends(below: str, above: str) -> str:
            texts = [_amount(row[key], unit) if row[key] is not None else "not in its range"
                     for key in (below, above) if key in row]
            return " / ".join(texts) or "–"

        rows.append([plain(row["effect"]),
                     ends("detectable below", "detectable above") if row["simulated"] else "not simulated",
                     ends("lower bound", "upper bound"),
                     number(alone[row["effect"]], 2) if alone.get(row["effect"]) is not None else "–"])
    return rows
