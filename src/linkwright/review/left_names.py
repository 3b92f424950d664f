"""Find plugins and sensors that still name a removed link or joint."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator

from linkwright.diagnostics import Phrase, Span, phrase
from linkwright.review.changes import Change, Effect, Location
from linkwright.schema.name_tags import JOINT_TAG, LINK_TAG
from linkwright.xmltree import Element

_READER_TAGS = frozenset({"plugin", "sensor"})
_SCOPE = "::"
"""The separator of the names of models and links."""


def find_left_names(
    elements: Iterable[Element],
    links: Collection[str],
    joints: Collection[str],
    location: Callable[[Span | None], Location | None],
) -> Iterator[Change]:
    """Yield a breaking change for each parameter that names a removed link or joint.

    Only parameters of plugins and sensors are searched.

    Args:
        elements: the elements of the new version.
        links: the names of the links that only the old version has.
        joints: the names of the joints that only the old version has.
        location: a function that returns the location of a span.
    """
    if not links and not joints:
        return
    for reader in (reader for element in elements for reader in element.walk() if reader.tag in _READER_TAGS):
        for element in reader.walk():
            name = element.text().strip().rpartition(_SCOPE)[2]
            if LINK_TAG.search(element.tag) and name in links:
                yield _make_change(reader, element, phrase("the link '{name}' no longer exists", name=name), location)
            elif JOINT_TAG.search(element.tag) and name in joints:
                yield _make_change(reader, element, phrase("the joint '{name}' no longer exists", name=name), location)


def is_searched_property(name: str) -> bool:
    """Return whether `find_left_names` searches a property of an extension for names of links."""
    words = name.split(" ")
    return not _READER_TAGS.isdisjoint(words[:-1]) and LINK_TAG.search(words[-1]) is not None


def _make_change(
    reader: Element, element: Element, reason: Phrase, location: Callable[[Span | None], Location | None]
) -> Change:
    text = phrase(
        "{kind} '{owner}' still names '{name}' in <{tag}>",
        kind=reader.tag,
        owner=reader.attributes.get("name", ""),
        name=element.text().strip(),
        tag=element.tag,
    )
    return Change(text, Effect.BREAKING, reason, location(element.span()))
