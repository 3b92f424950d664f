"""Rules about joints that follow another joint (``<mimic>``)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import inf

from linkwright.diagnostics import Diagnostic, Note, Severity, phrase
from linkwright.lint.fix import is_literal, remove_element
from linkwright.lint.rule import Rule
from linkwright.lint.subject import Subject
from linkwright.lint.walk import format_number, iterate_joints, parse_number
from linkwright.urdf import Joint
from linkwright.xmltree import Element

_REVOLUTE_TYPES = ("revolute", "continuous")
_PRISMATIC_TYPES = ("prismatic",)
_TOLERANCE = 1e-3
"""The fraction of its range by which a follower may exceed its limits: rounded factors are not mistakes."""


def _iterate_followers(subject: Subject) -> Iterator[tuple[Joint, Element]]:
    """Yield the joints that follow another joint, each with its ``<mimic>`` element."""
    for joint, element in iterate_joints(subject):
        mimic = element.first("mimic")
        if joint.mimic is not None and mimic is not None:
            yield joint, mimic


def _iterate_followers_with_leaders(subject: Subject) -> Iterator[tuple[Joint, Joint, Element]]:
    """Yield each follower with its leader and ``<mimic>``, if the leader is another joint."""
    joints_by_name = {joint.name: joint for joint in subject.joints}
    for joint, mimic in _iterate_followers(subject):
        leader = joints_by_name.get(mimic.attributes["joint"])
        if leader is not None and leader.name != joint.name:
            yield joint, leader, mimic


class MimicOnFixed(Rule):
    """A fixed joint with a `<mimic>`.

    ## Why

    A fixed joint does not move, whatever it follows. Usually, the author changed the type and forgot the `<mimic>`. If
    the type comes from a xacro expression, it may differ in another expansion, so the joint is not reported.

    ## Example

    ```xml
    <joint name="right_finger_joint" type="fixed">
      <mimic joint="left_finger_joint"/>
    ```

    ## Use instead

    Remove `<mimic>`, or give the joint the type of the joint that it follows.
    """

    code = "LW230"
    name = "mimic-on-fixed"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every fixed joint that mimics another."""
        for joint, mimic in _iterate_followers(subject):
            if joint.type == "fixed" and joint.element is not None and is_literal(joint.element, "type"):
                yield self.report(
                    phrase(
                        "fixed joint '{name}' cannot mimic '{joint}'", name=joint.name, joint=mimic.attributes["joint"]
                    ),
                    mimic,
                    hint=phrase("remove <mimic>, or give the joint the type of the joint that it mimics"),
                    fix=remove_element(mimic, safe=False),
                )


class MimicOfFixed(Rule):
    """A joint that mimics a fixed joint.

    ## Why

    The followed joint has no position, so the follower never moves. Simulators refuse such a constraint.

    ## Example

    ```xml
    <mimic joint="palm_joint"/>   <!-- which is fixed -->
    ```

    ## Use instead

    Name a joint that moves, or make the follower fixed, too.
    """

    code = "LW231"
    name = "mimic-of-fixed"

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every movable follower of a fixed joint."""
        for joint, leader, mimic in _iterate_followers_with_leaders(subject):
            if leader.type == "fixed" and joint.type != "fixed":
                yield self.report(
                    phrase(
                        "joint '{name}' mimics '{leader_name}', which is fixed",
                        name=joint.name,
                        leader_name=leader.name,
                    ),
                    mimic,
                    "joint",
                    hint=phrase("give the name of a joint that moves"),
                    notes=_make_definition_note(leader),
                )


class MimicMultiplierZero(Rule):
    """A joint that mimics another with multiplier 0.

    ## Why

    The joint stays at its offset, whatever the other joint does. A fixed joint does the same at no cost.

    ## Example

    ```xml
    <mimic joint="left_finger_joint" multiplier="0"/>
    ```

    ## Use instead

    Write the intended factor, or make the joint fixed.
    """

    code = "LW232"
    name = "mimic-stands-still"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every follower whose multiplier is 0."""
        for joint, mimic in _iterate_followers(subject):
            if parse_number(mimic, "multiplier") == 0:
                yield self.report(
                    phrase(
                        "joint '{name}' mimics '{joint}' with multiplier 0, so it never moves",
                        name=joint.name,
                        joint=mimic.attributes["joint"],
                    ),
                    mimic,
                    "multiplier",
                    hint=phrase("give a multiplier other than 0, or make the joint fixed"),
                )


