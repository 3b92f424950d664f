"""The commands of ROS 2 as small programs in a folder that is appended to the search path."""

from __future__ import annotations

import hashlib
import os
import shlex
import subprocess
import sys
from collections.abc import MutableMapping
from contextlib import suppress
from pathlib import Path

from linkwright.files.user_folders import cache_folder
from linkwright.messages.distribution import ASSUMED
from linkwright.packages.ament import ROS_VARIABLES

PROGRAMS = {
    "ros2": ("linkwright.cli.tools", "ros2"),
    "xacro": ("linkwright.cli.tools", "xacro"),
    "check_urdf": ("linkwright.cli.tools", "check_urdf"),
    "urdf_to_graphviz": ("linkwright.cli.tools", "urdf_to_graphviz"),
    "urdf_to_graphiz": ("linkwright.cli.tools", "urdf_to_graphviz"),
    "rviz2": ("linkwright.cli.tools", "rviz2"),
    "launch_test": ("linkwright.cli.tools", "launch_test"),
    "colcon": ("linkwright.cli.tools", "colcon"),
    "linkwright": ("linkwright", None),
}
"""Name of the command -> its Python module, and the first argument of the module.

``urdf_to_graphiz`` was urdfdom's spelling for years, which it still installs besides the right one.
"""


def write_programs(folder: Path, python: str = sys.executable) -> None:
    """Write a program for each command to a folder.

    Args:
        folder: an existing folder.
        python: the interpreter that runs the programs, which must be able to import Linkwright.
    """
    for name, (module, word) in PROGRAMS.items():
        words = [python, "-m", module, *([word] if word else [])]
        if sys.platform == "win32":
            (folder / f"{name}.cmd").write_text(f"@echo off\n{subprocess.list2cmdline(words)} %*\n", encoding="utf-8")
        else:
            program = folder / name
            program.write_text(f'#!/bin/sh\nexec {shlex.join(words)} "$@"\n', encoding="utf-8")
            program.chmod(0o755)


def offer_programs(environment: MutableMapping[str, str]) -> None:
    """Append the folder of our programs to the search path, for commands in launch files.

    The programs are written to the cache folder. If that folder is not writable, the search path is not changed.
    """
    key = hashlib.sha256(repr((sys.executable, sorted(PROGRAMS.items()))).encode()).hexdigest()[:16]
    folder = cache_folder() / "programs" / key
    with suppress(OSError):
        if not all((folder / name).exists() or (folder / f"{name}.cmd").exists() for name in PROGRAMS):
            folder.mkdir(parents=True, exist_ok=True)
            write_programs(folder)
        parts = environment.get("PATH", os.defpath).split(os.pathsep)
        if str(folder) not in parts:
            environment["PATH"] = os.pathsep.join([*parts, str(folder)])


def offer_ros_variables(environment: MutableMapping[str, str]) -> None:
    """Set the variables of a sourced ROS 2 that launch files expect, unless ROS 2 is sourced.

    The values are those of Humble.
    """
    if "ROS_DISTRO" not in environment:
        environment.update(ROS_VARIABLES)
        environment[ASSUMED] = "1"
        for name in (
            "GZ_SIM_RESOURCE_PATH",
            "LD_LIBRARY_PATH",
        ):  # Launch files append to these variables without checking that they are set.
            environment.setdefault(name, "")
