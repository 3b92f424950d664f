"""The ``<gazebo>`` elements that drive a robot in Gazebo Classic and in Linkwright.

Sources: the plugins of gazebo_ros_pkgs for ROS 2, and of gz-sim for joints that hold their positions, with their
parameters.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from linkwright.inference.results import Drive
from linkwright.loading.extensions import extensions
from linkwright.sdf.plugins import find_original_library, library_name
from linkwright.urdf import Robot
from linkwright.xmltree import Element, Text

_DRIVE_PATTERN = re.compile(
    r"diff[_-]?drive|skid[_-]?steer|planar[_-]?move|ackermann|mecanum|tricycle|omni[_-]?drive|object_controller"
    r"|velocity[_-]control|hoverboard|ros2?_control|multicopter|track(?:ed)?[_-]",
    re.IGNORECASE,
)
_JOINT_STATES_PATTERN = re.compile(r"joint[_-]state[_-]publisher", re.IGNORECASE)
_JOINT_CONTROL_PATTERN = re.compile(r"joint[_-](?:position|pose|trajectory|controller)", re.IGNORECASE)
_ROS1_CONTROL = "gazebo_ros_control"
"""The library of ROS 1 whose controllers are in the parameter server, unless its element names parameter files."""
_ROS2_CONTROL_PATTERN = re.compile(r"ros2?_control")
_PLUGIN_GROUP = "linkwright.simulated_plugins"
_SIMULATOR_PATTERN = re.compile(r"gz|gazebo|ign|mujoco|isaac", re.IGNORECASE)

_MAX_ACCELERATION = 1.0
"""The maximum acceleration of wheels in m/s2. With more, they would spin on the spot."""

_CASTER_FRICTION = "0.0"
"""The friction of a caster. It is simulated without its swivel, so it slides where a real one would roll."""

_GRAVITY = 9.81
"""The acceleration of gravity in m/s2."""
_MOTOR_RIM_SPEED = 1.0
"""The rim speed in m/s that a motor reaches against the damping of its wheel's joint."""
_SKID_TORQUE_FACTOR = 4.0
"""The motor torque of a skid-steered robot, as a multiple of the torque at which the wheels slip.

With less torque the wheels stalled in our measurements.
"""

_UPDATE_RATE = "50"


def find_working_drive(robot: Robot) -> Element | None:
    """Return the description's plugin that drives the robot, or None if none works here."""
    return next((plugin for plugin in _find_drive_plugins(robot) if _is_working(plugin)), None)


def find_idle_drive(robot: Robot) -> Element | None:
    """Return an element that should drive the robot but has no effect here, or None.

    The element is a plugin or a ``<ros2_control>``. Examples are controllers of ROS 1, controllers with a missing
    parameter file, and a ``<ros2_control>`` for a simulator without the plugin that runs it. Such a plugin is often in
    a separate file for launches.
    """
    idle_plugin = next((plugin for plugin in _find_drive_plugins(robot) if not _is_working(plugin)), None)
    if idle_plugin is not None:
        return idle_plugin
    if any(
        _ROS2_CONTROL_PATTERN.search(plugin.attributes.get("filename", "")) for plugin in _find_drive_plugins(robot)
    ):
        return None
    return next(
        (
            extension
            for extension in robot.extensions
            if extension.tag == "ros2_control"
            for hardware in extension.elements("hardware")
            if any(_SIMULATOR_PATTERN.search(plugin.text()) for plugin in hardware.elements("plugin"))
        ),
        None,
    )


def find_commanded_joints(robot: Robot) -> frozenset[str]:
    """Return the joints that controllers can command.

    The description lists them in ``<ros2_control>`` or, as in ROS 1, in ``<transmission>``.
    """
    return frozenset(
        joint.attributes.get("name", "")
        for extension in robot.extensions
        if extension.tag in ("ros2_control", "transmission")
        for joint in extension.elements("joint")
        if extension.tag == "transmission" or joint.first("command_interface") is not None
    )


