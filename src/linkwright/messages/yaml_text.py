"""Writes messages as YAML, character for character as ``ros2 topic echo`` shows them.

The format is PyYAML's, but PyYAML takes milliseconds for a message of a few hundred numbers, too slow to follow /tf.
Therefore the lines are written here, from a plan for each class. PyYAML is used only for strings, whose quoting is
complicated, and its results are cached.
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
from linkwright.messages.conversion import CUT, Abridgement, abbreviated, to_dict
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
        message: any message.
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
    """Writes one message.

    A path names the containers around a value: ``m`` for a mapping, ``s`` for a list.
    """

    def __init__(self, shown: Abridgement, lines: list[str]) -> None:
        self._shown = shown
        self._lines = lines

    def message(self, message: Message, indent: str, way: tuple[str, ...]) -> None:
        """Write the lines of a message's fields, with an indentation.

        Args:
            message: the message.
            indent: the indentation of each line.
            way: the path of the message.
        """
        way = (*way, "m")
        lines, append = self._lines, self._lines.append
        for key, slot, kind, number in _plan(type(message)):
            value = getattr(message, slot)
            if number is not None:
                append(f"{indent}{key}: {number(value)}\n")
            elif kind.container is not Container.ONE:
                append(f"{indent}{key}:")
                self._list(kind, value, indent, way)
            elif isinstance(value, Message):
                append(f"{indent}{key}:\n")
                before = len(lines)
                self.message(value, indent + "  ", way)
                if len(lines) == before:
                    lines[-1] = f"{indent}{key}: {{}}\n"
            else:
                append(f"{indent}{key}: {self._text(value, way)}\n")

    def _list(self, kind: FieldType, values: Any, indent: str, way: tuple[str, ...]) -> None:
        lines = self._lines
        if self._shown.no_arr:
            lines.append(f" {_scalar(abbreviated(kind, values))}\n")
            return
        if not len(values):
            lines.append(" []\n")
            return
        lines.append("\n")
        length = self._shown.truncate_length
        shown = values if length is None else list(values)[:length]
        bullet = indent + "- "
        number = _number_text(kind)
        if number is not None:
            numbers = shown.tolist() if isinstance(shown, array) or is_array(shown) else shown
            lines.extend([f"{bullet}{number(item)}\n" for item in numbers])
        else:
            way = (*way, "s")
            for item in shown:
                self._item(item, indent, bullet, way)
        if len(shown) < len(values):
            lines.append(f"{bullet}'{CUT}'\n")

    def _item(self, value: Any, indent: str, bullet: str, way: tuple[str, ...]) -> None:
        lines = self._lines
        if not isinstance(value, Message):
            lines.append(f"{bullet}{self._text(value, way)}\n")
            return
        first = len(lines)
        self.message(value, indent + "  ", way)
        if len(lines) > first:
            lines[first] = bullet + lines[first][len(bullet) :]
        else:
            lines.append(f"{bullet}{{}}\n")

    def _text(self, value: Any, way: tuple[str, ...]) -> str:
        text = self._shown.cut(value.decode("latin-1")) if isinstance(value, bytes) else self._shown.text(value)
        if len(text) <= _MAX_CACHED_LENGTH and text.isprintable():
            return _scalar(text)
        return _block_scalar(text, way)


_Step = tuple[str, str, FieldType, Callable[[Any], str] | None]
"""For a field its key, its slot, its type, and the function that writes it if it is a plain number."""

_plans: dict[str, list[_Step]] = {}


def _plan(cls: type[Message]) -> list[_Step]:
    """Return the steps that write the fields of a message class."""
    plan = _plans.get(cls.TYPE_NAME)
    if plan is None:
        plan = _plans[cls.TYPE_NAME] = [_step(field) for field in definition_of(cls).fields]
    return plan


def _step(field: Field) -> _Step:
    number = _number_text(field.type) if field.type.container is Container.ONE else None
    return _scalar(field.name), "_" + field.name, field.type, number


def _number_text(kind: FieldType) -> Callable[[Any], str] | None:
    """Return the function that formats a number of a type; None if values need further tests."""
    primitive = kind.primitive
    writers: dict[type, Callable[[Any], str]] = {int: str, float: _float_text, bool: _bool_text}
    return None if primitive is None else writers.get(primitive.python)


def _bool_text(value: object) -> str:
    return "true" if value else "false"


def _float_text(value: float) -> str:
    if not isfinite(value):
        return ".nan" if value != value else ".inf" if value > 0 else "-.inf"
    text = repr(float(value))
    # YAML 1.1 requires a decimal point in a number with an exponent.
    return text.replace("e", ".0e", 1) if "e" in text and "." not in text else text


@lru_cache(maxsize=8192)
def _scalar(text: str) -> str:
    """Format a single-line string as a value or a key."""
    return _dump({"k": text}, flow_style=False)[len("k: ") : -1]


def _block_scalar(text: str, way: tuple[str, ...]) -> str:
    """Format a multi-line string, whose indentation depends on its path.

    PyYAML formats the string inside containers of the same kinds.
    """
    marker = _dump(_wrapped("X", way), flow_style=False)
    return _dump(_wrapped(text, way), flow_style=False)[marker.index("X") : -1]


def _wrapped(text: str, way: tuple[str, ...]) -> Any:
    value: Any = text
    for container in reversed(way):
        value = [value] if container == "s" else {"k": value}
    return value


def _dump(data: Any, *, flow_style: bool) -> str:
    import yaml  # imported here because only programs that show messages need it

    class Dumper(yaml.SafeDumper):
        """PyYAML's dumper, except that the fields of a message are never in braces.

        As in rosidl_runtime_py, this does not depend on the style of lists.
        """

        def represent_fields(self, data: OrderedDict[str, Any]) -> yaml.MappingNode:
            items = [(self.represent_data(key), self.represent_data(value)) for key, value in data.items()]
            return yaml.MappingNode("tag:yaml.org,2002:map", items)

    Dumper.add_representer(OrderedDict, Dumper.represent_fields)
    text: str = yaml.dump(data, Dumper=Dumper, allow_unicode=True, width=sys.maxsize, default_flow_style=flow_style)
    return text
