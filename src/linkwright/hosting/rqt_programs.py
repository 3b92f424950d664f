"""The programs of rqt and image_view: those that open a panel of the page, and those without a panel."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Literal

from linkwright.diagnostics import Phrase, phrase


@dataclass(frozen=True)
class PanelProgram:
    """A program of rqt or image_view, and the panel that it opens.

    Attributes:
        panel: the name of the panel in the page; empty if the page opens as it is.
        display_class: the class of the display that the panel needs; empty if it needs none.
        positional_kind: the meaning of the positional arguments: a topic, fields to plot, a node, recordings, or none.
        ignored_options: the options that are accepted without an effect, each with the number of its values.
        default_topic: the topic that the panel shows without an argument; empty if the user chooses it.
    """

    panel: str
    display_class: str = ""
    positional_kind: Literal["", "topic", "fields", "node", "recordings"] = ""
    ignored_options: Mapping[str, int] = field(default_factory=dict)
    default_topic: str = ""


PANEL_PROGRAMS: Mapping[tuple[str, str], PanelProgram] = MappingProxyType(
    {
        ("image_view", "image_view"): PanelProgram("image", "rviz_default_plugins/Image", default_topic="image"),
        ("rqt", "rqt"): PanelProgram(""),
        ("rqt_bag", "rqt_bag"): PanelProgram("", positional_kind="recordings", ignored_options={"--clock": 0}),
        ("rqt_console", "rqt_console"): PanelProgram("log"),
        ("rqt_controller_manager", "rqt_controller_manager"): PanelProgram("controllers"),
        ("rqt_graph", "rqt_graph"): PanelProgram("graph"),
        ("rqt_gui", "rqt_gui"): PanelProgram(""),
        ("rqt_image_view", "rqt_image_view"): PanelProgram("image", "rviz_default_plugins/Image", "topic"),
        ("rqt_joint_trajectory_controller", "rqt_joint_trajectory_controller"): PanelProgram("trajectories"),
        ("rqt_plot", "rqt_plot"): PanelProgram(
            "plot", positional_kind="fields", ignored_options={"-P": 0, "--pause": 0, "-e": 0, "--empty": 0, "-b": 1}
        ),
        ("rqt_publisher", "rqt_publisher"): PanelProgram("publishers"),
        ("rqt_reconfigure", "rqt_reconfigure"): PanelProgram("parameters", positional_kind="node"),
        ("rqt_robot_steering", "rqt_robot_steering"): PanelProgram("teleop"),
        ("rqt_service_caller", "rqt_service_caller"): PanelProgram("services"),
        ("rqt_tf_tree", "rqt_tf_tree"): PanelProgram("displays", "rviz_default_plugins/TF"),
        ("rqt_topic", "rqt_topic"): PanelProgram("topics"),
    }
)
"""The programs that open a panel, by package and executable."""

RQT_COMMANDS: Mapping[str, str] = MappingProxyType(
    {executable: package for package, executable in PANEL_PROGRAMS if package.startswith("rqt")}
)
"""The packages of the programs that are commands of a shell, by executable. `ros2 run` starts the others."""

MISSING_PROGRAMS: Mapping[str, Phrase] = MappingProxyType(
    {
        "rqt_action": phrase("run `ros2 action list -t` and `ros2 interface show TYPE`"),
        "rqt_msg": phrase("run `ros2 interface show TYPE`"),
        "rqt_robot_monitor": phrase("open the panel Topics of the page, or run `ros2 topic echo /diagnostics_agg`"),
        "rqt_runtime_monitor": phrase("open the panel Topics of the page, or run `ros2 topic echo /diagnostics`"),
        "rqt_shell": phrase("add `--terminal` to the command that opens the page, which then has a terminal"),
        "rqt_srv": phrase("run `ros2 interface show TYPE`"),
    }
)
"""The replacements of programs whose panel the page does not have, by package."""

_OTHER_PROGRAMS = phrase(
    "open Panels in the title bar of the page, which has the panels of rqt_graph, rqt_plot and others"
)


def find_panel_program(package: str | None, executable: str) -> PanelProgram | None:
    """Return the program with a package and an executable, or None if it opens no panel."""
    return None if package is None else PANEL_PROGRAMS.get((package, executable))


def find_program_of_plugin(plugin: str) -> PanelProgram | None:
    """Return the program that shows a plugin of rqt, or None if the page has no such panel.

    Args:
        plugin: a name as ``rqt --standalone`` accepts it: ``rqt_graph``, ``rqt_graph.ros_graph.RosGraph``, or
            ``rqt_image_view/ImageView``.
    """
    package = plugin.partition("/")[0].partition(".")[0]
    return PANEL_PROGRAMS.get((package, package))


def find_replacement(package: str) -> Phrase | None:
    """Return the replacement of a program of rqt that is missing, or None for other packages.

    Args:
        package: the package of the program.
    """
    if not package.startswith("rqt"):
        return None
    return MISSING_PROGRAMS.get(package.partition("/")[0].partition(".")[0], _OTHER_PROGRAMS)
