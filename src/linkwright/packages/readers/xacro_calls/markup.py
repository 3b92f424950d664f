"""Reader for calls of xacro in XML launch files (ROS 2 and ROS 1) and YAML launch files."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping

from linkwright.diagnostics import LinkwrightError, SourceText, Span
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_typing import Any
from linkwright.packages.readers.xacro_calls.call import (
    CallingFile,
    ConditionalDefault,
    Inclusion,
    XacroCall,
    make_launch_argument,
    name_launch_choice,
)
from linkwright.packages.readers.xacro_calls.command_line import parse_xacro_command
from linkwright.packages.readers.xacro_calls.texts import UNKNOWN, Placeholder, Share, Text, make_literal
from linkwright.xmltree import Element, parse

_TAG_AND_REST = lazy_pattern(r"\s*(\S+)\s*(.*)", re.DOTALL)
_ARGUMENT_TAGS = frozenset({"var", "arg"})
_CONDITIONS = frozenset({"if", "unless"})
_COMPARISON = lazy_pattern(
    r"""\$\(eval\s+["']*(?:\$?\(?(?:arg|var)[(\s]\s*["']?(?P<argument>\w+)["']?\s*\)|(?P<name>\w+))["']?\s*"""
    r"""(?P<operator>==|!=)\s*["']?(?P<value>[\w./-]*)["']*\s*\)"""
)
"""A condition that compares an argument with a text, such as ``$(eval arg('arm') == 'long')``."""
_SHARE_TAGS = frozenset({"find-pkg-share", "find"})


def read_xml(source: SourceText) -> CallingFile:
    """Read the calls of xacro in an XML launch file.

    The result is empty if the file is not XML or not a launch file.
    """
    file = CallingFile(source.name)
    try:
        root = parse(source.text, source.name).root
    except LinkwrightError:
        return file
    if root.tag != "launch":
        return file
    include_children = {
        id(child) for element in root.walk() if element.tag == "include" for child in element.elements()
    }
    for element in root.walk():
        values = {key: parse_markup_text(value, source.name) for key, value in element.attributes.items()}
        if element.tag in ("arg", "let") and id(element) not in include_children and "name" in element.attributes:
            default = values.get("default", values.get("value"))
            file.declare(element.attributes["name"], default, tuple(_read_choice_values(element)))
            _record_conditional_default(file, element.attributes, default)
        elif element.tag == "include" and "file" in values:
            arguments = {
                child.attributes.get("name", ""): parse_markup_text(child.attributes["value"], source.name)
                for child in element.elements()
                if child.tag in ("arg", "let") and "value" in child.attributes
            }
            file.inclusions.append(Inclusion(values["file"], arguments))
        for key, value in element.attributes.items():
            lines = [values[key]] if key == "command" else list(_find_commands(value, source.name))
            _record_calls(file, lines, element.attribute_span(key))
    return file


def _record_conditional_default(file: CallingFile, attributes: Mapping[str, str], default: Text | None) -> None:
    """Record a default that holds only if another argument has a value."""
    for keyword in _CONDITIONS & attributes.keys() if default is not None else ():
        match = _COMPARISON.fullmatch(attributes[keyword])
        if match is not None and default is not None:
            is_equal = (match["operator"] == "==") == (keyword == "if")
            name = name_launch_choice(match["argument"] or match["name"])
            file.conditional_defaults.setdefault(name_launch_choice(attributes["name"]), []).append(
                ConditionalDefault(name, match["value"], is_equal, default)
            )


def _read_choice_values(element: Element) -> Iterator[Text]:
    for child in element.elements():
        if child.tag == "choice" and "value" in child.attributes:
            yield make_literal(child.attributes["value"])


def read_yaml(source: SourceText) -> CallingFile:
    """Read the calls of xacro in a YAML launch file.

    The result is empty if the file is not YAML or not a launch file.
    """
    import yaml

    file = CallingFile(source.name)
    try:
        document = yaml.safe_load(source.text)
    except (yaml.YAMLError, RecursionError, ValueError):
        return file
    if isinstance(document, dict) and isinstance(document.get("launch"), list):
        for entity in document["launch"]:
            _read_entity(entity, source, file)
    return file


