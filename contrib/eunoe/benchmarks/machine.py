"""Facts about the machine that was measured: processor, compiler and versions."""

from __future__ import annotations

import os
import platform
import re
import subprocess
from pathlib import Path


def _first(pattern: str, text: str) -> str:
    match = re.search(pattern, text, re.M)
    return match.group(1).strip() if match else "unknown"


def _read(path: str) -> str:
    try:
        return Path(path).read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ""


def _compiler(program: str) -> str:
    """The compiler of the build folder that holds the program, from CMake's files."""
    cache = _read(str(Path(program).parent / "CMakeCache.txt"))
    compiler = _first(r"^CMAKE_CXX_COMPILER:\w+=(.*)$", cache)
    try:
        done = subprocess.run([compiler, "--version"], capture_output=True, text=True, check=False)
        version = done.stdout.splitlines()[0]
    except (OSError, IndexError):
        return "unknown"
    return f"{version}, {_first(r'^CMAKE_BUILD_TYPE:.*=(.*)$', cache)}"


def processor() -> str:
    return _first(r"^model name\s*:(.*)$", _read("/proc/cpuinfo"))


def facts(programs: list, program: str) -> dict[str, str]:
    """Names and values; `programs` are the programs compared, `program` is the path of Eunoe's."""
    cpu = _read("/proc/cpuinfo")
    flags = set(_first(r"^flags\s*:(.*)$", cpu).split())
    widths = [name for name in ("sse2", "avx", "avx2", "fma", "avx512f") if name in flags]
    memory = _first(r"^MemTotal:\s*(\d+)", _read("/proc/meminfo"))
    result = {
        "processor": processor(),
        "cores": str(os.cpu_count()),
        "instruction sets": ", ".join(widths) or "unknown",
        "memory": f"{int(memory) / 2**20:.0f} GiB" if memory.isdigit() else "unknown",
        "system": _first(r'^PRETTY_NAME="(.*)"$', _read("/etc/os-release")) + ", Linux "
        + platform.release(),
        "compiler": _compiler(program),
        "load before the start": " ".join(_read("/proc/loadavg").split()[:3]) or "unknown",
    }
    for entry in programs:
        result[entry.name] = entry.version()
    return result
