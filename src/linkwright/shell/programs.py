"""The commands of ROS 2 as small programs in a folder of their own, for the end of the search path."""

from __future__ import annotations

import shlex
import subprocess
import sys
from pathlib import Path

PROGRAMS = {
    "ros2": ("linkwright.cli.tools", "ros2"),
    "xacro": ("linkwright.cli.tools", "xacro"),
    "check_urdf": ("linkwright.cli.tools", "check_urdf"),
    "urdf_to_graphviz": ("linkwright.cli.tools", "urdf_to_graphviz"),
    "urdf_to_graphiz": ("linkwright.cli.tools", "urdf_to_graphviz"),
    "rviz2": ("linkwright.cli.tools", "rviz2"),
    "colcon": ("linkwright.cli.tools", "colcon"),
    "linkwright": ("linkwright", None),
}
"""Name of the command -> the Python module that it is, and the first word the module is given.

``urdf_to_graphiz`` is how urdfdom spelt it for years, and still installs beside the right spelling.
"""


def write_programs(folder: Path, python: str = sys.executable) -> None:
    """Write one program for each command into a folder.

    Args:
        folder: an existing folder.
        python: the interpreter that runs them, one that can import Linkwright.
    """
    for name, (module, word) in PROGRAMS.items():
        words = [python, "-m", module, *([word] if word else [])]
        if sys.platform == "win32":
            (folder / f"{name}.cmd").write_text(f"@echo off\n{subprocess.list2cmdline(words)} %*\n", encoding="utf-8")
        else:
            program = folder / name
            program.write_text(f'#!/bin/sh\nexec {shlex.join(words)} "$@"\n', encoding="utf-8")
            program.chmod(0o755)
