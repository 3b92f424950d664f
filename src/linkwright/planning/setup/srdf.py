"""Writes the semantic description of a robot (SRDF)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from xml.sax.saxutils import quoteattr

from linkwright.planning.setup.collision_pairs import CollisionPairs
from linkwright.planning.setup.groups import PlanningGroup, RobotGroups
from linkwright.planning.setup.named_states import States
from linkwright.urdf import Robot

WORLD = "world"


@dataclass(frozen=True, slots=True)
class VirtualJointSettings:
    """The joint between a frame outside of the robot and its root link."""

    type: str
    parent_frame: str
    child_link: str

    @property
    def name(self) -> str:
        """The name of the joint."""
        return "virtual_joint"


def choose_virtual_joint(robot: Robot, groups: RobotGroups) -> VirtualJointSettings | None:
    """Return the virtual joint of a robot: planar for a robot with wheels, or else fixed.

    A robot whose root link is the world has none.
    """
    if robot.root == WORLD:
        return None
    if groups.passive_joints:
        return VirtualJointSettings("planar", "odom", robot.root)
    return VirtualJointSettings("fixed", WORLD, robot.root)


def write_srdf(
    robot: Robot,
    groups: RobotGroups,
    states: States,
    pairs: CollisionPairs,
    virtual_joint: VirtualJointSettings | None,
) -> str:
    """Return the text of an SRDF."""
    lines = ['<?xml version="1.0" encoding="UTF-8"?>', f"<robot name={quoteattr(robot.name)}>"]
    lines.append("    <!-- The groups of joints that are planned for -->")
    for group in groups.groups:
        lines += _group_lines(group)
    lines.append("    <!-- Named states -->")
    for group_name, group_states in states.items():
        for state, positions in group_states.items():
            lines += _state_lines(group_name, state, positions)
    effectors = [group for group in groups.groups if group.is_end_effector]
    if effectors:
        lines.append("    <!-- End effectors -->")
    lines += [_end_effector_line(group) for group in effectors]
    if virtual_joint is not None:
        lines.append("    <!-- The joint between the robot and the frame in which it is placed -->")
        lines.append(
            _element(
                "virtual_joint",
                name=virtual_joint.name,
                type=virtual_joint.type,
                parent_frame=virtual_joint.parent_frame,
                child_link=virtual_joint.child_link,
            )
        )
    if groups.passive_joints:
        lines.append("    <!-- Joints without a motor that is planned for -->")
    lines += [_element("passive_joint", name=name) for name in groups.passive_joints]
    lines.append("    <!-- Pairs of links whose collisions are not checked -->")
    for (first, second), reason in pairs.disabled.items():
        lines.append(_element("disable_collisions", link1=first, link2=second, reason=reason))
    return "\n".join([*lines, "</robot>", ""])


def _group_lines(group: PlanningGroup) -> list[str]:
    if group.is_chain:
        children = [_element("chain", indent=8, base_link=group.base, tip_link=group.tip)]
    else:
        children = [_element("link", indent=8, name=link) for link in group.links]
        children += [_element("joint", indent=8, name=joint) for joint in group.joints]
    return [f"    <group name={quoteattr(group.name)}>", *children, "    </group>"]


def _state_lines(group: str, state: str, positions: Mapping[str, float]) -> list[str]:
    joints = [_element("joint", indent=8, name=name, value=f"{value:.10g}") for name, value in positions.items()]
    return [f"    <group_state name={quoteattr(state)} group={quoteattr(group)}>", *joints, "    </group_state>"]


def _end_effector_line(group: PlanningGroup) -> str:
    name = f"{group.name}_end_effector"
    if not group.parent_group:
        return _element("end_effector", name=name, parent_link=group.parent_link, group=group.name)
    return _element(
        "end_effector",
        name=name,
        parent_link=group.parent_link,
        group=group.name,
        parent_group=group.parent_group,
    )


def _element(tag: str, indent: int = 4, **attributes: str) -> str:
    text = " ".join(f"{name}={quoteattr(value)}" for name, value in attributes.items())
    return f"{' ' * indent}<{tag} {text}/>"
