"""Read the outlines of launch files in XML and YAML."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import yaml

from linkwright.diagnostics import SourceText, Span, phrase
from linkwright.review.file_pair import LimitError
from linkwright.review.files.parameters.yaml_values import compose_yaml
from linkwright.review.launches.outlines import (
    ALLOW_SUBSTITUTIONS,
    CONDITION,
    DELETION,
    ENVIRONMENT,
    IGNORED_TAG,
    NAMESPACE,
    NAMESPACE_OF_INCLUDED,
    PARAMETER,
    PASSES_ALL_ARGUMENTS,
    PROGRAM_KINDS,
    REMAPPING,
    SERVER_PARAMETER,
    TEST,
    CodePart,
    Entry,
    LaunchOutline,
    Scope,
    with_condition,
)
from linkwright.review.launches.python.environment import find_markup_readings
from linkwright.review.launches.ros1_parameters import (
    deletes_parameters,
    find_deleted_name,
    read_file_settings,
    read_written_parameters,
)
from linkwright.xmltree import Element

_NODE_TAGS = ("node", "lifecycle_node", "composable_node", "node_container")
_NAMESPACE_TAGS = ("push_ros_namespace", "push-ros-namespace", "push_namespace")
_ENVIRONMENT_TAGS = ("set_env", "env", "append_env", "unset_env")
_REMAPPING_TAGS = ("remap", "set_remap")
_CHILDREN_IN_ROS1 = {
    "include": frozenset({"arg", "env"}),
    "node": frozenset({"remap", "param", "rosparam", "env"}),
    TEST: frozenset({"remap", "param", "rosparam", "env"}),
}
"""The children that roslaunch reads; see ``roslaunch/xmlloader.py``. It only prints a warning about others."""
_CONDITION_ATTRIBUTES = ("if", "unless")
_ROSPARAM_TAG = "rosparam"
_IGNORED_ATTRIBUTES = frozenset({"pkg", "exec", "type", "plugin", "description", "doc", "cmd"})
_QUOTED_COMMAND = re.compile(r"\$\(command (['\"])(.*)\1( \w+)?\)")
_MAX_ACTIONS = 20_000
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
    other_code: list[CodePart] = []
    entries = list(_read_entries(root, Scope(), other_code))
    is_ros1 = any(map(_is_ros1, _walk_tags(root)))
    if is_ros1:
        entries = [replace(entry, kind=SERVER_PARAMETER) if entry.kind == "parameter" else entry for entry in entries]
        entries += (entry for tag in _walk_tags(root) for entry in _find_ignored_tags(tag))
    return LaunchOutline([*entries, *find_markup_readings(_walk_values(root))], other_code, is_ros1=is_ros1)


def _is_ros1(tag: LaunchTag) -> bool:
    """Return whether an action exists only in ROS 1.

    Such actions are nodes with ``type``, server parameters and paths with ``find``.
    """
    is_node = tag.name in PROGRAM_KINDS and "type" in tag.attributes
    return is_node or tag.name == _ROSPARAM_TAG or any("$(find " in value for value in tag.attributes.values())


def _walk_tags(tag: LaunchTag) -> Iterator[LaunchTag]:
    yield tag
    for child in tag.children:
        yield from _walk_tags(child)


def _find_ignored_tags(tag: LaunchTag) -> Iterator[Entry]:
    """Yield the children that roslaunch ignores."""
    known = _CHILDREN_IN_ROS1.get(tag.name)
    for child in tag.children:
        if known is not None and child.name not in known:
            words = [child.name, *(f'{name}="{value}"' for name, value in child.attributes.items())]
            yield Entry(IGNORED_TAG, f"<{' '.join(words)}> in <{tag.name}>", {}, child.span)


def _walk_values(tag: LaunchTag) -> Iterator[tuple[str, Span]]:
    """Yield the attributes and texts of tags with their locations."""
    yield from ((value, tag.span) for value in (*tag.attributes.values(), tag.text))
    for child in tag.children:
        yield from _walk_values(child)


def tag_from_xml(element: Element) -> LaunchTag:
    """Return an element of XML with the elements in it."""
    children = [tag_from_xml(child) for child in element.elements()]
    span = element.span() or Span("", 1, 1, 1, 1)
    attributes = {name: " ".join(value.split()) for name, value in element.attributes.items()}
    text = element.text() if element.tag == _ROSPARAM_TAG else " ".join(element.text().split())
    return LaunchTag(element.tag, attributes, span, text, children)


def read_yaml_tags(path: Path) -> LaunchTag:
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
    for name, value in _iterate_mapping(node):
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
        self._action_count = 0

    def add(self, parent: LaunchTag, node: yaml.Node) -> None:
        """Add the actions of a list to a tag."""
        for item in node.value if isinstance(node, yaml.SequenceNode) else []:
            for name, value in _iterate_mapping(item):
                parent.children.append(self._read_tag(name, value))

    def _read_tag(self, name: str, node: yaml.Node) -> LaunchTag:
        self._action_count += 1
        if self._action_count > _MAX_ACTIONS:
            raise LimitError(phrase("it has more than {count} actions", count=_MAX_ACTIONS))
        tag = LaunchTag(name, {}, self._source.span(node.start_mark.index, node.start_mark.index + 1))
        if isinstance(node, yaml.SequenceNode):
            self.add(tag, node)
        for key, value in _iterate_mapping(node):
            if key == "children":
                self.add(tag, value)
            elif isinstance(value, yaml.SequenceNode):
                tag.children += (self._read_tag(key, item) for item in value.value)
            elif isinstance(value, yaml.ScalarNode):
                tag.attributes[key] = str(value.value)
        if isinstance(node, yaml.ScalarNode):
            tag.text = str(node.value)
        return tag


def _iterate_mapping(node: yaml.Node | None) -> Iterator[tuple[str, yaml.Node]]:
    for key, value in node.value if isinstance(node, yaml.MappingNode) else []:
        yield str(key.value), value


# --- entries ---------------------------------------------------------------------------------------------------------


def _read_entries(parent: LaunchTag, scope: Scope, other_code: list[CodePart]) -> Iterator[Entry]:
    """Yield the entries of the tags in a group, and add the other tags to the other code."""
    for tag in parent.children:
        attributes = tag.attributes
        if tag.name in _NAMESPACE_TAGS:
            namespace = attributes.get("namespace") or attributes.get("ns") or attributes.get("name", "")
            condition = _format_condition(tag)
            scope = scope.with_namespace(f"{namespace} ({condition})" if condition else namespace)
        elif tag.name == "group":
            inner = scope.with_condition(_format_condition(tag)).with_namespace(attributes.get("ns", ""))
            inner = inner if attributes.get("scoped", "true").lower() != "true" else inner.with_group(tag.span.line)
            yield from _read_entries(tag, inner, other_code)
        else:
            entries = list(_read_action(tag))
            for entry in entries:
                settings = scope.add_to_settings(entry.kind, entry.settings)
                namespaces = scope.namespaces if entry.kind == "parameter" else ()
                yield Entry(entry.kind, entry.name, settings, entry.span, namespaces, scope.remappings, scope.groups)
                scope = scope.with_remapping(entry) if entry.kind == "remapping" else scope
            if entries:
                if entries[0].kind == "node":
                    inner_tags = [child for child in tag.children if child.name in _NODE_TAGS]
                    inner = scope.with_condition(_format_condition(tag))
                    yield from _read_entries(LaunchTag("", {}, tag.span, children=inner_tags), inner, other_code)
            else:
                text = " ".join(
                    [tag.name, *(f"{name}={value}" for name, value in sorted(attributes.items())), tag.text]
                )
                other_code.append(CodePart(text, text, tag.span))
                yield from _read_entries(tag, scope.with_condition(_format_condition(tag)), other_code)


def _format_condition(tag: LaunchTag) -> str:
    return " and ".join(f"{name} {tag.attributes[name]}" for name in _CONDITION_ATTRIBUTES if name in tag.attributes)


def _read_action(tag: LaunchTag) -> Iterator[Entry]:
    """Yield the entries of an action: one for each parameter of a ``<rosparam>`` element."""
    parameters = read_written_parameters(tag.attributes, tag.text) if tag.name == _ROSPARAM_TAG else {}
    condition = _format_condition(tag)
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
        kind, name, settings = "node", _format_node_name(attributes), _read_node_settings(tag)
        if tag.name == "lifecycle_node":
            settings["lifecycle"] = "true"
    elif tag.name == TEST:
        kind, name, settings = TEST, _format_node_name(attributes), _read_node_settings(tag)
    elif tag.name == "executable":
        kind, name, settings = (
            "process",
            attributes.get("cmd", ""),
            {**_select_remaining_attributes(attributes), **_read_environment_settings(tag)},
        )
    elif tag.name == "include":
        kind, name, settings = "include", attributes.get("file", ""), _read_passed_arguments(tag)
    elif tag.name in _REMAPPING_TAGS:
        kind, name, settings = "remapping", attributes.get("from", ""), {"to": attributes.get("to", "")}
    elif tag.name in ("param", "set_parameter"):
        kind, settings = "parameter", {"value": _read_parameter_value(tag)}
    elif tag.name == _ROSPARAM_TAG and deletes_parameters(attributes):
        kind, name = DELETION, find_deleted_name(attributes)
    elif tag.name == _ROSPARAM_TAG:
        name = attributes.get("file") or attributes.get("param", "")
        kind, settings = "parameters", read_file_settings(attributes)
    elif tag.name in _ENVIRONMENT_TAGS:
        kind = "environment"
        key = {"append_env": "appended value", "unset_env": "unset"}.get(tag.name, "value")
        settings = {key: attributes.get("value", "true")}
    else:
        return None
    condition = _format_condition(tag)
    return Entry(kind, name, {**settings, **({CONDITION: condition} if condition else {})}, tag.span)


def _select_attributes(attributes: Mapping[str, str], names: Mapping[str, str]) -> dict[str, str]:
    return {names[key]: value for key, value in attributes.items() if key in names}


def _select_remaining_attributes(attributes: Mapping[str, str], ignored: Sequence[str] = ()) -> dict[str, str]:
    names = {"ns": NAMESPACE, "args": "arguments", "launch-prefix": "prefix"}
    ignored_names = {*_IGNORED_ATTRIBUTES, *_CONDITION_ATTRIBUTES, *ignored}
    return {names.get(key, key): value for key, value in attributes.items() if key not in ignored_names}


def _format_node_name(attributes: Mapping[str, str]) -> str:
    parts = (attributes.get("pkg"), attributes.get("exec") or attributes.get("type"), attributes.get("plugin"))
    return "/".join(part for part in parts if part)


def _read_node_settings(tag: LaunchTag) -> dict[str, str]:
    """Return the settings of a node from its attributes and children."""
    settings = _select_remaining_attributes(tag.attributes)
    files: list[str] = []
    deleted: list[str] = []
    for child in tag.children:
        attributes, condition = child.attributes, _format_condition(child)
        child_settings: dict[str, str] = {}
        if child.name in ("param", _ROSPARAM_TAG) and (attributes.get("from") or attributes.get("file")):
            items = [
                f"{name} {value}"
                for name, value in read_file_settings(attributes).items()
                if child.name == _ROSPARAM_TAG
            ]
            if attributes.get(ALLOW_SUBSTITUTIONS, "false").lower() not in ("false", "0"):
                items.append(ALLOW_SUBSTITUTIONS)
            items += filter(None, [condition])
            file = attributes.get("from") or attributes["file"]
            files.append(f"{file} ({', '.join(items)})" if items else file)
        elif child.name == "param":
            child_settings = _read_parameter_settings(child, "")
        elif child.name == _ROSPARAM_TAG and deletes_parameters(attributes):
            deleted.append(
                " ".join(filter(None, [find_deleted_name(attributes) or "~", condition and f"({condition})"]))
            )
        elif child.name == _ROSPARAM_TAG:
            parameters = read_written_parameters(attributes, child.text)
            child_settings = {f"{PARAMETER}{name}": value for name, value in parameters.items()}
            if not child_settings:
                name = attributes.get("param") or attributes.get("ns", "")
                child_settings = {f"{PARAMETER}{name}": attributes.get("command", "")}
        elif child.name == "remap":
            child_settings = {f"{REMAPPING}{attributes.get('from', '')}": attributes.get("to", "")}
        elif child.name == "extra_arg":
            child_settings = {f"extra argument {attributes.get('name', '')}": attributes.get("value", "")}
        settings |= {with_condition(name, condition): value for name, value in child_settings.items()}
    settings |= _read_environment_settings(tag)
    if deleted:
        settings["deleted parameters"] = f"[{', '.join(deleted)}]"
    return {**settings, "parameters": f"[{', '.join(files)}]"} if files else settings


def _read_environment_settings(tag: LaunchTag) -> dict[str, str]:
    """Return the environment variables that an action sets for its process, by name."""
    return {
        with_condition(
            f"{ENVIRONMENT}{child.attributes.get('name', '')}", _format_condition(child)
        ): child.attributes.get("value", "")
        for child in tag.children
        if child.name == "env"
    }


def _read_parameter_settings(tag: LaunchTag, path: str) -> dict[str, str]:
    """Return the value of a parameter by name, or the values of the parameters inside it."""
    name = f"{path}{tag.attributes.get('name', '')}"
    inner = [child for child in tag.children if child.name == "param"]
    if not inner:
        return {f"{PARAMETER}{name}": _read_parameter_value(tag)}
    parameters: dict[str, str] = {}
    for child in inner:
        parameters |= _read_parameter_settings(child, f"{name}.")
    return parameters


def _read_parameter_value(tag: LaunchTag) -> str:
    """Return the value of a parameter, or the file or command that it comes from."""
    keys = ("value", "textfile", "binfile", "command")
    text = next((tag.attributes[key] for key in keys if key in tag.attributes), tag.text)
    if not {"value", "textfile", "binfile"} & tag.attributes.keys() and "command" in tag.attributes:
        return f"$(command {text})"
    return _QUOTED_COMMAND.sub(r"$(command \2\3)", text)


def _read_passed_arguments(tag: LaunchTag) -> dict[str, str]:
    """Return the arguments that an include passes, and the namespace of the nodes in the file."""
    settings = {
        with_condition(child.attributes.get("name", ""), _format_condition(child)): child.attributes.get(
            "value", child.attributes.get("default", "")
        )
        for child in tag.children
        if child.name in ("arg", "let")
    }
    if tag.attributes.get("ns"):
        settings[NAMESPACE_OF_INCLUDED] = tag.attributes["ns"]
    if tag.attributes.get(PASSES_ALL_ARGUMENTS, "false").lower() not in ("false", "0"):
        settings[PASSES_ALL_ARGUMENTS] = "true"
    return {**settings, **_read_environment_settings(tag)}
