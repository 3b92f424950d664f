"""Read the outlines of launch files in XML and YAML."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import yaml

from linkwright.diagnostics import SourceText, Span, phrase
from linkwright.review.file_pair import LimitError
from linkwright.review.files.yaml_values import compose_yaml
from linkwright.review.launches.environment import markup_readings
from linkwright.review.launches.outlines import (
    CONDITION,
    DELETION,
    ENVIRONMENT,
    NAMESPACE,
    NAMESPACE_OF_INCLUDED,
    PARAMETER,
    REMAPPING,
    SERVER_PARAMETER,
    CodePart,
    Entry,
    LaunchOutline,
    Scope,
    with_condition,
)
from linkwright.review.launches.ros1_parameters import (
    deleted_name,
    deletes_parameters,
    file_settings,
    written_parameters,
)
from linkwright.xmltree import Element

_NODE_TAGS = ("node", "lifecycle_node", "composable_node", "node_container")
_PUSHES = ("push_ros_namespace", "push-ros-namespace", "push_namespace")
_ENVIRONMENT = ("set_env", "env", "append_env", "unset_env")
_REMAPPINGS = ("remap", "set_remap")
_CONDITIONS = ("if", "unless")
_ROSPARAM = "rosparam"
_NOT_COMPARED = frozenset({"pkg", "exec", "type", "plugin", "description", "doc", "cmd"})
_QUOTED_COMMAND = re.compile(r"\$\(command (['\"])(.*)\1( \w+)?\)")
_MAX_NODES = 20_000
"""The maximum number of actions of a file. YAML aliases can expand to billions of actions."""


@dataclass
class LaunchTag:
    """An action of a launch file in XML or YAML.

    Attributes:
        name: the name of the tag.
        attributes: the attributes of the tag by name.
        span: the position of the tag in the file.
        text: the text inside it.
        children: the actions and settings inside it.
    """

    name: str
    attributes: dict[str, str]
    span: Span
    text: str = ""
    children: list[LaunchTag] = field(default_factory=list)


def read_markup_outline(root: LaunchTag) -> LaunchOutline:
    """Return the outline of a launch file in XML or YAML."""
    rest: list[CodePart] = []
    entries = list(_read_entries(root, Scope(), rest))
    is_ros1 = any(map(_is_ros1, _walk_tags(root)))
    if is_ros1:
        entries = [replace(entry, kind=SERVER_PARAMETER) if entry.kind == "parameter" else entry for entry in entries]
    return LaunchOutline([*entries, *markup_readings(_attribute_values(root))], rest, is_ros1=is_ros1)


def _is_ros1(tag: LaunchTag) -> bool:
    """Return whether an action exists only in ROS 1: a node with ``type``, a server parameter, a path with ``find``."""
    is_node = tag.name == "node" and "type" in tag.attributes
    return is_node or tag.name == _ROSPARAM or any("$(find " in value for value in tag.attributes.values())


def _walk_tags(tag: LaunchTag) -> Iterator[LaunchTag]:
    yield tag
    for child in tag.children:
        yield from _walk_tags(child)


def _attribute_values(tag: LaunchTag) -> Iterator[tuple[str, Span]]:
    """Yield the attributes and texts of tags with their places."""
    yield from ((value, tag.span) for value in (*tag.attributes.values(), tag.text))
    for child in tag.children:
        yield from _attribute_values(child)


def xml_tags(element: Element) -> LaunchTag:
    """Return an element of XML with the elements in it."""
    children = [xml_tags(child) for child in element.elements()]
    span = element.span() or Span("", 1, 1, 1, 1)
    attributes = {name: " ".join(value.split()) for name, value in element.attributes.items()}
    text = element.text() if element.tag == _ROSPARAM else " ".join(element.text().split())
    return LaunchTag(element.tag, attributes, span, text, children)


def yaml_tags(path: Path) -> LaunchTag:
    """Return the actions of a launch file in YAML below a root.

    Raises:
        UnreadableFileError: the text is not YAML, or it has too many actions.
        OSError: the file cannot be read.
        ValueError: the file is not text in UTF-8.
    """
    source = SourceText(str(path), path.read_text("utf-8"))
    node = compose_yaml(source.text)
    root = LaunchTag("launch", {}, source.span(0, 1))
    reader = _YamlReader(source)
    for name, value in _mapping_items(node):
        if name == "launch":
            reader.add(root, value)
    return root


class _YamlReader:
    """A reader of actions in YAML.

    Each item of a list is a mapping from a tag to its attributes. An attribute that is a list contains tags of that
    name, such as ``param``.
    """

    def __init__(self, source: SourceText) -> None:
        self._source = source
        self._count = 0

    def add(self, parent: LaunchTag, node: yaml.Node) -> None:
        """Add the actions of a list to a tag."""
        for item in node.value if isinstance(node, yaml.SequenceNode) else []:
            for name, value in _mapping_items(item):
                parent.children.append(self._read_tag(name, value))

    def _read_tag(self, name: str, node: yaml.Node) -> LaunchTag:
        self._count += 1
        if self._count > _MAX_NODES:
            raise LimitError(phrase("it has more than {count} actions", count=_MAX_NODES))
        tag = LaunchTag(name, {}, self._source.span(node.start_mark.index, node.start_mark.index + 1))
        if isinstance(node, yaml.SequenceNode):
            self.add(tag, node)
        for key, value in _mapping_items(node):
            if key == "children":
                self.add(tag, value)
            elif isinstance(value, yaml.SequenceNode):
                tag.children += (self._read_tag(key, item) for item in value.value)
            elif isinstance(value, yaml.ScalarNode):
                tag.attributes[key] = str(value.value)
        if isinstance(node, yaml.ScalarNode):
            tag.text = str(node.value)
        return tag


def _mapping_items(node: yaml.Node | None) -> Iterator[tuple[str, yaml.Node]]:
    for key, value in node.value if isinstance(node, yaml.MappingNode) else []:
        yield str(key.value), value


# --- entries ---------------------------------------------------------------------------------------------------------


def _read_entries(parent: LaunchTag, scope: Scope, rest: list[CodePart]) -> Iterator[Entry]:
    for tag in parent.children:
        attributes = tag.attributes
        if tag.name in _PUSHES:
            namespace = attributes.get("namespace") or attributes.get("ns") or attributes.get("name", "")
            condition = _condition_text(tag)
            scope = scope.with_namespace(f"{namespace} ({condition})" if condition else namespace)
        elif tag.name == "group":
            inner = scope.inside(_condition_text(tag)).with_namespace(attributes.get("ns", ""))
            yield from _read_entries(tag, inner, rest)
        else:
            entries = list(_read_action(tag))
            for entry in entries:
                yield Entry(entry.kind, entry.name, scope.settings(entry.kind, entry.settings), entry.span)
            if entries:
                if entries[0].kind == "node":
                    inner_tags = [child for child in tag.children if child.name in _NODE_TAGS]
                    inner = scope.inside(_condition_text(tag))
                    yield from _read_entries(LaunchTag("", {}, tag.span, children=inner_tags), inner, rest)
            else:
                text = " ".join(
                    [tag.name, *(f"{name}={value}" for name, value in sorted(attributes.items())), tag.text]
                )
                rest.append(CodePart(text, text, tag.span))
                yield from _read_entries(tag, scope.inside(_condition_text(tag)), rest)


def _condition_text(tag: LaunchTag) -> str:
    return " and ".join(f"{name} {tag.attributes[name]}" for name in _CONDITIONS if name in tag.attributes)


def _read_action(tag: LaunchTag) -> Iterator[Entry]:
    """Yield the entries of an action: one for each parameter of a ``<rosparam>`` element."""
    parameters = written_parameters(tag.attributes, tag.text) if tag.name == _ROSPARAM else {}
    condition = _condition_text(tag)
    for name, value in parameters.items():
        settings = {"value": value, **({CONDITION: condition} if condition else {})}
        yield Entry("parameter", name, settings, tag.span)
    entry = None if parameters else _read_entry(tag)
    if entry is not None:
        yield entry


def _read_entry(tag: LaunchTag) -> Entry | None:
    """Return the entry of an action, or None for a tag that is not an action."""
    attributes = tag.attributes
    name = attributes.get("name", "")
    settings: dict[str, str] = {}
    if tag.name == "arg":
        kind = "argument"
        settings = _select_attributes(attributes, {"default": "default", "value": "value"})
        choices = [child.attributes.get("value", "") for child in tag.children if child.name == "choice"]
        if choices:
            settings["choices"] = f"[{', '.join(choices)}]"
    elif tag.name == "let":
        kind, settings = "variable", {"value": attributes.get("value", "")}
    elif tag.name in _NODE_TAGS:
        kind, name, settings = "node", _node_name(attributes), _node_settings(tag)
    elif tag.name == "executable":
        kind, name, settings = (
            "process",
            attributes.get("cmd", ""),
            {**_remaining_attributes(attributes), **_environment_settings(tag)},
        )
    elif tag.name == "include":
        kind, name, settings = "include", attributes.get("file", ""), _passed_arguments(tag)
    elif tag.name in _REMAPPINGS:
        kind, name, settings = "remapping", attributes.get("from", ""), {"to": attributes.get("to", "")}
    elif tag.name in ("param", "set_parameter"):
        kind, settings = "parameter", {"value": _parameter_value(tag)}
    elif tag.name == _ROSPARAM and deletes_parameters(attributes):
        kind, name = DELETION, deleted_name(attributes)
    elif tag.name == _ROSPARAM:
        name = attributes.get("file") or attributes.get("param", "")
        kind, settings = "parameters", file_settings(attributes)
    elif tag.name in _ENVIRONMENT:
        kind = "environment"
        key = {"append_env": "appended value", "unset_env": "unset"}.get(tag.name, "value")
        settings = {key: attributes.get("value", "true")}
    else:
        return None
    condition = _condition_text(tag)
    return Entry(kind, name, {**settings, **({CONDITION: condition} if condition else {})}, tag.span)


def _select_attributes(attributes: Mapping[str, str], names: Mapping[str, str]) -> dict[str, str]:
    return {names[key]: value for key, value in attributes.items() if key in names}


def _remaining_attributes(attributes: Mapping[str, str], ignored: Sequence[str] = ()) -> dict[str, str]:
    names = {"ns": NAMESPACE, "args": "arguments", "launch-prefix": "prefix"}
    left_out = {*_NOT_COMPARED, *_CONDITIONS, *ignored}
    return {names.get(key, key): value for key, value in attributes.items() if key not in left_out}


def _node_name(attributes: Mapping[str, str]) -> str:
    parts = (attributes.get("pkg"), attributes.get("exec") or attributes.get("type"), attributes.get("plugin"))
    return "/".join(part for part in parts if part)


def _node_settings(tag: LaunchTag) -> dict[str, str]:
    settings = _remaining_attributes(tag.attributes)
    files: list[str] = []
    deleted: list[str] = []
    for child in tag.children:
        attributes, condition = child.attributes, _condition_text(child)
        found: dict[str, str] = {}
        if child.name in ("param", _ROSPARAM) and (attributes.get("from") or attributes.get("file")):
            items = [f"{name} {value}" for name, value in file_settings(attributes).items() if child.name == _ROSPARAM]
            items += filter(None, [condition])
            file = attributes.get("from") or attributes["file"]
            files.append(f"{file} ({', '.join(items)})" if items else file)
        elif child.name == "param":
            found = _parameter_settings(child, "")
        elif child.name == _ROSPARAM and deletes_parameters(attributes):
            deleted.append(" ".join(filter(None, [deleted_name(attributes) or "~", condition and f"({condition})"])))
        elif child.name == _ROSPARAM:
            parameters = written_parameters(attributes, child.text)
            found = {f"{PARAMETER}{name}": value for name, value in parameters.items()}
            if not found:
                name = attributes.get("param") or attributes.get("ns", "")
                found = {f"{PARAMETER}{name}": attributes.get("command", "")}
        elif child.name == "remap":
            found = {f"{REMAPPING}{attributes.get('from', '')}": attributes.get("to", "")}
        elif child.name == "extra_arg":
            found = {f"extra argument {attributes.get('name', '')}": attributes.get("value", "")}
        settings |= {with_condition(name, condition): value for name, value in found.items()}
    settings |= _environment_settings(tag)
    if deleted:
        settings["deleted parameters"] = f"[{', '.join(deleted)}]"
    return {**settings, "parameters": f"[{', '.join(files)}]"} if files else settings


def _environment_settings(tag: LaunchTag) -> dict[str, str]:
    """Return the environment variables that an action sets for its process, by name."""
    return {
        with_condition(
            f"{ENVIRONMENT}{child.attributes.get('name', '')}", _condition_text(child)
        ): child.attributes.get("value", "")
        for child in tag.children
        if child.name == "env"
    }


def _parameter_settings(tag: LaunchTag, path: str) -> dict[str, str]:
    """Return the value of a parameter by name, or the values of the parameters inside it."""
    name = f"{path}{tag.attributes.get('name', '')}"
    inner = [child for child in tag.children if child.name == "param"]
    if not inner:
        return {f"{PARAMETER}{name}": _parameter_value(tag)}
    parameters: dict[str, str] = {}
    for child in inner:
        parameters |= _parameter_settings(child, f"{name}.")
    return parameters


def _parameter_value(tag: LaunchTag) -> str:
    """Return the value of a parameter, or the file or command that it comes from."""
    keys = ("value", "textfile", "binfile", "command")
    text = next((tag.attributes[key] for key in keys if key in tag.attributes), tag.text)
    if not {"value", "textfile", "binfile"} & tag.attributes.keys() and "command" in tag.attributes:
        return f"$(command {text})"
    return _QUOTED_COMMAND.sub(r"$(command \2\3)", text)


def _passed_arguments(tag: LaunchTag) -> dict[str, str]:
    """Return the arguments that an include passes, and the namespace of the nodes in the file."""
    settings = {
        with_condition(child.attributes.get("name", ""), _condition_text(child)): child.attributes.get(
            "value", child.attributes.get("default", "")
        )
        for child in tag.children
        if child.name in ("arg", "let")
    }
    if tag.attributes.get("ns"):
        settings[NAMESPACE_OF_INCLUDED] = tag.attributes["ns"]
    return {**settings, **_environment_settings(tag)}
