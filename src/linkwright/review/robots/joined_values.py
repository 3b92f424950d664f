"""Join the changes in the inertial of a link, or in the limits of a joint, in one line."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import groupby

from linkwright.descriptions.comparison import Difference
from linkwright.diagnostics import Phrase, phrase, term

_BLOCK_TAGS = ("inertial", "limit")
"""The elements whose values are joined: ``<inertial>`` and ``<limit>``."""


@dataclass(frozen=True, slots=True)
class JoinedDifferences(Difference):
    """The differences in several values of a block.

    The location is that of the first difference.

    Attributes:
        values: the differences of values that both versions have.
    """

    values: tuple[Difference, ...] = ()

    def sentence(self) -> Phrase:
        """Return the differences in one line."""
        return phrase(
            "{subject} '{name}': {property}: {new}",
            subject=term(self.subject),
            name=self.name,
            property=self.property,
            new=", ".join(map(_format_value, self.values)),
        )


def join_value_differences(differences: Iterable[Difference]) -> Iterator[Difference]:
    """Yield the differences, with those in an inertial, or in a joint's limits, joined."""
    for key, group in groupby(differences, _find_block):
        values = tuple(group)
        if key is None or len(values) == 1:
            yield from values
            continue
        first = values[0]
        yield JoinedDifferences(
            first.subject,
            first.name,
            first.kind,
            property=key[1],
            old_place=first.old_place,
            new_place=first.new_place,
            values=values,
        )


def _find_block(difference: Difference) -> tuple[str, str] | None:
    """Return the link or joint and the block of a changed value, or None.

    The result is None if the value cannot be joined with others.
    """
    block = difference.property.partition(" ")[0]
    is_value = difference.kind == "changed" and block in _BLOCK_TAGS and block != difference.property
    return (difference.name, block) if is_value and difference.old and difference.new else None


def _format_value(difference: Difference) -> str:
    """Return the change in a value with its unit, such as ``mass 2 -> 3 kg``."""
    name = difference.property.rpartition(" ")[2]
    words = "center" if name == "xyz" else name, difference.old, "->", difference.new, difference.unit
    return " ".join(filter(None, words))
