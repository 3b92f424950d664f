"""Compare the commands of build files that are not facts for other packages, by their text."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from linkwright.diagnostics import Phrase, joined_first, phrase
from linkwright.review.changes import MAX_NAMES
from linkwright.review.file_pair import FilePair
from linkwright.review.texts.excerpts import shorten_middle
from linkwright.review.texts.list_changes import EMPTY, change_text

_MAX_OTHER_COMMANDS = 6
"""The maximum number of other commands whose text is shown."""
_MAX_TEXT_CHARACTERS = 200
_MIN_LONG_LIST_WORDS = 5
"""The minimum number of words of a command of which only the differing words are shown."""
_DOWNLOAD_COMMANDS = ("externalproject_add", "fetchcontent_declare")
"""The commands that download other projects, with a URL and a version after keywords."""
_KEYWORD = re.compile(r"(?!(?:TRUE|FALSE|OFF|YES)\Z)[A-Z][A-Z_]{2,}")
_ONE_VALUE_KEYWORDS = frozenset({"GIT_REPOSITORY", "GIT_TAG", "GIT_REMOTE_NAME", "HG_TAG", "SVN_REVISION", "CVS_TAG"})
"""The keywords that always have one value, which may be in capital letters, such as the name of a tag."""


def compare_other_commands(pair: FilePair, old: Sequence[tuple[str, str]], new: Sequence[tuple[str, str]]) -> None:
    """Report the commands that are not facts and that differ: a few as text, more of them by name.

    Args:
        pair: the versions of the build file.
        old: the names and arguments of the old commands.
        new: the names and arguments of the new commands.
    """
    removed, added = _find_unpaired_items(old, new), _find_unpaired_items(new, old)
    names = list(dict.fromkeys(name for name, _ in (*added, *removed)))
    if len(names) > _MAX_OTHER_COMMANDS:
        shown = joined_first([f"'{name}'" for name in names], MAX_NAMES)
        pair.add(phrase("other build settings changed: {names}", names=shown), None)
        return
    for name in names:
        old_texts, new_texts = ([text for other, text in items if other == name] for items in (removed, added))
        old_text, new_text = ("; ".join(filter(None, texts)) for texts in (old_texts, new_texts))
        if name in _DOWNLOAD_COMMANDS and len(old_texts) == len(new_texts) == 1:
            for text in _compare_keywords(name, old_text.split(), new_text.split()):
                pair.add(text, None)
        elif old_texts and new_texts:
            pair.add(_format_word_changes(name, old_text, new_text), None)
        elif new_texts:
            text = phrase(
                "{parameter} added: {items}", parameter=name, items=shorten_middle(new_text, _MAX_TEXT_CHARACTERS)
            )
            pair.add(text if new_text else phrase("{parameter} added", parameter=name), None)
        else:
            text = phrase(
                "{parameter} removed: {items}", parameter=name, items=shorten_middle(old_text, _MAX_TEXT_CHARACTERS)
            )
            pair.add(text if old_text else phrase("{parameter} removed", parameter=name), None)


def _compare_keywords(name: str, old_words: Sequence[str], new_words: Sequence[str]) -> Iterator[Phrase]:
    """Yield the changes to the arguments of a command after each keyword, such as ``GIT_TAG``."""
    old, new = _group_by_keyword(old_words), _group_by_keyword(new_words)
    for keyword in dict.fromkeys([*old, *new]):
        before, after = old.get(keyword), new.get(keyword)
        title = f"{name} {keyword}".strip()
        if before == after:
            continue
        if before or after:
            yield change_text(title, before or EMPTY, after or EMPTY)
        elif before is None:
            yield phrase("{parameter} added", parameter=title)
        else:
            yield phrase("{parameter} removed", parameter=title)


def _group_by_keyword(words: Sequence[str]) -> dict[str, str]:
    """Return the arguments by the keyword before them; an empty keyword for the first ones."""
    values: dict[str, list[str]] = {}
    keyword = ""
    for word in words:
        is_value = keyword in _ONE_VALUE_KEYWORDS and not values[keyword]
        if _KEYWORD.fullmatch(word) and not is_value:
            keyword = word
            values.setdefault(keyword, [])
        else:
            values.setdefault(keyword, []).append(word)
    return {key: " ".join(items) for key, items in values.items()}


def _format_word_changes(name: str, old: str, new: str) -> Phrase:
    """Return the change to the arguments of a command.

    For long lists, only added and removed words are shown.
    """
    old_words, new_words = old.split(), new.split()
    added = [word for word in new_words if word not in old_words]
    removed = [word for word in old_words if word not in new_words]
    if min(len(old_words), len(new_words)) < _MIN_LONG_LIST_WORDS or not (added or removed):
        return change_text(name, old, new)
    return change_text(name, f"[{', '.join(dict.fromkeys(old_words))}]", f"[{', '.join(dict.fromkeys(new_words))}]")


def _find_unpaired_items(items: Sequence[tuple[str, str]], others: Sequence[tuple[str, str]]) -> list[tuple[str, str]]:
    unpaired_others = list(others)
    unpaired = []
    for item in items:
        if item in unpaired_others:
            unpaired_others.remove(item)
        else:
            unpaired.append(item)
    return unpaired
