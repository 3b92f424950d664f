"""Parameter files: YAML with node names and, below ``ros__parameters``, parameter values.

Files are read as by rcl_yaml_param_parser: nested names of namespaces and nodes, nested parameter names, its rules for
scalars (see `parse_scalar`), lists of a single type, no anchors. A file that rcl_yaml_param_parser would refuse is
refused here, too, with the position of the mistake. There is one exception: a parameter whose list contains lists or
mappings is omitted, because the files of real robots have such lists.

`format_parameter_file` returns the content of a file, as ``ros2 param dump`` writes it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from itertools import chain
from pathlib import Path
from typing import Any

from linkwright.diagnostics import (
    Diagnostic,
    LinkwrightError,
    Note,
    Phrase,
    Severity,
    SourceText,
    did_you_mean,
    display_path,
    foreign,
    phrase,
)
from linkwright.files.input_files import read_text
from linkwright.graph.parameters.parameter import ParameterFileNotFoundError, ParameterRules

PARAMETERS_KEY = "ros__parameters"
_TYPE_NAMES = {bool: "bool", int: "integer", float: "double", str: "string"}
_FORM_HINT = phrase(
    "write a mapping from node names to '{parameters_key}', and below it a mapping from parameter names to values",
    parameters_key=PARAMETERS_KEY,
)


def read_parameter_file(path: str | Path) -> ParameterRules:
    """Read a parameter file.

    Raises:
        ParameterFileNotFoundError: GRAPH211, the file does not exist.
        LinkwrightError: GRAPH211, the file cannot be read; GRAPH212, its content is not a parameter file.
    """
    path = Path(path)
    shown_path = display_path(path)
    try:
        text = read_text(path)
    except FileNotFoundError:
        candidates = [str(file) for file in path.parent.glob("*.y*ml")] if path.parent.is_dir() else []
        hint = did_you_mean(str(path), candidates)
        raise ParameterFileNotFoundError(
            Diagnostic("GRAPH211", phrase("parameter file '{path}' does not exist", path=shown_path), hint=hint)
        ) from None
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or error
        raise LinkwrightError(
            Diagnostic(
                "GRAPH211",
                phrase("parameter file '{path}' cannot be read: {reason}", path=shown_path, reason=foreign(reason)),
            )
        ) from error
    rules = parse_parameters(SourceText(str(path), text))
    rules.files.append(str(path))
    return rules


def parse_parameters(source: SourceText) -> ParameterRules:
    """Parse the text of a parameter file.

    A parameter whose list contains lists or mappings is left out, with a finding in `ParameterRules.skipped_findings`.

    Raises:
        LinkwrightError: GRAPH212, a mistake with its position.
    """
    return _Reader(source).read()


def parse_value(text: str, name: str) -> Any:
    """Parse a parameter value on the command line (``-p name:=value``).

    Args:
        text: the value: a scalar, or a list of one type.
        name: the parameter's name, for the error message.

    Raises:
        LinkwrightError: GRAPH212, the text is neither a scalar nor a list of one type.
    """
    return _Reader(SourceText(f"<{name}>", text)).read_value(name)


class _NestedListError(LinkwrightError):
    """Raised when a list contains lists or mappings."""


class _Reader:
    """A reader of the YAML events of a parameter file.

    `_event` is the current event.
    """

    def __init__(self, source: SourceText) -> None:
        self._source = source
        self._rules = ParameterRules()
        self._events = self._parse_events()

    def read(self) -> ParameterRules:
        self._advance()
        if self._is_event("StreamEnd"):
            return self._rules
        if self._is_event("Scalar") and not self._event.value:
            return self._rules
        if not self._is_event("MappingStart"):
            raise self._error(phrase("a parameter file must be a mapping"), _FORM_HINT)
        self._read_names(())
        return self._rules

    def read_value(self, name: str) -> Any:
        self._advance()
        if self._is_event("StreamEnd"):
            return ""
        if self._is_event("MappingStart"):
            raise self._error(
                phrase("the value of parameter '{name}' is a mapping", name=name),
                phrase("set each entry as a separate parameter, such as gains.p"),
            )
        if self._is_event("SequenceStart"):
            return self._read_list(name)
        return self._read_scalar(name)

    def _parse_events(self) -> Iterator[Any]:
        import yaml

        try:
            for event in yaml.parse(self._source.text, Loader=_import_loader_class()):
                if not isinstance(event, (yaml.StreamStartEvent, yaml.DocumentStartEvent, yaml.DocumentEndEvent)):
                    yield event
        except yaml.YAMLError as error:
            raise self._not_yaml_error(error) from error

    def _advance(self) -> None:
        self._event = next(self._events)
        if type(self._event).__name__ == "AliasEvent":
            raise self._error(
                phrase("aliases are not supported in parameter files"), phrase("write the value instead of the alias")
            )

    def _is_event(self, kind: str) -> bool:
        return type(self._event).__name__ == f"{kind}Event"

    def _read_names(self, parents: tuple[str, ...]) -> None:
        """Read a mapping of namespaces, node names and ``ros__parameters``.

        The current event is the start of the mapping.
        """
        self._advance()
        while not self._is_event("MappingEnd"):
            key = self._read_key()
            if key == PARAMETERS_KEY:
                if not parents:
                    raise self._error(
                        phrase("there is no node name above '{parameters_key}'", parameters_key=PARAMETERS_KEY),
                        _FORM_HINT,
                    )
                pattern = "/" + "/".join(parents)
                self._rules.section(pattern)
                self._advance()
                if self._is_event("MappingStart"):
                    self._read_parameters("", pattern)
                elif not (self._is_event("Scalar") and not self._event.value):
                    raise self._error(
                        phrase("'{parameters_key}' must be a mapping of names to values", parameters_key=PARAMETERS_KEY)
                    )
            else:
                tokens = tuple(part for part in key.split("/") if part)
                self._check_names(key, tokens)
                self._advance()
                if not self._is_event("MappingStart"):
                    raise self._error(
                        phrase(
                            "'{key}' has a value, but only parameters below '{parameters_key}' can have values",
                            key=key,
                            parameters_key=PARAMETERS_KEY,
                        ),
                        did_you_mean(key, [PARAMETERS_KEY])
                        or (did_you_mean(parents[-1], [PARAMETERS_KEY]) if parents else None)
                        or _FORM_HINT,
                    )
                self._read_names((*parents, *tokens))
            self._advance()

    def _read_parameters(self, prefix: str, pattern: str) -> None:
        """Read a mapping of parameter names.

        The current event is the start of the mapping.
        """
        self._advance()
        while not self._is_event("MappingEnd"):
            name = prefix + self._read_key()
            self._advance()
            if self._is_event("MappingStart"):
                self._read_parameters(f"{name}.", pattern)
            elif self._is_event("SequenceStart"):
                self._read_list_parameter(name, pattern)
            else:
                self._rules.set(pattern, name, self._read_scalar(name))
            self._advance()

    def _read_list_parameter(self, name: str, pattern: str) -> None:
        """Read a list and set the parameter to it.

        As in rcl, the entries of a mapping that is the only item, such as ``- interfaces: [...]`` of gpio_controllers,
        are parameters below the name. If the list contains other lists or mappings, the parameter is left out.
        """
        start, events = self._event, self._buffer_list()
        self._events = chain(events, self._events)
        if _is_mapping_of_lists([type(event).__name__.removesuffix("Event") for event in events]):
            self._advance()
            self._read_parameters(f"{name}.", pattern)
            self._advance()
            return
        self._event = start
        try:
            self._rules.set(pattern, name, self._read_list(name))
        except _NestedListError as error:
            (finding,) = error.diagnostics
            note = Note(phrase("the parameter is ignored"))
            warning = finding.with_changes(severity=Severity.WARNING, notes=(note,))
            self._rules.skipped_findings.append((pattern, warning))
            self._skip_rest_of_list()

    def _buffer_list(self) -> list[Any]:
        """Return the events after the start of a list, up to its end."""
        events: list[Any] = []
        depth = 1
        while depth:
            event = next(self._events)
            kind = type(event).__name__
            depth += (kind == "SequenceStartEvent") - (kind == "SequenceEndEvent")
            events.append(event)
        return events

    def _skip_rest_of_list(self) -> None:
        """Advance to the end of a list.

        The current event is the start of a nested list or mapping.
        """
        depth = 2
        while depth:
            self._advance()
            depth += self._is_event("SequenceStart") + self._is_event("MappingStart")
            depth -= self._is_event("SequenceEnd") + self._is_event("MappingEnd")

    def _read_key(self) -> str:
        if not self._is_event("Scalar"):
            raise self._error(phrase("a name must be a string, not a list or a mapping"))
        key = str(self._event.value)
        if not key:
            raise self._error(phrase("a name must not be empty"))
        return key

    def _read_scalar(self, name: str) -> Any:
        event = self._event
        is_plain = event.style not in ("'", '"') and event.tag != "tag:yaml.org,2002:str"
        if is_plain and not event.value:
            raise self._error(
                phrase("parameter '{name}' has no value", name=name), phrase('write "" for an empty string')
            )
        return parse_scalar(event.value, is_plain=is_plain)

    def _read_list(self, name: str) -> list[Any]:
        values: list[Any] = []
        self._advance()
        while not self._is_event("SequenceEnd"):
            if not self._is_event("Scalar"):
                message = (
                    phrase("the list of parameter '{name}' contains a list", name=name)
                    if self._is_event("SequenceStart")
                    else phrase("the list of parameter '{name}' contains a mapping", name=name)
                )
                error = self._error(message, phrase("write only plain values in a list"))
                raise _NestedListError(*error.diagnostics)
            value = self._read_scalar(name)
            if values and type(value) is not type(values[0]):
                first_type, other_type = _TYPE_NAMES[type(values[0])], _TYPE_NAMES[type(value)]
                raise self._error(
                    phrase(
                        "the list of parameter '{name}' begins with a value of type {first_type} but contains one "
                        "of type {other_type}",
                        name=name,
                        first_type=first_type,
                        other_type=other_type,
                    ),
                    _make_mixed_types_hint(values[0], value, self._event.value),
                )
            values.append(value)
            self._advance()
        return values

    def _check_names(self, key: str, tokens: tuple[str, ...]) -> None:
        for token in tokens:
            if token not in ("*", "**") and not re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", token):
                raise self._error(
                    phrase("'{key}' is not a node name", key=key),
                    phrase("use letters, digits and '_', and do not begin with a digit; * and ** match any name"),
                )
        if not tokens:
            raise self._error(phrase("'{key}' is not a node name", key=key), phrase("write /** for all nodes"))

    def _error(self, message: Phrase, hint: Phrase | None = None) -> LinkwrightError:
        mark = self._event.start_mark
        return self._error_at(mark.line, mark.column, message, hint)

    def _error_at(self, line: int, column: int, message: Phrase, hint: Phrase | None) -> LinkwrightError:
        source = self._source
        span = source.span(source.offset(line + 1, column + 1))
        return LinkwrightError(Diagnostic("GRAPH212", message, span, hint=hint, source=source))

    def _not_yaml_error(self, error: Exception) -> LinkwrightError:
        mark = getattr(error, "problem_mark", None)
        problem = getattr(error, "problem", None) or str(error)
        if mark is None:
            return LinkwrightError(
                Diagnostic("GRAPH212", phrase("parameter file is not YAML: {problem}", problem=foreign(problem)))
            )
        from linkwright.files.yaml_documents import yaml_hint

        hint = yaml_hint(self._source, mark.line + 1)
        return self._error_at(
            mark.line, mark.column, phrase("parameter file is not YAML: {problem}", problem=foreign(problem)), hint
        )


@lru_cache(maxsize=1)
def _import_loader_class() -> Any:
    import yaml

    return getattr(yaml, "CSafeLoader", yaml.SafeLoader)


def _make_mixed_types_hint(first: Any, value: Any, text: str) -> Phrase:
    if type(first) is float and type(value) is int:
        return phrase("write {text}.0", text=text)
    if type(first) is int and type(value) is float:
        return phrase("write the first value as {value}.0, or make all values integers", value=first)
    if type(first) is str:
        return phrase('write "{text}"', text=text)
    return phrase("all values of a list must be of one type")


_TRUE = frozenset({"Y", "y", "yes", "Yes", "YES", "true", "True", "TRUE", "on", "On", "ON"})
_FALSE = frozenset({"N", "n", "no", "No", "NO", "false", "False", "FALSE", "off", "Off", "OFF"})
_INTEGER = re.compile(r"\s*[+-]?(0[xX][0-9a-fA-F]+|0[0-7]*|[1-9][0-9]*)")
_FLOAT = re.compile(
    r"\s*[+-]?([0-9]+\.?[0-9]*([eE][+-]?[0-9]+)?|\.[0-9]+([eE][+-]?[0-9]+)?|inf(inity)?|nan)", re.IGNORECASE
)
_HEXADECIMAL_FLOAT = re.compile(r"\s*[+-]?0x[0-9a-f]*\.?[0-9a-f]*(p[+-]?[0-9]+)?", re.IGNORECASE)
_SPECIAL_FLOATS = {
    f"{sign}.{word}": f"{sign}{word}"
    for sign in ("", "+", "-")
    for word in ("inf", "Inf", "INF", "nan", "NaN", "NAN")
    if not (sign and word.lower() == "nan")
}
_MIN_INTEGER, _MAX_INTEGER = -(2**63), 2**63 - 1


def parse_scalar(text: str, *, is_plain: bool) -> Any:
    """Return the value of a YAML scalar by the rules of rcl_yaml_param_parser.

    The value is a bool, int, float or str. Booleans are those of YAML 1.1, including ``y`` and ``n``. A number is a
    text that C's ``strtol`` (any base) or ``strtod`` consumes entirely. Everything else, including quoted numbers,
    is a string.

    Args:
        text: the content of the scalar.
        is_plain: whether the scalar is written without quotes.
    """
    if not is_plain:
        return text
    if text in _TRUE:
        return True
    if text in _FALSE:
        return False
    if _INTEGER.fullmatch(text):
        number = _parse_integer(text.strip())
        if _MIN_INTEGER <= number <= _MAX_INTEGER:
            return number
    if text in _SPECIAL_FLOATS or _FLOAT.fullmatch(text):
        return float(_SPECIAL_FLOATS.get(text, text))
    if _HEXADECIMAL_FLOAT.fullmatch(text) and any(character.isdigit() for character in text):
        return _parse_hexadecimal_float(text)
    return text


def _parse_integer(text: str) -> int:
    digits = text.lstrip("+-")
    base = 16 if digits[:2] in ("0x", "0X") else 8 if digits.startswith("0") and digits != "0" else 10
    return int(text, base)


def _parse_hexadecimal_float(text: str) -> float | str:
    try:
        return float.fromhex(text.strip())
    except (ValueError, OverflowError):
        return text


def format_parameter_file(node: str, values: Mapping[str, Any]) -> str:
    """Return the YAML text of a parameter file for one node.

    Args:
        node: the node's full name.
        values: the values by parameter name, as plain Python data; see `plain_value`.
    """
    import yaml

    tree: dict[str, Any] = {}
    for name, value in values.items():
        _insert(tree, name.split("."), value)
    return yaml.dump({node: {"ros__parameters": tree}}, default_flow_style=False, allow_unicode=True)


def plain_value(value: Any) -> Any:
    """Convert an rcl_interfaces/msg/ParameterValue to plain Python data.

    Arrays become lists, and a value that is not set becomes None.
    """
    from linkwright.graph.parameters.parameter import parameter_value_to_python

    python_value = parameter_value_to_python(value)
    return (
        python_value
        if python_value is None or isinstance(python_value, (bool, int, float, str))
        else list(python_value)
    )


def _insert(tree: dict[str, Any], path: list[str], value: Any) -> None:
    """Insert a value into nested mappings, below the parts of its name.

    If a part already has a value that is not a mapping, the rest of the name keeps its dots.
    """
    for index, key in enumerate(path[:-1]):
        subtree = tree.setdefault(key, {})
        if not isinstance(subtree, dict):
            tree[".".join(path[index:])] = value
            return
        tree = subtree
    tree[path[-1]] = value


def _is_mapping_of_lists(kinds: Sequence[str]) -> bool:
    """Return whether the events of a list are those of one mapping from names to lists of plain values."""
    text = " ".join(kinds)
    return (
        re.fullmatch(r"MappingStart( Scalar SequenceStart( Scalar)* SequenceEnd)+ MappingEnd SequenceEnd", text)
        is not None
    )
