"""Launch descriptions that spawn controllers (``controller_manager.launch_utils``)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from linkwright.launch.model.actions import DeclareLaunchArgument
from linkwright.launch.model.description import LaunchDescription
from linkwright.launch.model.substitutions import LaunchConfiguration, PythonExpression
from linkwright.launch.ros.node import Node

_MANAGER = "controller_manager"
_UNLOAD = "unload_on_kill"


def generate_controllers_spawner_launch_description(
    controller_names: Iterable[Any],
    controller_params_files: Sequence[Any] | None = None,
    extra_spawner_args: Sequence[Any] = (),
) -> LaunchDescription:
    """Return a launch description that spawns controllers.

    The description declares arguments for the name of the controller manager, and for whether the controllers are
    unloaded at the end.

    Args:
        controller_names: the names of the controllers.
        controller_params_files: the parameter files of the controllers; empty names are skipped.
        extra_spawner_args: further arguments of the spawner.
    """
    files = [word for file in controller_params_files or () if file for word in ("--param-file", file)]
    unload = PythonExpression(['"--unload-on-kill" if "true" == "', LaunchConfiguration(_UNLOAD), '" else ""'])
    manager = f"{_MANAGER}_name"
    words = [*controller_names, "--controller-manager", LaunchConfiguration(manager), *files, unload]
    return LaunchDescription(
        [
            DeclareLaunchArgument(manager, default_value=_MANAGER, description="Name of the controller manager's node"),
            DeclareLaunchArgument(_UNLOAD, default_value="false", description="Unload the controllers at the end"),
            Node(  # noqa: S604 - an argument may be empty, which only a shell drops
                package=_MANAGER,
                executable="spawner",
                arguments=[*words, *extra_spawner_args],
                shell=True,
                output="screen",
            ),
        ]
    )


def generate_controllers_spawner_launch_description_from_dict(
    controller_info_dict: Mapping[str, Any], extra_spawner_args: Sequence[Any] = ()
) -> LaunchDescription:
    """Return a launch description that spawns the controllers in a mapping.

    Args:
        controller_info_dict: controller -> its parameter file, a list of parameter files, or None.
        extra_spawner_args: further arguments of the spawner.

    Raises:
        ValueError: the argument is not a mapping, or a file has another type.
    """
    if not isinstance(controller_info_dict, Mapping):
        raise ValueError(f"Invalid controller_info_dict type parsed {controller_info_dict}")  # noqa: TRY004 - as in controller_manager
    files: list[Any] = []
    for given in controller_info_dict.values():
        if given and not isinstance(given, (str, list)):
            raise ValueError(f"Invalid controller_params_file type parsed in the dict {given}")
        files += given if isinstance(given, list) else [given]
    return generate_controllers_spawner_launch_description(list(controller_info_dict), files, extra_spawner_args)


def generate_load_controller_launch_description(
    controller_name: Any,
    controller_type: Any = None,
    controller_params_file: Any = None,
    extra_spawner_args: Sequence[Any] = (),
) -> LaunchDescription:
    """Return a launch description that spawns one controller.

    The order of the arguments is that of Humble.

    Args:
        controller_name: the name of the controller.
        controller_type: the controller's plugin, if its parameters do not set it.
        controller_params_file: the controller's parameter file.
        extra_spawner_args: further arguments of the spawner.
    """
    words = [controller_name, *(("--controller-type", controller_type) if controller_type else ())]
    return generate_controllers_spawner_launch_description(words, [controller_params_file], extra_spawner_args)
