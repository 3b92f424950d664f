"""The matching of the links and joints of two descriptions.

They match by name, or as renamed if everything else is equal.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping

from linkwright.loading.lean_dataclasses import dataclass
from linkwright.urdf import Joint, Link, Robot, children_of


@dataclass(frozen=True, slots=True)
class Matches:
    """The names in the new description that match names in the old one, equal or renamed.

    Attributes:
        links: the new names of links, by old name.
        joints: the new names of joints, by old name.
    """

    links: Mapping[str, str]
    joints: Mapping[str, str]


def match(
    old: Robot, new: Robot, same_link: Callable[[Link, Link], bool], same_joint: Callable[[Joint, Joint], bool]
) -> Matches:
    """Match the links and joints of two robots, from the root down.

    Links or joints with the same name match. A joint that is only in the old robot was renamed if a joint that is only
    in the new robot has the same parent, an equal child and equal properties. A link was renamed if an equal link
    has the same parent joint.

    Args:
        old: the old robot.
        new: the new robot.
        same_link: a function that returns whether two links are equal except for their names.
        same_joint: a function that returns whether two joints are equal except for their names and those of their
            links.
    """
    links = {name: name for name in old.links if name in new.links}
    joints = {name: name for name in old.joints if name in new.joints}
    taken = set(joints)

    def renamed(before: str, after: str) -> bool:
        """Return whether two links match, and record a renamed link as matched."""
        if links.get(before) == after:
            return True
        if before in new.links or after in old.links or before in links or after in links.values():
            return False
        if not same_link(old.links[before], new.links[after]):
            return False
        links[before] = after
        return True

    renamed(old.root, new.root)
    below_old, below_new = children_of(old), children_of(new)
    pending = deque([old.root])
    while pending:
        parent = pending.popleft()
        rivals = below_new.get(links.get(parent, ""), ())
        for joint in below_old.get(parent, ()):
            if joint.name in new.joints:
                renamed(joint.child, new.joints[joint.name].child)
            else:
                for rival in rivals:
                    free = rival.name not in taken and rival.name not in old.joints
                    if free and same_joint(joint, rival) and renamed(joint.child, rival.child):
                        joints[joint.name] = rival.name
                        taken.add(rival.name)
                        break
            pending.append(joint.child)
    return Matches(links, joints)
