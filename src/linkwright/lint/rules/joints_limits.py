"""Rules about the bounds of joints: positions, effort and velocity."""

from __future__ import annotations

import re
from collections.abc import Iterable
from math import pi

from linkwright.diagnostics import Diagnostic, Severity, phrase
from linkwright.lint.fix import Fix, remove_element, value_edit
from linkwright.lint.rule import Rule
from linkwright.lint.subject import Subject
from linkwright.lint.walk import BOUNDED_TYPES, UNBOUNDED_RAD, format_number, iterate_limits, parse_bounds
from linkwright.loading.deferred import lazy_pattern

_SENSOR_NAME = lazy_pattern(
    r"sensor|camera|(?<![a-z])(imu|gps|gnss|dvl|sonar|lidar|laser|magnetometer|altimeter|pressure|bumper)(?![a-z])",
    re.IGNORECASE,
)


class LimitInverted(Rule):
    """A joint whose lower limit is above its upper limit.

    ## Why

    There is no position between the limits. Below URDF 1.2, urdfdom accepts such limits without a warning. Planners
    then refuse every configuration, simulators apply one of the bounds or none, and sliders have no range.

    ## Example

    ```xml
    <limit lower="1.5" upper="-1.5" effort="10" velocity="1"/>
    ```

    ## Use instead

    ```xml
    <limit lower="-1.5" upper="1.5" effort="10" velocity="1"/>
    ```
    """

    code = "LW201"
    name = "limit-inverted"
    holds_for_parts = True
    severity = Severity.ERROR

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every bounded joint with inverted limits.

        In URDF 1.2, the reader reports them.
        """
        if subject.robot is not None and subject.robot.version >= (1, 2):
            return
        for joint, limit in iterate_limits(subject, *BOUNDED_TYPES):
            range_bounds = parse_bounds(limit)
            if range_bounds is None or range_bounds[0] <= range_bounds[1]:
                continue
            edits = [
                value_edit(limit, "lower", limit.attributes.get("upper", "0")),
                value_edit(limit, "upper", limit.attributes.get("lower", "0")),
            ]
            complete_edits = [edit for edit in edits if edit is not None]
            yield self.report(
                phrase(
                    "'lower' in <limit> of joint '{name}' is above 'upper': {lower} > {upper}",
                    name=joint.name,
                    lower=format_number(range_bounds[0]),
                    upper=format_number(range_bounds[1]),
                ),
                limit,
                "lower" if "lower" in limit.attributes else "upper",
                hint=phrase(
                    'write lower="{lower}" upper="{upper}"',
                    lower=format_number(range_bounds[1]),
                    upper=format_number(range_bounds[0]),
                ),
                fix=Fix(tuple(complete_edits), safe=False) if len(complete_edits) == 2 else None,
            )


class LimitEmpty(Rule):
    """A moving joint whose lower and upper limits are the same.

    ## Why

    Such a joint cannot move. joint_state_publisher_gui shows no slider for it, and planners treat it as fixed, at the
    cost of a moving joint. If the names show that the joint holds a sensor at 0, the finding is only informational:
    Gazebo merges a link on a fixed joint with its parent, and a joint with equal limits preserves the link of the
    sensor.

    ## Example

    ```xml
    <joint name="elbow" type="revolute">
      <limit lower="0" upper="0" effort="10" velocity="1"/>
    ```

    ## Use instead

    Write the range of the joint, or make it `type="fixed"` and remove `<limit>` and `<axis>`.
    """

    code = "LW202"
    name = "limit-empty"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every bounded joint whose two bounds are equal."""
        for joint, limit in iterate_limits(subject, *BOUNDED_TYPES):
            range_bounds = parse_bounds(limit)
            has_bounds = "lower" in limit.attributes or "upper" in limit.attributes
            if range_bounds is not None and has_bounds and range_bounds[0] == range_bounds[1]:
                yield self.report(
                    phrase(
                        "{type} joint '{name}' cannot move: 'lower' and 'upper' are both {limit}",
                        type=joint.type,
                        name=joint.name,
                        limit=format_number(range_bounds[0]),
                    ),
                    limit,
                    "lower" if "lower" in limit.attributes else "upper",
                    hint=phrase("give the range of the joint, or make it 'fixed'"),
                    severity=Severity.INFO
                    if range_bounds[0] == 0 and _SENSOR_NAME.search(f"{joint.name} {joint.child}")
                    else None,
                )


