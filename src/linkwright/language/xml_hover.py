"""Explanations of the elements, attributes, values and names in an XML file."""

from __future__ import annotations

import math
from collections.abc import Sequence

from linkwright.diagnostics.translation import localized
from linkwright.language.cursor import Cursor, CursorSyntax, cursor_at, name_at
from linkwright.language.definitions import NameDefinition
from linkwright.language.expression_completion import FUNCTIONS, XACRO_FUNCTIONS, function_purpose, parameters_in_scope
from linkwright.language.extension_schema import HARDWARE_PLUGIN, PARAMETER_NAME
from linkwright.language.format import Document
from linkwright.language.grammar import PREFIX, XACRO, root_of, rule_at
from linkwright.language.hardware_plugins import hardware_parameters, hardware_plugins
from linkwright.language.hover import Explanation, definitions_at, describe_definition
from linkwright.language.parameters import called_macro, macro_parameters
from linkwright.language.simulator_plugins import SimulatorPlugin, find_plugin
from linkwright.language.xml_completion import describe_parameter
from linkwright.language.xml_values import find_element_at, find_hardware_plugin
from linkwright.schema import AttributeRule, ElementRule, describe_attribute, describe_element


def explain_at(document: Document, offset: int, names: Sequence[NameDefinition] = ()) -> Explanation | None:
    """Explain the name, element, attribute or value at an offset, or return None.

    Args:
        document: the text. The name of its file determines the language.
        offset: the character offset.
        names: the names that the files of the description define.
    """
    text = document.text
    cursor = cursor_at(text, offset)
    definitions = definitions_at(text, offset, names)
    if definitions:
        name = name_at(text, offset)
        start, end = (name[1], name[1] + len(name[0])) if name else (offset, offset)
        return Explanation("\n\n".join(map(describe_definition, definitions)), start, end)
    root = root_of(document.file)
    if root is None:
        return None
    if cursor.syntax is CursorSyntax.TEXT:
        return _explain_text(document, cursor, root)
    if cursor.token is None:
        return None
    if cursor.syntax is CursorSyntax.TAG:
        tags, elements = (*cursor.tags, cursor.token.name), (*cursor.elements, cursor.token)
        rule = XACRO.get(cursor.token.name) or rule_at(root, tags, elements)
        start = cursor.token.name_start
        return None if rule is None else Explanation(describe_element(rule), start, start + len(cursor.token.name))
    if cursor.attribute is not None:
        return _explain_word(cursor) or _explain_attribute(document, cursor, root, names)
    return None


def _explain_attribute(
    document: Document, cursor: Cursor, root: ElementRule, names: Sequence[NameDefinition]
) -> Explanation | None:
    assert cursor.attribute is not None
    name, start, end = cursor.attribute.name, cursor.attribute.start, cursor.attribute.end
    tag = cursor.tags[-1]
    if tag.startswith(PREFIX) and tag not in XACRO:
        macro = called_macro(tag, names)
        parameters = () if macro is None else macro_parameters(macro)
        macro_parameter = next((parameter for parameter in parameters if parameter.name == name), None)
        return (
            None
            if macro_parameter is None or macro is None
            else Explanation(describe_parameter(macro_parameter, macro), start, end)
        )
    rule = XACRO.get(tag) or rule_at(root, cursor.tags, cursor.elements)
    attribute = None if rule is None else rule.attribute_rules.get(name)
    if attribute is None:
        return None
    value = cursor.attribute.value or ""
    if cursor.syntax is CursorSyntax.VALUE:
        value_explanation = _explain_value(document, cursor, attribute, value)
        if value_explanation:
            return Explanation(value_explanation, start, end)
        angles = _describe_in_degrees(cursor, attribute, value)
        if angles:
            return Explanation(f"{localized(describe_attribute(attribute))}\n\n{angles}", start, end)
    return Explanation(describe_attribute(attribute), start, end)


