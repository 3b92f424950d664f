"""The parameters of joint_state_publisher."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import isfinite
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, did_you_mean, phrase
from linkwright.graph import Node, ParameterDescriptor, ParameterType

_DEPENDENT_FIELDS = ("parent", "factor", "offset")


@dataclass(frozen=True, slots=True)
class Dependence:
    """A dependent joint: its position is ``factor * position of parent + offset`` (rad or m)."""

    parent: str
    factor: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True, slots=True)
class JointSettings:
    """The parameters as one object.

    Attributes:
        rate: messages a second.
        publish_default_positions: whether joints without a message have their zero position.
        publish_default_velocities: give them velocity 0.
        publish_default_efforts: give them effort 0.
        use_mimic_tags: joints with a ``<mimic>`` follow their master.
        use_smallest_joint_limits: the soft limits of a ``<safety_controller>`` count too.
        source_list: topics of joint states to take over.
        delta: how far every joint moves each time, rad or m; 0 for not at all.
        zeros: starting positions by joint, rad or m.
        dependent_joints: joints that follow others, regardless of the description.
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
    """Declare the parameters. Values from outside keep their types, as in the ROS node: ``rate: 2.5`` is fine.

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


def settings_from(values: Mapping[str, Any]) -> JointSettings:
    """Convert parameter values by name to settings.

    Raises:
        LinkwrightError: values that mean nothing (NODE201), all of them.
    """
    reader = _Reader(values)
    settings = JointSettings(
        rate=reader.number("rate", positive=True),
        publish_default_positions=reader.flag("publish_default_positions"),
        publish_default_velocities=reader.flag("publish_default_velocities"),
        publish_default_efforts=reader.flag("publish_default_efforts"),
        use_mimic_tags=reader.flag("use_mimic_tags"),
        use_smallest_joint_limits=reader.flag("use_smallest_joint_limits"),
        source_list=reader.texts("source_list"),
        delta=reader.number("delta"),
        zeros={joint: reader.number(f"zeros.{joint}") for joint in reader.below("zeros")},
        dependent_joints=reader.dependent_joints(),
    )
    if reader.problems:
        raise LinkwrightError(*reader.problems)
    return settings


class _Reader:
    def __init__(self, values: Mapping[str, Any]) -> None:
        self._values = values
        self.problems: list[Diagnostic] = []

    def below(self, prefix: str) -> list[str]:
        start = f"{prefix}."
        return [name[len(start) :] for name in self._values if name.startswith(start)]

    def flag(self, name: str) -> bool:
        value = self._values[name]
        if not isinstance(value, bool):
            self._complain(name, phrase("true or false"))
        return bool(value)

    def number(self, name: str, *, positive: bool = False) -> float:
        value = self._values[name]
        valid = isinstance(value, (int, float)) and not isinstance(value, bool) and isfinite(value)
        if not valid or (positive and value <= 0):
            self._complain(name, phrase("a positive number") if positive else phrase("a number"))
            return 1.0
        return float(value)

    def texts(self, name: str) -> tuple[str, ...]:
        value = self._values[name]
        if not isinstance(value, Sequence) or isinstance(value, str) or not all(isinstance(v, str) for v in value):
            self._complain(name, phrase("a list of topic names"))
            return ()
        return tuple(value)

    def dependent_joints(self) -> dict[str, Dependence]:
        dependent: dict[str, dict[str, Any]] = {}
        for rest in self.below("dependent_joints"):
            # Joint names may have dots themselves, so the last one counts.
            joint, _, entry = rest.rpartition(".")
            if entry not in _DEPENDENT_FIELDS or not joint:
                self.problems.append(
                    Diagnostic(
                        "NODE201",
                        phrase(
                            "invalid dependent_joint name '{rest}': allowed are JOINT.parent, JOINT.factor and"
                            " JOINT.offset",
                            rest=rest,
                        ),
                        hint=did_you_mean(entry, _DEPENDENT_FIELDS),
                    )
                )
            else:
                dependent.setdefault(joint, {})[entry] = f"dependent_joints.{rest}"
        return {joint: self._dependence(joint, names) for joint, names in dependent.items()}

    def _dependence(self, joint: str, names: Mapping[str, str]) -> Dependence:
        parent = self._values.get(names.get("parent", ""))
        if not isinstance(parent, str):
            self._complain(f"dependent_joints.{joint}.parent", phrase("the name of a joint"))
            parent = ""
        factor = self.number(names["factor"]) if "factor" in names else 1.0
        offset = self.number(names["offset"]) if "offset" in names else 0.0
        return Dependence(parent, factor, offset)

    def _complain(self, name: str, expected: Phrase) -> None:
        value = self._values.get(name)
        given = phrase("it is {value}", value=repr(value)) if value is not None else phrase("it is not given")
        self.problems.append(
            Diagnostic(
                "NODE201",
                phrase("parameter '{name}' must be {expected}, and {given}", name=name, expected=expected, given=given),
            )
        )
