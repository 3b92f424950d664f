"""The elements and attributes that are allowed at a position in an XML file."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from linkwright.language.extension_schema import DESCRIPTION
from linkwright.language.launch_schema import LAUNCH
from linkwright.language.manifest_schema import PACKAGE
from linkwright.language.simulator_plugins import find_plugin
from linkwright.language.srdf_schema import SRDF
from linkwright.packages.manifest import MANIFEST
from linkwright.schema import AttributeRule, ElementRule, ValueType
from linkwright.sdf.worlds import SDF
from linkwright.xmltree.tokens import Token

_TEXT = ValueType("text")
_NAMES = ValueType("name")
_CONDITION = ValueType("true or false")


def _tag(name: str, meaning: str, *attributes: AttributeRule) -> ElementRule:
    return ElementRule(f"xacro:{name}", meaning, attributes, is_repeated=True)


XACRO = {
    rule.tag: rule
    for rule in (
        _tag(
            "property",
            "a named value, or a block of elements",
            AttributeRule("name", _NAMES, "the name in expressions", required=True),
            AttributeRule("value", _TEXT, "the value, which may contain expressions", usually_written=True),
            AttributeRule("default", _TEXT, "the value unless the property has one"),
            AttributeRule("scope", ValueType("parent or global"), "where it is defined", default="local"),
            AttributeRule("lazy_eval", _CONDITION, "whether it is evaluated when it is used", default="true"),
        ),
        _tag(
            "arg",
            "a value that the caller sets, as in xacro FILE NAME:=VALUE",
            AttributeRule("name", _NAMES, "the name in $(arg NAME)", required=True),
            AttributeRule("default", _TEXT, "the value if the caller passes none", usually_written=True),
        ),
        _tag(
            "include",
            "the content of another file",
            AttributeRule("filename", _TEXT, "the file; relative paths start at this file", required=True),
            AttributeRule("ns", _NAMES, "a namespace for its macros and properties"),
            AttributeRule("optional", _CONDITION, "whether the file may be missing", default="false"),
        ),
        _tag(
            "macro",
            "a piece of XML with parameters; a call is <xacro:NAME .../>",
            AttributeRule("name", _NAMES, "the name of the macro", required=True),
            AttributeRule("params", _TEXT, "the parameters: a, b:=default, *block, **blocks", usually_written=True),
        ),
        _tag(
            "if",
            "content for a true condition",
            AttributeRule("value", _CONDITION, "the condition", required=True),
        ),
        _tag(
            "unless",
            "content for a false condition",
            AttributeRule("value", _CONDITION, "the condition", required=True),
        ),
        _tag(
            "insert_block",
            "a block parameter, or a property that is a block",
            AttributeRule("name", _NAMES, "the name of the block", required=True),
        ),
        _tag(
            "call",
            "a call of a macro whose name is computed",
            AttributeRule("macro", _TEXT, "the name of the macro", required=True),
        ),
        _tag(
            "element",
            "an element whose name is computed",
            AttributeRule("xacro:name", _TEXT, "the name of the element", required=True),
        ),
        _tag(
            "attribute",
            "an attribute of the element around it",
            AttributeRule("name", _TEXT, "the name of the attribute", required=True),
            AttributeRule("value", _TEXT, "the value", required=True),
        ),
    )
}
"""The tags of xacro (ros/xacro 2.1), by name."""

PREFIX = "xacro:"


def root_of(path: Path) -> ElementRule | None:
    """Return the rule of a file's root element, derived from the file name, or None."""
    name = path.name.removesuffix(".xacro")
    if name.endswith((".sdf", ".world")):
        return SDF
    if name.endswith(".srdf"):
        return SRDF
    if is_launch_file(path):
        return LAUNCH
    if path.name == MANIFEST:
        return PACKAGE
    return DESCRIPTION if path.name.endswith((".urdf", ".xacro")) and not name.endswith(".launch") else None


def is_launch_file(path: Path) -> bool:
    """Return whether a file is a launch file in XML, by its name."""
    return path.name.endswith((".launch.xml", ".launch", "_launch.xml")) or path.name == "launch.xml"


def has_xacro(root: ElementRule) -> bool:
    """Return whether files with a root element may contain xacro's tags."""
    return root not in (LAUNCH, PACKAGE)


def rule_at(root: ElementRule, tags: Sequence[str], elements: Sequence[Token] = ()) -> ElementRule | None:
    """Return the rule of an element.

    The content of xacro tags belongs to the element around them. The content of a macro or a call may belong to any
    element, so the rule of its first tag is searched in the whole schema.

    Args:
        root: the rule of the root element.
        tags: the names of the elements from the root to the element.
        elements: their start tags, which determine the parameters of simulator plugins, or an empty sequence.
    """
    current: ElementRule | None = None
    for index, tag in enumerate(tags):
        if tag.startswith(PREFIX):
            continue
        if current is None:
            current = root if tag == root.tag else _find_rule(root, tag)
        else:
            current = current.child_rules.get(tag) or _rule_in_macro(root, tags, tag)
        if current is None:
            return None
        if tag == "plugin" and "filename" in current.attribute_rules and index < len(elements):
            current = _rule_of_plugin(elements[index]) or current
    return current


def _rule_of_plugin(element: Token) -> ElementRule | None:
    attributes = {attribute.name: attribute.value or "" for attribute in element.attributes()}
    plugin = find_plugin(attributes.get("filename", ""), attributes.get("name", ""))
    return None if plugin is None else plugin.rule


def _rule_in_macro(root: ElementRule, tags: Sequence[str], tag: str) -> ElementRule | None:
    is_call = any(other.startswith(PREFIX) and other not in XACRO for other in tags)
    return _find_rule(root, tag) if is_call or "xacro:macro" in tags else None


def _find_rule(root: ElementRule, tag: str) -> ElementRule | None:
    """Return the rule with a tag that is nearest to the root, or None."""
    pending, seen_ids = [root], {id(root)}
    for rule in pending:
        if rule.tag == tag:
            return rule
        for child in rule.child_rules.values():
            if id(child) not in seen_ids:
                seen_ids.add(id(child))
                pending.append(child)
    return None
