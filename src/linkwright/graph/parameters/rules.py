"""Values for parameters of nodes that are named by patterns: the sum of parameter files and ``-p``."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from linkwright.diagnostics import Diagnostic

ANY_NODE = "/**"


class ParameterRules:
    """Parameter values by node name pattern.

    A pattern is a node's full name, in which ``*`` matches one part and ``**`` any number of parts. As in rcl the
    patterns count in the order in which they appear first, and for a node the later of two that match it wins.

    Attributes:
        files: the paths of the files that they were read from.
        left_out: patterns, each with a finding about a parameter whose value no parameter can have.
    """

    def __init__(self) -> None:
        self._values: dict[str, dict[str, Any]] = {}
        self.files: list[str] = []
        self.left_out: list[tuple[str, Diagnostic]] = []

    def __bool__(self) -> bool:
        return bool(self._values)

    def __iter__(self) -> Iterator[tuple[str, Mapping[str, Any]]]:
        """Patterns with their values by parameter name."""
        return iter(self._values.items())

    def set(self, pattern: str, name: str, value: Any) -> None:
        """Give a parameter a value, instead of the one that the same pattern gave it before."""
        self.section(pattern)[name] = value

    def section(self, pattern: str) -> dict[str, Any]:
        """The values of a pattern, to which may be added; a missing leading slash is added."""
        return self._values.setdefault(pattern if pattern.startswith("/") else f"/{pattern}", {})

    def add(self, other: ParameterRules) -> None:
        """Add rules that come after these."""
        for pattern, values in other:
            self.section(pattern).update(values)
        self.files += other.files
        self.left_out += other.left_out

    @property
    def patterns(self) -> list[str]:
        """The patterns, in their order."""
        return list(self._values)

    def fit(self, full_name: str) -> bool:
        """Whether any pattern is for a node."""
        return any(_expression(pattern).fullmatch(full_name) for pattern in self._values)

    def without_node(self, full_names: Iterable[str]) -> list[str]:
        """The patterns that fit none of some nodes."""
        names = list(full_names)
        return [value for value in self._values if not any(map(_expression(value).fullmatch, names))]

    def for_node(self, full_name: str) -> dict[str, Any]:
        """The values for a node, by parameter name.

        Args:
            full_name: its namespace and name, such as ``/robot/talker``.
        """
        found: dict[str, Any] = {}
        for pattern, values in self._values.items():
            if _expression(pattern).fullmatch(full_name):
                found.update(values)
        return found

    def left_out_for(self, full_name: str) -> list[Diagnostic]:
        """The findings about parameters that were left out for a node."""
        return [finding for pattern, finding in self.left_out if _expression(pattern).fullmatch(full_name)]


@lru_cache(maxsize=256)
def _expression(pattern: str) -> re.Pattern[str]:
    while "/**/**" in pattern:  # is no more than one of them, and many of them take forever
        pattern = pattern.replace("/**/**", "/**")
    escaped = re.escape(pattern).replace(r"/\*\*", r"(/\w+)*").replace(r"/\*", r"(/\w+)")
    return re.compile(escaped)
