"""Makes the stand-ins importable in every Python process with this folder on its ``PYTHONPATH``.

Linkwright is imported only when the program imports a module of ours that no other finder provides. If a real rclpy is
importable, none of our modules is provided, because the nodes of one accept only its own message classes.
"""

# This module uses os.path, because it runs in every Python process and pathlib is slow to import.
# ruff: noqa: PTH100, PTH109, PTH113, PTH118, PTH120, PTH208

from __future__ import annotations

import os
import sys
from importlib.machinery import ModuleSpec, PathFinder

_HERE = os.path.dirname(os.path.abspath(__file__))
_TABLES = os.path.join(os.path.dirname(_HERE), "tables")
_LINKWRIGHT = os.path.dirname(os.path.dirname(os.path.dirname(_HERE)))

_OURS = os.path.join(_LINKWRIGHT, "linkwright", "")
_SIGNALS = os.path.join("rclpy_api", "signals.py")
"""The name of the signal handler, which may run at any point of the program."""
_STANDARD_LIBRARY = os.path.join(os.path.dirname(os.__file__), "")

_WITH_ANY_ROS = frozenset({"tf_transformations"})
"""Stand-ins that use neither messages nor nodes, so that they work with a real ROS."""

_INTERFACE_KINDS = ("msg", "srv", "action")
_INTERFACE_ENDINGS = ("_msgs", "_interfaces", "_srvs", "_msg", "_srv", "_action", "_actions")
_OTHER_INTERFACES = frozenset({"turtlesim"})
_PARENTS_LOOKED_AT = 5


class StandIns:
    """Finds the stand-ins, after all other finders have failed."""

    def __init__(self) -> None:
        self._names: frozenset[str] | None = None
        self._real_ros: bool | None = None
        self._searching = False

    def find_spec(self, name: str, path: object = None, target: object = None) -> ModuleSpec | None:
        """Return the spec of a stand-in or interface module, or None for another module."""
        if self._searching or name.startswith("_"):
            return None
        top, _, rest = name.partition(".")
        if rest:
            return self.interface(name) if rest.partition(".")[0] in _INTERFACE_KINDS else None
        if self.has(top):
            if top not in _WITH_ANY_ROS and self.has_real_ros():
                return None
            _make_importable()
            from linkwright.standins import modules

            modules.install()
            return _with_ros_field_checks(modules.find_spec(name))
        return self.interface(name) if _may_hold_interfaces(top) else None

    def interface(self, name: str) -> ModuleSpec | None:
        """Return the spec of an interface module, or None for another module."""
        if self._searching or self.has_real_ros():
            return None
        self._searching = True
        try:
            _make_importable()
            from linkwright.standins.interfaces import find_spec

            return _with_ros_field_checks(find_spec(name))
        finally:
            self._searching = False

    def has(self, name: str) -> bool:
        """Return whether there is a stand-in for a module name."""
        if self._names is None:
            try:
                self._names = frozenset(name.removesuffix(".txt") for name in os.listdir(_TABLES))
            except OSError:
                self._names = frozenset()
        return name in self._names

    def has_real_ros(self) -> bool:
        """Return whether an rclpy other than ours is installed."""
        if self._real_ros is None:
            found = PathFinder.find_spec("rclpy", [entry for entry in sys.path if entry != _TABLES])
            self._real_ros = found is not None and found.origin is not None
        return self._real_ros


