"""The data of a description's ``<ros2_control>`` elements.

Source: hardware_interface's component parser (elements, types, defaults). A joint mimics another joint if the URDF
joint has ``<mimic>`` (Jazzy), or if the component has the parameters ``mimic``, ``multiplier`` and ``offset`` (Humble);
``mimic="false"`` disables this.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import nan

from linkwright.diagnostics import Diagnostic, Phrase, Severity, did_you_mean, phrase
from linkwright.urdf import Robot
from linkwright.xmltree import Element

SYSTEM, ACTUATOR, SENSOR = "system", "actuator", "sensor"
_TYPES = (SYSTEM, ACTUATOR, SENSOR)
_TRUE_TEXTS = ("true", "True", "TRUE", "1")


@dataclass(frozen=True, slots=True)
class InterfaceDescription:
    """An interface of a component.

    Attributes:
        name: the kind of interface, such as ``position``.
        minimum, maximum: the bounds of commands; NaN if they are not set.
        initial_value: the initial value of a state; NaN if it is not set.
        is_limited: whether commands are limited if the manager enforces limits.
        parameters: all parameters as written.
    """

    name: str
    minimum: float = nan
    maximum: float = nan
    initial_value: float = nan
    is_limited: bool = True
    parameters: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class MimicDescription:
    """A mimic relation: position = `multiplier` * position of `joint` + `offset`."""

    joint: str
    multiplier: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True, slots=True)
class ComponentDescription:
    """A joint, sensor or GPIO of hardware.

    Attributes:
        name: the component's name.
        kind: ``joint``, ``sensor`` or ``gpio``.
        commands, states: the component's interfaces.
        parameters: the parameters as written.
        mimic: the relation to the joint that the component mimics; None if it mimics no joint.
    """

    name: str
    kind: str
    commands: tuple[InterfaceDescription, ...] = ()
    states: tuple[InterfaceDescription, ...] = ()
    parameters: Mapping[str, str] = field(default_factory=dict)
    mimic: MimicDescription | None = None


@dataclass(frozen=True, slots=True)
class HardwareDescription:
    """A ``<ros2_control>`` element.

    Attributes:
        name: the hardware's name.
        type: ``system``, ``actuator`` or ``sensor``.
        plugin: the type name of the hardware class.
        is_async: whether the hardware requests its own thread.
        parameters: the parameters of the hardware.
        joints, sensors, gpios: the components, in file order.
    """

    name: str
    type: str
    plugin: str
    is_async: bool = False
    parameters: Mapping[str, str] = field(default_factory=dict)
    joints: tuple[ComponentDescription, ...] = ()
    sensors: tuple[ComponentDescription, ...] = ()
    gpios: tuple[ComponentDescription, ...] = ()

    @property
    def components(self) -> tuple[ComponentDescription, ...]:
        """The joints, sensors and GPIOs."""
        return (*self.joints, *self.sensors, *self.gpios)

    def is_set(self, name: str) -> bool:
        """Return whether a parameter of the hardware is ``true``."""
        return self.parameters.get(name, "").strip() in _TRUE_TEXTS


def hardware_from_robot(robot: Robot) -> tuple[list[HardwareDescription], list[Diagnostic]]:
    """Return the hardware of a robot, and findings about its ``<ros2_control>`` elements.

    Invalid elements are left out: hardware without a name or with an invalid type, joints that the robot does not have,
    and values that are not numbers.
    """
    reader = _Reader(robot)
    hardware_list = [
        reader.parse_hardware(extension) for extension in robot.extensions if extension.tag == "ros2_control"
    ]
    hardware_by_name: dict[str, HardwareDescription] = {}
    for hardware in hardware_list:
        if hardware is not None:
            hardware_by_name.setdefault(hardware.name, hardware)
    if not any(extension.tag == "ros2_control" for extension in robot.extensions):
        message = phrase("the description has no <ros2_control>")
        hint = phrase("add <ros2_control> with the hardware, its joints and their interfaces")
        reader.findings.append(Diagnostic("CTL110", message, severity=Severity.WARNING, hint=hint))
    return list(hardware_by_name.values()), reader.findings


class _Reader:
    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self.findings: list[Diagnostic] = []

    def parse_hardware(self, element: Element) -> HardwareDescription | None:
        name, kind = element.attributes.get("name", ""), element.attributes.get("type", "")
        if not name or kind not in _TYPES:
            message = phrase("<ros2_control> has no name, or its type '{kind}' is not valid", kind=kind)
            self._report(
                "CTL111", message, element, phrase('give it a name, and write type="system", "actuator" or "sensor"')
            )
            return None
        hardware = element.first("hardware")
        plugin = hardware.first("plugin") if hardware is not None else None
        if plugin is None or not plugin.text().strip():
            message = phrase("<ros2_control> '{name}' does not name a hardware plugin", name=name)
            self._report("CTL112", message, element, phrase("write <hardware><plugin>mock_components/GenericSystem"))
            return None
        joints = [self._parse_component(child, "joint") for child in element.elements("joint")]
        names = [joint.name for joint in joints]
        for joint_component, joint_element in zip(joints, element.elements("joint"), strict=True):
            if joint_component.name not in self._robot.joints:
                message = phrase(
                    "<ros2_control> names the joint '{name}', which the robot does not have",
                    name=joint_component.name,
                )
                self._report("CTL113", message, joint_element, did_you_mean(joint_component.name, self._robot.joints))
            elif joint_component.mimic is not None and joint_component.mimic.joint not in names:
                message = phrase(
                    "the mimicked joint '{name}' is not in this <ros2_control>", name=joint_component.mimic.joint
                )
                self._report("CTL114", message, joint_element, did_you_mean(joint_component.mimic.joint, names))
        return HardwareDescription(
            name,
            kind,
            plugin.text().strip(),
            element.attributes.get("is_async", "").strip() in _TRUE_TEXTS,
            _parse_parameters(hardware),
            tuple(joint for joint in joints if joint.name in self._robot.joints),
            tuple(self._parse_component(child, "sensor") for child in element.elements("sensor")),
            tuple(self._parse_component(child, "gpio") for child in element.elements("gpio")),
        )

    def _parse_component(self, element: Element, kind: str) -> ComponentDescription:
        name, parameters = element.attributes.get("name", ""), _parse_parameters(element)
        return ComponentDescription(
            name,
            kind,
            self._parse_interfaces(element, "command_interface"),
            self._parse_interfaces(element, "state_interface"),
            parameters,
            self._parse_mimic(name, element, parameters) if kind == "joint" else None,
        )

    def _parse_mimic(self, name: str, element: Element, parameters: Mapping[str, str]) -> MimicDescription | None:
        if "mimic" in parameters:
            multiplier, offset = (parameters.get(item, "") for item in ("multiplier", "offset"))
            return MimicDescription(
                parameters["mimic"],
                1.0 if not multiplier else self._parse_number(multiplier, element),
                0.0 if not offset else self._parse_number(offset, element),
            )
        joint = self._robot.joints.get(name)
        if joint is None or joint.mimic is None or element.attributes.get("mimic") in ("false", "False"):
            return None
        return MimicDescription(joint.mimic.joint, joint.mimic.multiplier, joint.mimic.offset)

    def _parse_interfaces(self, element: Element, tag: str) -> tuple[InterfaceDescription, ...]:
        interfaces = {}
        for child in element.elements(tag):
            parameters = _parse_parameters(child)
            minimum, maximum, initial = (
                self._parse_number(parameters[name], child) if parameters.get(name, "").strip() else nan
                for name in ("min", "max", "initial_value")
            )
            name = child.attributes.get("name", "")
            is_limited = _is_limited(element) and _is_limited(child)
            interfaces[name] = InterfaceDescription(name, minimum, maximum, initial, is_limited, parameters)
        return tuple(interfaces.values())

    def _parse_number(self, text: str, element: Element) -> float:
        try:
            return float(text)
        except ValueError:
            if text.strip() in (*_TRUE_TEXTS, "false", "False"):
                return float(text.strip() in _TRUE_TEXTS)
            self._report("CTL115", phrase("'{text}' is not a number", text=text), element, None)
            return nan

    def _report(self, code: str, message: Phrase, element: Element, hint: Phrase | None) -> None:
        self.findings.append(
            Diagnostic(code, message, element.span(), Severity.WARNING, hint=hint, source=element.source)
        )


def _is_limited(element: Element) -> bool:
    limits = element.first("limits")
    return limits is None or limits.attributes.get("enable", "true").strip() in _TRUE_TEXTS


def _parse_parameters(element: Element | None) -> dict[str, str]:
    if element is None:
        return {}
    return {child.attributes.get("name", ""): child.text().strip() for child in element.elements("param")}
