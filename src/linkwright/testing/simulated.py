"""A simulated world for tests, which advances with the graph step by step."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import wraps
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Concatenate, ParamSpec, TypeVar

from linkwright.descriptions import DescriptionLibrary, examine
from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.single import Transform, quaternion_from_rpy
from linkwright.graph import SIMULATION_CLOCK_QOS
from linkwright.graph.stepped.node import SteppedNode
from linkwright.messages import Time, get_message
from linkwright.nodes.options import NodeOptions
from linkwright.nodes.robot_state_publisher import RobotStatePublisher
from linkwright.packages import PackageFinder
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.sdf.models import Model
from linkwright.sdf.resources import ResourceFinder
from linkwright.sdf.variation import with_friction, with_mass, with_noise
from linkwright.sdf.worlds import World
from linkwright.simulation.server.server import ServerOptions, SimulationServer
from linkwright.simulation.server.services import Services
from linkwright.simulation.simulation import Simulation
from linkwright.testing.paths import RobotPath, start_path
from linkwright.testing.scenes import read_model, read_world
from linkwright.testing.stepped import AsyncSteppedGraph
from linkwright.testing.stepped_sync import SteppedGraph

if TYPE_CHECKING:
    from typing_extensions import Self

    from linkwright.simulation.plugins.plugin import SimulatedPlugin

_P = ParamSpec("_P")
_T = TypeVar("_T")

_NODE_NAME = "gazebo"
_CLOCK_TYPE, _TWIST_TYPE = "rosgraph_msgs/msg/Clock", "geometry_msgs/msg/Twist"
_STEP_PERIOD_S = 0.01
_ORIGIN_POSE = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


class AsyncSteppedSimulation(AsyncSteppedGraph):
    """`SteppedSimulation` for tests that are coroutines.

    Arguments and attributes are those of `SteppedSimulation`.
    """

    def __init__(
        self,
        world: str | Path = "empty",
        robot: str | Path | None = None,
        *,
        arguments: Mapping[str, object] | None = None,
        pose: Sequence[float] = _ORIGIN_POSE,
        seed: int = 0,
        friction: float | None = None,
        mass: float = 1.0,
        noise: float = 1.0,
        robot_state_publisher: bool = False,
        services: bool = True,
        period: float = _STEP_PERIOD_S,
        start: float = 1_700_000_000.0,
        strict: bool = True,
    ) -> None:
        super().__init__(start=start, strict=strict)
        self._path = None if robot is None else _resolve_path(robot)
        self._loaded_world = read_world(str(world))
        if friction is not None:
            self._loaded_world = self._loaded_world._replace(
                world=_with_world_friction(self._loaded_world.world, friction)
            )
        self._model: Model | None = None
        self._description: str | None = None
        if self._path is not None:
            if robot_state_publisher:
                self._description = _read_description(self._path, arguments or {})
            model = _read_robot(self._path, arguments or {})
            model = model if mass == 1.0 else with_mass(model, mass)
            self._model = model if noise == 1.0 else with_noise(model, noise)
        self._pose = _transform_from_rpy(pose)
        self._has_services = services
        self._options = ServerOptions(seed, usual_names=True)
        self._folders = [
            Path.cwd(),
            *([] if self._path is None else [self._path.parent]),
            Path(world).absolute().parent,
        ]
        self._period_ns = round(period * NANOSECONDS_PER_SECOND)
        self._remaining_ns = 0
        self._server: SimulationServer | None = None
        self._robot_path: RobotPath | None = None

    async def __aenter__(self) -> Self:
        await super().__aenter__()
        try:
            self._begin()
        except BaseException:
            await self.graph.close()
            raise
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        try:
            await self.end_programs(error)
        finally:
            self.server.close()
            await super().__aexit__(kind, error, trace)

    def _begin(self) -> None:
        simulation = Simulation(self._loaded_world.world, ResourceFinder(PackageFinder(start=self._folders)))
        node = self.graph.create_node(_NODE_NAME)
        self._clock_topic = node.create_publisher(get_message(_CLOCK_TYPE), "/clock", SIMULATION_CLOCK_QOS)
        self._server = SimulationServer(simulation, node, self._options)
        self._server.on_failure.append(self.errors.append)
        self._run_control = _RunControl(simulation)
        if self._has_services:
            server_node = SteppedNode(node, self._server.exchange, owned=False)
            Services(self._server, self._run_control, server_node, self._loaded_world, DescriptionLibrary())
        self._server.start()
        if self._model is not None:
            self._server.spawn(self._model, self._model.name, self._pose)
            self._robot_path = start_path()
        if self._description is not None:
            parameters = {"robot_description": self._description, "use_sim_time": True}
            RobotStatePublisher(self.graph, NodeOptions(parameters=parameters))
        self._publish_time()

    @property
    def server(self) -> SimulationServer:
        """The server that runs the simulation and its plugins.

        Raises:
            RuntimeError: the test has not started.
        """
        if self._server is None:
            raise RuntimeError("the test has not started: use the simulation as a context manager")
        return self._server

    @property
    def simulation(self) -> Simulation:
        """The simulation of the world."""
        return self.server.simulation

    def spawn(
        self,
        robot: str | Path,
        name: str = "",
        *,
        pose: Sequence[float] = _ORIGIN_POSE,
        namespace: str = "",
        arguments: Mapping[str, object] | None = None,
    ) -> str:
        """Spawn another robot in the world. See `SteppedSimulation.spawn`."""
        model = _read_robot(_resolve_path(robot), arguments or {})
        self.server.spawn(model, name or model.name, _transform_from_rpy(pose), namespace)
        return name or model.name

    def delete(self, name: str) -> None:
        """Delete a model from the world. See `SteppedSimulation.delete`."""
        self.server.delete(name)

    def robot_pose(self) -> Transform:
        """Return the robot's true pose. See `SteppedSimulation.robot_pose`."""
        assert self._model is not None, "there is a robot"
        return self.simulation.model_pose(self._model.name)

    def drive(self, linear: float, angular: float = 0.0, topic: str = "/cmd_vel") -> None:
        """Command the robot's velocity. See `SteppedSimulation.drive`."""
        message = get_message(_TWIST_TYPE)()
        message.linear.x, message.angular.z = float(linear), float(angular)
        self.publish(topic, message)

    async def settle(self) -> None:
        """Run all ready callbacks of the graph and the simulation.

        Callbacks that these cause are also run. Time does not advance.

        Raises:
            Exception: the error of a callback.
        """
        await self._settle_world()
        self._raise_callback_error()

    spin = settle

    async def _settle_world(self) -> None:
        await self._settle_graph()
        self.server.exchange.run_commands()
        self.server.exchange.deliver()
        await self._settle_graph()

    async def advance(self, seconds: float) -> None:
        """Advance the time of the simulation and of the graph.

        Raises:
            UnstableError: a value in the simulation is no longer finite.
            Exception: the error of a callback; time has advanced even then.
        """
        await self._advance(seconds)
        self._raise_callback_error()

    async def _advance(self, seconds: float) -> None:
        await self._settle_world()
        self._remaining_ns += round(seconds * NANOSECONDS_PER_SECOND)
        server, simulation = self.server, self.simulation
        self._record_position()
        while self._remaining_ns > 0:
            server.exchange.run_commands()
            step_ns = min(self._period_ns, self._remaining_ns)
            if not self._run_control.is_paused:
                time_before_ns = simulation.time
                simulation.advance(step_ns)
                step_ns = simulation.time - time_before_ns
            self._remaining_ns -= step_ns
            await self.clock.advance(step_ns / NANOSECONDS_PER_SECOND, is_settled=True)
            self._record_position()
            self._publish_time()
            server.exchange.deliver()
            await self._settle_graph()

    def _record_position(self) -> None:
        """Add the robot's true position to its recorded path if the next point is due."""
        path, time_ns = self._robot_path, self.clock.steady_ns()
        if path is None or not path.is_due(time_ns):
            return
        assert self._model is not None, "there is a robot"
        if self._model.name not in self.simulation.scene.models:
            self._robot_path = None  # the robot was deleted
            return
        x, y = self.simulation.model_pose(self._model.name)[:2]
        path.add(time_ns, float(x), float(y))

    async def reset(self) -> None:
        """Restore the initial state of the world, of simulated time and of the noise.

        Nodes and recorded messages remain, and the time of day is not reset.
        """
        self.server.reset()
        self._remaining_ns = 0
        if self._robot_path is not None:
            self._robot_path = start_path()
        self._publish_time()
        await self.settle()

    def _publish_time(self) -> None:
        self._clock_topic.publish(get_message(_CLOCK_TYPE)(clock=Time.from_nanoseconds(self.simulation.time)))


