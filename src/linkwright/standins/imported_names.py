"""What modules stood in for have only because they import it, which users' programs take from there."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from importlib.machinery import PathFinder
from typing import Any


def submodules_of(package: str) -> Callable[[str], Any]:
    """The ``__getattr__`` of a package: its submodules, imported when somebody asks for one."""

    def submodule(name: str) -> Any:
        if not name.startswith("__") and PathFinder.find_spec(f"{package}.{name}", sys.modules[package].__path__):
            return importlib.import_module(f"{package}.{name}")
        raise AttributeError(f"module '{package}' has no attribute '{name}'")

    return submodule


def imported_from(modules: Sequence[str], system: str, *, interfaces: Sequence[str] = ()) -> Callable[[str], Any]:
    """The ``__getattr__`` of a module: what other modules of its system have, it offers as well.

    Args:
        modules: where names are looked for, in this order.
        system: what these are, for the message where none has the name.
        interfaces: modules of message, service and action classes, which are looked at after those.
    """

    def imported_there(name: str) -> Any:
        if not name.startswith("_"):
            for module in modules:
                found = vars(importlib.import_module(module)).get(name)
                if found is not None:
                    return found
            for module in interfaces:
                with suppress(ImportError, AttributeError):
                    return getattr(importlib.import_module(module), name)
        raise AttributeError(f"no module of {system} has a name '{name}'")

    return imported_there