class LimitBoundsMissing(Rule):
    """A revolute or prismatic joint whose `<limit>` has neither `lower` nor `upper`.

    ## Why

    A missing bound is 0, so the joint cannot leave position 0. Its slider has no range.

    ## Example

    ```xml
    <joint name="elbow" type="revolute">
      <limit effort="10" velocity="1"/>
    ```

    ## Use instead

    ```xml
      <limit lower="-1.57" upper="1.57" effort="10" velocity="1"/>
    ```

    A joint that rotates without bounds has `type="continuous"`.
    """

    code = "LW203"
    name = "limit-bounds-missing"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every ``<limit>`` without bounds.

        In URDF 1.2, the reader reports them.
        """
        if subject.robot is not None and subject.robot.version >= (1, 2):
            return
        for joint, limit in iterate_limits(subject, *BOUNDED_TYPES):
            if "lower" not in limit.attributes and "upper" not in limit.attributes:
                if joint.type == "revolute":
                    hint = phrase(
                        'add lower="..." upper="..." (rad); a joint that turns without bounds is \'continuous\''
                    )
                else:
                    hint = phrase('add lower="..." upper="..." (m)')
                yield self.report(
                    phrase(
                        "<limit> of {type} joint '{name}' has no 'lower' and 'upper', so it cannot leave 0",
                        type=joint.type,
                        name=joint.name,
                    ),
                    limit,
                    hint=hint,
                )


class LimitOneBound(Rule):
    """A revolute or prismatic joint whose `<limit>` has only one of `lower` and `upper`.

    ## Why

    The missing bound is 0, which is not visible in the file. The limits of grippers are often written in this way, so
    the rule is off by default.

    ## Example

    ```xml
    <limit upper="0.04" effort="10" velocity="1"/>
    ```

    ## Use instead

    ```xml
    <limit lower="0" upper="0.04" effort="10" velocity="1"/>
    ```
    """

    code = "LW204"
    name = "limit-one-bound"
    holds_for_parts = True
    default = False

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every bounded joint with only one bound."""
        from linkwright.lint.fix import add_attribute

        for joint, limit in iterate_limits(subject, *BOUNDED_TYPES):
            missing_bounds = [name for name in ("lower", "upper") if name not in limit.attributes]
            if len(missing_bounds) == 1:
                yield self.report(
                    phrase(
                        "<limit> of {type} joint '{name}' has no '{missing}', so '{missing}' defaults to 0",
                        type=joint.type,
                        name=joint.name,
                        missing=missing_bounds[0],
                    ),
                    limit,
                    hint=phrase('add {missing}="0" if 0 is intended', missing=missing_bounds[0]),
                    fix=add_attribute(limit, missing_bounds[0], "0"),
                )


class LimitOnContinuous(Rule):
    """A continuous joint with position limits, which nothing enforces.

    ## Why

    A continuous joint rotates without bounds: urdfdom reads the limits, but every consumer ignores them. The author,
    however, probably expects the joint to stop at the limits.

    ## Example

    ```xml
    <joint name="pan" type="continuous">
      <limit lower="-1.57" upper="1.57" effort="10" velocity="1"/>
    ```

    ## Use instead

    Make the joint `type="revolute"`, or remove `lower` and `upper`. Very large bounds, such as `-1e16`, and bounds of a
    full turn are not reported.
    """

    code = "LW209"
    name = "limit-on-continuous"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every continuous joint with a limited range on which its author may rely."""
        for joint, limit in iterate_limits(subject, "continuous"):
            range_bounds = parse_bounds(limit)
            if (
                range_bounds is None
                or range_bounds[0] == range_bounds[1]
                or max(abs(range_bounds[0]), abs(range_bounds[1])) > UNBOUNDED_RAD
            ):
                continue
            if range_bounds[1] - range_bounds[0] >= 2 * pi - 0.02:
                continue  # a full turn covers all positions
            yield self.report(
                phrase(
                    "continuous joint '{name}' has limits from {lower} to {upper}, which nothing enforces",
                    name=joint.name,
                    lower=format_number(range_bounds[0]),
                    upper=format_number(range_bounds[1]),
                ),
                limit,
                "lower" if "lower" in limit.attributes else "upper",
                hint=phrase("make it 'revolute' if it stops there, or remove 'lower' and 'upper'"),
            )


class LimitOnFixed(Rule):
    """A fixed joint with a `<limit>`.

    ## Why

    A fixed joint does not move, so the limit has no effect. Often, the joint was made fixed for a test and not changed
    back. Some xacro macros write a limit for every joint type, which is harmless, so the rule is off by default.

    ## Example

    ```xml
    <joint name="camera_joint" type="fixed">
      <limit lower="-1" upper="1" effort="10" velocity="1"/>
    ```

    ## Use instead

    Remove the `<limit>`, or give the joint the type for which the limit was written.
    """

    code = "LW210"
    name = "limit-on-fixed"
    holds_for_parts = True
    default = False

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every fixed joint with a limit."""
        for joint, limit in iterate_limits(subject, "fixed"):
            yield self.report(
                phrase("<limit> of fixed joint '{name}' has no effect", name=joint.name),
                limit,
                hint=phrase("remove it, or change the type of the joint"),
                fix=remove_element(limit),
            )


class ZeroOutsideLimits(Rule):
    """A joint that cannot be at 0, where most tools start.

    ## Why

    joint_state_publisher starts such a joint in the middle of its range. Simulators start it at 0 and push it into its
    range with a jolt. A range without 0 is not a mistake, so the rule is off by default.

    ## Example

    ```xml
    <limit lower="0.5" upper="2" effort="10" velocity="1"/>
    ```

    ## Use instead

    Move or rotate the joint's `<origin>` so that 0 is a rest position, or give simulators an initial position.
    """

    code = "LW215"
    name = "zero-outside-limits"
    holds_for_parts = True
    severity = Severity.INFO
    default = False

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every bounded joint whose range does not contain 0."""
        for joint, limit in iterate_limits(subject, *BOUNDED_TYPES):
            range_bounds = parse_bounds(limit)
            if (
                range_bounds is not None
                and range_bounds[0] < range_bounds[1]
                and (range_bounds[0] > 0 or range_bounds[1] < 0)
            ):
                yield self.report(
                    phrase(
                        "joint '{name}' cannot be at 0: its range is {lower} to {upper}",
                        name=joint.name,
                        lower=format_number(range_bounds[0]),
                        upper=format_number(range_bounds[1]),
                    ),
                    limit,
                    "lower" if range_bounds[0] > 0 else "upper",
                    hint=phrase("move its <origin> so that 0 is in the range"),
                )
