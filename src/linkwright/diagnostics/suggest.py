"""Searches for similar names, which hints suggest."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Sequence

from linkwright.diagnostics.phrase import Phrase, joined, phrase, quoted_names
from linkwright.diagnostics.render import display_path
from linkwright.loading.lean_typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

_LISTED = 8
_ADDRESSES = ("http:", "https:", "ftp:")
_ADDRESS = r"(?:^|/)((?:https?|ftp):)/+(.+)"  # compiled only on use, because few commands need it
_MOST_COMPARED = 1_000
"""Of more names than these, only those are compared that begin alike and are about as long."""
_WORD = r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+|[^\W\d_]+"
_SHORT = 2
"""Words of so few letters cannot be recognised after a typing error, except after two swapped letters."""


def nearest(name: str, candidates: Iterable[str], limit: int = 3) -> list[str]:
    """Return the candidates that `name` may be meant to be, best first, ignoring case.

    A common word, as in the names of two robots' descriptions, is not enough: the names may only differ by typing
    errors, missing words, or the order of words.
    """
    from difflib import get_close_matches  # imported here, because most commands need no hint

    by_fold: dict[str, str] = {}
    for candidate in candidates:
        by_fold.setdefault(candidate.casefold(), candidate)
    folded = name.casefold()
    near: Iterable[str] = by_fold
    if len(by_fold) > _MOST_COMPARED:
        near = [other for other in by_fold if abs(len(other) - len(folded)) < 3 and other[:2] == folded[:2]]
        near = near[:_MOST_COMPARED]
    close = get_close_matches(folded, near, n=4 * limit, cutoff=0.6)
    return [by_fold[match] for match in close if _is_alike(name, by_fold[match])][:limit]


def words_of(name: str) -> list[str]:
    """Return the words of a name in lower case, split at separators, capitals and numbers."""
    return [word.casefold() for word in re.findall(_WORD, name)]


def _is_alike(name: str, other: str) -> bool:
    """Return whether one name may be meant to be another.

    The words that they do not share must be typing errors, or extra words of one of them.
    """
    words, others = words_of(name), words_of(other)
    if "".join(words) == "".join(others):
        return True
    own = list(words)
    theirs = []
    for word in others:
        if word in own:
            own.remove(word)
        else:
            theirs.append(word)
    if not own or not theirs:
        return len(own) + len(theirs) < len(words) + len(others)
    if len(own) == len(theirs):
        return all(any(_is_slip(word, meant) for meant in theirs) for word in own)
    return _is_slip("".join(own), "".join(theirs))


def _is_slip(word: str, meant: str) -> bool:
    """Return whether a word is a misspelling or abbreviation of another; numbers never are."""
    shorter, longer = sorted((word, meant), key=len)
    if word.isdigit() or meant.isdigit():
        return False
    if len(longer) == len(shorter) and sorted(word) == sorted(meant):
        return _is_within(word, meant, 1 + len(word) // 4)
    if word[0] == meant[0] and _is_abbreviation(shorter, longer):
        return True
    if len(shorter) <= _SHORT or (len(shorter) == len(longer) and word[0] != meant[0]):
        return False
    return longer.startswith(shorter) or _is_within(word, meant, max(1, len(longer) // 3))


def _is_abbreviation(shorter: str, longer: str) -> bool:
    """Return whether a word is another one without some letters, such as ``cnt`` of ``count``.

    At most half of the letters may be omitted.
    """
    letters = iter(longer)
    return len(shorter) < len(longer) <= 2 * len(shorter) and all(letter in letters for letter in shorter)


def is_misspelt(name: str, names: Iterable[str]) -> bool:
    """Return whether a name differs from another by a missing, extra, wrong or swapped letter.

    Long names may have more errors, one more for every ten letters.
    """
    return any(_is_within(name, other, 1 + len(name) // 10) for other in names)


def _is_within(one: str, other: str, most: int) -> bool:
    """Return whether two texts differ by at most `most` errors.

    Errors are counted by the optimal string alignment distance.
    """
    if abs(len(one) - len(other)) > most:
        return False
    before: list[int] = []
    row = list(range(len(other) + 1))
    for i, letter in enumerate(one):
        before_that, before, row = before, row, [i + 1]
        for j, theirs in enumerate(other):
            cost = min(before[j + 1] + 1, row[j] + 1, before[j] + (letter != theirs))
            if i and j and letter == other[j - 1] and one[i - 1] == theirs:
                cost = min(cost, before_that[j - 1] + 1)
            row.append(cost)
        if min(row) > most:
            return False
    return row[-1] <= most


def did_you_mean(name: str, candidates: Iterable[str]) -> Phrase | None:
    """Return a hint such as ``did you mean 'radius'?``, or None if no candidate is similar."""
    return _meant(nearest(name, candidates))


def _meant(names: Sequence[str]) -> Phrase | None:
    return phrase("did you mean {names}?", names=quoted_names(names, " or ")) if names else None


def _like(name: str, names: Iterable[str]) -> list[str]:
    """Return the file names that may be meant, compared without extension.

    The extensions must match, too: 'a.urdf' is not like 'robot.urdf'.
    """
    stem, ending = _parts(name)
    stems: dict[str, list[str]] = {}
    for other in names:
        its_stem, its_ending = _parts(other)
        if its_ending == ending or (ending and (is_misspelt(ending, [its_ending]) or its_ending.endswith(ending))):
            stems.setdefault(its_stem, []).append(other)
    return [other for near in nearest(stem, stems) for other in stems[near]][:3]


def _parts(name: str) -> tuple[str, str]:
    """Split the name of a file into stem and extension.

    The extension of 'robot.urdf.xacro' is '.urdf.xacro'.
    """
    dot = name.find(".", 1)
    return (name, "") if dot < 0 else (name[:dot], name[dot:])


def as_typed(path: str | os.PathLike[str]) -> str:
    """Return a path as its user typed it.

    A URL that was treated as a path gets its second slash back.
    """
    shown = os.fspath(path)
    address = re.search(_ADDRESS, shown)
    return shown if address is None else f"{address[1]}//{address[2]}"


def missing_file_hint(path: Path, wanted: Callable[[str], bool] | None = None) -> Phrase:
    """Return a hint for a missing file.

    It names the missing folder, the nearest file names there, or all file names there.

    Args:
        path: the path of the missing file.
        wanted: a predicate for names that may be meant; by default names with the same extension.
    """
    if any(part in path.parts for part in _ADDRESSES):
        return phrase("files are not fetched from the network: download the file, and give its path")
    folder = path.parent
    if wanted is None:

        def wanted(name: str) -> bool:
            return name.endswith(path.suffix)

    try:
        names = sorted(entry.name for entry in folder.iterdir() if entry.is_file())
    except OSError:
        return phrase(
            "the folder '{folder}' does not exist; the current folder is '{current}'",
            folder=display_path(folder),
            current=os.getcwd(),  # noqa: PTH109 - pathlib takes long to import
        )
    like = _meant(_like(path.name, names))
    if like:
        return like
    there = [name for name in names if wanted(name)][:_LISTED]
    if there:
        return phrase("choose from {names}", names=joined(there))
    return phrase("the current folder is '{current}'", current=os.getcwd())  # noqa: PTH109 - as above