class MimicBeyondLimits(Rule):
    """A joint that mimics another further than its own limits allow.

    ## Why

    Nothing stops the follower at its limits when the other joint moves further. RViz shows the follower beyond its
    limits, and in a simulator both joints jam.

    ## Example

    ```xml
    <joint name="finger_tip" type="revolute">
      <limit lower="0" upper="0.5" effort="1" velocity="1"/>
      <mimic joint="finger" multiplier="2"/>   <!-- which moves from 0 to 1 -->
    ```

    ## Use instead

    Compute each limit from the limit of the other joint, times the multiplier, plus the offset. For a negative
    multiplier, swap the two limits.
    """

    code = "LW233"
    name = "mimic-beyond-limits"

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every bounded follower whose leader moves it out of its range."""
        for joint, leader, mimic in _iterate_followers_with_leaders(subject):
            follower_range, leader_range = _find_position_range(joint), _find_position_range(leader)
            if follower_range is None or leader_range is None or joint.mimic is None:
                continue
            factor, offset = joint.mimic.multiplier, joint.mimic.offset
            positions = sorted(bound * factor + offset for bound in leader_range)
            tolerance = _TOLERANCE * max(follower_range[1] - follower_range[0], 1e-6)
            if positions[0] >= follower_range[0] - tolerance and positions[1] <= follower_range[1] + tolerance:
                continue
            yield self.report(
                phrase(
                    "joint '{joint_name}' mimics '{name}' from {reach_lower} to {reach_upper}, but has the limits "
                    "{lower} to {upper}",
                    name=leader.name,
                    joint_name=joint.name,
                    reach_lower=format_number(positions[0]),
                    reach_upper=format_number(positions[1]),
                    lower=format_number(follower_range[0]),
                    upper=format_number(follower_range[1]),
                ),
                mimic,
                hint=phrase(
                    'write lower="{lower}" upper="{upper}" to cover that range',
                    lower=format_number(positions[0]),
                    upper=format_number(positions[1]),
                ),
                notes=_make_definition_note(leader),
            )


class MimicChain(Rule):
    """A joint that mimics a joint which itself mimics another.

    ## Why

    joint_state_publisher follows the chain. robot_state_publisher, if it only receives the first joint's position,
    moves the second joint but not the third. Simulators and ros2_control refuse the chain.

    ## Example

    ```xml
    <joint name="tip" type="revolute"><mimic joint="middle"/> ...
    <joint name="middle" type="revolute"><mimic joint="base"/> ...
    ```

    ## Use instead

    Let every follower name the first joint of the chain, with the product of the multipliers.
    """

    code = "LW234"
    name = "mimic-chain"

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every joint that follows a follower of a joint without ``<mimic>``.

        A longer chain is thus reported at one of its joints. The URDF reader reports cycles.
        """
        joints_by_name = {joint.name: joint for joint in subject.joints}
        for joint, leader, mimic in _iterate_followers_with_leaders(subject):
            if leader.mimic is None or joint.mimic is None:
                continue
            first_joint = joints_by_name.get(leader.mimic.joint)
            if first_joint is None or first_joint.mimic is not None:
                continue  # a missing leader, a cycle or a longer chain, which is reported at another joint
            factor = joint.mimic.multiplier * leader.mimic.multiplier
            offset = joint.mimic.multiplier * leader.mimic.offset + joint.mimic.offset
            yield self.report(
                phrase(
                    "joint '{name}' mimics '{leader_name}', which itself mimics '{first_name}'",
                    name=joint.name,
                    leader_name=leader.name,
                    first_name=first_joint.name,
                ),
                mimic,
                "joint",
                hint=phrase(
                    'write <mimic joint="{name}" multiplier="{factor}" offset="{offset}"/>',
                    name=first_joint.name,
                    factor=format_number(factor),
                    offset=format_number(offset),
                ),
                notes=_make_definition_note(leader),
            )


