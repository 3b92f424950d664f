"""The groups of a robot that a semantic description names: arms, grippers, and those of the user."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean, joined, phrase, term
from linkwright.planning.setup.bodies import Body, find_bodies
from linkwright.planning.setup.chains import MIN_ARM_JOINTS, Chain, find_chains, find_wheels
from linkwright.urdf import Robot, parent_joints

_TIP_NAME = re.compile(r"(?i)(^|_)(tool\d*|tcp|ee|eef|end_?effector|flange|tip|grasp\w*)(_|$)")
_SENSOR_NAME = re.compile(r"(?i)camera|optical|sensor|imu|(^|_)ft(_|$)")
_NAME_WORDS = re.compile(r"[A-Za-z]+|\d+")
_IGNORED_WORDS = frozenset({"joint", "link", "j"})
_LEG_NAME = re.compile(r"(?i)hip|thigh|knee|calf|shank|ankle")
_KIND_WORDS = frozenset({"arm", "leg", "manipulator", "robot", "head", "torso", "hand"})


@dataclass(frozen=True, slots=True)
class PlanningGroup:
    """A group of joints.

    Attributes:
        joints: the moving joints, parents before children, including joints that mimic others.
        active_joints: those with a position of their own.
        base: the first link of a chain; empty for a group that is not a chain.
        tip: the last link of a chain.
        links: links that belong to a group that is not a chain, in addition to those that its joints move.
        parent_link: the link to which an end effector is attached; empty for other groups.
        parent_group: the group of this link.
        is_requested: whether the user named the group.
    """

    name: str
    joints: tuple[str, ...]
    active_joints: tuple[str, ...]
    base: str = ""
    tip: str = ""
    links: tuple[str, ...] = ()
    parent_link: str = ""
    parent_group: str = ""
    is_requested: bool = False

    @property
    def is_chain(self) -> bool:
        """Whether the group is a chain between two links."""
        return bool(self.tip)

    def moved_links(self, robot: Robot) -> frozenset[str]:
        """Return the links that belong to the group."""
        return frozenset((*self.links, *(robot.joints[name].child for name in self.joints)))

    @property
    def is_end_effector(self) -> bool:
        """Whether the group is a gripper or another end effector."""
        return bool(self.parent_link)


@dataclass(frozen=True, slots=True)
class GroupRequests:
    """The groups, tips and end effectors that the user names.

    Attributes:
        groups: for each group, a base link and a tip link in the form ``BASE:TIP``, or joints in the form
            ``JOINT,JOINT``.
        tips: the tip link of chains, by group name.
        end_effectors: the links to which groups are attached as end effectors, by group name.
    """

    groups: Mapping[str, str] = field(default_factory=dict)
    tips: Mapping[str, str] = field(default_factory=dict)
    end_effectors: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class RobotGroups:
    """The groups of a robot.

    Attributes:
        groups: the groups, each arm before its gripper.
        passive_joints: the joints of wheels, which are not planned for.
        other_joints: the other joints with a position of their own that are in no group.
    """

    groups: tuple[PlanningGroup, ...]
    passive_joints: tuple[str, ...]
    other_joints: tuple[str, ...]

    @property
    def controlled_joints(self) -> tuple[str, ...]:
        """The joints that need a controller or at least a state: all active joints that are not passive."""
        grouped = [name for group in self.groups for name in group.active_joints]
        return tuple(dict.fromkeys((*grouped, *self.other_joints)))


def find_groups(robot: Robot, requests: GroupRequests | None = None) -> RobotGroups:
    """Return the groups that a robot has by its shape, and those that the user names.

    A group of the user replaces all groups found that have one of its joints.

    Raises:
        LinkwrightError: ARM105, the robot has no arm, and the user names no group; ARM106, a group of the user names
            something that does not exist.
    """
    requests = requests or GroupRequests()
    bodies = find_bodies(robot)
    requested = [_requested_group(robot, bodies, name, text) for name, text in requests.groups.items()]
    taken = {joint for group in requested for joint in group.joints}
    found = [group for group in _find_groups(robot, bodies) if group.name not in requests.groups]
    groups = [*(group for group in found if not taken.intersection(group.joints)), *requested]
    groups = [_complete(robot, bodies, groups, group, requests) for group in groups]
    if not groups:
        message = phrase(
            "robot '{robot}' has no serial chain of {count} joints", robot=robot.name, count=MIN_ARM_JOINTS
        )
        hint = phrase("name the joints to plan for: --group arm=BASE_LINK:TIP_LINK, or --group arm=JOINT,JOINT")
        raise LinkwrightError(Diagnostic("ARM105", message, hint=hint))
    for name in (*requests.tips, *requests.end_effectors):
        if all(group.name != name for group in groups):
            raise _unknown("group", name, [group.name for group in groups])
    grouped = {joint for group in groups for joint in group.joints}
    wheels = [bodies[number] for number in find_wheels(bodies)]
    passive = tuple(body.joint_name for body in wheels if body.joint_name not in grouped and body.is_active)
    other = (body.joint_name for body in bodies if body.is_active and body.joint_name not in grouped.union(passive))
    return RobotGroups(tuple(groups), passive, tuple(other))


def _find_groups(robot: Robot, bodies: list[Body]) -> list[PlanningGroup]:
    chains = find_chains(bodies)
    groups: list[PlanningGroup] = []
    for chain, (arm_name, gripper_name) in zip(chains, _name_groups(bodies, chains), strict=True):
        last = bodies[chain.bodies[-1]]
        fingers = [bodies[number] for number in chain.gripper if bodies[number].parent not in chain.gripper]
        palm_links, tip = _split_palm(robot, last, [_parent_link(finger) for finger in fingers])
        joints, active = _joint_names(bodies, chain.bodies)
        groups.append(PlanningGroup(arm_name, joints, active, _parent_link(bodies[chain.bodies[0]]), tip))
        if chain.gripper:
            joints, active = _joint_names(bodies, chain.gripper)
            groups.append(
                PlanningGroup(gripper_name, joints, active, links=palm_links, parent_link=tip, parent_group=arm_name)
            )
    return groups


def _parent_link(body: Body) -> str:
    assert body.joint is not None
    return body.joint.parent


def _joint_names(bodies: list[Body], numbers: Iterable[int]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the names of the joints of bodies, and those of the joints that have a position of their own."""
    moved = [bodies[number] for number in numbers]
    return tuple(body.joint_name for body in moved), tuple(body.joint_name for body in moved if body.is_active)


