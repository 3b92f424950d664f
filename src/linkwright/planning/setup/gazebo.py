"""How a robot is simulated in Gazebo: which simulator, and what its description has and lacks for it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from linkwright.planning.setup.bodies import find_bodies
from linkwright.planning.setup.srdf import WORLD, VirtualJointSettings
from linkwright.sdf.plugins import find_original_library, library_name
from linkwright.urdf import Robot


@dataclass(frozen=True, slots=True)
class Simulator:
    """A simulator with the controllers of ros2_control.

    Attributes:
        is_classic: whether it is Gazebo Classic.
        package: the package of the hardware and of the library.
        hardware: the class of the hardware.
        library: the library that runs the controllers, without ``lib`` and ``.so``.
        plugin: the ``name`` of the plugin in the library, which is a class for the newer Gazebo.
    """

    is_classic: bool
    package: str
    hardware: str
    library: str
    plugin: str

    @property
    def hardware_plugin(self) -> str:
        """The plugin for ``<hardware>``."""
        return f"{self.package}/{self.hardware}"


GZ = Simulator(
    is_classic=False,
    package="gz_ros2_control",
    hardware="GazeboSimSystem",
    library="gz_ros2_control-system",
    plugin="gz_ros2_control::GazeboSimROS2ControlPlugin",
)
IGNITION = Simulator(
    is_classic=False,
    package="ign_ros2_control",
    hardware="IgnitionSystem",
    library="ign_ros2_control-system",
    plugin="ign_ros2_control::IgnitionROS2ControlPlugin",
)
CLASSIC = Simulator(
    is_classic=True,
    package="gazebo_ros2_control",
    hardware="GazeboSystem",
    library="gazebo_ros2_control",
    plugin="gazebo_ros2_control",
)
_SIMULATORS = (GZ, IGNITION, CLASSIC)
CONTROLLERS_FILE = "ros2_controllers.yaml"


@dataclass(frozen=True, slots=True)
class GazeboSettings:
    """The settings for a robot in Gazebo.

    Attributes:
        simulator: the simulator.
        has_plugin: whether the description has the plugin that runs the controllers.
        controllers_file: the file from which this plugin reads the controllers, if it is not that of the package.
        arguments: the values of xacro arguments of the description that differ in Gazebo.
        fixed_link: the root link, if it has to be fixed to the world; otherwise empty.
        other_hardware: the hardware plugins of the description that Gazebo does not have.
        links_without_mass: the links that a joint moves and that have no mass, even with the links fixed to them.
    """

    simulator: Simulator
    has_plugin: bool
    controllers_file: str
    arguments: Mapping[str, str]
    fixed_link: str
    other_hardware: tuple[str, ...]
    links_without_mass: tuple[str, ...]


def choose_gazebo(
    robot: Robot, package: str, virtual_joint: VirtualJointSettings | None, arguments: Mapping[str, str]
) -> GazeboSettings:
    """Return the settings for a robot in Gazebo.

    The simulator is that of the plugin or of the hardware in the description, or else the newer Gazebo.

    Args:
        robot: the robot with the arguments for Gazebo.
        package: the name of the configuration package.
        virtual_joint: the joint between the robot and the frame in which it is placed.
        arguments: the values of xacro arguments that differ in Gazebo.
    """
    hardware = tuple(dict.fromkeys(_hardware(robot)))
    simulators = {name: _simulator_of_hardware(name) for name in hardware}
    plugin, file = next(_control_plugins(robot), (None, ""))
    is_fixed = virtual_joint is not None and virtual_joint.type == "fixed" and robot.root != WORLD
    return GazeboSettings(
        plugin or next(filter(None, simulators.values()), GZ),
        plugin is not None,
        "" if file.replace(")", "").endswith(f"{package}/config/{CONTROLLERS_FILE}") else file,
        arguments,
        robot.root if is_fixed else "",
        tuple(name for name, simulator in simulators.items() if simulator is None),
        tuple(_links_without_mass(robot)),
    )


def _hardware(robot: Robot) -> Iterator[str]:
    """Yield the hardware plugins of ros2_control in the description."""
    for element in robot.extensions:
        if element.tag == "ros2_control":
            for hardware in element.elements("hardware"):
                yield from (plugin.text().strip() for plugin in hardware.elements("plugin"))


def _simulator_of_hardware(plugin: str) -> Simulator | None:
    return next((each for each in _SIMULATORS if plugin.rpartition("/")[2] == each.hardware), None)


def _control_plugins(robot: Robot) -> Iterator[tuple[Simulator, str]]:
    """Yield the simulator and the file with the controllers of each plugin of the description that runs controllers.

    Vendors' copies of the plugins are known by the name of the class.
    """
    for extension in robot.extensions:
        for plugin in extension.elements("plugin") if extension.tag == "gazebo" else ():
            library = library_name(plugin.attributes.get("filename", ""))
            libraries = {library, find_original_library(plugin.attributes.get("name", ""))}
            simulators = [simulator for simulator in _SIMULATORS if simulator.library in libraries]
            files = [parameters.text().strip() for parameters in plugin.elements("parameters")]
            yield from ((simulator, files[-1] if files else "") for simulator in simulators)


def _links_without_mass(robot: Robot) -> Iterator[str]:
    """Yield the first link of each body that a joint moves and that has no mass."""
    for body in find_bodies(robot):
        inertials = (robot.links[name].inertial for name in body.links)
        if body.joint is not None and not any(inertial is not None and inertial.has_mass for inertial in inertials):
            yield body.links[0]
