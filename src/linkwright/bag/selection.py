"""Select the topics of a recording."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.graph.endpoints.service import EVENT_TOPIC_SUFFIX


@dataclass(frozen=True)
class TopicSelection:
    """The options of ``bag record`` and ``bag play`` that select topics.

    Attributes:
        all_topics: whether to select all topics that are not hidden.
        names: the absolute names of topics to select.
        types: the types whose topics are selected.
        pattern: a regular expression; topics and services whose names contain a match are selected.
        without_names: the absolute names of topics to exclude, even if another option selects them.
        without_types: the types whose topics are excluded.
        without_pattern: a regular expression; topics and services whose names contain a match are excluded.
        include_hidden: whether to treat hidden topics like other topics; a part of their names begins with an
            underscore.
        all_services: whether to select the events of all services that publish them (service introspection).
        services: the absolute names of services whose events are selected.
        without_services: the absolute names of services to exclude.

    Raises:
        LinkwrightError: BAG104, a regular expression is not valid.
    """

    all_topics: bool = False
    names: Sequence[str] = ()
    types: Sequence[str] = ()
    pattern: str = ""
    without_names: Sequence[str] = ()
    without_types: Sequence[str] = ()
    without_pattern: str = ""
    include_hidden: bool = False
    all_services: bool = False
    services: Sequence[str] = ()
    without_services: Sequence[str] = ()
    _compiled_pattern: re.Pattern[str] | None = field(init=False, repr=False, compare=False)
    _compiled_without_pattern: re.Pattern[str] | None = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_compiled_pattern", _compile(self.pattern))
        object.__setattr__(self, "_compiled_without_pattern", _compile(self.without_pattern))

    @property
    def is_empty(self) -> bool:
        """Whether the options do not select any topic."""
        return not (self._accepts_unnamed or self.names or self.services)

    @property
    def required_topics(self) -> frozenset[str] | None:
        """The topics whose discovery completes the search, or None if any topic may be selected."""
        return None if self._accepts_unnamed else self.selected_names

    @property
    def selected_names(self) -> frozenset[str]:
        """The topics that are selected by name."""
        return frozenset((*self.names, *(name + EVENT_TOPIC_SUFFIX for name in self.services)))

    @property
    def _accepts_unnamed(self) -> bool:
        return bool(self.all_topics or self.all_services or self.types or self.pattern)

    def selects(self, name: str, type_name: str) -> bool:
        """Return whether a topic is selected.

        Args:
            name: the absolute name of the topic.
            type_name: the type, such as ``std_msgs/msg/String``.
        """
        if name in self.without_names or type_name in self.without_types or self._is_unwanted(name):
            return False
        if name in self.names:
            return True
        if name.endswith(EVENT_TOPIC_SUFFIX):
            return self._selects_service(name.removesuffix(EVENT_TOPIC_SUFFIX), type_name)
        if not self.include_hidden and any(part.startswith("_") for part in name.split("/")):
            return False
        return self.all_topics or type_name in self.types or self._is_wanted(name)

    def _selects_service(self, service: str, type_name: str) -> bool:
        if service in self.without_services or self._is_unwanted(service):
            return False
        return self.all_services or service in self.services or type_name in self.types or self._is_wanted(service)

    def _is_wanted(self, name: str) -> bool:
        return self._compiled_pattern is not None and self._compiled_pattern.search(name) is not None

    def _is_unwanted(self, name: str) -> bool:
        return self._compiled_without_pattern is not None and self._compiled_without_pattern.search(name) is not None


def _compile(pattern: str) -> re.Pattern[str] | None:
    if not pattern:
        return None
    try:
        return re.compile(pattern)
    except re.error as error:
        raise LinkwrightError(
            Diagnostic(
                "BAG104",
                phrase(
                    "'{pattern}' is not a valid regular expression: {reason}",
                    pattern=pattern,
                    reason=foreign(error.msg),
                ),
            )
        ) from error
