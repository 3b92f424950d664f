"""The comparison of worlds and models in SDF."""

from __future__ import annotations

import re
from collections.abc import Hashable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from linkwright.descriptions.comparison import Difference, ElementComparison
from linkwright.diagnostics import Phrase, joined, joined_first, phrase
from linkwright.review.breaking import plugin_name_reason
from linkwright.review.changes import Change, Location
from linkwright.review.drawings.scene_images import world_images
from linkwright.review.file_pair import FilePair
from linkwright.review.files.merged_paths import MergedPaths, differing_parts, path_pattern
from linkwright.review.names_in_plugins import path_of_renamed
from linkwright.review.plugins import added_topics, contents_text, missing_topics_reason
from linkwright.review.versions import Version
from linkwright.sdf.text import parse_as_gazebo
from linkwright.xmltree import Element
from linkwright.xmltree.reader import read_bytes

_NAMED = re.compile(r"(?:^|.* )(?P<tag>world|model|include|link|joint|sensor|frame) (?P<name>\S+)")
"""The path of an element whose name programs and other models use."""
_INCLUDED_NAME = re.compile(r"(?:^|.* )include \S+ name")
"""The path of the name of an included model."""
_MAX_NAMES = 8
"""The number of models, links or joints that the line about an added world names."""
_MIN_ALIKE = 3
"""The number of equal changes of elements at different places from which they are one line."""


def compare_worlds(pair: FilePair) -> None:
    """Compare two versions of a file in SDF, without the models that it includes."""
    elements = pair.read(_elements)
    if elements is None:
        return
    differences = list(ElementComparison().child_differences(*elements))
    added = added_topics(differences)
    changes = [_WorldChange(difference, _breaking_reason(difference, added)) for difference in differences]
    alone: list[_WorldChange] = []
    for group in _alike(changes):
        parts = differing_parts([change.path for change in group])
        if len(group) < _MIN_ALIKE or not any(" " in part for part in parts):
            alone += group
            continue
        locations = tuple(location for change in group[1:] if (location := change.location(pair)) is not None)
        first = group[0]
        text = _sentence(first.difference, first.path)
        pair.changes.append(
            Change(text, location=first.location(pair), other_names=tuple(parts[1:]), other_locations=locations)
        )
    _add_alone(pair, alone)
    if differences and pair.drawings.images:
        pair.images += world_images(pair)


def world_contents(version: Version, path: str) -> Phrase | None:
    """Return the models of a world, or the links and joints of a model, and the plugins and sensors, or None."""
    parts: list[Phrase] = []
    for element in _elements(version.file(path)):
        names = {
            tag: [_name(child) for child in element.elements(tag)] for tag in ("model", "include", "link", "joint")
        }
        models = [*names["model"], *names["include"]]
        if models:
            parts.append(phrase("models {names}", names=joined_first(models, _MAX_NAMES)))
        if names["link"]:
            parts.append(phrase("links {names}", names=joined_first(names["link"], _MAX_NAMES)))
        if names["joint"]:
            parts.append(phrase("joints {names}", names=joined_first(names["joint"], _MAX_NAMES)))
        contents = contents_text(element)
        if contents is not None:
            parts.append(contents)
    return joined(parts) if parts else None


def _name(element: Element) -> str:
    """Return the name of an element, or the last part of the URI of an included model without a name."""
    texts = (element.first(tag) for tag in ("name", "uri"))
    included = next((text.text().strip().rstrip("/") for text in texts if text is not None), "")
    return element.attributes.get("name") or included.rpartition("/")[2]


@dataclass(frozen=True)
class _WorldChange:
    """A difference between two worlds, and why it is breaking."""

    difference: Difference
    reason: Phrase | None

    @property
    def path(self) -> str:
        """The names of the elements and of the value that differ."""
        return f"{self.difference.name} {self.difference.property}".strip()

    @property
    def kind(self) -> Hashable:
        """A key that is equal for equal changes of several elements."""
        difference = self.difference
        content = "" if difference.element is None else _content(difference.element)
        reason = None if self.reason is None else str(self.reason)
        return difference.kind, difference.old, difference.new, content, reason

    @property
    def is_renamed(self) -> bool:
        """Whether the change is that of a name."""
        return path_of_renamed(self.difference, self.path) is not None

    def location(self, pair: FilePair) -> Location | None:
        """Return the location in the new world, or in the old one of a removed element."""
        place = self.difference.new_place or self.difference.old_place
        return None if place is None else pair.location(place.span, is_old=self.difference.new_place is None)


def _alike(changes: Sequence[_WorldChange]) -> Iterator[list[_WorldChange]]:
    """Yield the changes in groups that are equal except for the names of the elements."""
    groups: dict[Hashable, list[_WorldChange]] = {}
    for number, change in enumerate(changes):
        is_alone = change.reason is not None or change.is_renamed
        groups.setdefault(number if is_alone else (path_pattern(change.path), change.kind), []).append(change)
    yield from groups.values()


def _add_alone(pair: FilePair, changes: Sequence[_WorldChange]) -> None:
    """Add changes, of which those whose paths differ in one word are one."""
    merged = MergedPaths()
    firsts: list[_WorldChange] = []
    for change in changes:
        if merged.add(change.path, id(change) if change.is_renamed else change.kind) == len(firsts):
            firsts.append(change)
    for path, change in zip(merged.paths, firsts, strict=True):
        pair.add(_sentence(change.difference, path), change.location(pair), change.reason)


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
    if named is not None and not (named["tag"] == "include" and "/" in named["name"]):
        return _name_reason(named["tag"], named["name"])
    if _INCLUDED_NAME.fullmatch(path) and difference.old:
        return _name_reason("include", difference.old)
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
