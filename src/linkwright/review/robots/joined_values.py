"""The changes of the inertial of a link, or of the limits of a joint, in one line."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import groupby

from linkwright.descriptions.comparison import Difference
from linkwright.diagnostics import Phrase, phrase, term

_BLOCKS = ("inertial", "limit")
"""The properties whose values are joined: those of ``<inertial>`` and those of ``<limit>``."""
_SEPARATOR = ", "


def with_joined_values(differences: Iterable[Difference]) -> Iterator[Difference]:
    """Yield differences in which those of the inertial of a link, or of the limits of a joint, are one."""
    for key, group in groupby(differences, _block_of):
        if key is None:
            yield from group
            continue
        first, *others = group
        yield _joined(key[1], [first, *others]) if others else first


def has_joined_values(difference: Difference) -> bool:
    """Return whether a difference joins those of several values."""
    return difference.property in _BLOCKS and bool(difference.old and difference.new)


def joined_sentence(difference: Difference) -> Phrase:
    """Return the joined differences in one line."""
    pairs = zip((difference.old or "").split(_SEPARATOR), (difference.new or "").split(_SEPARATOR), strict=True)
    words = ((old.split(" "), new) for old, new in pairs)
    return phrase(
        "{subject} '{name}': {property}: {new}",
        subject=term(difference.subject),
        name=difference.name,
        property=difference.property,
        new=_SEPARATOR.join(f"{name} {' '.join(old)} -> {new}" for (name, *old), new in words),
    )


def _block_of(difference: Difference) -> tuple[str, str] | None:
    """Return the link or joint and the block of a changed value that can be joined; None for other differences."""
    block = difference.property.partition(" ")[0]
    is_value = difference.kind == "changed" and block in _BLOCKS and block != difference.property
    return (difference.name, block) if is_value and difference.old and difference.new else None


def _joined(block: str, differences: list[Difference]) -> Difference:
    """Return the differences of a block as one, whose old value has the names and whose new one has the units."""
    old = _SEPARATOR.join(f"{_quantity(difference.property)} {difference.old}" for difference in differences)
    new = _SEPARATOR.join(" ".join(filter(None, (difference.new, difference.unit))) for difference in differences)
    return replace(differences[0], property=block, old=old, new=new, unit="")


def _quantity(property_name: str) -> str:
    """Return the name of a quantity in one word, such as ``mass``, ``center``, ``ixx`` or ``lower``."""
    name = property_name.rpartition(" ")[2]
    return "center" if name == "xyz" else name
