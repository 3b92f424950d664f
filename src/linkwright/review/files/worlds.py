"""The comparison of worlds and models in SDF."""

from __future__ import annotations

import re
from pathlib import Path

from linkwright.descriptions.comparison import Difference, ElementComparison
from linkwright.diagnostics import Phrase, phrase
from linkwright.review.breaking import plugin_name_reason
from linkwright.review.drawings.scene_images import world_images
from linkwright.review.file_pair import FilePair
from linkwright.review.files.merged_paths import MergedPaths
from linkwright.review.names_in_plugins import path_of_renamed
from linkwright.review.plugins import added_topics, contents_text, missing_topics_reason
from linkwright.sdf.text import parse_as_gazebo
from linkwright.xmltree import Element
from linkwright.xmltree.reader import read_bytes

_NAMED = re.compile(r"(?:^|.* )(?P<tag>world|model|link|joint|sensor|frame) (?P<name>\S+)")
"""The path of an element whose name programs and other models use."""


def compare_worlds(pair: FilePair) -> None:
    """Compare two versions of a file in SDF, without the models that it includes."""
    elements = pair.read(_elements)
    if elements is None:
        return
    differences = list(ElementComparison().child_differences(*elements))
    added = added_topics(differences)
    merged = MergedPaths()
    firsts: list[tuple[Difference, Phrase | None]] = []
    for difference in differences:
        reason = _breaking_reason(difference, added)
        path = f"{difference.name} {difference.property}".strip()
        content = "" if difference.element is None else _content(difference.element)
        kind = difference.kind, difference.old, difference.new, content, None if reason is None else str(reason)
        is_merged = path_of_renamed(difference, path) is None
        if merged.add(path, kind if is_merged else id(difference)) == len(firsts):
            firsts.append((difference, reason))
    for path, (difference, reason) in zip(merged.paths, firsts, strict=True):
        place = difference.new_place or difference.old_place
        location = None if place is None else pair.location(place.span, is_old=difference.new_place is None)
        pair.add(_sentence(difference, path), location, reason)
    if differences and pair.drawings.images:
        pair.images += world_images(pair)


def _elements(file: Path) -> list[Element]:
    document, _ = parse_as_gazebo(read_bytes(file), str(file))
    return list(document.root.elements())


def _content(element: Element) -> str:
    """Return the attributes and the text of an element, without its name."""
    words = [f"{name}={value}" for name, value in element.attributes.items() if name != "name"]
    return " ".join([*words, *element.text().split()])


def _sentence(difference: Difference, name: str) -> Phrase:
    """Return a difference in one line.

    Args:
        difference: the difference.
        name: the path of the element, with the names of others that have the same difference.
    """
    old_path = path_of_renamed(difference, name)
    if old_path is not None:
        return phrase("{element} renamed to '{new}'", element=old_path, new=difference.new or "")
    if difference.kind == "added" or (difference.old is None and difference.kind == "changed"):
        content = (difference.new or "") if difference.element is None else _content(difference.element)
        text = phrase("{element} added", element=f"{name} {content}".strip())
    elif difference.kind == "removed" or difference.new is None:
        text = phrase("{element} removed", element=name)
    else:
        return phrase("{element}: {old} -> {new}", element=name, old=difference.old or "-", new=difference.new or "-")
    contents = None if difference.element is None else contents_text(difference.element)
    return text if contents is None else phrase("{change}: {contents}", change=text, contents=contents)


def _breaking_reason(difference: Difference, added: frozenset[str]) -> Phrase | None:
    """Return why a difference breaks programs that use the world, or None if it does not."""
    path = f"{difference.name} {difference.property}".strip()
    is_removed = difference.kind == "removed" or (difference.kind == "changed" and difference.new is None)
    named = _NAMED.fullmatch(path_of_renamed(difference, path) or (path if is_removed else ""))
    if named is not None:
        return _name_reason(named["tag"], named["name"])
    if is_removed and difference.element is not None:
        reason = missing_topics_reason(difference, added)
        if reason is not None:
            return reason
    is_used = "plugin " in difference.property or "sensor" in difference.property
    return plugin_name_reason(difference) if is_used else None


def _name_reason(tag: str, name: str) -> Phrase:
    if tag == "world":
        return phrase("programs that use the topics and services of the world '{name}' do not find them", name=name)
    if tag in ("link", "frame"):
        return phrase(
            "programs that look up the frame '{name}', and models that attach to it, do not find it", name=name
        )
    if tag == "sensor":
        return phrase("the topics of the sensor '{name}' are missing", name=name)
    return phrase("programs and models that use the name '{name}' do not find it", name=name)
