"""Read and compare the enumerators in an installed C++ header."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from linkwright.diagnostics import Phrase, Span, joined_first, phrase, quoted_names
from linkwright.review.breaking import quote_first
from linkwright.review.changes import MAX_NAMES
from linkwright.review.sources.cpp.functions import PUBLIC, read_scopes
from linkwright.review.sources.namespaces import HeaderChange

_ENUMERATION = re.compile(
    r"\benum(?:\s+(?:class|struct))?(?:\s+\[\[[^\]]*\]\])?(?:\s+(?P<name>\w+))?\s*(?::\s*[\w:\s]+)?\{(?P<body>[^{}]*)\}"
)
_ENUMERATOR = re.compile(r"\s*(?P<name>[A-Za-z_]\w*)\s*(?:=\s*(?P<value>.+?))?\s*", re.DOTALL)
_SEPARATOR = re.compile(r",(?![^()<>]*[)>])")
_INTEGER = re.compile(r"(?P<number>[-+]?(?:0[xX][\da-fA-F]+|0[bB][01]+|[1-9]\d*|0))[uUlL]*")


class Enumerator(NamedTuple):
    """A named value of an enumeration.

    Attributes:
        value: the value, or the expression that computes it.
        start: the offset of the name.
    """

    value: str
    start: int


def read_enumerations(text: str) -> dict[str, dict[str, Enumerator]]:
    """Return the enumerators of the public enumerations of a header.

    The keys are the names of the enumerations, qualified by their classes. The name of an enumeration without a name is
    empty. Enumerations with preprocessor conditions are left out, because their values are uncertain.

    Args:
        text: the text of the header without comments.
    """
    scopes = {end: classes for classes, end in read_scopes(text, PUBLIC)}
    enumerations: dict[str, dict[str, Enumerator]] = {}
    for match in _ENUMERATION.finditer(text):
        classes = scopes.get(match.start("body") - 1)
        if classes is not None and "#" not in match["body"]:
            name = "::".join([*classes, match["name"] or ""])
            enumerations.setdefault(name, {}).update(_read_enumerators(match["body"], match.start("body")))
    return enumerations


def _read_enumerators(body: str, offset: int) -> Iterator[tuple[str, Enumerator]]:
    base, count = "", 0
    for item in _SEPARATOR.split(body):
        match = _ENUMERATOR.fullmatch(item)
        if match is not None:
            if match["value"] is not None:
                number = _INTEGER.fullmatch(match["value"])
                base = "" if number else " ".join(match["value"].split())
                count = int(number["number"], 0) if number else 0
            value = f"{base} + {count}" if base and count else base or str(count)
            yield match["name"], Enumerator(value, offset + match.start("name"))
            count += 1
        offset += len(item) + 1


Enumerations = Mapping[str, Mapping[str, tuple[str, Span]]]
"""The values and locations of enumerators, by enumeration and name."""


def compare_enumerations(old: Enumerations, new: Enumerations) -> Iterator[HeaderChange]:
    """Yield the changes to the enumerators of the enumerations that both versions of a header have."""
    for name in new:
        if name in old:
            yield from _compare(name, old[name], new[name])


def _compare(
    name: str, old: Mapping[str, tuple[str, Span]], new: Mapping[str, tuple[str, Span]]
) -> Iterator[HeaderChange]:
    removed, added = [key for key in old if key not in new], [key for key in new if key not in old]
    for key in list(removed):
        same_value = [other for other in added if new[other][0] == old[key][0]]
        if len(same_value) == 1:
            removed.remove(key)
            added.remove(same_value[0])
            text = phrase(
                "enumerator '{old}' renamed to '{new}'",
                old=_qualify(name, key),
                new=_qualify(name, same_value[0]),
            )
            yield HeaderChange(text, new[same_value[0]][1], _make_reason([_qualify(name, key)]))
    if removed:
        names = [_qualify(name, key) for key in removed]
        text = phrase("enumerators removed: {names}", names=joined_first([f"'{item}'" for item in names], MAX_NAMES))
        yield HeaderChange(text, old[removed[0]][1], _make_reason(names), is_old=True)
    if added:
        names = [_qualify(name, key) for key in added]
        text = phrase("enumerators added: {names}", names=joined_first([f"'{item}'" for item in names], MAX_NAMES))
        yield HeaderChange(text, new[added[0]][1])
    changed = [key for key in new if key in old and old[key][0] != new[key][0]]
    if changed:
        values = joined_first([f"{_qualify(name, key)} {old[key][0]} -> {new[key][0]}" for key in changed], MAX_NAMES)
        names_text = quoted_names(_qualify(name, key) for key in changed[:MAX_NAMES])
        reason = phrase("programs that store or send the old value of {names} mean another one", names=names_text)
        yield HeaderChange(phrase("values of enumerators: {values}", values=values), new[changed[0]][1], reason)


def _make_reason(names: Sequence[str]) -> Phrase:
    return phrase("code of other packages that uses {names} does not build", names=quote_first(names))


def _qualify(enumeration: str, name: str) -> str:
    return f"{enumeration.rstrip(':')}::{name}".removeprefix("::")
