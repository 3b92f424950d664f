"""Nearest names for hints."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING

from linkwright.diagnostics.phrase import Phrase, joined, phrase, quoted_names
from linkwright.diagnostics.render import display_path

if TYPE_CHECKING:
    from pathlib import Path

_LISTED = 8
_ADDRESSES = ("http:", "https:", "ftp:")
_MOST_COMPARED = 1_000
"""Of more names than these, only those are compared that begin alike and are about as long."""


def nearest(name: str, candidates: Iterable[str], limit: int = 3) -> list[str]:
    """The candidates most like `name`, best first; upper and lower case count as alike."""
    from difflib import get_close_matches  # here, because most runs of a command end without a hint

    by_fold: dict[str, str] = {}
    for candidate in candidates:
        by_fold.setdefault(candidate.casefold(), candidate)
    folded = name.casefold()
    near: Iterable[str] = by_fold
    if len(by_fold) > _MOST_COMPARED:
        near = [other for other in by_fold if abs(len(other) - len(folded)) < 3 and other[:2] == folded[:2]]
        near = near[:_MOST_COMPARED]
    return [by_fold[match] for match in get_close_matches(folded, near, n=limit, cutoff=0.6)]


def is_misspelt(name: str, names: Iterable[str]) -> bool:
    """Whether a name is one of others but for a letter: left out, added, another one, or swapped with its neighbour.

    In long names there may be more such slips, one for every ten letters.
    """
    return any(_is_within(name, other, 1 + len(name) // 10) for other in names)


def _is_within(one: str, other: str, most: int) -> bool:
    """Whether so many slips make one text of another (the distance called optimal string alignment)."""
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
    """A hint such as ``did you mean 'radius'?``, or None when no candidate is near."""
    return _meant(nearest(name, candidates))


def _meant(names: Sequence[str]) -> Phrase | None:
    return phrase("did you mean {names}?", names=quoted_names(names, " or ")) if names else None


def _like(name: str, names: Iterable[str]) -> list[str]:
    """The names of files that may be meant, by what stands before the ending: 'a.urdf' is not like 'robot.urdf'."""
    stem, ending = _parts(name)
    stems: dict[str, list[str]] = {}
    for other in names:
        its_stem, its_ending = _parts(other)
        if its_ending == ending or (ending and (is_misspelt(ending, [its_ending]) or its_ending.endswith(ending))):
            stems.setdefault(its_stem, []).append(other)
    return [other for near in nearest(stem, stems) for other in stems[near]][:3]


def _parts(name: str) -> tuple[str, str]:
    """The name of a file without its ending, and the ending: that of 'robot.urdf.xacro' is '.urdf.xacro'."""
    dot = name.find(".", 1)
    return (name, "") if dot < 0 else (name[:dot], name[dot:])


def missing_file_hint(path: Path, wanted: Callable[[str], bool] | None = None) -> Phrase:
    """A hint for a missing file: the missing folder, the nearest names beside it, or all names there.

    Args:
        path: of the file.
        wanted: which names may be meant; those with the same ending when left out.
    """
    if any(part in path.parts for part in _ADDRESSES):
        return phrase("files are not fetched from the network: download it, and name the file")
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
        return phrase("there are: {names}", names=joined(there))
    return phrase("the current folder is '{current}'", current=os.getcwd())  # noqa: PTH109 - as above
