"""Import of ``<package>.msg``, ``.srv`` and ``.action``, as rosidl's packages allow.

``from sensor_msgs.msg import JointState`` imports the class of `linkwright.messages`. ``from my_msgs.msg import Count``
works for a package of the workspace as well: the classes are created from the interface files, without a build.
Installed interfaces take precedence, because their finders come first.
"""

from __future__ import annotations

import importlib
import sys
from collections.abc import Sequence
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from types import ModuleType
from typing import Any

from linkwright.diagnostics import LinkwrightError, did_you_mean, phrase
from linkwright.messages import catalog
from linkwright.messages.classes import get_interface
from linkwright.messages.definitions.interfaces import KINDS, is_package_name, to_snake_case
from linkwright.messages.definitions.library import LIBRARY
from linkwright.messages.errors import InterfaceNotFoundError
from linkwright.messages.message import ActionType, ServiceType


class InterfaceFinder(MetaPathFinder):
    """A finder of interface packages and their modules, such as ``std_msgs.msg``."""

    def find_spec(
        self,
        fullname: str,
        path: Sequence[str] | None = None,
        target: ModuleType | None = None,
    ) -> ModuleSpec | None:
        """Return the spec of an interface module, or None."""
        return find_spec(fullname)


class NamespaceFinder(MetaPathFinder):
    """A finder of ``my_msgs.msg`` in source folders, in place of Python's namespace packages.

    If a package's sources are on the path, such as ``my_msgs/msg`` with ``.msg`` files, Python's own finder creates an
    empty namespace package for the folder. This finder therefore comes before Python's finder, and handles interface
    modules of packages without Python files.
    """

    def find_spec(
        self,
        fullname: str,
        path: Sequence[str] | None = None,
        target: ModuleType | None = None,
    ) -> ModuleSpec | None:
        """Return the spec of an interface module in a namespace package, or None."""
        package, _, kind = fullname.rpartition(".")
        if kind not in KINDS or getattr(sys.modules.get(package), "__file__", None) is not None:
            return None
        return find_spec(fullname)


def install() -> None:
    """Make interface packages importable.

    Repeated calls have no further effect.
    """
    if not any(isinstance(finder, InterfaceFinder) for finder in sys.meta_path):
        sys.meta_path.insert(0, NamespaceFinder())
        sys.meta_path.append(InterfaceFinder())


def find_spec(name: str) -> ModuleSpec | None:
    """Return the spec of an interface module, or None.

    Examples are ``std_msgs``, ``std_msgs.msg`` and ``std_msgs.msg._string``.
    """
    package, *submodules = name.split(".")
    if len(submodules) > 2 or (submodules and submodules[0] not in KINDS) or not is_package_name(package):
        return None
    names = (
        _find_interface_names(package, submodules[0])
        if submodules
        else [interface for kind in KINDS for interface in _find_interface_names(package, kind)]
    )
    if not names:
        return None
    loader: Loader
    if len(submodules) < 2:
        loader = _KindLoader(names) if submodules else _PackageLoader()
        return ModuleSpec(name, loader, origin="Linkwright", is_package=True)
    interface = next((name for name in names if "_" + to_snake_case(name) == submodules[1]), None)
    if interface is None:
        return None
    return ModuleSpec(name, _InterfaceLoader(f"{package}/{submodules[0]}/{interface}"), origin="Linkwright")


def _find_interface_names(package: str, kind: str) -> list[str]:
    """Return the names of a package's interfaces.

    Packages that are part of Linkwright are not searched for on disk.
    """
    shipped_names = [name.rpartition("/")[2] for name in catalog.read_texts(package) if name.startswith(kind + "/")]
    return sorted(shipped_names) or [name.rpartition("/")[2] for name in LIBRARY.names(kind, package)]


class _PackageLoader(Loader):
    """A loader of the module of an interface package, which contains only submodules."""

    def create_module(self, spec: ModuleSpec) -> ModuleType | None:
        return None

    def exec_module(self, module: ModuleType) -> None:
        module.__doc__ = f"The messages, services and actions of {module.__name__}."

        def load_kind(name: str) -> Any:
            if name in KINDS and _find_interface_names(module.__name__, name):
                return importlib.import_module(f"{module.__name__}.{name}")
            raise AttributeError(f"module '{module.__name__}' has no attribute '{name}'")

        module.__getattr__ = load_kind  # type: ignore[method-assign]  # PEP 562


class _KindLoader(Loader):
    """A loader of a module such as ``<package>.msg``, whose classes are created on first use."""

    def __init__(self, names: list[str]) -> None:
        self._names = names

    def create_module(self, spec: ModuleSpec) -> ModuleType | None:
        return None

    def exec_module(self, module: ModuleType) -> None:
        package, _, kind = module.__name__.rpartition(".")
        names = self._names

        def load(name: str) -> Any:
            if not name[:1].isupper():
                raise AttributeError(f"module '{module.__name__}' has no attribute '{name}'")
            try:
                interface = get_interface(f"{package}/{kind}/{name}")
            except InterfaceNotFoundError:
                # as in 'from std_msgs.msg import Strng', for which Python's own message does not suggest a name
                hint = did_you_mean(name, names) or "it has " + ", ".join(names)
                message = f"cannot import name '{name}' from '{module.__name__}': {hint}"
                raise ImportError(message, name=module.__name__) from None
            except LinkwrightError as error:  # the error names the file and the line, so omit the traceback
                raise ImportError(str(error), name=module.__name__) from None
            setattr(module, name, interface)
            return interface

        module.__doc__ = f"The {kind} interfaces of {package}."
        own_names = {"__getattr__": load, "__dir__": lambda: sorted({*names, *vars(module)})}  # PEP 562
        vars(module).update(own_names, __all__=list(names))


class _InterfaceLoader(Loader):
    """A loader of a module such as ``std_srvs.srv._set_bool``, with the classes of rosidl."""

    def __init__(self, type_name: str) -> None:
        self._type_name = type_name

    def create_module(self, spec: ModuleSpec) -> ModuleType | None:
        return None

    def exec_module(self, module: ModuleType) -> None:
        try:
            interface = get_interface(self._type_name)
        except LinkwrightError as error:  # the interface file has an error; report it as an error of the import
            raise ImportError(str(error), name=module.__name__) from None
        name = interface.__name__
        attributes = {name: interface}
        if issubclass(interface, ServiceType):
            attributes |= _collect_service_parts(name, interface)
        elif issubclass(interface, ActionType):
            attributes |= {
                f"{name}_Goal": interface.Goal,
                f"{name}_Result": interface.Result,
                f"{name}_Feedback": interface.Feedback,
            }
            attributes[f"{name}_FeedbackMessage"] = interface.Impl.FeedbackMessage
            for part, service in (
                ("SendGoal", interface.Impl.SendGoalService),
                ("GetResult", interface.Impl.GetResultService),
            ):
                attributes[f"{name}_{part}"] = service
                attributes |= _collect_service_parts(f"{name}_{part}", service)
        module.__dict__.update(attributes)


def _collect_service_parts(name: str, service: type[ServiceType]) -> dict[str, Any]:
    return {
        f"{name}_Request": service.Request,
        f"{name}_Response": service.Response,
        f"{name}_Event": service.Event,
    }
