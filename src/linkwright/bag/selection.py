"""Which topics are recorded."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field

from linkwright.diagnostics import Diagnostic, LinkwrightError


@dataclass(frozen=True)
class TopicSelection:
    """What ``bag record`` is told about topics.

    Attributes:
        everything: every topic that is not hidden.
        names: these topics, absolute names.
        types: every topic of one of these types.
        pattern: every topic in whose name this regular expression is found.
        without_names: none of these, whatever else says.
        without_types: none of these types.
        without_pattern: none in whose name this regular expression is found.
        hidden: hidden topics, those with a name that begins with an underscore, count as others.

    Raises:
        LinkwrightError: BAG104, a regular expression is not valid.
    """

    everything: bool = False
    names: Sequence[str] = ()
    types: Sequence[str] = ()
    pattern: str = ""
    without_names: Sequence[str] = ()
    without_types: Sequence[str] = ()
    without_pattern: str = ""
    hidden: bool = False
    _wanted: re.Pattern[str] | None = field(init=False, repr=False, compare=False)
    _unwanted: re.Pattern[str] | None = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_wanted", _compiled(self.pattern))
        object.__setattr__(self, "_unwanted", _compiled(self.without_pattern))

    @property
    def is_empty(self) -> bool:
        """Whether it names nothing at all to record."""
        return not (self.everything or self.names or self.types or self.pattern)

    @property
    def is_complete_with(self) -> frozenset[str] | None:
        """The topics after which there is nothing more to look for; None where new ones may always come."""
        return None if self.everything or self.types or self.pattern else frozenset(self.names)

    def takes(self, name: str, type_name: str) -> bool:
        """Whether a topic is recorded.

        Args:
            name: its absolute name.
            type_name: such as ``std_msgs/msg/String``.
        """
        if name in self.without_names or type_name in self.without_types:
            return False
        if self._unwanted is not None and self._unwanted.search(name):
            return False
        if name in self.names:
            return True
        if not self.hidden and any(part.startswith("_") for part in name.split("/")):
            return False
        return (
            self.everything
            or type_name in self.types
            or (self._wanted is not None and self._wanted.search(name) is not None)
        )


def _compiled(pattern: str) -> re.Pattern[str] | None:
    if not pattern:
        return None
    try:
        return re.compile(pattern)
    except re.error as error:
        raise LinkwrightError(
            Diagnostic("BAG104", f"'{pattern}' is not a valid regular expression: {error.msg}")
        ) from error
