"""PID gains of gazebo_ros_control, in parameter files of ROS 2.

ROS 1 has the gains in ``gazebo_ros_control/pid_gains/JOINT``. In ROS 2 they are parameters of a node:

    gazebo_ros_control:
      ros__parameters:
        pid_gains:
          elbow: {p: 100.0, i: 0.1, d: 10.0, i_clamp: 5.0}

Source: control_toolbox of ROS 1 (names; without ``p`` there is no controller; without a bound, the integral term is 0).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from linkwright.control.motion.pid import CLAMPED, NONE, PidGains
from linkwright.diagnostics import phrase
from linkwright.graph.log.logger import Logger
from linkwright.graph.names.rules import join
from linkwright.graph.parameters.files import read_parameter_file

_NODE_NAME, _PARAMETER_PREFIX = "gazebo_ros_control", "pid_gains"


def read_gains(paths: Iterable[str], namespace: str) -> dict[str, Any]:
    """Return the gains in parameter files for a namespace, by dotted names such as ``elbow.p``.

    Raises:
        LinkwrightError: a file cannot be read, or is not a parameter file.
    """
    values: dict[str, Any] = {}
    for path in paths:
        values |= read_parameter_file(path).for_node(join(namespace or "/", _NODE_NAME))
    prefix = f"{_PARAMETER_PREFIX}."
    return {name.removeprefix(prefix): value for name, value in values.items() if name.startswith(prefix)}


def parse_gains(joint: str, values: Mapping[str, Any], logger: Logger) -> PidGains | None:
    """Return the gains of a joint's PID controller, or None if the joint has no gain ``p``.

    Args:
        joint: the joint's name.
        values: the gains of all joints, by dotted names.
        logger: receives a warning for each gain that is not a number.
    """
    if f"{joint}.p" not in values:
        return None

    def read_number(name: str, default: float) -> float:
        value = values.get(f"{joint}.{name}", default)
        try:
            return float(value)
        except (TypeError, ValueError):
            warning = phrase(
                "the PID parameter {name} of joint '{joint}' is not a number: '{value}'",
                joint=joint,
                name=name,
                value=str(value),
            )
            logger.warning(warning)
            return default

    clamp = abs(read_number("i_clamp", 0.0))
    return PidGains(
        p=read_number("p", 0.0),
        i=read_number("i", 0.0),
        d=read_number("d", 0.0),
        i_min=-abs(read_number("i_clamp_min", clamp)),
        i_max=abs(read_number("i_clamp_max", clamp)),
        antiwindup=CLAMPED if values.get(f"{joint}.antiwindup") is True else NONE,
    )
