"""The values of YAML files by their paths, with their locations."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import yaml

from linkwright.diagnostics import foreign, phrase
from linkwright.review.file_pair import LimitError, UnreadableFileError

_MAX_VALUES = 20_000
"""The maximum number of values of a file. Aliases can repeat a value billions of times."""
_NAME_KEYS = ("name", "id")
"""The keys that identify the items of a list."""


@dataclass(frozen=True)
class YamlValue:
    """A scalar, or a list of scalars.

    Attributes:
        text: the value as text, as it is written without quotes.
        line: the line, starting at 1.
        column: the column, starting at 1.
    """

    text: str
    line: int
    column: int


def read_yaml_values(text: str) -> dict[str, YamlValue]:
    """Return the values of a YAML document by their paths, such as ``controller_manager.ros__parameters.update_rate``.

    Raises:
        UnreadableFileError: the text is not YAML, or it has more values than a parameter file.
    """
    values: dict[str, YamlValue] = {}
    root = composed(text)
    if root is None:
        return values
    for path, value in _values(root, ""):
        values[path] = value
        if len(values) > _MAX_VALUES:
            raise LimitError(phrase("it has more than {count} values", count=_MAX_VALUES))
    return values


def composed(text: str) -> yaml.Node | None:
    """Return the nodes of a YAML document, or None if it is empty.

    Raises:
        UnreadableFileError: the text is not YAML.
    """
    try:
        return yaml.compose(text, Loader=yaml.SafeLoader)
    except (yaml.YAMLError, RecursionError) as error:
        raise UnreadableFileError(foreign(" ".join(str(error).split()))) from None


def _values(node: yaml.Node, path: str) -> Iterator[tuple[str, YamlValue]]:
    if isinstance(node, yaml.MappingNode):
        for key, value in node.value:
            name = key.value if isinstance(key, yaml.ScalarNode) else "?"
            yield from _values(value, f"{path}.{name}" if path else str(name))
    elif isinstance(node, yaml.SequenceNode) and not all(isinstance(item, yaml.ScalarNode) for item in node.value):
        for number, item in enumerate(node.value):
            yield from _values(item, f"{path}[{_name_of(item) or number}]")
    else:
        mark = node.start_mark
        yield path, YamlValue(_scalar_text(node), mark.line + 1, mark.column + 1)


def _scalar_text(node: yaml.Node) -> str:
    if isinstance(node, yaml.SequenceNode):
        return f"[{', '.join(str(item.value) for item in node.value)}]"
    return " ".join(str(node.value).split())


def _name_of(node: yaml.Node) -> str | None:
    """Return the name of an item of a list, so that an inserted item does not shift the others."""
    if not isinstance(node, yaml.MappingNode):
        return None
    names = {
        key.value: value.value
        for key, value in node.value
        if isinstance(key, yaml.ScalarNode) and isinstance(value, yaml.ScalarNode)
    }
    return next((str(names[key]) for key in _NAME_KEYS if names.get(key)), None)
