"""The record of the pictures: doc/pictures/README.md, a line for each file."""

from __future__ import annotations

import hashlib
import re
from dataclasses import dataclass
from pathlib import Path

from eunoe.folders import write_whole

NAME = "README.md"
HEAD = """# Pictures of the documentation

Written by `contrib/tools pictures`; do not edit by hand. `contrib/tools pictures --only RULE` makes the
pictures of a rule again, `--list` shows the commands and their cost. The revision is that of the
program that computed what the picture shows; of pictures that are older than this list, it is that of
the commit which brought them. The digest is the beginning of the file's SHA-256.

| picture | rule | revision | digest |
|---|---|---|---|
"""


@dataclass(frozen=True)
class Entry:
    """What made a picture."""

    rule: str
    revision: str  # several of a campaign that was made by more than one, as "abcdef0, 1234567"
    digest: str

    @property
    def revisions(self) -> list[str]:
        return self.revision.split(", ")


def digest(file: Path) -> str:
    return hashlib.sha256(file.read_bytes()).hexdigest()[:12]


def read_record(pictures: Path) -> dict[str, Entry]:
    """The entries by the names of the pictures; empty if there is no record yet."""
    file = pictures / NAME
    text = file.read_text(encoding="utf-8") if file.exists() else ""
    revision = r"(?:[0-9a-f]+|unknown)"
    line = rf"^\| (\S+\.png) \| (\S+) \| ({revision}(?:, {revision})*) \| ([0-9a-f]+) \|$"
    return {name: Entry(*words) for name, *words in re.findall(line, text, re.M)}


def write_record(pictures: Path, record: dict[str, Entry]) -> None:
    lines = (f"| {name} | {entry.rule} | {entry.revision} | {entry.digest} |\n"
             for name, entry in sorted(record.items()))
    write_whole(pictures / NAME, HEAD + "".join(lines))
