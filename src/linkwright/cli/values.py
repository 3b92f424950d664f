"""The values of a message, request or goal, parsed from YAML and checked with the type."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import (
    Diagnostic,
    LinkwrightError,
    Note,
    Phrase,
    SourceText,
    Span,
    did_you_mean,
    foreign,
    phrase,
)

if TYPE_CHECKING:
    import yaml

    from linkwright.messages import Message

_SOURCE_NAME = "<values>"
_ASSIGNMENT_ERRORS = (AssertionError, TypeError, ValueError, AttributeError, OverflowError)
"""The exceptions that a field raises when an invalid value is assigned.

They are the same as in rosidl's generated classes.
"""

_AUTOMATIC_VALUES = ("auto", "now")


def add_values_arguments(parser: argparse.ArgumentParser, *, values_help: str, metavar: str = "VALUES") -> Any:
    """Declare the argument for the values, and the options to read them from elsewhere.

    Args:
        parser: the parser of the command.
        values_help: the help text, with an example.
        metavar: the name of the argument in the help.

    Returns:
        The argument group, to which the command can add another source of values.
    """
    group = parser.add_mutually_exclusive_group()
    group.add_argument("values", metavar=metavar, nargs="?", default="{}", help=values_help)
    group.add_argument("--stdin", action="store_true", help="read the values from standard input")
    return group


def read_values(arguments: argparse.Namespace) -> str:
    """Return the YAML text of the values from the command line, a file or standard input.

    Raises:
        LinkwrightError: CLI404, the file cannot be read.
    """
    if getattr(arguments, "stdin", False):
        return sys.stdin.read()
    file = getattr(arguments, "yaml_file", None)
    if file is None:
        return str(arguments.values)
    from linkwright.files.input_files import read_text

    try:
        return read_text(file)
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or error
        raise LinkwrightError(
            Diagnostic("CLI404", phrase("cannot read '{path}': {reason}", path=file, reason=foreign(reason)))
        ) from None


def parse_values(text: str) -> list[dict[str, Any]]:
    """Parse YAML, and return the mapping of each document.

    Empty documents are skipped; if all are empty, the result is one empty mapping.

    Raises:
        LinkwrightError: CLI402, the text is not YAML; CLI403, a document is not a mapping.
    """
    import yaml

    source = SourceText(_SOURCE_NAME, text)
    try:
        documents = list(yaml.safe_load_all(text))
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        span = None if mark is None else source.span(mark.index)
        problem = error.problem or error.context
        notes = (Note(foreign(error.context)),) if error.context and error.problem else ()
        hint = phrase(
            "quote the values for the shell, and write a space after each colon and comma: \"{a: 1, b: 'x'}\""
        )
        raise LinkwrightError(
            Diagnostic(
                "CLI402",
                phrase("the values are not YAML: {error}", error=foreign(problem)),
                span,
                notes=notes,
                hint=hint,
                source=source,
            )
        ) from None
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        raise LinkwrightError(
            Diagnostic("CLI402", phrase("the values are not YAML: {error}", error=foreign(error)), source=source)
        ) from None
    documents = [document for document in documents if document is not None] or [{}]
    for document in documents:
        if not isinstance(document, dict):
            raise LinkwrightError(_not_mapping_error(document, source))
    return documents


def _not_mapping_error(document: object, source: SourceText) -> Diagnostic:
    hint = phrase("write 'field: value', or '{field: value, other: value}'")
    if isinstance(document, str) and ":" in document:
        name, _, value = document.partition(":")
        if name.isidentifier():
            hint = phrase("YAML requires a space after the colon: '{name}: {value}'", name=name, value=value)
    message = phrase("The passed value needs to be a dictionary in YAML format")
    return Diagnostic("CLI403", message, source.span(0, len(source.text)), hint=hint, source=source)


def check_values(message: Message, values: Mapping[str, Any], text: str = "") -> None:
    """Check that values fit a message.

    One error reports all values that do not fit.

    Args:
        message: a message of the type, which remains unchanged.
        values: a mapping from `parse_values`.
        text: the YAML source of the values, for the locations in the error.

    Raises:
        LinkwrightError: CLI405, there is no such field; CLI406, a value is invalid for its field.
    """
    locations = _Locations(text)
    diagnostics = list(_find_problems(message, values, (), locations))
    if diagnostics:
        raise LinkwrightError(*diagnostics)


def fill_message(message: Message, values: Mapping[str, Any], text: str = "") -> list[Callable[[Any], None]]:
    """Set the fields of a message to values.

    As in ``ros2 topic pub``, the values ``header: auto`` (for a std_msgs/Header) and ``stamp: now`` (for a
    builtin_interfaces/Time) mean the time of publishing.

    Returns:
        Functions that set the stamps of this message; call each with a Time message before publishing.
    """
    from linkwright.messages import set_fields

    check_values(message, values, text)
    plain_values, setters = _split(message, dict(values))
    set_fields(message, plain_values)
    return setters


def _split(message: Any, values: dict[str, Any]) -> tuple[dict[str, Any], list[Callable[[Any], None]]]:
    """Split values into plain values and placeholders for the time of publishing.

    Returns:
        The values without placeholders, and a function for each placeholder that sets its stamp.
    """
    setters: list[Callable[[Any], None]] = []
    plain_values: dict[str, Any] = {}
    for name, value in values.items():
        field = getattr(message, name)
        type_name = getattr(field, "TYPE_NAME", "")
        if value == "auto" and type_name == "std_msgs/msg/Header":
            setters.append(_create_setter(field, "stamp"))
        elif value == "now" and type_name == "builtin_interfaces/msg/Time":
            setters.append(_create_setter(message, name))
        elif isinstance(value, dict) and type_name:
            plain_values[name], field_setters = _split(field, value)
            setters += field_setters
        else:
            plain_values[name] = value
    return plain_values, setters


def _create_setter(owner: Any, name: str) -> Callable[[Any], None]:
    return lambda stamp: setattr(owner, name, stamp)


class _Locations:
    """The locations of values in the YAML source, by paths of names and indices."""

    def __init__(self, text: str) -> None:
        self.source = SourceText(_SOURCE_NAME, text)
        self._root: yaml.Node | None = None
        if text:
            import yaml

            try:
                self._root = yaml.compose(text, yaml.SafeLoader)
            except yaml.YAMLError:  # a text of several documents, for which locations are not available
                self._root = None

    def span(self, path: tuple[str | int, ...], *, key: bool = False) -> Span | None:
        """Return the location of a value or of its key, or None if it is unknown."""
        import yaml

        node, key_node = self._root, None
        for step in path:
            key_node = None
            if isinstance(node, yaml.MappingNode):
                for name, value in node.value:
                    if name.value == str(step):
                        key_node, node = name, value
            elif isinstance(node, yaml.SequenceNode) and isinstance(step, int) and step < len(node.value):
                key_node = node = node.value[step]
            if key_node is None:
                return None
        target = key_node if key else node
        if target is None:
            return None
        return self.source.span(target.start_mark.index, target.end_mark.index)


def _find_problems(
    message: Any, values: Mapping[str, Any], path: tuple[str | int, ...], locations: _Locations
) -> Iterator[Diagnostic]:
    from linkwright.messages import set_fields

    fields = message.get_fields_and_field_types()
    for name, value in values.items():
        field_path = (*path, name)
        if name not in fields:
            yield Diagnostic(
                "CLI405",
                phrase("{type_name} has no field '{name}'", type_name=message.TYPE_NAME, name=name),
                locations.span(field_path, key=True),
                hint=did_you_mean(str(name), fields) or phrase("its fields are {fields}", fields=", ".join(fields))
                if fields
                else None,
                source=locations.source,
            )
            continue
        field = getattr(message, name)
        if hasattr(field, "get_fields_and_field_types") and isinstance(value, dict):
            yield from _find_problems(field, value, field_path, locations)
            continue
        if hasattr(field, "get_fields_and_field_types") and value in _AUTOMATIC_VALUES:
            continue
        try:
            set_fields(type(message)(), {name: value})
        except (*_ASSIGNMENT_ERRORS, LinkwrightError) as error:
            yield Diagnostic(
                "CLI406",
                phrase(
                    "field '{here}' is of type {fields} and cannot be {value}",
                    here=".".join(map(str, field_path)),
                    fields=fields[name],
                    value=_shorten(value),
                ),
                locations.span(field_path),
                notes=(Note(foreign(error)),) if str(error) else (),
                hint=_type_hint(fields[name], value),
                source=locations.source,
            )


def _shorten(value: object) -> str:
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."


def _type_hint(kind: str, value: object) -> Phrase | None:
    if kind == "string" and isinstance(value, (bool, int, float)):
        return phrase("quote it, so that YAML reads it as a string: '\"{value}\"'", value=str(value).lower())
    if kind.startswith(("float", "double")) and isinstance(value, str):
        return phrase("write a number, such as 1.0")
    if kind.startswith(("int", "uint")) and isinstance(value, float):
        return phrase("write an integer")
    if ("sequence" in kind or "[" in kind) and not isinstance(value, (list, str)):
        return phrase("write a list: [1, 2, 3]")
    return None
