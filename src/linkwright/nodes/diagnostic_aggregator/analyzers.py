"""Analyzers: which statuses belong to a group, and what is reported of them.

Parameters, names and levels are those in the documentation of diagnostic_aggregator.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Protocol

from linkwright.nodes.diagnostic_aggregator.items import Level, Status, format_item_name, remove_prefix
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

OTHER_TIMEOUT = 5.0
"""After this time without an update, the group ``Other`` drops a status, in seconds."""


class Analyzer(Protocol):
    """A part of an aggregator that takes and reports statuses.

    Attributes:
        name: the name in the status of the group above.
        path: the name of the analyzer's own status.
    """

    name: str
    path: str

    def matches(self, name: str) -> bool:
        """Return whether the analyzer takes statuses with a name."""

    def analyze(self, item: Status) -> bool:
        """Take a status that matches, and return whether some analyzer keeps it."""

    def report(self, now_ns: int) -> list[Status]:
        """Return the statuses to publish."""


@dataclass(slots=True)
class Selection:
    """The names of statuses that an analyzer takes: any of these rules is enough.

    Attributes:
        regex: regular expressions that match a whole name.
        names: whole names.
        startswith: beginnings of names.
        contains: parts of names.
    """

    regex: Sequence[re.Pattern[str]] = ()
    names: Sequence[str] = ()
    startswith: Sequence[str] = ()
    contains: Sequence[str] = ()

    def __bool__(self) -> bool:
        """Return whether there is a rule."""
        return bool(self.regex or self.names or self.startswith or self.contains)

    def matches(self, name: str) -> bool:
        """Return whether a rule matches a name."""
        return (
            name in self.names
            or name.startswith(tuple(self.startswith))
            or any(part in name for part in self.contains)
            or any(pattern.fullmatch(name) for pattern in self.regex)
        )


@dataclass(slots=True)
class GenericAnalyzer:
    """Keeps the last status of each name, and reports them below a status of its own.

    Attributes:
        name: the name of the analyzer.
        path: the path of the group above and the name.
        selection: the statuses that the analyzer takes.
        prefixes: removed from the names of statuses.
        expected: the names of statuses that are missing if they were not received.
        timeout: after this time without an update a status is stale, in seconds; not positive for never.
        expected_count: the number of statuses that there must be; 0 if there may be none, and negative for any number.
        discards_stale: whether stale statuses are dropped.
        items: the statuses by name.
    """

    name: str
    path: str
    selection: Selection
    prefixes: Sequence[str] = ()
    expected: Sequence[str] = ()
    timeout: float = 5.0
    expected_count: int = -1
    discards_stale: bool = False
    items: dict[str, Status] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.items.update((name, Status.missing(name)) for name in self.expected)

    def matches(self, name: str) -> bool:
        """Return whether the analyzer takes statuses with a name."""
        return self.selection.matches(name)

    def analyze(self, item: Status) -> bool:
        """Keep a status."""
        self.items[item.name] = item
        return True

    def report(self, now_ns: int) -> list[Status]:
        """Return the analyzer's own status, followed by the statuses below it in the order of their names."""
        reported = self._report_items(now_ns)
        missing = [name for name in self.expected if name not in self.items]
        has_only_stale = all(status.level is Level.STALE for status in reported)
        reported += [Status.missing(name).below(self.path) for name in missing]
        for status in reported[1:]:
            for prefix in self.prefixes:
                status.name = remove_prefix(status.name, format_item_name(prefix))
        header = reported[0]
        if missing:
            header.level = Level.STALE if has_only_stale else Level.ERROR
            header.message = "All Stale" if has_only_stale else "Error"
            header.values += [(name, "Missing") for name in missing]
        return reported

    def _report_items(self, now_ns: int) -> list[Status]:
        header = Status(self.path)
        reported, levels = [header], []
        for name, item in sorted(self.items.items()):
            is_stale = self.timeout > 0 and now_ns - item.update_ns > self.timeout * NANOSECONDS_PER_SECOND
            if is_stale and self.discards_stale:
                del self.items[name]
                continue
            status = item.below(self.path, is_stale=is_stale)
            header.values.append((name, item.message))
            levels.append(status.level)
            reported.append(status)
        if all(level is Level.STALE for level in levels):
            may_be_empty = self.expected_count == 0 and not levels
            header.level = Level.OK if self.discards_stale or may_be_empty else Level.STALE
        else:
            header.level = min(max(levels), Level.ERROR)
        header.message = header.level.text
        self._check_count(header, len(levels))
        return reported

    def _check_count(self, header: Status, count: int) -> None:
        if self.expected_count <= 0 or count == self.expected_count:
            return
        header.level = max(header.level, Level.ERROR)
        header.message = (
            f"Expected {self.expected_count}, found {count}"
            if count
            else f"No items found, expected {self.expected_count}"
        )


