"""Hints on replacements for ROS programs that are not available.

For an unknown command, shells run ``python -m linkwright.shell.instead NAME``, which prints such a hint.
"""

from __future__ import annotations

import sys

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, did_you_mean, phrase, print_diagnostics
from linkwright.hosting.rqt_programs import MISSING_PROGRAMS

_PAGE_HINT = phrase(
    "use a panel of the page: run `linkwright launch` or `linkwright view`, and open Panels in its title bar"
)
_COLCON_HINT = phrase("this is a ROS 1 command; build with `colcon build`")
_ROS2_HINT = phrase(
    "this is a ROS 1 command; the commands of ROS 2 begin with `ros2`, as in `ros2 launch` and `ros2 topic list`"
)
_SIMULATION_HINT = phrase(
    "run a launch file, which starts Linkwright's simulation instead: `ros2 launch "
    "gazebo_ros gazebo.launch.py world:=FILE`"
)

HINTS: dict[str, Phrase] = {
    "rosdep": phrase(
        "Linkwright needs no system packages: put the sources of a missing package into the "
        "workspace's src folder, and install Python modules with pip"
    ),
    **MISSING_PROGRAMS,
    "rviz": phrase("run `rviz2 -d FILE.rviz`, or `linkwright view FILE` for one robot"),
    "plotjuggler": _PAGE_HINT,
    "gazebo": _SIMULATION_HINT,
    "gzserver": _SIMULATION_HINT,
    "gzclient": _SIMULATION_HINT,
    "gz": _SIMULATION_HINT,
    "ign": _SIMULATION_HINT,
    "catkin": _COLCON_HINT,
    "catkin_make": _COLCON_HINT,
    "roscore": phrase("this is a ROS 1 command; in ROS 2, nodes find each other without a master"),
    "roslaunch": _ROS2_HINT,
    "rosrun": _ROS2_HINT,
    "rostopic": _ROS2_HINT,
    "rosnode": _ROS2_HINT,
    "rosparam": _ROS2_HINT,
    "rosservice": _ROS2_HINT,
    "rosbag": _ROS2_HINT,
}
"""The hints on what to use instead, by the name of the program."""


def unknown_command_error(
    name: str, existing_commands: tuple[str, ...], default_hint: Phrase | None = None
) -> LinkwrightError:
    """Return the error SHELL101 for a command that does not exist, with a hint.

    Args:
        name: the name of the command that the user entered.
        existing_commands: the names of existing commands, for suggestions.
        default_hint: the hint if there is neither a replacement nor a suggestion; None for no hint.
    """
    hint = HINTS.get(name) or did_you_mean(name, existing_commands) or default_hint
    return LinkwrightError(
        Diagnostic("SHELL101", phrase("command '{command}' does not exist", command=name), hint=hint)
    )


def main(name: str) -> int:
    """Print the hint for an unknown command.

    Return the exit status with which shells report such a command.
    """
    print_diagnostics(unknown_command_error(name, ()).diagnostics, sys.stderr)
    return 127


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1]))
