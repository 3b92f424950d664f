"""A force on a link, commanded on a topic: ``libgazebo_ros_force.so``.

Source: gazebo_ros_pkgs for ROS 2 and ROS 1 (parameters, topic; before each step, the force of the last message acts at
the center of mass, in the axes of the world or of the link).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from linkwright.diagnostics import phrase
from linkwright.geometry.single import rotate
from linkwright.simulation.plugins.entities import vector_components
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin

_NO_WRENCH = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


@dataclass(frozen=True, kw_only=True)
class ForceParameters:
    """Parameters of ``libgazebo_ros_force.so``."""

    link_name: str = parameter(aliases=("bodyName",))
    force_frame: str = "world"
    topic_name: str = parameter("gazebo_ros_force", aliases=("topicName",))


class ClassicForce(SimulatedPlugin[ForceParameters]):
    """The substitute for ``libgazebo_ros_force.so``."""

    PARAMETERS = ForceParameters
    CARRIED = ("_wrench",)

    def start(self) -> None:
        """Find the link, and subscribe to the force.

        Raises:
            LinkwrightError: SIM133, there is no such link; SIM160, the frame is neither the world's nor the link's.
        """
        parameters = self.parameters
        self._link = self.link(parameters.link_name)
        if parameters.force_frame not in ("world", "link"):
            raise self.parameter_error(
                phrase("plugin '{plugin}': <force_frame> must be 'world' or 'link'", plugin=self.context.name)
            )
        self.simulation.keep_awake(self._link)
        self._wrench = _NO_WRENCH
        command_guard = self.node.command_guard(self._stop_motion)
        self.node.subscribe(
            "geometry_msgs/msg/Wrench",
            parameters.topic_name,
            self._on_wrench,
            command_guard=command_guard,
            stop_motion=self._stop_motion,
        )
        self.every(0.0, self._apply_wrench)

    def reset(self) -> None:
        """Set the force to zero."""
        self._wrench = _NO_WRENCH
        self._apply_wrench()

    def _on_wrench(self, message: Any) -> None:
        self._wrench = (vector_components(message.force), vector_components(message.torque))
        self._apply_wrench()

    def _stop_motion(self) -> bool:
        """Set the force to zero, and return whether it was nonzero."""
        old_wrench = self._wrench
        self.reset()
        return old_wrench != _NO_WRENCH

    def _apply_wrench(self) -> None:
        force, torque = self._wrench
        if self.parameters.force_frame == "link":
            orientation = self.simulation.link_pose(self._link)[3:]
            force, torque = rotate(orientation, force), rotate(orientation, torque)
        self.push(self._link, force, torque)
