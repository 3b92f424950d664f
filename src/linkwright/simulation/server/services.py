"""What may be asked of a simulator by services, those of gazebo_ros and of simulation_interfaces.

Source: gazebo_ros_pkgs for ROS 2 (``gazebo_ros_init``, ``gazebo_ros_factory``, ``gazebo_ros_state``,
``gazebo_ros_force_system``) and their messages.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import Any

from linkwright.descriptions import DescriptionLibrary
from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean, phrase
from linkwright.geometry.single import IDENTITY, Transform, compose, invert, normalized, rotate
from linkwright.messages import Header, Quaternion, Time, Vector3, get_message
from linkwright.sdf.frames import transform_of
from linkwright.sdf.poses import SEPARATOR, WORLD
from linkwright.simulation.plugins.node import PluginNode
from linkwright.simulation.server.entities import entity_from
from linkwright.simulation.server.loading import WorldLoader, told
from linkwright.simulation.server.runner import Runner
from linkwright.simulation.server.server import SimulationServer
from linkwright.simulation.server.worlds import LoadedWorld
from linkwright.simulation.server.wrenches import Wrench, Wrenches
from linkwright.simulation.simulation import NANOSECONDS

_OK, _WRONG_STATE, _FAILED = 1, 3, 4
"""Of simulation_interfaces/msg/Result."""
_WHOLE_WORLD = ("", WORLD, "map", "/map")
"""Names of the frame of the world."""


class Services:
    """The services of a simulator; what they do is done in the simulation's thread.

    Args:
        server: the simulation.
        runner: what advances it.
        node: the node of the simulator.
        world: what is simulated.
        library: the robot descriptions that the process has read.

    Attributes:
        worlds: what makes the world another one.
    """

    def __init__(
        self,
        server: SimulationServer,
        runner: Runner,
        node: PluginNode,
        world: LoadedWorld,
        library: DescriptionLibrary,
    ) -> None:
        self._server = server
        self._runner = runner
        self.worlds = WorldLoader(server, world)
        self._library = library
        self._wrenches = Wrenches(server.simulation)
        for kind, name, callback in (
            ("gazebo_msgs/srv/SpawnEntity", "/spawn_entity", self._spawn),
            ("gazebo_msgs/srv/DeleteEntity", "/delete_entity", self._delete),
            ("gazebo_msgs/srv/GetModelList", "/get_model_list", self._list),
            ("gazebo_msgs/srv/GetEntityState", "/get_entity_state", self._get_state),
            ("gazebo_msgs/srv/SetEntityState", "/set_entity_state", self._set_state),
            ("gazebo_msgs/srv/ApplyLinkWrench", "/apply_link_wrench", self._push),
            ("gazebo_msgs/srv/LinkRequest", "/clear_link_wrenches", self._let_go),
            ("std_srvs/srv/Empty", "/pause_physics", self._pause),
            ("std_srvs/srv/Empty", "/unpause_physics", self._go_on),
            ("std_srvs/srv/Empty", "/reset_simulation", self._reset),
            ("std_srvs/srv/Empty", "/reset_world", self._reset),
            ("simulation_interfaces/srv/StepSimulation", "/step_simulation", self._step),
            ("simulation_interfaces/srv/LoadWorld", "/load_world", self.worlds.answer),
        ):
            node.service(kind, name, callback)

    # --- models -------------------------------------------------------------------------------------------------------

    def spawn(self, text: str, name: str, pose: Transform, namespace: str = "") -> None:
        """Put the model of a text, URDF or SDF, into the world.

        Args:
            text: the description.
            name: what it is called; that in the description if empty.
            pose: of its frame, before which its own pose comes.
            namespace: of the nodes of its plugins that name none.

        Raises:
            LinkwrightError: what is wrong with it.
        """
        entity = entity_from(text, self._server.simulation.finder, self._library)
        placed = compose(pose, transform_of(entity.model.pose.pose))
        self._server.spawn(entity.model, name or entity.model.name, placed, namespace)

    def _spawn(self, request: Any, response: Any) -> Any:
        def spawn() -> str:
            pose = compose(self._frame(request.reference_frame), _transform(request.initial_pose))
            self.spawn(request.xml, request.name, pose, request.robot_namespace)
            return f"SpawnEntity: Successfully spawned entity [{request.name}]"

        return _answered(response, spawn)

    def _delete(self, request: Any, response: Any) -> Any:
        def delete() -> str:
            self._server.delete(request.name)
            return f"Successfully deleted entity [{request.name}]"

        return _answered(response, delete)

    def _list(self, _: Any, response: Any) -> Any:
        response.header = Header(self._stamp(), WORLD)
        response.model_names = list(self._server.simulation.scene.models)
        response.success = True
        return response

    # --- where things are ---------------------------------------------------------------------------------------------

    def _get_state(self, request: Any, response: Any) -> Any:
        response.header = Header(self._stamp(), request.reference_frame or WORLD)
        try:
            response.state = self._state(request.name, request.reference_frame)
            response.success = True
        except LinkwrightError as error:
            response.success = False
            self._server.node.get_logger().error(error.diagnostics[0].message)
        return response

    def _state(self, name: str, reference: str) -> Any:
        simulation = self._server.simulation
        is_model = name in simulation.scene.models
        link = simulation.scene.models[name].structure.links[0].link.name if is_model else self._link(name)
        pose = simulation.model_pose(name) if is_model else simulation.link_pose(link)
        linear, angular = simulation.link_velocity(link)
        into = invert(self._frame(reference))
        message = get_message("gazebo_msgs/msg/EntityState")(name=name, reference_frame=reference or WORLD)
        _fill(message.pose, compose(into, pose))
        message.twist.linear = Vector3(*rotate(into[3:], tuple(linear.tolist())))
        message.twist.angular = Vector3(*rotate(into[3:], tuple(angular.tolist())))
        return message

    def _set_state(self, request: Any, response: Any) -> Any:
        state, simulation = request.state, self._server.simulation

        def put() -> str:
            if state.name not in simulation.scene.models:
                raise self._nothing(state.name, simulation.scene.models)
            frame = self._frame(state.reference_frame)
            simulation.set_model_pose(state.name, compose(frame, _transform(state.pose)))
            twist = (_numbers(state.twist.linear), _numbers(state.twist.angular))
            simulation.set_model_velocity(state.name, *(rotate(frame[3:], each) for each in twist))
            return ""

        return _answered(response, put)

    def _push(self, request: Any, response: Any) -> Any:
        def push() -> str:
            link = self._link(request.link_name)
            turn = self._frame(request.reference_frame)[3:]
            force, torque = (rotate(turn, _numbers(each)) for each in (request.wrench.force, request.wrench.torque))
            duration = request.duration.sec * NANOSECONDS + request.duration.nanosec
            start = request.start_time.sec * NANOSECONDS + request.start_time.nanosec
            begin = max(start, self._server.simulation.time)
            end = None if duration < 0 else begin + duration
            self._wrenches.add(link, Wrench(force, torque, _numbers(request.reference_point), begin, end))
            return ""

        return _answered(response, push)

    def _let_go(self, request: Any, response: Any) -> Any:
        self._wrenches.clear(self._link(request.link_name))
        return response

    # --- time ---------------------------------------------------------------------------------------------------------

    def _pause(self, _: Any, response: Any) -> Any:
        self._runner.pause()
        return response

    def _go_on(self, _: Any, response: Any) -> Any:
        self._runner.go_on()
        return response

    def _reset(self, _: Any, response: Any) -> Any:
        self._server.reset()
        return response

    def _step(self, request: Any, response: Any) -> Any:
        if not self._runner.paused:
            response.result.result = _WRONG_STATE
            response.result.error_message = "the simulation runs: pause it to make single steps"
            return response
        try:
            self._runner.step(request.steps)
            response.result.result = _OK
        except LinkwrightError as error:
            response.result.result, response.result.error_message = _FAILED, str(error.diagnostics[0].message)
        return response

    # --- frames -------------------------------------------------------------------------------------------------------

    def _frame(self, name: str) -> Transform:
        """Where a model or link is in the world.

        Raises:
            LinkwrightError: SIM141 there is no such thing.
        """
        if name in _WHOLE_WORLD:
            return IDENTITY
        if name in self._server.simulation.scene.models:
            return self._server.simulation.model_pose(name)
        return self._server.simulation.link_pose(self._link(name))

    def _link(self, name: str) -> str:
        """A link by its full name, ``model::link``, or by its own where only one model has such.

        Raises:
            LinkwrightError: SIM141 there is none.
        """
        bodies = self._server.simulation.scene.bodies
        if name in bodies:
            return name
        found = [each for each in bodies if each.endswith(f"{SEPARATOR}{name}")]
        if len(found) == 1:
            return found[0]
        raise self._nothing(name, (*self._server.simulation.scene.models, *bodies))

    def _nothing(self, name: str, known: Collection[str]) -> LinkwrightError:
        message = phrase("there is no model or link '{name}'", name=name)
        return LinkwrightError(Diagnostic("SIM141", message, hint=did_you_mean(name, known)))

    def _stamp(self) -> Time:
        return Time(*divmod(self._server.simulation.time, NANOSECONDS))


def _answered(response: Any, work: Callable[[], str]) -> Any:
    """A response with whether something worked and what it says, or why it did not; some have no such text."""
    try:
        response.success, message = True, work()
    except LinkwrightError as error:
        response.success, message = False, told(error.diagnostics[0])
    if hasattr(response, "status_message"):
        response.status_message = message
    return response


def _fill(message: Any, pose: Transform) -> None:
    message.position.x, message.position.y, message.position.z = pose[:3]
    message.orientation = Quaternion(*pose[3:])


def _transform(message: Any) -> Transform:
    """A pose as it is in messages; one without an orientation is not turned."""
    turn = message.orientation
    quaternion = (turn.x, turn.y, turn.z, turn.w)
    if not any(quaternion):
        quaternion = (0.0, 0.0, 0.0, 1.0)
    return (*_numbers(message.position), *normalized(*quaternion))


def _numbers(vector: Any) -> tuple[float, float, float]:
    return vector.x, vector.y, vector.z
