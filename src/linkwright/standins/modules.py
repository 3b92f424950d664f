"""Create the modules in the tables, such as ``launch.actions``, when they are imported.

`FOLDER` is a virtual folder for Python's path finder. `FOLDER` contains every package that has a table, and
``FOLDER/launch`` contains the modules of ``launch``. Earlier entries of ``sys.path`` take precedence, package by
package. `pkgutil` lists the modules like files. A name is imported on first use, from the origin in the table.
"""

from __future__ import annotations

import importlib
import os
import sys
from ast import literal_eval
from collections.abc import Iterator
from importlib.machinery import ModuleSpec
from types import ModuleType
from typing import Any

from linkwright.standins import table

FOLDER = str(table.FOLDER)
"""The entry to add to ``sys.path`` after `install`."""


def install() -> None:
    """Make Python find the modules of `FOLDER`.

    Repeated calls have no further effect.
    """
    if _create_finder not in sys.path_hooks:
        sys.path_hooks.insert(0, _create_finder)
        for path in [path for path in sys.path_importer_cache if path.startswith(FOLDER)]:
            del sys.path_importer_cache[path]


def find_spec(name: str) -> ModuleSpec | None:
    """Return the spec of a module, or None if no table describes the module."""
    module_entries = table.find(name)
    if module_entries is None:
        return None
    spec = ModuleSpec(
        name,
        _Loader(module_entries),  # type: ignore[arg-type]  # a duck-typed loader: the base class is slow to import
        origin=str(table.FOLDER / f"{name.partition('.')[0]}.txt"),
        is_package=bool(module_entries.submodules) or "." not in name,
    )
    spec.has_location = True
    if spec.submodule_search_locations is not None:
        spec.submodule_search_locations.append(os.path.join(FOLDER, *name.split(".")))  # noqa: PTH118 - not a real folder
    return spec


def is_stand_in(module: ModuleType | None) -> bool:
    """Return whether a module was created by this module."""
    return isinstance(getattr(getattr(module, "__spec__", None), "loader", None), _Loader)


def _create_finder(path: str) -> _Finder:
    """Return the finder for an entry of ``sys.path``, as a path hook of Python.

    Raises:
        ImportError: the entry is not in `FOLDER`.
    """
    if path != FOLDER and not path.startswith(FOLDER + os.sep):
        raise ImportError(f"{path!r} contains no stand-ins", path=path)
    return _Finder(path[len(FOLDER) + 1 :].replace(os.sep, "."))


class _Finder:
    """A finder of the modules of one package, or of all packages that have a table."""

    def __init__(self, package: str) -> None:
        self._package = package

    def find_spec(self, name: str, target: ModuleType | None = None) -> ModuleSpec | None:
        """Return the spec of a module, or None."""
        return find_spec(name)

    def iter_modules(self, prefix: str = "") -> Iterator[tuple[str, bool]]:
        """Yield the name of each module and whether it is a package, for `pkgutil`."""
        package_entries = table.find(self._package)
        names = table.list_packages() if package_entries is None else package_entries.submodules
        for name in names:
            submodule_entries = table.find(f"{self._package}.{name}" if self._package else name)
            yield prefix + name, bool(submodule_entries and submodule_entries.submodules) or not self._package


class _Loader:
    """A loader that creates a module whose names are imported on first use."""

    def __init__(self, entries: table.Module) -> None:
        self._entries = entries

    def find_providers(self, name: str) -> list[str]:
        """Return the modules that provide a name, for the message of a failed import of the name."""
        return table.find_modules_providing(name)

    def create_module(self, spec: ModuleSpec) -> ModuleType | None:
        """Return None, so that Python creates a module object."""
        return None

    def exec_module(self, module: ModuleType) -> None:
        """Fill the module with functions that import its names on first use."""
        entries = self._entries
        module.__doc__ = f"A stand-in for ``{entries.name}``."
        dir_names = {**dict.fromkeys(entries.names), **dict.fromkeys(entries.submodules)}

        def import_name(name: str) -> Any:
            if name in entries.names:
                value = resolve_name(entries, name)
            elif name in entries.submodules:
                value = importlib.import_module(f"{entries.name}.{name}")
            elif entries.others:
                origin, _, function = entries.others.rpartition(".")
                return getattr(importlib.import_module(origin), function)(name)
            else:
                raise AttributeError(f"module '{entries.name}' has no attribute '{name}'", name=name, obj=module)
            setattr(module, name, value)
            return value

        own_names = {"__getattr__": import_name, "__dir__": lambda: sorted({*dir_names, *vars(module)})}  # PEP 562
        vars(module).update(own_names, __all__=entries.public)
        for name in entries.submodules:
            if name in entries.names and entries.names[name].origin != table.IMPORT:
                # If a function has the name of its submodule, import the submodule first. If not, a later import of the
                # submodule would replace the function with the module.
                importlib.import_module(f"{entries.name}.{name}")
                setattr(module, name, resolve_name(entries, name))
        if entries.setup:
            origin, _, function = entries.setup.rpartition(".")
            getattr(importlib.import_module(origin), function)()


def resolve_name(module: table.Module, name: str) -> Any:
    """Return the object that a module provides under a name.

    Raises:
        ImportError: the module that defines the name cannot be imported.
        AttributeError: that module does not define the name.
    """
    entry = module.names[name]
    if entry.origin == table.IMPORT:
        is_submodule = entry.name in module.submodules
        return importlib.import_module(f"{module.name}.{entry.name}" if is_submodule else entry.name)
    if entry.origin == table.VALUE:
        return literal_eval(entry.name)
    return getattr(importlib.import_module(entry.origin), entry.name)
