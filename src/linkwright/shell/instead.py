"""What to use here in the place of programs of ROS that users type and that are not here.

``python -m linkwright.shell.instead NAME`` says it; shells run that for a command that they do not find.
"""

from __future__ import annotations

import sys

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, did_you_mean, phrase, print_diagnostics

_PAGE = phrase(
    "the panels of the page show that: `linkwright launch` or `linkwright view`, then Panels in its title bar"
)
_COLCON = phrase("that was ROS 1; build with `colcon build`")
_ROS2 = phrase("that was ROS 1; the commands of ROS 2 begin with `ros2`, as in `ros2 launch` and `ros2 topic list`")
_SIMULATION = phrase(
    "launch files that start it run here with a simulation of Linkwright's own: "
    "`ros2 launch gazebo_ros gazebo.launch.py world:=FILE`"
)

INSTEAD: dict[str, Phrase] = {
    "rosdep": phrase(
        "packages need nothing of the system here: put the sources of one that is missing into the workspace's src "
        "folder, and install Python modules with pip"
    ),
    "rqt": _PAGE,
    "rqt_console": _PAGE,
    "rqt_graph": phrase("the page's panel Node graph shows it; in the terminal, `ros2 node info NODE`"),
    "rqt_plot": _PAGE,
    "rqt_reconfigure": phrase(
        "the page's panel Parameters does that; in the terminal, `ros2 param set NODE NAME VALUE`"
    ),
    "rviz": phrase("it is called rviz2: `rviz2 -d FILE.rviz`, or `linkwright view FILE` for one robot"),
    "plotjuggler": _PAGE,
    "gazebo": _SIMULATION,
    "gzserver": _SIMULATION,
    "gzclient": _SIMULATION,
    "gz": _SIMULATION,
    "ign": _SIMULATION,
    "catkin": _COLCON,
    "catkin_make": _COLCON,
    "roscore": phrase("that was ROS 1; nodes of ROS 2 find each other without it"),
    "roslaunch": _ROS2,
    "rosrun": _ROS2,
    "rostopic": _ROS2,
    "rosnode": _ROS2,
    "rosparam": _ROS2,
    "rosservice": _ROS2,
    "rosbag": _ROS2,
}
"""Name of a program -> what to use."""


def no_such_command(name: str, others: tuple[str, ...], otherwise: Phrase | None = None) -> LinkwrightError:
    """SHELL101: there is no such command here, with what to use.

    Args:
        name: as it was typed.
        others: commands that may have been meant.
        otherwise: the hint for one that nothing is known of.
    """
    hint = INSTEAD.get(name) or did_you_mean(name, others) or otherwise
    return LinkwrightError(Diagnostic("SHELL101", phrase("there is no command '{words}'", words=name), hint=hint))


def main(name: str) -> int:
    """Say what to use; the exit status is the one that shells have for a command that they do not find."""
    print_diagnostics(no_such_command(name, ()).diagnostics, sys.stderr)
    return 127


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1]))
