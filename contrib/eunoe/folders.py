"""Folders of runs that several commands work in."""

from __future__ import annotations

import contextlib
import fcntl
import json
from collections.abc import Iterator
from pathlib import Path

from eunoe.launch import Failure


def occupy(folder: Path, what: dict[str, object], note: str) -> None:
    """Notes what the runs of a folder are of, in a file of this name there; a folder with runs of something else
    is refused."""
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / note
    if file.exists():
        old = json.loads(file.read_text(encoding="utf-8"))
        other = [name for name, value in what.items() if old.get(name) != value]
        if other:
            raise Failure(f"{folder} has runs with another {', '.join(other)}. Give another folder.")
    file.write_text(json.dumps(what, indent=2) + "\n", encoding="utf-8")


@contextlib.contextmanager
def alone_with(lock: Path, wait: bool = False) -> Iterator[int | None]:
    """Holds the lock of a file. Gives its descriptor, for programs that shall hold it as long as they run; None if
    another process holds it, unless it is to be waited for."""
    lock.parent.mkdir(parents=True, exist_ok=True)
    with open(lock, "w", encoding="utf-8") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
        except BlockingIOError:
            yield None
            return
        yield file.fileno()
