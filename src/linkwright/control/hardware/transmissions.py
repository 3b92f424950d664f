"""Hardware of ROS 1: joints with ``<transmission>`` elements directly in ``<robot>``.

Source: transmission_interface's parser and gazebo_ros_control's ``DefaultRobotHWSim`` (elements, the first interface of
a joint, interfaces in ``<actuator>``). Commands and states are those of the joint, so ``<mechanicalReduction>`` has no
effect, as in Gazebo.
"""

from __future__ import annotations

from linkwright.control.hardware.description import (
    SYSTEM,
    ComponentDescription,
    HardwareDescription,
    InterfaceDescription,
    MimicDescription,
)
from linkwright.control.hardware.interfaces import EFFORT, POSITION, VELOCITY
from linkwright.diagnostics import Diagnostic, Phrase, Severity, did_you_mean, joined, phrase
from linkwright.urdf import Joint, Robot
from linkwright.xmltree import Element

HARDWARE_NAME = "gazebo_ros_control"
"""The name of the hardware that a robot's transmissions describe."""
_PLUGIN_TYPE = "gazebo_ros_control/DefaultRobotHWSim"
_INTERFACES_BY_CLASS = {
    "EffortJointInterface": EFFORT,
    "PositionJointInterface": POSITION,
    "VelocityJointInterface": VELOCITY,
}
_MULTI_JOINT_TYPES = ("DifferentialTransmission", "FourBarLinkageTransmission")
_STATE_INTERFACES = tuple(InterfaceDescription(kind) for kind in (POSITION, VELOCITY, EFFORT))


def hardware_from_transmissions(robot: Robot) -> tuple[list[HardwareDescription], list[Diagnostic]]:
    """Return the hardware of a robot's ``<transmission>`` elements, and findings about them.

    Each joint has one command interface, and state interfaces for position, velocity and effort. Transmissions that
    gazebo_ros_control cannot use are left out.
    """
    reader = _Reader(robot)
    elements = [extension for extension in robot.extensions if extension.tag == "transmission"]
    joints: dict[str, ComponentDescription] = {}
    for element in elements:
        joint = reader.joint(element)
        if joint is not None:
            joints.setdefault(joint.name, joint)
    if not elements:
        message = phrase("the description has no <transmission>, so there is nothing to control")
        hint = phrase("add <ros2_control> with the joints, and replace the plugin with libgazebo_ros2_control.so")
        reader.findings.append(Diagnostic("CTL116", message, severity=Severity.WARNING, hint=hint))
    if not joints:
        return [], reader.findings
    return [HardwareDescription(HARDWARE_NAME, SYSTEM, _PLUGIN_TYPE, joints=tuple(joints.values()))], reader.findings


class _Reader:
    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self.findings: list[Diagnostic] = []

    def joint(self, transmission: Element) -> ComponentDescription | None:
        """Return the joint of a transmission with its interfaces, or None if it cannot be used."""
        name = transmission.attributes.get("name", "")
        joints = list(transmission.elements("joint"))
        kind = _strip_package(_get_type(transmission))
        if kind in _MULTI_JOINT_TYPES or len(joints) > 1:
            message = phrase(
                "transmission '{name}' is left out: gazebo_ros_control drives one joint for each transmission",
                name=name,
            )
            self._report("CTL117", message, transmission, phrase("write a SimpleTransmission for each of its joints"))
            return None
        if not joints:
            message = phrase("transmission '{name}' is left out: it has no <joint>", name=name)
            self._report("CTL118", message, transmission, phrase("name the joint that the transmission drives"))
            return None
        joint_name = joints[0].attributes.get("name", "")
        joint = self._robot.joints.get(joint_name)
        if joint is None:
            message = phrase(
                "transmission '{name}' names the joint '{joint}', which the robot does not have",
                name=name,
                joint=joint_name,
            )
            self._report("CTL118", message, joints[0], did_you_mean(joint_name, self._robot.joints))
            return None
        interface = self._find_interface(transmission, joints[0], joint_name)
        if interface is None:
            return None
        return ComponentDescription(
            joint_name, "joint", (InterfaceDescription(interface),), _STATE_INTERFACES, mimic=_get_mimic(joint)
        )

    def _find_interface(self, transmission: Element, joint: Element, joint_name: str) -> str | None:
        """Return the kind of a joint's command interface, or None if it has no valid one.

        Old files have the interface in ``<actuator>``.
        """
        elements = list(joint.elements("hardwareInterface"))
        if not elements:
            elements = [
                interface
                for actuator in list(transmission.elements("actuator"))[:1]
                for interface in actuator.elements("hardwareInterface")
            ]
        names = [_strip_package(element.text()) for element in elements]
        if len(names) > 1:
            message = phrase(
                "joint '{joint}' has several hardware interfaces, but a simulated joint has only one: {name} is used",
                joint=joint_name,
                name=names[0],
            )
            self._report("CTL119", message, joint, phrase("remove the other <hardwareInterface> elements"))
        if names and names[0] in _INTERFACES_BY_CLASS:
            return _INTERFACES_BY_CLASS[names[0]]
        message = phrase("joint '{joint}' is left out: it has no <hardwareInterface>", joint=joint_name)
        if names:
            message = phrase(
                "joint '{joint}' is left out: the hardware interface '{name}' is unknown",
                joint=joint_name,
                name=names[0],
            )
        hint = phrase(
            "write one of {names}", names=joined([f"hardware_interface/{name}" for name in _INTERFACES_BY_CLASS])
        )
        self._report("CTL118", message, joint, hint)
        return None

    def _report(self, code: str, message: Phrase, element: Element, hint: Phrase | None) -> None:
        self.findings.append(
            Diagnostic(code, message, element.span(), Severity.WARNING, hint=hint, source=element.source)
        )


def _get_type(transmission: Element) -> str:
    """Return the type of a transmission, from its element or, in old files, from its attribute."""
    element = transmission.first("type")
    return element.text() if element is not None else transmission.attributes.get("type", "")


def _strip_package(name: str) -> str:
    """Return a class name without its package, such as ``hardware_interface/``."""
    return name.strip().rpartition("/")[2]


def _get_mimic(joint: Joint) -> MimicDescription | None:
    mimic = joint.mimic
    return None if mimic is None else MimicDescription(mimic.joint, mimic.multiplier, mimic.offset)