def _describe_in_degrees(cursor: Cursor, rule: AttributeRule, value: str) -> str:
    """Return the angles of a value in degrees, or an empty text if it has other contents."""
    parent_attributes = {
        attribute.name: attribute.value for element in cursor.elements[-2:-1] for attribute in element.attributes()
    }
    if rule.unit != "rad" and (rule.unit != "rad or m" or parent_attributes.get("type") == "prismatic"):
        return ""
    try:
        angles = [math.degrees(float(word)) for word in value.split()]
    except ValueError:
        return ""
    return f"{value.strip()} rad = {' '.join(f'{angle:.4g}°' for angle in angles)}" if any(angles) else ""


def _explain_value(document: Document, cursor: Cursor, rule: AttributeRule, value: str) -> str:
    """Return the explanation of a simulator plugin or hardware parameter, or empty."""
    if cursor.tags[-1] == "plugin" and rule.name in ("filename", "name"):
        attributes = {attribute.name: attribute.value or "" for attribute in cursor.elements[-1].attributes()}
        plugin = find_plugin(attributes.get("filename", ""), attributes.get("name", ""))
        return "" if plugin is None else describe_plugin(plugin)
    if rule.type is PARAMETER_NAME and "hardware" in cursor.tags:
        plugin_name = find_hardware_plugin(document.text, find_element_at(document.text, cursor.elements[:-1]))
        parameter = hardware_parameters(document, plugin_name).get(value)
        return "" if parameter is None else f"**{value}**, {plugin_name}\n\n{parameter.meaning}"
    return ""


def describe_plugin(plugin: SimulatorPlugin) -> str:
    """Return the purpose and the parameters of a simulator plugin in Markdown."""
    name = plugin.class_name or plugin.filename
    parameters = ", ".join(f"`{child.tag}`" for child in plugin.rule.children)
    return f"**{name}**: {plugin.purpose}" + (f"\n\n{parameters}" if parameters else "")


def _explain_text(document: Document, cursor: Cursor, root: ElementRule) -> Explanation | None:
    """Explain the text inside an element, or return None."""
    rule = rule_at(root, cursor.tags, cursor.elements) if cursor.tags else None
    if rule is None or rule.text is None:
        return None
    begin = cursor.offset - len(cursor.typed)
    ends = document.text.find("<", cursor.offset)
    element_text = document.text[begin : ends if ends >= 0 else len(document.text)]
    value = element_text.strip()
    if not value:
        return None
    start = begin + element_text.index(value)
    if rule.text.type is HARDWARE_PLUGIN:
        purpose = hardware_plugins(document).get(value)
        parameters = ", ".join(f"`{name}`" for name in hardware_parameters(document, value))
        if purpose is not None:
            described = "\n\n".join(filter(None, (f"**{value}**: {purpose}", parameters)))
            return Explanation(described, start, start + len(value))
    return Explanation(describe_element(rule), start, start + len(value))


def _explain_word(cursor: Cursor) -> Explanation | None:
    """Explain the macro parameter or function at a cursor in an expression, or return None."""
    if cursor.syntax is not CursorSyntax.VALUE or not cursor.is_in_expression or cursor.token is None:
        return None
    name = name_at(cursor.token.text, cursor.offset - cursor.token.start)
    if name is None:
        return None
    word, start = name[0], name[1] + cursor.token.start
    parameter = next(
        (candidate for candidate in parameters_in_scope(cursor) if candidate.name == word.partition(".")[0]), None
    )
    if parameter is not None:
        default = "" if parameter.default is None else f" = `{parameter.default}`"
        return Explanation(f"**parameter {parameter.name}**{default}", start, start + len(word))
    purpose = XACRO_FUNCTIONS.get(word) or (function_purpose(word) if word in FUNCTIONS else "")
    return Explanation(f"`{word}`: {purpose}", start, start + len(word)) if purpose else None
