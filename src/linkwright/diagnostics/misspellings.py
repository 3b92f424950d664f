"""Finds the known name of which another name is a misspelling, never a sibling's name.

``wheel_2`` is not a misspelling of ``wheel_1``, nor is ``lwheel`` of ``rwheel``, or ``stopKp`` of ``stopKd``: they name
different parts, and a fix that confuses them breaks the robot.
"""

from __future__ import annotations

from collections.abc import Iterable

from linkwright.diagnostics.suggest import is_misspelt, words_of

_SHORTEST = 3
"""Shorter words, such as ``fl`` and ``fr`` of wheels, are never taken for misspellings of each other."""


def misspelling_of(name: str, known: Iterable[str]) -> str | None:
    """Return the known name that is misspelt, or None.

    It is None if there is no such name, or if several with different words are possible.
    """
    meant = [each for each in known if each != name and _is_slip(name, each)]
    return meant[0] if len({"".join(words_of(item)) for item in meant}) == 1 else None


def _is_slip(name: str, known: str) -> bool:
    """Return whether two names differ only in case, separators or a typing error in a word."""
    words, others = words_of(name), words_of(known)
    if not words or not others:
        return False
    if "".join(words) == "".join(others):
        return True
    if len(words) != len(others):
        # A separator may be missing, and a letter in addition.
        return _is_slip_of_word("".join(words), "".join(others)) and not any(map(str.isdigit, name + known))
    different = [pair for pair in zip(words, others, strict=True) if pair[0] != pair[1]]
    return len(different) == 1 and _is_slip_of_word(*different[0])


def _is_slip_of_word(word: str, known: str) -> bool:
    return (
        min(len(word), len(known)) >= _SHORTEST
        and not word.isdigit()
        and not known.isdigit()
        and word[0] == known[0]
        and is_misspelt(word, [known])
    )
