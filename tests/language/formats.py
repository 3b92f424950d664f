"""Texts of a package with a marked position, and the results for an editor there."""

from __future__ import annotations

from pathlib import Path

from linkwright.diagnostics.translation import localized
from linkwright.language.completion import Completion
from linkwright.language.format import Document, Format
from linkwright.language.formats import format_of
from linkwright.language.includes import real_path
from linkwright.language.workspace import Workspace

MANIFEST = """<package format="3">
  <name>{name}</name><version>0.1.0</version><description>{about}</description>
  <maintainer email="a@example.org">A</maintainer><license>Apache-2.0</license>
  {more}
</package>
"""
SETUP = """from setuptools import setup
setup(name="lamp_nodes", entry_points={"console_scripts": ["blink = lamp_nodes.blink:main"]})
"""
CMAKE = """add_executable(glow src/glow.cpp)
rclcpp_components_register_nodes(lamp "lamp_bringup::Fader")
install(TARGETS glow DESTINATION lib/${PROJECT_NAME})
"""
PARTS_XML = """<launch>
  <arg name="rate" default="10" description="How often it blinks"/>
  <arg name="mode" default="slow"><choice value="slow"/><choice value="fast"/></arg>
</launch>
"""
PARTS_PY = """def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("color", default_value="red", description="Its color", choices=["red", "blue"]),
        *[DeclareLaunchArgument(axis, default_value="0.0") for axis in ["x", "y"]],
    ])
"""


def make_packages(folder: Path) -> Path:
    """Make two packages, and return the folder of the first.

    They have launch files, programs and configurations.
    """
    files = {
        "lamp_bringup/package.xml": MANIFEST.format(
            name="lamp_bringup", about="Starts a lamp.", more="<exec_depend>lamp_nodes</exec_depend>"
        ),
        "lamp_bringup/CMakeLists.txt": CMAKE,
        "lamp_bringup/launch/parts.launch.xml": PARTS_XML,
        "lamp_bringup/launch/parts.launch.py": PARTS_PY,
        "lamp_bringup/config/lamp.yaml": "{}\n",
        "lamp_nodes/package.xml": MANIFEST.format(name="lamp_nodes", about="Nodes of a lamp.", more=""),
        "lamp_nodes/setup.py": SETUP,
        "lamp_nodes/lamp_nodes/__init__.py": "",
        "lamp_nodes/lamp_nodes/blink.py": "def main():\n    pass\n",
    }
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return real_path(folder / "lamp_bringup")


class Place:
    """A position in the text of a file, marked by ``|``.

    Args:
        file: the file, in a package.
        text: the text; the bar is the cursor.
        folder: the folder of the workspace; by default the folder of the packages.
    """

    def __init__(self, file: Path, text: str, folder: Path | None = None) -> None:
        self.offset = text.index("|")
        workspace = Workspace([folder or file.parents[2]])
        text = text.replace("|", "", 1)
        self.document = Document(workspace, {file: text}, file, text)
        file_format = format_of(file)
        assert isinstance(file_format, Format)
        self.format = file_format

    def items(self) -> list[Completion]:
        """Return the completions."""
        return [*self.format.complete(self.document, self.offset)]

    def labels(self) -> list[str]:
        """Return the completions that match the typed text."""
        typed = [(item.label, self.document.text[item.start : self.offset]) for item in self.items()]
        return [label for label, begin in typed if label.startswith(begin)]

    def hover(self) -> str:
        """Return the hover; empty if there is none."""
        explanation = self.format.explain(self.document, self.offset)
        return "" if explanation is None else localized(explanation.text)

    def targets(self) -> list[str]:
        """Return the definitions, each as the name of the file and the text at the location."""
        targets = self.format.define(self.document, self.offset)
        return [
            f"{target.file.name}:{self.document.other(target.file)[target.start : target.end]}" for target in targets
        ]

    def links(self) -> list[str]:
        """Return the names of the files that the text refers to."""
        return [link.file.name for link in self.format.links(self.document)]