class MimicOtherKind(Rule):
    """A prismatic joint that mimics a revolute joint, or the other way round, without a multiplier.

    ## Why

    Without a multiplier, one radian becomes one meter. For a rack that follows its pinion, the multiplier is the
    pinion's radius.

    ## Example

    ```xml
    <joint name="rack" type="prismatic">
      <mimic joint="pinion"/>   <!-- which turns -->
    ```

    ## Use instead

    ```xml
      <mimic joint="pinion" multiplier="0.02"/>
    ```
    """

    code = "LW235"
    name = "mimic-other-kind"

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every follower with multiplier 1 if only one of the two joints is prismatic."""
        for joint, leader, mimic in _iterate_followers_with_leaders(subject):
            is_revolute_follower = joint.type in _REVOLUTE_TYPES and leader.type in _PRISMATIC_TYPES
            is_prismatic_follower = joint.type in _PRISMATIC_TYPES and leader.type in _REVOLUTE_TYPES
            if (
                (is_revolute_follower or is_prismatic_follower)
                and joint.mimic is not None
                and abs(joint.mimic.multiplier) == 1
            ):
                units = phrase("radian per meter") if is_revolute_follower else phrase("meter per radian")
                yield self.report(
                    phrase(
                        "{type} joint '{name}' mimics {leader_type} joint '{leader_name}' at one {units}",
                        type=joint.type,
                        name=joint.name,
                        leader_type=leader.type,
                        leader_name=leader.name,
                        units=units,
                    ),
                    mimic,
                    "multiplier" if "multiplier" in mimic.attributes else "joint",
                    hint=phrase('add multiplier="...", such as the radius of the wheel between them'),
                    notes=_make_definition_note(leader),
                )


class MimicDrivenByControl(Rule):
    """A joint that mimics another and also has a command interface in `<ros2_control>`.

    ## Why

    The joint receives two commands: the hardware or simulator must follow the other joint and also obey the command
    interface. ros2_control refuses such a joint when it loads the description.

    ## Example

    ```xml
    <joint name="right_finger_joint">   <!-- which mimics the left one -->
      <command_interface name="position"/>
      <state_interface name="position"/>
    </joint>
    ```

    ## Use instead

    Omit `<command_interface>` for the joint that follows.
    """

    code = "LW236"
    name = "mimic-commanded"
    severity = Severity.WARNING

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every command interface of a follower."""
        followers = {joint.name: joint for joint, _ in _iterate_followers(subject)}
        for system in subject.elements("ros2_control"):
            for control_joint in system.elements("joint"):
                joint = followers.get(control_joint.attributes.get("name", ""))
                command = control_joint.first("command_interface")
                if joint is None or joint.mimic is None or command is None:
                    continue
                if control_joint.attributes.get("mimic") == "false":
                    continue
                yield self.report(
                    phrase(
                        "joint '{name}' mimics '{joint}', but <ros2_control> also commands joint '{name}'",
                        name=joint.name,
                        joint=joint.mimic.joint,
                    ),
                    command,
                    hint=phrase('remove <command_interface>, or write <joint name="..." mimic="false"> there'),
                    notes=_make_definition_note(joint),
                )


def _find_position_range(joint: Joint) -> tuple[float, float] | None:
    """Return the position range of a joint in rad or m, or None if it is missing or invalid."""
    if joint.type not in ("revolute", "prismatic") or joint.limit is None:
        return None
    lower, upper = joint.limit.lower, joint.limit.upper
    return (lower, upper) if -inf < lower < upper < inf else None


def _make_definition_note(joint: Joint) -> tuple[Note, ...]:
    return (
        (Note(phrase("joint '{name}' is defined here", name=joint.name), joint.element.span()),)
        if joint.element
        else ()
    )
