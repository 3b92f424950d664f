"""The changes of the mass, the center of mass and the inertia of a link, in one line."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import groupby

from linkwright.descriptions.comparison import Difference
from linkwright.diagnostics import Phrase, phrase, term

INERTIAL = "inertial"
"""The property of a link whose difference joins all those of its ``<inertial>``."""
_SEPARATOR = ", "


def with_joined_inertials(differences: Iterable[Difference]) -> Iterator[Difference]:
    """Yield differences in which those of the inertial of a link are one."""
    for key, group in groupby(differences, _inertial_of):
        if key is None:
            yield from group
            continue
        first, *others = group
        yield _joined([first, *others]) if others else first


def inertial_sentence(difference: Difference) -> Phrase:
    """Return the joined differences of an inertial in one line."""
    pairs = zip((difference.old or "").split(_SEPARATOR), (difference.new or "").split(_SEPARATOR), strict=True)
    words = ((old.split(" "), new) for old, new in pairs)
    return phrase(
        "{subject} '{name}': {property}: {new}",
        subject=term(difference.subject),
        name=difference.name,
        property=difference.property,
        new=_SEPARATOR.join(f"{name} {' '.join(old)} -> {new}" for (name, *old), new in words),
    )


def _inertial_of(difference: Difference) -> str | None:
    """Return the link whose inertial has a difference; None for other differences."""
    is_value = difference.kind == "changed" and difference.property.startswith(f"{INERTIAL} ")
    return difference.name if is_value and difference.old and difference.new else None


def _joined(differences: list[Difference]) -> Difference:
    """Return the differences of an inertial as one, whose old value has the names and whose new one has the units."""
    old = _SEPARATOR.join(f"{_quantity(difference.property)} {difference.old}" for difference in differences)
    new = _SEPARATOR.join(" ".join(filter(None, (difference.new, difference.unit))) for difference in differences)
    return replace(differences[0], property=INERTIAL, old=old, new=new, unit="")


def _quantity(property_name: str) -> str:
    """Return the name of a quantity in one word, such as ``mass``, ``center`` or ``ixx``."""
    name = property_name.rpartition(" ")[2]
    return "center" if name == "xyz" else name
