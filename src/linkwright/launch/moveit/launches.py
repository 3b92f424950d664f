"""The launch descriptions of a MoveIt configuration package.

They replace ``moveit_configs_utils.launches`` and ``moveit_configs_utils.launch_utils``.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

from linkwright.launch.frontend.include import IncludeLaunchDescription
from linkwright.launch.frontend.sources import PythonLaunchDescriptionSource
from linkwright.launch.model.actions import DeclareLaunchArgument
from linkwright.launch.model.conditions import IfCondition, UnlessCondition
from linkwright.launch.model.description import LaunchDescription
from linkwright.launch.model.substitutions import LaunchConfiguration
from linkwright.launch.moveit.configs import MoveItConfigs
from linkwright.launch.ros import Node, ParameterValue


def generate_rsp_launch(moveit_config: MoveItConfigs) -> LaunchDescription:
    """Return a launch description that starts the robot state publisher."""
    frequency = "publish_frequency"
    node = Node(
        package="robot_state_publisher",
        executable="robot_state_publisher",
        respawn=True,
        output="screen",
        parameters=[moveit_config.robot_description, {frequency: LaunchConfiguration(frequency)}],
    )
    return LaunchDescription([DeclareLaunchArgument(frequency, default_value="15.0"), node])


def generate_moveit_rviz_launch(moveit_config: MoveItConfigs) -> LaunchDescription:
    """Return a launch description that starts the viewer with the parameters of MoveIt."""
    description = LaunchDescription()
    description.add_action(DeclareBooleanLaunchArg("debug", default_value=False))
    description.add_action(
        DeclareLaunchArgument("rviz_config", default_value=_find_package_file(moveit_config, "config/moveit.rviz"))
    )
    add_debuggable_node(
        description,
        package="rviz2",
        executable="rviz2",
        output="log",
        respawn=False,
        arguments=["-d", LaunchConfiguration("rviz_config")],
        parameters=[
            moveit_config.planning_pipelines,
            moveit_config.robot_description_kinematics,
            moveit_config.joint_limits,
        ],
    )
    return description


def generate_setup_assistant_launch(moveit_config: MoveItConfigs) -> LaunchDescription:
    """Return a launch description that starts the Setup Assistant for the package."""
    description = LaunchDescription()
    description.add_action(DeclareBooleanLaunchArg("debug", default_value=False))
    name = "moveit_setup_assistant"
    arguments = [["--config_pkg=", str(moveit_config.package_path)]]
    add_debuggable_node(description, package=name, executable=name, arguments=arguments)
    return description


def generate_static_virtual_joint_tfs_launch(moveit_config: MoveItConfigs) -> LaunchDescription:
    """Return a launch description for static transforms of the virtual joints in the SRDF."""
    frames = [pair for text in moveit_config.robot_description_semantic.values() for pair in _read_virtual_joints(text)]
    return LaunchDescription(
        [
            Node(
                package="tf2_ros",
                executable="static_transform_publisher",
                name=f"static_transform_publisher{index}",
                output="log",
                arguments=["--frame-id", parent, "--child-frame-id", child],
            )
            for index, (parent, child) in enumerate(frames)
        ]
    )


def generate_spawn_controllers_launch(moveit_config: MoveItConfigs) -> LaunchDescription:
    """Return a launch description that spawns the controllers and the joint state broadcaster."""
    manager = moveit_config.trajectory_execution.get("moveit_simple_controller_manager") or {}
    controllers = [*(manager.get("controller_names") or ()), "joint_state_broadcaster"]
    return LaunchDescription(
        [
            Node(package="controller_manager", executable="spawner", arguments=[name], output="screen")
            for name in controllers
        ]
    )


def generate_warehouse_db_launch(moveit_config: MoveItConfigs) -> LaunchDescription:
    """Return a launch description that starts the warehouse database."""
    defaults = {
        "moveit_warehouse_database_path": _find_package_file(moveit_config, "default_warehouse_mongo_db"),
        "moveit_warehouse_port": "33829",
        "moveit_warehouse_host": "localhost",
    }
    parameters = {
        "overwrite": False,
        "database_path": LaunchConfiguration("moveit_warehouse_database_path"),
        "warehouse_port": LaunchConfiguration("moveit_warehouse_port"),
        "warehouse_host": LaunchConfiguration("moveit_warehouse_host"),
        "warehouse_exec": "mongod",
        "warehouse_plugin": "warehouse_ros_mongo::MongoDatabaseConnection",
    }
    return LaunchDescription(
        [
            *(DeclareLaunchArgument(name, default_value=value) for name, value in defaults.items()),
            DeclareBooleanLaunchArg("reset", default_value=False),
            Node(package="warehouse_ros_mongo", executable="mongo_wrapper_ros.py", parameters=[parameters]),
            Node(
                package="moveit_ros_warehouse",
                executable="moveit_init_demo_warehouse",
                output="screen",
                condition=IfCondition(LaunchConfiguration("reset")),
            ),
        ]
    )


def generate_move_group_launch(moveit_config: MoveItConfigs) -> LaunchDescription:
    """Return a launch description that starts move_group."""
    description = LaunchDescription()
    for name, value in (
        ("debug", False),
        ("allow_trajectory_execution", True),
        ("publish_monitored_planning_scene", True),
        ("monitor_dynamics", False),
    ):
        description.add_action(DeclareBooleanLaunchArg(name, default_value=value))
    for name in ("capabilities", "disable_capabilities"):
        value = moveit_config.move_group_capabilities.get(name, "")
        description.add_action(DeclareLaunchArgument(name, default_value=value))
    is_published = LaunchConfiguration("publish_monitored_planning_scene")
    settings = {
        "publish_robot_description_semantic": True,
        "allow_trajectory_execution": LaunchConfiguration("allow_trajectory_execution"),
        "capabilities": ParameterValue(LaunchConfiguration("capabilities"), value_type=str),
        "disable_capabilities": ParameterValue(LaunchConfiguration("disable_capabilities"), value_type=str),
        "publish_planning_scene": is_published,
        "publish_geometry_updates": is_published,
        "publish_state_updates": is_published,
        "publish_transforms_updates": is_published,
        "monitor_dynamics": False,
    }
    add_debuggable_node(
        description,
        package="moveit_ros_move_group",
        executable="move_group",
        commands_file=_find_package_file(moveit_config, "launch/gdb_settings.gdb"),
        output="screen",
        parameters=[moveit_config.to_dict(), settings],
        extra_debug_args=["--debug"],
        additional_env={"DISPLAY": ":0"},
    )
    return description


def generate_demo_launch(moveit_config: MoveItConfigs, launch_package_path: Path | None = None) -> LaunchDescription:
    """Return a launch description that starts all programs of a demo with simulated joints.

    Args:
        moveit_config: the parameters of MoveIt.
        launch_package_path: the share folder of the package whose launch files are included; None for the package of
            `moveit_config`.
    """
    folder = Path(launch_package_path or _find_package_folder(moveit_config)) / "launch"

    def include(file: str, **kwargs: Any) -> IncludeLaunchDescription:
        return IncludeLaunchDescription(PythonLaunchDescriptionSource(str(folder / file)), **kwargs)

    description = LaunchDescription()
    argument_description = "By default, no database is started: it can be large."
    description.add_action(DeclareBooleanLaunchArg("db", default_value=False, description=argument_description))
    argument_description = "Whether to run nodes in a debugger."
    description.add_action(DeclareBooleanLaunchArg("debug", default_value=False, description=argument_description))
    description.add_action(DeclareBooleanLaunchArg("use_rviz", default_value=True))
    virtual_joints = "static_virtual_joint_tfs.launch.py"
    if (folder / virtual_joints).exists():
        description.add_action(include(virtual_joints))
    description.add_action(include("rsp.launch.py"))
    description.add_action(include("move_group.launch.py"))
    description.add_action(include("moveit_rviz.launch.py", condition=IfCondition(LaunchConfiguration("use_rviz"))))
    description.add_action(include("warehouse_db.launch.py", condition=IfCondition(LaunchConfiguration("db"))))
    controllers = _find_package_file(moveit_config, "config/ros2_controllers.yaml")
    remappings = [("/controller_manager/robot_description", "/robot_description")]
    description.add_action(
        Node(
            package="controller_manager",
            executable="ros2_control_node",
            parameters=[moveit_config.robot_description, controllers],
            remappings=remappings,
        )
    )
    description.add_action(include("spawn_controllers.launch.py"))
    return description


def _find_package_folder(configs: MoveItConfigs) -> Path:
    return Path(configs.package_path or "")


def _find_package_file(configs: MoveItConfigs, file: str) -> str:
    return str(_find_package_folder(configs) / file)


def _read_virtual_joints(text: Any) -> Iterator[tuple[str, str]]:
    """Yield the parent frame and child link of each virtual joint in an SRDF.

    For an SRDF that is evaluated only during the launch, nothing is yielded.
    """
    if not isinstance(text, str):
        return
    for joint in ET.fromstring(text).iter("virtual_joint"):  # noqa: S314 - the output of Linkwright's expansion
        yield joint.get("parent_frame", "world"), joint.get("child_link", "")


class DeclareBooleanLaunchArg(DeclareLaunchArgument):
    """An action that declares a boolean argument.

    Args:
        name: the argument's name.
        default_value: the default value.
        description: the description for ``--show-args``.
    """

    def __init__(self, name: str, *, default_value: Any = False, description: str | None = None, **kwargs: Any) -> None:
        choices = ["true", "false", "True", "False"]
        super().__init__(name, default_value=str(default_value), description=description, choices=choices, **kwargs)


def add_debuggable_node(
    ld: LaunchDescription,
    package: str,
    executable: str,
    condition_name: str = "debug",
    commands_file: str | None = None,
    extra_debug_args: list[Any] | None = None,
    **kwargs: Any,
) -> None:
    """Add a node to a launch description.

    The node runs in gdb if a launch argument is true.

    Args:
        ld: the launch description.
        package: the package of the node.
        executable: the executable of the node.
        condition_name: the launch argument that determines whether to use gdb.
        commands_file: the path of a file with commands for gdb, or None.
        extra_debug_args: further arguments of the node in gdb, which have an effect only if `arguments` is given.
        kwargs: see `Node`.
    """
    debug = LaunchConfiguration(condition_name)
    ld.add_action(Node(package=package, executable=executable, condition=UnlessCondition(debug), **kwargs))
    if "arguments" in kwargs:
        kwargs["arguments"] = [*kwargs["arguments"], *(extra_debug_args or ())]
    commands = f"-x {commands_file} " if commands_file else ""
    prefix = [f"gdb {commands}--ex run --args"]
    ld.add_action(Node(package=package, executable=executable, condition=IfCondition(debug), prefix=prefix, **kwargs))
