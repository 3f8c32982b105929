"""Checkpoints with wrong contents and valid checksums, and of the version before."""

from __future__ import annotations

import json
import struct
import zlib
from typing import Callable

TITLE = b"Eunoe checkpoint 7\n"
CHUNK = 1 << 22


def assembled(head: bytes, sections: bytes) -> bytes:
    data = TITLE + struct.pack("<Q", len(head)) + head + sections
    of_chunks = [zlib.crc32(data[begin:begin + CHUNK]) for begin in range(0, len(data), CHUNK)]
    data += struct.pack(f"<Q{len(of_chunks)}I", len(data), *of_chunks)
    return data + struct.pack("<Q", zlib.crc32(data))


def without_checksums(data: bytes) -> bytes:
    n_chunks = -(-(len(data) - 16) // (CHUNK + 4))
    return data[:-16 - 4 * n_chunks]


def of_version_6(data: bytes) -> bytes:
    """The same checkpoint as programs wrote it before chunks had checksums."""
    data = without_checksums(data).replace(TITLE, b"Eunoe checkpoint 6\n", 1)
    return data + struct.pack("<Q", zlib.crc32(data))


def forged(data: bytes, change: Callable[[dict, list], None]) -> bytes:
    """@param change what is done to the head and to the rows of the first section"""
    data = without_checksums(data)
    begin = len(TITLE) + 8
    end = begin + struct.unpack_from("<Q", data, len(TITLE))[0]
    head = json.loads(data[begin:end])
    n = head["sections"][0]["rows"]
    lengths = struct.unpack_from(f"<{n}I", data, end)
    at, rows = end + 4 * n, []
    for length in lengths:
        rows.append(list(struct.unpack_from(f"<{length}d", data, at)))
        at += 8 * length
    rest = data[at:]
    change(head, rows)
    sections = struct.pack(f"<{len(rows)}I", *(len(row) for row in rows))
    sections += b"".join(struct.pack(f"<{len(row)}d", *row) for row in rows) + rest
    return assembled(json.dumps(head, separators=(",", ":")).encode(), sections)


def set_head(path: str, value) -> Callable[[dict, list], None]:
    """@param path names of the keys from the outermost on, "insertion/next_id" """
    *outer, name = path.split("/")

    def change(head: dict, rows: list) -> None:
        for key in outer:
            head = head[key]
        head[name] = value
    return change


def set_number(place: int, value: float) -> Callable[[dict, list], None]:
    """@param place in the row of the first particle: 0 its id, 1 its type, 2 its radius"""
    return lambda head, rows: rows[0].__setitem__(place, value)


def lengthen(values: list[float]) -> Callable[[dict, list], None]:
    """Gives the first particle more numbers, in the place of its contacts' records."""
    def change(head: dict, rows: list) -> None:
        rows[0].extend(values)
        head["sections"][0]["values"] += len(values)
    return change


def shorten(head: dict, rows: list) -> None:
    """Leaves the first particle no more than its id."""
    head["sections"][0]["values"] -= len(rows[0]) - 1
    del rows[0][1:]


def claim(name: str, number: int) -> Callable[[dict, list], None]:
    return lambda head, rows: head["sections"][0].__setitem__(name, number)


def wrong_words(head: dict, rows: list) -> None:
    head["ledger"]["inserted"]["mass"] = [1, 0, 2**63 - 1, 2**63 - 1]


NO_HEAD = "is damaged: its head is not understood."
NO_NUMBER = "is damaged: a number in its head is none."
NOT_OF_CASE = "is damaged: its particles are not those of the case."
FORGERIES = (
    ("no sections", lambda head, rows: head.pop("sections"), NO_HEAD),
    ("rows that wrap around", claim("rows", 2**62), "its sections do not fit into it."),
    ("values that wrap around", claim("values", 2**61), "its sections do not fit into it."),
    ("half a row", claim("rows", 0.5), NO_HEAD),
    ("fewer rows", claim("rows", 0), "its sections do not fill it."),
    ("no step", lambda head, rows: head["clock"].pop("step"), "its head lacks what the case needs."),
    ("half a step", set_head("clock/step", 0.5), NO_NUMBER),
    ("a step far away", set_head("clock/step", 10**18), "is of step 1000000000000000000, and the run ends"),
    ("no input", set_head("input", None), "it does not hold the input of its run."),
    ("no tally", set_head("ledger/lost", []), "its head lacks what the case needs."),
    ("a sum that overflows", wrong_words, NO_NUMBER),
    ("ids that run over", set_head("insertion/next_id", 2**32), NO_NUMBER),
    ("components that run over",
     lambda head, rows: head["layout"]["fields"].append({"name": "more", "components": 2**32 - 1}), NO_NUMBER),
    ("no pictures", set_head("outputs", {}), "its head lacks what the case needs."),
    ("an id", set_number(0, -1.), NOT_OF_CASE),
    ("a type", set_number(1, 1.), NOT_OF_CASE),
    ("a radius", set_number(2, float("nan")), NOT_OF_CASE),
    ("a mass", set_number(3, 0.), NOT_OF_CASE),
    ("a place", set_number(4, 1e300), "outside the mesh"),
    ("half a contact", lengthen([0., 1.]), NOT_OF_CASE),
    ("a contact with nobody", lengthen([0., 1e300] + 20 * [0.]), NOT_OF_CASE),
    ("a short row", shorten, NOT_OF_CASE),
)
