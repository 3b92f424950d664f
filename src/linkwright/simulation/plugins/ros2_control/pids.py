"""PID controllers in the simulator's hardware, as in gazebo_ros2_control.

There are two ways to declare a PID controller. Either the command interface is called ``position_pid`` or
``velocity_pid`` in the description, and the gains ``pos_kp``, ``vel_ki``, ... are parameters of its joint. Or the
interface has its usual name, and the gains are parameters of the plugin's node, ``pid_gains.position.JOINT.kp``.
Controllers find the interface as ``JOINT/position`` or ``JOINT/velocity``.

Source: gazebo_ros2_control's GazeboSystem (names). Without ``min_integral_error`` the lower bound is the negated upper
bound, while GazeboSystem keeps the integral from becoming negative.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import inf
from typing import Any

from linkwright.control.hardware.description import ComponentDescription, HardwareDescription
from linkwright.control.hardware.interfaces import POSITION, VELOCITY
from linkwright.control.motion.pid import CLAMPED, NONE, PidGains
from linkwright.diagnostics import phrase
from linkwright.graph.log.logger import Logger

_PARAMETER_PREFIXES = {POSITION: "pos_", VELOCITY: "vel_"}
_PID_SUFFIX = "_pid"
_TRUE_VALUES = ("true", "True", True)


def extract_pid_gains(
    description: HardwareDescription, values: Mapping[str, Any], logger: Logger
) -> tuple[HardwareDescription, dict[tuple[str, str], PidGains]]:
    """Return a description with controllers' interface names, and the declared PID gains.

    Args:
        description: the hardware description in the URDF.
        values: the parameters of the plugin's node, by their dotted names.
        logger: receives a warning for each gain that is not a number.

    Returns:
        The description without ``_pid`` suffixes, and the gains by joint name and kind of command.
    """
    gains: dict[tuple[str, str], PidGains] = {}
    joints = []
    for joint in description.joints:
        commands = []
        for command in joint.commands:
            kind = command.name.removesuffix(_PID_SUFFIX)
            if kind in _PARAMETER_PREFIXES:
                declared_gains = _find_declared_gains(joint, kind, values, is_pid=kind != command.name)
                if declared_gains is not None:
                    gains[joint.name, kind] = _parse_pid_gains(joint.name, declared_gains, logger)
                commands.append(replace(command, name=kind))
            else:
                commands.append(command)
        joints.append(replace(joint, commands=tuple(commands)))
    return replace(description, joints=tuple(joints)), gains


def _find_declared_gains(
    joint: ComponentDescription, kind: str, values: Mapping[str, Any], *, is_pid: bool
) -> Mapping[str, Any] | None:
    """Return the gains of a joint's PID controller, by name without prefix.

    Returns None if the joint has no PID controller.
    """
    parameter_prefix = f"pid_gains.{kind}.{joint.name}."
    node_gains = {
        name.removeprefix(parameter_prefix): value
        for name, value in values.items()
        if name.startswith(parameter_prefix)
    }
    if node_gains or not is_pid:
        return node_gains or None
    prefix = _PARAMETER_PREFIXES[kind]
    return {name.removeprefix(prefix): value for name, value in joint.parameters.items() if name.startswith(prefix)}


def _parse_pid_gains(joint: str, declared_gains: Mapping[str, Any], logger: Logger) -> PidGains:
    def read_number(name: str, default: float) -> float:
        try:
            return float(declared_gains.get(name, default))
        except (TypeError, ValueError):
            warning = phrase(
                "the PID parameter {name} of joint '{joint}' is not a number: '{value}'",
                joint=joint,
                name=name,
                value=str(declared_gains[name]),
            )
            logger.warning(warning)
            return default

    max_integral_error = read_number("max_integral_error", inf)
    return PidGains(
        p=read_number("kp", 0.0),
        i=read_number("ki", 0.0),
        d=read_number("kd", 0.0),
        i_max=max_integral_error,
        i_min=read_number("min_integral_error", -max_integral_error),
        antiwindup=CLAMPED if declared_gains.get("antiwindup") in _TRUE_VALUES else NONE,
    )
