"""Select the topics and services that a bridge carries, by name patterns.

A pattern such as ``/robot1`` matches that name and all names below it; ``*`` in a pattern matches any text without a
slash.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase

_PATTERN = re.compile(r"/|(/[A-Za-z0-9_*]+)+")
_ACTION = "/_action/"


class NameFilter:
    """A filter of topic and service names.

    Args:
        allowed: patterns, at least one of which a name must match; if there are none, all names are allowed.
        denied: patterns that a name must not match, even if it is allowed.

    Raises:
        LinkwrightError: CLI453, a pattern is not valid.
    """

    def __init__(self, allowed: Iterable[str] = (), denied: Iterable[str] = ()) -> None:
        self._allowed = [_compile_pattern(pattern) for pattern in allowed]
        self._denied = [_compile_pattern(pattern) for pattern in denied]

    def passes(self, name: str) -> bool:
        """Return whether a topic or service, given by its absolute name, is carried.

        The topics and services of an action are treated like the action's name.
        """
        name = name.partition(_ACTION)[0]
        if any(pattern.match(name) for pattern in self._denied):
            return False
        return not self._allowed or any(pattern.match(name) for pattern in self._allowed)


def _compile_pattern(pattern: str) -> re.Pattern[str]:
    if not _PATTERN.fullmatch(pattern):
        raise LinkwrightError(
            Diagnostic(
                "CLI453",
                phrase("'{pattern}' is not a valid pattern for topic and service names", pattern=pattern),
                hint=phrase("write an absolute name, such as /robot1 for all names below it, or /*/scan"),
            )
        )
    expression = "[^/]*".join(re.escape(literal) for literal in pattern.rstrip("/").split("*"))
    return re.compile(f"{expression}(/.*)?$")
