"""Validate selectors, and return their canonical forms."""

from __future__ import annotations

from linkwright.diagnostics import Phrase, nearest, phrase, quoted_names
from linkwright.lint.registry import all_rules, find_rule
from linkwright.lint.selectors import ALL
from linkwright.loading.deferred import lazy_pattern

_CODE = lazy_pattern("[A-Z]+[0-9]{0,3}")


def is_selector(text: str) -> bool:
    """Return whether a text is a valid selector of findings."""
    if text == ALL or find_rule(text) is not None:
        return True
    if not _CODE.fullmatch(text):
        return False
    from linkwright.lint.explain import read_room_pages  # imported here because most checks have no selectors

    return any(rule.code.startswith(text) for rule in all_rules()) or any(
        code.startswith(text) for code in read_room_pages()
    )


def to_canonical(text: str) -> str:
    """Return the canonical form of a selector: the code instead of the name of a rule.

    Other texts are returned unchanged.
    """
    rule = find_rule(text)
    return rule.code if rule else text


def make_selector_hint(text: str) -> Phrase:
    """Return a hint on a text that is not a valid selector."""
    candidates = [name for rule in all_rules() for name in (rule.name, rule.code)]
    suggestions = nearest(text, candidates, limit=1)
    if suggestions:
        return phrase("did you mean {names}?", names=quoted_names(suggestions))
    return phrase("give a code such as LW201, the beginning of a code, or the name of a rule")
