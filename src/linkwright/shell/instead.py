"""Hints about replacements for ROS programs that are not available.

Shells run ``python -m linkwright.shell.instead NAME`` for an unknown command to print such a hint.
"""

from __future__ import annotations

import sys

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, did_you_mean, phrase, print_diagnostics

_PAGE = phrase(
    "the page has panels for that: run `linkwright launch` or `linkwright view`, then open Panels in its title bar"
)
_COLCON = phrase("this is a ROS 1 command; build with `colcon build`")
_ROS2 = phrase(
    "this is a ROS 1 command; the commands of ROS 2 begin with `ros2`, as in `ros2 launch` and `ros2 topic list`"
)
_SIMULATION = phrase(
    "run a launch file that starts it, which uses Linkwright's simulation: `ros2 launch "
    "gazebo_ros gazebo.launch.py world:=FILE`"
)

INSTEAD: dict[str, Phrase] = {
    "rosdep": phrase(
        "Linkwright needs no system packages: put the sources of a missing package into the "
        "workspace's src folder, and install Python modules with pip"
    ),
    "rqt": _PAGE,
    "rqt_console": _PAGE,
    "rqt_graph": phrase("open the page's panel Node graph; in the terminal, run `ros2 node info NODE`"),
    "rqt_plot": _PAGE,
    "rqt_reconfigure": phrase(
        "open the page's panel Parameters; in the terminal, run `ros2 param set NODE NAME VALUE`"
    ),
    "rviz": phrase("run `rviz2 -d FILE.rviz`, or `linkwright view FILE` for one robot"),
    "plotjuggler": _PAGE,
    "gazebo": _SIMULATION,
    "gzserver": _SIMULATION,
    "gzclient": _SIMULATION,
    "gz": _SIMULATION,
    "ign": _SIMULATION,
    "catkin": _COLCON,
    "catkin_make": _COLCON,
    "roscore": phrase("this is a ROS 1 command; nodes of ROS 2 find each other without it"),
    "roslaunch": _ROS2,
    "rosrun": _ROS2,
    "rostopic": _ROS2,
    "rosnode": _ROS2,
    "rosparam": _ROS2,
    "rosservice": _ROS2,
    "rosbag": _ROS2,
}
"""Name of a program -> hint."""


def no_such_command(name: str, others: tuple[str, ...], otherwise: Phrase | None = None) -> LinkwrightError:
    """Return the error SHELL101 for an unknown command, with a hint.

    Args:
        name: the command that the user typed.
        others: existing commands, for suggestions.
        otherwise: the hint if there is neither a replacement nor a suggestion.
    """
    hint = INSTEAD.get(name) or did_you_mean(name, others) or otherwise
    return LinkwrightError(Diagnostic("SHELL101", phrase("there is no command '{words}'", words=name), hint=hint))


def main(name: str) -> int:
    """Print the hint for an unknown command, and return the exit status that shells use."""
    print_diagnostics(no_such_command(name, ()).diagnostics, sys.stderr)
    return 127


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1]))
