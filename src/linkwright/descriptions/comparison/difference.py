"""A difference between two descriptions, with its locations."""

from __future__ import annotations

from linkwright.diagnostics import Span
from linkwright.loading.lean_dataclasses import dataclass, field
from linkwright.loading.lean_typing import Literal
from linkwright.xacro.faults import Frame, frames
from linkwright.xmltree import Element

Kind = Literal["added", "removed", "renamed", "changed"]
Subject = Literal["robot", "link", "joint", "extension"]


@dataclass(frozen=True, slots=True)
class DifferenceLocation:
    """The location of a difference.

    `calls` are the macro calls and includes that produced the element at this location, innermost first.
    """

    span: Span
    calls: tuple[Span, ...] = ()


@dataclass(frozen=True, slots=True)
class Difference:
    """A difference between two descriptions.

    Attributes:
        subject: the kind of the changed object; ``extension`` is a ``<gazebo>``, ``<ros2_control>``,
            ``<transmission>``, ...
        name: the object's name in the new description or, for a removed object, in the old description.
        kind: the kind of change.
        property: the changed property, such as ``mass`` or ``visual 2 origin xyz``; empty for the whole object.
        old: the value in the old description without its unit, or None if there is none.
        new: the value in the new description without its unit, or None if there is none.
        unit: the unit of both values; empty for text.
        old_place: the location of the value in the old description, or of the beginning of its object.
        new_place: the location of the value in the new description, or of the beginning of its object.
        element: the element that was added or removed as a whole, if it belongs to an extension.
    """

    subject: Subject
    name: str
    kind: Kind
    property: str = ""
    old: str | None = None
    new: str | None = None
    unit: str = ""
    old_place: DifferenceLocation | None = None
    new_place: DifferenceLocation | None = None
    element: Element | None = field(default=None, compare=False, repr=False)


def location_of(element: Element | None, attribute: str = "") -> DifferenceLocation | None:
    """Return the location of an element or of one of its attributes, or None if unknown."""
    if element is None:
        return None
    span = element.attribute_span(attribute) if attribute in element.attributes else element.span()
    if span is None:
        return None
    calls = (frame.site.span() for frame in frames(element.origin if isinstance(element.origin, Frame) else None))
    return DifferenceLocation(span, tuple(call for call in calls if call is not None))
