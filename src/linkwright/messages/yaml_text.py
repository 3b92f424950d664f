"""Write messages as YAML that is identical to the output of ``ros2 topic echo``.

The format is PyYAML's, but PyYAML takes milliseconds for a message of a few hundred numbers, which is too slow for
/tf. Therefore this module writes the lines itself, from a plan for each class. It uses PyYAML only for strings, because
quoting is complicated, and caches the results.
"""

from __future__ import annotations

import sys
from array import array
from collections import OrderedDict
from collections.abc import Callable
from functools import lru_cache
from math import isfinite
from typing import Any

from linkwright.messages.checks import is_array
from linkwright.messages.conversion import ELLIPSIS, Abridgement, abbreviate, to_dict
from linkwright.messages.definitions.interfaces import Container, Field, FieldType
from linkwright.messages.message import Message, definition_of

_MAX_CACHED_LENGTH = 200


def to_yaml(
    message: Message,
    *,
    truncate_length: int | None = None,
    no_arr: bool = False,
    no_str: bool = False,
    flow_style: bool = False,
) -> str:
    """Return a message as YAML text.

    Args:
        message: the message to write.
        truncate_length: longer strings and lists are cut to this length and end with ``...``; None for no limit.
        no_arr: whether arrays and sequences are replaced by their type and length.
        no_str: whether strings are replaced by their length.
        flow_style: whether lists are written in brackets, and the messages in them in braces.
    """
    if flow_style:
        return _dump(to_dict(message, truncate_length=truncate_length, no_arr=no_arr, no_str=no_str), flow_style=True)
    lines: list[str] = []
    _Writer(Abridgement(truncate_length, no_arr, no_str), lines).message(message, "", ())
    return "".join(lines) or "{}\n"


class _Writer:
    """A writer that appends the YAML lines of one message to a list.

    A path describes the containers around a value: ``m`` for a mapping, ``s`` for a list.
    """

    def __init__(self, abridgement: Abridgement, lines: list[str]) -> None:
        self._abridgement = abridgement
        self._lines = lines

    def message(self, message: Message, indent: str, path: tuple[str, ...]) -> None:
        """Append the lines of a message's fields.

        Args:
            message: the message to write.
            indent: the indentation of each line.
            path: the path of the message: its containers, from the outermost.
        """
        path = (*path, "m")
        lines, append = self._lines, self._lines.append
        for key, slot, kind, format_number in _make_plan(type(message)):
            value = getattr(message, slot)
            if format_number is not None:
                append(f"{indent}{key}: {format_number(value)}\n")
            elif kind.container is not Container.ONE:
                append(f"{indent}{key}:")
                self._write_list(kind, value, indent, path)
            elif isinstance(value, Message):
                append(f"{indent}{key}:\n")
                line_count = len(lines)
                self.message(value, indent + "  ", path)
                if len(lines) == line_count:
                    lines[-1] = f"{indent}{key}: {{}}\n"
            else:
                append(f"{indent}{key}: {self._format_value(value, path)}\n")

    def _write_list(self, kind: FieldType, values: Any, indent: str, path: tuple[str, ...]) -> None:
        lines = self._lines
        if self._abridgement.no_arr:
            lines.append(f" {_format_scalar(abbreviate(kind, values))}\n")
            return
        if not len(values):
            lines.append(" []\n")
            return
        lines.append("\n")
        length = self._abridgement.truncate_length
        shown_values = values if length is None else list(values)[:length]
        bullet = indent + "- "
        format_number = _choose_number_format(kind)
        if format_number is not None:
            numbers = (
                shown_values.tolist() if isinstance(shown_values, array) or is_array(shown_values) else shown_values
            )
            lines.extend([f"{bullet}{format_number(item)}\n" for item in numbers])
        else:
            path = (*path, "s")
            for item in shown_values:
                self._write_item(item, indent, bullet, path)
        if len(shown_values) < len(values):
            lines.append(f"{bullet}'{ELLIPSIS}'\n")

    def _write_item(self, value: Any, indent: str, bullet: str, path: tuple[str, ...]) -> None:
        lines = self._lines
        if not isinstance(value, Message):
            lines.append(f"{bullet}{self._format_value(value, path)}\n")
            return
        first_line = len(lines)
        self.message(value, indent + "  ", path)
        if len(lines) > first_line:
            lines[first_line] = bullet + lines[first_line][len(bullet) :]
        else:
            lines.append(f"{bullet}{{}}\n")

    def _format_value(self, value: Any, path: tuple[str, ...]) -> str:
        text = (
            self._abridgement.cut(value.decode("latin-1"))
            if isinstance(value, bytes)
            else self._abridgement.text(value)
        )
        if len(text) <= _MAX_CACHED_LENGTH and text.isprintable():
            return _format_scalar(text)
        return _format_block_scalar(text, path)


