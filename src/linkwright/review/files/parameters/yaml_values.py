"""Read the values of YAML files by path, with their locations."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from enum import Enum
from pathlib import Path

import yaml

from linkwright.diagnostics import foreign, phrase
from linkwright.review.file_pair import LimitError, UnreadableFileError
from linkwright.review.texts.list_changes import EMPTY

_MAX_BYTES = 4 << 20
_MAX_VALUES = 20_000
"""The maximum number of values of a file. Aliases can repeat a value billions of times."""
_MERGE_TAG = "tag:yaml.org,2002:merge"
NULL = "null"
_NAME_KEYS = ("name", "id")
"""The keys that identify the items of a list."""
_INTEGER = re.compile(r"[-+]?(0x[0-9a-fA-F]+|\d+)")
_FLOAT = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?|[-+]?\.(inf|Inf|INF)|\.(nan|NaN|NAN)")
_BOOLEAN = re.compile(r"true|false|yes|no|on|off", re.IGNORECASE)


class YamlType(Enum):
    """The type of a ROS 2 parameter with a value in YAML."""

    INTEGER = "integer"
    FLOAT = "double"
    TRUTH = "bool"
    TEXT = "string"
    MIXED = "mixed"


@dataclass(frozen=True)
class YamlValue:
    """A scalar, or a list of scalars.

    Attributes:
        text: the value as written, without quotes.
        line: the line, starting at 1.
        column: the column, starting at 1.
        type: the type of the scalar, or of the items of the list; None for an empty list or an empty value.
        is_list: whether the value is a list.
    """

    text: str
    line: int
    column: int
    type: YamlType | None = None
    is_list: bool = False

    @property
    def is_null(self) -> bool:
        """Whether the value is null, including a key without a value."""
        return self.type is None and not self.is_list

    @property
    def shown(self) -> str:
        """The value as text, with a word for null and empty values."""
        return NULL if self.is_null else self.text or EMPTY

    @property
    def type_name(self) -> str:
        """The name of the type of a parameter in ROS 2."""
        name = "" if self.type is None else self.type.value
        return f"{name}_array" if self.is_list else name


def read_yaml_values(text: str, labels: Mapping[int, str] | None = None) -> dict[str, YamlValue]:
    """Return the values of a YAML document by their paths.

    A path is ``controller_manager.ros__parameters.update_rate``, for example.

    Raises:
        UnreadableFileError: the text is not YAML, or it has more values than a parameter file.
    """
    root = compose_yaml(text)
    return {} if root is None else collect_values(root, labels or {})


def collect_values(root: yaml.Node, labels: Mapping[int, str]) -> dict[str, YamlValue]:
    """Return the values of a document by their paths.

    Args:
        root: the root node of the document.
        labels: the labels of list items in paths, by the identity of the item. Other items use their names or numbers.

    Raises:
        UnreadableFileError: the document has more values than a parameter file.
    """
    values: dict[str, YamlValue] = {}
    for path, value in _walk_values(root, "", labels):
        values[path] = value
        if len(values) > _MAX_VALUES:
            raise LimitError(phrase("it has more than {count} values", count=_MAX_VALUES))
    return values


def read_yaml_text(file: Path) -> str:
    """Return the text of a file of values.

    Raises:
        LimitError: the file is larger than 4 MiB.
        OSError, UnicodeDecodeError: the file cannot be read.
    """
    if file.stat().st_size > _MAX_BYTES:
        raise LimitError(phrase("it is larger than {megabytes} MB", megabytes=_MAX_BYTES >> 20))
    return file.read_text(encoding="utf-8")


def compose_yaml(text: str) -> yaml.Node | None:
    """Return the nodes of a YAML document, or None if it is empty.

    Raises:
        UnreadableFileError: the text is not YAML.
    """
    try:
        return yaml.compose(text, Loader=yaml.SafeLoader)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        problem = foreign(error.problem or error.context or "")
        line = 1 if mark is None else mark.line + 1
        raise UnreadableFileError(
            phrase("line {line} is not valid YAML: {problem}", line=line, problem=problem)
        ) from None
    except (yaml.YAMLError, RecursionError) as error:
        raise UnreadableFileError(foreign(" ".join(str(error).split()))) from None


def parse_yaml_value(text: str) -> YamlValue | None:
    """Return the YAML scalar or list of scalars of a text; None for other texts."""
    try:
        root = compose_yaml(text)
    except UnreadableFileError:
        return None
    if root is None or isinstance(root, yaml.MappingNode) or is_structured_list(root):
        return None
    return next(value for _, value in _walk_values(root, "", {}))


def _walk_values(node: yaml.Node, path: str, labels: Mapping[int, str]) -> Iterator[tuple[str, YamlValue]]:
    if isinstance(node, yaml.MappingNode):
        for key, value in list_merged_items(node):
            name = key.value if isinstance(key, yaml.ScalarNode) else "?"
            yield from _walk_values(value, f"{path}.{name}" if path else str(name), labels)
    elif is_structured_list(node):
        for number, item in enumerate(node.value):
            label = find_item_name(item) or labels.get(id(item)) or number
            yield from _walk_values(item, f"{path}[{label}]", labels)
    else:
        mark = node.start_mark
        is_list = isinstance(node, yaml.SequenceNode)
        yield path, YamlValue(_format_scalar(node), mark.line + 1, mark.column + 1, _find_type(node), is_list)


def list_merged_items(node: yaml.MappingNode) -> list[tuple[yaml.Node, yaml.Node]]:
    """Return the keys and values of a mapping, with those that merge keys (``<<``) bring; own keys go first."""
    items: list[tuple[yaml.Node, yaml.Node]] = []
    _collect_items(node, items, set())
    return items


def _collect_items(node: yaml.MappingNode, items: list[tuple[yaml.Node, yaml.Node]], seen: set[int]) -> None:
    """Add the items of a mapping whose keys are not known yet.

    Args:
        node: the mapping.
        items: the known keys with their values.
        seen: the identities of the mappings that were added; one may be merged many times, also into itself.
    """
    seen.add(id(node))
    known = {key.value for key, _ in items if isinstance(key, yaml.ScalarNode)}
    own = [(key, value) for key, value in node.value if key.tag != _MERGE_TAG]
    items += [item for item in own if not isinstance(item[0], yaml.ScalarNode) or item[0].value not in known]
    for key, value in node.value:
        sources = value.value if isinstance(value, yaml.SequenceNode) else [value]
        for source in sources if key.tag == _MERGE_TAG else ():
            if isinstance(source, yaml.MappingNode) and id(source) not in seen:
                _collect_items(source, items, seen)


def is_structured_list(node: yaml.Node) -> bool:
    """Return whether a node is a list with items that are lists or mappings."""
    return isinstance(node, yaml.SequenceNode) and not all(isinstance(item, yaml.ScalarNode) for item in node.value)


def _find_type(node: yaml.Node) -> YamlType | None:
    if isinstance(node, yaml.SequenceNode):
        types = {_find_type(item) for item in node.value}
        return YamlType.MIXED if len(types) > 1 else next(iter(types), None)
    text = str(node.value)
    if not isinstance(node, yaml.ScalarNode) or node.style is not None:
        return YamlType.TEXT
    if text in ("", "~", NULL, "Null", "NULL"):
        return None
    patterns = ((YamlType.INTEGER, _INTEGER), (YamlType.FLOAT, _FLOAT), (YamlType.TRUTH, _BOOLEAN))
    return next((kind for kind, pattern in patterns if pattern.fullmatch(text)), YamlType.TEXT)


def _format_scalar(node: yaml.Node) -> str:
    if isinstance(node, yaml.SequenceNode):
        items = (str(item.value) or (NULL if _find_type(item) is None else EMPTY) for item in node.value)
        return f"[{', '.join(items)}]"
    return " ".join(str(node.value).split())


def find_item_name(node: yaml.Node) -> str | None:
    """Return the name of a list item, which identifies it independently of its position."""
    if not isinstance(node, yaml.MappingNode):
        return None
    names = {
        key.value: value.value
        for key, value in node.value
        if isinstance(key, yaml.ScalarNode) and isinstance(value, yaml.ScalarNode)
    }
    return next((str(names[key]) for key in _NAME_KEYS if names.get(key)), None)
