"""Showing one model file, without a launch file."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import LinkwrightError
from linkwright.launch.log.launch_log import LaunchLog
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.description import LaunchDescription
from linkwright.launch.model.descriptions import XacroCall
from linkwright.launch.model.substitution import Substitution
from linkwright.launch.ros import Node, ParameterValue
from linkwright.launch.run import LaunchOptions, run_description
from linkwright.packages import PackageFinder

if TYPE_CHECKING:
    from linkwright.urdf import Robot
    from linkwright.viewer import RvizConfig

_PUBLISH_FREQUENCY = 60.0
"""Hz; at robot_state_publisher's own 20 a dragged slider is seen to lag."""
_FIRST_LINK = re.compile(r"""<link\s[^>]*?\bname\s*=\s*["']([^"'$]+)["']""")


class ModelText(Substitution):
    """The description that a model file expands to.

    Args:
        call: the file and its xacro arguments.
    """

    def __init__(self, call: XacroCall) -> None:
        self.call = call

    def perform(self, context: LaunchContext) -> str:
        """The text.

        Raises:
            DescriptionError: what is wrong with the model.
        """
        descriptions = context.session.descriptions
        text = descriptions.expand(self.call)
        context.remark(self.call, descriptions.warnings_of(self.call))
        return text


class ModelViewer(Node):
    """The viewer with Grid, RobotModel and TF about one model.

    Args:
        call: the model.
    """

    def __init__(self, call: XacroCall) -> None:
        super().__init__(package="rviz2", executable="rviz2", exec_name="viewer", name="viewer")
        self._call = call

    def viewer_config(self, context: LaunchContext) -> Callable[[], RvizConfig]:
        """What makes the configuration, with the model's root link as the fixed frame."""

        def make() -> RvizConfig:
            from linkwright.viewer import RvizConfig, size_of

            robot = _robot(self._call, context)
            frame = robot.root if robot is not None else _first_link(self._call.path)
            size = size_of(robot) if robot is not None else None
            return RvizConfig.for_model(frame, size=size, name=str(self._call.path))

        return make


def run_view(
    model_path: str | Path, arguments: Mapping[str, str] | None = None, options: LaunchOptions | None = None
) -> int:
    """Show a URDF or xacro file, with sliders for its joints, until the user ends it.

    Args:
        model_path: the file.
        arguments: name -> value of the xacro arguments.
        options: how it is run; when left out, its nodes are seen by no other program.

    Returns:
        The exit status, see `linkwright.launch.run_launch`.
    """
    path = Path(model_path).absolute()
    call = XacroCall(path, tuple((arguments or {}).items()))

    def load(_: LaunchLog) -> tuple[LaunchDescription, dict[str, Any]]:
        return describe_view(call), {}

    finder = PackageFinder(start=[path.parent, Path.cwd()])
    return run_description(load, {}, finder, options or LaunchOptions(network=False), path.name)


def describe_view(call: XacroCall) -> LaunchDescription:
    """The nodes that show a model."""
    description = ParameterValue(ModelText(call), value_type=str)
    return LaunchDescription(
        [
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                parameters=[{"robot_description": description, "publish_frequency": _PUBLISH_FREQUENCY}],
            ),
            Node(package="joint_state_publisher_gui", executable="joint_state_publisher_gui"),
            ModelViewer(call),
        ]
    )


def _robot(call: XacroCall, context: LaunchContext) -> Robot | None:
    """The model; None of one that is broken."""
    descriptions = context.session.descriptions
    try:
        return descriptions.library.read(descriptions.expand(call)).robot
    except LinkwrightError:
        return None


def _first_link(path: Path) -> str:
    """The first link that the text of a broken model names, for most the root."""
    try:
        found = _FIRST_LINK.search(path.read_text(encoding="utf-8", errors="replace"))
    except OSError:
        found = None
    return found.group(1) if found else "base_link"