_Step = tuple[str, str, FieldType, Callable[[Any], str] | None]
"""A field's key, slot and type, and the function that formats its value if this is a single number or bool."""

_plans: dict[str, list[_Step]] = {}


def _make_plan(cls: type[Message]) -> list[_Step]:
    """Return the cached steps that write the fields of a message class."""
    plan = _plans.get(cls.TYPE_NAME)
    if plan is None:
        plan = _plans[cls.TYPE_NAME] = [_make_step(field) for field in definition_of(cls).fields]
    return plan


def _make_step(field: Field) -> _Step:
    format_number = _choose_number_format(field.type) if field.type.container is Container.ONE else None
    return _format_scalar(field.name), "_" + field.name, field.type, format_number


def _choose_number_format(kind: FieldType) -> Callable[[Any], str] | None:
    """Return the function that formats numbers or bools of a type, or None for other types."""
    primitive = kind.primitive
    formatters: dict[type, Callable[[Any], str]] = {int: str, float: _format_float, bool: _format_bool}
    return None if primitive is None else formatters.get(primitive.python)


def _format_bool(value: object) -> str:
    return "true" if value else "false"


def _format_float(value: float) -> str:
    if not isfinite(value):
        return ".nan" if value != value else ".inf" if value > 0 else "-.inf"
    text = repr(float(value))
    # YAML 1.1 requires a decimal point in a number with an exponent.
    return text.replace("e", ".0e", 1) if "e" in text and "." not in text else text


@lru_cache(maxsize=8192)
def _format_scalar(text: str) -> str:
    """Format a single-line string as a value or a key."""
    return _dump({"k": text}, flow_style=False)[len("k: ") : -1]


def _format_block_scalar(text: str, path: tuple[str, ...]) -> str:
    """Format a multi-line string with the indentation for its path.

    To get this indentation, PyYAML formats the string inside containers of the same kinds.
    """
    marker = _dump(_nest("X", path), flow_style=False)
    return _dump(_nest(text, path), flow_style=False)[marker.index("X") : -1]


def _nest(text: str, path: tuple[str, ...]) -> Any:
    value: Any = text
    for container in reversed(path):
        value = [value] if container == "s" else {"k": value}
    return value


def _dump(data: Any, *, flow_style: bool) -> str:
    import yaml  # imported here because only programs that show messages need it

    class Dumper(yaml.SafeDumper):
        """PyYAML's dumper, except that it never writes the fields of a message in braces.

        As in rosidl_runtime_py, this does not depend on the style of lists.
        """

        def represent_fields(self, data: OrderedDict[str, Any]) -> yaml.MappingNode:
            items = [(self.represent_data(key), self.represent_data(value)) for key, value in data.items()]
            return yaml.MappingNode("tag:yaml.org,2002:map", items)

    Dumper.add_representer(OrderedDict, Dumper.represent_fields)
    text: str = yaml.dump(data, Dumper=Dumper, allow_unicode=True, width=sys.maxsize, default_flow_style=flow_style)
    return text
