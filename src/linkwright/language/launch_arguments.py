"""The arguments declared in a launch file in XML, YAML or Python, which may be incomplete."""

from __future__ import annotations

import re
from bisect import bisect_left
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from linkwright.language.python_text import Group, Item, Name, Operator, Part, PythonText, Text, python_text
from linkwright.xmltree.tokens import Kind, Token, tokens

_DECLARATIONS = ("DeclareLaunchArgument", "DeclareBooleanLaunchArgument")
_YAML_ARGUMENT = re.compile(r"^(?P<indent>[ ]*)-[ ]*(?:arg|let)[ ]*:[ ]*$", re.MULTILINE)
_YAML_KEY = re.compile(
    r"^(?P<indent>[ ]+)(?P<key>name|default|value|description)[ ]*:[ ]*(?P<value>.*?)[ ]*$", re.MULTILINE
)
_LOG_LEVELS = ("info", "debug", "warn", "error", "fatal")
_CAPITALIZED_BOOLEAN, _LOWERCASE_BOOLEAN = (
    re.compile(r"""["'](?:True|False)["']"""),
    re.compile(r"""["'](?:true|false)["']"""),
)
_MAX_TEXT_LENGTH = 1_000_000
_MAX_CHARACTERS_BEFORE = 200
"""The number of statements before a declaration that are searched for its loop."""


@dataclass(frozen=True, slots=True)
class LaunchArgument:
    """An argument or launch configuration that a launch file declares.

    Attributes:
        name: the name of the argument.
        file: the launch file.
        start: the offset of the name.
        default: the default as written, or None if the argument is required.
        description: the description, or empty.
        choices: the allowed values, or empty if any value is allowed.
        is_argument: whether a caller can set it, unlike ``let``.
    """

    name: str
    file: Path
    start: int
    default: str | None = None
    description: str = ""
    choices: tuple[str, ...] = ()
    is_argument: bool = True

    @property
    def end(self) -> int:
        """The offset after the name."""
        return self.start + len(self.name)

    @property
    def is_condition(self) -> bool:
        """Whether the default is true or false."""
        return (self.default or "").strip("'\"").lower() in ("true", "false")

    def describe(self) -> str:
        """Return the argument in Markdown: name, default, choices and description."""
        default = "" if self.default is None else f" = `{self.default or repr(self.default)}`"
        lines = [f"**{self.name}**{default}, {self.file.name}"]
        if self.description:
            lines.append(self.description)
        if self.choices:
            lines.append(" | ".join(f"`{choice}`" for choice in self.choices))
        return "\n\n".join(lines)


def list_likely_values(argument: LaunchArgument | None, name: str, text: str) -> tuple[str, ...]:
    """Return the likely values of an argument, in the spelling of a launch file.

    Args:
        argument: the argument, or None if only its name is known.
        name: the name of the argument.
        text: the launch file in which the value is written.
    """
    if argument is not None and argument.choices:
        return argument.choices
    if name.endswith("log_level"):
        return _LOG_LEVELS
    if argument is None or argument.is_condition or argument.default is None:
        capital = len(_CAPITALIZED_BOOLEAN.findall(text)) > len(_LOWERCASE_BOOLEAN.findall(text))
        small, large = ("true", "false"), ("True", "False")
        return (*large, *small) if capital else (*small, *large)
    default = argument.default.strip("'\"")
    return (default,) if default and "(" not in default else ()


def arguments_in(text: str, file: Path) -> list[LaunchArgument]:
    """Return the arguments that a launch file declares, in text order, each name once."""
    if len(text) > _MAX_TEXT_LENGTH:
        return []
    if file.name.endswith(".py"):
        arguments = _arguments_in_python(text, file)
    elif file.name.endswith((".yaml", ".yml")):
        arguments = _arguments_in_yaml(text, file)
    else:
        arguments = _arguments_in_xml(text, file)
    by_name: dict[str, LaunchArgument] = {}
    for argument in arguments:
        by_name.setdefault(argument.name, argument)
    return list(by_name.values())


def _arguments_in_xml(text: str, file: Path) -> Iterator[LaunchArgument]:
    inside: list[str] = []
    pending: tuple[Token, list[str]] | None = None
    for token in tokens(text):
        if token.kind is Kind.START and token.name:
            if token.name == "choice" and pending is not None:
                pending[1].extend(item.value or "" for item in token.attributes() if item.name == "value")
            elif token.name in ("arg", "bool_arg", "let") and "include" not in inside:
                if pending is not None:
                    yield from _argument_of_tag(*pending, file)
                pending = token, []
            if not token.is_empty_element:
                inside.append(token.name)
        elif token.kind is Kind.END and token.name in inside:
            while inside.pop() != token.name:
                pass
    if pending is not None:
        yield from _argument_of_tag(*pending, file)


def _argument_of_tag(token: Token, choices: list[str], file: Path) -> Iterator[LaunchArgument]:
    attributes = {attribute.name: attribute for attribute in token.attributes()}
    name = attributes.get("name")
    if name is not None and name.value:
        value = attributes.get("value" if token.name == "let" else "default")
        description = attributes.get("description")
        yield LaunchArgument(
            name.value,
            file,
            name.value_start,
            None if value is None else value.value,
            (description.value or "") if description else "",
            tuple(choices) or (("true", "false") if token.name == "bool_arg" else ()),
            token.name != "let",
        )


