"""Selectors, by which settings, suppression comments and the command line select findings.

A selector is the code of a rule or of another diagnostic (``LW201``), the beginning of a code (``LW2``), the name
of a rule (``limit-inverted``), or ``ALL``.
"""

from __future__ import annotations

from collections.abc import Iterable

ALL = "ALL"


def matches(selectors: Iterable[str], code: str) -> bool:
    """Return whether at least one of the canonical selectors matches a code."""
    return specificity(selectors, code) > 0


def specificity(selectors: Iterable[str], code: str) -> int:
    """Return the specificity of the best match between canonical selectors and a code.

    The result is 0 for no match, 1 for ``ALL``, and more for a longer selector.
    """
    return max((_specificity(selector, code) for selector in selectors), default=0)


def _specificity(selector: str, code: str) -> int:
    if selector == ALL:
        return 1
    return len(selector) + 1 if code.startswith(selector) else 0
