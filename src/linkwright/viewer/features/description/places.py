"""Where links and joints stand: in the expanded text, and in the files that it was made from."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby, islice

from linkwright.diagnostics import LinkwrightError
from linkwright.lint.fix import element_range
from linkwright.urdf.plaintext import parse_as_urdfdom
from linkwright.viewer.protocol.description import CallSite, SourceRange, Written
from linkwright.xacro.origin import Frame, frames
from linkwright.xmltree import Element

_EXPANDED = ""
_MOST_CALLS = 20


class Places:
    """The places of the links and joints of one description.

    Args:
        text: the description, expanded.
    """

    def __init__(self, text: str) -> None:
        self._expanded: dict[tuple[str, str], Element] = {}
        try:
            root = parse_as_urdfdom(text, _EXPANDED).root
        except LinkwrightError:
            return  # a robot was made of it, so that this does not happen
        for element in root.elements():
            key = (element.tag, element.attributes.get("name", ""))
            self._expanded.setdefault(key, element)

    def of(self, tag: str, name: str, element: Element | None) -> Written:
        """Where a link or joint is written; `element` is the one that the robot was read from."""
        twin = self._expanded.get((tag, name))
        expanded = None if twin is None else _range(twin)
        if element is None or element.source is None or element.source.name.startswith("<"):
            return Written(expanded, None, [])
        return Written(expanded, _range(element), list(islice(_calls(element), _MOST_CALLS)))


def _calls(element: Element) -> Iterator[CallSite]:
    """The calls and includes on the way to an element, innermost first; of calls from one place the innermost."""
    innermost = element.origin
    if not isinstance(innermost, Frame):
        return
    for site, group in groupby(frames(innermost), key=lambda frame: frame.site):
        span = site.span()
        if span is not None:
            yield CallSite(next(group).macro, span.file, span.line, span.column)


def _range(element: Element) -> SourceRange | None:
    """The whole element; only its start tag's name where its end cannot be told."""
    found = element_range(element)
    span = element.span() if found is None or element.source is None else element.source.span(*found)
    if span is None:
        return None
    return SourceRange(span.file, span.line, span.column, span.end_line, span.end_column)
