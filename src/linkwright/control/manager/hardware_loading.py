"""Load hardware from the robot's description and the manager's parameters.

Source: the controller manager of ros2_control, with the names of Humble and of Jazzy.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

from linkwright.control.hardware.description import HardwareDescription, hardware_from_robot
from linkwright.control.hardware.limits import CommandLimits, JointLimiter, limits_from_joint
from linkwright.control.hardware.resources import HardwareFactory, Resources
from linkwright.control.manager.manager import ControllerManager
from linkwright.control.manager.nodes import read_string_list
from linkwright.descriptions import DescriptionLibrary
from linkwright.diagnostics import Diagnostic, Severity
from linkwright.graph import Logger
from linkwright.graph.lifecycle.states import ACTIVE, INACTIVE, UNCONFIGURED
from linkwright.messages.distribution import is_before_kilted
from linkwright.urdf import Robot

HardwareReader: TypeAlias = Callable[[Robot], tuple[list[HardwareDescription], list[Diagnostic]]]
"""A function that returns the hardware in a robot's description, and findings about it."""

_INITIAL_STATE_PARAMETER = "hardware_components_initial_state"


def load_hardware(
    manager: ControllerManager,
    description: str,
    library: DescriptionLibrary,
    factory: HardwareFactory,
    *,
    read_hardware: HardwareReader = hardware_from_robot,
    enforces_limits: bool = False,
) -> bool:
    """Load the hardware of a description, and bring it to its initial states.

    The manager's parameters contain the initial states.

    Args:
        manager: the manager.
        description: the URDF.
        library: the robot descriptions that the process has read.
        factory: creates hardware from its description.
        read_hardware: reads the hardware in the robot's description.
        enforces_limits: whether commands are limited even if the manager's parameters do not request it.

    Returns:
        Whether the description is readable; its errors are logged.
    """
    node, logger = manager.node, manager.node.get_logger()
    reading = library.read(description)
    if reading.robot is None:
        logger.error("The published robot description file (urdf) seems not to be genuine.")
        _log_findings(
            logger, [diagnostic for diagnostic in reading.diagnostics if diagnostic.severity is Severity.ERROR]
        )
        return False
    descriptions, findings = read_hardware(reading.robot)
    _log_findings(logger, findings)
    manager.robot_description = description
    resources = manager.resources
    resources.load(descriptions, factory)
    parameter = node.get_parameter_or("enforce_command_limits").value
    if enforces_limits or (parameter if parameter is not None else not is_before_kilted()):
        manager.limits = _build_command_limits(reading.robot, resources, logger)
    remaining = dict.fromkeys(resources.components)
    inactive_names = [
        *read_string_list(node, f"{_INITIAL_STATE_PARAMETER}.inactive"),
        *read_string_list(node, "configure_components_on_start"),
    ]
    for target, names in (
        (UNCONFIGURED, read_string_list(node, f"{_INITIAL_STATE_PARAMETER}.unconfigured")),
        (INACTIVE, inactive_names),
    ):
        for name in filter(None, names):
            if name not in remaining:
                logger.warning(f"Hardware component '{name}' is unknown, therefore not set in '{target.label}' state.")
                continue
            logger.info(f"Setting component '{name}' to '{target.label}' state.")
            resources.set_state(name, target)
            del remaining[name]
    activated_names = read_string_list(node, "activate_components_on_start")
    for name in remaining:
        if not activated_names or name in activated_names:
            resources.set_state(name, ACTIVE)
    return True


def _build_command_limits(robot: Robot, resources: Resources, logger: Logger) -> CommandLimits:
    """Return the command limits of the hardware, from the limits of the robot's joints."""
    limiters = []
    for hardware in resources.components.values():
        for joint in hardware.description.joints:
            commands = {command.kind: command for command in hardware.commands if command.component == joint.name}
            states = {state.kind: state for state in hardware.states if state.component == joint.name}
            limiters.append(
                JointLimiter(joint.name, limits_from_joint(robot.joints[joint.name], joint), commands, states)
            )
    return CommandLimits(limiters, logger)


def _log_findings(logger: Logger, findings: list[Diagnostic]) -> None:
    for finding in findings:
        hint = f" ({finding.hint})" if finding.hint else ""
        message = f"{finding.message}{hint}"
        if finding.severity is Severity.ERROR:
            logger.error(message)
        else:
            logger.warning(message)
