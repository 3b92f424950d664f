"""The installed language servers for Python files, and their environment."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable, Sequence
from importlib.machinery import PathFinder
from pathlib import Path
from typing import NamedTuple

from linkwright.packages import PackageFinder
from linkwright.packages.programs.workspace_environment import make_workspace_environment
from linkwright.standins import modules, process

_PYTHON_PATH = "PYTHONPATH"
_STUBS = Path(process.standin_path()).with_name("stubs")
"""The type stubs of the stand-ins and of the messages that come with Linkwright."""


class Program(NamedTuple):
    """A language server for Python files.

    Attributes:
        name: its name, which is also the source of its findings, apart from the case of letters.
        command: the command that starts it.
    """

    name: str
    command: tuple[str, ...]


def installed_programs() -> list[Program]:
    """Return the installed language servers for Python files.

    These are ``ty`` for types and completion, and ``ruff`` for rules and formatting.

    Programs in the interpreter's folder precede programs on the search path.
    """
    programs = ((name, _find_program(name)) for name in ("ty", "ruff"))
    return [Program(name, (str(path), "server")) for name, path in programs if path is not None]


def _find_program(name: str) -> Path | None:
    """Return the path of a program, or None if it is not installed.

    A program in the current folder is not used, because it may be malicious.
    """
    folders = [Path(sys.executable).parent, *map(Path, os.get_exec_path())]
    candidates = (folder / (f"{name}.exe" if os.name == "nt" else name) for folder in folders if folder.is_absolute())
    return next((candidate for candidate in candidates if candidate.is_file() and os.access(candidate, os.X_OK)), None)


def program_environment(folders: Sequence[Path], workspace_stubs: Path) -> dict[str, str]:
    """Return an environment that lets a language server find the user's modules.

    These are the Python packages of the workspace and, unless ROS 2 is installed, the stand-ins and messages.

    Args:
        folders: the folders of the workspace.
        workspace_stubs: the folder with the type stubs of the messages of the workspace.
    """
    environment = process.create_environment(make_workspace_environment(PackageFinder(start=list(folders)), os.environ))
    entries = [entry for entry in environment[_PYTHON_PATH].split(os.pathsep) if entry != process.standin_path()]
    interpreter = process.python_command(())[0]
    is_own = interpreter == sys.executable
    if not _has_ros(entries):
        entries += [str(_STUBS), str(workspace_stubs)]
        if not is_own:  # The stubs refer to classes of Linkwright.
            entries += environment["LINKWRIGHT_SITE"].split(os.pathsep)
    environment[_PYTHON_PATH] = os.pathsep.join(entries)
    if is_own and sys.prefix != sys.base_prefix:
        environment["VIRTUAL_ENV"] = sys.prefix
    return environment


def _has_ros(entries: Iterable[str]) -> bool:
    """Return whether an rclpy that is not the stand-in can be imported."""
    spec = PathFinder.find_spec("rclpy", [*entries, *(entry for entry in sys.path if entry != modules.FOLDER)])
    return spec is not None and spec.origin is not None
