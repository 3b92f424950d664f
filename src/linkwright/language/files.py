"""The names of the files that an editor sends to the language server, for the configurations of editors."""

from __future__ import annotations

from collections.abc import Mapping

PATTERNS: Mapping[str, tuple[str, ...]] = {
    "xml": (
        "*.xacro",
        "*.urdf",
        "*.sdf",
        "*.world",
        "*.srdf",
        "*.launch",
        "*launch.xml",
        "package.xml",
        "model.config",
    ),
    "python": ("*launch.py", "*/launch/*.py", "setup.py"),
    "yaml": ("*.yaml", "*.yml", "*.rviz"),
    "interface": ("*.msg", "*.srv", "*.action"),
    "cmake": ("CMakeLists.txt",),
}
"""Patterns of file names, by the language of the text. One with a slash is a pattern of the path.

The server answers in all of these files. Those with the name of a build file alone get findings, links and fixes of
their package.
"""
