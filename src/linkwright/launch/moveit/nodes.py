"""Parts of MoveIt's launch files (``moveit_configs_utils.launch_utils``)."""

from __future__ import annotations

from typing import Any

from linkwright.launch.model.actions import DeclareLaunchArgument
from linkwright.launch.model.conditions import IfCondition, UnlessCondition
from linkwright.launch.model.description import LaunchDescription
from linkwright.launch.model.substitutions import LaunchConfiguration
from linkwright.launch.ros import Node


class DeclareBooleanLaunchArg(DeclareLaunchArgument):
    """Declares an argument that is true or false.

    Args:
        name: the argument's name.
        default_value: the value where none is given.
        description: what ``--show-args`` says of it.
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
    """Add a node that an argument has run inside of gdb.

    Args:
        ld: the description.
        package: the node's package.
        executable: its executable.
        condition_name: the argument that decides.
        commands_file: commands for gdb.
        extra_debug_args: further arguments for the node in gdb.
        kwargs: see `Node`.
    """
    debug = LaunchConfiguration(condition_name)
    ld.add_action(Node(package=package, executable=executable, condition=UnlessCondition(debug), **kwargs))
    if "arguments" in kwargs:
        kwargs["arguments"] = [*kwargs["arguments"], *(extra_debug_args or ())]
    commands = f"-x {commands_file} " if commands_file else ""
    prefix = [f"gdb {commands}--ex run --args"]
    ld.add_action(Node(package=package, executable=executable, condition=IfCondition(debug), prefix=prefix, **kwargs))
