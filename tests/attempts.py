"""Runs the checks of a test: a failure does not stop the others, and some run at the same time."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

from eunoe.launch import Failure

# Factor on limits of time: 1 for a release build, more for builds that are much slower.
PATIENCE = int(os.environ.get("EUNOE_PATIENCE", "1"))
# Seconds after which a run of a few seconds counts as one that hangs: so many that a machine that is
# busy with other work does not look like one.
HANGING = 300 * PATIENCE


class Attempts:
    """Collects the error messages of the checks that fail."""

    def __init__(self) -> None:
        self.failures: list[str] = []

    def make(self, name: str, action: Callable[..., Any], *arguments: Any) -> None:
        start = time.monotonic()
        try:
            action(*arguments)
        except Failure as failure:
            self.failures.append(f"{name}: {failure}")
        print(f"{name}: {time.monotonic() - start:.1f} s", flush=True)

    def make_at_once(self, work: Iterable[tuple], number: int = 4) -> None:
        """Runs checks in parallel, each a name, an action and its arguments. A launcher takes
        seconds to notice that its ranks have failed; other checks run in that time."""
        with ThreadPoolExecutor(number) as pool:
            for waiting in [pool.submit(self.make, *what) for what in work]:
                waiting.result()

    def exit_code(self) -> int:
        """Prints the failures and returns 1 if there are any, else 0."""
        print(*self.failures, sep="\n")
        return 1 if self.failures else 0