class OtherAnalyzer(GenericAnalyzer):
    """Reports the statuses that no other analyzer takes, if there are any.

    Args:
        base_path: the path of the aggregator.
        are_errors: whether such statuses are an error.
    """

    def __init__(self, base_path: str, *, are_errors: bool) -> None:
        super().__init__("Other", f"{base_path}/Other", Selection(), timeout=OTHER_TIMEOUT, discards_stale=True)
        self._are_errors = are_errors

    def report(self, now_ns: int) -> list[Status]:
        """Return the statuses below ``Other``, or nothing."""
        reported = super().report(now_ns)
        if len(reported) == 1:
            return []
        if self._are_errors:
            reported[0].level = Level.ERROR
            reported[0].message = 'Unanalyzed items found in "Other"'
        return reported


class DiscardAnalyzer(GenericAnalyzer):
    """Takes statuses and reports none of them."""

    def report(self, now_ns: int) -> list[Status]:
        """Return nothing."""
        return []


class IgnoreAnalyzer:
    """Takes and reports nothing."""

    name = path = ""

    def matches(self, name: str) -> bool:
        """Return False."""
        return False

    def analyze(self, item: Status) -> bool:
        """Return False: the status is not kept."""
        return False

    def report(self, now_ns: int) -> list[Status]:
        """Return nothing."""
        return []


@dataclass(slots=True)
class AnalyzerGroup:
    """Reports what its analyzers report, below a status of its own.

    Attributes:
        name: the name of the group, which in diagnostic_aggregator is its path.
        path: the path of the group; empty for an aggregator without a path, which has no status of its own.
        analyzers: the analyzers of the group.
        failed: the analyzers that cannot be created, with the reason.
    """

    name: str
    path: str
    analyzers: list[Analyzer] = field(default_factory=list)
    failed: list[Status] = field(default_factory=list)
    _matching: dict[str, list[Analyzer]] = field(default_factory=dict)

    def matches(self, name: str) -> bool:
        """Return whether one of the analyzers takes statuses with a name."""
        return bool(self._find_matching(name))

    def analyze(self, item: Status) -> bool:
        """Give a status to each analyzer that takes it, and return whether one keeps it."""
        kept = [analyzer.analyze(item) for analyzer in self._find_matching(item.name)]
        return any(kept)

    def report(self, now_ns: int) -> list[Status]:
        """Return the statuses of all analyzers, followed by the group's own."""
        header = Status(self.path)
        if not self.analyzers:
            name = "/AnalyzerGroup" if self.path in ("", "/") else self.path
            return [Status(name, Level.ERROR, "No analyzers"), *self._report_failed()]
        levels: list[Level] = []
        reported: list[Status] = []
        for analyzer in self.analyzers:
            for status in analyzer.report(now_ns):
                reported.append(status)
                if status.name == analyzer.path:
                    header.values.append((analyzer.name, status.message))
                    levels.append(status.level)
        header.level = max(levels, default=Level.OK)
        if header.level is Level.STALE and any(level is not Level.STALE for level in levels):
            header.level = Level.ERROR
        header.message = header.level.text
        if self.path not in ("", "/"):
            reported.append(header)
        return [*reported, *self._report_failed()]

    def _report_failed(self) -> Iterator[Status]:
        return (status.below(self.path, is_stale=True) for status in self.failed)

    def _find_matching(self, name: str) -> list[Analyzer]:
        """Return the analyzers that take statuses with a name, which is found out once for each name."""
        if name not in self._matching:
            self._matching[name] = [analyzer for analyzer in self.analyzers if analyzer.matches(name)]
        return self._matching[name]
