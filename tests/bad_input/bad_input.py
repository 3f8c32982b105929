"""Every broken input of this folder is refused with its sentence: on one rank and on two, with exit
code 2, soon, without a stack trace, and without a change to the results of an earlier run.

Usage: bad_input.py path/to/eunoe-particles folder

sentences.txt holds a line a case: its name, and a part of the sentence that it must give.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from eunoe.launch import SHARED, mpirun, overrides
from forged import FORGERIES, assembled, forged

HERE = Path(__file__).resolve().parent
TWO_RANKS = mpirun(2, *SHARED)
# Texts on which a reader may choke by their length alone, and their sentences.
LONG = {
    "many_blanks": ("subsection simulation control\nset time step = 1" + 150000 * " " + "2\nend\n",
                    "which does not fit. Give a number of at least 0."),
    "long_value": ("subsection simulation control\nset time step = " + 1000000 * "7 " + "\nend\n",
                   "... (1999999 characters)', which does not fit."),
    "long_words": ("subsection insertion info\nsubsection insertion acceptance function\n"
                   "set Function expression = x + " + 1000000 * "y" + "\nend\nend\n",
                   "... (1000004 characters)' is not understood."),
    "long_name": ("set " + 2000000 * "a" + " = 1\n", "' is unknown."),
    "deeply_nested": (40000 * "subsection a\n", "more than 20 subsections are open."),
    "many_unknown_names": ("".join(f"set unknown{k} = 1\n" for k in range(3000)),
                           "entry 'unknown2999' is unknown."),
}
# What is quoted from an input is cut short.
LONGEST_LINE = 2000
failures = 0


def fail(text: str) -> None:
    global failures
    failures += 1
    print(text, flush=True)


def contents(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes()
            for path in sorted(folder.rglob("*")) if path.is_file()}


def refuse(program: str, case: str, sentence: str, folder: Path, *settings: str,
           codes: tuple[int, ...] = (2,)) -> None:
    for launch in ([], TWO_RANKS):
        place = f"{folder.name}/{case} on {2 if launch else 1} rank(s)"
        try:
            run = subprocess.run([*launch, program, f"{case}.prm", *overrides(settings)], cwd=folder, timeout=60,
                                 capture_output=True, check=False)
        except subprocess.TimeoutExpired:
            fail(f"{place}: it hangs")
            continue
        errors = run.stderr.decode(errors="replace")
        if run.returncode not in codes:
            fail(f"{place}: exit code {run.returncode}\n{errors}")
        elif errors.count(sentence) != 1:
            fail(f"{place}: no '{sentence}' in\n{errors}")
        elif max(len(line) for line in errors.splitlines()) > LONGEST_LINE:
            fail(f"{place}: it quotes too much of the input")
        elif "Stacktrace" in errors or "terminate called" in errors:
            fail(f"{place}: a stack trace")


def spoil_checkpoints(program: str, folder: Path) -> None:
    """Checkpoints that were cut short or damaged, and inputs that do not fit to them."""
    subprocess.run([program, "checkpointed.prm", "--quiet"], cwd=folder, check=True)
    data = next((folder / "checkpointed").glob("*.checkpoint")).read_bytes()
    again = "restart/restart = true"

    def spoil(name: str, content: bytes | None, sentence: str, *settings: str,
              codes: tuple[int, ...] = (2,)) -> None:
        place = folder / "spoiled" / name.replace(" ", "_")
        place.mkdir(parents=True)
        shutil.copy(folder / "checkpointed.prm", place)
        shutil.copytree(folder / "checkpointed", place / "checkpointed")
        file = next((place / "checkpointed").glob("*.checkpoint"))
        if content is None:
            file.unlink()
        else:
            file.write_bytes(content)
        refuse(program, "checkpointed", sentence, place, again, *settings, codes=codes)

    # Some forgeries are found when the results are open already.
    work = [(("another time step", data,
              "time step' is '2e-6', and was '1e-6' in the run that wrote",
              "simulation control/time step = 2e-6"), (2,)),
            (("another wall", data, "'number of floating walls' is '1', and was '0'",
              "floating walls/number of floating walls = 1", "floating walls/wall 0/end time = 1"),
             (2,)),
            *(((name, broken, sentence), (2,)) for name, broken, sentence in (
                ("cut short", data[:-9], "its checksum does not fit"),
                ("nearly empty", data[:20], "is cut short: it has 20 bytes"),
                ("empty", b"", "is cut short: it has 0 bytes"),
                ("one bit", data[:-40] + bytes([data[-40] ^ 1]) + data[-39:],
                 "its checksum does not fit"),
                ("a bit of the head", data[:60] + bytes([data[60] ^ 4]) + data[61:],
                 "its checksum does not fit"),
                ("no head", assembled(b"[]", b""), "is damaged: its head is not understood."),
                ("no file", None, "cannot be read: No such file"))),
            *(((name, forged(data, change), sentence), (1, 2)) for name, change, sentence in FORGERIES)]
    with ThreadPoolExecutor(8) as pool:
        for waiting in [pool.submit(spoil, *what, codes=codes) for what, codes in work]:
            waiting.result()


def accept_meshes(program: str) -> None:
    """What the sentences advise is taken: hexahedra in the formats of Gmsh, also of cut tetrahedra."""
    meshes = sorted((HERE.parent / "meshes" / "gmsh").glob("*.msh"))
    settings = {"lagrangian physical properties/particle type 0/number of particles": 1,
                "insertion info/insertion method": "list",
                **{f"insertion info/list {axis}": 0.5 for axis in "xyz"}}
    for mesh in meshes:
        command = [program, "mesh_of_tetrahedra.prm", "--check", *overrides({**settings, "mesh/file name": mesh})]
        run = subprocess.run(command, cwd=HERE, timeout=60, capture_output=True, text=True, check=False)
        if run.returncode != 0:
            fail(f"{mesh.name}: {run.stderr}")


def main(program: str, folder: Path) -> int:
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(HERE, folder)
    # The spreading cases include files of the project.
    for file in folder.glob("*.prm"):
        file.write_bytes(file.read_bytes().replace(b"../../prm", str(HERE.parents[1] / "prm").encode()))
    lines = (HERE / "sentences.txt").read_text().splitlines()
    sentences = dict(line.split(": ", 1) for line in lines)
    unknown = {path.stem for path in HERE.glob("*.prm")} ^ (sentences.keys() | {"checkpointed"})
    if unknown:
        fail(f"sentences.txt and the folder differ: {sorted(unknown)}")
    for case, (text, sentence) in LONG.items():
        (folder / f"{case}.prm").write_text(text)
        sentences[case] = sentence
    results = folder / "output"
    results.mkdir()
    (results / "summary.json").write_text("of an earlier run")
    before = contents(folder)
    # A launcher takes seconds to notice that its ranks have failed, in which the others can work.
    with ThreadPoolExecutor(8) as pool:
        for waiting in [pool.submit(refuse, program, case, sentence, folder)
                        for case, sentence in sentences.items()]:
            waiting.result()
    if contents(folder) != before:
        fail(f"files have changed: {set(contents(folder)) ^ set(before)}")
    spoil_checkpoints(program, folder)
    accept_meshes(program)
    print(f"{len(sentences) + len(FORGERIES) + 9} broken inputs")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(str(Path(sys.argv[1]).resolve()), Path(sys.argv[2])))