def _read_entity(entity: Any, source: SourceText, file: CallingFile) -> None:
    """Read an action of a YAML launch file.

    An action is a mapping from its tag to attributes or nested actions.
    """
    for tag, value in entity.items() if isinstance(entity, dict) else ():
        attributes = value if isinstance(value, dict) else {}
        if tag in ("arg", "let") and "name" in attributes:
            default = attributes.get("default", attributes.get("value"))
            choices = tuple(
                make_literal(str(mapping["value"])) for mapping in _filter_mappings(attributes.get("choice"), "value")
            )
            default_text = None if default is None else parse_markup_text(str(default), source.name)
            file.declare(str(attributes["name"]), default_text, choices)
            continue
        if tag == "include" and "file" in attributes:
            argument_entries = _filter_mappings(attributes.get("arg", attributes.get("let")), "name")
            arguments = {
                str(item["name"]): parse_markup_text(str(item.get("value", "")), source.name)
                for item in argument_entries
            }
            file.inclusions.append(Inclusion(parse_markup_text(str(attributes["file"]), source.name), arguments))
        for text in _iterate_strings(value):
            _record_calls(file, list(_find_commands(text, source.name)), source.span(max(source.text.find(text), 0)))
        for nested_entity in value if isinstance(value, list) else ():
            _read_entity(nested_entity, source, file)


def _filter_mappings(value: Any, key: str) -> list[dict[Any, Any]]:
    """Return the items of a list that are mappings and have a key."""
    return [item for item in value if isinstance(item, dict) and key in item] if isinstance(value, list) else []


def _iterate_strings(value: Any) -> Iterator[str]:
    if isinstance(value, str):
        yield value
    for item in value.values() if isinstance(value, dict) else value if isinstance(value, list) else ():
        yield from _iterate_strings(item)


def _record_calls(file: CallingFile, lines: list[Text], span: Span | None) -> None:
    for line in lines:
        call = parse_xacro_command(line)
        if call is not None and span is not None:
            file.calls.append(XacroCall(*call, span, is_command=True))


def parse_markup_text(text: str, file: str) -> Text:
    """Convert a text of a launch file, with a placeholder for each ``$(...)``.

    Args:
        text: an attribute value or a YAML scalar, as written.
        file: the path of the launch file, for ``$(dirname)``.
    """
    pieces: list[str | Share | Placeholder] = []
    position = 0
    for start, end in _find_substitutions(text):
        pieces += make_literal(text[position:start])
        pieces += _read_substitution(text[start + 2 : end - 1], file)
        position = end
    return (*pieces, *make_literal(text[position:]))


def _find_substitutions(text: str) -> Iterator[tuple[int, int]]:
    """Yield the start and end offsets of the outermost ``$(...)`` in a text."""
    start = text.find("$(")
    while start >= 0:
        depth, end = 1, start + 2
        while end < len(text) and depth:
            depth += (text[end] == "(") - (text[end] == ")")
            end += 1
        if depth:
            return
        yield start, end
        start = text.find("$(", end)


def _read_substitution(content: str, file: str) -> Text:
    match = _TAG_AND_REST.match(content)
    if match is None:
        return (UNKNOWN,)
    tag, argument = match[1], match[2].strip().strip("'\"")
    if tag in _ARGUMENT_TAGS:
        return (make_launch_argument(argument),)
    if tag in _SHARE_TAGS:
        return (Share(parse_markup_text(argument, file)),)
    if tag == "dirname":
        return make_literal(os.path.dirname(file))  # noqa: PTH120 - a part of a path as text
    if tag == "find-exec":
        return make_literal(argument)
    if tag in ("env", "optenv"):
        default = argument.partition(" ")[2]
        return parse_markup_text(default.strip(), file) if default else (UNKNOWN,)
    return (UNKNOWN,)


def _find_commands(text: str, file: str) -> Iterator[Text]:
    """Yield the command lines in the ``$(command ...)`` of a text."""
    for start, end in _find_substitutions(text):
        match = _TAG_AND_REST.match(text[start + 2 : end - 1])
        if match is not None and match[1] == "command":
            yield _read_command_line(match[2].strip(), file)


def _read_command_line(argument: str, file: str) -> Text:
    """Return the first argument of ``$(command ...)``, without the quotes around several words."""
    quote = argument[:1]
    if quote in ("'", '"'):
        end = argument.rfind(quote)
        return parse_markup_text(argument[1 : end if end > 0 else None], file)
    return parse_markup_text(argument, file)
