#!/usr/bin/env python3
"""Says which files include what stands above them. A file of the library may include its own folder
and those beneath it; doc/architecture.md says what stands on each floor.

Usage: contrib/check_floors.py [folder of the tree]
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

# From the ground up. Folders of one floor must not include each other.
FLOORS = [["core"], ["checkpoint"], ["state"], ["solids"], ["domain"], ["contact"], ["engine"], ["simulation"],
          ["observables", "processes"], ["discovery"]]
FLOOR_OF = {folder: floor for floor, folders in enumerate(FLOORS) for folder in folders}
INCLUDE = re.compile(r'\s*#\s*include\s*[<"]eunoe/([^/">]+)/')
RELATIVE = re.compile(r'\s*#\s*include\s*"[^"]*\.\./')


def folder_of(path: Path) -> str | None:
    """The folder that a file of the library belongs to; None for files outside the folders."""
    inner = path.parts[1:] if path.parts[0] == "source" else path.parts[2:]
    return inner[0] if len(inner) > 1 else None


def problems_of(path: Path, text: str) -> list[str]:
    folder = folder_of(path)
    if folder is None:
        return []
    if folder not in FLOOR_OF:
        return [f"{path}: the folder '{folder}' has no floor. Give it one in contrib/check_floors.py."]
    problems = []
    for number, line in enumerate(text.splitlines(), 1):
        if RELATIVE.match(line):
            problems.append(f"{path}:{number}: a header that other folders use belongs into include/eunoe.")
        found = INCLUDE.match(line)
        if not found or found[1] == folder:
            continue
        if found[1] not in FLOOR_OF:
            problems.append(f"{path}:{number}: there is no folder '{found[1]}'.")
        elif FLOOR_OF[found[1]] >= FLOOR_OF[folder]:
            problems.append(f"{path}:{number}: '{folder}' may not include '{found[1]}', which does not stand beneath it.")
    return problems


def main(arguments: list[str]) -> int:
    root = Path(arguments[0]) if arguments else Path(__file__).resolve().parents[1]
    problems, n_files = [], 0
    for top in ("include/eunoe", "source"):
        for path in sorted((root / top).rglob("*")):
            if path.suffix in (".h", ".cc"):
                n_files += 1
                problems += problems_of(path.relative_to(root), path.read_text(encoding="utf-8"))
    print("\n".join(problems) if problems else f"{n_files} files include only their own folder and what stands beneath it.")
    return 1 if problems or n_files == 0 else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
