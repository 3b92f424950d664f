"""Activate the stand-ins in every Python process with this folder on ``PYTHONPATH``.

Linkwright is imported only when the program imports a stand-in that no other finder provides. If a real rclpy is
importable, the stand-ins are not provided, because the nodes of each rclpy accept only its own message classes.
"""

# This module uses os.path, because it runs in every Python process and pathlib is slow to import.
# ruff: noqa: PTH100, PTH109, PTH113, PTH118, PTH120, PTH208

from __future__ import annotations

import os
import sys
from importlib.machinery import ModuleSpec, PathFinder

_STARTUP_FOLDER = os.path.dirname(os.path.abspath(__file__))
_TABLES_FOLDER = os.path.join(os.path.dirname(_STARTUP_FOLDER), "tables")
_SOURCE_FOLDER = os.path.dirname(os.path.dirname(os.path.dirname(_STARTUP_FOLDER)))

_LINKWRIGHT_PREFIX = os.path.join(_SOURCE_FOLDER, "linkwright", "")
_SIGNALS_PATH = os.path.join("rclpy_api", "signals.py")
"""The end of the path of the signal handler's module. The handler may run at any point of the program."""
_STANDARD_LIBRARY_PREFIX = os.path.join(os.path.dirname(os.__file__), "")

_ROS_INDEPENDENT = frozenset({"tf_transformations"})
"""Stand-ins that also work with a real ROS, because they use neither messages nor nodes."""

_INTERFACE_KINDS = ("msg", "srv", "action")
_INTERFACE_SUFFIXES = ("_msgs", "_interfaces", "_srvs", "_msg", "_srv", "_action", "_actions")
_OTHER_INTERFACE_PACKAGES = frozenset({"turtlesim"})
_MAX_PARENT_FOLDERS = 5


class StandIns:
    """A finder of the stand-ins.

    Python uses it after all other finders have failed.
    """

    def __init__(self) -> None:
        self._names: frozenset[str] | None = None
        self._has_real_ros: bool | None = None
        self._is_searching = False

    def find_spec(self, name: str, path: object = None, target: object = None) -> ModuleSpec | None:
        """Return the spec of a stand-in or interface module, or None for another module."""
        if self._is_searching or name.startswith("_"):
            return None
        top_level_name, _, submodules = name.partition(".")
        if submodules:
            return self.find_interface_spec(name) if submodules.partition(".")[0] in _INTERFACE_KINDS else None
        if self.provides(top_level_name):
            if top_level_name not in _ROS_INDEPENDENT and self.has_real_ros():
                return None
            _make_importable()
            from linkwright.standins import modules

            modules.install()
            return _enable_field_checks(modules.find_spec(name))
        return self.find_interface_spec(name) if _may_contain_interfaces(top_level_name) else None

    def find_interface_spec(self, name: str) -> ModuleSpec | None:
        """Return the spec of an interface module, or None for another module."""
        if self._is_searching or self.has_real_ros():
            return None
        self._is_searching = True
        try:
            _make_importable()
            from linkwright.standins.interfaces import find_spec

            return _enable_field_checks(find_spec(name))
        finally:
            self._is_searching = False

    def provides(self, name: str) -> bool:
        """Return whether a stand-in exists for the name of a top-level module."""
        if self._names is None:
            try:
                self._names = frozenset(name.removesuffix(".txt") for name in os.listdir(_TABLES_FOLDER))
            except OSError:
                self._names = frozenset()
        return name in self._names

    def has_real_ros(self) -> bool:
        """Return whether an rclpy that is not the stand-in is installed."""
        if self._has_real_ros is None:
            spec = PathFinder.find_spec("rclpy", [entry for entry in sys.path if entry != _TABLES_FOLDER])
            self._has_real_ros = spec is not None and spec.origin is not None
        return self._has_real_ros


class SourceFolders:
    """A finder of stand-ins and interface modules that a source folder of the same name hides.

    This finder comes before all others. Without it, Python would import such a folder, for example ``my_msgs/msg`` or
    ``launch`` next to ``package.xml``, as an empty module.
    """

    def __init__(self, stand_ins: StandIns) -> None:
        self._stand_ins = stand_ins

    def find_spec(self, name: str, path: object = None, target: object = None) -> ModuleSpec | None:
        """Return the spec of a stand-in or interface module that a source folder hides, or None."""
        package, _, kind = name.rpartition(".")
        if not package:
            return self._stand_ins.find_spec(name) if self._is_hidden(name) else None
        if kind not in _INTERFACE_KINDS or package not in sys.modules:
            return None
        return None if getattr(sys.modules[package], "__file__", None) else self._stand_ins.find_interface_spec(name)

    def _is_hidden(self, name: str) -> bool:
        """Return whether a folder that is not a Python package hides a stand-in of the same name."""
        if not self._stand_ins.provides(name):
            return False
        spec = PathFinder.find_spec(name)
        return spec is not None and spec.origin is None


