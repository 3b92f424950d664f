"""Names and regular expressions that are loaded or compiled on first use.

This makes programs start quickly.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence

from linkwright.loading.lean_typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from typing import AnyStr


def deferred(package: str, names: Mapping[str, Sequence[str]]) -> Callable[[str], Any]:
    """Return a ``__getattr__`` for a package's ``__init__``, for imports on first access.

    Source: PEP 562.

    Args:
        package: the name of the package.
        names: maps the names of modules in the package to the names that they define.

    Returns:
        A function that returns the object with a given name, and raises AttributeError for an unknown name.
    """

    def get_name(name: str) -> Any:
        from importlib import import_module  # imported here because many modules use only `lazy_pattern`

        for module, defined_names in names.items():
            if name in defined_names:
                return getattr(import_module(f"{package}.{module}"), name)
        raise AttributeError(f"module '{package}' has no attribute '{name}'")

    return get_name


class _Pattern:
    """A pattern that is compiled when one of its attributes is used for the first time.

    Modules define their patterns at the top. A check of one robot imports seventy patterns, and uses a quarter of
    them. Compiling one pattern takes as long as importing a small module.
    """

    def __init__(self, text: Any, flags: int) -> None:
        self._text = text
        self._flags = flags

    def __getattr__(self, name: str) -> Any:
        # Python calls this method only for missing attributes, so it is called once for each attribute.
        if name.startswith("__"):  # `copy`, for example, looks up such special names
            raise AttributeError(name)
        value = getattr(re.compile(self._text, self._flags), name)
        setattr(self, name, value)
        return value


def _lazy_pattern(text: Any, flags: int = 0) -> Any:
    return _Pattern(text, flags)


if TYPE_CHECKING:

    def lazy_pattern(text: AnyStr, flags: int = 0) -> re.Pattern[AnyStr]:
        """Return a pattern like `re.compile`.

        Errors in the pattern are raised only on first use.
        """

else:
    lazy_pattern = _lazy_pattern
