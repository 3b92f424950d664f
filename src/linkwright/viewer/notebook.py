"""Shows a robot in a notebook cell, with a slider for each joint.

The cell contains, in an iframe, the page that ``linkwright export`` writes. The page needs no server and no network, so
it also works in saved notebooks, and wherever notebooks run: Jupyter, VS Code, marimo (decision 0112).
"""

from __future__ import annotations

from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from html import escape
from pathlib import Path

from linkwright.descriptions import DescriptionLibrary, Packages, examine
from linkwright.diagnostics import Diagnostic, LinkwrightError
from linkwright.diagnostics.diagnostic import is_text
from linkwright.packages import PackageFinder
from linkwright.panels.export.html import write_html
from linkwright.panels.export.snapshot import no_robot_error
from linkwright.urdf import Robot, save
from linkwright.viewer.model_snapshot import take_model_snapshot

_IFRAME_TEMPLATE = (
    '<iframe title="{title}" srcdoc="{page}" style="width: 100%; height: {height}px; border: 0" '
    'allow="fullscreen"></iframe>'
)


@dataclass(frozen=True)
class RobotCell:
    """The output of a notebook cell that shows a robot.

    Attributes:
        name: the robot's name.
        page: the HTML document that shows the robot.
        height: the height of the cell, in pixels.
        diagnostics: the findings about the description.
    """

    name: str
    page: str = field(repr=False)
    height: int
    diagnostics: tuple[Diagnostic, ...]

    def _repr_html_(self) -> str:
        return _IFRAME_TEMPLATE.format(title=escape(self.name), page=escape(self.page), height=self.height)


def show(
    robot: str | Path | Robot,
    *,
    arguments: Mapping[str, str] | None = None,
    packages: Packages = None,
    height: int = 480,
) -> RobotCell:
    """Return a robot as the output of a notebook cell.

    Call this in the last line of the cell.

    Args:
        robot: the path of a URDF or xacro file, the text of a description, or a `Robot`.
        arguments: the values of xacro arguments by name; None to use their defaults.
        packages: the share folders of packages by package name, or a finder.
        height: the height of the cell, in pixels.

    Raises:
        LinkwrightError: the description cannot be read or expanded, or has no robot.
    """
    library = DescriptionLibrary()
    source = save(robot) if isinstance(robot, Robot) else robot
    search_folders = [Path.cwd()] if is_text(source) else [Path(source).absolute().parent, Path.cwd()]
    finder = packages if isinstance(packages, PackageFinder) else PackageFinder(start=search_folders, extra=packages)
    description = examine(source, arguments=arguments, packages=finder)
    described_robot = description.robot
    if described_robot is None or not described_robot.root:
        raise LinkwrightError(*description.diagnostics) if description.diagnostics else no_robot_error()
    text = library.store(description)
    with ThreadPoolExecutor(1) as thread:  # the main thread of a notebook already runs an event loop
        snapshot = thread.submit(take_model_snapshot, text, described_robot, library, finder).result()
    page = write_html(snapshot).decode("utf-8")
    return RobotCell(described_robot.name, page, height, (*description.diagnostics, *snapshot.problems))
