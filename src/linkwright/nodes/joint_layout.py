"""The joints of joint_state_publisher: parameters, order, limits and mimic joints."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import isfinite, pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, did_you_mean, phrase
from linkwright.graph import Node, ParameterDescriptor, ParameterType
from linkwright.nodes.robot_state_publisher import MOVING_TYPES
from linkwright.urdf import Joint, JointType, Robot

_DEPENDENT_FIELDS = ("parent", "factor", "offset")


@dataclass(frozen=True, slots=True)
class Dependence:
    """The dependence of a joint on another one, in rad or m.

    ``position = factor * position of parent + offset``
    """

    parent: str
    factor: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True, slots=True)
class JointSettings:
    """The parameters of joint_state_publisher.

    Attributes:
        rate: the number of messages per second.
        publish_default_positions: whether joints without a received position are published at their zero position.
        publish_default_velocities: whether joints without a received velocity are published with velocity 0.
        publish_default_efforts: whether joints without a received effort are published with effort 0.
        use_mimic_tags: whether joints with a ``<mimic>`` tag follow the joint that the tag names.
        use_smallest_joint_limits: whether the soft limits of a ``<safety_controller>`` also apply.
        source_list: the topics from which joint states are read.
        delta: the distance that every joint moves in each cycle, in rad or m; 0 for no motion.
        zeros: the initial positions by joint, in rad or m.
        dependent_joints: the joints that depend on other joints, in addition to those of the description.
    """

    rate: float = 10.0
    publish_default_positions: bool = True
    publish_default_velocities: bool = False
    publish_default_efforts: bool = False
    use_mimic_tags: bool = True
    use_smallest_joint_limits: bool = True
    source_list: tuple[str, ...] = ()
    delta: float = 0.0
    zeros: Mapping[str, float] = field(default_factory=dict)
    dependent_joints: Mapping[str, Dependence] = field(default_factory=dict)


def declare_settings(node: Node) -> None:
    """Declare the parameters of joint_state_publisher.

    A given value keeps its type, as in the ROS node; ``rate: 2.5`` is therefore valid.

    Raises:
        LinkwrightError: the value of a parameter is invalid.
    """
    node.declare_parameters_from_overrides()
    defaults = JointSettings()
    for name, default in {
        "rate": 10,
        "publish_default_positions": defaults.publish_default_positions,
        "publish_default_velocities": defaults.publish_default_velocities,
        "publish_default_efforts": defaults.publish_default_efforts,
        "use_mimic_tags": defaults.use_mimic_tags,
        "use_smallest_joint_limits": defaults.use_smallest_joint_limits,
        "delta": defaults.delta,
    }.items():
        if not node.has_parameter(name):
            node.declare_parameter(name, default)
    if not node.has_parameter("source_list"):
        node.declare_parameter("source_list", [], ParameterDescriptor(type=ParameterType.STRING_ARRAY))


def parse_settings(values: Mapping[str, Any]) -> JointSettings:
    """Convert parameter values by name to settings.

    Raises:
        LinkwrightError: NODE201, values are invalid; the error lists all of them.
    """
    reader = _Reader(values)
    settings = JointSettings(
        rate=reader.read_number("rate", positive=True),
        publish_default_positions=reader.read_flag("publish_default_positions"),
        publish_default_velocities=reader.read_flag("publish_default_velocities"),
        publish_default_efforts=reader.read_flag("publish_default_efforts"),
        use_mimic_tags=reader.read_flag("use_mimic_tags"),
        use_smallest_joint_limits=reader.read_flag("use_smallest_joint_limits"),
        source_list=reader.read_texts("source_list"),
        delta=reader.read_number("delta"),
        zeros={joint: reader.read_number(f"zeros.{joint}") for joint in reader.list_names_below("zeros")},
        dependent_joints=reader.read_dependent_joints(),
    )
    if reader.problems:
        raise LinkwrightError(*reader.problems)
    return settings


class _Reader:
    """A reader of parameter values, which collects the problems."""

    def __init__(self, values: Mapping[str, Any]) -> None:
        self._values = values
        self.problems: list[Diagnostic] = []

    def list_names_below(self, prefix: str) -> list[str]:
        full_prefix = f"{prefix}."
        return [name[len(full_prefix) :] for name in self._values if name.startswith(full_prefix)]

    def read_flag(self, name: str) -> bool:
        value = self._values[name]
        if not isinstance(value, bool):
            self._add_problem(name, phrase("true or false"))
        return bool(value)

    def read_number(self, name: str, *, positive: bool = False) -> float:
        value = self._values[name]
        is_number = isinstance(value, (int, float)) and not isinstance(value, bool) and isfinite(value)
        if not is_number or (positive and value <= 0):
            self._add_problem(name, phrase("a positive number") if positive else phrase("a number"))
            return 1.0
        return float(value)

    def read_texts(self, name: str) -> tuple[str, ...]:
        value = self._values[name]
        if (
            not isinstance(value, Sequence)
            or isinstance(value, str)
            or not all(isinstance(item, str) for item in value)
        ):
            self._add_problem(name, phrase("a list of topic names"))
            return ()
        return tuple(value)

    def read_dependent_joints(self) -> dict[str, Dependence]:
        dependent: dict[str, dict[str, Any]] = {}
        for entry_name in self.list_names_below("dependent_joints"):
            # Joint names can contain dots, so split at the last dot.
            joint, _, field_name = entry_name.rpartition(".")
            if field_name not in _DEPENDENT_FIELDS or not joint:
                self.problems.append(
                    Diagnostic(
                        "NODE201",
                        phrase(
                            "invalid dependent_joint name '{name}': write JOINT.parent, JOINT.factor or JOINT.offset",
                            name=entry_name,
                        ),
                        hint=did_you_mean(field_name, _DEPENDENT_FIELDS),
                    )
                )
            else:
                dependent.setdefault(joint, {})[field_name] = f"dependent_joints.{entry_name}"
        return {joint: self._read_dependence(joint, names) for joint, names in dependent.items()}

    def _read_dependence(self, joint: str, names: Mapping[str, str]) -> Dependence:
        parent = self._values.get(names.get("parent", ""))
        if not isinstance(parent, str):
            self._add_problem(f"dependent_joints.{joint}.parent", phrase("the name of a joint"))
            parent = ""
        factor = self.read_number(names["factor"]) if "factor" in names else 1.0
        offset = self.read_number(names["offset"]) if "offset" in names else 0.0
        return Dependence(parent, factor, offset)

    def _add_problem(self, name: str, expected: Phrase) -> None:
        value = self._values.get(name)
        current_state = phrase("it is {value}", value=repr(value)) if value is not None else phrase("it is not given")
        self.problems.append(
            Diagnostic(
                "NODE201",
                phrase(
                    "parameter '{name}' must be {expected}, but {value}",
                    name=name,
                    expected=expected,
                    value=current_state,
                ),
            )
        )


Array = NDArray[np.float64]

_UNLIMITED_RANGE = {"revolute": 2.0 * pi, "continuous": 2.0 * pi, "prismatic": 2.0}
"""The range of the slider of a joint with infinite limits, by type: a full turn in rad, or two meters."""


@dataclass(frozen=True, slots=True)
class JointRange:
    """A published joint with finite position limits (rad or m).

    `zero` is the initial position: the joint's entry in ``zeros``. Without an entry, it is 0, or the middle of the
    range if 0 is outside the range.
    """

    name: str
    kind: JointType
    lower: float
    upper: float
    zero: float

    def clamp(self, position: float) -> float:
        """Return the nearest position within the limits."""
        return min(max(position, self.lower), self.upper)


@dataclass(frozen=True, slots=True, eq=False)
class JointLayout:
    """The joints of a robot as joint_state_publisher handles them.

    Attributes:
        ranges: every published joint by name, in the order of the file and of the messages.
        free: the joints that do not mimic another joint, in the same order; position arrays have one entry per free
            joint.
        dependent: the other joints by name, each with the joint that it mimics directly.
        master_indices: array of shape (n,): for each published joint, the index in `free` of the joint at the end of
            its mimic chain; -1 if that joint does not move.
        factor: array of shape (n,): published position = factor * position of the master + offset.
        offset: array of shape (n,), see `factor`.
        problems: the problems of the description; the affected joints are omitted or do not move.
    """

    ranges: Mapping[str, JointRange]
    free: tuple[JointRange, ...]
    dependent: Mapping[str, Dependence]
    master_indices: NDArray[np.intp]
    factor: Array
    offset: Array
    problems: tuple[str, ...]


def empty_layout() -> JointLayout:
    """Return the layout that is used without a description."""
    return JointLayout({}, (), {}, np.zeros(0, dtype=np.intp), np.zeros(0), np.zeros(0), ())


def make_layout(robot: Robot, settings: JointSettings) -> JointLayout:
    """Compute the layout for a robot.

    Raises:
        LinkwrightError: NODE202, joints mimic each other in a cycle.
    """
    problems: list[str] = []
    ranges: dict[str, JointRange] = {}
    dependent: dict[str, Dependence] = {}
    for joint in robot.joints.values():
        if joint.type not in MOVING_TYPES:
            continue
        limits = _read_limits(joint, settings, problems)
        if limits is None:
            continue
        zero = settings.zeros.get(joint.name, _choose_default_zero(*limits))
        ranges[joint.name] = JointRange(joint.name, joint.type, *limits, zero)
        # The parameter takes precedence over <mimic>, even after the description changes. In the ROS node, <mimic>
        # then takes precedence.
        if joint.name in settings.dependent_joints:
            dependent[joint.name] = settings.dependent_joints[joint.name]
        elif settings.use_mimic_tags and joint.mimic is not None:
            dependent[joint.name] = Dependence(joint.mimic.joint, joint.mimic.multiplier, joint.mimic.offset)
    free = tuple(ranges[name] for name in ranges if name not in dependent)
    free_indices = {joint.name: row for row, joint in enumerate(free)}
    mimic_chains = [_resolve_chain(name, dependent) for name in ranges]
    for name, (master, _, _) in zip(ranges, mimic_chains, strict=True):
        if master not in free_indices:
            problems.append(f"joint '{name}' follows joint '{master}', which does not move")
    return JointLayout(
        ranges,
        free,
        dependent,
        np.array([free_indices.get(master, -1) for master, _, _ in mimic_chains], dtype=np.intp),
        np.array([factor for _, factor, _ in mimic_chains], dtype=np.float64),
        np.array([offset for *_, offset in mimic_chains], dtype=np.float64),
        tuple(problems),
    )


def _resolve_chain(name: str, dependent: Mapping[str, Dependence]) -> tuple[str, float, float]:
    """Return the free joint at the end of a mimic chain, and the total factor and offset."""
    chain = [name]
    factor, offset = 1.0, 0.0
    while (dependence := dependent.get(name)) is not None:
        offset += factor * dependence.offset
        factor *= dependence.factor
        name = dependence.parent
        if name in chain:
            message = phrase("Found an infinite recursive mimic chain: {value}", value=[*chain, name])
            raise LinkwrightError(Diagnostic("NODE202", message))
        chain.append(name)
    return name, factor, offset


def _choose_default_zero(lower: float, upper: float) -> float:
    return (lower + upper) / 2.0 if lower > 0.0 or upper < 0.0 else 0.0


def _read_limits(joint: Joint, settings: JointSettings, problems: list[str]) -> tuple[float, float] | None:
    if joint.type == "continuous":
        lower, upper = -pi, pi
    else:
        missing_limit = _find_missing_limit(joint)
        if missing_limit is not None or joint.limit is None:
            problems.append(
                f'Limits must be specified for joint "{joint.name}" of type "{joint.type}"'
                if missing_limit is None
                else f'"{missing_limit}" limit must be specified for joint "{joint.name}" of type "{joint.type}"'
            )
            return None
        lower, upper = joint.limit.lower, joint.limit.upper
    if settings.use_smallest_joint_limits and joint.safety is not None:
        if _is_set(joint, "safety_controller", "soft_lower_limit"):
            lower = max(lower, joint.safety.soft_lower_limit)
        if _is_set(joint, "safety_controller", "soft_upper_limit"):
            upper = min(upper, joint.safety.soft_upper_limit)
    return _make_limits_finite(min(lower, upper), max(lower, upper), _UNLIMITED_RANGE[joint.type])


def _find_missing_limit(joint: Joint) -> str | None:
    """Return the name of the first missing limit attribute, or None.

    urdfdom reads a missing limit as 0, and joint_state_publisher rejects it.
    """
    if joint.limit is None:
        return None
    for name, value in (("lower", joint.limit.lower), ("upper", joint.limit.upper)):
        if isfinite(value) and not _is_set(joint, "limit", name):
            return name
    return None


def _is_set(joint: Joint, tag: str, attribute: str) -> bool:
    """Return whether the file sets an attribute of a joint's child element.

    The result is always True for a joint that was not read from a file.
    """
    if joint.element is None:
        return True
    element = joint.element.first(tag)
    return element is not None and attribute in element.attributes


def _make_limits_finite(lower: float, upper: float, default_range: float) -> tuple[float, float]:
    if isfinite(lower) and isfinite(upper):
        return lower, upper
    if isfinite(lower):
        return lower, lower + default_range
    if isfinite(upper):
        return upper - default_range, upper
    return -default_range / 2.0, default_range / 2.0
