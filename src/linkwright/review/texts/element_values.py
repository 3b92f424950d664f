"""Summarize the values in an added or removed XML element in one line."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from linkwright.descriptions.comparison import round_numbers
from linkwright.diagnostics import Phrase, joined_first
from linkwright.review.names_in_plugins import NAME_TAGS
from linkwright.xmltree import Element

_NAMED_BY_CHILD = "include"
"""The tag of elements that have their name, or else their URI, as a child."""


def format_own_content(element: Element, skipped: Collection[str] = ()) -> str:
    """Return the attributes and the text of an element.

    Its name and the skipped attributes are omitted, and so is a text between elements in it, which means nothing.
    """
    attributes = element.attributes.items()
    words = [f"{name}={value}" for name, value in attributes if name != "name" and name not in skipped]
    text = "" if any(element.elements()) else round_numbers(element.text())
    return " ".join([*words, text]).strip()


def format_values(element: Element, limit: int, skipped: Collection[str] = ()) -> Phrase | None:
    """Return the values in an element, or None if there are none.

    If there are more values than the limit, topics, frames and other names come first.

    Args:
        element: the XML element.
        limit: the maximum number of values to show.
        skipped: the tags of the elements to leave out.
    """
    values = list(_list_values(element, "", skipped))
    if len(values) > limit:
        values.sort(key=lambda value: NAME_TAGS.search(value.rpartition(" ")[0]) is None)
    return joined_first(values, limit) if values else None


def _list_values(element: Element, path: str, skipped: Collection[str]) -> Iterator[str]:
    name_tag = "uri" if element.first("name") is None else "name"
    for child in element.elements():
        if child.tag in skipped or (element.tag == _NAMED_BY_CHILD and child.tag == name_tag):
            continue
        child_path = " ".join(filter(None, (path, child.tag, child.attributes.get("name"))))
        content = format_own_content(child)
        if content or not any(child.elements()):
            yield f"{child_path} {content}".strip()
        yield from _list_values(child, child_path, skipped)
