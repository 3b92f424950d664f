"""Find out which joints the chains, links and groups of a planning group bring with them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import suppress
from functools import cached_property
from typing import NamedTuple

from linkwright.diagnostics import LinkwrightError
from linkwright.review.lenient_xml import read_lenient_root
from linkwright.review.versions import Version
from linkwright.xmltree import Element

_EXPRESSION = re.compile(r"\$\{[^{}]*\}|\$\([^()]*\)")
_MAX_DEPTH = 20
"""The maximum depth of groups in groups, which may form a circle by mistake."""


class _ParentJoint(NamedTuple):
    """The joint above a link.

    Attributes:
        name: the name of the joint.
        parent: its parent link.
    """

    name: str
    parent: str


_Tree = Mapping[str, _ParentJoint]
"""The joint above each link. Xacro expressions in names, such as prefixes, count as empty."""


class GroupJoints:
    """The joints of the groups of a semantic description, by the trees of the robots in the repository.

    Args:
        version: the version of the repository.
        root: the root element of the semantic description.
    """

    def __init__(self, version: Version, root: Element) -> None:
        self._version = version
        self._groups = {group.attributes.get("name", ""): group for group in root.elements("group")}

    def has_group(self, name: str) -> bool:
        """Return whether the semantic description has a group."""
        return name in self._groups

    def may_contain(self, group: str, joint: str) -> bool:
        """Return whether a group contains a joint, or whether this is unknown because a robot is missing."""
        return self._may_contain(group, _EXPRESSION.sub("", joint), 0)

    def _may_contain(self, group: str, joint: str, depth: int) -> bool:
        if group not in self._groups or depth > _MAX_DEPTH:
            return False
        return any(self._may_bring(member, joint, depth) for member in self._groups[group].elements())

    def _may_bring(self, member: Element, joint: str, depth: int) -> bool:
        """Return whether a member of a group is or brings a joint, or whether this is unknown."""
        name, tip, base = (
            _EXPRESSION.sub("", member.attributes.get(key, "")) for key in ("name", "tip_link", "base_link")
        )
        if member.tag == "joint":
            return name == joint
        if member.tag == "group":
            return self._may_contain(member.attributes.get("name", ""), joint, depth + 1)
        if member.tag == "link":
            joints = [[tree[name].name] for tree in self._trees if name in tree]
        else:
            joints = [found for tree in self._trees if (found := _find_chain_joints(tree, base, tip)) is not None]
        return not joints or any(joint in names for names in joints)

    @cached_property
    def _trees(self) -> list[_Tree]:
        """The trees of the descriptions, and at the end all of them as one tree.

        A link and its parent can be in different files.
        """
        paths = self._version.paths((".urdf", ".xacro"))
        trees = [tree for path in paths if (tree := dict(self._read_tree(path)))]
        return [*trees, {link: joint for tree in reversed(trees) for link, joint in tree.items()}]

    def _read_tree(self, path: str) -> Iterator[tuple[str, _ParentJoint]]:
        with suppress(LinkwrightError, OSError):
            for joint in read_lenient_root(self._version.file(path)).walk():
                ends = [joint.first(tag) for tag in ("parent", "child")] if joint.tag == "joint" else []
                names = [_EXPRESSION.sub("", end.attributes.get("link", "")) for end in ends if end is not None]
                if len(names) == len(("parent", "child")):
                    yield names[1], _ParentJoint(_EXPRESSION.sub("", joint.attributes.get("name", "")), names[0])


def _find_chain_joints(tree: _Tree, base: str, tip: str) -> list[str] | None:
    """Return the joints between two links of a tree, or None if the tree has no such chain."""
    joints: list[str] = []
    link = tip
    while link != base:
        joint = tree.get(link)
        if joint is None or joint.name in joints:
            return None
        joints.append(joint.name)
        link = joint.parent
    return joints
