"""Paths in the repository."""

from __future__ import annotations

from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CASES = ROOT / "prm"
DOC = ROOT / "doc"
BENCHMARKS = ROOT / "contrib" / "benchmarks"  # their data
PROGRAM = ROOT / "build" / "release" / "eunoe-particles"
