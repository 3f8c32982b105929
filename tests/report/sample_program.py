"""Stands for eunoe-particles in tests of the campaign: writes the output of a finished run in no time.

If the folder above the output folder has a file `die`, it dies in the middle of the first run, after as many layers
as the file says or five, and removes that file; if it has a file `wait`, it waits until it is asked to stop.
"""

from __future__ import annotations

import signal
import sys
import time
from pathlib import Path

CHECK = """\
It would run with
  particles:  16525 at most, 12374 on average
  steps:      2000000 of 5.632e-07 s
  core-hours: about 1.7 (3.6e+10 particle-steps at 16 million a second and core)
The case is in order.
"""


def main(words: list[str]) -> int:
    if words == ["--version"]:
        print("Eunoe 0.1.0 (revision 9876543210, deal.II 9.4.1)")
        return 0
    settings = dict(map(str.strip, word.split("=", 1)) for word in words if "=" in word)
    folder, seed = Path(settings["simulation control/output path"]), int(words[words.index("--seed") + 1])
    if "--check" in words:
        print(CHECK)
        return 0
    import sample_bed  # takes longer than the answers above
    peak = 14 if "PS1" in words[0] else 10
    print("starts", folder.name, flush=True)
    if (folder.parent / "wait").exists():
        stopped = []
        signal.signal(signal.SIGUSR1, lambda *_: stopped.append(True))
        (folder.parent / "waits").touch()
        while not stopped:
            time.sleep(0.01)
        return 3
    if (folder.parent / "die").exists():
        layers = int((folder.parent / "die").read_text() or 5)
        (folder.parent / "die").unlink()
        sample_bed.write_run(folder, peak, seed, layers=layers)
        return 9
    sample_bed.write_run(folder, peak, seed)
    return 0


sys.exit(main(sys.argv[1:]))
