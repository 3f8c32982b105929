"""Every broken input of this folder is refused with its sentence: on one rank and on two, with exit
code 2, soon, without a stack trace, and without a change to the results of an earlier run.

Usage: bad_input.py path/to/many-runs folder

sentences.txt has one line for each case: its name, and a part of the sentence that it must give.
"""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

from eunoe.launch import overrides
from forged import FORGERIES, assembled, forged
from many_runs import ManyRuns

HERE = Path(__file__).resolve().parent
# Texts that a reader may fail on because of their length, and their sentences.
LONG = {
    "many_blanks": ("subsection simulation control\nset time step = 1" + 150000 * " " + "2\nend\n",
                    "which does not fit. Give a number of at least 0, or 'auto'."),
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
# A message quotes long parts of an input in abridged form.
LONGEST_LINE = 2000
failures = 0


def fail(text: str) -> None:
    global failures
    failures += 1
    print(text, flush=True)


def contents(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes()
            for path in sorted(folder.rglob("*")) if path.is_file()}


def refuse(programs: list[ManyRuns], case: str, sentence: str, folder: Path, *settings: str,
           codes: tuple[int, ...] = (2,)) -> None:
    for program in programs:
        place = f"{folder.name}/{case} on {program.n_ranks} rank(s)"
        run = program(f"{case}.prm", *overrides(settings), cwd=folder)
        if run.returncode not in codes:
            fail(f"{place}: exit code {run.returncode}\n{run.stderr}")
        elif run.stderr.count(sentence) != 1:
            fail(f"{place}: no '{sentence}' in\n{run.stderr}")
        elif max(len(line) for line in run.stderr.splitlines()) > LONGEST_LINE:
            fail(f"{place}: it quotes too much of the input")
        elif "Stacktrace" in run.stderr or "terminate called" in run.stderr:
            fail(f"{place}: a stack trace")


def spoil_checkpoints(programs: list[ManyRuns], folder: Path) -> None:
    """Checkpoints that were cut short or damaged, and inputs that do not match them."""
    programs[0]("checkpointed.prm", "--quiet", cwd=folder).check_returncode()
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
        before = contents(place)
        refuse(programs, "checkpointed", sentence, place, again, *settings, codes=codes)
        if codes == (2,) and contents(place) != before:
            fail(f"{name}: what is refused has changed the folder")

    # Some forgeries are found only after the results were opened, which gives exit code 1.
    strictly = "restart/restart = auto"
    work = [(("another time step", data,
              "time step' is '2e-6', and was '1e-6' in the run that wrote", strictly,
              "simulation control/time step = 2e-6"), (2,)),
            (("another wall", data, "'number of floating walls' is '1', and was '0'", strictly,
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
    for what, codes in work:
        spoil(*what, codes=codes)


def accept_meshes(program: ManyRuns) -> None:
    """The meshes that the sentences advise are accepted: hexahedra in Gmsh's formats, also those
    into which tetrahedra were divided."""
    meshes = sorted((HERE.parent / "meshes" / "gmsh").glob("*.msh"))
    settings = {"lagrangian physical properties/particle type 0/number of particles": 1,
                "insertion info/insertion method": "list",
                **{f"insertion info/list {axis}": 0.5 for axis in "xyz"}}
    for mesh in meshes:
        run = program("mesh_of_tetrahedra.prm", "--check", *overrides({**settings, "mesh/file name": mesh}), cwd=HERE)
        if run.returncode != 0:
            fail(f"{mesh.name}: {run.stderr}")


def main(many_runs: str, folder: Path) -> int:
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
    programs = [ManyRuns(many_runs, folder.with_name(f"{folder.name}_on_{n}"), n) for n in (1, 2)]
    for program in programs:  # ranks that wait for the next input take time from others
        for case, sentence in sentences.items():
            refuse([program], case, sentence, folder)
    if contents(folder) != before:
        fail(f"files have changed: {set(contents(folder)) ^ set(before)}")
    spoil_checkpoints(programs, folder)
    accept_meshes(programs[0])
    for program in programs:
        program.close()
    print(f"{len(sentences) + len(FORGERIES) + 9} broken inputs")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], Path(sys.argv[2]).resolve()))
