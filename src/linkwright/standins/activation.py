"""Activate the stand-ins, which makes them importable as ``launch``, ``rclpy`` and so on."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Mapping, Sequence
from importlib.machinery import ModuleSpec
from pathlib import Path
from types import ModuleType

from linkwright.standins import modules

LAUNCH_MODULES = ("launch", "launch_ros", "ament_index_python", "xacro")
"""The modules that launch files import.

When Linkwright runs a launch file, these modules are always stand-ins, even if ROS is sourced, because the modules of
ROS need the launcher of ROS.
"""


def activate() -> None:
    """Make the modules for launch files importable.

    Repeated calls have no further effect.

    The folder of the tables is last on ``sys.path``. An installed module therefore precedes a stand-in, unless its
    package is in `LAUNCH_MODULES`. The stand-ins are also importable in the processes that launch files start.
    """
    modules.install()
    if modules.FOLDER not in sys.path:
        sys.path.append(modules.FOLDER)
    if not any(isinstance(finder, _LazyInterfaceFinder) for finder in sys.meta_path):
        sys.meta_path += [_WorkspaceModuleFinder(), _LazyInterfaceFinder()]
    _register_for_processes()
    missing = [name for name in LAUNCH_MODULES if not modules.is_stand_in(sys.modules.get(name))]
    if not missing:
        return
    for name in [name for name in sys.modules if name.partition(".")[0] in missing]:
        del sys.modules[name]
    sys.path.insert(0, modules.FOLDER)
    try:
        for name in missing:
            importlib.import_module(name)
    finally:
        sys.path.remove(modules.FOLDER)


class _LazyInterfaceFinder:
    """A finder that installs the interface finders on the first import of an interface module.

    The finder is last on ``sys.meta_path``. It does not derive from the abstract base class, which is slow to import.
    """

    def find_spec(
        self,
        fullname: str,
        path: Sequence[str] | None = None,
        target: ModuleType | None = None,
    ) -> ModuleSpec | None:
        """Return the spec of an interface module, or None for another module."""
        if not _may_contain_interfaces(fullname):
            return None
        from linkwright.standins import interfaces

        if any(isinstance(finder, interfaces.InterfaceFinder) for finder in sys.meta_path):
            return None  # the import system calls that finder next
        interfaces.install()
        return interfaces.find_spec(fullname)


class _WorkspaceModuleFinder:
    """A finder of the Python modules of workspace packages, for users' launch files."""

    def find_spec(
        self,
        fullname: str,
        path: Sequence[str] | None = None,
        target: ModuleType | None = None,
    ) -> ModuleSpec | None:
        """Return the spec of a workspace module that a user's file imports, or None."""
        from linkwright.packages.active import active_finder

        finder = active_finder()
        importing_file = None if finder is None or path is not None else _find_importing_file()
        if finder is None or importing_file is None:
            return None
        from linkwright.packages.programs.python_modules import find_module

        return find_module(finder, fullname, importing_file.parent)


def _find_importing_file() -> Path | None:
    """Return the user's file that runs the current import.

    The result is None if a library runs the import, because a library may import a module optionally.
    """
    from linkwright.packages.programs.code_files import is_user_file

    frame = sys._getframe(2)
    while frame.f_back is not None and frame.f_code.co_filename.startswith("<frozen importlib"):
        frame = frame.f_back
    return Path(frame.f_code.co_filename) if is_user_file(frame.f_code.co_filename) else None


def _may_contain_interfaces(name: str) -> bool:
    """Return whether a module may contain interfaces.

    If so, the interface finder must search it.
    """
    package, _, kind = name.partition(".")
    if kind:
        return kind in ("msg", "srv", "action")
    messages = sys.modules.get("linkwright.messages")
    if messages is not None and not getattr(messages.__spec__, "_initializing", False):
        return not package.startswith("_")
    return package.endswith(("_msgs", "_interfaces", "_srvs"))


def _register_for_processes() -> None:
    """Make the stand-ins importable in processes that launch files start."""
    from linkwright.packages.programs import child_python as surroundings

    surroundings.register_launcher(_create_environment, _python_command)


def _create_environment(base: Mapping[str, str]) -> Mapping[str, str]:
    from linkwright.standins import process  # imported late, when the first process is started

    return process.create_environment(base)


def _python_command(arguments: Sequence[str]) -> Sequence[str]:
    from linkwright.standins import process

    return process.python_command(arguments)