class SourceFolders:
    """Finds stand-ins and interface modules that have the name of a source folder, before all others.

    Without this finder, Python would import such a folder as an empty module, for example ``my_msgs/msg``, or
    ``launch`` next to ``package.xml``.
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
        return None if getattr(sys.modules[package], "__file__", None) else self._stand_ins.interface(name)

    def _is_hidden(self, name: str) -> bool:
        """Return whether a folder that is not a Python package hides the stand-in with the same name."""
        if not self._stand_ins.has(name):
            return False
        found = PathFinder.find_spec(name)
        return found is not None and found.origin is None


def _may_hold_interfaces(package: str) -> bool:
    """Return whether a package may contain interface files, so that Linkwright must be imported."""
    if _is_loaded("linkwright.messages") or package.endswith(_INTERFACE_ENDINGS) or package in _OTHER_INTERFACES:
        return True
    shares = [os.path.join(prefix, "share") for prefix in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)]
    return any(os.path.isfile(os.path.join(folder, package, "package.xml")) for folder in (*shares, *_near_folders()))


def _is_loaded(name: str) -> bool:
    """Return whether a module is completely imported.

    Imports that the module makes during its own import must not be handled here.
    """
    module = sys.modules.get(name)
    return module is not None and not getattr(module.__spec__, "_initializing", False)


def _near_folders() -> list[str]:
    """Return the folders that may contain packages of the workspace to which the program belongs."""
    current = os.getcwd()
    folders = [current, os.path.join(current, "src")]
    program = os.path.abspath(sys.argv[0]) if getattr(sys, "argv", [""])[0] else current
    for _ in range(_PARENTS_LOOKED_AT):
        program = os.path.dirname(program)
        folders.append(program)
    return folders


def _make_importable() -> None:
    """Append the folders of Linkwright and its dependencies to ``sys.path``."""
    for folder in (_LINKWRIGHT, *os.environ.get("LINKWRIGHT_SITE", "").split(os.pathsep)):
        if folder and folder not in sys.path:
            sys.path.append(folder)


def _with_ros_field_checks(spec: ModuleSpec | None) -> ModuleSpec | None:
    """Enable the field checks of the ROS distribution in a user's program, and return the spec.

    Messages are then checked as strictly as by that distribution. A command of Linkwright in the shell is not a user's
    program, because it runs our own nodes.
    """
    named = "ROS_DISTRO" in os.environ or "ROS_PYTHON_CHECK_FIELDS" in os.environ
    if spec is not None and named and not _is_loaded("linkwright.cli"):
        from linkwright.messages import checks, distribution

        if distribution.checks_fields_as_ros():
            checks.keep_to_ros(as_humble=distribution.is_before_iron())
    return spec


def _run_next_sitecustomize() -> None:
    """Run the next ``sitecustomize`` on the path, which this module hides."""
    others = [entry for entry in sys.path if os.path.abspath(entry) != _HERE]
    spec = PathFinder.find_spec("sitecustomize", others)
    if spec is None or spec.loader is None:
        return
    from importlib.util import module_from_spec  # imported late because the module is large

    module = module_from_spec(spec)
    sys.modules["sitecustomize"] = module
    spec.loader.exec_module(module)


def _report_with_hint(kind: type[BaseException], error: BaseException, traceback: object) -> None:
    """Print an uncaught error, with a hint if a ROS module or a name in one is missing.

    Ctrl-C does not print a traceback while a node waits for messages or is still being imported. If Ctrl-C interrupts
    the user's own code, the traceback shows the location.
    """
    if kind is KeyboardInterrupt and _is_between_messages(traceback):
        return
    sys.__excepthook__(kind, error, traceback)  # type: ignore[arg-type]  # naming its type would import a module
    name = getattr(error, "name", None)
    if isinstance(error, ImportError) and name and not _stand_ins.has_real_ros():
        try:
            _make_importable()
            from linkwright.packages.programs.missing_modules import known_provider_hint, other_module_hint

            hint = known_provider_hint(name) if isinstance(error, ModuleNotFoundError) else other_module_hint(error)
        except Exception:  # noqa: BLE001 - the program's own error is reported
            return
        if hint:
            print(f"hint: {hint}", file=sys.stderr)


def _is_between_messages(traceback: object) -> bool:
    """Return whether a traceback ends in our code, in code called by it, or in an import."""
    is_ours, modules = False, 0
    while traceback is not None:
        code = traceback.tb_frame.f_code  # type: ignore[attr-defined]  # as above
        traceback = traceback.tb_next  # type: ignore[attr-defined]
        modules += code.co_name == "<module>"  # the program itself, and the modules it imports
        if not code.co_filename.endswith(_SIGNALS):
            ours = code.co_filename.startswith(_OURS)
            is_ours = ours or (is_ours and code.co_filename.startswith((_STANDARD_LIBRARY, "<")))
    return modules > 1 or is_ours


_stand_ins = StandIns()
sys.meta_path.insert(0, SourceFolders(_stand_ins))
sys.meta_path.append(_stand_ins)
if __name__ == "sitecustomize":  # this is false if `linkwright.pytest_plugin` runs the file after Python has started
    sys.excepthook = _report_with_hint
    _run_next_sitecustomize()
