"""Means and their 95 % intervals, from few values (Student 1908, Welch 1947)."""

from __future__ import annotations

import math
import statistics
from collections.abc import Sequence
from dataclasses import dataclass

# Quantiles of Student's t for two sides of 95 %, by degrees of freedom; 2 from 30 on is near enough.
STUDENT = (math.nan, 12.71, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160,
           2.145, 2.131, 2.120, 2.110, 2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064, 2.060, 2.056, 2.052,
           2.048, 2.045)


def quantile(freedom: float) -> float:
    """Rounded down to whole degrees of freedom, so that no interval is too narrow."""
    return STUDENT[int(freedom)] if freedom < len(STUDENT) else 2.


@dataclass(frozen=True)
class Interval:
    """A number and half the width of its interval; the half is NaN if it is not known: equal values do not tell
    their scatter."""

    value: float
    half: float

    @property
    def is_significant(self) -> bool:
        """Whether 0 lies outside."""
        return abs(self.value) > self.half


@dataclass(frozen=True)
class Scatter:
    """Standard deviation of single values about the mean of their group, and how many degrees of freedom know it."""

    deviation: float
    freedom: int


def _known(values: Sequence[float]) -> list[float]:
    return [value for value in values if not math.isnan(value)]


def common_scatter(groups: Sequence[Sequence[float]]) -> Scatter | None:
    """Of groups that are taken to scatter alike, so that a group of one value has an interval, too (the mean square
    within groups of an analysis of variance). None if no group has two values. NaN values are left out."""
    several = [group for group in map(_known, groups) if len(group) > 1]
    freedom = sum(len(group) - 1 for group in several)
    if not freedom:
        return None
    squares = sum((len(group) - 1) * statistics.variance(group) for group in several)
    return Scatter(math.sqrt(squares / freedom), freedom)


def _variance_of_mean(values: Sequence[float], scatter: Scatter | None) -> tuple[float, float]:
    """And its degrees of freedom; NaN if neither the values nor a scatter tell."""
    if scatter is not None:
        return scatter.deviation ** 2 / len(values), scatter.freedom
    if len(values) < 2:
        return math.nan, math.nan
    return statistics.variance(values) / len(values), len(values) - 1


def _interval(value: float, variance: float, freedom: float) -> Interval:
    if math.isnan(variance) or variance == 0.:
        return Interval(value, math.nan)
    return Interval(value, quantile(freedom) * math.sqrt(variance))


def mean_of(values: Sequence[float], scatter: Scatter | None = None) -> Interval:
    """The values scatter as given, else as they do themselves. NaN values are left out."""
    values = _known(values)
    if not values:
        return Interval(math.nan, math.nan)
    return _interval(statistics.mean(values), *_variance_of_mean(values, scatter))


def difference_of(values: Sequence[float], reference: Sequence[float], scatter: Scatter | None = None) -> Interval:
    """Of the means. The values scatter as given, else as they do themselves; the reference scatters by itself (Welch).
    NaN values are left out."""
    values, reference = _known(values), _known(reference)
    if not values or not reference:
        return Interval(math.nan, math.nan)
    parts = [_variance_of_mean(values, scatter), _variance_of_mean(reference, None)]
    total = sum(variance for variance, _ in parts)
    freedom = total ** 2 / sum(variance ** 2 / freedom for variance, freedom in parts) if total else math.nan
    return _interval(statistics.mean(values) - statistics.mean(reference), total, freedom)


def difference_within(scatter: Scatter | None, values: Sequence[float], reference: Sequence[float]) -> Interval:
    """Of the means of two groups that share this scatter; each scatters by itself if there is none."""
    values, reference = _known(values), _known(reference)
    if scatter is None or not values or not reference:
        return difference_of(values, reference)
    return _interval(statistics.mean(values) - statistics.mean(reference),
                     scatter.deviation ** 2 * (1. / len(values) + 1. / len(reference)), scatter.freedom)
