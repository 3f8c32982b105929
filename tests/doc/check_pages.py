"""The pages of the documentation: relative links lead to files and headings that exist, every page
of doc/ is linked from its index, the examples marked as complete (```prm complete) and the cases of
prm/examples and prm/verification are accepted by the program, which prints the sample of --check.

Usage: check_pages.py path/to/many-runs
"""

from __future__ import annotations

import re
import shlex
import sys
import tempfile
from pathlib import Path

from many_runs import ManyRuns

ROOT = Path(__file__).resolve().parents[2]


def pages() -> list[Path]:
    folders = [ROOT / name for name in ("doc", "contrib", "prm", "tests")]
    return sorted([*ROOT.glob("*.md"), *(p for f in folders for p in f.rglob("*.md"))])


def without_code(text: str) -> str:
    return re.sub(r"`[^`\n]*`", "", re.sub(r"^```.*?^```", "", text, flags=re.M | re.S))


def anchors(page: Path) -> set[str]:
    """The names that GitHub gives to the headings of a page."""
    text = re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.M | re.S)
    headings = re.findall(r"^#+ (.*)$", text, flags=re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-")
            for heading in headings}


def links(page: Path) -> list[str]:
    text = without_code(page.read_text(encoding="utf-8"))
    return [link for link in re.findall(r"\]\(([^)\s]+)\)", text)
            if not re.match(r"[a-z]+:", link)]


def check_links() -> list[str]:
    wrong = []
    for page in pages():
        for link in links(page):
            name, _, anchor = link.partition("#")
            target = (page.parent / name).resolve() if name else page
            place = f"{page.relative_to(ROOT)}: the link {link} "
            if not target.exists():
                wrong.append(place + "leads nowhere.")
            elif anchor and target.suffix == ".md" and anchor not in anchors(target):
                wrong.append(place + "names a heading that does not exist.")
    index = ROOT / "doc" / "README.md"
    named = {(index.parent / link.partition("#")[0]).resolve() for link in links(index)}
    wrong += [f"doc/README.md does not name {page.name}."
              for page in sorted((ROOT / "doc").glob("*.md")) if page not in named | {index}]
    return wrong


def check_examples(program: ManyRuns) -> list[str]:
    """Each example runs through --check in the folder prm/examples, where includes are found."""
    wrong = []
    count = 0
    for page in pages():
        text = page.read_text(encoding="utf-8")
        for example in re.findall(r"^```prm complete\n(.*?)^```", text, flags=re.M | re.S):
            count += 1
            with tempfile.NamedTemporaryFile("w", suffix=".prm") as file:
                file.write(example.replace("include ", f"include {ROOT}/prm/examples/"))
                file.flush()
                done = program(file.name, "--check", cwd=ROOT)
            if done.returncode != 0:
                place = page.relative_to(ROOT)
                wrong.append(f"{place}: example {count} is refused:\n{done.stdout}{done.stderr}")
    if count == 0:
        wrong.append("No example is marked as complete.")
    cases = [case for folder in ("examples", "verification")
             for case in sorted((ROOT / "prm" / folder).glob("*.prm"))]
    for case in cases:
        # Files that a case names are relative to the folder where the program starts.
        done = program(case, "--check", cwd=ROOT)
        if done.returncode != 0:
            wrong.append(f"{case.relative_to(ROOT)} is refused:\n{done.stdout}{done.stderr}")
    case = ROOT / "prm" / "examples" / "falling_particles.prm"
    if case.read_text(encoding="utf-8") not in (ROOT / "README.md").read_text(encoding="utf-8"):
        wrong.append(f"README.md does not show {case.name} as it is.")
    return wrong


def check_sample(program: ManyRuns) -> list[str]:
    """The command above the sample of --check in doc/input.md prints the lines of the sample in
    this order; of a line that ends with '...', the part before it."""
    text = (ROOT / "doc" / "input.md").read_text(encoding="utf-8")
    sample = re.search(r"^```sh\n\S*/eunoe-particles (.* --check .*)\n```\n\n.*\n\n```\n(.*?)^```", text,
                       flags=re.M | re.S)
    if not sample:
        return ["doc/input.md has no sample of --check below its command."]
    words = [str(ROOT / word) if (ROOT / word).is_file() else word for word in shlex.split(sample[1])]
    # Elsewhere, as --check has a line more where the folder of the results holds some.
    with tempfile.TemporaryDirectory() as folder:
        done = program(*words, cwd=Path(folder))
    said, printed = sample[2].splitlines(), done.stdout.splitlines()
    same = len(said) == len(printed) and all(
        line.startswith(says.removesuffix("...")) if says.endswith("...") else line == says
        for says, line in zip(said, printed))
    return [] if same else ["doc/input.md: --check does not print the sample but\n" + done.stdout + done.stderr]


def main() -> int:
    with tempfile.TemporaryDirectory() as folder:
        program = ManyRuns(sys.argv[1], Path(folder))
        wrong = check_links() + check_examples(program) + check_sample(program)
        program.close()
    print("\n".join(wrong) if wrong else "ok")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
