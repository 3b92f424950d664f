"""Regular expressions for programs that must start soon: compiled when they are first used.

Modules name their patterns where they begin. A check of one robot loads seventy and searches with a quarter, and
to compile one takes as long as to load a small module.
"""

from __future__ import annotations

import re

from linkwright.loading.lean_typing import TYPE_CHECKING

if TYPE_CHECKING:
    from typing import Any, AnyStr

__all__ = ["lazy_pattern"]


class _Pattern:
    """A pattern that has the methods of a compiled one, each after its first use."""

    def __init__(self, text: Any, flags: int) -> None:
        self._text = text
        self._flags = flags

    def __getattr__(self, name: str) -> Any:
        # Python comes here for a name that it has not found: the next time it finds this one.
        if name.startswith("__"):  # such as those that `copy` looks up
            raise AttributeError(name)
        value = getattr(re.compile(self._text, self._flags), name)
        setattr(self, name, value)
        return value


def _late(text: Any, flags: int = 0) -> Any:
    return _Pattern(text, flags)


if TYPE_CHECKING:

    def lazy_pattern(text: AnyStr, flags: int = 0) -> re.Pattern[AnyStr]:
        """Return a pattern as `re.compile` does; a mistake in it shows at its first use."""

else:
    lazy_pattern = _late
