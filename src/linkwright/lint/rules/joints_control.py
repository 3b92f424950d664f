"""Rules about the elements for controllers: safety limits, dynamics, calibration."""

from __future__ import annotations

from collections.abc import Iterable
from math import inf

from linkwright.diagnostics import Diagnostic, Severity, phrase
from linkwright.lint.fix import Fix, remove_element, value_edit
from linkwright.lint.rule import Rule
from linkwright.lint.subject import Subject
from linkwright.lint.walk import format_number, iterate_joint_children, parse_number
from linkwright.urdf import Joint
from linkwright.xmltree import Element

_TOLERANCE = 1e-6
_MAX_OVERSHOOT = 0.25
"""The fraction of the range by which a soft limit may exceed one end, where a mechanical stop is assumed."""


class SoftLimitsOutside(Rule):
    """A joint whose soft limits are outside its limits.

    ## Why

    A safety controller begins to act at the soft limits, so that the joint stops before its limits. If the soft limits
    are outside the limits, the controller never acts. A soft limit slightly beyond only one of the limits is not
    reported: grippers that press on an object, such as those of the PR2, rely on the mechanical stop at this end.

    ## Example

    ```xml
    <limit lower="-1" upper="1" effort="10" velocity="1"/>
    <safety_controller soft_lower_limit="-2" soft_upper_limit="2" k_position="20" k_velocity="10"/>
    ```

    ## Use instead

    ```xml
    <safety_controller soft_lower_limit="-0.9" soft_upper_limit="0.9" k_position="20" k_velocity="10"/>
    ```
    """

    code = "LW240"
    name = "soft-limits-outside"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report soft limits outside the limits.

        A small excess at one end is accepted if the other soft limit is inside its limit.
        """
        for joint, _, safety in iterate_joint_children(subject, "safety_controller"):
            if joint.type not in ("revolute", "prismatic") or joint.limit is None or joint.safety is None:
                continue
            lower, upper = joint.limit.lower, joint.limit.upper
            if not lower < upper:
                continue
            lower_excess = lower - joint.safety.soft_lower_limit if "soft_lower_limit" in safety.attributes else 0
            upper_excess = joint.safety.soft_upper_limit - upper if "soft_upper_limit" in safety.attributes else 0
            if min(lower_excess, upper_excess) < -_TOLERANCE and max(lower_excess, upper_excess) <= _MAX_OVERSHOOT * (
                upper - lower
            ):
                continue
            if lower_excess > _TOLERANCE:
                yield self._outside_finding(
                    joint, safety, "soft_lower_limit", joint.safety.soft_lower_limit, "lower", lower
                )
            if upper_excess > _TOLERANCE:
                yield self._outside_finding(
                    joint, safety, "soft_upper_limit", joint.safety.soft_upper_limit, "upper", upper
                )

    def _outside_finding(
        self, joint: Joint, safety: Element, name: str, soft_limit: float, bound_name: str, limit: float
    ) -> Diagnostic:
        is_lower = bound_name == "lower"
        return self.report(
            phrase(
                "'{name}' of joint '{joint_name}' is {comparison} its limit: {soft}, but '{bound}' is {limit}",
                name=name,
                joint_name=joint.name,
                comparison=phrase("below") if is_lower else phrase("above"),
                soft=format_number(soft_limit),
                bound=bound_name,
                limit=format_number(limit),
            ),
            safety,
            name,
            hint=phrase(
                "write a value {comparison} than {limit}, so that the soft limit acts before the limit",
                comparison=phrase("more") if is_lower else phrase("less"),
                limit=format_number(limit),
            ),
        )


class SoftLimitsInverted(Rule):
    """A joint whose lower soft limit is not below its upper one.

    ## Why

    There is no position at which the safety controller does not act on the joint.

    ## Example

    ```xml
    <safety_controller soft_lower_limit="1" soft_upper_limit="-1" k_position="20" k_velocity="10"/>
    ```

    ## Use instead

    ```xml
    <safety_controller soft_lower_limit="-1" soft_upper_limit="1" k_position="20" k_velocity="10"/>
    ```
    """

    code = "LW241"
    name = "soft-limits-inverted"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every pair of soft limits without a range between them.

        If no soft limits are given, both are 0 and have no effect.
        """
        for joint, _, safety in iterate_joint_children(subject, "safety_controller"):
            controller = joint.safety
            if controller is None or controller.soft_lower_limit == controller.soft_upper_limit == 0:
                continue
            if controller.soft_lower_limit >= controller.soft_upper_limit:
                edits = [
                    value_edit(safety, "soft_lower_limit", safety.attributes.get("soft_upper_limit", "0")),
                    value_edit(safety, "soft_upper_limit", safety.attributes.get("soft_lower_limit", "0")),
                ]
                available_edits = tuple(edit for edit in edits if edit is not None)
                yield self.report(
                    phrase(
                        "the soft limits of joint '{name}' leave no range: {soft_lower_limit} to {soft_upper_limit}",
                        name=joint.name,
                        soft_lower_limit=format_number(controller.soft_lower_limit),
                        soft_upper_limit=format_number(controller.soft_upper_limit),
                    ),
                    safety,
                    "soft_lower_limit",
                    hint=phrase("exchange the two values")
                    if controller.soft_lower_limit > controller.soft_upper_limit
                    else phrase("give a lower soft limit below the upper soft limit"),
                    fix=Fix(available_edits, safe=False) if len(available_edits) == 2 else None,
                )


