"""Creation of analyzers from the parameters of an aggregator."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from linkwright.diagnostics import Phrase, foreign, phrase, quoted_names
from linkwright.nodes.diagnostic_aggregator.analyzers import (
    Analyzer,
    AnalyzerGroup,
    DiscardAnalyzer,
    GenericAnalyzer,
    IgnoreAnalyzer,
    Selection,
)
from linkwright.nodes.diagnostic_aggregator.items import Status

_GENERIC_TYPES: Mapping[str, type[GenericAnalyzer]] = {
    "GenericAnalyzer": GenericAnalyzer,
    "DiscardAnalyzer": DiscardAnalyzer,
}
_IGNORE, _GROUP = "IgnoreAnalyzer", "AnalyzerGroup"
_TYPES = (*_GENERIC_TYPES, _IGNORE, _GROUP)
_ANALYZERS = "analyzers."
_SELECTING = ("startswith", "find_and_remove_prefix", "contains", "name", "expected", "regex")


class _InvalidAnalyzerError(Exception):
    """Raised when an analyzer cannot be created. The message is a `Phrase`."""

    def __init__(self, problem: Phrase) -> None:
        super().__init__(problem)
        self.problem = problem


@dataclass(frozen=True, slots=True)
class AnalyzerFactory:
    """Creates analyzers.

    Attributes:
        log_problem: receives what is wrong with the parameters of an analyzer.
    """

    log_problem: Callable[[Phrase], object]

    def create_group(self, parameters: Mapping[str, Any], path: str, prefix: str = "") -> AnalyzerGroup:
        """Return a group with the analyzers that its parameters describe.

        An analyzer that cannot be created is logged, and reported as a stale status.

        Args:
            parameters: the values by name; ``NAME.type`` or ``analyzers.NAME.type`` belong to the analyzer ``NAME``.
            path: the path of the group.
            prefix: the prefix of the parameters, for messages.
        """
        group = AnalyzerGroup(path, path)
        for key in sorted(list_analyzer_keys(parameters)):
            own = {
                name.removeprefix(f"{key}."): value for name, value in parameters.items() if name.startswith(f"{key}.")
            }
            try:
                group.analyzers.append(self._create(own, path, prefix + key))
            except _InvalidAnalyzerError as error:
                self.log_problem(error.problem)
                group.failed.append(Status.missing(key, "Analyzer init failed"))
        return group

    def _create(self, parameters: Mapping[str, Any], base_path: str, key: str) -> Analyzer:
        """Return the analyzer that parameters describe.

        Raises:
            _InvalidAnalyzerError: a parameter is missing or invalid.
        """
        kind = re.split(r"/|::", str(parameters["type"]))[-1]
        if kind not in _TYPES:
            raise _InvalidAnalyzerError(
                phrase(
                    "parameter '{name}' must be {types}, not '{type}'",
                    name=f"{key}.type",
                    types=quoted_names(_TYPES, " or "),
                    type=str(parameters["type"]),
                )
            )
        if kind == _IGNORE:
            return IgnoreAnalyzer()
        if not parameters.get("path"):
            raise _InvalidAnalyzerError(
                phrase("analyzer '{key}' has no name: set the parameter '{name}'", key=key, name=f"{key}.path")
            )
        path = f"{base_path.removesuffix('/')}/{parameters['path']}"
        if kind == _GROUP:
            group = self.create_group(parameters, path, f"{key}.")
            if not group.analyzers:
                raise _InvalidAnalyzerError(phrase("analyzer group '{key}' has no analyzers", key=key))
            return group
        return self._create_generic(_GENERIC_TYPES[kind], parameters, path, key)

    def _create_generic(
        self, analyzer_class: type[GenericAnalyzer], parameters: Mapping[str, Any], path: str, key: str
    ) -> GenericAnalyzer:
        found_prefixes = _read_texts(parameters, "find_and_remove_prefix")
        expected = _read_texts(parameters, "expected")
        selection = Selection(
            regex=self._read_patterns(parameters, key),
            names=[*_read_texts(parameters, "name"), *expected],
            startswith=[*found_prefixes, *_read_texts(parameters, "startswith")],
            contains=_read_texts(parameters, "contains"),
        )
        if not selection:
            raise _InvalidAnalyzerError(
                phrase(
                    "analyzer '{key}' selects no diagnostics: set {parameters}",
                    key=key,
                    parameters=quoted_names(_SELECTING, " or "),
                )
            )
        timeout = _read_number(parameters, "timeout", 5.0, key)
        discards_stale = bool(parameters.get("discard_stale", False))
        if discards_stale and timeout <= 0:
            self.log_problem(phrase("analyzer '{key}' has no timeout, so 'discard_stale' discards nothing", key=key))
            discards_stale = False
        return analyzer_class(
            str(parameters["path"]),
            path,
            selection,
            prefixes=[*found_prefixes, *_read_texts(parameters, "remove_prefix")],
            expected=expected,
            timeout=timeout,
            expected_count=int(_read_number(parameters, "num_items", -1, key)),
            discards_stale=discards_stale,
        )

    def _read_patterns(self, parameters: Mapping[str, Any], key: str) -> list[re.Pattern[str]]:
        patterns = (self._compile(text, f"{key}.regex") for text in _read_texts(parameters, "regex"))
        return [pattern for pattern in patterns if pattern is not None]

    def _compile(self, text: str, name: str) -> re.Pattern[str] | None:
        try:
            return re.compile(text)
        except re.error as error:
            problem = foreign(error)
            self.log_problem(
                phrase(
                    "parameter '{name}': '{text}' is not a regular expression: {problem}",
                    name=name,
                    text=text,
                    problem=problem,
                )
            )
            return None


def list_analyzer_keys(parameters: Mapping[str, Any]) -> set[str]:
    """Return the prefixes of the parameters of each analyzer: ``NAME`` or ``analyzers.NAME``."""
    keys = set()
    for name in parameters:
        start = _ANALYZERS if name.startswith(_ANALYZERS) else ""
        analyzer, dot, rest = name.removeprefix(start).partition(".")
        if dot and rest == "type":
            keys.add(start + analyzer)
    return keys


def _read_texts(parameters: Mapping[str, Any], name: str) -> list[str]:
    """Return the texts of a parameter that is a text or a list of texts."""
    value = parameters.get(name, ())
    return [value] if isinstance(value, str) else [str(text) for text in value]


def _read_number(parameters: Mapping[str, Any], name: str, default: float, key: str) -> float:
    """Return a number.

    Raises:
        _InvalidAnalyzerError: the parameter is not a number.
    """
    value = parameters.get(name, default)
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise _InvalidAnalyzerError(phrase("parameter '{name}' must be a number", name=f"{key}.{name}"))
    return float(value)