def _split_palm(robot: Robot, body: Body, attachments: Sequence[str]) -> tuple[tuple[str, ...], str]:
    """Return the links of the palm, and the tip of the arm.

    If the palm is a link of its own on the last body of the arm, it belongs to the gripper, and the arm ends at the
    link to which it is attached.

    Args:
        robot: the robot.
        body: the last body of the arm.
        attachments: the links of the body to which fingers are attached; empty without a gripper.
    """
    if not attachments:
        return (), _find_tip(body)
    paths = {link: _path_in_body(robot, body, link) for link in body.links}
    palm = body.links[0]
    for links in zip(*(paths[link] for link in attachments), strict=False):
        if len(set(links)) == 1:
            palm = links[0]
    if palm == body.links[0]:
        return (), _find_tip(body) if any(map(_TIP_NAME.search, body.links)) else palm
    return tuple(link for link in body.links if palm in paths[link]), paths[palm][-2]


def _path_in_body(robot: Robot, body: Body, link: str) -> list[str]:
    """Return the links from the first link of a body to one of its links."""
    parents, path = parent_joints(robot), [link]
    while path[-1] != body.links[0]:
        path.append(parents[path[-1]].parent)
    return path[::-1]


def _find_tip(body: Body) -> str:
    """Return the link at the end of an arm without a gripper.

    It is a link whose name is usual for tips, or else the last one that does not look like a sensor.
    """
    named = [link for link in body.links if _TIP_NAME.search(link)]
    others = [link for link in body.links if not _SENSOR_NAME.search(link)]
    return max(named or others or body.links, key=lambda link: body.depths[link])


