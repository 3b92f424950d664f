"""The elements of an XML text, which may be malformed, with their ranges."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import lru_cache

from linkwright.xmltree.tokens import Kind, Token, tokens

MACRO = "xacro:macro"


@dataclass(slots=True, eq=False)
class SourceElement:
    """An element as written in a text.

    Attributes:
        tag: its start tag.
        parent: its parent element, or None.
        children: its child elements.
        end: the character offset after its end tag, or -1 if it is not closed.
    """

    tag: Token
    parent: SourceElement | None = None
    children: list[SourceElement] = field(default_factory=list)
    end: int = -1

    @property
    def name(self) -> str:
        """The name of the element."""
        return self.tag.name

    @property
    def start(self) -> int:
        """The character offset of the start tag."""
        return self.tag.start

    def ancestors_and_self(self) -> Iterator[SourceElement]:
        """Yield the element and the elements around it, the root last."""
        current: SourceElement | None = self
        while current is not None:
            yield current
            current = current.parent

    @property
    def top(self) -> SourceElement | None:
        """The child of the root that is or contains the element, or None for the root."""
        chain = [*self.ancestors_and_self()]
        return chain[-2] if len(chain) > 1 else None

    @property
    def macro(self) -> SourceElement | None:
        """The innermost macro definition around the element, or None."""
        return next(
            (element for element in self.ancestors_and_self() if element.name == MACRO and element is not self), None
        )

    def child_of(self, outer: SourceElement) -> SourceElement:
        """Return the child of an outer element that is or contains this element."""
        return next(element for element in self.ancestors_and_self() if element.parent is outer)

    def value(self, attribute: str) -> str:
        """Return the value of an attribute as written, or empty if it is missing."""
        return next((candidate.value or "" for candidate in self.tag.attributes() if candidate.name == attribute), "")


@lru_cache(maxsize=1)
def source_elements(text: str) -> Sequence[SourceElement]:
    """Return all elements of a text in the order of their start tags, cached for the last text."""
    elements: list[SourceElement] = []
    current: SourceElement | None = None
    for token in tokens(text):
        if token.kind is Kind.START and token.name:
            element = SourceElement(token, current)
            elements.append(element)
            if current is not None:
                current.children.append(element)
            if token.is_empty_element:
                element.end = token.end
            else:
                current = element
        elif token.kind is Kind.END and current is not None:
            closed = next((outer for outer in current.ancestors_and_self() if outer.name == token.name), None)
            if closed is not None:
                closed.end = token.end
                current = closed.parent
    return elements


def find_innermost_element(elements: Sequence[SourceElement], offset: int) -> SourceElement | None:
    """Return the smallest element around an offset, or None.

    Args:
        elements: the elements of a text, as `source_elements` returns them.
        offset: the character offset.
    """
    lineage = [element for element in elements if element.start <= offset < element.end]
    return lineage[-1] if lineage else None
