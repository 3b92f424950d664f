"""The base classes of programs that call a simulator's services, such as spawn_entity.py."""

from __future__ import annotations

import asyncio
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from linkwright.geometry.single import Vector3, quaternion_from_rpy
from linkwright.graph import DESCRIPTION_QOS, Clock, ClockType, Node
from linkwright.messages import String, get_service
from linkwright.nodes.options import SingleNode
from linkwright.packages import current_finder
from linkwright.sdf.resources import ResourceFinder
from linkwright.simulation.description_files import read_model_file

SPAWN_SERVICE = "gazebo_msgs/srv/SpawnEntity"
_LIST_SERVICE = "gazebo_msgs/srv/GetModelList"


@dataclass(frozen=True)
class Entity:
    """The name, pose and namespace of an entity to spawn.

    Attributes:
        name: the name of the model in the world.
        xyz: the position in meters.
        rpy: the roll, pitch and yaw in radians.
        namespace: the ROS namespace of the model's plugins.
        reference_frame: the frame of the pose; the world if empty.
    """

    name: str
    xyz: Vector3 = (0.0, 0.0, 0.0)
    rpy: Vector3 = (0.0, 0.0, 0.0)
    namespace: str = ""
    reference_frame: str = ""


def create_spawn_request(entity: Entity, description: str) -> Any:
    """Return a request of ``/spawn_entity`` for an entity.

    `description` is the URDF or SDF of the entity.
    """
    request = get_service(SPAWN_SERVICE).Request(
        name=entity.name, xml=description, robot_namespace=entity.namespace, reference_frame=entity.reference_frame
    )
    set_pose(request.initial_pose, entity)
    return request


def set_pose(message: Any, entity: Entity) -> None:
    """Set a pose message to the pose of an entity."""
    position, orientation = message.position, message.orientation
    position.x, position.y, position.z = entity.xyz
    orientation.x, orientation.y, orientation.z, orientation.w = quaternion_from_rpy(entity.rpy)


class SimulatorClient(SingleNode):
    """A node that calls a service of the simulator and then ends.

    The exit status is 1 if the call failed.

    Derived classes create `_node` and call `_connect`.
    """

    finished: asyncio.Future[int]

    def _connect(self, node: Node, *, service_namespace: str = "", timeout: float | None = None) -> None:
        """Set the node, the service namespace and the timeout for calls to the simulator.

        Args:
            node: the node that calls the services.
            service_namespace: the namespace of the simulator's services.
            timeout: the maximum time to wait for the service, in seconds of the machine's steady clock; None to wait
                forever.
        """
        self._node = node
        self._timeout = timeout
        self._service_namespace = service_namespace.rstrip("/")
        self.finished = asyncio.get_running_loop().create_future()

    def _call_service(self, service_type: str, name: str, request: Any, on_response: Callable[[Any], None]) -> None:
        """Call a service of the simulator, and pass the response to `on_response`.

        If the service is not available within the timeout, log an error and end with status 1.
        """
        path = f"{self._service_namespace}/{name}"
        client = self._node.create_client(get_service(service_type), path)
        future = client.call_async(request)  # The request is sent when the service becomes available.
        future.add_done_callback(lambda completed: on_response(completed.result()))
        if client.service_is_ready():
            return
        timeout_text = "" if self._timeout is None else f", timeout = {self._timeout:g}"
        self._log(f"Waiting for service {path}{timeout_text}")
        if self._timeout is None:
            return
        steady_clock = Clock(clock_type=ClockType.STEADY_TIME, timebase=self._node.get_clock().timebase)

        def check_availability() -> None:
            timer.cancel()
            if not future.done() and not client.service_is_ready():
                client.remove_pending_request(future)
                self._fail(f"Service {path} unavailable. Was the simulation started?")

        timer = self._node.create_timer(self._timeout, check_availability, clock=steady_clock)

    def _log(self, text: str) -> None:
        self._node.get_logger().info(text)

    def _fail(self, text: str) -> None:
        self._node.get_logger().error(text)
        self._finish(1)

    def _finish(self, status: int) -> None:
        if not self.finished.done():
            self.finished.set_result(status)


class EntitySpawner(SimulatorClient):
    """A node that spawns one entity and ends.

    Derived classes create `_node`, call `_prepare`, and then `_spawn_from_topic` or `_spawn`.
    """

    _entity: Entity

    def _prepare(
        self, node: Node, entity: Entity, *, service_namespace: str = "", timeout: float | None = None
    ) -> None:
        """Set the entity to spawn, and connect to the simulator as `_connect` does."""
        self._connect(node, service_namespace=service_namespace, timeout=timeout)
        self._entity = entity
        self._has_description = False

    # --- getting a description ------------------------------------------------------------------------------------

    def _spawn_from_topic(self, topic: str) -> None:
        """Spawn the first description that arrives on a topic.

        A latched description arrives at once.
        """
        self._log(f"Waiting for entity xml on {topic}")
        self._node.create_subscription(String, topic, lambda message: self._spawn(message.data), DESCRIPTION_QOS)

    # --- the request ----------------------------------------------------------------------------------------------

    def _spawn(self, description: str) -> None:
        """Spawn the entity from its URDF or SDF once the simulator is available.

        Later calls have no effect.
        """
        if self._has_description:
            return
        self._has_description = True
        self._request_spawn(description)

    def _request_spawn(self, description: str) -> None:
        """Send the request for the entity."""
        self._call_service(
            SPAWN_SERVICE, "spawn_entity", create_spawn_request(self._entity, description), self._on_response
        )

    def _request_names(self, on_names: Callable[[list[str]], None]) -> None:
        """Request the names of the world's models, and pass them to a function."""
        self._call_service(
            _LIST_SERVICE,
            "get_model_list",
            get_service(_LIST_SERVICE).Request(),
            lambda response: on_names(list(response.model_names)),
        )

    def _on_response(self, response: Any) -> None:
        if not response.success:
            self._fail(f"Spawning '{self._entity.name}' failed: {response.status_message}")
            return
        self._log(f"Spawn status: {response.status_message}")
        self._on_spawned()

    def _on_spawned(self) -> None:
        """End with status 0, after the simulator has spawned the entity."""
        self._finish(0)


def read_description(address: str, environment: Mapping[str, str]) -> str:
    """Read the description at a path or URI, or of a model on Fuel.

    The schemes of URIs are ``file://``, ``package://`` and ``model://``.

    Args:
        address: the path or URI as the user wrote it.
        environment: the environment variables with the search paths.

    Raises:
        LinkwrightError: NODE811, there is no such description, or it cannot be read.
    """
    return read_model_file(address, ResourceFinder(current_finder(), environment))


def read_stdin() -> str:
    """Read the description from standard input."""
    return sys.stdin.read()
