"""Motion of a model at a commanded velocity: ``gz-sim-velocity-control-system``.

Source: gz-sim (parameters, topic; velocities are in the frame of the model and apply until the next message).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from linkwright.geometry.single import Vector3, rotate
from linkwright.simulation.plugins.entities import vector_components
from linkwright.simulation.plugins.planar_move import PlanarDrive


@dataclass(frozen=True, kw_only=True)
class VelocityControlParameters:
    """Parameters of ``gz-sim-velocity-control-system``."""

    topic: str = ""
    initial_linear: Vector3 | None = None
    initial_angular: Vector3 | None = None


class GzVelocityControl(PlanarDrive[VelocityControlParameters]):
    """The substitute for ``gz-sim-velocity-control-system``.

    The plugin controls models, but not single links.
    """

    PARAMETERS = VelocityControlParameters
    IGNORED = ("link_name",)
    CARRIED = ("_command",)

    def start(self) -> None:
        """Subscribe to the velocity commands.

        Raises:
            LinkwrightError: SIM160, the model is fixed to the world.
        """
        self.require_free_model()
        self.reset()
        topic = self.parameters.topic or f"/model/{self.context.path}/cmd_vel"
        command_guard = self.node.command_guard(self._stop_motion)
        self.node.subscribe(
            "geometry_msgs/msg/Twist",
            topic,
            self._on_command,
            conventional_topic="/cmd_vel",
            command_guard=command_guard,
            stop_motion=self._stop_motion,
        )
        self.every(0.0, self._move)

    def reset(self) -> None:
        """Command the initial velocity of the parameters, or drop the command if they have none."""
        parameters = self.parameters
        self._command: tuple[Vector3, Vector3] | None = None
        if parameters.initial_linear is not None or parameters.initial_angular is not None:
            self._command = (
                parameters.initial_linear or (0.0, 0.0, 0.0),
                parameters.initial_angular or (0.0, 0.0, 0.0),
            )

    def _on_command(self, twist: Any) -> None:
        self._command = (vector_components(twist.linear), vector_components(twist.angular))

    def _stop_motion(self) -> bool:
        zero_velocity = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
        previous_velocity, self._command = self._command, zero_velocity
        return previous_velocity != zero_velocity

    def _move(self) -> None:
        if self._command is None:
            return
        orientation = self.simulation.model_pose(self.context.path)[3:]
        linear, angular = (rotate(orientation, velocity) for velocity in self._command)
        self.simulation.set_model_velocity(self.context.path, linear, angular)
