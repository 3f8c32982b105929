"""Reader of the particle files that deal.II writes: .vtu with inline data, and their index .pvd."""

from __future__ import annotations

import base64
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Iterable
from xml.etree import ElementTree

import numpy as np

TYPES = {
    "Int8": "i1", "UInt8": "u1", "Int16": "i2", "UInt16": "u2", "Int32": "i4", "UInt32": "u4",
    "Int64": "i8", "UInt64": "u8", "Float32": "f4", "Float64": "f8",
}


class VtkError(Exception):
    """A file that cannot be read, with a sentence that says why."""


@dataclass(frozen=True)
class Snapshot:
    """An entry of a .pvd file: the time (s) and the file with the particles."""

    time: float
    file: Path


@dataclass(frozen=True)
class Encoding:
    """How a file stores its arrays."""

    order: str  # '<' or '>', of the bytes in a number
    header: str  # of the counts in front of the data
    compressed: bool

    @classmethod
    def of(cls, root: ElementTree.Element) -> Encoding:
        order = ">" if root.get("byte_order") == "BigEndian" else "<"
        compressor = root.get("compressor")
        if compressor not in (None, "vtkZLibDataCompressor"):
            raise VtkError(f"its compressor {compressor} is not supported")
        return cls(order, order + TYPES[root.get("header_type", "UInt32")], compressor is not None)


def _encoded_length(n_bytes: int) -> int:
    """Number of base64 characters, with padding, of so many bytes."""
    return 4 * -(-n_bytes // 3)


def _binary(text: str, encoding: Encoding) -> bytes:
    """The bytes of an array: its counts and its data are two base64 texts, one after the other."""
    size = np.dtype(encoding.header).itemsize

    def counts(number: int) -> np.ndarray:
        characters = text[:_encoded_length(number * size)]
        return np.frombuffer(base64.b64decode(characters), encoding.header, number)

    if not encoding.compressed:
        return base64.b64decode(text)[size:size + int(counts(1)[0])]
    # Number of blocks, their size, the last one's size, and the compressed size of each.
    n_header = 3 + int(counts(1)[0])
    data = memoryview(base64.b64decode(text[_encoded_length(n_header * size):]))
    ends = np.cumsum(counts(n_header)[3:], dtype=np.int64)
    blocks = zip(np.concatenate(([0], ends)), ends)
    return b"".join(zlib.decompress(data[begin:end]) for begin, end in blocks)


def _array(element: ElementTree.Element, encoding: Encoding) -> np.ndarray:
    """The values of a DataArray, with one row a point if it has several components."""
    layout = element.get("format", "ascii")
    kind = np.dtype(encoding.order + TYPES[element.get("type", "")])
    text = "".join((element.text or "").split()) if layout == "binary" else element.text or ""
    if not text.strip():
        values = np.empty(0, kind)
    elif layout == "binary":
        values = np.frombuffer(_binary(text, encoding), kind)
    elif layout == "ascii":
        values = np.array(text.split(), kind)
    else:
        raise VtkError(f"its format '{layout}' is not supported")
    n_components = int(element.get("NumberOfComponents", 1))
    return values.reshape(-1, n_components) if n_components > 1 else values


def read_vtu(path: Path, names: Iterable[str]) -> dict[str, np.ndarray]:
    """Points and point data of a .vtu file, of all its pieces (one a rank) together.

    The coordinates (m) come under the name 'points'; of the point data only those named are read,
    and those that the file lacks are left out.
    """
    wanted = set(names)
    pieces: dict[str, list[np.ndarray]] = {"points": []}
    try:
        root = ElementTree.parse(path).getroot()
        encoding = Encoding.of(root)
        for piece in root.iter("Piece"):
            n_points = int(piece.get("NumberOfPoints", 0))
            if n_points == 0:
                continue  # a rank without particles writes no points at all
            arrays = {"points": piece.find("Points/DataArray")}
            for element in piece.iterfind("PointData/DataArray"):
                arrays[element.get("Name", "")] = element
            for name in arrays.keys() & (wanted | {"points"}):
                values = _array(arrays[name], encoding)
                if len(values) != n_points:
                    raise VtkError(f"'{name}' has {len(values)} values for {n_points} points")
                pieces.setdefault(name, []).append(values)
    except VtkError as error:
        raise VtkError(f"{path.name} cannot be read: {error}.") from error
    except (OSError, ElementTree.ParseError, ValueError, KeyError, AttributeError,
            zlib.error) as error:
        raise VtkError(f"{path.name} cannot be read: it is missing or not complete.") from error
    pieces["points"] = pieces["points"] or [np.empty((0, 3), np.float32)]
    return {name: np.concatenate(parts) for name, parts in pieces.items()}


def read_pvd(path: Path) -> list[Snapshot]:
    """The entries of a .pvd file; none if the file does not exist."""
    if not path.is_file():
        return []
    try:
        root = ElementTree.parse(path).getroot()
        return [Snapshot(float(entry.attrib["timestep"]), path.parent / entry.attrib["file"])
                for entry in root.iter("DataSet")]
    except (ElementTree.ParseError, KeyError, ValueError) as error:
        raise VtkError(f"{path.name} cannot be read: it is not complete.") from error
