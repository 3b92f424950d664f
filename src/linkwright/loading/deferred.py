"""Names and regular expressions that are loaded or compiled on first use, for a quick start."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence

from linkwright.loading.lean_typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from typing import AnyStr


def deferred(package: str, names: Mapping[str, Sequence[str]]) -> Callable[[str], Any]:
    """Return a ``__getattr__`` for a package's ``__init__`` that imports modules on access.

    Source: PEP 562.

    Args:
        package: the name of the package.
        names: the names that each module defines, by the module's name in the package.

    Returns:
        A function that imports and returns the object with a name, and raises AttributeError for other names.
    """

    def find(name: str) -> Any:
        from importlib import import_module  # imported here because many modules use only `lazy_pattern`

        for module, has in names.items():
            if name in has:
                return getattr(import_module(f"{package}.{module}"), name)
        raise AttributeError(f"module '{package}' has no attribute '{name}'")

    return find


class _Pattern:
    """A pattern that is compiled when one of its attributes is first used.

    Modules define their patterns at the top. A check of one robot imports seventy patterns and uses a quarter of them.
    Compiling a pattern takes as long as importing a small module.
    """

    def __init__(self, text: Any, flags: int) -> None:
        self._text = text
        self._flags = flags

    def __getattr__(self, name: str) -> Any:
        # Python calls this method only for missing attributes, so each attribute is set once.
        if name.startswith("__"):  # special names, which for example `copy` looks up
            raise AttributeError(name)
        value = getattr(re.compile(self._text, self._flags), name)
        setattr(self, name, value)
        return value


def _late(text: Any, flags: int = 0) -> Any:
    return _Pattern(text, flags)


if TYPE_CHECKING:

    def lazy_pattern(text: AnyStr, flags: int = 0) -> re.Pattern[AnyStr]:
        """Return a pattern like `re.compile`, which raises errors in the pattern only on first use."""

else:
    lazy_pattern = _late