def _with_arguments_of(
    factory: Callable[_P, AsyncSteppedSimulation],
) -> Callable[[Callable[[_T, AsyncSteppedSimulation], None]], Callable[Concatenate[_T, _P], None]]:
    """Return a decorator that gives an ``__init__`` the signature of the asynchronous class.

    The decorated method receives an instance of the asynchronous class instead of the arguments.
    """

    def decorate(init: Callable[[_T, AsyncSteppedSimulation], None]) -> Callable[Concatenate[_T, _P], None]:
        @wraps(AsyncSteppedSimulation.__init__)
        def make_both(self: _T, /, *args: _P.args, **kwargs: _P.kwargs) -> None:
            init(self, factory(*args, **kwargs))

        return make_both

    return decorate


class SteppedSimulation(SteppedGraph):
    """A simulated world and a graph whose time advances only in `advance`.

    >>> with SteppedSimulation("empty", "package://my_robot_description/urdf/mbot_gazebo.xacro") as test:
    ...     odometry = test.record("/odom")
    ...     test.drive(0.5)
    ...     test.advance(2.5)
    ...     1.0 < odometry.last.pose.pose.position.x < 1.25
    True

    Neither threads nor real time are used. The world is simulated for one `period`. Then the graph calls the expired
    timers, publishes the time on ``/clock``, receives the messages of plugins and sensors, and runs the callbacks that
    these messages cause. The next period then begins, with the received commands. The results of a test are therefore
    bit-identical in each run. Nodes written for rclpy run in the graph after `init_rclpy`, and follow simulated time if
    the parameter ``use_sim_time`` is set.

    The simulation offers the services of a simulator: ``/spawn_entity``, ``/delete_entity``, ``/set_entity_state``,
    ``/pause_physics`` and so on; `spawn` and `delete` do the same as the first two services.

    Topics have the same names as in ``linkwright sim``: ``/cmd_vel``, ``/odom``, ``/scan``. Worlds and robots are read
    once per process, and again if their files have changed.

    Args:
        world: an SDF file, or the name of a world.
        robot: a URDF, xacro or SDF file to spawn in the world, or its ``package://`` URI; None for no robot.
        arguments: values for the ``<xacro:arg>`` elements of the robot.
        pose: the initial pose of the robot: x, y, z in m, roll, pitch, yaw in rad.
        seed: the seed of all noise.
        friction: the coefficient of friction of the world's static models, such as the ground; None for the values of
            the file. The lower value of two bodies in contact applies.
        mass: the factor for the robot's masses and inertias.
        noise: the factor for the noise of the robot's sensors; 0 for exact measurements.
        robot_state_publisher: whether a robot_state_publisher runs for the robot, which publishes the description and
            the transforms of the links from ``/joint_states``.
        services: whether the services of a simulator are offered, which a judged program must not have.
        period: the simulated time between two steps of the graph, in s.
        start: the time of day at the start, in seconds since the epoch.
        strict: whether the step in which a callback fails raises the callback's error; otherwise errors are only
            logged.

    Raises:
        LinkwrightError: SIM101, MuJoCo is not installed; SIM150, there is no such world; SIM142, the file contains no
            model; one of the files has errors.
    """

    _steps: AsyncSteppedSimulation

    @_with_arguments_of(AsyncSteppedSimulation)
    def __init__(self, steps: AsyncSteppedSimulation) -> None:
        super().__init__(steps=steps)

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._run(self._steps.end_programs(error))
        self._steps.server.close()  # The server must close first, because the shutdown of rclpy destroys its nodes.
        super().__exit__(kind, error, trace)

    @property
    def simulation(self) -> Simulation:
        """The simulation of the world: poses of links, positions of joints, forces."""
        return self._steps.simulation

    def spawn(
        self,
        robot: str | Path,
        name: str = "",
        *,
        pose: Sequence[float] = _ORIGIN_POSE,
        namespace: str = "",
        arguments: Mapping[str, object] | None = None,
    ) -> str:
        """Spawn another robot or model in the world, as the service ``/spawn_entity`` does.

        Args:
            robot: a URDF, xacro or SDF file, or its ``package://`` URI.
            name: the name of the model; empty for the name in the file.
            pose: the pose of the model's frame: x, y, z in m, roll, pitch, yaw in rad.
            namespace: the default namespace for the nodes of the model's plugins.
            arguments: values for the ``<xacro:arg>`` elements of the robot.

        Returns:
            The name of the model.

        Raises:
            LinkwrightError: SIM102, there is already a model with this name; SIM140, the model cannot be simulated;
                SIM142, the file contains no model; or the file has errors.
        """
        return self._steps.spawn(robot, name, pose=pose, namespace=namespace, arguments=arguments)

    def delete(self, name: str) -> None:
        """Delete a model from the world.

        Raises:
            LinkwrightError: SIM141, there is no model with this name.
        """
        self._steps.delete(name)

    def robot_pose(self) -> Transform:
        """Return the true pose of the robot's frame in the world.

        The pose consists of x, y, z in m and a quaternion x, y, z, w.
        """
        return self._steps.robot_pose()

    def world_plugins(self) -> tuple[SimulatedPlugin[object], ...]:
        """Return the running plugins of the world."""
        return self._steps.server.world_plugins

    def drive(self, linear: float, angular: float = 0.0, topic: str = "/cmd_vel") -> None:
        """Set the commanded velocity of the robot, beginning with the next step.

        Args:
            linear: the forward velocity, in m/s.
            angular: the yaw rate, positive to the left, in rad/s.
            topic: the topic on which the robot receives a ``Twist``.
        """
        self._steps.drive(linear, angular, topic)

    def reset(self) -> None:
        """Restore the initial state. See `AsyncSteppedSimulation.reset`."""
        self._run(self._steps.reset())


