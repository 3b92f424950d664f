"""Parse interface files, with their constants and default values."""

from __future__ import annotations

import math
import re
from typing import Protocol, cast

from linkwright.diagnostics import Diagnostic, Phrase, SourceText, counted, did_you_mean, phrase
from linkwright.messages.definitions.interfaces import (
    PRIMITIVES,
    Constant,
    Container,
    Definition,
    Field,
    FieldType,
    Primitive,
    Structure,
    build_interface,
    is_constant_name,
    is_field_name,
    is_interface_name,
    is_package_name,
    is_ros1_name,
)
from linkwright.messages.errors import DefinitionError

Value = bool | int | float | str | bytes

_ITEM_PATTERN = re.compile(r"""\s*("(?:\\.|[^"\\])*"|'(?:\\.|[^'\\])*'|[^,]*?)\s*(?:,|$)""")
_ESCAPE_PATTERN = re.compile(r"\\(.)")
_ESCAPED_CHARACTERS = {"n": "\n", "t": "\t", "r": "\r", "0": "\0", "\\": "\\", '"': '"', "'": "'"}


class LiteralError(Exception):
    """Raised when a text is not valid for a type. The argument is the reason."""


def read_default(text: str, kind: FieldType) -> object:
    """Parse the default value of a field: one value, or a tuple of values.

    Raises:
        LiteralError: the text is not a value of the type.
    """
    primitive = kind.primitive
    if primitive is None:
        raise LiteralError(
            phrase("a field of type '{type_name}' cannot have a default value", type_name=kind.to_msg_text())
        )
    if kind.container is Container.ONE:
        return _read_bounded(text, kind, primitive)
    if not (text.startswith("[") and text.endswith("]")):
        raise LiteralError(
            phrase("write the default of '{type_name}' as a list in square brackets", type_name=kind.to_msg_text())
        )
    values = tuple(_read_bounded(item, kind, primitive) for item in split_list(text[1:-1]))
    if kind.container is Container.ARRAY and len(values) != kind.size:
        raise LiteralError(
            phrase(
                "'{type_name}' must have {size} values, not {count}",
                type_name=kind.to_msg_text(),
                size=kind.size,
                count=len(values),
            )
        )
    if kind.container is Container.SEQUENCE and kind.size is not None and len(values) > kind.size:
        raise LiteralError(
            phrase(
                "'{type_name}' must have at most {size} values, not {count}",
                type_name=kind.to_msg_text(),
                size=kind.size,
                count=len(values),
            )
        )
    return values


def read_constant(text: str, type_name: str) -> Value:
    """Parse the value of a constant.

    Raises:
        LiteralError: the text is not a value of the type.
    """
    return _read(text, type_name, PRIMITIVES[type_name])


def split_list(text: str) -> list[str]:
    """Split a list at its commas, except commas inside quotes."""
    items: list[str] = []
    position = 0
    while position < len(text):
        match = _ITEM_PATTERN.match(text, position)
        if match is None:  # An unclosed quote: the rest is one item.
            items.append(text[position:].strip())
            break
        items.append(match.group(1))
        position = match.end()
    if items and not items[-1] and len(items) > 1:  # a trailing comma
        items.pop()
    return items


def _read_bounded(text: str, kind: FieldType, primitive: Primitive) -> Value:
    value = _read(text, kind.base, primitive)
    if kind.string_bound is not None and len(cast(str, value)) > kind.string_bound:
        raise LiteralError(
            phrase("the string is longer than {string_bound} characters", string_bound=kind.string_bound)
        )
    return value


def _read(text: str, type_name: str, primitive: Primitive) -> Value:
    if primitive.python is str:
        return _read_text(text)
    if primitive.python is bool:
        return _read_bool(text)
    if primitive.python is float:
        return _read_float(text, type_name, primitive)
    number = _read_int(text)
    low, high = (0, 255) if primitive.python is bytes else (primitive.low, primitive.high)
    if not low <= number <= high:
        raise LiteralError(
            phrase(
                "{value} is outside the range of {type_name}, {minimum} to {maximum}",
                value=text,
                type_name=type_name,
                minimum=low,
                maximum=high,
            )
        )
    return bytes([number]) if primitive.python is bytes else number


def _read_bool(text: str) -> bool:
    lower_text = text.lower()
    if lower_text in {"true", "1"}:
        return True
    if lower_text in {"false", "0"}:
        return False
    raise LiteralError(phrase("'{text}' is neither true nor false", text=text))


