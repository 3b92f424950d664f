"""Rules about the axes, types and frames of joints."""

from __future__ import annotations

from collections.abc import Iterable
from math import radians, sqrt

from linkwright.diagnostics import Diagnostic, Severity, phrase
from linkwright.lint.fix import add_attribute, remove_element, replace_value
from linkwright.lint.option import Option
from linkwright.lint.rule import Rule
from linkwright.lint.subject import Subject
from linkwright.lint.walk import format_number, iterate_joint_children, iterate_joints, parse_numbers
from linkwright.urdf import Joint
from linkwright.urdf.values import shortest_text

_TILT_TOLERANCE = 1e-6
"""The tilt in rad below which an axis is not reported, because it is only rounded: a micrometer per meter."""
_MOVING_TYPES = ("revolute", "continuous", "prismatic", "planar")
_LENGTH_TOLERANCE = 1e-3
"""The maximum deviation of an axis' length from 1."""


class AxisZero(Rule):
    """A moving joint whose axis is 0 0 0.

    ## Why

    The joint has no direction in which to move. urdfdom accepts the axis, but robot_state_publisher then does not move
    the joint, and simulators refuse the model or produce NaN. `<axis/>` without `xyz` is also 0 0 0, not the default 1
    0 0.

    ## Example

    ```xml
    <axis xyz="0 0 0"/>
    ```

    ## Use instead

    ```xml
    <axis xyz="0 0 1"/>
    ```
    """

    code = "LW220"
    name = "axis-zero"
    holds_for_parts = True
    severity = Severity.ERROR

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every moving joint with an ``<axis>`` of zero length."""
        for joint, _, axis in iterate_joint_children(subject, "axis"):
            if joint.type not in _MOVING_TYPES:
                continue
            if "xyz" not in axis.attributes:
                yield self.report(
                    phrase(
                        "<axis> of {type} joint '{name}' has no 'xyz', which makes it 0 0 0",
                        type=joint.type,
                        name=joint.name,
                    ),
                    axis,
                    hint=phrase('add xyz="0 0 1", or remove <axis> for 1 0 0'),
                    fix=add_attribute(axis, "xyz", "1 0 0", safe=False),
                )
            elif parse_numbers(axis, "xyz") == (0, 0, 0):
                yield self.report(
                    phrase("the axis of {type} joint '{name}' is 0 0 0", type=joint.type, name=joint.name),
                    axis,
                    "xyz",
                    hint=phrase("give the direction in which the joint moves, such as 0 0 1"),
                )


class AxisNotUnit(Rule):
    """A moving joint whose axis is not of length 1.

    ## Why

    The axis is a direction, which urdfdom passes on unchanged. Some consumers normalize the axis. Others use its length
    as a factor: code that rotates by `angle * axis` then rotates by a wrong angle.

    ## Example

    ```xml
    <axis xyz="1 1 0"/>
    ```

    ## Use instead

    ```xml
    <axis xyz="0.707107 0.707107 0"/>
    ```

    `linkwright check --fix` normalizes the axis.
    """

    code = "LW221"
    name = "axis-not-unit"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every moving joint whose axis is longer or shorter than rounding explains."""
        for joint, _, axis in iterate_joint_children(subject, "axis"):
            direction = parse_numbers(axis, "xyz")
            if joint.type not in _MOVING_TYPES or len(direction) != 3 or not any(direction):
                continue
            length = sqrt(sum(coordinate * coordinate for coordinate in direction))
            if abs(length - 1) <= _LENGTH_TOLERANCE:
                continue
            unit_vector = " ".join(_format_component(part / length) for part in direction)
            yield self.report(
                phrase(
                    "the axis of joint '{name}' has length {length}, not 1: '{xyz}'",
                    name=joint.name,
                    length=format_number(length),
                    xyz=axis.attributes["xyz"].strip(),
                ),
                axis,
                "xyz",
                hint=phrase("write {form}", form=unit_vector),
                fix=replace_value(axis, "xyz", unit_vector),
            )


