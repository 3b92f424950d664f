"""Convert the command lines of Gazebo's programs to parameters of substitute nodes.

Of the many options of `gazebo`, `gzserver` and `gz sim`, only the world, the paused start, the random seed, the ROS
arguments and the start in ``--gui-config`` have an effect here. The node's parameters are ``world``, ``pause`` and
``seed``, and ``gui`` for a server with a window. The executable is ``gzclient`` for a window without a server.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path, PurePath
from typing import Any

from linkwright.nodes.node_command import NodeCommand

_CLASSIC_VALUE_OPTIONS = """-s --server-plugin -g --gui-plugin -e --physics -p --play -o --profile -P --property --iters
--seed --record_path --record_encoding --record_period --record_filter --initial_sim_time --gui-client-plugin"""
"""Options of gazebo and gzserver that take the next argument as their value."""
_GZ_VALUE_OPTIONS = """-z --iterations --gui-config --physics-engine --render-engine --render-engine-server
--render-engine-gui --seed --record-path --record-topic --playback --network-role --network-secondaries
--initial-sim-time --update-rate"""
"""Options of gz sim that take the next argument as their value."""
_GZ_VERBOSITY = ("-v", "--verbose")
"""Options of gz sim that take the next argument as their value if it is a number."""
_ROS_ARGUMENTS = "--ros-args"
_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_WORLD_CONTROL = re.compile(r"<plugin\s[^>]*\bfilename\s*=\s*[\"']WorldControl[\"'].*?</plugin>", re.DOTALL)
_UNPAUSED_START = re.compile(r"<start_paused>\s*(false|0)\s*</start_paused>", re.IGNORECASE)


def simulator_command(command: Sequence[str]) -> NodeCommand | None:
    """Parse the command line of one of Gazebo's programs, or return None for other programs."""
    program, *arguments = command
    name = PurePath(program).name
    if name in ("gazebo", "gzserver"):
        return parse_classic_server_command(arguments, window=name == "gazebo")
    if name == "gzclient":
        return NodeCommand("gazebo_ros", "gzclient")
    if (name, arguments[:1]) in (("gz", ["sim"]), ("ign", ["gazebo"]), ("ign", ["sim"])):
        return parse_gz_server_command(arguments[1:])
    return None


def parse_classic_server_command(arguments: Sequence[str], *, window: bool = False) -> NodeCommand:
    """Parse the arguments of ``gzserver``, or of ``gazebo``, which also opens a window."""
    gazebo_arguments, ros_arguments = _split_ros_arguments(arguments)
    options, positional = _parse_options(gazebo_arguments, _CLASSIC_VALUE_OPTIONS.split())
    parameters = _read_seed(options) | ({"gui": True} if window else {})
    if positional and positional[0]:
        parameters["world"] = positional[0]
    if "-u" in options or "--pause" in options:
        parameters["pause"] = True
    return NodeCommand("gazebo_ros", "gzserver", parameters, ros_arguments)


def parse_gz_server_command(arguments: Sequence[str]) -> NodeCommand:
    """Parse the arguments of ``gz sim``.

    Without ``-r``, the simulation starts paused, unless the configuration of the window starts it.
    """
    gazebo_arguments, ros_arguments = _split_ros_arguments(arguments)
    options, positional = _parse_options(gazebo_arguments, _GZ_VALUE_OPTIONS.split())
    if "-g" in options:
        return NodeCommand("ros_gz_sim", "gzclient")
    has_window = "-s" not in options
    is_started = "-r" in options or (has_window and _is_started_by_window(options.get("--gui-config", "")))
    parameters = _read_seed(options) | {"pause": not is_started, "gui": has_window}
    if any(positional):
        parameters["world"] = next(filter(None, positional))
    return NodeCommand("ros_gz_sim", "gzserver", parameters, ros_arguments)


def _is_started_by_window(config_file: str) -> bool:
    """Return whether the panel for the time of Gazebo's window starts the simulation.

    The file is a list of elements, not a single XML element.
    """
    try:
        text = _COMMENT.sub("", Path(config_file).read_text(encoding="utf-8", errors="replace"))
    except OSError:
        return False
    return any(_UNPAUSED_START.search(panel) for panel in _WORLD_CONTROL.findall(text))


def _split_ros_arguments(arguments: Sequence[str]) -> tuple[list[str], list[str]]:
    """Split a command line into Gazebo's arguments and the ROS arguments."""
    start = arguments.index(_ROS_ARGUMENTS) if _ROS_ARGUMENTS in arguments else len(arguments)
    return list(arguments[:start]), list(arguments[start:])


def _parse_options(arguments: list[str], value_options: Sequence[str]) -> tuple[dict[str, str], list[str]]:
    """Split arguments into options with their values and positional arguments.

    A flag has an empty value. Arguments that consist only of spaces are dropped, but empty ones are kept: a launch file
    without a world passes an empty argument to ``gzserver``. This argument takes the place of the world, so the
    arguments after it do not name a world.
    """
    options, positional = {}, []
    remaining = [argument for argument in arguments if argument.strip() or not argument]
    while remaining:
        argument = remaining.pop(0)
        name, equals, value = argument.partition("=")
        if not argument.startswith("-"):
            positional.append(argument)
        elif argument in _GZ_VERBOSITY and remaining and remaining[0].isdigit():
            options[name] = remaining.pop(0)
        elif equals or name not in value_options or not remaining:
            options[name] = value
        else:
            options[name] = remaining.pop(0)
    return options, positional


def _read_seed(options: Mapping[str, str]) -> dict[str, Any]:
    seed = options.get("--seed", "")
    return {"seed": int(seed)} if seed.isdigit() else {}
