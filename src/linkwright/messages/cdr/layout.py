"""Layout of CDR that reader and writer share: alignment as far as it is known beforehand, sizes, runs of fields.

CDR (OMG, classic, "XCDR1") puts each primitive at a multiple of its size, counted from behind the four header bytes.
Behind text or a sequence the place is known only in part, such as "a multiple of four": generated code then pads where
it must, and nowhere else.
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
    """A position, as far as it is known: its remainder `rest` when divided by `modulus` (1, 2, 4 or 8)."""

    modulus: int
    rest: int

    def after(self, size: int) -> Place:
        """The place so many bytes further."""
        return Place(self.modulus, (self.rest + size) % self.modulus)

    def padding(self, size: int) -> int | None:
        """Bytes up to the next multiple of a size; None when that is not known beforehand."""
        return (-self.rest) % size if self.modulus >= size else None

    def met(self, other: Place) -> Place:
        """The knowledge that holds at both places."""
        modulus = min(self.modulus, other.modulus)
        while (self.rest - other.rest) % modulus:
            modulus //= 2
        return Place(modulus, self.rest % modulus)


START = Place(8, 0)
ANYWHERE = Place(1, 0)


class Facts(NamedTuple):
    """Facts on a structure.

    Attributes:
        least: the fewest bytes it takes on the wire, padding left out.
        leaves: how many primitives, texts and sequences it has, those of nested structures included.
        first: the alignment that its first primitive asks for.
    """

    least: int
    leaves: int
    first: int


_facts: dict[str, Facts] = {}


def facts(structure: Structure) -> Facts:
    """The facts on a structure."""
    found = _facts.get(structure.type_name)
    if found is None:
        parts = [field_facts(field) for field in structure.wire_fields]
        found = Facts(sum(f.least for f in parts), sum(f.leaves for f in parts), parts[0].first)
        _facts[structure.type_name] = found
    return found


def field_facts(field: Field) -> Facts:
    """The facts on a field."""
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
