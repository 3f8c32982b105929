"""Folders of runs that several commands work in."""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from eunoe.launch import Failure


def write_whole(file: Path, text: str) -> None:
    """Writes a file beside the old one and puts it in its place when it is complete. One that holds the text already
    is left alone."""
    if file.exists() and file.read_text(encoding="utf-8") == text:
        return
    beside = file.with_name(file.name + ".new")
    try:
        beside.write_text(text, encoding="utf-8")
        os.replace(beside, file)
    except OSError as error:
        beside.unlink(missing_ok=True)
        raise Failure(f"{file} cannot be written: {error.strerror}.") from error


def read_json(file: Path) -> Any:
    try:
        return json.loads(file.read_text(encoding="utf-8"))
    except json.JSONDecodeError as error:
        raise Failure(f"{file} is damaged: {error}. Remove it or put it back.") from error


def occupy(folder: Path, what: dict[str, object], note: str) -> None:
    """Notes what the runs of a folder are of, in a file of this name there; a folder with runs of something else
    is refused."""
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / note
    if file.exists():
        old = read_json(file)
        other = [name for name, value in what.items() if old.get(name) != value]
        if other:
            raise Failure(f"{folder} has runs with another {', '.join(other)}. Give another folder.")
    write_whole(file, json.dumps(what, indent=2) + "\n")


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
