"""Checks of a test that go on where one fails, some at the same time."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

from eunoe.launch import Failure


class Attempts:
    """Collects the sentences of those that fail."""

    def __init__(self) -> None:
        self.failures: list[str] = []

    def make(self, name: str, action: Callable[..., Any], *arguments: Any) -> None:
        try:
            action(*arguments)
        except Failure as failure:
            self.failures.append(f"{name}: {failure}")

    def make_at_once(self, work: Iterable[tuple], number: int = 4) -> None:
        """Each a name, an action and its arguments. A launcher takes seconds to notice that its ranks have
        failed, in which the others can work."""
        with ThreadPoolExecutor(number) as pool:
            for waiting in [pool.submit(self.make, *what) for what in work]:
                waiting.result()

    def exit_code(self) -> int:
        """Prints what has failed."""
        print(*self.failures, sep="\n")
        return 1 if self.failures else 0
