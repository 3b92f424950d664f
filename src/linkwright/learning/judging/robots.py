"""The robots of an exercise, as files that do not depend on the learner's packages.

Packages that Linkwright ships precede those of the current workspace: the workspace of a course contains a package
``my_robot_description`` of the learner, with another robot.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING
from xml.sax.saxutils import escape

from linkwright.descriptions import examine
from linkwright.descriptions.conversion import as_sdf
from linkwright.diagnostics import LinkwrightError
from linkwright.packages import PackageFinder
from linkwright.packages.finder import find_shipped_packages
from linkwright.sdf.writer import save

if TYPE_CHECKING:
    from linkwright.learning.judging.scene import OtherRobot


def write_robot(address: str, arguments: Mapping[str, object], exercise_folder: Path, folder: Path) -> Path:
    """Write the description of an exercise's robot into a folder, and return the file.

    Args:
        address: the URDF, xacro or SDF file of the robot, or its ``package://`` URI.
        arguments: values for the ``<xacro:arg>`` elements.
        exercise_folder: the folder of the exercise, from which relative paths start.
        folder: the folder for the file. A file in SDF is not copied.

    Raises:
        LinkwrightError: there is no such file, or it has errors.
        OSError: the file cannot be written.
    """
    finder = create_finder(exercise_folder)
    path = finder.resolve(address, exercise_folder)
    if path.suffix == ".sdf":
        return path
    texts = {name: str(value).lower() if isinstance(value, bool) else str(value) for name, value in arguments.items()}
    description = examine(str(path), arguments=texts, packages=finder)
    if description.robot is None:
        raise LinkwrightError(*description.diagnostics)
    file = folder / f"{path.stem}.urdf"
    file.write_text(description.text, encoding="utf-8")
    return file


def include_robot(robot: OtherRobot, exercise_folder: Path, folder: Path) -> str:
    """Write the model of another robot, and return the ``<include>`` that adds it to a world.

    Args:
        robot: the robot that the scene adds.
        exercise_folder: the folder of the exercise, from which relative paths start.
        folder: the folder for the file.

    Raises:
        LinkwrightError: there is no such file, or it has errors.
        OSError: the file cannot be written.
    """
    finder = create_finder(exercise_folder)
    path = finder.resolve(robot.file, exercise_folder)
    converted = as_sdf(path, finder, lump_fixed_joints=False, folder=folder)
    if converted.sdf is None or not converted.sdf.models:
        raise LinkwrightError(*converted.diagnostics)
    model = replace(converted.sdf.models[0], name=robot.name)
    file = folder / f"{robot.name}.sdf"
    file.write_text(save(replace(converted.sdf, models=(model,))), encoding="utf-8")
    x, y, yaw = robot.pose
    return f"<include><uri>{escape(file.as_uri())}</uri><pose>{x:.5f} {y:.5f} 0 0 0 {yaw:.5f}</pose></include>"


def create_finder(exercise_folder: Path) -> PackageFinder:
    """Return a finder of packages that prefers those that Linkwright ships."""
    return PackageFinder(start=[exercise_folder], extra=find_shipped_packages())
