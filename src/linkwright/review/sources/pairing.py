"""Pair the old and new names in a source that probably mean the same thing."""

from __future__ import annotations

import itertools
import re
from collections import Counter
from collections.abc import Callable, Hashable, Iterator, Sequence
from difflib import SequenceMatcher

from linkwright.review.sources.details import has_same_parameters
from linkwright.review.sources.name_patterns import can_make
from linkwright.review.sources.names import NameKind, SourceName, SourceNames
from linkwright.review.texts.merging import name_edit

_MIN_SIMILARITY = 0.6
"""The minimum ratio of equal characters of similar names of the same kind."""
_MAX_COMPARED_PAIRS = 10_000
"""The maximum number of pairs of names among which similar names are searched."""
_UNTYPED_KINDS = (
    *(NameKind.PARAMETER, NameKind.ELEMENT, NameKind.HARDWARE_PARAMETER, NameKind.HARDWARE_ELEMENT),
    *(NameKind.CLASS, NameKind.FUNCTION, NameKind.OPTION, NameKind.YAML_KEY),
)
"""The kinds for which equal types do not suggest a rename."""


def _never_differ(_old: str, _new: str) -> bool:
    return False


def pair_similar(
    removed: Sequence[SourceName],
    added: Sequence[SourceName],
    differ: Callable[[str, str], bool] = _never_differ,
) -> list[tuple[SourceName, SourceName]]:
    """Return the pairs of a removed and an added name of the same thing.

    A pair is a single removed and added name that are alike, the only names of a type, or the most similar names.

    Args:
        removed: the names that only the old version has.
        added: the names that only the new version has.
        differ: whether an old and a new name are certainly not of the same thing.
    """
    pairs: list[tuple[SourceName, SourceName]] = []
    if len(removed) == len(added) == 1:
        (old,), (new,) = removed, added
        if differ(old.name, new.name):
            return []
        has_types = old.kind not in _UNTYPED_KINDS and not _is_python_member(old)
        has_equal_type = old.type == new.type and (has_types or bool(old.type))
        return [(old, new)] if has_equal_type or compute_similarity(old, new) >= _MIN_SIMILARITY else []
    unpaired = list(added)
    is_compared = len(removed) * len(added) <= _MAX_COMPARED_PAIRS
    for item in removed:
        similar = [candidate for candidate in unpaired if _has_compatible_type(item, candidate)] if is_compared else []
        similar = [candidate for candidate in similar if not differ(item.name, candidate.name)]
        candidates = [candidate for candidate in similar if compute_similarity(item, candidate) >= _MIN_SIMILARITY]
        same_type = [
            [candidate for candidate in items if candidate.type == item.type and item.type]
            for items in (removed, unpaired)
        ]
        is_typed = item.kind not in (NameKind.PARAMETER, NameKind.ELEMENT, NameKind.MEMBER)
        if is_typed and len(same_type[0]) == len(same_type[1]) == 1:
            candidates = same_type[1]
        if candidates:
            best = max(candidates, key=lambda candidate: compute_similarity(item, candidate))
            pairs.append((item, best))
            unpaired.remove(best)
    return pairs


def pair_edited_alike(
    removed: Sequence[SourceName], added: Sequence[SourceName]
) -> list[tuple[SourceName, SourceName]]:
    """Return the pairs of a removed and an added name in which the same words are replaced as in another pair.

    Names that such an edit joins in two ways are left out.
    """
    edits: dict[Hashable, list[tuple[SourceName, SourceName]]] = {}
    if 1 < len(removed) * len(added) <= _MAX_COMPARED_PAIRS:
        for old, new in itertools.product(removed, added):
            edit = name_edit(old.name, new.name)
            is_replaced = isinstance(edit, tuple) and all(edit) and compute_similarity(old, new) >= _MIN_SIMILARITY
            if is_replaced and _has_compatible_type(old, new):
                edits.setdefault(edit, []).append((old, new))
    pairs = [pair for alike in edits.values() if len(alike) > 1 for pair in alike]
    counts = Counter(id(item) for pair in pairs for item in pair)
    return [pair for pair in pairs if all(counts[id(item)] == 1 for item in pair)]


def take_pairs(literals: list[SourceName], expressions: list[SourceName]) -> Iterator[tuple[SourceName, SourceName]]:
    """Yield the pairs of a name and an expression that probably mean the same.

    They are removed from both lists.
    """
    for item in list(literals):
        is_only_pair = len(literals) == len(expressions) == 1
        other = next((expression for expression in expressions if is_only_pair or expression.type == item.type), None)
        if other is not None:
            literals.remove(item)
            expressions.remove(other)
            yield item, other


def drop_replaceable(literals: list[SourceName], expressions: Sequence[SourceName]) -> None:
    """Remove the names from a list that one of the expressions may give."""
    literals[:] = [
        item
        for item in literals
        if not any(
            can_make(expression.name, item.name)
            and (item.kind in _UNTYPED_KINDS or _has_compatible_type(item, expression))
            for expression in expressions
        )
    ]


def _has_compatible_type(old: SourceName, new: SourceName) -> bool:
    return old.type == new.type or not old.type or not new.type


def compute_similarity(old: SourceName, new: SourceName) -> float:
    """Return the ratio of equal characters of the last words of two names."""
    old_name, new_name = (item.name.rpartition("::")[2].casefold() for item in (old, new))
    if _is_python_member(old) and _is_python_member(new):
        (old_class, _, old_word), (new_class, _, new_word) = old_name.rpartition("."), new_name.rpartition(".")
        if old_class == new_class:  # else the names of the classes count, too
            old_name, new_name = old_word, new_word
    return SequenceMatcher(None, old_name, new_name, autojunk=False).ratio()


def _is_python_member(item: SourceName) -> bool:
    """Return whether a name is a method or attribute of a class in Python, which is qualified by the class."""
    return item.kind in (NameKind.FUNCTION, NameKind.MEMBER) and "." in item.name


def has_same_types(old: SourceName, new: SourceName, old_names: SourceNames, new_names: SourceNames) -> bool:
    """Return whether a function or member only has other names for the same types."""
    is_member = old.kind in (NameKind.FUNCTION, NameKind.MEMBER) and old.type != new.type
    types = old_names.resolve_aliases(old.type), new_names.resolve_aliases(new.type)
    return is_member and not has_other_class(old, new, old_names, new_names) and has_same_parameters(*types)


def has_other_class(old: SourceName, new: SourceName, old_names: SourceNames, new_names: SourceNames) -> bool:
    """Return whether a type of a function or member is a class that only one version of the header declares."""
    types = old_names.resolve_aliases(old.type), new_names.resolve_aliases(new.type)
    own = old_names.forward_classes ^ new_names.forward_classes
    return any(re.search(rf"(?<!::)\b{name}\b", text) for name in own for text in types)


def is_same_frame(old: SourceName, new: SourceName) -> bool:
    """Return whether two names mean the same frame. tf ignores slashes at the ends of a name."""
    return old.kind in (NameKind.FRAME, NameKind.MESSAGE_FRAME) and old.name.strip("/") == new.name.strip("/")
