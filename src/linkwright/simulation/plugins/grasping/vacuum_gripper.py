"""Grippers that attract links: ``libgazebo_ros_vacuum_gripper.so``.

Source: gazebo_ros_pkgs for ROS 2 and ROS 1 (parameters, defaults, topics, services, forces). In ROS 1, a link that is
close takes on the velocity of the gripper, and the force grows as the distance falls.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.diagnostics import phrase
from linkwright.geometry.arrays import Array
from linkwright.messages import get_message
from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin

_BOOL_TYPE = "std_msgs/msg/Bool"
_MAX_FORCE = 20.0
"""The greatest force of the plugin of ROS 1, in N."""


@dataclass(frozen=True, kw_only=True)
class VacuumGripperParameters:
    """Parameters of ``libgazebo_ros_vacuum_gripper.so``."""

    link_name: str = parameter(aliases=("bodyName",))
    max_distance: float = 0.05
    fixed: tuple[str, ...] = ()
    topic_name: str = parameter("", aliases=("topicName",))


class VacuumGripper(SimulatedPlugin[VacuumGripperParameters]):
    """The substitute for ``libgazebo_ros_vacuum_gripper.so``.

    A ``<topicName>`` marks a description for ROS 1, which has the services ``on`` and ``off``.
    """

    PARAMETERS = VacuumGripperParameters
    CARRIED = ("_is_on",)

    def start(self) -> None:
        """Find the link, and create the topic and the services.

        Raises:
            LinkwrightError: SIM133, there is no such link.
        """
        parameters, node = self.parameters, self.node
        self._link = self.link(parameters.link_name)
        self._is_old = bool(parameters.topic_name)
        self.reset()
        self._output = node.publisher(_BOOL_TYPE, parameters.topic_name or "grasping", 1)
        if self._is_old:
            node.service("std_srvs/srv/Empty", "on", lambda _, response: self._switch(response, is_on=True))
            node.service("std_srvs/srv/Empty", "off", lambda _, response: self._switch(response, is_on=False))
        else:
            node.service("std_srvs/srv/SetBool", "switch", self._on_switch)
        self.every(0.0, self._attract)

    def reset(self) -> None:
        """Switch the gripper off."""
        self._is_on = False

    def _on_switch(self, request: Any, response: Any) -> Any:
        response.success = bool(request.data) != self._is_on
        return self._switch(response, is_on=bool(request.data))

    def _switch(self, response: Any, *, is_on: bool) -> Any:
        if is_on == self._is_on:
            self.node.logger.warning(
                phrase("the gripper is already on") if is_on else phrase("the gripper is already off")
            )
        self._is_on = is_on
        return response

    def _attract(self) -> None:
        forces = dict(self._compute_forces()) if self._is_on else {}
        self.stop_pushing(except_links=forces)
        for link, force in forces.items():
            self.push(link, force)
        if self._output.is_wanted:
            self._output.publish(get_message(_BOOL_TYPE)(data=bool(forces)))

    def _compute_forces(self) -> Iterator[tuple[str, Array]]:
        """Yield the links that are close, with the forces on them in N, in the axes of the world."""
        simulation, parameters = self.simulation, self.parameters
        own_model = self.context.path.partition(SEPARATOR)[0]
        position = np.array(simulation.link_pose(self._link)[:3])
        for name, model in simulation.scene.models.items():
            if name == own_model or name in parameters.fixed:
                continue
            for tree_link in model.structure.links:
                link = tree_link.link.name
                to_gripper = position - simulation.link_pose(link)[:3]
                distance = float(np.linalg.norm(to_gripper))
                if tree_link.link.static or distance > parameters.max_distance:
                    continue
                magnitude = 1.0
                if self._is_old:
                    self._match_velocity(name)
                    magnitude = min(1.0 / distance, _MAX_FORCE) if distance > 0.0 else 0.0
                yield link, magnitude * to_gripper / max(distance, 1e-9)

    def _match_velocity(self, model: str) -> None:
        """Give a free model the velocity of the gripper."""
        simulation = self.simulation
        if simulation.moves_freely(model):
            linear, angular = (tuple(vector.tolist()) for vector in simulation.link_velocity(self._link))
            simulation.set_model_velocity(model, linear, angular)
