"""Find links and joints with other names in a semantic description, which has the names alone."""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Collection, Hashable, Iterator, Mapping

from linkwright.diagnostics import joined_first, phrase
from linkwright.review.breaking import joint_name_reason
from linkwright.review.file_pair import FilePair
from linkwright.review.texts.merging import name_edit
from linkwright.review.versions import Version
from linkwright.xmltree import Element

_JOINT, _PASSIVE_JOINT, _LINK, _VIRTUAL_JOINT = "joint", "passive_joint", "link", "virtual_joint"
_LINK_NAME = re.compile(r"<link\s[^<>]*?\bname\s*=\s*[\"']([^\"'$]+)[\"']")
_PAIRS = frozenset({"disable_collisions", "enable_collisions"})
LINK_ATTRIBUTES = ("link", "link1", "link2", "base_link", "tip_link", "parent_link", "child_link")
"""The attributes of semantic descriptions that name a link."""
_MIN_NAMES = 2
"""The minimum number of names that are edited alike. A single pair may be two different parts."""
_MAX_NAMES = 4
"""The maximum number of renamed links and joints in a line, which all are edited alike."""
_MAX_PAIRS = 10_000
"""The maximum number of pairs of names to compare."""


def find_renamed_names(pair: FilePair, old_root: Element, new_root: Element) -> dict[str, str]:
    """Return the new names of links and joints by their old names.

    Names are renamed if the same edit of most names that only the old version has yields names that only the new
    version has, and most of these are in the same places. Two links that the robots of both versions have are
    different links.
    """
    old, new = (dict(_iterate_names(root)) for root in (old_root, new_root))
    removed, added = [name for name in old if name not in new], [name for name in new if name not in old]
    if len(removed) * len(added) > _MAX_PAIRS:
        return {}
    edits: dict[Hashable, dict[str, str]] = defaultdict(dict)
    for name in removed:
        for other in added:
            if old[name][0] == new[other][0]:
                edits[name_edit(name, other)].setdefault(name, other)
    renamed = max(edits.values(), key=len, default={})
    is_common = _MIN_NAMES <= len(renamed) == len(set(renamed.values())) and 2 * len(renamed) > len(removed)
    if not is_common or not _are_in_same_places(renamed, old_root, new_root):
        return {}
    return {} if _are_different_links(renamed, pair.versions.old, pair.versions.new) else renamed


def find_renamed_virtual_joints(old_root: Element, new_root: Element) -> dict[str, str]:
    """Return the new names of virtual joints that connect the same link to the same frame, by their old names."""
    old, new = (
        {element.attributes.get("name", ""): element for element in root.elements(_VIRTUAL_JOINT)}
        for root in (old_root, new_root)
    )
    added = [name for name in new if name not in old]
    renamed = {}
    for name in (name for name in old if name not in new):
        values = {**old[name].attributes, "name": ""}
        matches = [other for other in added if {**new[other].attributes, "name": ""} == values]
        if len(matches) == 1:
            renamed[name] = matches[0]
    return renamed if len(set(renamed.values())) == len(renamed) else {}


def _are_in_same_places(renamed: Mapping[str, str], old_root: Element, new_root: Element) -> bool:
    """Return whether most old names have as many places in groups, states and other elements as the new ones."""
    old, new = _count_places(old_root), _count_places(new_root)
    return 2 * sum(old[name] == new[other] for name, other in renamed.items()) > len(renamed)


def _count_places(root: Element) -> Mapping[str, Counter[tuple[str, str, str]]]:
    """Return the places of each name, by tags and attribute.

    Pairs of links are left out, because they are generated.
    """
    places: dict[str, Counter[tuple[str, str, str]]] = defaultdict(Counter)
    for owner in (owner for owner in root.elements() if owner.tag not in _PAIRS):
        for element in owner.walk():
            for attribute, value in element.attributes.items():
                places[value][owner.tag, element.tag, attribute] += 1
    return places


def _are_different_links(renamed: Mapping[str, str], old: Version, new: Version) -> bool:
    """Return whether the robots of the old version have most new names, and those of the new one most old names."""
    old_links, new_links = map(_find_links, (old, new))
    return 2 * sum(name in new_links and other in old_links for name, other in renamed.items()) > len(renamed)


def _find_links(version: Version) -> set[str]:
    """Return the links in the descriptions of a version, as written in the files."""
    texts = (version.text(path) for path in version.paths((".urdf", ".xacro")))
    return {match[1] for text in texts for match in _LINK_NAME.finditer(text)}


def report_renamed_names(
    pair: FilePair, new_root: Element, renamed: Mapping[str, str], fixed_joints: Collection[str]
) -> None:
    """Report the renamed links and joints of a semantic description in one line.

    Args:
        pair: both versions of the file.
        new_root: the root element of the new version.
        renamed: the new names, by old name.
        fixed_joints: the joints that programs do not move.
    """
    if not renamed:
        return
    new = dict(_iterate_names(new_root))
    joints = [name for name, new_name in renamed.items() if new[new_name][0] == _JOINT and name not in fixed_joints]
    first = next(iter(joints or renamed))
    others = [f"{name} -> {new_name}" for name, new_name in renamed.items() if name != first]
    names = joined_first([f"{first} -> {renamed[first]}", *others], _MAX_NAMES)
    text = phrase("links and joints renamed: {names}", names=names)
    pair.add(text, pair.location(new[renamed[first]][1].span()), joint_name_reason(first) if joints else None)


def _iterate_names(root: Element) -> Iterator[tuple[str, tuple[str, Element]]]:
    """Yield the names of links and joints, each with its kind and the element that has it."""
    for element in root.walk():
        if element.tag in (_JOINT, _PASSIVE_JOINT, _LINK) and "name" in element.attributes:
            kind = _LINK if element.tag == _LINK else _JOINT
            yield element.attributes["name"], (kind, element)
        for attribute in LINK_ATTRIBUTES:
            if attribute in element.attributes:
                yield element.attributes[attribute], (_LINK, element)
