"""Names and regular expressions for programs that must start quickly: loaded or compiled on first use."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence

from linkwright.loading.lean_typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from typing import AnyStr


def deferred(package: str, names: Mapping[str, Sequence[str]]) -> Callable[[str], Any]:
    """Return a ``__getattr__`` for a package's ``__init__``: it imports a module when one of its names is used.

    Source: PEP 562.

    Args:
        package: the name of the package.
        names: the names of each module, by the module's name below the package.

    Returns:
        A function that returns the attribute with a name, and raises AttributeError for unknown names.
    """

    def find(name: str) -> Any:
        from importlib import import_module  # imported here because many modules use only `lazy_pattern`

        for module, has in names.items():
            if name in has:
                return getattr(import_module(f"{package}.{module}"), name)
        raise AttributeError(f"module '{package}' has no attribute '{name}'")

    return find


class _Pattern:
    """A pattern with the methods of a compiled pattern, which are set on first use.

    Modules define their patterns at the top. A check of one robot loads seventy patterns and uses a quarter of them.
    Compiling one takes as long as loading a small module.
    """

    def __init__(self, text: Any, flags: int) -> None:
        self._text = text
        self._flags = flags

    def __getattr__(self, name: str) -> Any:
        # Python calls this for an attribute that does not exist; after this it exists.
        if name.startswith("__"):  # such as those that `copy` looks up
            raise AttributeError(name)
        value = getattr(re.compile(self._text, self._flags), name)
        setattr(self, name, value)
        return value


def _late(text: Any, flags: int = 0) -> Any:
    return _Pattern(text, flags)


if TYPE_CHECKING:

    def lazy_pattern(text: AnyStr, flags: int = 0) -> re.Pattern[AnyStr]:
        """Return a pattern like `re.compile`; an error in it is raised on first use."""

else:
    lazy_pattern = _late
