"""Launch descriptions that spawn controllers (``controller_manager.launch_utils``)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from linkwright.launch.model.actions import DeclareLaunchArgument
from linkwright.launch.model.description import LaunchDescription
from linkwright.launch.model.substitutions import LaunchConfiguration, PythonExpression
from linkwright.launch.ros.node import Node

_MANAGER = "controller_manager"
_UNLOAD_ARGUMENT = "unload_on_kill"


def generate_controllers_spawner_launch_description(
    controller_names: Iterable[Any],
    controller_params_files: Sequence[Any] | None = None,
    extra_spawner_args: Sequence[Any] = (),
) -> LaunchDescription:
    """Return a launch description that spawns controllers.

    The description declares an argument for the name of the controller manager, and an argument that determines whether
    the controllers are unloaded at the end.

    Args:
        controller_names: the names of the controllers.
        controller_params_files: the parameter files of the controllers; empty paths are ignored.
        extra_spawner_args: further arguments of the spawner.
    """
    file_arguments = [argument for file in controller_params_files or () if file for argument in ("--param-file", file)]
    unload_argument = PythonExpression(
        ['"--unload-on-kill" if "true" == "', LaunchConfiguration(_UNLOAD_ARGUMENT), '" else ""']
    )
    manager_argument = f"{_MANAGER}_name"
    spawner_arguments = [
        *controller_names,
        "--controller-manager",
        LaunchConfiguration(manager_argument),
        *file_arguments,
        unload_argument,
    ]
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                manager_argument, default_value=_MANAGER, description="Name of the controller manager's node"
            ),
            DeclareLaunchArgument(
                _UNLOAD_ARGUMENT, default_value="false", description="Unload the controllers at the end"
            ),
            Node(  # noqa: S604 - only a shell drops empty arguments
                package=_MANAGER,
                executable="spawner",
                arguments=[*spawner_arguments, *extra_spawner_args],
                shell=True,
                output="screen",
            ),
        ]
    )


def generate_controllers_spawner_launch_description_from_dict(
    controller_info_dict: Mapping[str, Any], extra_spawner_args: Sequence[Any] = ()
) -> LaunchDescription:
    """Return a launch description that spawns the controllers of a mapping.

    Args:
        controller_info_dict: maps each controller to its parameter file, a list of parameter files, or None.
        extra_spawner_args: further arguments of the spawner.

    Raises:
        ValueError: the argument is not a mapping, or the value of a controller has another type.
    """
    if not isinstance(controller_info_dict, Mapping):
        raise ValueError(f"Invalid controller_info_dict type parsed {controller_info_dict}")  # noqa: TRY004 - as in controller_manager
    files: list[Any] = []
    for controller_files in controller_info_dict.values():
        if controller_files and not isinstance(controller_files, (str, list)):
            raise ValueError(f"Invalid controller_params_file type parsed in the dict {controller_files}")
        files += controller_files if isinstance(controller_files, list) else [controller_files]
    return generate_controllers_spawner_launch_description(list(controller_info_dict), files, extra_spawner_args)


def generate_load_controller_launch_description(
    controller_name: Any,
    controller_type: Any = None,
    controller_params_file: Any = None,
    extra_spawner_args: Sequence[Any] = (),
) -> LaunchDescription:
    """Return a launch description that spawns one controller.

    The arguments are in the same order as in ROS 2 Humble.

    Args:
        controller_name: the name of the controller.
        controller_type: the plugin of the controller, if its parameters do not name it.
        controller_params_file: the controller's parameter file.
        extra_spawner_args: further arguments of the spawner.
    """
    controller_arguments = [controller_name, *(("--controller-type", controller_type) if controller_type else ())]
    return generate_controllers_spawner_launch_description(
        controller_arguments, [controller_params_file], extra_spawner_args
    )
