"""The table of pictures: their cases, commands and cost."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Rule:
    """Commands that make pictures, run in the top folder of the repository.

    `pictures` maps each file of doc/pictures to the file that the commands make, relative to the
    rule's folder. `compute` are commands that need not be repeated; `draw` are commands that only
    draw, or that skip by themselves what they have computed. In both, {particles} and {discovery}
    stand for the programs with mpirun, {program} for eunoe-particles without mpirun, {python} for
    the interpreter, {folder} for the rule's folder. `cost` is the time on one free core.
    """

    name: str
    cost: str
    pictures: dict[str, str]
    compute: tuple[str, ...] = field(default=())
    draw: tuple[str, ...] = field(default=())


REPORT = "{python} contrib/tools report {folder}/run --figures png"


def _lesson(file: str, name: str, data: str = "measured.csv") -> str:
    """A command of the worked example, with data, results and the shared cache in the rule's folder."""
    option = "--make-twin " if file == "truth" else ""
    settings = {"measured data": data, "output path": name, "table of runs": "runs.sqlite"}
    return (f"{{discovery}} {option}prm/discovery/paper_lesson/{file}.prm "
            + " ".join(f'--set "discovery/{entry} = {{folder}}/{path}"' for entry, path in settings.items())
            + (' --set "twin/sealed file = {folder}/truth.sealed.json"' if option else ""))


def _verification(rows: tuple[str, ...]) -> tuple[dict[str, str], str]:
    pictures = {f"verification_{row}.png": f"pictures/verification_{row}.png" for row in rows}
    return pictures, ("{python} contrib/tools verification {program} {folder}/runs --reuse --rows "
                      + " ".join(rows) + " --pictures {folder}/pictures")


EXAMPLES = ("bouncing_sphere", "dam_break", "granular_mixer", "packing_in_box", "rotating_drum", "sandpile")
SHORT_ROWS, DRAW_SHORT_ROWS = _verification((
    "chung_ooi_1", "chung_ooi_2", "chung_ooi_3", "chung_ooi_4", "chung_ooi_5", "chung_ooi_6", "kharaz",
    "sticking", "stacked_pair", "slip_to_roll", "incline", "rolling_decay", "pile", "pull_off_dmt",
    "pull_off_jkr"))
LONG_ROWS, DRAW_LONG_ROWS = _verification(("janssen", "beverloo"))

RULES = (
    Rule("quickstart", "4 minutes",
         {f"quickstart_{name}.png": f"run/figures/figure-{number}.png" for number, name in
          enumerate(("density", "layers", "displacement", "apparatus", "budget"), start=1)},
         ('{particles} prm/spreading/quickstart.prm --set "simulation control/output path = {folder}/run"',),
         (REPORT,)),
    Rule("spreading", "70 minutes",
         {"spreading.png": "spreading.png"},
         ('{particles} prm/spreading/PS1_small.prm --set "powder spreading/number of layers = 12" '
          '--set "simulation control/output path = {folder}/run"',),
         ("{python} contrib/tools apparatus {folder}/run 10 {folder}/spreading.png",)),
    Rule("heap", "4 minutes",
         {"heap_map.png": "PS3_1mm_fill12_seed1/figures/figure-1.png"},
         (),
         ("{python} contrib/tools heap-size {program} {folder} --discs 1 --fill-ratios 12 --sets PS3 "
          "--seeds 1",
          "{python} contrib/tools report {folder}/PS3_1mm_fill12_seed1 --figures png")),
    Rule("examples", "3 minutes",
         {f"example_{name}.png": f"pictures/example_{name}.png" for name in EXAMPLES},
         ("{python} contrib/tools example-pictures {program} {folder}/runs --run-only",),
         ("{python} contrib/tools example-pictures {program} {folder}/runs --draw-only "
          "--pictures {folder}/pictures",)),
    Rule("verification", "4 minutes", SHORT_ROWS, (), (DRAW_SHORT_ROWS,)),
    Rule("verification_long", "15 minutes", LONG_ROWS, (), (DRAW_LONG_ROWS,)),
    Rule("forgetting", "20 minutes",
         {"forgetting.png": "forgetting.png"},
         (),
         ("{python} contrib/tools forgetting {program} {folder} --experiments heap spreading "
          "--intervals 0 100000 10000 1000 100 10",
          "{python} contrib/tools forgetting {program} {folder} --experiments pile --seeds 1 2 3 "
          "--intervals 0 10000 1000 100",
          "{python} contrib/tools forgetting {program} {folder} --table-only "
          "--intervals 0 100000 10000 1000 100 10 --picture {folder}/forgetting.png")),
    Rule("collapse", "20 minutes, and LAMMPS must be installed",
         {"collapse_check.png": "collapse.png"},
         ("{python} contrib/tools collapse --program {program} "
          "--figure {folder}/collapse.png --table {folder}/collapse.md",)),
    Rule("discovery", "2 hours: a twin and two studies of the worked example",
         {"discovery_tie.png": "angle/figures/figure-1.png",
          "discovery_envelopes.png": "study/figures/figure-3.png",
          "discovery_gap.png": "study/figures/figure-4.png"},
         (_lesson("truth", "twin"),
          "bash -c \"grep -E '^#|^experiment|heap,base_angle,' {folder}/measured.csv "
          "> {folder}/measured_angle.csv\"",
          _lesson("angle_only", "angle", "measured_angle.csv"), _lesson("study", "study")),
         tuple("{python} contrib/tools discovery-report {folder}/" + name + " --figures png"
               for name in ("angle", "study"))),
)
