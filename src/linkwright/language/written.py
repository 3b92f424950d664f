"""The elements of an XML text, which may be malformed, with their ranges."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import lru_cache

from linkwright.xmltree.tokens import Kind, Token, tokens

MACRO = "xacro:macro"


@dataclass(slots=True, eq=False)
class WrittenElement:
    """An element as written in a text.

    Attributes:
        tag: its start tag.
        parent: its parent element, or None.
        children: its child elements.
        end: the character offset after its end tag, or -1 if it is not closed.
    """

    tag: Token
    parent: WrittenElement | None = None
    children: list[WrittenElement] = field(default_factory=list)
    end: int = -1

    @property
    def name(self) -> str:
        """The name of the element."""
        return self.tag.name

    @property
    def start(self) -> int:
        """The character offset of the start tag."""
        return self.tag.start

    def around(self) -> Iterator[WrittenElement]:
        """Yield the element and the elements around it, the root last."""
        current: WrittenElement | None = self
        while current is not None:
            yield current
            current = current.parent

    @property
    def top(self) -> WrittenElement | None:
        """The child of the root that is or contains the element, or None for the root."""
        chain = [*self.around()]
        return chain[-2] if len(chain) > 1 else None

    @property
    def macro(self) -> WrittenElement | None:
        """The innermost macro definition around the element, or None."""
        return next((element for element in self.around() if element.name == MACRO and element is not self), None)

    def child_of(self, outer: WrittenElement) -> WrittenElement:
        """Return the child of an outer element that is or contains this element."""
        return next(element for element in self.around() if element.parent is outer)

    def value(self, attribute: str) -> str:
        """Return the value of an attribute as written, or empty if it is missing."""
        return next((one.value or "" for one in self.tag.attributes() if one.name == attribute), "")


@lru_cache(maxsize=1)
def written_elements(text: str) -> Sequence[WrittenElement]:
    """Return all elements of a text in the order of their start tags, cached for the last text."""
    elements: list[WrittenElement] = []
    current: WrittenElement | None = None
    for token in tokens(text):
        if token.kind is Kind.START and token.name:
            element = WrittenElement(token, current)
            elements.append(element)
            if current is not None:
                current.children.append(element)
            if token.is_empty_element:
                element.end = token.end
            else:
                current = element
        elif token.kind is Kind.END and current is not None:
            closed = next((outer for outer in current.around() if outer.name == token.name), None)
            if closed is not None:
                closed.end = token.end
                current = closed.parent
    return elements


def innermost(elements: Sequence[WrittenElement], offset: int) -> WrittenElement | None:
    """Return the smallest element around an offset, or None.

    Args:
        elements: the elements of a text, as `written_elements` returns them.
        offset: the character offset.
    """
    around = [element for element in elements if element.start <= offset < element.end]
    return around[-1] if around else None
