"""Inertia tensors as given in descriptions, and their first flaw."""

from __future__ import annotations

from collections.abc import Sequence

from linkwright.diagnostics import Phrase, phrase, quoted_names
from linkwright.geometry import validity
from linkwright.geometry.shapes import Matrix
from linkwright.loading.lean_dataclasses import dataclass
from linkwright.urdf import Inertial

DIAGONAL_NAMES = ("ixx", "iyy", "izz")
PRODUCT_NAMES = ("ixy", "ixz", "iyz")
_MAX_NAMED_LINKS = 4
"""The maximum number of other links that a message names."""


@dataclass(frozen=True, slots=True)
class Flaw:
    """The first flaw of a link's tensor.

    Further flaws of the tensor are not reported, so that only one rule reports it.

    Attributes:
        kind: ``zero``, ``diagonal``, ``product``, ``indefinite`` or ``triangle``.
        attribute: the attribute with the flaw, or None if the flaw concerns all attributes.
        amount: a number that quantifies the flaw: the largest allowed product, or the fraction by which the inequality
            is violated.
    """

    kind: str
    attribute: str | None = None
    amount: float = 0.0


def read_tensor(inertial: Inertial) -> Matrix:
    """Return the inertia tensor given in ``<inertial>``, without its rotation, in kg m2."""
    i = inertial
    return (i.ixx, i.ixy, i.ixz), (i.ixy, i.iyy, i.iyz), (i.ixz, i.iyz, i.izz)


def _max_rounding_error(inertial: Inertial) -> float:
    """Return the largest change of a principal moment that rounding can cause, in kg m2.

    Each component may be off by half of its last digit. A principal moment then changes by at most the largest row sum
    of these errors (Weyl's inequality).
    """
    from decimal import Decimal, InvalidOperation  # imported here because few tensors have products of inertia

    element = inertial.element and inertial.element.first("inertia")
    attributes = {} if element is None else element.attributes

    def rounding_error(name: str) -> float:
        try:
            exponent = Decimal(attributes.get(name, "0").strip()).as_tuple().exponent
        except InvalidOperation:
            return 0.0
        return 0.5 * 10.0**exponent if isinstance(exponent, int) and exponent < 0 else 0.0

    rows = (("ixx", "ixy", "ixz"), ("ixy", "iyy", "iyz"), ("ixz", "iyz", "izz"))
    return max(sum(map(rounding_error, row)) for row in rows)


def find_first_flaw(inertial: Inertial) -> Flaw | None:
    """Return the first flaw of a tensor, or None if it is valid."""
    moments = [getattr(inertial, name) for name in DIAGONAL_NAMES]
    products = [getattr(inertial, name) for name in PRODUCT_NAMES]
    if not any(moments) and not any(products):
        return Flaw("zero")
    for name, moment in zip(DIAGONAL_NAMES, moments, strict=True):
        if moment <= 0:
            return Flaw("diagonal", name, moment)
    matrix = read_tensor(inertial)
    if any(products):
        for name, limit in validity.find_excessive_products(matrix):
            return Flaw("product", name, limit)
        if validity.is_indefinite(matrix, _max_rounding_error(inertial)):
            return Flaw("indefinite")
    excess = validity.triangle_excess(matrix)
    if excess > validity.TOLERANCE:
        return Flaw("triangle", DIAGONAL_NAMES[moments.index(max(moments))], excess)
    return None


def name_others(names: Sequence[str]) -> Phrase:
    """Return a phrase that names a few of the other links with the same tensor."""
    others_phrase = phrase("the others are {names}", names=quoted_names(names[:_MAX_NAMED_LINKS]))
    return phrase("{names}, ...", names=others_phrase) if len(names) > _MAX_NAMED_LINKS else others_phrase
