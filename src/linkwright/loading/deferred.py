"""Deferred names of a package, whose modules are loaded on first access because loading is slow (PEP 562)."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from importlib import import_module

from linkwright.loading.lean_typing import Any


def deferred(package: str, names: Mapping[str, Sequence[str]]) -> Callable[[str], Any]:
    """Return a ``__getattr__`` for the package's ``__init__``.

    Args:
        package: the name of the package.
        names: the names of each module, by the module's name below the package.

    Returns:
        A function that returns the attribute with a name, and raises AttributeError for unknown names.
    """

    def find(name: str) -> Any:
        for module, has in names.items():
            if name in has:
                return getattr(import_module(f"{package}.{module}"), name)
        raise AttributeError(f"module '{package}' has no attribute '{name}'")

    return find
