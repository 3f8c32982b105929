"""Renews the generated parts of doc/reproduction.md, and of the page beside it on plates with other ends, which stand
between markers."""

from __future__ import annotations

import re
import statistics
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from eunoe.folders import write_whole
from eunoe.intervals import mean_of
from eunoe.launch import Failure
from eunoe.report.common_scatter import CommonScatter, Number
from eunoe.report.comparison_text import (ALONE, DENSITIES, change_sentence, densities_table, differences_table, measured_group,
                                          meeting_table, rest_table, rise_sentence, span, supply_table, text_of)
from eunoe.report.measured import read_measured
from eunoe.report.spread_run import LATER, PLATEAU, YOUNG, Group, SpreadRun
from eunoe.tables import Table, as_markdown

from .cases import N_LAYERS, SETS
from .pictures import picture_name
from .results import HELD, OPEN, Findings, Result, length_name, origin_of, plain_label
from .verdict import by_chance, measured_table, simulated_table

EARLY = (YOUNG, (5, 7), (8, 10))  # spans in which a bed is pressed together
NOTHING = "No run of these has finished yet."


def _block(table: Table, results: list[Result], *sentences: str) -> str:
    if len(table) < 2:
        return NOTHING
    return "\n\n".join([as_markdown(table), origin_of(results), *filter(None, sentences)])


def _results(groups: list[Group]) -> list[Result]:
    return [run for group in groups for run in group.runs]


def _costs(results: list[Result]) -> list[str]:
    """What a run took, of those that went through at one go: a summary begins anew with a restart."""
    whole = [result.record for result in results if result.record.get("first_step", 0) == 0]
    if not whole:
        return ["restarted"] * 3
    hours = sum(record["loop_seconds"] * record["ranks"] for record in whole) / 3600.
    return [f"{1e-9 * sum(record['particle_steps'] for record in whole) / len(whole):.0f}",
            f"{100. * sum(record['share_asleep'] for record in whole) / len(whole):.0f}", f"{hours / len(whole):.2f}"]


def runs_block(findings: Findings) -> str:
    """What has been run, of what is planned."""
    table = [["case", "runs finished, of", "plate (mm)", "particles on it in the end", "steps (million)",
              "particle-steps (1e9)", "of them asleep (%)", "core-hours of a run"]]
    planned: dict[str, int] = {}
    for case in findings.cases:
        planned[case.group] = planned.get(case.group, 0) + 1
    for name, number in planned.items():
        results = findings.results.get(name, [])
        cells = [f"`{name}`", f"{len(results)}, {number}"]
        if results:
            cells += [f"{1e3 * results[0].apparatus.plate_length:.3g}",
                      f"{sum(result.layers.particles[-1] for result in results) / len(results):.0f}",
                      f"{1e-6 * sum(result.record['steps'] for result in results) / len(results):.2f}",
                      *_costs(results)]
        table.append([*cells, *[""] * (len(table[0]) - len(cells))])
    if not findings:
        return NOTHING
    return _block(table, findings.all)


def under_way_block(findings: Findings) -> str:
    """The runs that have not finished, as far as they have come, and finished ones of the same powder in the same
    layers."""
    after = f"layers {LATER[0]} to the last"
    table = [["run", "layers weighed", span(PLATEAU), f"LRD of {after} (%)",
              *(f"bed below, layers {first} to {last} (%)" for first, last in EARLY), "rise of LRD (%)",
              f"gained five layers and more below, layers {PLATEAU[0]} to {PLATEAU[1]} (% of a layer a pass)", f"the same, {after}"]]
    passes = [["run", "pass", "displacement of what lay there (um)", "zones at rest cover (%)",
               "removed (% of the mass before)"]]
    measured, scatter = measured_group(read_measured()), CommonScatter(findings.alike())
    for run in findings.under_way:
        later = (LATER[0], run.layers.last)
        groups = [(f"`{run.name}`", f"{len(run.layers)} of {N_LAYERS}", Group(run.name, [run])),
                  *((group.label, f"{len(group.runs)} runs", group) for group in findings.lengths(run.case.properties)),
                  (measured.label, f"{len(measured.runs)} repeats", measured)]
        early: list[Number] = [partial(SpreadRun.mean_lrd, span=PLATEAU), partial(SpreadRun.compaction, span=PLATEAU),
                               *(partial(SpreadRun.lrd_below, span=layers) for layers in EARLY)]
        late: list[Number] = [partial(SpreadRun.mean_lrd, span=later), lambda one, later=later: one.mean_lrd(later) - one.mean_lrd(PLATEAU),
                              partial(SpreadRun.compaction, span=later)]
        for name, extent, group in groups:
            lrd, gained, *bed = (text_of(scatter.mean(group, number), 100.) for number in early)
            lrd_later, rise, gained_later = (text_of(scatter.mean(group, number), 100.) if later[1] >= later[0] else ""
                                             for number in late)
            table.append([name, extent, lrd, lrd_later, *bed, rise, gained, gained_later])
            passes += [[name, str(layer), *_pass(group.runs, layer)] for layer in sorted({1, 5, 10, run.layers.last})
                       if layer <= run.layers.last and all(one.maps for one in group.runs)]
    if not findings.under_way:
        return "None."
    shown = [*findings.under_way, *(one for run in findings.under_way
                                    for group in findings.lengths(run.case.properties) for one in group.runs)]
    return "\n\n".join(_block(rows, shown) for rows in (table, passes) if len(rows) > 1)


