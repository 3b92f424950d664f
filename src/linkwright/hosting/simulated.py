"""The view of a simulated world, with or without a robot, that runs without a launch file."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.hosting.launch_log import LaunchLog
from linkwright.hosting.plans import VIEWER, HostedPlan, HostOptions
from linkwright.hosting.sensor_topics import find_image_topics, find_scan_topics
from linkwright.hosting.signals import SignalWatch, run_to_end
from linkwright.hosting.simulated_files import SimulatedDescriptions
from linkwright.hosting.view import ModelView
from linkwright.hosting.xacro_calls import XacroCall
from linkwright.packages import PackageFinder
from linkwright.xmltree import write

if TYPE_CHECKING:
    from linkwright.bag import BagWriter
    from linkwright.descriptions import Description
    from linkwright.inference import Inference
    from linkwright.rviz import RvizConfig
    from linkwright.urdf import Robot

_SIMULATOR_NODE = ("gazebo_ros", "gzserver")
_CLOCK_RATE_HZ = 100.0
"""The rate, in Hz, at which simulated time is published. It limits the age of transforms."""
_SCAN_DISPLAY, _IMAGE_DISPLAY = "rviz_default_plugins/LaserScan", "rviz_default_plugins/Image"
_PARTICLES_DISPLAY = "rviz_default_plugins/MarkerArray"
_ODOMETRY_DISPLAY, _ODOMETRY_TOPIC = "rviz_default_plugins/Odometry", "/odom"
_DRIVE_PLUGIN = re.compile(
    r"diff.drive|DiffDrive|skid_steer|planar_move|ackermann|mecanum|velocity.control", re.IGNORECASE
)


def _to_text(description: Description) -> str:
    return description.text


def _complete_description(description: Description, inference: Inference) -> str:
    from linkwright.inference.completion import complete_description  # Only some robots need it.

    return write(complete_description(description.document, inference))


@dataclass(frozen=True, slots=True)
class PlannedNode:
    """A node to run beside a simulated world.

    Attributes:
        package: the package of the node.
        executable: the name of its executable.
        parameters: the values of the parameters by name.
        arguments: the command line without the name of the program.
    """

    package: str
    executable: str
    parameters: Mapping[str, Any]
    arguments: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class SimulatedWorld:
    """A world to simulate, and the robot or model in it.

    Attributes:
        world: the path of a world file, or the name of a world.
        path: the file that the page is named after.
        description: the description of a robot in URDF; None for no robot, or for a model in SDF.
        text: the text of the simulated robot or model, in URDF or SDF; empty for none.
        name: the name of the robot or model in the world.
        pose: the pose of the robot's or model's frame: x, y, z in m, roll, pitch, yaw in rad.
        seconds: the simulated seconds after which the run ends; 0 for no limit.
        rate: the simulated seconds per real second; 0 for the rate of the world, negative for the maximum.
        step: the time step in s; 0 for that of the world.
        seed: the seed of the random numbers.
        paused: whether the simulation starts paused.
        headless: whether no page is served.
        gazebo_mistakes: whether plugins reproduce known bugs of Gazebo.
        particles_topic: the topic of the particles of emitters and of the drawings of plugins; empty for none.
        arguments: the names and values of the robot's xacro arguments.
        nodes: the nodes to run beside the simulator.
        complete: returns the text to simulate, for a description that was read again after the robot's file was saved.
    """

    world: str
    path: Path
    description: Description | None = None
    text: str = ""
    name: str = ""
    pose: tuple[float, ...] = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    seconds: float = 0.0
    rate: float = 0.0
    step: float = 0.0
    seed: int = 0
    paused: bool = False
    headless: bool = False
    gazebo_mistakes: bool = False
    particles_topic: str = ""
    arguments: tuple[tuple[str, str], ...] = ()
    nodes: tuple[PlannedNode, ...] = ()
    complete: Callable[[Description], str] = _to_text

    @classmethod
    def of(
        cls, world: str, description: Description, inference: Inference, infer: Callable[[Robot], Inference]
    ) -> SimulatedWorld:
        """Return a world with a robot on the ground.

        The robot's description is completed with inferred values.

        Args:
            world: the path of a world file, or the name of a world.
            description: the description of the robot.
            inference: the values that were inferred for the robot.
            infer: infers the values again, after the robot's file has changed.
        """

        def complete(new_description: Description) -> str:
            return (
                new_description.text
                if new_description.robot is None
                else _complete_description(new_description, infer(new_description.robot))
            )

        assert description.robot is not None, "something was inferred about it"
        pose = (0.0, 0.0, -inference.ground_z, 0.0, 0.0, 0.0)
        path, text = Path(description.name).absolute(), _complete_description(description, inference)
        return cls(world, path, description, text, description.robot.name, pose, complete=complete)

    @property
    def parameters(self) -> dict[str, Any]:
        """The parameters of the simulator node."""
        robot_parameters = {"robot_description": self.text, "robot_name": self.name, "robot_pose": list(self.pose)}
        return {
            "world": self.world,
            "publish_rate": _CLOCK_RATE_HZ,
            "real_time_factor": self.rate,
            "seconds": self.seconds,
            "step": self.step,
            "seed": self.seed,
            "pause": self.paused,
            "usual_names": True,
            "gazebo_mistakes": self.gazebo_mistakes,
            **(robot_parameters if self.text else {}),
        }


def run_simulated(
    world: SimulatedWorld,
    finder: PackageFinder,
    options: HostOptions,
    *,
    foxglove: int | None = None,
    writer: BagWriter | None = None,
) -> int:
    """Simulate a world until the user ends the run, or the simulated seconds have passed.

    Args:
        world: the world, and the robot or model in it.
        finder: the finder of ROS packages.
        options: the options of nodes and viewers.
        foxglove: the port to which Foxglove and Lichtblick can connect; None to open no port.
        writer: writes a recording of all topics with simulated times; None for no recording.

    Returns:
        The exit status, see `linkwright.hosting.signals.run_to_end`.
    """
    options = replace(options, title=world.path.name)
    log = LaunchLog()

    def run(signals: SignalWatch) -> bool:
        async def run_on_loop() -> bool:
            signals.session = view = SimulatedView(world, finder, options, log)
            return await view.run(foxglove, writer)

        return signals.run(run_on_loop)

    return run_to_end(run, finder, log)


class SimulatedView(ModelView):
    """The view of a simulated world on the running event loop.

    Its nodes are the simulator, the robot's robot_state_publisher, and the viewer.
    """

    def __init__(self, world: SimulatedWorld, finder: PackageFinder, options: HostOptions, log: LaunchLog) -> None:
        descriptions = SimulatedDescriptions(finder, world.complete)
        super().__init__(XacroCall(world.path, world.arguments), finder, options, log, descriptions)
        self._world = world
        self._files = descriptions

    def _plan_description(self) -> bool:
        """Plan the publication of the robot, if any, and return whether the view can continue.

        When the files of the robot and the world are saved, they are reloaded.
        """
        description, text = self._world.description, self._world.text
        if text:
            self._files.record_read_time(self._call)
            self._files.store_text(self._call, text, (self._call.path,) if description is None else description.files)
        if description is not None:
            self._files.store(self._call, description)
            self._plan_node(
                "robot_state_publisher", "robot_state_publisher", {"robot_description": text, "use_sim_time": True}
            )
        return True

    def _plan_other_nodes(self) -> None:
        self._plan_node(*_SIMULATOR_NODE, self._world.parameters, output="screen", waits_for_fix=False)
        for node in self._world.nodes:
            self._plan_node(node.package, node.executable, dict(node.parameters), arguments=node.arguments)
        if not self._world.headless:
            self._plan_node(*VIEWER, {"use_sim_time": True}, name="viewer", viewer_config=self._create_viewer_config)

    def _create_viewer_config(self) -> RvizConfig:
        """Return a configuration that shows the world, and the robot with its scans and images.

        Only the images of the first camera are shown, because rendering takes time. Odometry is hidden, because it
        would cover the robot.
        """
        from linkwright.hosting.world_config import create_world_config

        config = create_world_config(str(self._world.path), *self._world.pose[:2])

        def add_display(display_class: str, topic: str, *, name: str = "", checked: bool = True) -> None:
            display = config.make_display(display_class, name or display_class.rpartition("/")[2])
            display.section.put(("Topic", "Value"), topic, string=True)
            display.section.put(("Topic", "Reliability Policy"), "Best Effort", string=True)
            config.insert(display)
            display.checked = checked

        text = self._world.text
        for topic in find_scan_topics(text):
            add_display(_SCAN_DISPLAY, topic)
        if self._world.particles_topic:
            add_display(_PARTICLES_DISPLAY, self._world.particles_topic, name="Particles")
        for index, topic in enumerate(find_image_topics(text)):
            add_display(_IMAGE_DISPLAY, topic, checked=index == 0)
        if _DRIVE_PLUGIN.search(text):
            add_display(_ODOMETRY_DISPLAY, _ODOMETRY_TOPIC, checked=False)
        return config

    def report_node_end(self, plan: HostedPlan, status: int) -> None:
        """End the view if the node that ended is the simulator."""
        if plan.package == _SIMULATOR_NODE[0]:
            if status:
                self.fail(plan)
            self.shut_down("the simulation has ended")
