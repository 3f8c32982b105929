"""Prints what the kernels for AVX-512 take for eight contacts at least, by LLVM's machine-code analyser, which knows
processors that are not at hand: cycles if nothing waited for memory or for results of its own.

Usage: contrib/tools kernel-cycles [--library build/release/libeunoe.so] [--analyser llvm-mca-16]
           [--processors sapphirerapids,znver4]

Needs the analyser (Debian's llvm-16; older ones do not know znver4), and nm and objdump (binutils).
"""

from __future__ import annotations

import argparse
import re
import shutil
import subprocess

from eunoe.launch import Failure
from eunoe.tables import as_markdown

LANES = 8  # of 512 bits
BLOCK = 32  # contacts for which a kernel without a loop is unrolled, or one that loops over blocks
UNROLLED = 320  # instructions of 512 bits, more than the longest kernel has for eight contacts
VARIANT = "arch_x86_64_v4"
# What the names of the functions contain.
KERNELS = {"Mindlin": "Mindlin<(eunoe::(anonymous namespace)::Spring)0, true>::kernel<eunoe::SameRow",
           "EPSD": "EpsdRolling::kernel<eunoe::SameRow", "Hertz": "Hertz::kernel<eunoe::SameRow",
           "forces of one block added, the next described": "add_and_describe_kernel"}
ROOT_OR_DIVISION = re.compile(r"v(div|sqrt)pd")


def output(*command: str, text: str | None = None) -> str:
    if shutil.which(command[0]) is None:
        raise Failure(f"There is no program '{command[0]}'.")
    done = subprocess.run(command, input=text, capture_output=True, text=True, check=False)
    if done.returncode != 0 or "error:" in done.stderr:
        raise Failure(f"{command[0]}: {(done.stderr.strip().splitlines() or ['it has failed'])[0]}")
    return done.stdout


def instructions(disassembly: str) -> list[tuple[int, str]]:
    """Address and text of each instruction."""
    found = (re.match(r"\s*([0-9a-f]+):\t([^#]*)", line) for line in disassembly.splitlines())
    return [(int(match[1], 16), match[2].strip()) for match in found if match]


def hot_part(code: list[tuple[int, str]]) -> tuple[list[str], int]:
    """The loop with most divisions and roots, or all if there is no loop, and for how many contacts it is."""
    places = {address: place for place, (address, _) in enumerate(code)}
    loops = []
    for place, (address, text) in enumerate(code):
        jump = re.match(r"j\w+\s+([0-9a-f]+)", text)
        if jump and places.get(int(jump[1], 16), len(code)) <= place:
            loops.append([words for _, words in code[places[int(jump[1], 16)]:place + 1]])
    if not loops:
        return [text for _, text in code], BLOCK
    loop = max(loops, key=lambda lines: (sum(bool(ROOT_OR_DIVISION.match(line)) for line in lines), len(lines)))
    return loop, BLOCK if sum("zmm" in line for line in loop) > UNROLLED else LANES


def readable(lines: list[str]) -> str:
    """For the analyser, which knows no addresses of jumps and calls."""
    return "\n".join("nop" if re.match(r"j|call", line) else re.sub("<[^>]*>", "", line) for line in lines) + "\n"


def functions(library: str) -> dict[str, tuple[int, int]]:
    """Beginning and end of each kernel."""
    symbols = [line.split(maxsplit=3) for line in output("nm", "-C", "-S", "--defined-only", library).splitlines()]
    found = {}
    for name, part in KERNELS.items():
        for symbol in symbols:
            if len(symbol) == 4 and part in symbol[3] and VARIANT in symbol[3]:
                found[name] = (int(symbol[0], 16), int(symbol[0], 16) + int(symbol[1], 16))
        if name not in found:
            raise Failure(f"{library} has no kernel of {name} for {VARIANT}.")
    return found


def cycles(analyser: str, processor: str, text: str) -> float:
    report = output(analyser, f"-mcpu={processor}", "-iterations=100", text=text)
    return float(re.search(r"Block RThroughput:\s*([\d.]+)", report)[1])


def main(words: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--library", default="build/release/libeunoe.so")
    parser.add_argument("--analyser", default="llvm-mca-16")
    parser.add_argument("--processors", default="sapphirerapids,znver4")
    options = parser.parse_args(words)
    processors = options.processors.split(",")
    rows, sums = [], [0.] * len(processors)
    for name, (begin, end) in functions(options.library).items():
        code = instructions(output("objdump", "-d", "--no-show-raw-insn", f"--start-address={begin}",
                                   f"--stop-address={end}", options.library))
        lines, contacts = hot_part(code)
        taken = [cycles(options.analyser, processor, readable(lines)) * LANES / contacts for processor in processors]
        sums = [a + b for a, b in zip(sums, taken)]
        rows.append([name, *(f"{number:.0f}" for number in taken)])
    print(as_markdown([["", *processors], *rows, ["all of these", *(f"{number:.0f}" for number in sums)]]))
    return 0
