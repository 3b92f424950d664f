"""The search for the existing name that another name misspells.

The name of a sibling is not a misspelling: ``wheel_2`` does not misspell ``wheel_1``, and ``stopKp`` does not misspell
``stopKd``. Such names denote different parts, and a fix that confuses the names breaks the robot.
"""

from __future__ import annotations

from collections.abc import Iterable

from linkwright.diagnostics.suggest import is_misspelled, words_of

_MIN_LENGTH = 3
"""The minimum length of a word that can be misspelled. Shorter words, such as ``fl`` and ``fr``, differ on purpose."""


def find_misspelled(name: str, names: Iterable[str]) -> str | None:
    """Return the existing name that a name misspells, or None.

    The result is None if there is no such name, or if there are several names with different words.
    """
    candidates = [candidate for candidate in names if candidate != name and _is_misspelling(name, candidate)]
    return candidates[0] if len({"".join(words_of(item)) for item in candidates}) == 1 else None


def _is_misspelling(name: str, known_name: str) -> bool:
    """Return whether two names differ only in case, separators, or a typing error in one word."""
    words, known_words = words_of(name), words_of(known_name)
    if not words or not known_words:
        return False
    if "".join(words) == "".join(known_words):
        return True
    if len(words) != len(known_words):
        # Either a separator is missing, or there is also a typing error.
        return _is_misspelled_word("".join(words), "".join(known_words)) and not any(
            map(str.isdigit, name + known_name)
        )
    differing_pairs = [pair for pair in zip(words, known_words, strict=True) if pair[0] != pair[1]]
    return len(differing_pairs) == 1 and _is_misspelled_word(*differing_pairs[0])


def _is_misspelled_word(word: str, known_name: str) -> bool:
    return (
        min(len(word), len(known_name)) >= _MIN_LENGTH
        and not word.isdigit()
        and not known_name.isdigit()
        and word[0] == known_name[0]
        and is_misspelled(word, [known_name])
    )
