"""Rules about the drives of joints: their effort and velocity limits."""

from __future__ import annotations

from collections.abc import Iterable
from math import degrees, radians

from linkwright.diagnostics import Diagnostic, Severity, phrase
from linkwright.lint.fix import Fix, value_edit
from linkwright.lint.rule import Rule
from linkwright.lint.subject import Subject
from linkwright.lint.walk import (
    BOUNDED_TYPES,
    format_number,
    is_for_simulation,
    iterate_joint_children,
    iterate_limits,
    parse_bounds,
    parse_number,
)


class _ZeroLimitRule(Rule):
    """The base class of the rules about an `effort` or `velocity` of zero."""

    attribute: str
    consequence: str
    only_in_simulation = False

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        if self.only_in_simulation and not is_for_simulation(subject):
            return
        sprung_joints = {
            element.attributes.get("reference")
            for element in subject.elements("gazebo")
            if element.first("springStiffness") is not None
        }
        for joint, limit in iterate_limits(subject, *BOUNDED_TYPES, "continuous"):
            range_bounds = parse_bounds(limit)
            if range_bounds is not None and range_bounds[0] == range_bounds[1] and joint.type in BOUNDED_TYPES:
                continue  # a joint without a range cannot move in any case; LW202 reports it
            if joint.mimic is None and joint.name not in sprung_joints and parse_number(limit, self.attribute) == 0:
                yield self.report(
                    phrase(
                        "'{attribute}' in <limit> of joint '{name}' is 0: {consequence}",
                        attribute=self.attribute,
                        name=joint.name,
                        consequence=self.consequence,
                    ),
                    limit,
                    self.attribute,
                    hint=phrase("set it to the limit of the motor"),
                )


class EffortZero(_ZeroLimitRule):
    """A moving joint of a simulated robot with an effort limit of 0.

    ## Why

    Simulators apply the limit: the joint has no torque, so it hangs limp or does not move. Joints that mimic another
    joint, or that a spring moves in Gazebo, are not reported. Neither are descriptions without elements for a
    simulator, because manufacturers write 0 for an effort that they do not publish.

    ## Example

    ```xml
    <limit lower="-1" upper="1" effort="0" velocity="1"/>
    ```

    ## Use instead

    Write the maximum torque (N m) or force (N) of the drive.
    """

    code = "LW205"
    name = "effort-zero"
    attribute = "effort"
    consequence = phrase("simulators give it no torque or force")
    only_in_simulation = True


class VelocityZero(_ZeroLimitRule):
    """A moving joint with a velocity limit of 0.

    ## Why

    The joint is not allowed to move at all. MoveIt cannot compute the timing of a trajectory with this joint, and
    controllers hold the joint in place. A joint that mimics another, or that a spring moves in Gazebo, is not reported.

    ## Example

    ```xml
    <limit lower="-1" upper="1" effort="10" velocity="0"/>
    ```

    ## Use instead

    Write the maximum speed of the joint in rad/s or m/s.
    """

    code = "LW206"
    name = "velocity-zero"
    attribute = "velocity"
    consequence = phrase("planners and controllers do not move it")


class _NegativeLimitRule(Rule):
    """The base class of the rules about a negative `effort` or `velocity`."""

    attribute: str

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        if subject.robot is not None and subject.robot.version >= (1, 2):
            return  # the reader reports negative limits in files of URDF 1.2
        for joint, _, limit in iterate_joint_children(subject, "limit"):
            magnitude = parse_number(limit, self.attribute)
            if magnitude is not None and magnitude < 0:
                edit = value_edit(limit, self.attribute, limit.attributes[self.attribute].strip().lstrip("-"))
                yield self.report(
                    phrase(
                        "'{attribute}' in <limit> of joint '{name}' is negative: {size}",
                        attribute=self.attribute,
                        name=joint.name,
                        size=format_number(magnitude),
                    ),
                    limit,
                    self.attribute,
                    hint=phrase("write {value}: the limit applies in both directions", value=format_number(-magnitude)),
                    fix=Fix((edit,), safe=False) if edit else None,
                )


class EffortNegative(_NegativeLimitRule):
    """A joint with a negative effort limit.

    ## Why

    `effort` is a magnitude for both directions, so a negative value allows no effort at all. urdfdom accepts the value,
    and each simulator treats it differently. In SDF, -1 means "no limit", but URDF has no such value.

    ## Example

    ```xml
    <limit lower="-1" upper="1" effort="-10" velocity="1"/>
    ```

    ## Use instead

    ```xml
    <limit lower="-1" upper="1" effort="10" velocity="1"/>
    ```
    """

    code = "LW207"
    name = "effort-negative"
    holds_for_parts = True
    attribute = "effort"


class VelocityNegative(_NegativeLimitRule):
    """A joint with a negative velocity limit.

    ## Why

    `velocity` is a magnitude for both directions, so a negative value allows no motion. MoveIt refuses to compute the
    timing of trajectories with such a limit.

    ## Example

    ```xml
    <limit lower="-1" upper="1" effort="10" velocity="-2"/>
    ```

    ## Use instead

    ```xml
    <limit lower="-1" upper="1" effort="10" velocity="2"/>
    ```
    """

    code = "LW208"
    name = "velocity-negative"
    holds_for_parts = True
    attribute = "velocity"
    severity = Severity.ERROR


class VelocityInDegrees(Rule):
    """A revolute joint with a velocity limit that can only be in degrees per second.

    ## Why

    Speeds are in rad/s, and 180 rad/s is about 1700 revolutions per minute. If an arm joint is planned with this limit,
    it moves as fast as the controller allows.

    ## Example

    ```xml
    <limit lower="-3" upper="3" effort="50" velocity="180"/>
    ```

    ## Use instead

    ```xml
    <limit lower="-3" upper="3" effort="50" velocity="3.14159"/>
    ```
    """

    code = "LW214"
    name = "velocity-in-degrees"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every revolute joint whose velocity limit is a multiple of 15 from 45 to 720.

        No motor drives such a joint at this speed in rad/s.
        """
        for joint, limit in iterate_limits(subject, "revolute"):
            speed = parse_number(limit, "velocity")
            if speed is None or not 45 <= speed <= 720 or speed % 15 != 0:
                continue
            yield self.report(
                phrase(
                    "'velocity' in <limit> of revolute joint '{name}' looks like degrees per second: {speed}",
                    name=joint.name,
                    speed=format_number(speed),
                ),
                limit,
                "velocity",
                hint=phrase(
                    "speeds are in rad/s: write {radians}; {speed} rad/s are {degrees} revolutions per minute",
                    radians=format_number(radians(speed)),
                    speed=format_number(speed),
                    degrees=format_number(degrees(speed) / 6),
                ),
            )
