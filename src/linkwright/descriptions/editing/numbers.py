"""The formatting and parsing of numbers in descriptions."""

from __future__ import annotations

from fractions import Fraction
from math import degrees, isfinite, pi

EXACT = 1e-9
"""The smallest difference that counts, in m or rad."""
_EXACT_DEGREES = 5e-8
_MOST_DIGITS = 15
_PARTS_OF_PI = (1, 2, 3, 4, 6, 12)


def shortest(value: float, tolerance: float = EXACT) -> str:
    """Return a number as text with as few digits as possible, without an exponent.

    Args:
        value: a finite number.
        tolerance: the maximum error.
    """
    for digits in range(_MOST_DIGITS):
        text = f"{value:.{digits}f}"
        if abs(float(text) - value) <= tolerance:
            return "0" if float(text) == 0 else text
    return repr(value)


def same(some: float, other: float) -> bool:
    """Return whether two numbers are equal within the tolerance `EXACT`."""
    return abs(some - other) <= EXACT


def numbers_of(text: str, count: int) -> list[float] | None:
    """Return the numbers of an attribute, or None unless there are `count` finite numbers."""
    try:
        found = [float(word) for word in text.split()]
    except ValueError:
        return None
    return found if len(found) == count and all(map(isfinite, found)) else None


def part_of_pi(angle: float) -> str | None:
    """Return an angle as an expression such as ``-pi/2`` or ``3*pi/4``.

    The result is None if the angle is not such a fraction of pi.
    """
    for parts in _PARTS_OF_PI:
        whole = round(angle / pi * parts)
        if whole and same(whole * pi / parts, angle) and Fraction(whole, parts).denominator == parts:
            factor = {1: "", -1: "-"}.get(whole, f"{whole}*")
            return f"{factor}pi" if parts == 1 else f"{factor}pi/{parts}"
    return None


def in_degrees(angle: float) -> str | None:
    """Return an angle as a text in degrees, for ``radians()``, or None if the text is not short."""
    text = shortest(degrees(angle), _EXACT_DEGREES)
    return text if len(text.lstrip("-").replace(".", "")) <= 5 else None