def _find_drive_plugins(robot: Robot) -> Iterator[Element]:
    for extension in robot.extensions:
        for plugin in extension.elements("plugin") if extension.tag == "gazebo" else ():
            if _DRIVE_PATTERN.search(f"{plugin.attributes.get('filename', '')} {plugin.attributes.get('name', '')}"):
                yield plugin


def _is_working(plugin: Element) -> bool:
    """Return whether the simulation supports a plugin, and the plugin's parameter files exist."""
    supported = extensions(_PLUGIN_GROUP)
    names = (
        library_name(plugin.attributes.get("filename", "")),
        find_original_library(plugin.attributes.get("name", "")),
    )
    files = [Path(element.text().strip()) for element in plugin.elements("parameters")]
    if _ROS1_CONTROL in names and not files:
        return False
    return any(name in supported for name in names) and all(file.exists() for file in files if file.is_absolute())


def find_plugins_without_controllers(robot: Robot) -> tuple[Element, ...]:
    """Return the plugins without controllers, which would hold the joints of a drive."""
    return tuple(
        plugin
        for plugin in _find_drive_plugins(robot)
        if library_name(plugin.attributes.get("filename", "")) == _ROS1_CONTROL and not _is_working(plugin)
    )


def publishes_joint_states(robot: Robot) -> bool:
    """Return whether a plugin of the description publishes joint states."""
    return any(
        _JOINT_STATES_PATTERN.search(plugin.attributes.get("filename", ""))
        for extension in robot.extensions
        if extension.tag == "gazebo"
        for plugin in extension.elements("plugin")
    )


def find_controlled_joints(robot: Robot) -> frozenset[str]:
    """Return the joints that plugins of the description hold and move.

    A plugin that names no joints controls all joints.
    """
    controlled: set[str] = set()
    for extension in robot.extensions:
        for plugin in extension.elements("plugin") if extension.tag == "gazebo" else ():
            if _JOINT_CONTROL_PATTERN.search(plugin.attributes.get("filename", "")):
                names = {
                    element.text().strip() for element in plugin.elements() if element.tag in ("joint_name", "joint")
                }
                controlled |= names or set(robot.joints)
    return frozenset(controlled)


def has_friction(robot: Robot, link: str) -> bool:
    """Return whether a ``<gazebo>`` element sets the friction of a link."""
    return any(
        extension.tag == "gazebo"
        and extension.attributes.get("reference") == link
        and any(extension.first(tag) is not None for tag in ("mu1", "mu2", "mu"))
        for extension in robot.extensions
    )


def create_frictionless_element(link: str) -> Element:
    """Return the ``<gazebo>`` element that lets a caster slide without friction."""
    element = Element("gazebo", {"reference": link})
    element.children += [_create_text_element("mu1", _CASTER_FRICTION), _create_text_element("mu2", _CASTER_FRICTION)]
    return element


def create_drive_element(robot: Robot, drive: Drive, base_frame: str, mass: float) -> Element:
    """Return the ``<gazebo>`` element with the plugin that drives the wheels.

    Args:
        robot: the robot.
        drive: a drive of any kind except `joints`.
        base_frame: the child frame of the odometry.
        mass: the mass of the robot in kg.
    """
    makers = {
        "differential": _describe_diff_drive,
        "skid": _describe_diff_drive,
        "mecanum": _describe_planar_move,
        "ackermann": _describe_ackermann,
    }
    name, filename, parameters = makers[drive.kind](drive, _compute_torque(robot, drive, mass))
    odometry = [
        ("odometry_frame", "odom"),
        ("robot_base_frame", base_frame),
        ("publish_odom", "true"),
        ("publish_odom_tf", "true"),
    ]
    return _create_gazebo_element(_create_plugin_element(name, filename, [*parameters, *odometry]))


def create_joint_states_element(joints: Sequence[str]) -> Element:
    """Return the ``<gazebo>`` element with the plugin that publishes the positions of joints."""
    names = [("joint_name", name) for name in joints]
    plugin = _create_plugin_element(
        "joint_states", "libgazebo_ros_joint_state_publisher.so", [("update_rate", _UPDATE_RATE), *names]
    )
    return _create_gazebo_element(plugin)


