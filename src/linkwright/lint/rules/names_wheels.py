"""Rules about wheels: whether their names, positions and axes agree.

A wheel is recognized by its name alone: the name of the joint or of its child link contains the word "wheel", and no
word for a steering or suspension joint. All positions are in the frame of ``base_link`` (or of the root), with every
joint at zero. In this frame, x points forward and y to the left (REP 103).
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from math import cos, radians

from linkwright.diagnostics import Diagnostic, Note, Severity, Span, phrase
from linkwright.geometry.shapes import Placement, placement, rotated
from linkwright.geometry.single import dot, length, subtract_vectors
from linkwright.lint.rule import Rule
from linkwright.lint.subject import Subject
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import NamedTuple
from linkwright.urdf import Collision, Cylinder, Joint, Link, Robot, Vector3, Visual

_OTHER_PART = lazy_pattern(
    r"steer|swivel|knuckle|suspension|caster|castor|drop|arm|hub|axle|mount|fork|plate|holder|base|shaft|rocker|bogie"
    r"|pivot|roller|turn|rotate|yaw|slipping|cover|support|bracket|motor|encoder|arch|guard",
    re.IGNORECASE,
)
_OPPOSITE_SIDES = {"left": "right", "l": "r", "lhs": "rhs"}
_POSITION_TOLERANCE_M = 1e-3
_AXIS_TOLERANCE = cos(radians(10.0))


class Wheel(NamedTuple):
    """A joint that rotates a wheel, with the link of the wheel.

    The pose and the axis are in the base frame.
    """

    joint: Joint
    link: Link
    frame: Placement
    axis: Vector3


def iterate_wheels(subject: Subject, joint_type: str = "continuous") -> Iterator[Wheel]:
    """Yield the wheels of a robot whose joints have the given type, in source order."""
    robot, frames = subject.robot, subject.frames
    if robot is None:
        return
    base = frames.get("base_link", frames[robot.root])
    for joint in robot.joints.values():
        if joint.type == joint_type and is_wheel(joint) and joint.child in frames:
            frame = frames[joint.child].seen_from(base)
            axis = rotated(frame.rotation, joint.axis)
            axis_length = length(axis)
            if axis_length > 0:
                unit_axis = (axis[0] / axis_length, axis[1] / axis_length, axis[2] / axis_length)
                yield Wheel(joint, robot.links[joint.child], frame, unit_axis)


def iterate_joints_above(robot: Robot, joint: Joint) -> Iterator[Joint]:
    """Yield a joint and the joints above it, up to the root."""
    joints_by_child = {joint.child: joint for joint in robot.joints.values()}
    while (parent_joint := joints_by_child.get(joint.parent)) is not None:
        yield parent_joint
        joint = parent_joint


def is_wheel(joint: Joint) -> bool:
    """Return whether the names of a joint and its child suggest that it belongs to a wheel."""
    names = f"{joint.name} {joint.child}"
    return "wheel" in names.lower() and not _OTHER_PART.search(names)


def split_words(name: str) -> list[str]:
    """Return the words of a name in lower case: left, wheel and joint for ``leftWheel_joint``."""
    return [word.lower() for word in re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])|\d+", name)]


def iterate_pairs(all_wheels: list[Wheel]) -> Iterator[tuple[Wheel, Wheel]]:
    """Yield pairs of left and right wheels whose names differ only in the side."""
    wheels_by_words = {tuple(split_words(wheel.joint.name)): wheel for wheel in all_wheels}
    for wheel in all_wheels:
        name_words = split_words(wheel.joint.name)
        side_indexes = [index for index, word in enumerate(name_words) if word in _OPPOSITE_SIDES]
        if len(side_indexes) != 1:
            continue
        opposite_words = [*name_words]
        opposite_words[side_indexes[0]] = _OPPOSITE_SIDES[name_words[side_indexes[0]]]
        opposite_wheel = wheels_by_words.get(tuple(opposite_words))
        if opposite_wheel is not None:
            yield wheel, opposite_wheel


class WheelSide(Rule):
    """A wheel called left is on the right.

    ## Why

    In REP 103, x points forward and y to the left, so the left wheel has the larger y. If the names are exchanged, a
    differential drive controller turns the robot in the wrong direction.

    ## Example

    ```xml
    <joint name="left_wheel_joint" type="continuous">
      <origin xyz="0 -0.19 0"/>
    ```

    ## Use instead

    ```xml
    <joint name="left_wheel_joint" type="continuous">
      <origin xyz="0 0.19 0"/>
    ```
    """

    code = "LW640"
    name = "wheel-side"

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        for left, right in iterate_pairs(list(iterate_wheels(subject))):
            gap = subtract_vectors(left.frame.position, right.frame.position)
            if gap[1] < -_POSITION_TOLERANCE_M and abs(gap[1]) > abs(gap[0]) and left.joint.element is not None:
                note = Note(
                    phrase("'{name}' is at y = {position:g}", name=right.joint.name, position=right.frame.position[1]),
                    _find_span(right.joint),
                )
                message = phrase(
                    "'{name}' is on the right of '{joint_name}', at y = {position:g}",
                    name=left.joint.name,
                    joint_name=right.joint.name,
                    position=left.frame.position[1],
                )
                hint = phrase("REP 103: x is forward and y to the left; exchange the names or the signs of y")
                yield self.report(message, left.joint.element, notes=[note], hint=hint)


class WheelHasLimits(Rule):
    """The joint that a wheel rolls about is revolute, not continuous.

    ## Why

    A revolute joint stops at its limits, so the wheel turns once and stops. A `continuous` joint rotates without
    limits, as a wheel does. Steering joints may have limits and are not reported. A steering joint is recognized by its
    axis: the axis differs from that of the wheel's cylinder or, if the wheel has no cylinder, does not point to the
    side. A part that carries wheels, such as the arm of a rover, is not a wheel.

    ## Example

    ```xml
    <joint name="left_wheel_joint" type="revolute">
      <axis xyz="0 1 0"/>
      <limit lower="-3.14" upper="3.14" effort="10" velocity="20"/>
    ```

    ## Use instead

    ```xml
    <joint name="left_wheel_joint" type="continuous">
      <axis xyz="0 1 0"/>
      <limit effort="10" velocity="20"/>
    ```
    """

    code = "LW641"
    name = "wheel-has-limits"

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        robot = subject.robot
        if robot is None:
            return
        continuous_joints = [joint for joint in robot.joints.values() if joint.type == "continuous"]
        carrier_links = {
            upper_joint.parent
            for joint in continuous_joints
            for upper_joint in (joint, *iterate_joints_above(robot, joint))
        }
        for wheel in iterate_wheels(subject, "revolute"):
            joint = wheel.joint
            if joint.child in carrier_links or "wheel" not in joint.child.lower() or _allows_many_turns(joint):
                continue
            if joint.element is None or not _rolls_about_own_axis(wheel):
                continue
            message = phrase("the wheel on joint '{name}' cannot turn freely: the joint is revolute", name=joint.name)
            yield self.report(message, joint.element, "type", hint=phrase('write type="continuous"'))


class WheelAxis(Rule):
    """A wheel does not turn about the axis of its cylinder.

    ## Why

    In URDF, the axis of a cylinder is z, so a wheel's shape is rotated by a right angle relative to the link. The axis
    of the joint must be that of the rotated cylinder. Otherwise, the wheel tumbles instead of rolling.

    ## Example

    ```xml
    <joint name="left_wheel_joint" type="continuous">
      <axis xyz="0 0 1"/>
    </joint>
    <link name="left_wheel_link">
      <visual>
        <origin rpy="1.5708 0 0"/>
        <geometry><cylinder radius="0.06" length="0.025"/></geometry>
      </visual>
    </link>
    ```

    ## Use instead

    ```xml
      <axis xyz="0 1 0"/>
    ```
    """

    code = "LW642"
    name = "wheel-axis"

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        for wheel in iterate_wheels(subject):
            discs = list(_iterate_disc_axes(wheel.link))
            axis = wheel.joint.axis
            axis_length = length(axis)
            if not discs or axis_length == 0 or wheel.joint.element is None:
                continue
            if any(abs(dot(disc, axis)) / axis_length >= _AXIS_TOLERANCE for disc in discs):
                continue
            cylinder_axis_text = _format_axis(discs[0])
            element = wheel.joint.element.first("axis")
            axis_text = " ".join(f"{value:g}" for value in axis)
            message = phrase(
                "the wheel '{name}' turns about '{joint_axis}', but the axis of its cylinder is '{cylinder_axis}'",
                name=wheel.link.name,
                joint_axis=axis_text,
                cylinder_axis=cylinder_axis_text,
            )
            attribute = "xyz" if element is not None else None
            hint = phrase('write <axis xyz="{cylinder_axis}"/>, or turn the cylinder', cylinder_axis=cylinder_axis_text)
            yield self.report(message, element if element is not None else wheel.joint.element, attribute, hint=hint)


class WheelAxesOpposed(Rule):
    """The axes of a left and a right wheel point in opposite directions.

    ## Why

    Equal velocities then rotate the wheels in opposite directions, and a differential drive controller makes the robot
    spin instead of drive straight. If neither a simulator plugin nor `<ros2_control>` drives the wheels, the finding is
    only informational, because the driver of the robot may negate the velocity of one side. If a plugin negates this
    velocity, ignore the rule in the configuration.

    ## Example

    ```xml
    <joint name="right_wheel_joint" type="continuous">
      <axis xyz="0 -1 0"/>
    ```

    ## Use instead

    ```xml
    <joint name="right_wheel_joint" type="continuous">
      <axis xyz="0 1 0"/>
    ```
    """

    code = "LW643"
    name = "wheels-turn-against"

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        for left, right in iterate_pairs(list(iterate_wheels(subject))):
            if dot(left.axis, right.axis) < -_AXIS_TOLERANCE and right.joint.element is not None:
                note = Note(
                    phrase("'{name}' turns in the opposite direction", name=left.joint.name), _find_span(left.joint)
                )
                message = phrase(
                    "'{name}' and '{joint_name}' turn in opposite directions at velocities of the same sign",
                    name=right.joint.name,
                    joint_name=left.joint.name,
                )
                hint = phrase("point both axes to the left, +y, so that positive velocities drive forward")
                severity = (
                    None if _is_driven(subject, left.joint) and _is_driven(subject, right.joint) else Severity.INFO
                )
                yield self.report(message, right.joint.element, notes=[note], hint=hint, severity=severity)


class WheelsNotMirrored(Rule):
    """A left and a right wheel are not each other's mirror image.

    ## Why

    If one wheel of a symmetric robot is slightly misplaced, the robot drives in circles in simulation. Pedantic: robots
    need not be symmetric.

    ## Example

    ```xml
    <joint name="left_wheel_joint" ...><origin xyz="0 0.19 0"/>
    <joint name="right_wheel_joint" ...><origin xyz="0 -0.17 0"/>
    ```

    ## Use instead

    Use a macro with a parameter for the side: `<origin xyz="0 ${side*wheel_y} 0"/>`.
    """

    code = "LW644"
    name = "wheels-not-mirrored"
    default = False

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        for left, right in iterate_pairs(list(iterate_wheels(subject))):
            (lx, ly, lz), (rx, ry, rz) = left.frame.position, right.frame.position
            if (
                max(abs(lx - rx), abs(ly + ry), abs(lz - rz)) > _POSITION_TOLERANCE_M
                and right.joint.element is not None
            ):
                note = Note(
                    phrase("'{name}' is at {lx:.4g} {ly:.4g} {lz:.4g}", name=left.joint.name, lx=lx, ly=ly, lz=lz),
                    _find_span(left.joint),
                )
                message = phrase(
                    "'{name}', at {rx:.4g} {ry:.4g} {rz:.4g}, does not mirror '{joint_name}'",
                    name=right.joint.name,
                    rx=rx,
                    ry=ry,
                    rz=rz,
                    joint_name=left.joint.name,
                )
                yield self.report(message, right.joint.element, notes=[note])


class WheelsTurnBackward(Rule):
    """The axes of a left and a right wheel both point to the right.

    ## Why

    The y axis points to the left. By the right-hand rule, a wheel that rotates about +y rolls forward. If both axes are
    reversed, the robot drives backward at a positive velocity. Pedantic: a controller may be configured for reversed
    axes.

    ## Example

    ```xml
    <axis xyz="0 -1 0"/>
    ```

    ## Use instead

    ```xml
    <axis xyz="0 1 0"/>
    ```
    """

    code = "LW645"
    name = "wheels-turn-backward"
    default = False

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        for left, right in iterate_pairs(list(iterate_wheels(subject))):
            if max(left.axis[1], right.axis[1]) < -_AXIS_TOLERANCE and left.joint.element is not None:
                message = phrase(
                    "positive velocities of '{name}' and '{joint_name}' drive backward",
                    name=left.joint.name,
                    joint_name=right.joint.name,
                )
                element = left.joint.element.first("axis")
                hint = phrase("point both axes to the left, +y in the base frame")
                yield self.report(message, element if element is not None else left.joint.element, hint=hint)


def _is_driven(subject: Subject, joint: Joint) -> bool:
    """Return whether a simulator plugin or ``<ros2_control>`` commands the joint."""
    for gazebo in subject.elements("gazebo"):
        for plugin in gazebo.elements("plugin"):
            if any(joint.name in element.text().split() for element in plugin.walk()):
                return True
    return any(
        element.attributes.get("name") == joint.name and element.first("command_interface") is not None
        for system in subject.elements("ros2_control")
        for element in system.elements("joint")
    )


def _iterate_disc_axes(link: Link) -> Iterator[Vector3]:
    """Yield the axes of a link's flat cylinders in the link's frame."""
    shapes: tuple[Visual | Collision, ...] = (*link.collisions, *link.visuals)
    for visual_or_collision in shapes:
        shape = visual_or_collision.geometry
        if isinstance(shape, Cylinder) and 0 < shape.length < 1.5 * shape.radius:
            yield rotated(placement(visual_or_collision.origin).rotation, (0.0, 0.0, 1.0))


def _rolls_about_own_axis(wheel: Wheel) -> bool:
    """Return whether the joint rotates the wheel about the axis of its cylinder.

    If the link has no flat cylinder, the axis must point to the side.
    """
    discs = list(_iterate_disc_axes(wheel.link))
    if not discs:
        return abs(wheel.axis[1]) >= _AXIS_TOLERANCE
    axis_length = length(wheel.joint.axis)
    return any(abs(dot(disc, wheel.joint.axis)) / axis_length >= _AXIS_TOLERANCE for disc in discs)


def _allows_many_turns(joint: Joint) -> bool:
    """Return whether the limits of a joint span more than 1000 rad, so that a wheel can roll."""
    return joint.limit is not None and joint.limit.upper - joint.limit.lower > 1000.0


def _format_axis(axis: Vector3) -> str:
    """Return an axis as text, rounded, and reversed if its largest component is negative.

    The sign of a wheel's axis has no meaning here.
    """
    sign = 1.0 if max(axis, key=abs) > 0 else -1.0
    return " ".join(f"{round(sign * value, 3) + 0.0:g}" for value in axis)


def _find_span(joint: Joint) -> Span | None:
    return joint.element.span() if joint.element is not None else None
