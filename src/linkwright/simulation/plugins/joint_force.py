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
        topic = f"/model/{self.place.path}/joint/{name}/cmd_force"
        commander = self.node.commander(self._rest)
        self.node.subscribe("std_msgs/msg/Float64", topic, self._commanded, commander=commander, rest=self._rest)
        self.every(0.0, self._push)

    def reset(self) -> None:
        """Set the force to zero."""
        self._force = 0.0
        self._push()

    def _commanded(self, message: Any) -> None:
        self._force = float(message.data)

    def _rest(self) -> bool:
        """Set the force to zero; return whether it was nonzero."""
        before = self._force
        self.reset()
        return before != 0.0

    def _push(self) -> None:
        self.simulation.push_joint(self._joint, self._force)
