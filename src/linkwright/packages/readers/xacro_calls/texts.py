"""Texts with placeholders, as in launch files, and the possible values of the placeholders."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import combinations, islice

from linkwright.loading.lean_dataclasses import dataclass, field, replace
from linkwright.loading.lean_typing import Union

_MAX_DEPTH = 12
_MAX_SELECTIONS = 64
_SHARE_DELIMITER = "\0"
MAX_VARIATIONS = 24
"""The maximum number of variations, and of pairs of variations. The rest are omitted."""


@dataclass(frozen=True, slots=True)
class Share:
    """A piece of a text that represents the share folder of a package.

    Attributes:
        package: the name of the package, which may itself contain placeholders.
    """

    package: Text


@dataclass(frozen=True, slots=True)
class Placeholder:
    """A placeholder in a text for a value that is determined when the program runs.

    Attributes:
        choice: the name of the `Choice` that determines the value.
        column: the index of the value in the selected row.
        starts_component: whether the placeholder begins a component of a path. If its value is an absolute path, the
            value replaces everything before the placeholder.
    """

    choice: str
    column: int = 0
    starts_component: bool = False


Text = tuple[Union[str, Share, Placeholder], ...]  # noqa: UP007 - Python 3.10 cannot join a name that is not yet there
UNKNOWN = Placeholder("")
"""A placeholder with an unknown value."""


@dataclass(frozen=True, slots=True)
class Choice:
    """The possible values of placeholders that are filled together.

    Attributes:
        rows: the alternatives; the first is the default.
        is_certain: whether each row can occur together with any rows of other choices. If not, the choices may depend
            on each other, like the branches of an `if`.
    """

    rows: tuple[tuple[Text, ...], ...]
    is_certain: bool = True


@dataclass(slots=True)
class Selection:
    """The selected row of each choice.

    Attributes:
        rows: choice -> index of the selected row; the first row if the choice is missing.
        fixed_texts: choice -> the text for its placeholders, which takes precedence over its rows.
    """

    rows: Mapping[str, int] = field(default_factory=dict)
    fixed_texts: Mapping[str, str] = field(default_factory=dict)


def make_literal(text: str) -> Text:
    """Return a `Text` that consists of one literal string."""
    return (text,) if text else ()


def join_texts(parts: Iterable[Text]) -> Text:
    """Concatenate texts."""
    return tuple(piece for part in parts for piece in part)


def join_path(parts: Sequence[Text]) -> Text:
    """Join texts as components of a path.

    As in ``os.path.join``, an absolute component starts a new path.
    """
    path: Text = ()
    for part in parts:
        first = part[0] if part else ""
        if not path or isinstance(first, Share) or (isinstance(first, str) and first.startswith("/")):
            path = part or path
            continue
        if part and not (isinstance(path[-1], str) and path[-1].endswith("/")):
            path = (*path, "/")
        if isinstance(first, Placeholder) and first != UNKNOWN:
            part = (replace(first, starts_component=True), *part[1:])
        path = (*path, *part)
    return path


def resolve(text: Text, choices: Mapping[str, Choice], selection: Selection, depth: int = 0) -> str | None:
    """Fill the placeholders of a text, and return the string, or None if a value is missing.

    A share folder is written as its `make_share_mark`.
    """
    if depth > _MAX_DEPTH:
        return None
    strings: list[str] = []
    for piece in text:
        if isinstance(piece, str):
            strings.append(piece)
            continue
        content = piece.package if isinstance(piece, Share) else _select_text(piece, choices, selection)
        value = content if isinstance(content, str) else content and resolve(content, choices, selection, depth + 1)
        if value is None and content != ():
            return None
        string = make_share_mark(value or "") if isinstance(piece, Share) else value or ""
        if isinstance(piece, Placeholder) and piece.starts_component and string.startswith(("/", _SHARE_DELIMITER)):
            strings.clear()
        strings.append(string)
    return "".join(strings)


def make_share_mark(package: str) -> str:
    """Return the text that represents a package's share folder in the result of `resolve`."""
    return f"{_SHARE_DELIMITER}{package}{_SHARE_DELIMITER}"


def split_mark(path: str) -> tuple[str | None, str]:
    """Return the package and the rest of a resolved path that begins with a share folder.

    The package is None for any other path, which is returned unchanged.
    """
    if not path.startswith(_SHARE_DELIMITER):
        return None, path
    package, _, subpath = path[1:].partition(_SHARE_DELIMITER)
    return package, subpath


def _select_text(placeholder: Placeholder, choices: Mapping[str, Choice], selection: Selection) -> Text | str | None:
    if placeholder.choice in selection.fixed_texts:
        return selection.fixed_texts[placeholder.choice]
    choice = choices.get(placeholder.choice)
    if choice is None or not choice.rows:
        return None
    row = choice.rows[min(selection.rows.get(placeholder.choice, 0), len(choice.rows) - 1)]
    return row[placeholder.column] if placeholder.column < len(row) else None


def find_choices(text: Text, choices: Mapping[str, Choice], fixed_texts: Mapping[str, str]) -> list[str]:
    """Return the names of the choices that a text depends on, except names in `fixed_texts`."""
    names: dict[str, None] = {}
    pending: list[Text] = [text]
    while pending:
        for piece in pending.pop():
            if isinstance(piece, Share):
                pending.append(piece.package)
            elif isinstance(piece, Placeholder) and piece.choice not in names and piece.choice not in fixed_texts:
                choice = choices.get(piece.choice)
                if choice is not None:
                    names[piece.choice] = None
                    pending += [text for row in choice.rows for text in row]
    return list(names)


def generate_selections(
    text: Text, choices: Mapping[str, Choice], fixed_texts: Mapping[str, str]
) -> Iterator[Selection]:
    """Yield the selections of rows for the placeholders of a text, up to a maximum number."""
    row_combinations: list[dict[str, int]] = [{}]
    for name in find_choices(text, choices, fixed_texts):
        rows = range(len(choices[name].rows) or 1)
        row_combinations = [{**combination, name: row} for combination in row_combinations for row in rows][
            :_MAX_SELECTIONS
        ]
    return (Selection(rows, fixed_texts) for rows in row_combinations)


def generate_variations(
    texts: Iterable[Text], choices: Mapping[str, Choice], start: Selection
) -> Iterator[tuple[Selection, bool]]:
    """Yield selections of rows for several texts, each with whether it is known to occur.

    First, each row of each choice is selected, one choice at a time. Then pairs of rows follow, which might not occur
    together. Larger combinations are omitted, because there would be too many.
    """
    names = dict.fromkeys(name for text in texts for name in find_choices(text, choices, start.fixed_texts))
    unselected_names = [name for name in names if name not in start.rows and len(choices[name].rows) > 1]
    is_certain = all(choices[name].is_certain for name in unselected_names)
    yield start, is_certain
    alternatives = [(name, row) for name in unselected_names for row in range(1, len(choices[name].rows))]
    for name, row in alternatives[:MAX_VARIATIONS]:
        yield Selection({**start.rows, name: row}, start.fixed_texts), is_certain
    pairs = ((first, second) for first, second in combinations(alternatives, 2) if first[0] != second[0])
    for pair in islice(pairs, MAX_VARIATIONS):
        yield Selection({**start.rows, **dict(pair)}, start.fixed_texts), False
