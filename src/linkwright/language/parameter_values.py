"""Complete values in ROS 2 parameter files, such as types, joints and frames."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from linkwright.diagnostics import phrase
from linkwright.diagnostics.translation import localized
from linkwright.language.completion import Completion, ItemKind
from linkwright.language.definitions import NameKind
from linkwright.language.format import Document
from linkwright.language.mentions import kinds_of_key
from linkwright.language.parameter_catalog import (
    ParameterInfo,
    controller_purpose,
    controller_types,
    plugin_types,
    plugins,
)
from linkwright.language.parameter_sections import Section
from linkwright.language.robot_names import robot_names
from linkwright.language.source_declarations import DeclaredParameter, declared_parameters
from linkwright.language.yaml_outline import YamlCursor
from linkwright.language.yaml_symbols import snippet_text

INTERFACE_NAMES = ("position", "velocity", "effort", "acceleration")
_USUAL_FRAMES = ("map", "odom", "base_link", "base_footprint")
"""Frames of mobile platforms (REP 105)."""
_INTERFACE_KEY = re.compile(r"(^|_)(command_|state_)?interfaces?(_names?)?$")
_CAPITALIZED_BOOLEAN = re.compile(r":[ \t]+(?:True|False)\b")
_LOWERCASE_BOOLEAN = re.compile(r":[ \t]+(?:true|false)\b")
_CPP_PLUGIN_NAME = re.compile(r"plugin:[ \t]+[\"']?nav2_(?!costmap_2d)\w+::|plugin:[ \t]+[\"']?dwb_core::")
_SENSOR_TOPICS = ("/scan", "/points")


def find_declared_parameters(document: Document, section: Section) -> list[DeclaredParameter]:
    """Return the parameters that the sources of a section's node declare.

    The result is empty for patterns, known nodes, controller managers and declared controllers.
    """
    if not section.may_be_controller or section.node in section.controllers:
        return []
    return declared_parameters(document, section.node)


def kinds_of_parameter(key: str) -> tuple[NameKind, ...]:
    """Return the kinds of names that a parameter may contain, derived from its key."""
    last = key.rpartition(".")[2]
    return kinds_of_key(last)


def parameter_values(document: Document, section: Section, cursor: YamlCursor) -> Iterator[Completion]:
    """Yield the values that a parameter may have, the most likely first."""
    name = section.prefix
    last = name.rpartition(".")[2]
    parameter = section.find(name)
    needs_brackets = parameter is not None and parameter.type.endswith("_array") and not cursor.is_in_list

    def item(label: str, kind: ItemKind = ItemKind.VALUE, detail: str = "", description: str = "") -> Completion:
        snippet = f"[{snippet_text(label)}$0]" if needs_brackets and not label.startswith("[") else ""
        return Completion(label, kind, cursor.start, detail, description, snippet)

    present = {text for text, start in cursor.parent_entry.items() if start != cursor.start}
    if last == "type" and (section.is_manager or (section.may_be_controller and name == "type")):
        for type_name in _sort_by_resemblance(controller_types(), name.rpartition(".")[0] or section.node):
            yield item(type_name, description=controller_purpose(type_name) or "")
    elif last in ("plugin", "primary_controller"):
        uses_colons = _CPP_PLUGIN_NAME.search(document.text) is not None
        for type_name in _list_plugin_types(section, name.rpartition(".")[0], last):
            yield item(type_name.replace("/", "::") if uses_colons else type_name)
    elif _is_boolean(document, section, name):
        counts = [len(pattern.findall(document.text)) for pattern in (_LOWERCASE_BOOLEAN, _CAPITALIZED_BOOLEAN)]
        is_capital = cursor.typed[:1].isupper() if cursor.typed else counts[1] > counts[0]
        for word in ("true", "false"):
            mark = "" if parameter is None else _mark_default(parameter, word)
            yield item(word.title() if is_capital else word, detail=mark)
    elif parameter is not None and parameter.choices:
        for choice in parameter.choices:
            yield item(choice, detail=_mark_default(parameter, choice))
    elif _INTERFACE_KEY.search(last):
        for interface in INTERFACE_NAMES:
            if interface not in present:
                yield item(interface)
    elif any(plugin.list_parameter == last for plugin in plugins().values()):
        for entry in section.entry.children:
            if entry.child("plugin") is not None and entry.key not in present:
                yield item(entry.key, ItemKind.NAME)
    else:
        default = parameter.default_text if parameter is not None else ""
        for label, detail in _list_robot_values(document, last, default):
            if label not in present:
                yield item(label, ItemKind.NAME, detail)
    if last == "topic" and name.count("."):
        for topic in ("cmd_vel",) if section.node == "twist_mux" else _SENSOR_TOPICS:
            yield item(topic)
    if parameter is not None and not cursor.is_in_list and parameter.default_text and not parameter.choices:
        default = parameter.default_text
        if parameter.type != "bool":
            yield item(default, detail=localized(phrase("default")))


def _is_boolean(document: Document, section: Section, name: str) -> bool:
    parameter = section.find(name)
    if parameter is not None:
        return parameter.type == "bool"
    return any(
        declared.name == name and declared.type == "bool" for declared in find_declared_parameters(document, section)
    )


def _mark_default(parameter: ParameterInfo, word: str) -> str:
    return localized(phrase("default")) if parameter.default_text.strip('"') == word else ""


def _list_robot_values(document: Document, key: str, default: str) -> Iterator[tuple[str, str]]:
    """Yield the joints or frames for a parameter with a detail, the default frame first."""
    kinds = kinds_of_parameter(key)
    if not kinds:
        return
    if default in _USUAL_FRAMES:
        yield default, localized(phrase("default"))
    parts = robot_names(document)
    if NameKind.JOINT in kinds:  # List the movable joints first.
        parts.sort(key=lambda name: name.detail == "fixed")
    for name in parts:
        if name.kind in kinds:
            yield name.name, name.detail or name.kind.value
    if NameKind.LINK in kinds:
        for frame in _USUAL_FRAMES:
            yield frame, "REP 105"


def _sort_by_resemblance(types: Iterable[str], name: str) -> list[str]:
    """Sort types by their resemblance to the name of a controller or plugin."""
    words = [word for word in re.split(r"\W|_|(?<=[a-z])(?=[A-Z])", name) if word]

    def rank(kind: str) -> int:
        return -sum(len(word) for word in words if word.lower() in kind.lower())

    return sorted(types, key=rank)


def _list_plugin_types(section: Section, plugin: str, key: str) -> list[str]:
    """Return the possible types of a plugin, restricted by the parameter that lists it."""
    if key == "primary_controller":
        return plugin_types(section.node, "controller_plugins")
    entries = section.entries()
    for list_parameter in dict.fromkeys(known_plugin.list_parameter for known_plugin in plugins().values()):
        entry, parameter = entries.get(list_parameter), section.find(list_parameter)
        names = [parameter.default] if parameter is not None else []
        if entry is not None:
            names = [[text for text, _ in entry.items()], entry.scalar]
        if any(plugin == name or (isinstance(name, list) and plugin in name) for name in names):
            return _sort_by_resemblance(plugin_types(section.node, list_parameter), plugin)
    return _sort_by_resemblance(
        plugin_types(section.node) or [known_plugin.type for known_plugin in plugins().values()], plugin
    )