class SafetyGainNegative(Rule):
    """A safety controller with a negative gain.

    ## Why

    A negative gain drives the joint towards the limit that it should avoid.

    ## Example

    ```xml
    <safety_controller k_velocity="-10" k_position="20"/>
    ```

    ## Use instead

    ```xml
    <safety_controller k_velocity="10" k_position="20"/>
    ```
    """

    code = "LW242"
    name = "safety-gain-negative"
    holds_for_parts = True
    severity = Severity.ERROR

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every gain below 0."""
        for joint, _, safety in iterate_joint_children(subject, "safety_controller"):
            for name in ("k_velocity", "k_position"):
                gain = parse_number(safety, name)
                if gain is not None and gain < 0:
                    yield self.report(
                        phrase(
                            "'{name}' of joint '{joint_name}' is negative: {value}",
                            name=name,
                            joint_name=joint.name,
                            value=format_number(gain),
                        ),
                        safety,
                        name,
                        hint=phrase(
                            "write {value}: a negative gain drives the joint towards its limit",
                            value=format_number(-gain),
                        ),
                    )


class DynamicsNegative(Rule):
    """A joint with negative damping or friction.

    ## Why

    A negative value feeds energy into the joint: the simulation becomes unstable, or the simulator refuses the model.

    ## Example

    ```xml
    <dynamics damping="-0.1" friction="0.2"/>
    ```

    ## Use instead

    ```xml
    <dynamics damping="0.1" friction="0.2"/>
    ```
    """

    code = "LW243"
    name = "dynamics-negative"
    holds_for_parts = True
    severity = Severity.ERROR

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every negative damping or friction."""
        for joint, _, dynamics in iterate_joint_children(subject, "dynamics"):
            for name in ("damping", "friction"):
                coefficient = parse_number(dynamics, name)
                if coefficient is not None and coefficient < 0:
                    edit = value_edit(dynamics, name, dynamics.attributes[name].strip().lstrip("-"))
                    yield self.report(
                        phrase(
                            "'{name}' of joint '{joint_name}' is negative: {value}",
                            name=name,
                            joint_name=joint.name,
                            value=format_number(coefficient),
                        ),
                        dynamics,
                        name,
                        hint=phrase(
                            "write {value}: a negative value feeds energy into the joint",
                            value=format_number(-coefficient),
                        ),
                        fix=Fix((edit,), safe=False) if edit else None,
                    )


class DynamicsOnFixed(Rule):
    """A fixed joint with `<dynamics>`.

    ## Why

    A fixed joint does not move, so the element has no effect. Some macros write it for every joint, which is harmless,
    so the rule is off by default.

    ## Example

    ```xml
    <joint name="camera_joint" type="fixed">
      <dynamics damping="0.1"/>
    ```

    ## Use instead

    Remove `<dynamics>`.
    """

    code = "LW244"
    name = "dynamics-on-fixed"
    holds_for_parts = True
    default = False

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every fixed joint with dynamics."""
        for joint, _, dynamics in iterate_joint_children(subject, "dynamics"):
            if joint.type == "fixed":
                yield self.report(
                    phrase("<dynamics> of fixed joint '{name}' has no effect", name=joint.name),
                    dynamics,
                    hint=phrase("remove it"),
                    fix=remove_element(dynamics),
                )


class CalibrationOutside(Rule):
    """A calibration position outside the joint's limits.

    ## Why

    The joint can never reach the position where its reference signal changes, so a calibration never ends. ROS 2 does
    not use the calibration position, so the rule is off by default.

    ## Example

    ```xml
    <calibration rising="2"/>
    <limit lower="-1" upper="1" effort="10" velocity="1"/>
    ```

    ## Use instead

    Give the position of the reference mark, in rad or m, within the limits.
    """

    code = "LW245"
    name = "calibration-outside"
    default = False
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every reference position that a bounded joint cannot reach."""
        for joint, _, calibration in iterate_joint_children(subject, "calibration"):
            lower, upper = (joint.limit.lower, joint.limit.upper) if joint.limit else (-inf, inf)
            if joint.type not in ("revolute", "prismatic") or not lower < upper:
                continue
            for name in ("rising", "falling"):
                position = parse_number(calibration, name)
                if position is not None and not lower - _TOLERANCE <= position <= upper + _TOLERANCE:
                    yield self.report(
                        phrase(
                            "'{name}' of joint '{joint_name}' is outside its limits: {position}, but the range is "
                            "{lower} to {upper}",
                            name=name,
                            joint_name=joint.name,
                            position=format_number(position),
                            lower=format_number(lower),
                            upper=format_number(upper),
                        ),
                        calibration,
                        name,
                        hint=phrase("give a position that the joint can reach"),
                    )