def _with_world_friction(world: World, friction: float) -> World:
    """Return a copy of a world with a coefficient of friction for all static models."""
    models = tuple(with_friction(model, friction) if model.static else model for model in world.models)
    return replace(world, models=models)


class _RunControl:
    """Handles the simulator services that pause the simulation or run single steps."""

    def __init__(self, simulation: Simulation) -> None:
        self.is_paused = False
        self._simulation = simulation

    def pause(self) -> None:
        self.is_paused = True

    def resume(self) -> None:
        self.is_paused = False

    def step(self, count: int) -> None:
        self._simulation.advance(count * self._simulation.step)


def _resolve_path(robot: str | Path) -> Path:
    return PackageFinder(start=[Path.cwd()]).resolve(str(robot), Path.cwd())


def _read_robot(path: Path, arguments: Mapping[str, object]) -> Model:
    return read_model(path, {name: _format_argument(value) for name, value in arguments.items()})


def _read_description(path: Path, arguments: Mapping[str, object]) -> str:
    """Read the file of a robot, and return its description as URDF.

    Raises:
        LinkwrightError: the file has errors.
    """
    finder = PackageFinder(start=[path.parent, Path.cwd()])
    texts = {name: _format_argument(value) for name, value in arguments.items()}
    description = examine(str(path), arguments=texts, packages=finder)
    if description.robot is None:
        raise LinkwrightError(*description.diagnostics)
    return description.text


def _transform_from_rpy(pose: Sequence[float]) -> Transform:
    x, y, z, roll, pitch, yaw = pose
    return (x, y, z, *quaternion_from_rpy((roll, pitch, yaw)))


def _format_argument(value: object) -> str:
    """Format a value as a xacro argument."""
    return str(value).lower() if isinstance(value, bool) else str(value)
