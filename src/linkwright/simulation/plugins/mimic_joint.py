"""A joint that follows another joint.

The library is ``libroboticsgroup_gazebo_mimic_joint_plugin.so`` or one of its copies.

Gazebo classic ignores ``<mimic>`` in a URDF, so descriptions of grippers add this plugin. The simulation couples joints
with ``<mimic>`` itself; then the plugin has nothing to do.

Source: roboticsgroup_gazebo_plugins and roboticsgroup_upatras_gazebo_plugins (parameters; each step moves the joint to
its position directly, or pushes it with a PID controller).
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from math import inf, isfinite
from typing import Any

from linkwright.control.motion.pid import Pid, PidGains
from linkwright.diagnostics import phrase
from linkwright.graph.names.rules import join
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.sdf.plugins import library_name
from linkwright.simulation.actuators import Servo
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.simulation.plugins.ros2_control.classic_gains import parse_gains, read_gains
from linkwright.xmltree import Element

_GAINS_NAME = re.compile(r"(?P<namespace>.*?)/?gazebo_ros_control/pid_gains/(?P<joint>[^/]+)")
_CONTROL_LIBRARY = "gazebo_ros_control"
_MAX_SPEED = 1000.0
"""The maximum speed at which the joint follows, in rad/s or m/s, unless the joint has a lower limit."""


@dataclass(frozen=True, kw_only=True)
class MimicParameters:
    """Parameters of the mimic joint plugin."""

    joint: str = parameter()
    mimic_joint: str = parameter(aliases=("mimicJoint",))
    multiplier: float = 1.0
    offset: float = 0.0
    sensitiveness: float = 0.0
    max_effort: float | None = parameter(None, aliases=("maxEffort",))
    has_pid: tuple[str, ...] = parameter((), aliases=("hasPID",))
    parameters: tuple[str, ...] = ()


class MimicJoint(SimulatedPlugin[MimicParameters]):
    """The substitute for ``libroboticsgroup_gazebo_mimic_joint_plugin.so``."""

    PARAMETERS = MimicParameters

    def start(self) -> None:
        """Find the joints, and create the servo or the PID controller."""
        parameters, simulation = self.parameters, self.simulation
        self._leader, self._follower = self.joint(parameters.joint), self.joint(parameters.mimic_joint)
        self._servo: Servo | None = None
        self._pid: Pid | None = None
        if self._is_coupled():
            return
        axis = simulation.scene.joints[self._follower].axes[0][0]
        limit = axis.limit.effort if parameters.max_effort is None else parameters.max_effort
        self._max_effort = limit if isfinite(limit) and limit > 0.0 else inf
        simulation.keep_awake(simulation.scene.joints[self._follower].child)
        gains = self._read_gains() if parameters.has_pid else None
        if gains is not None:
            self._pid = Pid(gains)
        else:
            self._servo = simulation.add_servo(self._follower, _MAX_SPEED)
        self.every(0.0, self._follow)

    def reset(self) -> None:
        """Discard earlier errors, because simulated time restarts."""
        if self._pid is not None:
            self._pid.reset()
        if self._servo is not None:
            self._servo.restart()

    def _is_coupled(self) -> bool:
        """Return whether ``<mimic>`` already couples the joints.

        A warning is logged if its values differ from those of the plugin.
        """
        mimic = self.simulation.scene.joints[self._follower].axes[0][0].mimic
        if mimic is None:
            return False
        offset = mimic.offset - mimic.multiplier * mimic.reference
        values = (self.parameters.joint, self.parameters.multiplier, self.parameters.offset)
        if (mimic.joint, mimic.multiplier, offset) != values:
            self.node.logger.warning(
                phrase(
                    "joint '{joint}' follows its <mimic>, which differs from the plugin '{plugin}'",
                    joint=self.parameters.mimic_joint,
                    plugin=self.context.name,
                )
            )
        return True

    def _read_gains(self) -> PidGains | None:
        """Return the gains in ``<hasPID>`` or in the parameter files.

        Returns None and logs a warning if there are none.
        """
        joint, namespace = self.parameters.mimic_joint, self.node.name.rpartition("/")[0] or "/"
        name = _GAINS_NAME.fullmatch(self.parameters.has_pid[0])
        if name is not None:
            joint = name["joint"]
            if name[0].startswith("/"):
                namespace = name["namespace"] or "/"
            elif name["namespace"]:
                namespace = join(namespace, name["namespace"])
        values: dict[str, Any] = read_gains(self._find_parameter_files(), namespace)
        element = self._find_child("hasPID") or self._find_child("has_pid")
        if element is not None:
            values |= {f"{joint}.{child.tag}": child.text().strip() for child in element.elements()}
        gains = parse_gains(joint, values, self.node.logger)
        if gains is None:
            warning = phrase(
                "joint '{joint}' has no gain p in 'pid_gains' of '{node}', so it follows without a PID controller",
                joint=joint,
                node=join(namespace, _CONTROL_LIBRARY),
            )
            self.node.logger.warning(warning)
        return gains

    def _find_parameter_files(self) -> Iterator[str]:
        """Yield the parameter files of this plugin and of the model's gazebo_ros_control."""
        yield from self.parameters.parameters
        for plugin in self.context.model.plugins if self.context.model is not None else ():
            if library_name(plugin.filename) == _CONTROL_LIBRARY and plugin.element is not None:
                yield from (child.text().strip() for child in plugin.element.elements("parameters"))

    def _find_child(self, tag: str) -> Element | None:
        element = self.context.element
        return None if element is None else element.first(tag)

    def _follow(self) -> None:
        """Move or push the joint, unless it is near enough to its position."""
        simulation, seconds = self.simulation, self.simulation.step / NANOSECONDS_PER_SECOND
        target = simulation.joint_state(self._leader)[0] * self.parameters.multiplier + self.parameters.offset
        error = target - simulation.joint_state(self._follower)[0]
        if abs(error) < self.parameters.sensitiveness:
            if self._pid is not None:
                simulation.push_joint(self._follower, 0.0)
        elif self._pid is not None:
            force = self._pid.command(error, seconds)
            simulation.push_joint(self._follower, min(max(force, -self._max_effort), self._max_effort))
        elif self._servo is not None:
            self._servo.move(target, seconds)
