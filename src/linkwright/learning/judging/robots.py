"""The robots of an exercise, as files that do not depend on the learner's packages."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from linkwright.descriptions import examine
from linkwright.diagnostics import LinkwrightError
from linkwright.packages import PackageFinder
from linkwright.packages.finder import shipped_packages


def write_robot(address: str, arguments: Mapping[str, object], exercise_folder: Path, folder: Path) -> Path:
    """Write the description of an exercise's robot into a folder, and return the file.

    Packages that Linkwright ships precede those of the current workspace: the workspace of a course contains a package
    ``my_robot_description`` of the learner, with another robot.

    Args:
        address: the URDF, xacro or SDF file of the robot, or its ``package://`` URI.
        arguments: values for the ``<xacro:arg>`` elements.
        exercise_folder: the folder of the exercise, from which relative paths start.
        folder: the folder for the file. A file in SDF is not copied.

    Raises:
        LinkwrightError: there is no such file, or it has errors.
        OSError: the file cannot be written.
    """
    finder = PackageFinder(start=[exercise_folder], extra=shipped_packages())
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
