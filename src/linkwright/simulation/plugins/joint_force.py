"""A force on a joint, commanded on a topic: ``gz-sim-apply-joint-force-system``.

Source: gz-sim (parameter, topic; the last command acts in each step). Commands are ``std_msgs/msg/Float64``, which a
bridge converts to messages of gz.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin


@dataclass(frozen=True, kw_only=True)
class JointForceParameters:
    """Parameters of ``gz-sim-apply-joint-force-system``."""

    joint_name: str = parameter()


class GzJointForce(SimulatedPlugin[JointForceParameters]):
    """The substitute for ``gz-sim-apply-joint-force-system``."""

    PARAMETERS = JointForceParameters
    CARRIED = ("_force",)

    def start(self) -> None:
        """Find the joint, and subscribe to ``/model/MODEL/joint/JOINT/cmd_force``."""
        name, simulation = self.parameters.joint_name, self.simulation
        self._joint = self.joint(name)
        simulation.keep_awake(simulation.scene.joints[self._joint].child)
        self._force = 0.0
        topic = f"/model/{self.context.path}/joint/{name}/cmd_force"
        command_guard = self.node.command_guard(self._stop_motion)
        self.node.subscribe(
            "std_msgs/msg/Float64", topic, self._on_command, command_guard=command_guard, stop_motion=self._stop_motion
        )
        self.every(0.0, self._apply_force)

    def reset(self) -> None:
        """Set the force to zero."""
        self._force = 0.0
        self._apply_force()

    def _on_command(self, message: Any) -> None:
        self._force = float(message.data)

    def _stop_motion(self) -> bool:
        """Set the force to zero, and return whether it was nonzero."""
        old_force = self._force
        self.reset()
        return old_force != 0.0

    def _apply_force(self) -> None:
        self.simulation.push_joint(self._joint, self._force)