def _pass(runs: Sequence[Result], layer: int) -> list[str]:
    """How far the pass of a layer moved the bed, how much of it rested, and what was taken off; means."""
    moved = [1e6 * float(one.maps.moved_of_layers()[one.maps.layers == layer].mean()) for one in runs]
    covered = [100. * float(one.zones.covered[one.zones.layers == layer].mean()) for one in runs]
    removed = [100. * float(one.scraped[one.layers.layer == layer].mean()) for one in runs]
    return [f"{mean_of(moved).value:.0f}", text_of(mean_of(covered)), text_of(mean_of(removed))]


def densities_block(findings: Findings) -> str:
    groups = findings.plain()
    if not groups:
        return NOTHING
    everyone = [*groups, measured_group(read_measured())]
    scatter = CommonScatter(findings.alike())
    sentences = [*(rise_sentence(group, scatter) for group in groups), *_together(groups)]
    return _block(densities_table(everyone, scatter), _results(groups), " ".join(sentences))


def scatter_block(findings: Findings) -> str:
    """How much densities scatter between the seeds of each group, and of all as if they did so alike."""
    groups = [group for group in findings.alike() if len(group.runs) > 1]
    numbers = {name: number for name, (number, size) in DENSITIES.items() if size == 100.}
    table: Table = [["standard deviation between seeds", "degrees of freedom", *numbers]]
    rows = [(group.label, [group]) for group in groups] + [("**all groups alike**", groups)]
    for label, members in rows if groups else []:
        common = CommonScatter(members)
        found = [common.of(number) for number in numbers.values()]
        table.append([label, str(sum(len(group.runs) - 1 for group in members)),
                      *(f"{100. * scatter.deviation:.2f}" if scatter else "" for scatter in found)])
    return _block(table, _results(groups))


def levels_block(findings: Findings) -> str:
    """What layers add below the level of the transfer plate, and to the room between that and the spreader."""
    alike = findings.alike()
    groups, scatter = [group for group in alike if len(group.mapped) == len(group.runs)], CommonScatter(alike)
    first, last = PLATEAU[0] - 1, LATER[1]
    numbers: dict[str, Number] = {
        **{f"above the level after layer {layer} (% of a layer)": partial(SpreadRun.above_level, layer=layer)
           for layer in (first, PLATEAU[1], last)},
        **{f"bed below, layers {layers[0]} to {layers[1]} (%)": partial(SpreadRun.lrd_below, span=layers)
           for layers in (*EARLY, LATER)},
        "rise of the bed, first to last (%)": lambda run: run.lrd_below(LATER) - run.lrd_below(YOUNG),
        **{f"CRD after layer {layer} (%)": partial(SpreadRun.crd, layer=layer) for layer in (PLATEAU[1], last)}}
    table: Table = [["", *numbers]]
    for group in [*groups, measured_group(read_measured())] if groups else []:
        table.append([group.label, *(text_of(scatter.mean(group, number), 100.) for number in numbers.values())])
    return _block(table, _results(groups))


