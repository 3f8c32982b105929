"""Numbers with units, as a reader wants to see them."""

from __future__ import annotations

from math import floor, isfinite, log10

THIN_SPACE = "\u202f"  # between groups of digits
SPACE = "\u00a0"  # between a number and its unit
MINUS = "\u2212"

MASS = [(1e-9, "µg"), (1e-6, "mg"), (1e-3, "g"), (1., "kg")]  # of 1 kg
FORCE = [(1e-9, "nN"), (1e-6, "µN"), (1e-3, "mN"), (1., "N")]
TIME = [(1., "s"), (60., "min"), (3600., "h")]


def unit_for(largest: float, units: list[tuple[float, str]]) -> tuple[float, str]:
    """The unit in which the largest of some values is at least 1, and the unit's size."""
    fitting = [unit for unit in units if abs(largest) >= unit[0]]
    return fitting[-1] if fitting else units[0]


def number(value: float, digits: int = 3) -> str:
    """A number with so many significant digits, without an exponent if that is readable."""
    if not isfinite(value):
        return "–"
    if value == 0.:
        return "0"
    exponent = floor(log10(abs(value)))
    if -4 <= exponent < 7:
        text = f"{round(value, digits - 1 - exponent):,.{max(0, digits - 1 - exponent)}f}"
        if "." in text:
            text = text.rstrip("0").rstrip(".")
        return text.replace(",", THIN_SPACE).replace("-", MINUS)
    factor, power = f"{value:.{digits - 1}e}".split("e")
    factor = factor.rstrip("0").rstrip(".")
    raised = str(int(power)).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
    return f"{factor}{SPACE}×{SPACE}10{raised}".replace("-", MINUS)


def count(value: float) -> str:
    return f"{int(value):,}".replace(",", THIN_SPACE)


def with_unit(value: float, units: list[tuple[float, str]], digits: int = 3) -> str:
    size, name = unit_for(value, units)
    return f"{number(value / size, digits)}{SPACE}{name}"


def mass(kilograms: float) -> str:
    return with_unit(kilograms, MASS)


def duration(seconds: float) -> str:
    return with_unit(seconds, TIME)


def length(metres: float) -> str:
    """In mm, or in µm below 0.2 mm."""
    if abs(metres) < 0.2e-3:
        return f"{number(1e6 * metres)}{SPACE}µm"
    return f"{number(1e3 * metres)}{SPACE}mm"


def percent(fraction: float, decimals: int = 1) -> str:
    return f"{100. * fraction:.{decimals}f}{SPACE}%".replace("-", MINUS)