def _name_groups(bodies: list[Body], chains: Sequence[Chain]) -> list[tuple[str, str]]:
    """Return the names of each arm and its gripper.

    Several arms are named by the words that the names of their joints share, such as ``left``.
    """
    if len(chains) == 1:
        return [("arm", "gripper")]
    prefixes = [_common_words([bodies[number].joint_name for number in chain.bodies]) for chain in chains]
    if len(set(prefixes)) < len(prefixes) or "" in prefixes:
        prefixes = [f"arm_{index}" for index in range(1, len(chains) + 1)]
    names = []
    for prefix, chain in zip(prefixes, chains, strict=True):
        owner = "_".join(word for word in prefix.split("_") if word.lower() not in _KIND_WORDS)
        is_leg = any(_LEG_NAME.search(bodies[number].joint_name) for number in chain.bodies)
        kind = "leg" if is_leg else "arm"
        names.append((prefix if owner != prefix else f"{prefix}_{kind}", f"{owner or prefix}_gripper"))
    return names


def _common_words(names: Sequence[str]) -> str:
    """Return the words that all names have, in the order of the first name."""
    words = [_split_words(name) for name in names]
    shared = [word for word in words[0] if all(word in others for others in words[1:])]
    return "_".join(word for word in shared if word.lower() not in _IGNORED_WORDS and not word.isdigit())


def _split_words(name: str) -> list[str]:
    return _NAME_WORDS.findall(name)


def _requested_group(robot: Robot, bodies: list[Body], name: str, text: str) -> PlanningGroup:
    base, is_chain, tip = text.partition(":")
    if is_chain:
        return _make_chain(robot, bodies, PlanningGroup(name, (), (), base, tip, is_requested=True))
    names = [word.strip() for word in text.split(",")]
    for joint in names:
        if joint not in robot.joints:
            raise _unknown("joint", joint, robot.joints)
    joints, active = _joint_names(bodies, (number for number, body in enumerate(bodies) if body.joint_name in names))
    return PlanningGroup(name, joints, active, is_requested=True)


def _make_chain(robot: Robot, bodies: list[Body], group: PlanningGroup) -> PlanningGroup:
    """Return a chain with the joints between its base and its tip."""
    for link in (group.base, group.tip):
        if link not in robot.links:
            raise _unknown("link", link, robot.links)
    parents = parent_joints(robot)
    link, between = group.tip, set()
    while link != group.base and link in parents:
        between.add(parents[link].name)
        link = parents[link].parent
    if link != group.base:
        message = phrase("link '{tip}' is not below link '{base}'", tip=group.tip, base=group.base)
        hint = phrase("a chain goes from a link of the base toward the tip: --group NAME=BASE:TIP")
        raise LinkwrightError(Diagnostic("ARM106", message, hint=hint))
    numbers = (number for number, body in enumerate(bodies) if body.joint_name in between)
    joints, active = _joint_names(bodies, numbers)
    return replace(group, joints=joints, active_joints=active)


def _complete(
    robot: Robot, bodies: list[Body], groups: Sequence[PlanningGroup], group: PlanningGroup, requests: GroupRequests
) -> PlanningGroup:
    """Return a group with the tip, or the link to which it is attached, that the user gives."""
    tip = requests.tips.get(group.name)
    if tip is not None and group.base:
        group = _make_chain(robot, bodies, replace(group, tip=tip))
    parent_link = requests.end_effectors.get(group.name)
    if parent_link is None:
        return group
    if parent_link not in robot.links:
        raise _unknown("link", parent_link, robot.links)
    parents = parent_joints(robot)
    links = [parent_link]
    while links[-1] in parents:
        links.append(parents[links[-1]].parent)
    moved = {parents[link].name for link in links if link in parents}
    arms = [other.name for other in groups if other.is_chain and moved.intersection(other.joints)]
    return replace(group, parent_link=parent_link, parent_group=arms[0] if arms else "")


def _unknown(kind: str, name: str, candidates: Iterable[str]) -> LinkwrightError:
    names = list(candidates)
    message = phrase("the robot has no {kind} '{name}'", kind=term(kind), name=name)
    hint = did_you_mean(name, names) or phrase("choose from {names}", names=joined(names))
    return LinkwrightError(Diagnostic("ARM106", message, hint=hint))
