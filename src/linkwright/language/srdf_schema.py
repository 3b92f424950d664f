"""The elements of SRDF, the semantic description of a robot (MoveIt, srdfdom)."""

from __future__ import annotations

from linkwright.schema import AttributeRule, ElementRule, ValueType

_NAME = ValueType("name")
LINK = ValueType("name of a link")
JOINT = ValueType("name of a joint")
GROUP = ValueType("name of a group")
_NUMBER = ValueType("number")


def _required(name: str, kind: ValueType, meaning: str, unit: str = "") -> AttributeRule:
    return AttributeRule(name, kind, meaning, unit, required=True)


def _element(
    tag: str,
    meaning: str,
    *attributes: AttributeRule,
    children: tuple[ElementRule, ...] = (),
    is_recursive: bool = False,
) -> ElementRule:
    return ElementRule(tag, meaning, attributes, children, is_repeated=True, is_recursive=is_recursive)


def _pair_of_links(tag: str, meaning: str) -> ElementRule:
    reason = AttributeRule("reason", ValueType("reason"), "why: Adjacent, Never, Always, Default or User")
    return _element(
        tag,
        meaning,
        _required("link1", LINK, "the first link"),
        _required("link2", LINK, "the second link"),
        *((reason,) if tag == "disable_collisions" else ()),
    )


SRDF = ElementRule(
    "robot",
    "the semantic description of a robot",
    (_required("name", _NAME, "the name of the robot, as in the description"),),
    (
        _element(
            "group",
            "links and joints that are planned together",
            _required("name", _NAME, "the name of the group"),
            children=(
                _element("link", "a link, with its parent joint", _required("name", LINK, "the link")),
                _element("joint", "a joint, with its child link", _required("name", JOINT, "the joint")),
                _element(
                    "chain",
                    "all links from one link to another",
                    _required("base_link", LINK, "the first link, which is not part of the chain"),
                    _required("tip_link", LINK, "the last link"),
                ),
            ),
            is_recursive=True,
        ),
        _element(
            "group_state",
            "a named position of a group",
            _required("name", _NAME, "the name of the position"),
            _required("group", GROUP, "the group"),
            children=(
                _element(
                    "joint",
                    "the position of a joint",
                    _required("name", JOINT, "the joint"),
                    _required("value", _NUMBER, "the position", "rad or m"),
                ),
            ),
        ),
        _element(
            "end_effector",
            "a group that is the tool of another group",
            _required("name", _NAME, "the name of the end effector"),
            _required("group", GROUP, "the group of its links"),
            _required("parent_link", LINK, "the link that it is attached to"),
            AttributeRule("parent_group", GROUP, "the group of the arm"),
        ),
        _element(
            "virtual_joint",
            "a joint between the robot and the world",
            _required("name", _NAME, "the name of the joint"),
            _required("type", ValueType("fixed, floating or planar"), "the type of the joint"),
            _required("parent_frame", _NAME, "the frame of the world"),
            _required("child_link", LINK, "the root link of the robot"),
        ),
        _element("passive_joint", "a joint without an actuator", _required("name", JOINT, "the joint")),
        _pair_of_links("disable_collisions", "two links whose collisions are not checked"),
        _pair_of_links("enable_collisions", "two links whose collisions are checked"),
        _element(
            "disable_default_collisions",
            "a link whose collisions are not checked unless enabled",
            _required("link", LINK, "the link"),
        ),
        _element(
            "link_sphere_approximation",
            "spheres that replace the collision shapes of a link",
            _required("link", LINK, "the link"),
            children=(
                _element(
                    "sphere",
                    "a sphere in the frame of the link",
                    _required("center", ValueType("3 numbers"), "the center", "m"),
                    _required("radius", _NUMBER, "the radius", "m"),
                ),
            ),
        ),
        _element(
            "joint_property",
            "a property of a joint for planners",
            _required("joint_name", JOINT, "the joint"),
            _required("property_name", _NAME, "the name of the property"),
            _required("value", ValueType("text"), "the value"),
        ),
    ),
)
"""The rule of the root element of SRDF."""

CHOICES = {
    ("virtual_joint", "type"): ("fixed", "floating", "planar"),
    ("disable_collisions", "reason"): ("Adjacent", "Never", "Always", "Default", "User"),
}
"""The allowed values, by element and attribute."""
