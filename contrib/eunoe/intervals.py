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


def mean_of(values: Sequence[float]) -> Interval:
    """NaN values are left out."""
    known = [value for value in values if not math.isnan(value)]
    if len(known) < 2:
        return Interval(known[0] if known else math.nan, math.nan)
    half = quantile(len(known) - 1) * statistics.stdev(known) / math.sqrt(len(known))
    return Interval(statistics.mean(known), half or math.nan)


def difference_of(values: Sequence[float], reference: Sequence[float]) -> Interval:
    """Of the means; both may scatter differently. NaN values are left out."""
    values, reference = ([value for value in group if not math.isnan(value)] for group in (values, reference))
    if not values or not reference:
        return Interval(math.nan, math.nan)
    difference = statistics.mean(values) - statistics.mean(reference)
    if min(len(values), len(reference)) < 2:
        return Interval(difference, math.nan)
    parts = [statistics.variance(group) / len(group) for group in (values, reference)]
    if sum(parts) == 0.:
        return Interval(difference, math.nan)
    freedom = sum(parts) ** 2 / sum(part**2 / (len(group) - 1)
                                    for part, group in zip(parts, (values, reference)))
    return Interval(difference, quantile(freedom) * math.sqrt(sum(parts)))