def _may_contain_interfaces(package: str) -> bool:
    """Return whether a package may contain interface files.

    If so, Linkwright must be imported.
    """
    if (
        _is_loaded("linkwright.messages")
        or package.endswith(_INTERFACE_SUFFIXES)
        or package in _OTHER_INTERFACE_PACKAGES
    ):
        return True
    shares = [os.path.join(prefix, "share") for prefix in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)]
    return any(
        os.path.isfile(os.path.join(folder, package, "package.xml")) for folder in (*shares, *_find_nearby_folders())
    )


def _is_loaded(name: str) -> bool:
    """Return whether the import of a module is complete.

    While a module is being imported, the imports that it makes must not be handled here.
    """
    module = sys.modules.get(name)
    return module is not None and not getattr(module.__spec__, "_initializing", False)


def _find_nearby_folders() -> list[str]:
    """Return the folders near the program that may contain packages of its workspace."""
    current = os.getcwd()
    folders = [current, os.path.join(current, "src")]
    program = os.path.abspath(sys.argv[0]) if getattr(sys, "argv", [""])[0] else current
    for _ in range(_MAX_PARENT_FOLDERS):
        program = os.path.dirname(program)
        folders.append(program)
    return folders


def _make_importable() -> None:
    """Append the folders of Linkwright and its dependencies to ``sys.path``."""
    for folder in (_SOURCE_FOLDER, *os.environ.get("LINKWRIGHT_SITE", "").split(os.pathsep)):
        if folder and folder not in sys.path:
            sys.path.append(folder)


def _enable_field_checks(spec: ModuleSpec | None) -> ModuleSpec | None:
    """Return `spec`, and enable the field checks of the ROS distribution in a user's program.

    Messages are then checked as strictly as in that distribution. The checks stay off in commands of Linkwright,
    because these run Linkwright's nodes.
    """
    is_distribution_set = "ROS_DISTRO" in os.environ or "ROS_PYTHON_CHECK_FIELDS" in os.environ
    if spec is not None and is_distribution_set and not _is_loaded("linkwright.cli"):
        from linkwright.messages import checks, distribution

        if distribution.checks_fields_as_ros():
            checks.restrict_to_ros_values(as_humble=distribution.is_before_iron())
    return spec


def _run_next_sitecustomize() -> None:
    """Run the ``sitecustomize`` on the path that this module hides."""
    other_entries = [entry for entry in sys.path if os.path.abspath(entry) != _STARTUP_FOLDER]
    spec = PathFinder.find_spec("sitecustomize", other_entries)
    if spec is None or spec.loader is None:
        return
    from importlib.util import module_from_spec  # imported late because the module is large

    module = module_from_spec(spec)
    sys.modules["sitecustomize"] = module
    spec.loader.exec_module(module)


def _report_with_hint(kind: type[BaseException], error: BaseException, traceback: object) -> None:
    """Print an uncaught error, with a hint if a ROS module or a name in one is missing.

    After Ctrl-C, no traceback is printed if a node was waiting for messages or was still being imported. If Ctrl-C
    interrupted the user's code, the traceback shows the location.
    """
    if kind is KeyboardInterrupt and _is_between_messages(traceback):
        return
    sys.__excepthook__(kind, error, traceback)  # type: ignore[arg-type]  # naming its type would import a module
    name = getattr(error, "name", None)
    if isinstance(error, ImportError) and name and not _stand_ins.has_real_ros():
        try:
            _make_importable()
            from linkwright.packages.programs.missing_modules import make_known_provider_hint, make_other_module_hint

            hint = (
                make_known_provider_hint(name)
                if isinstance(error, ModuleNotFoundError)
                else make_other_module_hint(error)
            )
        except Exception:  # noqa: BLE001 - the program's own error is reported
            return
        if hint:
            print(f"hint: {hint}", file=sys.stderr)


def _is_between_messages(traceback: object) -> bool:
    """Return whether a traceback ends in Linkwright's code, or passes through an import.

    Code of the standard library counts as Linkwright's code if Linkwright's code calls it.
    """
    is_linkwright_code, module_count = False, 0
    while traceback is not None:
        code = traceback.tb_frame.f_code  # type: ignore[attr-defined]  # as above
        traceback = traceback.tb_next  # type: ignore[attr-defined]
        module_count += code.co_name == "<module>"  # the program itself, and the modules it imports
        if not code.co_filename.endswith(_SIGNALS_PATH):
            is_own_code = code.co_filename.startswith(_LINKWRIGHT_PREFIX)
            is_linkwright_code = is_own_code or (
                is_linkwright_code and code.co_filename.startswith((_STANDARD_LIBRARY_PREFIX, "<"))
            )
    return module_count > 1 or is_linkwright_code


_stand_ins = StandIns()
sys.meta_path.insert(0, SourceFolders(_stand_ins))
sys.meta_path.append(_stand_ins)
if __name__ == "sitecustomize":  # the name differs if `linkwright.pytest_plugin` runs the file after Python has started
    sys.excepthook = _report_with_hint
    _run_next_sitecustomize()
