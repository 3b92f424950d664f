"""Compare a quantity of a whole robot or model."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from linkwright.diagnostics import Phrase, phrase
from linkwright.review.changes import Figure

_RELATIVE_TOLERANCE = 1e-4
"""The maximum relative difference of equal quantities."""
_DIGITS = range(4, 8)
"""The numbers of digits to try for a quantity, until both versions differ."""
_LENGTH_TOLERANCE = 1e-4
"""The maximum difference in m of equal lengths."""


def compare_size(old: object, new: object) -> Iterator[Figure]:
    """Yield the size in m of a whole robot or model if it differs by more than the tolerance, as '1 x 2 x 3'."""
    yield from compare_quantity(phrase("size"), "m", old, new, separator=" x ")


def compare_quantity(name: Phrase, unit: str, old: object, new: object, *, separator: str = " ") -> Iterator[Figure]:
    """Yield a quantity if it differs by more than the tolerance.

    Quantities without a unit are counts. The separator is placed between the numbers of a quantity.
    """
    if old is None or new is None:
        return
    values = np.atleast_1d(np.asarray(old, float)), np.atleast_1d(np.asarray(new, float))
    tolerance = _LENGTH_TOLERANCE if unit == "m" else 0.0
    if not np.allclose(*values, rtol=_RELATIVE_TOLERANCE, atol=tolerance):
        formats = [f".{digits}g" for digits in _DIGITS] if unit else [".0f"]
        texts = [
            tuple(separator.join(format(number, form) for number in quantity) for quantity in values)
            for form in formats
        ]
        old_text, new_text = next((pair for pair in texts if pair[0] != pair[1]), texts[-1])
        yield Figure(name, old_text, new_text, unit)
