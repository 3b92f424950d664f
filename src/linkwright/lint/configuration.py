"""Settings from the nearest ``linkwright.toml`` or ``pyproject.toml`` above a file.

In ``pyproject.toml``, the settings are in ``[tool.linkwright]``. Mistakes in a configuration are reported with their
location. The rest of the configuration still applies.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator, Mapping
from functools import lru_cache
from importlib import import_module
from pathlib import Path

from linkwright.diagnostics import (
    Diagnostic,
    LinkwrightError,
    Phrase,
    Severity,
    SourceText,
    Span,
    did_you_mean,
    foreign,
    joined,
    phrase,
    quoted,
)
from linkwright.lint.option import Option, OptionValue
from linkwright.lint.registry import find_rule
from linkwright.lint.rule import Rule
from linkwright.lint.selector_words import is_selector, make_selector_hint, to_canonical
from linkwright.lint.settings import Settings
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_typing import Any
from linkwright.xmltree.decoding import decode
from linkwright.xmltree.reader import read_bytes
from linkwright.xmltree.style import Style

CONFIGURATION = "linkwright.toml"
_PROJECT_FILE = "pyproject.toml"
_PROJECT_TABLE = ("tool", "linkwright")
_SETTING_NAMES = ("select", "extend-select", "ignore", "severity", "per-file-ignores", "options", "arguments", "format")

_TABLE_HEADER = lazy_pattern(r"^[ \t]*\[(?!\[)([^\]\n]+)\]", re.MULTILINE)
_POSITION = lazy_pattern(r"\(at line (\d+), column (\d+)\)")
_TYPE_NAMES = {
    bool: phrase("true or false"),
    int: phrase("an integer"),
    float: phrase("a number"),
    str: phrase("a string"),
    list: phrase("a list of strings"),
}


def find_settings(path: Path) -> tuple[Settings, tuple[Diagnostic, ...]]:
    """Return the settings for a file or folder, and the findings about its configuration."""
    file = find_configuration(path)
    return (Settings(), ()) if file is None else read_settings(file)


def find_configuration(path: Path) -> Path | None:
    """Return the nearest configuration above a file or folder, or None if there is none.

    A ``linkwright.toml`` takes precedence over a ``pyproject.toml`` in the same folder.
    """
    start = path.absolute()
    for folder in (start, *start.parents):
        configuration = folder / CONFIGURATION
        if configuration.is_file():
            return configuration
        project = folder / _PROJECT_FILE
        if project.is_file() and _has_linkwright_table(project):
            return project
    return None


def read_settings(file: Path) -> tuple[Settings, tuple[Diagnostic, ...]]:
    """Return the settings of a configuration file, and the findings (LINT1##) about the file."""
    try:
        stamp = file.stat().st_mtime_ns
    except OSError:
        stamp = 0
    return _read_settings(file, stamp)


@lru_cache(maxsize=16)
def _read_settings(file: Path, _stamp: int) -> tuple[Settings, tuple[Diagnostic, ...]]:
    try:
        source = SourceText(str(file), decode(read_bytes(file), str(file)))
    except LinkwrightError as error:
        return Settings(), error.diagnostics
    # Imported here: most robots are checked without a configuration.
    tomllib: Any = import_module("tomllib" if sys.version_info >= (3, 11) else "tomli")
    try:
        document = tomllib.loads(source.text)
    except tomllib.TOMLDecodeError as error:
        return Settings(), (_make_syntax_error(source, error),)
    prefix = _PROJECT_TABLE if file.name == _PROJECT_FILE else ()
    table: Any = document
    for key in prefix:
        table = table.get(key, {}) if isinstance(table, dict) else {}
    reader = _Reader(source, prefix)
    return reader.settings(table, file.absolute().parent), tuple(reader.diagnostics)


def _has_linkwright_table(project: Path) -> bool:
    try:
        text = project.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return False
    return re.search(r"^[ \t]*\[+\s*tool\s*\.\s*linkwright\b", text, re.MULTILINE) is not None


def _make_syntax_error(source: SourceText, error: Exception) -> Diagnostic:
    message = str(error)
    position = _POSITION.search(message)
    start = source.offset(int(position[1]), int(position[2])) if position else len(source.text)
    reason = _POSITION.sub("", message).replace("(at end of document)", "").strip()
    return Diagnostic(
        "LINT101",
        phrase("this is not TOML: {reason}", reason=foreign(f"{reason[:1].lower()}{reason[1:]}")),
        source.span(start),
        hint=phrase('write a string in quotes, a number, true, false, or a list, such as ignore = ["LW204"]'),
        source=source,
    )


class _Reader:
    """A reader that converts a TOML table to settings and collects findings in `diagnostics`."""

    def __init__(self, source: SourceText, prefix: tuple[str, ...]) -> None:
        self._source = source
        self._prefix = prefix
        self.diagnostics: list[Diagnostic] = []

    def settings(self, table: Any, folder: Path) -> Settings:
        if not isinstance(table, dict):
            self._report_invalid(
                ("linkwright",), phrase("is not a table"), phrase("write [tool.linkwright] above the settings")
            )
            return Settings(folder=folder)
        for key in table:
            if key not in _SETTING_NAMES:
                hint = did_you_mean(key, _SETTING_NAMES) or phrase(
                    "the settings are {keys}", keys=joined(_SETTING_NAMES)
                )
                self._add_finding("LINT102", phrase("there is no setting '{key}'", key=key), (key,), hint)
        select = table.get("select")
        return Settings(
            None if select is None else self._read_selectors(("select",), select),
            self._read_selectors(("extend-select",), table.get("extend-select", [])),
            self._read_selectors(("ignore",), table.get("ignore", [])),
            dict(self._read_severities(self._check_table("severity", table))),
            tuple(self._read_per_file_ignores(self._check_table("per-file-ignores", table))),
            dict(self._read_options(self._check_table("options", table))),
            folder,
            tuple(self._read_arguments(self._check_table("arguments", table))),
            Style(**dict(self._read_style_settings(self._check_table("format", table)))),
        )

    def _check_table(self, key: str, table: Mapping[str, Any]) -> Mapping[str, Any]:
        value = table.get(key, {})
        if isinstance(value, dict):
            return value
        self._report_invalid(
            (key,), phrase("is not a table"), phrase("write [{value}]", value=".".join((*self._prefix, key)))
        )
        return {}

    def _read_selectors(self, path: tuple[str, ...], value: Any) -> tuple[str, ...]:
        if not isinstance(value, list) or not all(isinstance(item, str) for item in value):
            self._report_invalid(
                path,
                phrase("is not a list of strings"),
                phrase('write {key} = ["LW204", "limit-inverted"]', key=_to_toml_key(path[-1])),
            )
            return ()
        return tuple(selector for item in value if (selector := self._read_selector(path, item, item)))

    def _read_selector(self, path: tuple[str, ...], selector: str, value_text: str) -> str | None:
        if is_selector(selector):
            return to_canonical(selector)
        self._add_finding(
            "LINT104",
            phrase("there is no rule '{rule}'", rule=selector),
            path,
            make_selector_hint(selector),
            value_text=value_text,
        )
        return None

    def _read_severities(self, table: Mapping[str, Any]) -> Iterator[tuple[str, Severity]]:
        severity_names = [severity.value for severity in Severity]
        for key, value in table.items():
            path = ("severity", key)
            selector = self._read_selector(path, key, key)
            if value not in severity_names:
                hint = did_you_mean(str(value), severity_names) or phrase(
                    "use one of {values}; to silence a rule, use ignore", values=joined(severity_names)
                )
                self._report_invalid(path, phrase("is not a severity"), hint, shown=value)
            elif selector:
                yield selector, Severity(value)

    def _read_per_file_ignores(self, table: Mapping[str, Any]) -> Iterator[tuple[str, tuple[str, ...]]]:
        for pattern, value in table.items():
            yield pattern, self._read_selectors(("per-file-ignores", pattern), value)

    def _read_arguments(self, table: Mapping[str, Any]) -> Iterator[tuple[str, tuple[Mapping[str, str], ...]]]:
        for pattern, value in table.items():
            sets = value if isinstance(value, list) else [value]
            if all(isinstance(item, dict) and all(map(_is_scalar, item.values())) for item in sets):
                yield pattern, tuple({name: _to_argument(item[name]) for name in item} for item in sets)
            else:
                self._report_invalid(
                    ("arguments", pattern),
                    phrase("is neither a set of values nor a list of sets"),
                    phrase('write {key} = [{{ prefix = "left_" }}, {{ prefix = "right_" }}]', key=f'"{pattern}"'),
                )

    def _read_style_settings(self, table: Mapping[str, Any]) -> Iterator[tuple[str, int]]:
        for key, value in table.items():
            path = ("format", key)
            if key not in Style._fields:
                hint = did_you_mean(key, Style._fields) or phrase("the settings are {keys}", keys=joined(Style._fields))
                self._add_finding("LINT102", phrase("there is no setting '{key}'", key=key), path, hint)
            elif type(value) is not int or value < 1:
                self._report_invalid(
                    path, phrase("is not a positive integer"), phrase("write {key} = 2", key=key), shown=value
                )
            else:
                yield key, value

    def _read_options(self, table: Mapping[str, Any]) -> Iterator[tuple[str, Mapping[str, OptionValue]]]:
        for key, value in table.items():
            rule = find_rule(key)
            if rule is None:
                self._add_finding(
                    "LINT104", phrase("there is no rule '{rule}'", rule=key), ("options", key), make_selector_hint(key)
                )
            elif not isinstance(value, dict):
                self._report_invalid(
                    ("options", key), phrase("is not a table"), phrase("write [options.{key}]", key=key)
                )
            else:
                yield rule.name, dict(self._read_rule_options(rule, key, value))

    def _read_rule_options(self, rule: Rule, key: str, table: Mapping[str, Any]) -> Iterator[tuple[str, OptionValue]]:
        options = {option.name: option for option in rule.options}
        for name, value in table.items():
            path = ("options", key, name)
            option = options.get(name)
            if option is None:
                hint = did_you_mean(name, options) or (
                    phrase("its options are {known}", known=joined(options))
                    if options
                    else phrase("{code} has no options", code=rule.code)
                )
                self._add_finding(
                    "LINT102",
                    phrase("rule '{name}' has no option '{other_name}'", name=rule.name, other_name=name),
                    path,
                    hint,
                )
            elif not _has_option_type(option, value):
                from linkwright.lint.explain import to_toml

                self._report_invalid(
                    path,
                    phrase("is not {kind}", kind=_TYPE_NAMES[type(option.default)]),
                    phrase("the default is {toml}", toml=to_toml(option.default)),
                )
            else:
                yield name, value

    def _report_invalid(self, path: tuple[str, ...], problem: Phrase, hint: Phrase, *, shown: object = None) -> None:
        message = phrase("'{key}' {problem}", key=path[-1], problem=problem)
        if shown is not None:
            message = joined([message, quoted(shown)], ": ")
        self._add_finding("LINT103", message, path, hint)

    def _add_finding(
        self, code: str, message: Phrase, path: tuple[str, ...], hint: Phrase, *, value_text: str | None = None
    ) -> None:
        span = _locate(self._source, (*self._prefix, *path), value_text)
        self.diagnostics.append(Diagnostic(code, message, span, hint=hint, source=self._source))


def _has_option_type(option: Option, value: object) -> bool:
    kind = type(option.default)
    if kind is float:
        return isinstance(value, (int, float)) and not isinstance(value, bool)
    if kind is list:
        return isinstance(value, list) and all(isinstance(item, str) for item in value)
    return isinstance(value, kind) and isinstance(value, bool) == (kind is bool)


def _is_scalar(value: object) -> bool:
    """Return whether an argument accepts a TOML value: a string, number or boolean."""
    return isinstance(value, (str, int, float))


def _to_argument(value: str | float) -> str:
    """Return a TOML value as a user writes it on a command line."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def _to_toml_key(key: str) -> str:
    return key if re.fullmatch(r"[\w-]+", key) else f'"{key}"'


def _locate(source: SourceText, path: tuple[str, ...], value_text: str | None) -> Span:
    """Return the location of a key, or of the text `value_text` in the value of the key.

    The source is searched because tomllib stores no positions. If nothing is found, the result is the start of the
    file.
    """
    tables: list[tuple[tuple[str, ...], int, int]] = []
    headers = list(_TABLE_HEADER.finditer(source.text))
    ends = [header.start() for header in headers] + [len(source.text)]
    tables.append(((), 0, ends[0]))
    tables += [(_parse_header(header[1]), header.start(1), end) for header, end in zip(headers, ends[1:], strict=True)]
    for name, start, end in sorted(tables, key=lambda table: -len(table[0])):
        remaining_keys = path[len(name) :]
        if name != path[: len(name)]:
            continue
        if not remaining_keys:
            key_start = source.text.rindex(path[-1], start, source.text.index("]", start))
            return source.span(key_start, key_start + len(path[-1]))
        key_range = _find_key(source.text, start, end, remaining_keys)
        if key_range is None:
            continue
        if value_text is not None and value_text != path[-1]:
            quoted_match = re.compile(rf"""["']({re.escape(value_text)})["']""").search(source.text, key_range[1], end)
            if quoted_match:
                return source.span(*quoted_match.span(1))
        return source.span(*key_range)
    return source.span(0)


def _find_key(text: str, start: int, end: int, keys: tuple[str, ...]) -> tuple[int, int] | None:
    """Return the character range of a plain, dotted or inline key, or None if it is not found."""
    offset, key_range = start, None
    for index, key in enumerate(keys):
        prefix = r"[.{,=][ \t]*\{?" if index else "^"
        pattern = re.compile(rf"""{prefix}[ \t]*(["']?)({re.escape(key)})\1(?=[ \t]*[=.])""", re.MULTILINE)
        match = pattern.search(text, offset, end)
        if match is None:
            return None
        key_range = match.span(2)
        offset = match.end(2)
    return key_range


def _parse_header(header: str) -> tuple[str, ...]:
    return tuple(match[2] or match[3] for match in re.finditer(r"""(["'])(.*?)\1|([\w-]+)""", header))