def _read_int(text: str) -> int:
    digits = text.lstrip("+-")
    try:
        return int(text, 0 if digits[:1] == "0" and digits[1:2] in {"x", "X", "o", "O", "b", "B"} else 10)
    except ValueError:
        raise LiteralError(phrase("'{text}' is not an integer", text=text)) from None


def _read_float(text: str, type_name: str, primitive: Primitive) -> float:
    try:
        number = float(text)
    except ValueError:
        raise LiteralError(phrase("'{text}' is not a number", text=text)) from None
    if math.isfinite(number) and abs(number) > primitive.high:
        raise LiteralError(phrase("{value} is outside the range of {type_name}", value=text, type_name=type_name))
    return number


def _read_text(text: str) -> str:
    quote = text[:1]
    if quote not in {'"', "'"}:
        return text
    if len(text) < 2 or not text.endswith(quote) or _closes_early(text, quote):
        raise LiteralError(phrase("the string that begins with {quote} does not end with it", quote=quote))
    return _ESCAPE_PATTERN.sub(lambda match: _ESCAPED_CHARACTERS.get(match.group(1), match.group(0)), text[1:-1])


def _closes_early(text: str, quote: str) -> bool:
    content = re.sub(r"\\.", "  ", text[1:-1])
    return quote in content or content.endswith("\\")


SEPARATOR = "---"
SECTIONS = {"msg": ("",), "srv": ("_Request", "_Response"), "action": ("_Goal", "_Result", "_Feedback")}
"""The suffixes of the names of the structures in a file of each kind."""

_LINE_PATTERN = re.compile(
    r"""(?P<base>[A-Za-z_][\w/]*) (?P<bound>[ ]*<=[ ]*(?P<string_bound>[^\s\[\]]*))?
        (?P<container>\[[^\]]*\])? (?P<gap>\s+) (?P<name>[^\s=]+) \s* (?P<rest>.*)""",
    re.VERBOSE | re.DOTALL,
)
_ROS1_TYPES = {
    "time": "builtin_interfaces/Time",
    "duration": "builtin_interfaces/Duration",
    "Header": "std_msgs/Header",
}

_EXTRA_PART_HINTS = {
    1: phrase("write requests and responses in a .srv file"),
    2: phrase("write goals in a .action file"),
}


class _Section:
    """The fields and constants of a structure during parsing."""

    def __init__(self) -> None:
        self.fields: list[Field] = []
        self.constants: list[Constant] = []
        self.names: set[str] = set()


class KnownMessages(Protocol):
    """The interface of objects that determine which messages exist."""

    def has_message(self, type_name: str) -> bool:
        """Return whether a message with a full name exists."""

    def find_hint(self, type_name: str) -> Phrase | None:
        """Return a hint with names that resemble a missing message's name, or None."""


def parse_interface(
    source: SourceText, type_name: str, known_messages: KnownMessages, *, is_ros1: bool = False
) -> Definition:
    """Parse an interface file.

    Args:
        source: the content of the file.
        type_name: the name of the interface, such as ``my_msgs/srv/Count``.
        known_messages: determines which messages exist, to check references.
        is_ros1: whether to read the file as ROS 1 does. Its field names may contain capital letters, the names of its
            types may begin with lower-case letters, and it may use the types ``time``, ``duration`` and ``Header``.
            These become the types of ROS 2 with the same fields.

    Raises:
        DefinitionError: the file has mistakes; the error contains all of them (MSG110 to MSG119).
    """
    return _Reader(source, type_name, known_messages, is_ros1=is_ros1).read()


