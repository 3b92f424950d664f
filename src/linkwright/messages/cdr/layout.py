"""The layout of CDR, for the reader and the writer: alignment, sizes, runs of fields.

CDR (OMG, classic, "XCDR1") aligns each primitive to a multiple of its size, counted from the end of the four header
bytes. After a string or a sequence, the position is known only in part, such as "a multiple of four". Generated code
then computes the padding only where it may be needed.
"""

from __future__ import annotations

from typing import NamedTuple

from linkwright.messages.definitions.interfaces import PRIMITIVES, Container, Field, Structure
from linkwright.messages.definitions.library import LIBRARY

MOST_INLINE = 40
"""A nested structure of more leaves than these is written and read by a function of its own."""

DEEPEST_LOOP = 5
"""Loops inside of loops beyond this go to functions of their own; Python's limit is 20."""


class Place(NamedTuple):
    """A position of which only the remainder `rest` modulo `modulus` (1, 2, 4 or 8) is known."""

    modulus: int
    rest: int

    def after(self, size: int) -> Place:
        """Return the position that is `size` bytes further."""
        return Place(self.modulus, (self.rest + size) % self.modulus)

    def padding(self, size: int) -> int | None:
        """Return the number of bytes up to the next multiple of `size`; None if it is not known."""
        return (-self.rest) % size if self.modulus >= size else None

    def met(self, other: Place) -> Place:
        """Return what is known about a position that may be either this one or the other."""
        modulus = min(self.modulus, other.modulus)
        while (self.rest - other.rest) % modulus:
            modulus //= 2
        return Place(modulus, self.rest % modulus)


START = Place(8, 0)
ANYWHERE = Place(1, 0)


class Facts(NamedTuple):
    """Properties of the layout of a structure or a field.

    Attributes:
        least: the minimum number of bytes on the wire, without padding.
        leaves: the number of primitives, strings and sequences, including those of nested structures.
        first: the alignment in bytes that the first primitive requires.
    """

    least: int
    leaves: int
    first: int


_facts: dict[str, Facts] = {}


def facts(structure: Structure) -> Facts:
    """Return the layout properties of a structure."""
    found = _facts.get(structure.type_name)
    if found is None:
        parts = [field_facts(field) for field in structure.wire_fields]
        found = Facts(sum(f.least for f in parts), sum(f.leaves for f in parts), parts[0].first)
        _facts[structure.type_name] = found
    return found


def field_facts(field: Field) -> Facts:
    """Return the layout properties of a field."""
    kind = field.type
    primitive = PRIMITIVES.get(kind.base)
    if kind.container is Container.SEQUENCE:
        leaves = 1 if primitive is not None else 1 + facts(LIBRARY.structure(kind.base)).leaves
        return Facts(4, leaves, 4)
    one = Facts(primitive.size, 1, primitive.size) if primitive is not None else facts(LIBRARY.structure(kind.base))
    if kind.container is Container.ARRAY:
        assert kind.size is not None
        return Facts(one.least * kind.size, one.leaves, one.first)
    return one
