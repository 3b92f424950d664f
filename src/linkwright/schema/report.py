"""The interface by which readers of elements report findings."""

from __future__ import annotations

from collections.abc import Callable

from linkwright.loading.lean_typing import Any, Final, Protocol
from linkwright.schema.rules import AttributeRule, ElementRule
from linkwright.xmltree import Element

UNREADABLE: Final = type("Unreadable", (), {"__repr__": lambda _: "UNREADABLE"})()
"""The value of something unreadable, whose mistake has been reported."""


class Report(Protocol):
    """Receives the findings of a reader, and formulates them for one XML language.

    `owner` is the element that messages name an element's place by: the link or joint that it is part of.

    Attributes:
        count: how many findings there are.
    """

    count: int

    def missing_attribute(self, element: Element, rule: ElementRule, attribute: AttributeRule, owner: Element) -> None:
        """Report that a required attribute, or the text inside, is missing."""

    def malformed(self, element: Element, rule: ElementRule, attribute: AttributeRule, owner: Element) -> Any:
        """Report a malformed attribute or text, and return the value to continue with, or `UNREADABLE`."""

    def too_new(self, element: Element, rule: ElementRule, attribute: AttributeRule, owner: Element) -> None:
        """Report that an attribute is ignored, because a later version of the language added it."""

    def missing_child(self, element: Element, rule: ElementRule, child: ElementRule, owner: Element) -> None:
        """Report that a required child is missing."""

    def empty_choice(self, element: Element, rule: ElementRule, owner: Element) -> None:
        """Report that none of several children exists."""

    def unknown_choice(self, child: Element, rule: ElementRule, owner: Element) -> None:
        """Report a child that is not one of the expected ones in this version of the language."""


Read = Callable[[Element, Element, Report], Any]
"""From an element, its owner and a report to an object or `UNREADABLE`."""