def passes_block(findings: Findings) -> str:
    """What each pass did, on the longest plate of the first property set; means over its runs."""
    groups = findings.lengths(SETS[0])
    runs = groups[-1].runs if groups else []
    if not runs or not all(run.maps for run in runs):
        return NOTHING
    table: Table = [["layer", "LRD (%)", "gained five layers and more below (% of a layer)", "displacement of what lay there (um)",
                     "zones at rest cover (%)", "removed (% of the mass before)"]]
    for layer in range(1, N_LAYERS):
        lrd = [100. * float(run.layers.lrd[run.layers.layer == layer].mean()) for run in runs]
        gained = [100. * run.compaction((layer, layer)) for run in runs]
        table.append([str(layer), text_of(mean_of(lrd)), text_of(mean_of(gained)), *_pass(runs, layer)])
    return "\n\n".join([f"{groups[-1].label}:", _block(table, list(runs))])


def _together(groups: list[Group]) -> list[str]:
    """Sentences on the rise of all property sets on plates of one length. Runs of one seed are of the same grains in
    the same places, so they are not independent: what counts is the mean of each seed."""
    lengths: dict[float, list[Group]] = {}
    for group in groups:
        lengths.setdefault(group.runs[0].case.length, []).append(group)
    sentences = []
    for length, same in lengths.items():
        by_seed = [{run.case.seed: run.rise for run in group.runs} for group in same]
        seeds = sorted(set.intersection(*map(set, by_seed)))
        if len(same) > 1 and len(seeds) > 1:
            names = " and ".join(group.runs[0].case.properties for group in same)
            rises = [statistics.mean(rise[seed] for rise in by_seed) for seed in seeds]
            sentences.append(change_sentence(f"{names}, {length_name(length)}, their mean for each of {len(seeds)} seeds",
                                             mean_of(rises)))
    return sentences


def _differences(pairs: list[list[Group]], scatter: CommonScatter = ALONE) -> str:
    """One table for each list of groups, compared with its first."""
    blocks = [_block(differences_table(groups, scatter), _results(groups)) for groups in pairs if len(groups) > 1]
    return "\n\n".join(blocks) or NOTHING


def lengths_block(findings: Findings) -> str:
    return _differences([findings.lengths(properties) for properties in SETS], CommonScatter(findings.alike()))


def sets_block(findings: Findings) -> str:
    lengths = sorted({result.case.length for result in findings.all})
    return _differences([[group for properties in SETS if (group := findings.of(properties, length))]
                         for length in lengths], CommonScatter(findings.alike()))


def rest_block(findings: Findings) -> str:
    groups = findings.plain()
    tables = [table for table in (rest_table(groups), meeting_table(groups)) if len(table) > 1]
    return "\n\n".join(_block(table, _results(groups)) for table in tables) or NOTHING


def _all_about(groups: list[Group]) -> str:
    if not groups:
        return NOTHING
    parts = [_block(densities_table(groups), _results(groups), " ".join(map(rise_sentence, groups))),
             _block(rest_table(groups), _results(groups))]
    if len(groups) > 1:
        parts.append(_block(differences_table(groups), _results(groups)))
    return "\n\n".join(parts)


def held_block(findings: Findings) -> str:
    return _all_about(findings.of_variants(HELD))


def open_block(findings: Findings) -> str:
    return _all_about(findings.of_variants(OPEN))


def supply_block(findings: Findings) -> str:
    """Of plates with rims, of those whose ends nothing holds, and of those with lips."""
    groups = [*findings.plain(),
              *(Group(", ".join([plain_label(case), case.full_title]), group.runs)
                for group in findings.of_variants({*OPEN, *HELD}) for case in [group.runs[0].case])]
    return _block(supply_table(groups), _results(groups))


def variants_block(findings: Findings) -> str:
    return _differences([[base, *variants] for base, variants in findings.variants()], CommonScatter(findings.alike()))


def needed_block(findings: Findings) -> str:
    """How far the mean LRD of a shorter plate is from that of the longest one that has been run."""
    table = [["plate", "of the longest one's length", "LRD of layers 5 to 20, less the longest one's (%)"]]
    used: list[Group] = []
    for properties in SETS:
        groups = findings.lengths(properties)
        if len(groups) < 2:
            continue
        used += groups
        longest = groups[-1].runs[0].case.length
        rows = differences_table([groups[-1], *groups[:-1]], CommonScatter(findings.alike()))[1:]
        table += [[group.label, f"{group.runs[0].case.length / longest:.2g}", row[2].replace("**", "")]
                  for group, row in zip(groups[:-1], rows)]
    return _block(table, _results(used))


