"""The names of the files that an editor sends to the language server.

The configurations of editors are generated from them.
"""

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
"""Patterns of file names, by the language of the text. A pattern with a slash matches the path."""