class AxisImplicit(Rule):
    """A revolute or continuous joint without `<axis>`.

    ## Why

    The joint rotates about x, which is seldom intended: a wheel without an axis rotates about the direction of travel.
    Prismatic joints often move along x, so they are not reported.

    ## Example

    ```xml
    <joint name="wheel_joint" type="continuous">
      <parent link="base_link"/>
      <child link="wheel"/>
    </joint>
    ```

    ## Use instead

    ```xml
      <axis xyz="0 1 0"/>
    ```

    If x is intended, write `<axis xyz="1 0 0"/>`.
    """

    code = "LW222"
    name = "axis-implicit"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every revolute or continuous joint without an axis."""
        for joint, element in iterate_joints(subject):
            if joint.type in ("revolute", "continuous") and element.first("axis") is None and not _is_locked(joint):
                yield self.report(
                    phrase(
                        "{type} joint '{name}' has no <axis>, so it turns about x", type=joint.type, name=joint.name
                    ),
                    element,
                    hint=phrase('add <axis xyz="0 0 1"/>, or <axis xyz="1 0 0"/> if x is intended'),
                )


def _is_locked(joint: Joint) -> bool:
    """Return whether the limits leave the joint no range of motion.

    `LimitEmpty` (LW202) reports such a joint.
    """
    return joint.type == "revolute" and joint.limit is not None and joint.limit.lower == joint.limit.upper


class AxisOnFixed(Rule):
    """A fixed or floating joint with an `<axis>`.

    ## Why

    Readers ignore the axis. Macros often write it for every joint, which is harmless, so the rule is off by default.

    ## Example

    ```xml
    <joint name="camera_joint" type="fixed">
      <axis xyz="0 0 1"/>
    ```

    ## Use instead

    Remove the `<axis>`, or give the joint the type for which the axis was written.
    """

    code = "LW223"
    name = "axis-on-fixed"
    holds_for_parts = True
    default = False

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every ``<axis>`` of a fixed or floating joint, because readers ignore it."""
        for joint, _, axis in iterate_joint_children(subject, "axis"):
            if joint.type in ("fixed", "floating"):
                yield self.report(
                    phrase("{type} joint '{name}' has an <axis>, which is not read", type=joint.type, name=joint.name),
                    axis,
                    hint=phrase("remove it, or change the type of the joint"),
                    fix=remove_element(axis),
                )


class AxisTilted(Rule):
    """A joint axis that is almost, but not quite, along x, y or z.

    ## Why

    Axes such as `0 0.01 1` and `1 6.1e-17 0` come from exporters that rotate numerically. The joint then moves in a
    slightly tilted plane, and inverse kinematics that requires parallel axes finds no solution.

    ## Example

    ```xml
    <axis xyz="0 0.0005 1"/>
    ```

    ## Use instead

    ```xml
    <axis xyz="0 0 1"/>
    ```
    """

    code = "LW224"
    name = "axis-tilted"
    holds_for_parts = True
    severity = Severity.INFO
    options = (Option("largest-tilt", 0.1, "the largest tilt, in degrees, that is considered unintended"),)

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every axis that is close to a coordinate axis without being exactly aligned."""
        max_tilt = radians(self.option(subject, "largest-tilt", float))
        for joint, _, axis in iterate_joint_children(subject, "axis"):
            direction = parse_numbers(axis, "xyz")
            if joint.type not in _MOVING_TYPES or len(direction) != 3 or not any(direction):
                continue
            main_index = max(range(3), key=lambda index, vector=direction: abs(vector[index]))  # type: ignore[misc]
            perpendicular = sqrt(
                sum(coordinate * coordinate for index, coordinate in enumerate(direction) if index != main_index)
            )
            tilt = perpendicular / abs(direction[main_index])
            if not _TILT_TOLERANCE < tilt <= max_tilt:
                continue
            exact_axis = " ".join(
                shortest_text(float(round(part)) + 0.0) for part in _snap_to_axis(direction, main_index)
            )
            yield self.report(
                phrase(
                    "the axis of joint '{name}' is almost {axis}: '{xyz}'",
                    name=joint.name,
                    axis=exact_axis,
                    xyz=axis.attributes["xyz"].strip(),
                ),
                axis,
                "xyz",
                hint=phrase("write {form}", form=exact_axis),
                fix=replace_value(axis, "xyz", exact_axis, safe=False),
            )


class JointNotPublished(Rule):
    """A joint of a type that robot_state_publisher does not move.

    ## Why

    robot_state_publisher ignores a floating joint, so its two frames are connected only if another node broadcasts the
    transform. robot_state_publisher treats a planar joint as fixed.

    ## Example

    ```xml
    <joint name="world_joint" type="floating">
    ```

    ## Use instead

    Leave the joint out of the description, and let the node that knows the pose (odometry, localization, simulator)
    broadcast the transform. A planar motion can also be built from two prismatic joints and a continuous one.
    """

    code = "LW225"
    name = "joint-not-published"
    severity = Severity.INFO

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every floating and planar joint."""
        for joint, element in iterate_joints(subject):
            if joint.type == "floating":
                yield self.report(
                    phrase(
                        "robot_state_publisher publishes nothing for floating joint '{name}': no transform"
                        " connects '{parent}' and '{child}'",
                        name=joint.name,
                        parent=joint.parent,
                        child=joint.child,
                    ),
                    element,
                    "type",
                    hint=phrase("broadcast this transform from another node"),
                )
            elif joint.type == "planar":
                yield self.report(
                    phrase("robot_state_publisher treats planar joint '{name}' as fixed", name=joint.name),
                    element,
                    "type",
                    hint=phrase("build the motion from two prismatic joints and a continuous one"),
                )


def _format_component(component: float) -> str:
    return shortest_text(float(f"{component:.6g}") + 0.0)


def _snap_to_axis(direction: tuple[float, ...], main_index: int) -> list[float]:
    return [
        (1.0 if component > 0 else -1.0) if index == main_index else 0.0 for index, component in enumerate(direction)
    ]
