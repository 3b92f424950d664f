"""Loading of hardware from the robot's description and a manager's parameters.

Source: the controller manager of ros2_control, with the names of Humble and of Jazzy.
"""

from __future__ import annotations

from linkwright.control.hardware.description import hardware_of
from linkwright.control.hardware.limits import CommandLimits, JointLimiter, limits_of
from linkwright.control.hardware.resources import Maker, Resources
from linkwright.control.manager.manager import ControllerManager
from linkwright.control.manager.nodes import words_of
from linkwright.descriptions import DescriptionLibrary
from linkwright.diagnostics import Diagnostic, Severity
from linkwright.graph import Logger
from linkwright.graph.lifecycle.states import ACTIVE, INACTIVE, UNCONFIGURED
from linkwright.messages.distribution import is_before_kilted
from linkwright.urdf import Robot

_INITIAL = "hardware_components_initial_state"


def load_hardware(manager: ControllerManager, text: str, library: DescriptionLibrary, make: Maker) -> bool:
    """Load the hardware of a description, and bring it to its initial lifecycle states.

    The manager's parameters specify these states.

    Args:
        manager: the manager.
        text: the URDF.
        library: the robot descriptions that the process has read.
        make: creates hardware from its description.

    Returns:
        Whether the description is readable; its errors are logged.
    """
    node, logger = manager.node, manager.node.get_logger()
    reading = library.read(text)
    if reading.robot is None:
        logger.error("The published robot description file (urdf) seems not to be genuine.")
        _log(logger, [diagnostic for diagnostic in reading.diagnostics if diagnostic.severity is Severity.ERROR])
        return False
    descriptions, findings = hardware_of(reading.robot)
    _log(logger, findings)
    manager.robot_description = text
    resources = manager.resources
    resources.load(descriptions, make)
    enforces = node.get_parameter_or("enforce_command_limits").value
    if enforces if enforces is not None else not is_before_kilted():
        manager.limits = _limits_of(reading.robot, resources, logger)
    waiting = dict.fromkeys(resources.components)
    configured = [*words_of(node, f"{_INITIAL}.inactive"), *words_of(node, "configure_components_on_start")]
    for target, names in ((UNCONFIGURED, words_of(node, f"{_INITIAL}.unconfigured")), (INACTIVE, configured)):
        for name in filter(None, names):
            if name not in waiting:
                logger.warning(f"Hardware component '{name}' is unknown, therefore not set in '{target.label}' state.")
                continue
            logger.info(f"Setting component '{name}' to '{target.label}' state.")
            resources.set_state(name, target)
            del waiting[name]
    started = words_of(node, "activate_components_on_start")
    for name in waiting:
        if not started or name in started:
            resources.set_state(name, ACTIVE)
    return True


def _limits_of(robot: Robot, resources: Resources, logger: Logger) -> CommandLimits:
    """Return the command limits of the hardware, from the limits of the robot's joints."""
    limiters = []
    for hardware in resources.components.values():
        for joint in hardware.description.joints:
            commands = {command.kind: command for command in hardware.commands if command.component == joint.name}
            states = {state.kind: state for state in hardware.states if state.component == joint.name}
            limiters.append(JointLimiter(joint.name, limits_of(robot.joints[joint.name], joint), commands, states))
    return CommandLimits(limiters, logger)


def _log(logger: Logger, findings: list[Diagnostic]) -> None:
    for finding in findings:
        hint = f" ({finding.hint})" if finding.hint else ""
        message = f"{finding.message}{hint}"
        if finding.severity is Severity.ERROR:
            logger.error(message)
        else:
            logger.warning(message)