def _arguments_in_python(text: str, file: Path) -> Iterator[LaunchArgument]:
    python = python_text(text)
    for call in python.calls_of(*_DECLARATIONS):
        name = call.argument("name", 0)
        literal = _read_literal(name)
        default, description = call.argument("default_value"), call.argument("description")
        default_text = None if default is None else _source_text(_resolve(python, default), text)
        description_text = (
            "".join(part.value for part in description.parts if isinstance(part, Text)) if description else ""
        )
        if literal is not None and literal.value:
            choices = (
                _read_literals(call.argument("choices")) if call.function == _DECLARATIONS[0] else ("true", "false")
            )
            yield LaunchArgument(literal.value, file, literal.start, default_text, description_text, choices)
        elif name is not None and len(name.parts) == 1 and isinstance(name.parts[0], Name):
            for entry, values in _find_loop_values(python, call, name.parts[0].value):
                computed = default is not None and bool(values)
                yield LaunchArgument(
                    entry.value,
                    file,
                    entry.start,
                    values[0] if computed else default_text,
                    description_text or "".join(values[1:2]),
                )


def _find_loop_values(python: PythonText, call: Group, name: str) -> Iterator[tuple[Text, list[str]]]:
    """Yield each string that a loop around a call assigns to a name, with its entry's strings.

    The loop iterates over a list of strings, or over a dictionary whose values are strings or pairs of strings.
    """
    item = call.parent
    following_items = [] if item is None else item.group.items[item.group.items.index(item) :]
    item_index = bisect_left(python.root.items, call.start, key=lambda other: other.start)
    statements = (
        other.parts for other in reversed(python.root.items[max(0, item_index - _MAX_CHARACTERS_BEFORE) : item_index])
    )
    for parts in ([part for other in following_items for part in other.parts], *statements):
        words = [part.value if isinstance(part, Name) else "" for part in parts]
        if "for" not in words or "in" not in words[words.index("for") :]:
            continue
        head = parts[words.index("for") : words.index("in", words.index("for"))]
        values = parts[words.index("in", words.index("for")) + 1 :]
        if values and any(isinstance(part, Name) and part.value == name for part in head):
            yield from _list_loop_entries(python, values[0])
            return


def _list_loop_entries(python: PythonText, values: Part) -> Iterator[tuple[Text, list[str]]]:
    bound = values.callee.partition(".")[0] if isinstance(values, Group) and values.callee else None
    bound = values.value if isinstance(values, Name) else bound
    if bound is not None:
        assigned = python.bindings.get(bound)
        values = assigned.parts[0] if assigned is not None and assigned.parts else values
    for item in values.items if isinstance(values, Group) else ():
        entry = _read_literal(item)
        if entry is not None:
            texts = [part for part in item.after_colon if part is not entry]
            inner = [
                _read_literal(inner_item) for group in texts if isinstance(group, Group) for inner_item in group.items
            ]
            strings = [part for part in texts if isinstance(part, Text)] or [part for part in inner if part is not None]
            yield entry, [part.value for part in strings]


def _read_literal(item: Item | None) -> Text | None:
    part = item.parts[0] if item is not None and item.parts else None
    return part if isinstance(part, Text) else None


def _read_literals(item: Item | None) -> tuple[str, ...]:
    part = item.parts[0] if item is not None and item.parts else None
    if not isinstance(part, Group):
        return ()
    return tuple(text.value for inner in part.items if (text := _read_literal(inner)) is not None)


def _resolve(python: PythonText, item: Item) -> Item:
    """Resolve a variable to its string, or to the default of its ``LaunchConfiguration``."""
    for _ in range(2):
        part = item.parts[0] if len(item.parts) == 1 else None
        bound = python.bindings.get(part.value) if isinstance(part, Name) else None
        inner = bound.parts[0] if bound is not None and len(bound.parts) == 1 else part
        default = inner.argument("default", 1) if isinstance(inner, Group) else None
        if isinstance(inner, Group) and inner.function == "LaunchConfiguration" and default is not None:
            item = default
        elif bound is not None and isinstance(inner, Text):
            item = bound
    return item


def _source_text(item: Item, text: str) -> str:
    """Return the content of a string literal, or the source text of any other expression."""
    only = item.parts[0] if len(item.parts) == 1 else None
    if isinstance(only, Text):
        return only.value
    places = [part for part in item.parts if not isinstance(part, Operator)]
    if not places:
        return "".join(getattr(part, "value", "") for part in item.parts)
    first, last = places[0], places[-1]
    start = first.start - len(first.callee) if isinstance(first, Group) else first.start
    return " ".join(text[start : last.end].split())


def _arguments_in_yaml(text: str, file: Path) -> Iterator[LaunchArgument]:
    for entry in _YAML_ARGUMENT.finditer(text):
        values_by_key: dict[str, re.Match[str]] = {}
        offset = entry.end() + 1
        while (line := _YAML_KEY.match(text, offset)) and len(line["indent"]) > len(entry["indent"]):
            values_by_key.setdefault(line["key"], line)
            offset = line.end() + 1
        name = values_by_key.get("name")
        if name is None or not name["value"].strip("'\""):
            continue
        quoted = name["value"][:1] in ("'", '"')
        is_argument = "let" not in entry[0]
        default = values_by_key.get("default" if is_argument else "value")
        description = values_by_key["description"]["value"].strip("'\"") if "description" in values_by_key else ""
        yield LaunchArgument(
            name["value"].strip("'\""),
            file,
            name.start("value") + quoted,
            None if default is None else default["value"].strip("'\""),
            description,
            is_argument=is_argument,
        )
