"""The program gzserver: the node ``gazebo`` with a simulated world and its services.

The node behaves like the gzserver of Gazebo classic with the libraries of gazebo_ros, and like the server of gz.
The world is simulated in a separate thread, see `linkwright.simulation.server`.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from math import inf
from typing import TYPE_CHECKING, Any, ClassVar

from linkwright.diagnostics import Diagnostic, LinkwrightError, Severity
from linkwright.geometry.single import Transform, quaternion_from_rpy
from linkwright.graph import Graph, Parameter, SetParametersResult
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors

if TYPE_CHECKING:
    from linkwright.nodes.watched_files import FileWatcher
    from linkwright.sdf.plugins import Plugin

_EMPTY_WORLD, _DESCRIPTION_PARAMETER = "empty", "robot_description"
_LOGGED_WARNINGS = frozenset({"SDF150", "SDF160", "SDF161"})
"""The codes of warnings about unknown elements and missing files, which are logged like errors."""
_PARAMETERS: dict[str, Any] = {
    "world": _EMPTY_WORLD,
    "world_sdf_file": "",
    "world_sdf_string": "",
    "publish_rate": 10.0,
    "real_time_factor": 0.0,
    "step": 0.0,
    "seed": 0,
    "pause": False,
    "gui": False,
    "seconds": 0.0,
    "usual_names": False,
    "gazebo_mistakes": False,
    _DESCRIPTION_PARAMETER: "",
    "robot_name": "",
    "robot_pose": [0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    "robot_namespace": "",
}

_PAUSED_NOTICE = (
    "The simulation is paused: resume it in the page, or call /unpause_physics. 'gz sim -r' starts without a pause"
)


class Simulator(SingleNode):
    """The simulator's node.

    Its parameters:

    ``world``
        the world file, which may also be the only argument apart from ROS arguments; ``empty`` is a ground plane.
    ``world_sdf_file``, ``world_sdf_string``
        the world file, or the text of the world, as for the gzserver of ros_gz_sim.
    ``publish_rate``
        the rate of ``/clock`` in simulated time, in Hz.
    ``real_time_factor``
        simulated seconds per real second; 0 for the factor in the world, negative for as fast as possible.
    ``step``
        the time step in s; 0 for the time step of the world.
    ``seed``, ``pause``, ``seconds``
        the random seed; whether to start paused; the simulated seconds after which to end, 0 for never.
    ``gui``
        whether the host of the node opens a page with the world.
    ``usual_names``
        whether gz topics are also available under the names that are usual on robots.
    ``gazebo_mistakes``
        whether plugins reproduce the known mistakes of Gazebo, see docs/simulation.md.
    ``robot_description``, ``robot_name``, ``robot_pose``, ``robot_namespace``
        a robot that exists from the start: URDF or SDF, and x, y, z in m and roll, pitch, yaw in rad. The
        description may be replaced while the node runs: the robot keeps its pose and its joint positions.

    Attributes:
        finished: a future with the exit status: 0 after ``seconds``, or 1 if the simulation failed.

    Raises:
        LinkwrightError: SIM150, the world does not exist; SIM101, MuJoCo is missing; an error in the world or robot.
    """

    DEFAULT_NAME = "gazebo"
    REPEATS_TIME: ClassVar[bool] = False
    """Whether a paused simulation repeats its time on ``/clock``. Gazebo classic publishes it only in steps."""

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        from linkwright.graph.stepped.node import SteppedNode
        from linkwright.simulation.server.reports import Reports
        from linkwright.simulation.server.runner import Runner
        from linkwright.simulation.server.server import ServerOptions, SimulationServer
        from linkwright.simulation.server.services import Services
        from linkwright.simulation.server.worlds import load_world
        from linkwright.simulation.simulation import Simulation

        self._node, arguments = create_node(graph, options, self.DEFAULT_NAME)
        loop = asyncio.get_running_loop()
        self.finished: asyncio.Future[int] = loop.create_future()
        with handle_start_errors(self._node):
            parameters = {name: self._node.declare_parameter(name, value).value for name, value in _PARAMETERS.items()}
            world_text = parameters["world_sdf_string"] or None
            world_file = "world_sdf_string" if world_text else parameters["world_sdf_file"] or parameters["world"]
            loaded_world = (
                load_world(arguments[0], environment=options.environment)
                if arguments
                else load_world(world_file, world_text, options.environment)
            )
            logged_findings = (
                diagnostic
                for diagnostic in loaded_world.diagnostics
                if diagnostic.severity is Severity.ERROR or diagnostic.code in _LOGGED_WARNINGS
            )
            self._log_findings(logged_findings)
            simulation = Simulation(loaded_world.world, loaded_world.finder, step=parameters["step"] or None)
            server_options = ServerOptions(
                parameters["seed"],
                parameters["usual_names"],
                parameters["gazebo_mistakes"],
                self._get_default_plugins(),
            )
            self.server = SimulationServer(simulation, self._node, server_options)
            stepped_node = SteppedNode(self._node, self.server.exchange, owned=False)
            self._reports = Reports(
                self.server, stepped_node, parameters["publish_rate"], repeats_time=self.REPEATS_TIME
            )
            self.runner = Runner(
                self.server,
                factor=parameters["real_time_factor"] if parameters["real_time_factor"] >= 0 else inf,
                paused=parameters["pause"],
                seconds=parameters["seconds"] or None,
                watch=self._publish_due,
                on_state=self._publish_state,
                on_end=partial(_call_threadsafe, loop, self._finish),
            )
            self.services = Services(self.server, self.runner, stepped_node, loaded_world, options.library)
            self.server.start()
            if parameters[_DESCRIPTION_PARAMETER]:
                pose = _to_transform(parameters["robot_pose"])
                robot = self.services.spawn(
                    parameters[_DESCRIPTION_PARAMETER], parameters["robot_name"], pose, parameters["robot_namespace"]
                )
                self._node.add_on_set_parameters_callback(partial(self._on_parameters, robot))
            self._reports.start_description()
            self._publish_state()
            self.server.exchange.deliver()
            if parameters["pause"]:
                self._node.get_logger().info(_PAUSED_NOTICE)
            self.runner.start()

    def watch_files(self, host: FileWatcher) -> None:
        """Reload the world and the spawned robots when their files are saved."""
        from linkwright.simulation.nodes.saved_files import watch_files

        watch_files(self._node, self.server, self.services, host)

    def close(self) -> None:
        """Stop the simulation, and destroy the node."""
        self.runner.close()
        self.server.close()
        super().close()

    def _get_default_plugins(self) -> Sequence[Plugin]:
        """Return the default plugins of a world that does not declare any."""
        return ()

    def _on_parameters(self, robot: str, parameters: Sequence[Parameter]) -> SetParametersResult:
        """Replace the robot if its description changes, and keep the robot's state.

        An invalid description is rejected with the reason.
        """
        from linkwright.simulation.plugins.entities import format_finding

        for parameter in parameters:
            if parameter.name == _DESCRIPTION_PARAMETER:
                try:
                    self.services.replace_model(parameter.value, robot)
                except LinkwrightError as error:
                    return SetParametersResult(successful=False, reason=format_finding(error.diagnostics[0]))
        return SetParametersResult(successful=True)

    def _finish(self, status: int) -> None:
        if not self.finished.done():
            self.finished.set_result(status)

    def _publish_due(self) -> None:
        self._reports.publish_due(lambda: self.runner.real_time_factor, paused=self.runner.is_paused)

    def _publish_state(self) -> None:
        self._reports.publish_state(paused=self.runner.is_paused)

    def _log_findings(self, findings: Iterable[Diagnostic]) -> None:
        """Log the findings as errors or warnings, without repeating a message."""
        logger = self._node.get_logger()
        first_findings: dict[str, Diagnostic] = {}
        for finding in findings:
            first_findings.setdefault(str(finding.message), finding)
        for first_finding in first_findings.values():
            location = f"{first_finding.span}: " if first_finding.span else ""
            hint = f" ({first_finding.hint})" if first_finding.hint else ""
            text = f"{location}{first_finding.message}{hint}"
            if first_finding.severity is Severity.ERROR:
                logger.error(text)
            else:
                logger.warning(text)


class GzServer(Simulator):
    """The simulator's node in place of the server of gz.

    A world without plugins gets the default plugins of gz. A paused simulation repeats its time, as gz does after each
    iteration, so that nodes with simulated time have a time before the first step.
    """

    REPEATS_TIME = True

    def _get_default_plugins(self) -> Sequence[Plugin]:
        from linkwright.simulation.plugins.registry import DEFAULT_GZ_SYSTEMS

        return DEFAULT_GZ_SYSTEMS


def _call_threadsafe(loop: asyncio.AbstractEventLoop, function: Callable[[int], None], status: int) -> None:
    loop.call_soon_threadsafe(function, status)


def _to_transform(numbers: Sequence[float]) -> Transform:
    x, y, z, roll, pitch, yaw = numbers
    return (x, y, z, *quaternion_from_rpy((roll, pitch, yaw)))
