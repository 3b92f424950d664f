"""The format of ROS 2 parameter files and other YAML files, with hover and definitions."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from linkwright.diagnostics import phrase
from linkwright.diagnostics.translation import localized
from linkwright.language.definitions import NameDefinition, NameKind
from linkwright.language.format import Document, Format, Target
from linkwright.language.hover import Explanation
from linkwright.language.hover_facts import describe_part, robots_of
from linkwright.language.parameter_catalog import controller_purpose, load_tables, node_parameters, plugins
from linkwright.language.parameter_completion import complete_parameters, describe_parameter_info
from linkwright.language.parameter_sections import (
    PARAMETERS_KEY,
    Section,
    controller_declarations,
    declared_controllers,
    node_of,
    section_at,
)
from linkwright.language.parameter_values import find_declared_parameters, kinds_of_parameter
from linkwright.language.robot_names import robot_names, written_length
from linkwright.language.yaml_outline import YamlCursor, YamlEntry, YamlOutline, YamlPosition
from linkwright.language.yaml_symbols import yaml_symbols

_SUFFIXES = (".yaml", ".yml")
_LAUNCH_SUFFIXES = (".launch.yaml", ".launch.yml", "_launch.yaml", "_launch.yml")


def is_parameter_file(file: Path) -> bool:
    """Return whether a file may contain parameters: YAML, except launch files."""
    return file.name.endswith(_SUFFIXES) and not file.name.endswith(_LAUNCH_SUFFIXES)


# --- explanations -----------------------------------------------------------------------------------------------------


def explain_parameter(document: Document, offset: int) -> Explanation | None:
    """Explain the key or value at an offset of a parameter file, or return None."""
    outline = YamlOutline(document.text)
    cursor = outline.cursor(offset)
    start, end, word = word_at(document.text, cursor)
    if not word:
        return None
    if cursor.position is YamlPosition.KEY and cursor.entry is not None:
        text = _explain_key(document, outline, cursor.entry)
    else:
        text = _explain_value(document, outline, cursor, word)
    return None if not text else Explanation(text, start, end)


def word_at(text: str, cursor: YamlCursor) -> tuple[int, int, str]:
    """Return the range of the key or value at a cursor, and its text without quotes."""
    if cursor.position is YamlPosition.NOTHING:
        return cursor.offset, cursor.offset, ""
    if cursor.position is YamlPosition.KEY:
        entry = cursor.entry
        if entry is None:
            return cursor.offset, cursor.offset, ""
        start = entry.start + (1 if text[entry.start : entry.start + 1] in ("'", '"') else 0)
        return start, start + len(entry.key), entry.key
    start = end = cursor.start
    stops = "\n,]}#" if cursor.is_in_list else "\n#"
    quote = text[start - 1 : start] if start and text[start - 1] in "\"'" else ""
    while end < len(text) and text[end] not in (quote or stops) and text[end] != "\n":
        end += 1
    word = text[start:end].rstrip()
    return start, start + len(word), word


def _explain_key(document: Document, outline: YamlOutline, entry: YamlEntry) -> str:
    if entry.key == PARAMETERS_KEY:
        return localized(phrase("the parameters of the node")) + (f" **{node}**" if (node := node_of(entry)) else "")
    section = section_at(outline, entry.parent) if entry.parent is not None else None
    if section is None:
        return _explain_node(outline, entry)
    kind = entry.child("type")
    if section.is_manager and not section.prefix and kind is not None:
        return f"**{entry.key}** `{kind.scalar}`\n\n{controller_purpose(kind.scalar) or ''}".strip()
    if entry.key == "type" and (section.is_manager or section.may_be_controller):
        purpose = controller_purpose(entry.scalar)
        text = localized(phrase("the type of the controller"))
        return f"**type** `string`\n\n{text}" + (f"\n\n`{entry.scalar}`: {purpose}" if purpose else "")
    name = section.name(entry.key)
    parameter = section.find(name)
    if parameter is not None:
        return describe_parameter_info(parameter, name)
    if entry.key == "plugin":
        return _explain_plugin(entry.scalar)
    plugin = entry.child("plugin")
    if plugin is not None:
        return f"**{entry.key}** " + _explain_plugin(plugin.scalar)
    declaration = next(
        (declared for declared in find_declared_parameters(document, section) if declared.name == name), None
    )
    if declaration is not None:
        default = f" = `{declaration.default}`" if declaration.default else ""
        return f"**{name}** `{declaration.type}`{default}\n\n`{declaration.file.name}`".replace(" ``", "")
    declared_names = [declaration.name for declaration in find_declared_parameters(document, section)]
    nested_names = {
        parameter.removeprefix(f"{name}."): None for parameter in declared_names if parameter.startswith(f"{name}.")
    }
    nested_names |= {
        inner_name: None for parameter in section.parameters() if (inner_name := parameter.relative_name(name))
    }
    facts = explain_part(document, entry.key, (NameKind.JOINT, NameKind.LINK))
    if facts:
        return facts
    return f"**{name}**: " + ", ".join(f"`{inner_name}`" for inner_name in nested_names) if nested_names else ""


def _explain_node(outline: YamlOutline, entry: YamlEntry) -> str:
    if "*" in entry.key:
        return f"**{entry.key}**\n\n" + localized(phrase("the parameters of all nodes whose names match this pattern"))
    node = [part for part in entry.key.split("/") if part][-1:]
    name = node[0] if node else ""
    kind = declared_controllers(outline).get(name)
    if kind is not None:
        return f"**{name}** `{kind}`\n\n{controller_purpose(kind) or ''}".strip()
    parameters = node_parameters(name)
    if not parameters:
        return ""
    names = ", ".join(f"`{parameter.name}`" for parameter in parameters[:30])
    return f"**{name}**: {names}" + (", ..." if len(parameters) > 30 else "")


def _explain_plugin(kind: str) -> str:
    plugin = plugins().get(kind.replace("::", "/"))
    if plugin is None:
        return f"`{kind}`" if kind else ""
    names = ", ".join(f"`{parameter.name}`" for parameter in plugin.parameters)
    text = localized(phrase("plugin of {node}", node=plugin.node))
    return f"`{kind}`, {text}: {plugin.purpose}" + (f"\n\n{names}" if names else "")


def _explain_value(document: Document, outline: YamlOutline, cursor: YamlCursor, word: str) -> str:
    section = section_at(outline, cursor.parent_entry)
    if section is None:
        return ""
    last = section.prefix.rpartition(".")[2]
    purpose = controller_purpose(word)
    if purpose is not None:
        return f"`{word}`: {purpose}"
    if word.replace("::", "/") in plugins():
        return _explain_plugin(word)
    facts = explain_part(document, word, kinds_of_parameter(last))
    if facts:
        return facts
    parameter = section.find(section.prefix)
    return "" if parameter is None else describe_parameter_info(parameter, section.prefix)


def explain_part(document: Document, name: str, kinds: tuple[NameKind, ...]) -> str:
    """Return the facts about a link or joint in the robots that a file probably means."""
    for part in robot_names(document):
        if part.name == name and part.kind in kinds:
            robots = robots_of(document.workspace, document.texts, part.file)
            facts = next((facts for robot in robots if (facts := describe_part(robot, part.kind, name))), "")
            return f"**{part.kind.value} {name}**, {part.file.name}\n\n{facts}"
    return ""


# --- definitions ------------------------------------------------------------------------------------------------------


def define_in_parameters(document: Document, offset: int) -> Iterator[Target]:
    """Yield the definition of the controller, plugin, parameter, joint or link at an offset."""
    outline = YamlOutline(document.text)
    cursor = outline.cursor(offset)
    _, _, word = word_at(document.text, cursor)
    if not word:
        return
    section = section_at(outline, cursor.parent_entry)
    kinds: tuple[NameKind, ...] = ()
    if section is not None:
        key = section.prefix.rpartition(".")[2]
        kinds = kinds_of_parameter(key) if cursor.position is YamlPosition.VALUE else (NameKind.JOINT, NameKind.LINK)
    declaration = _find_declaration(outline, section, cursor, word)
    if declaration is not None:
        yield Target(document.file, declaration.start, declaration.start + len(declaration.key))
        return
    if section is not None and cursor.position is YamlPosition.KEY:
        name_in_section = section.name(word)
        for source in find_declared_parameters(document, section):
            if source.name == name_in_section:
                yield Target(source.file, source.start, source.start + len(source.name))
                return
    for name in robot_names(document):
        if name.name == word and (name.kind in kinds or (not kinds and cursor.is_in_list)):
            yield target_of(document, name)
            return


def _find_declaration(outline: YamlOutline, section: Section | None, cursor: YamlCursor, word: str) -> YamlEntry | None:
    """Return the entry that declares the controller or plugin at a cursor, or None."""
    if cursor.position is YamlPosition.VALUE and section is not None:
        entry = section.entry.child(word)
        if entry is not None and entry.children:
            return entry
    if cursor.position is YamlPosition.KEY and section is not None and not section.is_manager:
        return None
    kind = controller_declarations(outline).get(word.rpartition("/")[2])
    entry = kind if kind is None or kind.key != "type" else kind.parent
    if entry is not None and entry.key == PARAMETERS_KEY:
        entry = entry.parent
    if entry is not None and entry is cursor.entry:
        return next((other for other in outline.root.all() if other.key == word and other is not entry), None)
    return entry


def target_of(document: Document, name: NameDefinition) -> Target:
    """Return the location of the name of a link or joint."""
    return Target(name.file, name.start, name.start + written_length(document.other(name.file), name))


PARAMETER_FILES = Format(
    covers=is_parameter_file,
    complete=complete_parameters,
    explain=explain_parameter,
    define=define_in_parameters,
    symbols=yaml_symbols,
    prepare=load_tables,
)
