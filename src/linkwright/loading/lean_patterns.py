"""Regular expressions for programs that must start quickly: compiled on first use.

Modules define their patterns at the top. A check of one robot loads seventy patterns and uses a quarter of them, and
compiling one takes as long as loading a small module.
"""

from __future__ import annotations

import re

from linkwright.loading.lean_typing import TYPE_CHECKING

if TYPE_CHECKING:
    from typing import Any, AnyStr

__all__ = ["lazy_pattern"]


class _Pattern:
    """A pattern with the methods of a compiled pattern, which are set on first use."""

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
