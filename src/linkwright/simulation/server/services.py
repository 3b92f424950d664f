"""The services of a simulator, as in gazebo_ros and simulation_interfaces; those of gz are in `world_services`.

Source: gazebo_ros_pkgs for ROS 2 (``gazebo_ros_init``, ``gazebo_ros_factory``, ``gazebo_ros_state``,
``gazebo_ros_force_system``) and their messages.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

from linkwright.descriptions import DescriptionLibrary
from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.single import Transform, compose, rotate
from linkwright.graph.stepped.node import SteppedNode
from linkwright.messages import Header, Time
from linkwright.sdf.frames import transform_of
from linkwright.sdf.poses import WORLD
from linkwright.simulation.plugins.entities import (
    Entities,
    describe_refusal,
    fill_response,
    format_finding,
    transform_from_message,
    vector_components,
)
from linkwright.simulation.server.entities import Entity, read_entity
from linkwright.simulation.server.loading import WorldLoader
from linkwright.simulation.server.server import SimulationServer
from linkwright.simulation.server.world_services import WorldServices
from linkwright.simulation.server.worlds import LoadedWorld
from linkwright.simulation.server.wrenches import Wrench, Wrenches

_OK, _WRONG_STATE, _FAILED = 1, 3, 4
"""The codes of simulation_interfaces/msg/Result that are returned here."""


class RunControl(Protocol):
    """The controls of a running simulation."""

    @property
    def is_paused(self) -> bool:
        """Whether the simulation is paused."""

    def pause(self) -> None:
        """Pause the simulation."""

    def resume(self) -> None:
        """Resume the simulation."""

    def step(self, count: int) -> None:
        """Run a number of steps.

        Raises:
            UnstableError: a value in the simulation is no longer finite.
        """


class Services:
    """The services of a simulator, handled in the simulation's thread.

    Args:
        server: the simulation to which the services apply.
        runner: advances the simulation.
        node: the simulator's node, which offers the services.
        world: the world that is simulated at the start.
        library: the robot descriptions that the process has read.

    Attributes:
        worlds: the loader that replaces the world.
        on_spawned: called in the simulation's thread with the name and description of a model from ``/spawn_entity``.
    """

    def __init__(
        self,
        server: SimulationServer,
        runner: RunControl,
        node: SteppedNode,
        world: LoadedWorld,
        library: DescriptionLibrary,
    ) -> None:
        self._server = server
        self._runner = runner
        self.worlds = WorldLoader(server, world)
        self.on_spawned: list[Callable[[str, str], object]] = []
        self._library = library
        self._entities = Entities(server.simulation)
        self._wrenches = Wrenches(server.simulation)
        for service_type, name, callback in (
            ("gazebo_msgs/srv/SpawnEntity", "/spawn_entity", self._spawn),
            ("gazebo_msgs/srv/DeleteEntity", "/delete_entity", self._delete),
            ("gazebo_msgs/srv/GetModelList", "/get_model_list", self._list_models),
            ("gazebo_msgs/srv/GetEntityState", "/get_entity_state", self._get_state),
            ("gazebo_msgs/srv/SetEntityState", "/set_entity_state", self._set_state),
            ("gazebo_msgs/srv/ApplyLinkWrench", "/apply_link_wrench", self._push),
            ("gazebo_msgs/srv/LinkRequest", "/clear_link_wrenches", self._clear_wrenches),
            ("std_srvs/srv/Empty", "/pause_physics", self._pause),
            ("std_srvs/srv/Empty", "/unpause_physics", self._resume),
            ("std_srvs/srv/Empty", "/reset_simulation", self._reset),
            ("std_srvs/srv/Empty", "/reset_world", self._reset),
            ("simulation_interfaces/srv/StepSimulation", "/step_simulation", self._step),
            ("simulation_interfaces/srv/LoadWorld", "/load_world", self.worlds.handle_request),
        ):
            node.service(service_type, name, callback)
        self._world_services = WorldServices(server, runner, node, self._spawn_as_gz)

    # --- models -------------------------------------------------------------------------------------------------------

    def spawn(self, text: str, name: str, pose: Transform, namespace: str = "") -> str:
        """Add the model that URDF or SDF describes to the world.

        Args:
            text: the description.
            name: the name of the model; empty for the name in the description.
            pose: the pose in the world to which the model's own pose is relative.
            namespace: the default namespace for the nodes of the model's plugins.

        Returns:
            The name of the model.

        Raises:
            LinkwrightError: the description has errors, or the model cannot be added.
        """
        return self._add_model(read_entity(text, self._server.simulation.finder, self._library), name, pose, namespace)

    def _add_model(
        self, entity: Entity, name: str, pose: Transform | None, namespace: str, *, is_relative: bool = True
    ) -> str:
        """Add a model and return its name.

        The pose is relative to the model's own pose, or replaces it; None means the model's own pose.
        """
        own_pose = transform_of(entity.model.pose.pose)
        if pose is None:
            pose = own_pose
        elif is_relative:
            pose = compose(pose, own_pose)
        name = name or entity.model.name
        self._server.spawn(entity.model, name, pose, namespace)
        self._server.report(entity.diagnostics, name)
        return name

    def replace_model(self, text: str, name: str) -> None:
        """Replace a model with the model in a description.

        The method may be called from any thread.

        The description is read immediately. The model is replaced later in the simulation's thread, which logs errors.

        Args:
            text: the description, URDF or SDF.
            name: the name of the model.

        Raises:
            LinkwrightError: the description has errors.
        """
        entity = read_entity(text, self._server.simulation.finder, self._library)

        def replace_in_simulation() -> None:
            try:
                self._server.replace_model(entity.model, name)
                self._server.report(entity.diagnostics, name)
            except LinkwrightError as error:
                self._server.node.get_logger().error(format_finding(error.diagnostics[0]))

        self._server.exchange.post(replace_in_simulation)

    def _spawn(self, request: Any, response: Any) -> Any:
        def spawn() -> str:
            pose = compose(
                self._entities.frame_pose(request.reference_frame), transform_from_message(request.initial_pose)
            )
            self._spawn_description(request.xml, request.name, pose, request.robot_namespace)
            return f"SpawnEntity: Successfully spawned entity [{request.name}]"

        return fill_response(response, spawn)

    def _spawn_as_gz(self, text: str, name: str, pose: Transform | None) -> None:
        """Add a model at a pose that replaces its own, as gz does, or at its own pose."""
        self._spawn_description(text, name, pose, "", is_relative=False)

    def _spawn_description(
        self, text: str, name: str, pose: Transform | None, namespace: str, *, is_relative: bool = True
    ) -> None:
        entity = read_entity(text, self._server.simulation.finder, self._library)
        if entity.missing_shape_errors:
            raise LinkwrightError(*entity.missing_shape_errors)
        name = self._add_model(entity, name, pose, namespace, is_relative=is_relative)
        for function in self.on_spawned:
            function(name, text)

    def _delete(self, request: Any, response: Any) -> Any:
        def delete() -> str:
            self._server.delete(request.name)
            return f"Successfully deleted entity [{request.name}]"

        return fill_response(response, delete)

    def _list_models(self, _: Any, response: Any) -> Any:
        response.header = Header(stamp=Time.from_nanoseconds(self._server.simulation.time), frame_id=WORLD)
        response.model_names = list(self._server.simulation.scene.models)
        response.success = True
        return response

    # --- poses of entities --------------------------------------------------------------------------------------------

    def _get_state(self, request: Any, response: Any) -> Any:
        return self._entities.fill_get_response(
            "/get_entity_state", request, response, self._server.node.get_logger().error
        )

    def _set_state(self, request: Any, response: Any) -> Any:
        return self._entities.fill_set_response(
            "/set_entity_state", request, response, self._server.node.get_logger().error
        )

    def _push(self, request: Any, response: Any) -> Any:
        def push() -> str:
            link = self._entities.link(request.link_name)
            orientation = self._entities.frame_pose(request.reference_frame)[3:]
            force, torque = (
                rotate(orientation, vector_components(vector))
                for vector in (request.wrench.force, request.wrench.torque)
            )
            duration = request.duration.nanoseconds
            start = request.start_time.nanoseconds
            start_time = max(start, self._server.simulation.time)
            end = None if duration < 0 else start_time + duration
            self._wrenches.add(link, Wrench(force, torque, vector_components(request.reference_point), start_time, end))
            return ""

        return fill_response(response, push)

    def _clear_wrenches(self, request: Any, response: Any) -> Any:
        try:
            self._wrenches.clear(self._entities.link(request.link_name))
        except LinkwrightError as error:
            self._server.node.get_logger().error(describe_refusal("/clear_link_wrenches", error))
        return response

    # --- time ---------------------------------------------------------------------------------------------------------

    def _pause(self, _: Any, response: Any) -> Any:
        self._runner.pause()
        return response

    def _resume(self, _: Any, response: Any) -> Any:
        self._runner.resume()
        return response

    def _reset(self, _: Any, response: Any) -> Any:
        self._server.reset()
        return response

    def _step(self, request: Any, response: Any) -> Any:
        if not self._runner.is_paused:
            response.result.result = _WRONG_STATE
            response.result.error_message = "the simulation is running: pause it to make single steps"
            return response
        try:
            self._runner.step(request.steps)
            response.result.result = _OK
        except LinkwrightError as error:
            response.result.result, response.result.error_message = _FAILED, str(error.diagnostics[0].message)
        return response
