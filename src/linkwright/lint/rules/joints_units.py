"""Rules about bounds of joints that are in the wrong unit, or too large to have an effect."""

from __future__ import annotations

from collections.abc import Iterable
from math import log10, pi, radians

from linkwright.diagnostics import Diagnostic, Severity, phrase
from linkwright.lint.option import Option
from linkwright.lint.rule import Rule
from linkwright.lint.subject import Subject
from linkwright.lint.walk import UNBOUNDED_RAD, format_number, iterate_limits, parse_bounds, parse_number
from linkwright.urdf.values import looks_like_degrees


class LimitInDegrees(Rule):
    """A revolute joint with a limit so large that it can only be an angle in degrees.

    ## Why

    Angles are in radians. 170.5 rad is 27 turns: sliders become useless, and planners search positions that the joint
    cannot reach. The URDF reader reports multiples of 5 (URDF190).

    ## Example

    ```xml
    <limit lower="-170.5" upper="170.5" effort="10" velocity="1"/>
    ```

    ## Use instead

    ```xml
    <limit lower="-2.97579" upper="2.97579" effort="10" velocity="1"/>
    ```

    In xacro, `${radians(170.5)}`.
    """

    code = "LW211"
    name = "limit-in-degrees"
    holds_for_parts = True
    options = (Option("most-turns", 3.0, "the largest number of turns to either side that is considered plausible"),)

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every limit of a revolute joint that is plausible in degrees, but not in radians."""
        max_angle = self.option(subject, "most-turns", float) * 2 * pi
        for joint, limit in iterate_limits(subject, "revolute"):
            range_bounds = parse_bounds(limit)
            if range_bounds is None or max(map(abs, range_bounds)) > 360 or looks_like_degrees(*range_bounds):
                continue
            for name, angle in zip(("lower", "upper"), range_bounds, strict=True):
                if abs(angle) > max_angle:
                    yield self.report(
                        phrase(
                            "'{name}' in <limit> of joint '{joint_name}' is {value} rad, which is {turns} turns",
                            name=name,
                            joint_name=joint.name,
                            value=format_number(angle),
                            turns=format_number(abs(angle) / (2 * pi)),
                        ),
                        limit,
                        name,
                        hint=phrase(
                            "write {radians} if the value is in degrees", radians=format_number(radians(angle))
                        ),
                    )


class LimitPracticallyUnbounded(Rule):
    """A revolute joint with limits so large that it might as well be continuous.

    ## Why

    With a range of thousands of turns, sliders and planners sample meaningless positions, and numbers lose precision.
    `continuous` expresses the intent.

    ## Example

    ```xml
    <joint name="wheel_joint" type="revolute">
      <limit lower="-100000" upper="100000" effort="10" velocity="1"/>
    ```

    ## Use instead

    ```xml
    <joint name="wheel_joint" type="continuous">
      <limit effort="10" velocity="1"/>
    ```
    """

    code = "LW212"
    name = "limit-endless"
    holds_for_parts = True
    severity = Severity.INFO

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every revolute joint with both bounds beyond a thousand radians."""
        for joint, limit in iterate_limits(subject, "revolute"):
            range_bounds = parse_bounds(limit)
            if range_bounds is not None and range_bounds[0] <= -UNBOUNDED_RAD and range_bounds[1] >= UNBOUNDED_RAD:
                yield self.report(
                    phrase(
                        "revolute joint '{name}' turns from {lower} to {upper} rad",
                        name=joint.name,
                        lower=format_number(range_bounds[0]),
                        upper=format_number(range_bounds[1]),
                    ),
                    limit,
                    "lower",
                    hint=phrase("make it 'continuous', without 'lower' and 'upper'"),
                )


class LimitInMillimeters(Rule):
    """A prismatic joint with a limit so large that it can only be in millimeters.

    ## Why

    Lengths are in meters. A travel of 120 m is usually 120 mm, copied from a data sheet. Limits such as -100 and 100
    are not reported, because they mean that there are no limits.

    ## Example

    ```xml
    <joint name="lift" type="prismatic">
      <limit lower="0" upper="120" effort="100" velocity="0.2"/>
    ```

    ## Use instead

    ```xml
      <limit lower="0" upper="0.12" effort="100" velocity="0.2"/>
    ```
    """

    code = "LW213"
    name = "limit-in-millimeters"
    holds_for_parts = True
    options = (Option("longest", 20.0, "the largest travel to either side, in m, that is considered plausible"),)

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every limit of a prismatic joint that is implausible in meters."""
        max_position = self.option(subject, "longest", float)
        for joint, limit in iterate_limits(subject, "prismatic"):
            range_bounds = parse_bounds(limit)
            if (
                range_bounds is not None
                and -range_bounds[0] == range_bounds[1] > 0
                and log10(range_bounds[1]).is_integer()
            ):
                continue  # limits such as -100 to 100 mean that there are no limits
            for name in ("lower", "upper"):
                position = parse_number(limit, name)
                if position is not None and max_position < abs(position) <= 10 * UNBOUNDED_RAD:
                    yield self.report(
                        phrase(
                            "'{name}' in <limit> of prismatic joint '{joint_name}' is {distance} m",
                            name=name,
                            joint_name=joint.name,
                            distance=format_number(position),
                        ),
                        limit,
                        name,
                        hint=phrase(
                            "write {meters} if the value is in millimeters", meters=format_number(position / 1000)
                        ),
                    )
