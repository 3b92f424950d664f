"""The commands of ROS 2 as small programs, in a folder that is appended to the search path."""

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
from linkwright.hosting.rqt_programs import RQT_COMMANDS
from linkwright.messages.distribution import ASSUMED_DISTRIBUTION_VARIABLE
from linkwright.packages.ament import ROS_VARIABLES
from linkwright.process.own_programs import PROGRAMS_MODULE

PROGRAMS = {
    "ros2": (PROGRAMS_MODULE, "ros2"),
    "xacro": (PROGRAMS_MODULE, "xacro"),
    "check_urdf": (PROGRAMS_MODULE, "check_urdf"),
    "urdf_to_graphviz": (PROGRAMS_MODULE, "urdf_to_graphviz"),
    "urdf_to_graphiz": (PROGRAMS_MODULE, "urdf_to_graphviz"),
    "rviz2": (PROGRAMS_MODULE, "rviz2"),
    **{name: (PROGRAMS_MODULE, name) for name in ("gz", "ign", "gazebo", "gzserver", "gzclient")},
    **{name: (PROGRAMS_MODULE, name) for name in RQT_COMMANDS},
    "launch_test": (PROGRAMS_MODULE, "launch_test"),
    "colcon": (PROGRAMS_MODULE, "colcon"),
    "linkwright": ("linkwright", None),
}
"""The Python module of each command, with the first argument of the module or None.

For years, urdfdom spelled a command ``urdf_to_graphiz``. It still installs this name next to the correct one.
"""


def write_programs(folder: Path, python: str = sys.executable) -> None:
    """Write a small program for each command to a folder.

    Args:
        folder: an existing folder.
        python: the path of an interpreter that can import Linkwright and runs the programs.
    """
    for name, (module, argument) in PROGRAMS.items():
        command = [python, "-m", module, *([argument] if argument else [])]
        if sys.platform == "win32":
            (folder / f"{name}.cmd").write_text(f"@echo off\n{subprocess.list2cmdline(command)} %*\n", encoding="utf-8")
        else:
            program = folder / name
            program.write_text(f'#!/bin/sh\nexec {shlex.join(command)} "$@"\n', encoding="utf-8")
            program.chmod(0o755)


def append_programs_to_path(environment: MutableMapping[str, str]) -> None:
    """Append the folder of Linkwright's programs to the search path, for launch files.

    The programs are written to the cache folder. If that is not possible, the search path does not change.
    """
    digest = hashlib.sha256(repr((sys.executable, sorted(PROGRAMS.items()))).encode()).hexdigest()[:16]
    folder = cache_folder() / "programs" / digest
    with suppress(OSError):
        if not all((folder / name).exists() or (folder / f"{name}.cmd").exists() for name in PROGRAMS):
            folder.mkdir(parents=True, exist_ok=True)
            write_programs(folder)
        folders = environment.get("PATH", os.defpath).split(os.pathsep)
        if str(folder) not in folders:
            environment["PATH"] = os.pathsep.join([*folders, str(folder)])


def set_ros_variables(environment: MutableMapping[str, str]) -> None:
    """Set the environment variables of ROS 2 that launch files expect, except those that are set.

    The values are those of ROS 2 Humble. Launch files append to ``GZ_SIM_RESOURCE_PATH`` and ``LD_LIBRARY_PATH``
    without checking whether they are set.
    """
    if "ROS_DISTRO" not in environment:
        environment[ASSUMED_DISTRIBUTION_VARIABLE] = "1"
    for name, value in {**ROS_VARIABLES, "GZ_SIM_RESOURCE_PATH": "", "LD_LIBRARY_PATH": ""}.items():
        environment.setdefault(name, value)
