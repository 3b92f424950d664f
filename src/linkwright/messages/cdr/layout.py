"""The layout of CDR, for the reader and the writer: alignment, sizes, runs of fields.

CDR (OMG, classic, "XCDR1") aligns each primitive to a multiple of its size, counted from the end of the four header
bytes. After a string or a sequence, only the remainder of the position is known, such as "a multiple of four".
Generated code computes padding only where it may be needed.
"""

from __future__ import annotations

from typing import NamedTuple

from linkwright.messages.definitions.interfaces import PRIMITIVES, Container, Field, Structure
from linkwright.messages.definitions.library import LIBRARY

MAX_INLINE_LEAVES = 40
"""The maximum number of leaves of a nested structure whose code is inlined.

Larger structures have separate functions.
"""

MAX_LOOP_DEPTH = 5
"""The maximum depth of nested loops in one function. Python's limit for nested blocks is 20."""


class Alignment(NamedTuple):
    """The known part of a position: its `remainder` after division by `modulus` (1, 2, 4 or 8)."""

    modulus: int
    remainder: int

    def advance(self, size: int) -> Alignment:
        """Return the position that is `size` bytes further."""
        return Alignment(self.modulus, (self.remainder + size) % self.modulus)

    def padding(self, size: int) -> int | None:
        """Return the number of bytes up to the next multiple of `size`, or None if it is not known."""
        return (-self.remainder) % size if self.modulus >= size else None

    def combine(self, other: Alignment) -> Alignment:
        """Return the alignment that holds for both of two possible positions."""
        modulus = min(self.modulus, other.modulus)
        while (self.remainder - other.remainder) % modulus:
            modulus //= 2
        return Alignment(modulus, self.remainder % modulus)


START = Alignment(8, 0)
ANYWHERE = Alignment(1, 0)


class Facts(NamedTuple):
    """The layout of a structure or a field.

    Attributes:
        min_size: the minimum serialized size in bytes, without padding.
        leaf_count: the number of primitives, strings and sequences, including those of nested structures.
        first_alignment: the alignment of the first primitive in bytes.
    """

    min_size: int
    leaf_count: int
    first_alignment: int


_facts: dict[str, Facts] = {}


def get_layout_facts(structure: Structure) -> Facts:
    """Return the layout properties of a structure."""
    layout_facts = _facts.get(structure.type_name)
    if layout_facts is None:
        facts_of_fields = [compute_field_facts(field) for field in structure.wire_fields]
        layout_facts = Facts(
            sum(f.min_size for f in facts_of_fields),
            sum(f.leaf_count for f in facts_of_fields),
            facts_of_fields[0].first_alignment,
        )
        _facts[structure.type_name] = layout_facts
    return layout_facts


def compute_field_facts(field: Field) -> Facts:
    """Return the layout properties of a field."""
    kind = field.type
    primitive = PRIMITIVES.get(kind.base)
    if kind.container is Container.SEQUENCE:
        leaves = 1 if primitive is not None else 1 + get_layout_facts(LIBRARY.structure(kind.base)).leaf_count
        return Facts(4, leaves, 4)
    item_facts = (
        Facts(primitive.size, 1, primitive.size)
        if primitive is not None
        else get_layout_facts(LIBRARY.structure(kind.base))
    )
    if kind.container is Container.ARRAY:
        assert kind.size is not None
        return Facts(item_facts.min_size * kind.size, item_facts.leaf_count, item_facts.first_alignment)
    return item_facts
