"""The rows of a robot's links and joints below a RobotModel display, and how their boxes hang together."""

from __future__ import annotations

from collections.abc import Callable

from linkwright.urdf import Joint, Link, Robot
from linkwright.viewer.config.schema import Path, PropertySpec
from linkwright.viewer.displays.properties.look import alpha

LINKS = "Links"
JOINTS = "Joints"
STYLE = (LINKS, "Link Tree Style")
ALL = (LINKS, "All Links Enabled")

_TREES = ("Tree of links", "Tree of links and joints")
_OPTIONS = (
    PropertySpec(
        STYLE[1],
        "enum",
        "Links in Alphabetic Order",
        "How the rows of links and joints are arranged.",
        options=("Links in Alphabetic Order", "Joints in Alphabetic Order", *_TREES),
    ),
    PropertySpec("Expand Tree", "bool", False, "Open or close the rows of all links and joints of the tree."),
    PropertySpec("Expand Link Details", "bool", False, "Open or close what is known of each link."),
    PropertySpec("Expand Joint Details", "bool", False, "Open or close what is known of each joint."),
    PropertySpec(ALL[1], "bool", True, "Set the boxes of all links."),
)
_OPTION_NAMES = frozenset(spec.name for spec in _OPTIONS)

_LINK_ALPHA = alpha("Opacity of this link.")
_LINK_EXTRAS = (
    PropertySpec("Show Trail", "bool", False, "Draw the way that the link went."),
    PropertySpec("Show Axes", "bool", False, "Draw the axes of the link's frame."),
)
_JOINT_AXES = PropertySpec("Show Axes", "bool", False, "Draw the axes of the joint's frame.")
_JOINT_AXIS = PropertySpec("Show Joint Axis", "bool", False, "Draw the axis that the joint moves about or along.")
_WITH_AXIS = ("continuous", "revolute", "prismatic", "planar")

NO_ROWS = (PropertySpec(LINKS, "group", children=_OPTIONS),)


class RobotRows:
    """The rows of one robot.

    The page arranges them by the Link Tree Style; their places in the file do not depend on it. A link has a box when
    it has shapes. A joint has one when links with shapes are below it: in a tree all of them, in a list its child.
    """

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self._below: dict[str, list[str]] = {}
        for joint in robot.joints.values():
            self._below.setdefault(joint.parent, []).append(joint.name)
        self._shaped = {link.name for link in robot.links.values() if link.visuals or link.collisions}
        self._found: dict[tuple[str, bool], list[str]] = {}

    def specs(self, style: str) -> tuple[PropertySpec, ...]:
        """The groups of links and of joints, each in alphabetic order."""
        links = tuple(
            self._link(self._robot.links[name]) for name in sorted(self._robot.links) if name not in _OPTION_NAMES
        )
        joints = tuple(self._joint(self._robot.joints[name], style) for name in sorted(self._robot.joints))
        return (
            PropertySpec(LINKS, "group", description="The links of the robot.", children=(*_OPTIONS, *links)),
            PropertySpec(JOINTS, "group", description="The joints of the robot.", children=joints),
        )

    @property
    def boxes(self) -> list[Path]:
        """The boxes of links."""
        return [(LINKS, name) for name in sorted(self._shaped - _OPTION_NAMES)]

    def boxes_of(self, joint: str, style: str) -> list[Path]:
        """The boxes of the links that a joint's box sets."""
        return [(LINKS, name) for name in self._links_of(self._robot.joints[joint], style)]

    def derived(self, style: str, is_on: Callable[[Path], bool]) -> dict[Path, bool]:
        """The boxes that follow from those of links: a joint's is on when those of all its links are."""
        on = {name: is_on((LINKS, name)) for name in self._shaped - _OPTION_NAMES}
        found: dict[Path, bool] = {
            (JOINTS, joint.name): all(on.get(name, True) for name in links)
            for joint in self._robot.joints.values()
            if (links := self._links_of(joint, style))
        }
        return {**found, ALL: all(on.values())}

    def _link(self, link: Link) -> PropertySpec:
        if link.name not in self._shaped:
            about = "A link without shapes."
            return PropertySpec(link.name, "group", None, about, children=_LINK_EXTRAS, details="link")
        about, children = "Draw the shapes of this link.", (_LINK_ALPHA, *_LINK_EXTRAS)
        return PropertySpec(link.name, "bool", True, about, children=children, details="link")

    def _joint(self, joint: Joint, style: str) -> PropertySpec:
        children = (_JOINT_AXES, _JOINT_AXIS) if joint.type in _WITH_AXIS else (_JOINT_AXES,)
        about = f"Joint '{joint.name}' with parent link '{joint.parent}' and child link '{joint.child}'."
        if not self._links_of(joint, style):
            return PropertySpec(joint.name, "group", None, about, children=children, details="joint")
        return PropertySpec(joint.name, "bool", True, about, children=children, details="joint")

    def _links_of(self, joint: Joint, style: str) -> list[str]:
        key = (joint.name, style in _TREES)
        if key not in self._found:
            links = self._links_below(joint) if style in _TREES else [joint.child]
            self._found[key] = [name for name in links if name in self._shaped]
        return self._found[key]

    def _links_below(self, joint: Joint) -> list[str]:
        found, pending = [], [joint.child]
        while pending:
            link = pending.pop()
            found.append(link)
            pending.extend(self._robot.joints[name].child for name in self._below.get(link, ()))
        return found
