"""The elements and comments of an XML text, which may be incomplete, with their ranges."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from linkwright.xmltree.tokens import Kind, Token, tokens

_IDENTIFYING_ATTRIBUTES = ("name", "filename", "reference", "link", "value")
"""The attributes that identify an element, in order of precedence."""


@dataclass(slots=True)
class OutlineElement:
    """An element, which may be incomplete.

    Attributes:
        tag: its start tag.
        closing: its end tag, or None if it has none, as in ``<a/>``.
        children: its child elements.
        end: the offset after it.
    """

    tag: Token
    closing: Token | None = None
    children: list[OutlineElement] = field(default_factory=list)
    end: int = 0

    @property
    def label(self) -> str:
        """The tag and the value that identifies the element, such as ``link base``."""
        attributes = {attribute.name: attribute.value for attribute in self.tag.attributes()}
        value = next((attributes[name] for name in _IDENTIFYING_ATTRIBUTES if attributes.get(name)), None)
        return f"{self.tag.name} {value}" if value else self.tag.name

    @property
    def is_named(self) -> bool:
        """Whether the element has a name, or includes a file."""
        return any(
            attribute.name in _IDENTIFYING_ATTRIBUTES[:3] and attribute.value for attribute in self.tag.attributes()
        )

    def all(self) -> Iterator[OutlineElement]:
        """Yield the element and all its descendants, in text order."""
        yield self
        for child in self.children:
            yield from child.all()


@dataclass(slots=True)
class Outline:
    """The elements and comments of a text.

    Attributes:
        elements: the top-level elements.
        comments: the comment tokens, in text order.
    """

    elements: list[OutlineElement] = field(default_factory=list)
    comments: list[Token] = field(default_factory=list)

    @classmethod
    def of(cls, text: str) -> Outline:
        """Return the outline of a text.

        An end tag closes the nearest open element with its name. Unclosed elements inside that element end there.
        """
        outline = cls()
        open_elements: list[OutlineElement] = []
        for token in tokens(text):
            if token.kind is Kind.COMMENT:
                outline.comments.append(token)
            elif token.kind is Kind.START and token.name:
                element = OutlineElement(token, end=token.end)
                (open_elements[-1].children if open_elements else outline.elements).append(element)
                if not token.is_empty_element:
                    open_elements.append(element)
            elif token.kind is Kind.END and any(element.tag.name == token.name for element in open_elements):
                while open_elements:
                    element = open_elements.pop()
                    if element.tag.name == token.name:
                        element.closing, element.end = token, token.end
                        break
                    element.end = token.start
        for element in open_elements:
            element.end = len(text)
        return outline

    def all(self) -> Iterator[OutlineElement]:
        """Yield all elements, in text order."""
        for element in self.elements:
            yield from element.all()

    def elements_around(self, offset: int) -> list[OutlineElement]:
        """Return the elements that contain an offset, the outermost first."""
        elements: list[OutlineElement] = []
        siblings = self.elements
        while element := next(
            (candidate for candidate in siblings if candidate.tag.start <= offset <= candidate.end), None
        ):
            elements.append(element)
            siblings = element.children
        return elements
