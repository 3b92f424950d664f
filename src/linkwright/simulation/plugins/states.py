"""Topics and services for the states of models and links: ``libgazebo_ros_state.so``.

Source: gazebo_ros_pkgs for ROS 2 (topics, services, the rate). The simulator itself answers ``/get_entity_state`` and
``/set_entity_state``; this plugin also offers these services in its own namespace.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from linkwright.messages import get_message
from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.plugins.entities import Entities, fill_response
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin


@dataclass(frozen=True, kw_only=True)
class StateParameters:
    """Parameters of ``libgazebo_ros_state.so``."""

    update_rate: float = parameter(100.0, aliases=("updateRate",))


class ClassicState(SimulatedPlugin[StateParameters]):
    """The substitute for the world plugin ``libgazebo_ros_state.so``."""

    PARAMETERS = StateParameters

    def start(self) -> None:
        """Create the publishers and services for the states of models, links and joints."""
        node = self.node
        self._entities = Entities(self.simulation)
        self._models = node.publisher("gazebo_msgs/msg/ModelStates", "model_states", 1)
        self._links = node.publisher("gazebo_msgs/msg/LinkStates", "link_states", 1)
        if node.name.count("/") > 1:  # Without a namespace, these are the simulator's own services.
            node.service("gazebo_msgs/srv/GetEntityState", "get_entity_state", self._get_entity_state)
            node.service("gazebo_msgs/srv/SetEntityState", "set_entity_state", self._set_entity_state)
        node.service("gazebo_msgs/srv/SetModelConfiguration", "set_joint_positions", self._set_joint_positions)
        self.every(self.parameters.update_rate, self._publish)

    def _publish(self) -> None:
        models = self.simulation.scene.models
        if self._models.is_wanted:
            self._models.publish(self._create_message("gazebo_msgs/msg/ModelStates", list(models)))
        if self._links.is_wanted:
            links = [placed_link.link.name for model in models.values() for placed_link in model.structure.links]
            self._links.publish(self._create_message("gazebo_msgs/msg/LinkStates", links))

    def _create_message(self, message_type: str, names: list[str]) -> Any:
        states = [self._entities.state(name) for name in names]
        return get_message(message_type)(
            name=names, pose=[state.pose for state in states], twist=[state.twist for state in states]
        )

    def _get_entity_state(self, request: Any, response: Any) -> Any:
        return self._entities.fill_get_response("get_entity_state", request, response, self.node.logger.error)

    def _set_entity_state(self, request: Any, response: Any) -> Any:
        return self._entities.fill_set_response("set_entity_state", request, response, self.node.logger.error)

    def _set_joint_positions(self, request: Any, response: Any) -> Any:
        if len(request.joint_names) != len(request.joint_positions):
            response.status_message = "set_joint_positions: joint name and position list have different lengths"
            return response

        def set_positions() -> str:
            model = self._entities.model(request.model_name)
            joints = [self._entities.joint(f"{model}{SEPARATOR}{name}") for name in request.joint_names]
            for joint, position in zip(joints, request.joint_positions, strict=True):
                self.simulation.set_joint_position(joint, float(position))
            return "set_joint_positions: success"

        return fill_response(response, set_positions)
