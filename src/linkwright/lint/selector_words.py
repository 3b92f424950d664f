"""The validation of selectors, and their canonical forms."""

from __future__ import annotations

from linkwright.diagnostics import Phrase, nearest, phrase, quoted_names
from linkwright.lint.registry import all_rules, find_rule
from linkwright.lint.selectors import ALL
from linkwright.loading.deferred import lazy_pattern

_CODE = lazy_pattern("[A-Z]+[0-9]{0,3}")


def is_selector(word: str) -> bool:
    """Return whether a word is a valid selector of findings."""
    if word == ALL or find_rule(word) is not None:
        return True
    if not _CODE.fullmatch(word):
        return False
    from linkwright.lint.explain import room_pages  # imported here because most checks have no selectors

    return any(rule.code.startswith(word) for rule in all_rules()) or any(
        code.startswith(word) for code in room_pages()
    )


def canonical(word: str) -> str:
    """Return the canonical form of a selector, which is a code for the name of a rule.

    Other words are returned unchanged.
    """
    rule = find_rule(word)
    return rule.code if rule else word


def selector_hint(word: str) -> Phrase:
    """Return a hint on a word that is not a valid selector."""
    candidates = [name for rule in all_rules() for name in (rule.name, rule.code)]
    near = nearest(word, candidates, limit=1)
    if near:
        return phrase("did you mean {names}?", names=quoted_names(near))
    return phrase("give a code such as LW201, the beginning of one, or the name of a rule")