class _Reader:
    def __init__(self, source: SourceText, type_name: str, known_messages: KnownMessages, *, is_ros1: bool) -> None:
        self._source = source
        self._is_ros1 = is_ros1
        self._type_name = type_name
        self._package, self._kind, _ = type_name.split("/")
        self._known = known_messages
        self._diagnostics: list[Diagnostic] = []

    def read(self) -> Definition:
        sections = [_Section()]
        offset = 0
        for line in self._source.text.splitlines(keepends=True):
            code = _remove_comment(line)
            start = offset + len(code) - len(code.lstrip())
            offset += len(line)
            code = code.strip()
            if code == SEPARATOR:
                sections.append(_Section())
                self._check_sections(len(sections), start)
            elif code:
                self._read_line(code, start, sections[-1])
        suffixes = SECTIONS[self._kind]
        if len(sections) < len(suffixes):
            self._report(
                "MSG118",
                phrase(
                    "a .{kind} file has {count} parts with '---' between them, but this file has {other_count}",
                    kind=self._kind,
                    count=len(suffixes),
                    other_count=len(sections),
                ),
                offset,
                0,
            )
        if self._diagnostics:
            raise DefinitionError(*self._diagnostics)
        structures = [
            Structure(self._type_name + suffix, tuple(section.fields), tuple(section.constants))
            for suffix, section in zip(suffixes, sections, strict=True)
        ]
        return build_interface(self._type_name, structures)

    def _check_sections(self, count: int, start: int) -> None:
        section_count = len(SECTIONS[self._kind])
        if count == section_count + 1:
            self._report(
                "MSG118",
                counted(
                    "a .{kind} file has {count} part, but this '---' begins another",
                    "a .{kind} file has {count} parts, but this '---' begins another",
                    section_count,
                    kind=self._kind,
                ),
                start,
                3,
                _EXTRA_PART_HINTS.get(section_count),
            )

    def _read_line(self, code: str, start: int, section: _Section) -> None:
        match = _LINE_PATTERN.fullmatch(code)
        if match is None:
            self._report(
                "MSG110",
                phrase("'{code}' is neither a field ('TYPE name') nor a constant ('TYPE NAME=value')", code=code),
                start,
                len(code),
            )
            return
        kind = self._read_type(match, start)
        name, rest = match["name"], match["rest"]
        name_offset = start + match.start("name")
        if rest.startswith("="):
            self._add_constant(section, kind, name, name_offset, rest[1:].strip(), start + match.start("rest"))
        else:
            self._add_field(section, kind, name, name_offset, rest, start + match.start("rest"))

    # --- types ----------------------------------------------------------------------------------------------

    def _read_type(self, match: re.Match[str], start: int) -> FieldType | None:
        base = self._read_base(match["base"], start)
        container, size = Container.ONE, None
        string_bound = None
        is_valid = base is not None
        if match["bound"] is not None:
            string_bound = self._read_number(
                match["string_bound"], start + match.start("string_bound"), phrase("a string")
            )
            is_valid = is_valid and string_bound is not None
            if base is not None and base not in {"string", "wstring"}:
                hint = phrase(
                    "write a bounded sequence as '{base}[<={string_bound}]'",
                    base=match["base"],
                    string_bound=match["string_bound"],
                )
                self._report(
                    "MSG119",
                    phrase("only strings can have a length bound, and '{base}' is not a string", base=match["base"]),
                    start,
                    len(match["base"]),
                    hint,
                )
                is_valid = False
        brackets = match["container"]
        if brackets is not None:
            length_text, length_offset = brackets[1:-1].strip(), start + match.start("container") + 1
            container = Container.SEQUENCE if not length_text or length_text.startswith("<=") else Container.ARRAY
            if length_text:
                container_name = phrase("an array") if container is Container.ARRAY else phrase("a sequence")
                number = length_text.removeprefix("<=").lstrip()
                size = self._read_number(
                    number,
                    length_offset + brackets[1:].index(length_text) + len(length_text) - len(number),
                    container_name,
                )
                is_valid = is_valid and size is not None
        return FieldType(base, string_bound, container, size) if is_valid and base is not None else None

    def _read_base(self, text: str, start: int) -> str | None:
        if text in PRIMITIVES:
            return text
        if "/" in text:
            parts = text.split("/")
            if len(parts) == 3 and parts[1] == "msg":
                parts.pop(1)
            if len(parts) == 2 and is_package_name(parts[0]) and self._is_message_name(parts[1]):
                return self._find_existing_message(f"{parts[0]}/msg/{parts[1]}", text, start)
            self._report(
                "MSG111",
                phrase("'{text}' is not a type: write 'package/Name' for a type of another package", text=text),
                start,
                len(text),
            )
            return None
        type_name = f"{self._package}/msg/{text}"
        if self._is_ros1 and text in _ROS1_TYPES:
            return _ROS1_TYPES[text].replace("/", "/msg/")
        if text in _ROS1_TYPES and not self._known.has_message(type_name):
            self._report("MSG117", phrase("the type '{text}' is a ROS 1 type", text=text), start, len(text),
                         phrase("use {name} in ROS 2", name=f"'{_ROS1_TYPES[text]}'"))  # fmt: skip
            return None
        if self._is_message_name(text) and (is_interface_name(text) or self._known.has_message(type_name)):
            return self._find_existing_message(type_name, text, start)
        self._report(
            "MSG111", phrase("there is no type '{text}'", text=text), start, len(text), did_you_mean(text, PRIMITIVES)
        )
        return None

    def _is_message_name(self, text: str) -> bool:
        return is_interface_name(text) or (self._is_ros1 and is_ros1_name(text))

    def _find_existing_message(self, type_name: str, text: str, start: int) -> str | None:
        if self._known.has_message(type_name):
            return type_name
        hint = self._known.find_hint(type_name)
        self._report("MSG111", phrase("there is no message '{name}'", name=type_name), start, len(text), hint)
        return None

    def _read_number(self, text: str, offset: int, subject: Phrase) -> int | None:
        if text.isascii() and text.isdigit() and int(text) > 0:
            return int(text)
        self._report(
            "MSG119",
            phrase(
                "'{value}' is not a valid length of {subject}: write an integer above 0", value=text, subject=subject
            ),
            offset,
            max(len(text), 1),
        )
        return None

    # --- fields and constants -------------------------------------------------------------------------------

    def _add_field(
        self, section: _Section, kind: FieldType | None, name: str, name_offset: int, default: str, default_offset: int
    ) -> None:
        if not (is_field_name(name) or (self._is_ros1 and name.isidentifier())):
            hint = phrase("field names are lower case with single underscores")
            suggested_name = re.sub(r"_+", "_", re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()).strip("_")
            if is_field_name(suggested_name):
                hint = phrase(
                    "field names are lower case with single underscores, such as '{suggestion}'",
                    suggestion=suggested_name,
                )
            self._report(
                "MSG112", phrase("'{name}' is not a valid name for a field", name=name), name_offset, len(name), hint
            )
            return
        if not self._is_new(section, name, name_offset) or kind is None:
            return
        value = None
        if default:
            try:
                value = read_default(default, kind)
            except LiteralError as fault:
                self._report(
                    "MSG114",
                    phrase("the default value of '{name}' is invalid: {fault}", name=name, fault=fault),
                    default_offset,
                    len(default),
                )
                return
        section.fields.append(Field(name, kind, value))

    def _add_constant(
        self, section: _Section, kind: FieldType | None, name: str, name_offset: int, value: str, value_offset: int
    ) -> None:
        if not is_constant_name(name):
            hint = phrase("constants are upper case with single underscores")
            if is_field_name(name):
                hint = phrase(
                    "constants are upper case with single underscores;"
                    " the default value of a field is written without '='"
                )
            self._report(
                "MSG113", phrase("'{name}' is not a valid name for a constant", name=name), name_offset, len(name), hint
            )
            return
        if not self._is_new(section, name, name_offset) or kind is None:
            return
        if kind.primitive is None or kind.container is not Container.ONE:
            self._report(
                "MSG114",
                phrase(
                    "the constant '{name}' cannot be of type '{type_name}'",
                    name=name,
                    type_name=kind.to_msg_text(self._package),
                ),
                name_offset,
                len(name),
                phrase("constants must be numbers, bools or strings"),
            )
            return
        try:
            section.constants.append(Constant(name, kind.base, read_constant(value, kind.base)))
        except LiteralError as fault:
            self._report(
                "MSG114",
                phrase("the value of '{name}' is invalid: {fault}", name=name, fault=fault),
                value_offset,
                max(len(value), 1),
            )

    def _is_new(self, section: _Section, name: str, name_offset: int) -> bool:
        if name in section.names:
            self._report("MSG115", phrase("the name '{name}' is used twice", name=name), name_offset, len(name))
            return False
        section.names.add(name)
        return True

    def _report(self, code: str, message: Phrase, start: int, length: int, hint: Phrase | None = None) -> None:
        span = self._source.span(start, start + length)
        self._diagnostics.append(Diagnostic(code, message, span, hint=hint, source=self._source))


def _remove_comment(line: str) -> str:
    """Return a line without its comment.

    A ``#`` inside quotes does not begin a comment.
    """
    if "#" not in line:
        return line
    quote = None
    for index, character in enumerate(line):
        if quote:
            if character == quote and line[index - 1] != "\\":
                quote = None
        elif character in "\"'" and index and (line[index - 1] in " \t=[,"):
            quote = character
        elif character == "#":
            return line[:index]
    # An apostrophe without a partner, as in "string name  # the robot's", is part of the comment, so the first ``#``
    # begins the comment.
    return line.partition("#")[0] if quote else line
