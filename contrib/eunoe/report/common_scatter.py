"""Numbers of groups of runs with 95 % intervals, where some groups are taken to scatter alike."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from eunoe.intervals import Interval, Scatter, common_scatter, difference_of, difference_within, mean_of

from .spread_run import Group, SpreadRun, difference

Number = Callable[[SpreadRun], float]


class CommonScatter:
    """Two or three runs that differ in the seed alone hardly tell how a number scatters, and one does not. The groups
    given here are taken to scatter alike; every other group does so by itself."""

    def __init__(self, groups: Sequence[Group] = ()) -> None:
        self._groups = tuple(groups)
        self._runs = {id(run) for group in groups for run in group.runs}

    def of(self, number: Number) -> Scatter | None:
        return common_scatter([group.of_runs(number) for group in self._groups])

    def mean(self, group: Group, number: Number) -> Interval:
        return mean_of(group.of_runs(number), self._of(group, number))

    def difference(self, group: Group, reference: Group, number: Number) -> Interval:
        """Of the means. Runs of one seed are compared pair by pair only where the groups scatter by themselves."""
        scatter = self._of(group, number)
        if scatter is None:
            return difference(group, reference, number)
        values, others = group.of_runs(number), reference.of_runs(number)
        if self._of(reference, number) is None:
            return difference_of(values, others, scatter)
        return difference_within(scatter, values, others)

    def _of(self, group: Group, number: Number) -> Scatter | None:
        return self.of(number) if all(id(run) in self._runs for run in group.runs) else None