def verdict_block(findings: Findings) -> str:
    if not findings.plain():
        return NOTHING
    (measured, differences), (simulated, others) = measured_table(findings), simulated_table(findings)
    return "\n\n".join(["Beside the measurement, of a plate of 7 L1:", _block(measured, findings.all),
                        "Beside the paper's simulations:", _block(simulated, findings.all, by_chance([*differences, *others]))])


# The pictures that stand below a block, as far as they have been drawn, and what they show.
PICTURES = {
    "densities": {"density": "LRD and CRD of all lengths and property sets, beside the measured ones",
                  "middle": "LRD of the middle half of the plate"},
    "levels": {"levels": "Solid above the level of the transfer plate, and density of the bed below it"},
    "rest": {"mechanism": "Displacement, rest, removal and zones by layer",
             "maps_PS1": "Displacement and density by place and layer, PS1 on its longest plate",
             "maps_PS3": "Displacement and density by place and layer, PS3 on its longest plate",
             "profiles": "Profiles of the solid along the plate and over the height",
             "layers": "The bed at four weighings", "pass": "A pass in four pictures"},
    "held": {"held": "LRD and CRD where lips hold the ends, beside the measured ones",
             "held_mechanism": "Displacement, rest, removal and zones by layer, ends held",
             "held_maps_PS1": "Displacement and density by place and layer, PS1, ends held",
             "held_maps_PS3": "Displacement and density by place and layer, PS3, ends held",
             "held_layers": "The bed at four weighings, ends held", "held_pass": "A pass in four pictures, ends held"},
    "open": {"open": "LRD and CRD where nothing holds the ends, beside the measured ones",
             "open_middle": "LRD of the middle half of the plate, open ends",
             "open_mechanism": "Displacement, rest, removal and zones by layer, open ends",
             "open_maps_PS1": "Displacement and density by place and layer, PS1 on its longest plate, open ends",
             "open_maps_PS3": "Displacement and density by place and layer, PS3 on its longest plate, open ends",
             "open_layers": "The bed at four weighings, open ends", "open_pass": "A pass in four pictures, open ends"},
    "variants": {f"variants_{number}": f"LRD and CRD of the variants, part {number}" for number in range(1, 7)},
}
BLOCKS = {"verdict": verdict_block, "runs": runs_block, "under way": under_way_block, "scatter": scatter_block,
          "densities": densities_block, "levels": levels_block, "passes": passes_block,
          "lengths": lengths_block, "sets": sets_block, "rest": rest_block, "variants": variants_block,
          "needed": needed_block}
OTHER_ENDS = {"open": open_block, "supply": supply_block, "held": held_block}


def _pictures(name: str, folder: Path) -> str:
    found = {picture_name(picture): text for picture, text in PICTURES.get(name, {}).items()}
    return "".join(f"\n\n![{text}](pictures/{file})" for file, text in found.items() if (folder / file).exists())


def other_ends(page: Path) -> Path:
    """The page beside it."""
    return page.with_name(f"{page.stem}_other_ends{page.suffix}")


def _renewed(page: Path, blocks: dict[str, Callable[[Findings], str]], findings: Findings, pictures: Path) -> str:
    """The page with new text between its markers."""
    text = page.read_text(encoding="utf-8")
    for name, make in blocks.items():
        begin, end = f"<!-- {name}: generated -->", f"<!-- end of {name} -->"
        pattern = re.compile(f"{begin}\n.*?{end}", re.S)
        if len(pattern.findall(text)) != 1:
            raise Failure(f"{page.name} must have '{begin}' and '{end}' once, in lines of their own.")
        block = f"{begin}\n\n{make(findings)}{_pictures(name, pictures)}\n\n{end}"
        text = pattern.sub(lambda _, block=block: block, text)
    return text


def renew(page: Path, findings: Findings, pictures: Path) -> None:
    texts = {each: _renewed(each, blocks, findings, pictures)
             for each, blocks in ((page, BLOCKS), (other_ends(page), OTHER_ENDS))}
    for each, text in texts.items():
        write_whole(each, text)
