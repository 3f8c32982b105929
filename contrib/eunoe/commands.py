"""The commands: `contrib/tools NAME ...` calls `main` of the module beside that name."""

from __future__ import annotations

import difflib
import importlib
import signal
import sys

from eunoe.launch import Failure

MISSING_PACKAGE = 77  # exit code that makes ctest skip a test
# The names of Debian's packages.
PACKAGES = {"numpy": "python3-numpy", "matplotlib": "python3-matplotlib", "vtkmodules": "python3-vtk9",
            "PIL": "python3-pil"}

COMMANDS = {
    "Results": {
        "report": ("report.of_run", "turns the output folder of a run into a page, report.html"),
        "discovery-report": ("report.of_study", "turns the output folder of a study into a page, discovery.html"),
    },
    "Verification and long runs": {
        "lethe": ("lethe.run", "runs the examples of Lethe and compares them with published numbers"),
        "verification": ("verification.compare", "compares the cases of prm/verification with their references"),
        "kill-and-restart": ("endurance.kill_and_restart", "kills a run again and again and lets it continue"),
        "soak": ("endurance.soak", "runs millions of steps and watches the memory"),
    },
    "Speed": {
        "benchmark": ("benchmarks.speed", "measures the speed beside LAMMPS and LIGGGHTS"),
        "balance": ("benchmarks.balance", "measures what load balancing does over a spreading run"),
        "late-layers": ("benchmarks.late_layers", "measures what sleeping particles save in a pass over 20 layers"),
        "late-pass": ("benchmarks.late_pass", "measures what sleeping particles save"),
        "collapse": ("benchmarks.collapse", "compares the collapse of a column with LAMMPS"),
        "slot": ("benchmarks.slot_rate", "compares the discharge through a slot with LAMMPS and LIGGGHTS"),
        "kernel-cycles": ("benchmarks.kernel_cycles", "tells what the kernels take on a processor that is not at hand"),
        "predict-scaling": ("scaling.predict", "predicts what a case takes on many ranks"),
    },
    "Studies": {
        "cheap-heaps": ("studies.cheap_heaps", "whether larger steps, softer grains or sleep change a heap"),
        "cheap-layers": ("studies.cheap_layers", "whether larger steps, softer grains or sleep change the layers"),
        "feedstock": ("studies.feedstock", "what the feedstock does to the layers"),
        "forgetting": ("studies.forgetting", "what a packing loses when its contacts forget"),
        "reproduction": ("studies.reproduction", "goes on with the campaign that reproduces the paper"),
        "heap-size": ("studies.heap_size", "how a heap's angle depends on the size of its disc"),
        "heap-extrapolation": ("studies.heap_extrapolation", "towards which angle heaps go on larger discs"),
        "sleep-layers": ("studies.sleep_layers", "whether sleeping particles change the layers"),
        "sleep-proofs": ("studies.sleep_proofs", "whether sleeping particles change what creeps or flows"),
        "measure": ("discovery.measure", "measures particles of another program or a scan, for a study"),
        "fingerprints": ("discovery.fingerprints", "how well recorded runs tell effects apart"),
        "foreign-heaps": ("discovery.foreign_heaps", "makes heaps with LIGGGHTS or LAMMPS, as data of studies"),
        "suite": ("discovery.suite", "makes a blind suite of hidden truths for eunoe-discovery, and studies it"),
        "score": ("discovery.score", "compares the answers of such a suite with the truths"),
    },
    "Documentation": {
        "document-parameters": ("documentation.parameters", "writes doc/parameters.md from a program's description"),
        "pictures": ("pictures.make", "rebuilds the pictures of doc/pictures from their cases"),
        "example-pictures": ("pictures.examples", "draws the cases of prm/examples"),
        "apparatus": ("pictures.apparatus_at", "draws the whole apparatus of a spreading run"),
    },
}
MODULES = {name: module for group in COMMANDS.values() for name, (module, _) in group.items()}


def listing() -> str:
    lines = ["Usage: contrib/tools COMMAND ...", "       contrib/tools COMMAND --help"]
    for title, group in COMMANDS.items():
        lines += ["", f"{title}:", *(f"  {name:19} {text}" for name, (_, text) in group.items())]
    return "\n".join(lines)


def run(name: str, words: list[str]) -> int:
    """Runs a command with its arguments."""
    try:
        module = importlib.import_module(f"eunoe.{MODULES[name]}")
        return module.main(words)
    except ImportError as error:
        package = (error.name or "").partition(".")[0]
        if package not in PACKAGES:
            raise
        print(f"{sys.executable} has no {package}: install {PACKAGES[package]}, and call this with Debian's "
              "/usr/bin/python3.", file=sys.stderr)
        return MISSING_PACKAGE
    except Failure as failure:
        print(failure, file=sys.stderr)
        return 1
    except OSError as error:
        # A full disk does not say in which file.
        print(f"{error.filename or 'A file'} cannot be used: {error.strerror}.", file=sys.stderr)
        return 2


def main(words: list[str] | None = None) -> int:
    name, *rest = (sys.argv[1:] if words is None else words) or ["--help"]
    if name in ("-h", "--help"):
        print(listing())
        return 0
    if name not in MODULES:
        near = difflib.get_close_matches(name, MODULES, 1)
        print(f"There is no command '{name}'. " + (f"Did you mean '{near[0]}'?" if near else
                                                   "See contrib/tools --help."), file=sys.stderr)
        return 2
    # Like other programs, end quietly when the reader of the output closes the pipe.
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    sys.argv = [f"tools {name}", *rest]  # argparse takes the program's name from here
    return run(name, rest)
