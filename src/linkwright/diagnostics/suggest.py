"""The search for similar names to suggest in hints."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Sequence
from functools import lru_cache

from linkwright.diagnostics.phrase import Phrase, joined, phrase, quoted_names
from linkwright.diagnostics.render import display_path
from linkwright.loading.lean_typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

_MAX_LISTED = 8
_URL_SCHEMES = ("http:", "https:", "ftp:")
_URL_PATTERN = r"(?:^|/)((?:https?|ftp):)/+(.+)"  # compiled only on use, because few commands need it
_MAX_CANDIDATES = 1_000
"""The maximum number of names to compare. More names are filtered by beginning and length."""
_WORD_PATTERN = r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+|[^\W\d_]+"
_MAX_SHORT_LENGTH = 2
"""The length up to which a word is a misspelling only if letters are swapped or omitted."""


def nearest(name: str, candidates: Iterable[str], limit: int = 3) -> list[str]:
    """Return the candidates that are most similar to a name, ignoring case, the best first.

    A common word, as in the names of two robots, is not enough: the names may only differ by typing errors, by missing
    words, or in the order of words.
    """
    return list(_find_nearest(name, tuple(candidates), limit))


@lru_cache(maxsize=256)
def _find_nearest(name: str, candidates: tuple[str, ...], limit: int) -> tuple[str, ...]:
    """Return the result of `nearest`.

    The result is cached, because a description may use a missing property very often.
    """
    from difflib import get_close_matches  # imported here, because most commands need no hint

    by_fold: dict[str, str] = {}
    for candidate in candidates:
        by_fold.setdefault(candidate.casefold(), candidate)
    folded = name.casefold()
    comparable: Iterable[str] = by_fold
    if len(by_fold) > _MAX_CANDIDATES:
        comparable = [other for other in by_fold if abs(len(other) - len(folded)) < 3 and other[:2] == folded[:2]]
        comparable = comparable[:_MAX_CANDIDATES]
    matches = get_close_matches(folded, comparable, n=4 * limit, cutoff=0.6)
    return tuple(by_fold[match] for match in matches if _is_similar(name, by_fold[match]))[:limit]


def words_of(name: str) -> list[str]:
    """Return the words of a name in lower case, split at separators, capitals and numbers."""
    return [word.casefold() for word in re.findall(_WORD_PATTERN, name)]


def _is_similar(name: str, other: str) -> bool:
    """Return whether a name may be a misspelling of another name.

    The words that the names do not share must be typing errors, or be extra words of one name.
    """
    words, others = words_of(name), words_of(other)
    if "".join(words) == "".join(others):
        return True
    only_in_name = list(words)
    only_in_other = []
    for word in others:
        if word in only_in_name:
            only_in_name.remove(word)
        else:
            only_in_other.append(word)
    if not only_in_name or not only_in_other:
        return len(only_in_name) + len(only_in_other) < len(words) + len(others)
    if len(only_in_name) == len(only_in_other):
        return all(any(_is_misspelling(word, other_word) for other_word in only_in_other) for word in only_in_name)
    return _is_misspelling("".join(only_in_name), "".join(only_in_other))


def _is_misspelling(word: str, other: str) -> bool:
    """Return whether a word misspells or abbreviates another word.

    A number neither misspells nor abbreviates another word.
    """
    shorter, longer = sorted((word, other), key=len)
    if word.isdigit() or other.isdigit():
        return False
    if len(longer) == len(shorter) and sorted(word) == sorted(other):
        return _is_within(word, other, 1 + len(word) // 4)
    if word[0] == other[0] and _is_abbreviation(shorter, longer):
        return True
    if len(shorter) <= _MAX_SHORT_LENGTH or (len(shorter) == len(longer) and word[0] != other[0]):
        return False
    return longer.startswith(shorter) or _is_within(word, other, max(1, len(longer) // 3))


def _is_abbreviation(shorter: str, longer: str) -> bool:
    """Return whether a word abbreviates another by omitting letters, as ``cnt`` for ``count``.

    At most half of the letters may be omitted.
    """
    letters = iter(longer)
    return len(shorter) < len(longer) <= 2 * len(shorter) and all(letter in letters for letter in shorter)


def is_misspelled(name: str, names: Iterable[str]) -> bool:
    """Return whether a name is equal to one of some names, except for a typing error.

    The error is a missing, extra, wrong or swapped letter. Long names may have more errors, one more for every ten
    letters.
    """
    return any(_is_within(name, other, 1 + len(name) // 10) for other in names)


def _is_within(first: str, second: str, max_edits: int) -> bool:
    """Return whether two texts differ by at most `max_edits` edits.

    Edits are counted by the optimal string alignment distance.
    """
    if abs(len(first) - len(second)) > max_edits:
        return False
    previous_row: list[int] = []
    row = list(range(len(second) + 1))
    for i, letter in enumerate(first):
        row_before_previous, previous_row, row = previous_row, row, [i + 1]
        for j, other_letter in enumerate(second):
            cost = min(previous_row[j + 1] + 1, row[j] + 1, previous_row[j] + (letter != other_letter))
            if i and j and letter == second[j - 1] and first[i - 1] == other_letter:
                cost = min(cost, row_before_previous[j - 1] + 1)
            row.append(cost)
        if min(row) > max_edits:
            return False
    return row[-1] <= max_edits


def did_you_mean(name: str, candidates: Iterable[str]) -> Phrase | None:
    """Return a hint such as ``did you mean 'radius'?``, or None if no candidate is similar."""
    return _did_you_mean(nearest(name, candidates))


def _did_you_mean(names: Sequence[str]) -> Phrase | None:
    return phrase("did you mean {names}?", names=quoted_names(names, " or ")) if names else None


def _find_in_neighboring_folder(path: Path) -> Path | None:
    """Return the file of the same name one folder below or above a missing file, or None."""
    folder = path.parent
    try:
        folders = [*sorted(folder.iterdir())[:_MAX_CANDIDATES], folder.parent]
    except OSError:
        return None
    candidates = (other / path.name for other in folders)
    return next((file for file in candidates if os.path.isfile(file)), None)  # noqa: PTH113 - is_file() raises for EACCES


def _find_similar_files(name: str, names: Iterable[str]) -> list[str]:
    """Return at most three file names that are similar to a name, compared without extensions.

    The extensions must be similar as well: 'a.urdf' is not similar to 'robot.urdf'.
    """
    stem, extension = _split_extension(name)
    stems: dict[str, list[str]] = {}
    for other in names:
        other_stem, other_extension = _split_extension(other)
        if other_extension == extension or (
            extension and (is_misspelled(extension, [other_extension]) or other_extension.endswith(extension))
        ):
            stems.setdefault(other_stem, []).append(other)
    return [other for similar_stem in nearest(stem, stems) for other in stems[similar_stem]][:3]


def _split_extension(name: str) -> tuple[str, str]:
    """Split the name of a file into stem and extension.

    The extension of 'robot.urdf.xacro' is '.urdf.xacro'.
    """
    dot = name.find(".", 1)
    return (name, "") if dot < 0 else (name[:dot], name[dot:])


def as_typed(path: str | os.PathLike[str]) -> str:
    """Return a path as the user typed it.

    A URL that was handled as a path gets its second slash back.
    """
    path_text = os.fspath(path)
    match = re.search(_URL_PATTERN, path_text)
    return path_text if match is None else f"{match[1]}//{match[2]}"


def missing_file_hint(path: Path, is_candidate: Callable[[str], bool] | None = None) -> Phrase:
    """Return a hint for a file that does not exist.

    The hint names the missing folder, or similar file names in the folder, or other files there.

    Args:
        path: the path of the missing file.
        is_candidate: a function that returns whether a file name in the folder can be suggested; None for names with
            the same extension.
    """
    if any(part in path.parts for part in _URL_SCHEMES):
        return phrase("files are not fetched from the network: download the file, and give its path")
    if "package:" in path.parts:
        package = path.parts[path.parts.index("package:") + 1 :][:1]
        return phrase(
            "write $(find {package}) in place of package://{package}", package=package[0] if package else "..."
        )
    if any(part.startswith("(find ") for part in path.parts):
        return phrase("write a dollar sign before '(find ...)'")
    folder = path.parent
    if is_candidate is None:

        def is_candidate(name: str) -> bool:
            return name.endswith(path.suffix)

    try:
        names = sorted(entry.name for entry in folder.iterdir() if entry.is_file())
    except OSError:
        return phrase(
            "the folder '{folder}' does not exist; the current folder is '{current}'",
            folder=display_path(folder),
            current=os.getcwd(),  # noqa: PTH109 - pathlib takes long to import
        )
    suggestion = _did_you_mean(_find_similar_files(path.name, names))
    if suggestion:
        return suggestion
    if elsewhere := _find_in_neighboring_folder(path):
        return phrase("did you mean '{name}'?", name=display_path(elsewhere))
    listed_names = [name for name in names if is_candidate(name)][:_MAX_LISTED]
    if listed_names:
        return phrase("choose from {names}", names=joined(listed_names))
    return phrase("the current folder is '{current}'", current=os.getcwd())  # noqa: PTH109 - as above
