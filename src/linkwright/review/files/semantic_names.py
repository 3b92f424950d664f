"""Find links and joints with other names in a semantic description, which has the names alone."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Hashable, Iterator, Mapping

from linkwright.diagnostics import joined_first, phrase
from linkwright.review.breaking import joint_name_reason
from linkwright.review.file_pair import FilePair
from linkwright.review.merging import name_edit
from linkwright.xmltree import Element

_JOINT, _PASSIVE_JOINT, _LINK = "joint", "passive_joint", "link"
_LINK_ATTRIBUTES = ("link", "link1", "link2", "base_link", "tip_link", "parent_link", "child_link")
_MIN_NAMES = 2
"""The minimum number of names that are edited alike. A single pair may be two different parts."""
_MAX_NAMES = 4
"""The maximum number of renamed links and joints in a line, which all are edited alike."""
_MAX_PAIRS = 10_000
"""The maximum number of pairs of names to compare."""


def find_renamed_names(old_root: Element, new_root: Element) -> dict[str, str]:
    """Return the new names of links and joints by their old names.

    Names are renamed if the same edit of most names that only the old version has yields names that only the new
    version has.
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
    return renamed if is_common else {}


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
        for attribute in _LINK_ATTRIBUTES:
            if attribute in element.attributes:
                yield element.attributes[attribute], (_LINK, element)