def create_joint_controllers_element(joints: Iterable[str]) -> Element:
    """Return the ``<gazebo>`` element with plugins that hold joints, and move them on command."""
    return _create_gazebo_element(
        *(
            _create_plugin_element(
                "gz::sim::systems::JointPositionController",
                "gz-sim-joint-position-controller-system",
                [("joint_name", name), ("use_velocity_commands", "true")],
            )
            for name in joints
        )
    )


def _describe_diff_drive(drive: Drive, torque: float) -> tuple[str, str, list[tuple[str, str]]]:
    count = len(drive.left)
    pairs = [("num_wheel_pairs", str(count))] if count > 1 else []
    separations = [abs(left.center[1] - right.center[1]) for left, right in zip(drive.left, drive.right, strict=True)]
    diameters = [a.radius + b.radius for a, b in zip(drive.left, drive.right, strict=True)]
    parameters = [
        ("update_rate", _UPDATE_RATE),
        *pairs,
        *(("left_joint", wheel.joint) for wheel in drive.left),
        *(("right_joint", wheel.joint) for wheel in drive.right),
        *(("wheel_separation", format_number(separation)) for separation in separations),
        *(("wheel_diameter", format_number(diameter)) for diameter in diameters),
        ("max_wheel_torque", f"{torque:.3g}"),
        ("max_wheel_acceleration", format_number(_MAX_ACCELERATION)),
        ("odometry_source", "0"),
        ("publish_wheel_tf", "false"),
    ]
    return "diff_drive", "libgazebo_ros_diff_drive.so", parameters


def _describe_planar_move(_drive: Drive, _compute_torque: float) -> tuple[str, str, list[tuple[str, str]]]:
    return (
        "planar_move",
        "libgazebo_ros_planar_move.so",
        [("update_rate", _UPDATE_RATE), ("publish_rate", _UPDATE_RATE)],
    )


def _describe_ackermann(drive: Drive, torque: float) -> tuple[str, str, list[tuple[str, str]]]:
    left, right = drive.steered
    gains = f"{10.0 * torque:.3g} 0 {0.1 * torque:.3g}"
    parameters = [
        ("update_rate", _UPDATE_RATE),
        ("front_left_joint", left.joint),
        ("front_right_joint", right.joint),
        ("rear_left_joint", drive.left[0].joint),
        ("rear_right_joint", drive.right[0].joint),
        ("left_steering_joint", left.steering or ""),
        ("right_steering_joint", right.steering or ""),
        ("max_steer", "0.6"),
        ("max_speed", "20"),
        ("left_steering_pid_gain", gains),
        ("right_steering_pid_gain", gains),
        ("linear_velocity_pid_gain", gains),
        ("publish_wheel_tf", "false"),
        ("publish_distance", "false"),
    ]
    return "ackermann_drive", "libgazebo_ros_ackermann_drive.so", parameters


def _compute_torque(robot: Robot, drive: Drive, mass: float) -> float:
    """Return the maximum torque of a wheel in N m: slip torque, joint friction and damping."""
    wheels = (*drive.left, *drive.right)
    slip_torque = _GRAVITY * mass * drive.radius / len(wheels)
    dynamics = [robot.joints[wheel.joint].dynamics for wheel in wheels]
    joint_torques = [
        dynamic.friction + dynamic.damping * _MOTOR_RIM_SPEED / drive.radius
        for dynamic in dynamics
        if dynamic is not None
    ]
    return (_SKID_TORQUE_FACTOR if drive.kind == "skid" else 1.0) * slip_torque + max(joint_torques, default=0.0)


def format_number(value: float) -> str:
    """Format a number with at most six digits."""
    return f"{value:.6g}"


def _create_gazebo_element(*plugins: Element) -> Element:
    element = Element("gazebo")
    element.children += plugins
    return element


def _create_plugin_element(name: str, filename: str, parameters: Iterable[tuple[str, str]]) -> Element:
    element = Element("plugin", {"name": name, "filename": filename})
    element.children += [_create_text_element(tag, text) for tag, text in parameters]
    return element


def _create_text_element(tag: str, text: str) -> Element:
    element = Element(tag)
    element.children.append(Text(text))
    return element
