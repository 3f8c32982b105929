"""The catalogue of effects: every file of prm/effects has all required entries, and its patch is
accepted by the program in the micro experiments, at its scale and at both ends of its range.

Usage: check_effects.py path/to/many-runs
"""

from __future__ import annotations

import re
import sys
import tempfile
from pathlib import Path

from eunoe.launch import overrides
from eunoe.prm_file import parse_prm
from many_runs import ManyRuns

PRM = Path(__file__).resolve().parents[2] / "prm"
CASES = {"spreading": PRM / "discovery" / "micro_spreading.prm",
         "heap": PRM / "discovery" / "micro_heap.prm"}
KEYS = ("mechanism", "parameter", "unit", "null value", "scale", "range", "sign", "confounders",
        "source", "experiments")


def patched(value: str, base: str, amplitude: float) -> str:
    expression = re.fullmatch(r"\$\{(.*)\}", value)
    if not expression:
        return value
    numbers = base.split(",") if "base" in expression[1] else ["0"]
    code = expression[1].replace("^", "**")
    return ", ".join(repr(eval(code, {"base": float(number), "amplitude": amplitude}))
                     for number in numbers)


def defects(name: str, about: dict[str, str], names: set[str]) -> list[str]:
    wrong = [f"'{key}' is missing" for key in KEYS if not about.get(key)]
    if wrong:
        return wrong
    null, scale = float(about["null value"]), float(about["scale"])
    lower, upper = (float(end) for end in about["range"].split(","))
    if about["sign"] not in ("above", "below", "both") or about["experiments"] not in ("all", *CASES):
        wrong.append("'sign' or 'experiments' is none of the choices")
    elif not lower <= null <= upper or not 0. < 2. * scale <= upper - lower:
        wrong.append("the scale is more than half of the range")
    if about["sign"] == "above" and lower != null or about["sign"] == "below" and upper != null:
        wrong.append("the range reaches to the side that 'sign' rules out")
    for other in about["confounders"].split(","):
        if other.strip() not in names - {name}:
            wrong.append(f"the confounder '{other.strip()}' is not in the catalogue")
    return wrong


def check(program: ManyRuns, file: Path, names: set[str], bases: dict[str, dict[str, str]]) -> list[str]:
    values = parse_prm(file.read_text(encoding="utf-8")).flat()
    about = {key.partition("/")[2]: v for key, v in values.items() if key.startswith("effect/")}
    wrong = defects(file.stem, about, names)
    patch = {key: v for key, v in values.items() if not key.startswith("effect/")}
    if not wrong and not any("amplitude" in value for value in patch.values()):
        wrong.append("the patch does not use the amplitude")
    for kind, case in CASES.items() if not wrong else ():
        if about["experiments"] not in ("all", kind):
            continue
        null = float(about["null value"])
        amplitudes = {float(number) for number in [about["scale"], *about["range"].split(",")]}
        for amplitude in sorted(amplitudes - {null}):
            settings = {key: patched(value, bases[kind].get(key, "0"), amplitude)
                        for key, value in patch.items()}
            done = program(case, "--check", *overrides(settings), cwd=PRM)
            if done.returncode != 0:
                wrong.append(f"at {amplitude:g} {case.name} is refused: {done.stderr.strip()}")
    return [f"{file.name}: {text}." for text in wrong]


def main(many_runs: str) -> int:
    files = sorted((PRM / "effects").glob("*.prm"))
    names = {file.stem for file in files}
    with tempfile.TemporaryDirectory() as folder:
        program = ManyRuns(many_runs, Path(folder))
        bases = {kind: parse_prm(program(case, "--print-parameters", cwd=PRM).stdout).flat()
                 for kind, case in CASES.items()}
        wrong = sum((check(program, file, names, bases) for file in files), [])
        program.close()
    if len(files) < 14:
        wrong.append(f"There are only {len(files)} effects.")
    print("\n".join(wrong) if wrong else "ok")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
