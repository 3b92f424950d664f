"""Match the links and joints of two descriptions.

Links and joints match by name, or as renamed if everything else is equal.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping, Sequence

from linkwright.loading.lean_dataclasses import dataclass
from linkwright.urdf import Joint, Link, Robot, children_of

WORLD = "world"
"""The link that Gazebo fixes to the world. It matches only a link with the same name."""


@dataclass(frozen=True, slots=True)
class Matches:
    """The names in the new description that match names in the old description.

    Attributes:
        links: the new names of links, by old name.
        joints: the new names of joints, by old name.
    """

    links: Mapping[str, str]
    joints: Mapping[str, str]


def match(
    old: Robot, new: Robot, same_link: Callable[[Link, Link], bool], same_joint: Callable[[Joint, Joint], bool]
) -> tuple[dict[str, str], dict[str, str]]:
    """Match the links and joints of two robots, from the root down.

    Links or joints with the same name match. A joint that is only in the old robot was renamed if a joint that is only
    in the new robot has the same parent, an equal child and equal properties. A link was renamed if an equal link
    has the same parent joint. The root link was renamed if the new root is equal and has one of the same children.

    Args:
        old: the old robot.
        new: the new robot.
        same_link: a function that returns whether two links are equal except for their names.
        same_joint: a function that returns whether two joints are equal except for their own names and the names of
            their links.

    Returns:
        The new names of links and of joints, by old name.
    """
    links = {name: name for name in old.links if name in new.links}
    joints = {name: name for name in old.joints if name in new.joints}
    matched_joints = set(joints)

    def match_renamed(old_name: str, new_name: str) -> bool:
        """Return whether two links match, and record a renamed link as matched."""
        if links.get(old_name) == new_name:
            return True
        if old_name in new.links or new_name in old.links or old_name in links or new_name in links.values():
            return False
        if WORLD in (old_name, new_name):
            return False
        if not same_link(old.links[old_name], new.links[new_name]):
            return False
        links[old_name] = new_name
        return True

    match_renamed(old.root, new.root)
    old_children, new_children = children_of(old), children_of(new)
    pending = deque([old.root])
    while pending:
        parent = pending.popleft()
        candidates = new_children.get(links.get(parent, ""), ())
        for joint in old_children.get(parent, ()):
            if joint.name in new.joints:
                match_renamed(joint.child, new.joints[joint.name].child)
            else:
                for candidate in candidates:
                    is_free = candidate.name not in matched_joints and candidate.name not in old.joints
                    if is_free and same_joint(joint, candidate) and match_renamed(joint.child, candidate.child):
                        joints[joint.name] = candidate.name
                        matched_joints.add(candidate.name)
                        break
            pending.append(joint.child)
    if old.root not in new.links and not _has_matched_child(old.root, old_children, new_children, links):
        links.pop(old.root, None)
    return links, joints


def _has_matched_child(
    parent: str,
    old_children: Mapping[str, Sequence[Joint]],
    new_children: Mapping[str, Sequence[Joint]],
    links: Mapping[str, str],
) -> bool:
    """Return whether a child of a link matches a child of the link that matches it."""
    children = {joint.child for joint in new_children.get(links.get(parent, ""), ())}
    return any(links.get(joint.child) in children for joint in old_children[parent])
