"""The patterns of names that clients may use, such as ``[/camera/*, '/odom']``."""

from __future__ import annotations

from collections.abc import Sequence
from fnmatch import fnmatchcase


class Globs:
    """Patterns of names. Without patterns, all names match.

    Args:
        patterns: a list as a text, with or without brackets and quotes, or a list of texts.
        always: further patterns, which apply if there are any.
    """

    def __init__(self, patterns: str | Sequence[str], always: Sequence[str] = ()) -> None:
        if isinstance(patterns, str):
            patterns = patterns.strip().removeprefix("[").removesuffix("]").split(",")
        self._patterns = [stripped for pattern in patterns if (stripped := pattern.strip().strip("'\""))]
        if self._patterns:
            self._patterns += always

    def match(self, name: str) -> bool:
        """Return whether a name matches."""
        return not self._patterns or any(fnmatchcase(name, pattern) for pattern in self._patterns)
