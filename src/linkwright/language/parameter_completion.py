"""Complete nodes, controllers and parameters in ROS 2 parameter files."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from linkwright.diagnostics import Phrase, phrase
from linkwright.diagnostics.translation import localized
from linkwright.language.completion import Completion, ItemKind
from linkwright.language.definitions import NameKind
from linkwright.language.format import Document
from linkwright.language.parameter_catalog import (
    ParameterInfo,
    controller_purpose,
    controller_types,
    node_names,
    node_parameters,
    plugin_types,
    plugins,
)
from linkwright.language.parameter_sections import (
    PARAMETERS_KEY,
    Section,
    declared_controllers,
    node_of,
    section_at,
    sections,
)
from linkwright.language.parameter_values import find_declared_parameters, kinds_of_parameter, parameter_values
from linkwright.language.robot_names import robot_names
from linkwright.language.yaml_outline import YamlCursor, YamlEntry, YamlOutline, YamlPosition
from linkwright.language.yaml_symbols import has_colon, snippet_text, sort_by_match

_USUAL_CONTROLLERS = (
    "joint_state_broadcaster/JointStateBroadcaster",
    "joint_trajectory_controller/JointTrajectoryController",
    "diff_drive_controller/DiffDriveController",
)
_NUMBERED = re.compile(r"[a-z]+\d+(_|$)")
"""A parameter of one of several sensors, such as ``odom0_config``."""
_MAX_FILES = 40
_COSTMAP_NODES = ("local_costmap", "global_costmap")


def complete_parameters(document: Document, offset: int) -> list[Completion]:
    """Return the completions at an offset of a parameter file, the most likely first."""
    outline = YamlOutline(document.text)
    cursor = outline.cursor(offset)
    if cursor.position is YamlPosition.NOTHING:
        return []
    section = section_at(outline, cursor.parent_entry)
    items: Iterable[Completion]
    if cursor.position is YamlPosition.KEY:
        colon = "" if has_colon(document.text, offset) else ":"
        items = (
            _offer_node_keys(outline, cursor, colon)
            if section is None
            else _offer_parameters(document, section, cursor, colon)
        )
    else:
        items = () if section is None else parameter_values(document, section, cursor)
    return sort_by_match(items, cursor.typed)


def _offer_node_keys(outline: YamlOutline, cursor: YamlCursor, colon: str) -> Iterator[Completion]:
    """Yield the keys outside ``ros__parameters``: nodes, and ``ros__parameters`` itself."""
    others = [child for child in cursor.parent_entry.children if child is not cursor.entry]
    present = {child.key for child in others}
    is_top = cursor.parent_entry.parent is None
    if is_top and others and not any(sections(outline)):
        return  # This is another kind of file.
    body, parent_key = f"{PARAMETERS_KEY}:\n    $0", cursor.parent_entry.key
    if not is_top:
        if parent_key in _COSTMAP_NODES and len(cursor.parent_entry.path) == 1 and not present:
            yield _make_key_completion(cursor, parent_key, "node", "", colon and f"{parent_key}:\n  {body}")
        if PARAMETERS_KEY not in present:
            text = phrase("the parameters of the node")
            yield _make_key_completion(cursor, PARAMETERS_KEY, "", text, colon and f"{PARAMETERS_KEY}:\n  $0")
        if "ros__parameters" in present:
            return
    if is_top and "/**" not in present:
        text = phrase("parameters of all nodes")
        yield _make_key_completion(cursor, "/**", "", text, colon and f"/**:\n  {body}")
    for name, kind in declared_controllers(outline).items():
        if name not in present:
            yield _make_key_completion(
                cursor, name, kind, controller_purpose(kind) or "", colon and f"{name}:\n  {body}"
            )
    for name in node_names():
        if name not in present:
            yield _make_key_completion(
                cursor, name, "node", _join_names(node_parameters(name)), colon and f"{name}:\n  {body}"
            )


def _make_key_completion(
    cursor: YamlCursor, label: str, detail: str, description: str | Phrase, snippet: str
) -> Completion:
    return Completion(label, ItemKind.ATTRIBUTE, cursor.start, detail, description, snippet)


def _join_names(parameters: Iterable[ParameterInfo]) -> str:
    return ", ".join(f"`{parameter.name}`" for parameter in parameters)


def _offer_parameters(document: Document, section: Section, cursor: YamlCursor, colon: str) -> Iterator[Completion]:
    """Yield the parameters and groups at a position in ``ros__parameters``."""
    present = {child.key for child in cursor.parent_entry.children if child is not cursor.entry}
    if section.is_manager:
        yield from _offer_manager_keys(section, cursor, colon)
    prefix_parts = section.prefix.split(".") if section.prefix else []
    yield from _offer_plugin_keys(section, cursor, colon, present)
    yield from _offer_parameters_of_sources(document, section, cursor, colon, present)
    groups: dict[str, list[str]] = {}
    dotted: list[Completion] = []
    for parameter in sorted(section.parameters(), key=lambda parameter: bool(_NUMBERED.match(parameter.name))):
        parts = parameter.name.split(".")
        if len(parts) <= len(prefix_parts) or any(a not in ("*", b) for a, b in zip(parts, prefix_parts, strict=False)):
            continue
        remaining_parts = parts[len(prefix_parts) :]
        first_names = (
            _find_names_for(document, section, parameter) if remaining_parts[0] == "*" else [remaining_parts[0]]
        )
        for first in first_names:
            if len(remaining_parts) == 1 and first not in present:
                yield _make_parameter_completion(cursor, first, parameter, colon)
            elif len(remaining_parts) > 1:
                groups.setdefault(first, []).append(".".join(remaining_parts[1:]))
                name = ".".join([first, *remaining_parts[1:]])
                if "*" not in name and name not in present:
                    dotted.append(_make_parameter_completion(cursor, name, parameter, colon))
    yield from _offer_keys_of_other_files(document, section, cursor, colon, present)
    uses_dots = any("." in name for name in present)
    yield from dotted if uses_dots else ()
    for name, inner_names in groups.items():
        if name not in present:
            names = ", ".join(f"`{part}`" for part in dict.fromkeys(inner_names))
            yield Completion(name, ItemKind.NAME, cursor.start, "", names, colon and f"{snippet_text(name)}:\n  $0")
    yield from dotted


def _offer_parameters_of_sources(
    document: Document, section: Section, cursor: YamlCursor, colon: str, present: set[str]
) -> Iterator[Completion]:
    """Yield the parameters that the sources of a node of the workspace declare."""
    for parameter in find_declared_parameters(document, section):
        prefix = f"{section.prefix}." if section.prefix else ""
        if parameter.name.startswith(prefix):
            first, _, remainder = parameter.name.removeprefix(prefix).partition(".")
            if first not in present:
                detail = f"{parameter.type} = {parameter.default}" if parameter.default else parameter.type
                end = ":\n  $0" if remainder else ": $0"
                snippet = colon and snippet_text(first) + end
                yield _make_key_completion(
                    cursor, first, "" if remainder else detail, f"`{parameter.file.name}`", snippet
                )


def _offer_keys_of_other_files(
    document: Document, section: Section, cursor: YamlCursor, colon: str, present: set[str]
) -> Iterator[Completion]:
    """Yield the keys at this position in other parameter files, for an unknown node."""
    if not section.may_be_controller or section.node in section.controllers:
        return
    for file in [*document.workspace.configuration_files(document.file)][:_MAX_FILES]:
        text = document.other(file) if file != document.file and file.name.endswith((".yaml", ".yml")) else ""
        for entry in sections(YamlOutline(text)) if f"{section.node}:" in text else ():
            section_entry: YamlEntry | None = entry if node_of(entry) == section.node else None
            for key in section.prefix.split(".") if section.prefix else ():
                section_entry = None if section_entry is None else section_entry.child(key)
            for child in () if section_entry is None else section_entry.children:
                if child.key and child.key not in present:
                    detail = f"{file.name}: {child.value[:40]}" if child.value else file.name
                    end = ":\n  $0" if child.children else ": $0"
                    yield _make_key_completion(cursor, child.key, detail, "", colon and snippet_text(child.key) + end)


def _offer_plugin_keys(section: Section, cursor: YamlCursor, colon: str, present: set[str]) -> Iterator[Completion]:
    """Yield the listed plugins without a section, or the key ``plugin`` in such a section."""
    entries = section.entries()
    for list_parameter in dict.fromkeys(plugin.list_parameter for plugin in plugins().values()):
        entry = entries.get(list_parameter)
        names = [] if entry is None else [text for text, _ in entry.items()] or [entry.scalar]
        if section.prefix in names and "plugin" not in present:
            text = phrase("the type of the plugin")
            yield _make_key_completion(cursor, "plugin", "string", text, colon and "plugin: $0")
        if not section.prefix and (not section.node or plugin_types(section.node, list_parameter)):
            for name in names:
                if name and name not in present:
                    yield _make_key_completion(
                        cursor, name, list_parameter, "", colon and f"{snippet_text(name)}:\n  plugin: $0"
                    )


def _make_parameter_completion(cursor: YamlCursor, label: str, parameter: ParameterInfo, colon: str) -> Completion:
    default = parameter.default_text
    detail = f"{parameter.type} = {default}" if default else parameter.type
    value = f"${{1:{snippet_text(default)}}}" if default and len(default) <= 40 else "$0"
    snippet = colon and f"{snippet_text(label)}: {value}"
    return Completion(
        label, ItemKind.ATTRIBUTE, cursor.start, detail, describe_parameter_info(parameter, label), snippet
    )


def describe_parameter_info(parameter: ParameterInfo, name: str = "") -> str:
    """Return the description of a parameter in Markdown.

    Args:
        parameter: a parameter of the catalog.
        name: the name to show instead of a name with ``*``.
    """
    default = parameter.default_text
    head = f"**{name or parameter.name}**" + (f" `{parameter.type}`" if parameter.type else "")
    lines = [head + (f" = `{default}`" if default else "")]
    if parameter.description:
        lines.append(parameter.description[:1].upper() + parameter.description[1:].rstrip("."))
    if parameter.choices:
        choices = ", ".join(f"`{choice}`" for choice in parameter.choices)
        lines.append(localized(phrase("one of {choices}", choices=choices)))
    if parameter.owner:
        lines.append(f"*{parameter.owner}*")
    return "\n\n".join(lines)


def _find_names_for(document: Document, section: Section, parameter: ParameterInfo) -> list[str]:
    """Return the names for ``*``: the names in its list parameters, or all movable joints."""
    entries = section.entries()
    names = [
        name
        for key in parameter.keys
        if key in entries
        for name in ([text for text, _ in entries[key].items()] or entries[key].scalar.split())
        if name
    ]
    if names or not parameter.keys or not any(kinds_of_parameter(key) for key in parameter.keys):
        return names
    parts = robot_names(document)
    return [name.name for name in parts if name.kind is NameKind.JOINT and name.detail != "fixed"]


def _offer_manager_keys(section: Section, cursor: YamlCursor, colon: str) -> Iterator[Completion]:
    if section.prefix:
        if "." not in section.prefix and cursor.parent_entry.child("type") in (None, cursor.entry):
            text = phrase("the type of the controller")
            yield _make_key_completion(cursor, "type", "string", text, colon and "type: $0")
        return
    present = {child.key for child in cursor.parent_entry.children}
    for kind in dict.fromkeys((*_USUAL_CONTROLLERS, *controller_types())):
        package, _, name = kind.partition("/")
        if package.endswith("controllers"):
            package = re.sub(r"(?<!^)(?=[A-Z])", "_", name).lower()
        if package not in present:
            snippet = colon and f"{package}:\n  type: {kind}"
            yield _make_key_completion(cursor, package, kind, controller_purpose(kind) or "", snippet)
