"""Selectors: what settings, suppressing comments and the command line name rules by.

A selector is the code of a rule or of another diagnostic (``LW201``), the beginning of one (``LW2``), the name of a
rule (``limit-inverted``), or ``ALL``.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

from linkwright.diagnostics import nearest
from linkwright.lint.registry import all_rules, find_rule

ALL = "ALL"
_CODE = re.compile("[A-Z]+[0-9]{0,3}").fullmatch
_OWN = "LW"


def is_selector(word: str) -> bool:
    """Whether a word can select findings."""
    if word == ALL or find_rule(word) is not None:
        return True
    if not _CODE(word):
        return False
    if word.startswith(_OWN):
        return any(rule.code.startswith(word) for rule in all_rules())
    from linkwright.lint.explain import known_codes

    return any(code.startswith(word) for code in known_codes())


def canonical(word: str) -> str:
    """A selector as the rest compares it: a rule's code for its name, otherwise as it is."""
    rule = find_rule(word)
    return rule.code if rule else word


def selector_hint(word: str) -> str:
    """What to say of a word that selects nothing."""
    candidates = [name for rule in all_rules() for name in (rule.name, rule.code)]
    near = nearest(word, candidates, limit=1)
    if near:
        return f"did you mean '{near[0]}'?"
    return "give a code such as LW201, the beginning of one, or the name of a rule"


def matches(selectors: Iterable[str], code: str) -> bool:
    """Whether one of the (canonical) selectors means a code."""
    return specificity(selectors, code) > 0


def specificity(selectors: Iterable[str], code: str) -> int:
    """How closely the closest of (canonical) selectors means a code: 0 not at all, 1 by ALL, more for more letters."""
    return max((_closeness(selector, code) for selector in selectors), default=0)


def _closeness(selector: str, code: str) -> int:
    if selector == ALL:
        return 1
    return len(selector) + 1 if code.startswith(selector) else 0
