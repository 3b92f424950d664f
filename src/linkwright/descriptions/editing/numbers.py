"""Format and parse numbers in descriptions."""

from __future__ import annotations

from fractions import Fraction
from math import degrees, isfinite, pi

EXACT = 1e-9
"""The difference up to which two numbers are equal, in m or rad."""
_EXACT_DEGREES = 5e-8
_MAX_DIGITS = 15
_PI_DENOMINATORS = (1, 2, 3, 4, 6, 12)


def shortest_text(value: float, tolerance: float = EXACT) -> str:
    """Return a number as text with as few digits as possible, without an exponent.

    Args:
        value: a finite number.
        tolerance: the maximum error.
    """
    for digits in range(_MAX_DIGITS):
        text = f"{value:.{digits}f}"
        if abs(float(text) - value) <= tolerance:
            return "0" if float(text) == 0 else text
    return repr(value)


def are_close(first: float, second: float) -> bool:
    """Return whether two numbers are equal within the tolerance `EXACT`."""
    return abs(first - second) <= EXACT


def parse_numbers(text: str, count: int) -> list[float] | None:
    """Return the numbers of an attribute, or None unless there are `count` finite numbers."""
    try:
        values = [float(word) for word in text.split()]
    except ValueError:
        return None
    return values if len(values) == count and all(map(isfinite, values)) else None


def format_pi_fraction(angle: float) -> str | None:
    """Return an angle as an expression such as ``-pi/2`` or ``3*pi/4``.

    The result is None if the angle is not such a fraction of pi.
    """
    for denominator in _PI_DENOMINATORS:
        numerator = round(angle / pi * denominator)
        if (
            numerator
            and are_close(numerator * pi / denominator, angle)
            and Fraction(numerator, denominator).denominator == denominator
        ):
            factor = {1: "", -1: "-"}.get(numerator, f"{numerator}*")
            return f"{factor}pi" if denominator == 1 else f"{factor}pi/{denominator}"
    return None


def format_degrees(angle: float) -> str | None:
    """Return an angle as a short text in degrees, for ``radians()``, or None."""
    text = shortest_text(degrees(angle), _EXACT_DEGREES)
    return text if len(text.lstrip("-").replace(".", "")) <= 5 else None
