"""Selectors: the words by which settings, suppression comments and the command line name rules.

A selector is the code of a rule or of another diagnostic (``LW201``), the beginning of one (``LW2``), the name of a
rule (``limit-inverted``), or ``ALL``.
"""

from __future__ import annotations

from collections.abc import Iterable

ALL = "ALL"


def matches(selectors: Iterable[str], code: str) -> bool:
    """Return whether one of the (canonical) selectors means a code."""
    return specificity(selectors, code) > 0


def specificity(selectors: Iterable[str], code: str) -> int:
    """How closely the closest of (canonical) selectors means a code: 0 not at all, 1 by ALL, more for more letters."""
    return max((_closeness(selector, code) for selector in selectors), default=0)


def _closeness(selector: str, code: str) -> int:
    if selector == ALL:
        return 1
    return len(selector) + 1 if code.startswith(selector) else 0
