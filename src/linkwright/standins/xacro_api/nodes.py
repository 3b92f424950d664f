"""Functions of the module ``xacro`` that operate on minidom nodes."""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from typing import Any
from xml.dom import minidom

from linkwright.diagnostics import phrase
from linkwright.standins.xacro_api import color
from linkwright.standins.xacro_api.errors import XacroException
from linkwright.standins.xacro_api.evaluation import eval_text, get_boolean_value, is_valid_name
from linkwright.standins.xacro_api.macros import Macro, parse_macro_arg
from linkwright.standins.xacro_api.stacks import STATE, print_location
from linkwright.standins.xacro_api.tables import NameSpace, Table

_ELEMENT, _TEXT, _COMMENT = minidom.Node.ELEMENT_NODE, minidom.Node.TEXT_NODE, minidom.Node.COMMENT_NODE
_MARKER = minidom.Document().createTextNode("\n\n")
"""Marks the position up to which comments have been checked. The single marker is moved along."""


def first_child_element(elt: Any) -> Any:
    """Return the first child element of a node, or None."""
    return next((child for child in elt.childNodes if child.nodeType == _ELEMENT), None)


def next_sibling_element(node: Any) -> Any:
    """Return the next sibling element of a node, or None."""
    node = node.nextSibling
    while node is not None and node.nodeType != _ELEMENT:
        node = node.nextSibling
    return node


def replace_node(node: Any, by: Any, content_only: bool = False) -> None:
    """Replace a node with other nodes, or remove it.

    Args:
        node: the node to replace.
        by: a node or a list of nodes to insert; None to remove `node`.
        content_only: whether to insert the children of the new nodes instead of the nodes.
    """
    parent = node.parentNode
    for new_node in by if isinstance(by, list) else [] if by is None else [by]:
        for childNode in list(new_node.childNodes) if content_only else [new_node]:
            parent.insertBefore(childNode, node)
    parent.removeChild(node)


def attribute(tag: Any, a: str) -> str | None:
    """Return the value of an attribute, or None if the element does not have it."""
    return tag.getAttribute(a) if tag.hasAttribute(a) else None


def opt_attrs(tag: Any, attrs: Sequence[str]) -> list[str | None]:
    """Return the values of attributes, with None for missing attributes."""
    return [attribute(tag, name) for name in attrs]


def reqd_attrs(tag: Any, attrs: Sequence[str]) -> list[str]:
    """Return the values of required attributes.

    Raises:
        RuntimeError: an attribute is missing.
    """
    for name in attrs:
        if not tag.hasAttribute(name):
            raise RuntimeError(phrase("'{tag}' needs the attribute '{name}'", tag=tag.nodeName, name=name))
    return [tag.getAttribute(name) for name in attrs]


def check_attrs(tag: Any, required: Sequence[str], optional: Sequence[str]) -> list[Any]:
    """Return the values of required and optional attributes, and warn about other attributes.

    Raises:
        RuntimeError: a required attribute is missing.
    """
    values = [*reqd_attrs(tag, required), *opt_attrs(tag, optional)]
    unexpected_names = [name for name in tag.attributes.keys() if name not in (*required, *optional)]  # noqa: SIM118 - not a dict
    unexpected_names = [name for name in unexpected_names if not name.startswith("xmlns:")]
    if unexpected_names:
        color.warning(f"'{tag.nodeName}' has unknown attributes: {', '.join(map(repr, unexpected_names))}")
        if STATE.verbosity > 0:
            print_location()
    return values


def import_xml_namespaces(parent: Any, attributes: Any) -> None:
    """Copy namespace declarations to an element, and warn about conflicting declarations."""
    for name, value in attributes.items():
        if not name.startswith("xmlns:"):
            continue
        if parent.hasAttribute(name) and parent.getAttribute(name) != value:
            color.warning(
                phrase(
                    "'{name}' is declared as '{value}' here, but as '{declared}' in an enclosing element",
                    name=name,
                    value=value,
                    declared=parent.getAttribute(name),
                )
            )
        else:
            parent.setAttribute(name, value)


def remove_previous_comments(node: Any) -> None:
    """Remove the comments directly above a node, up to a blank line or text."""
    next_node, previous_node = node.nextSibling, node.previousSibling
    while previous_node is not None:
        if previous_node.nodeType == _TEXT and previous_node.data.isspace() and previous_node.data.count("\n") <= 1:
            previous_node = previous_node.previousSibling
        if previous_node is None or previous_node.nodeType != _COMMENT:
            if next_node is not None and next_node is not _MARKER:
                if _MARKER.parentNode is not None:
                    _MARKER.parentNode.removeChild(_MARKER)
                node.parentNode.insertBefore(_MARKER, next_node)
            return
        comment, previous_node = previous_node, previous_node.previousSibling
        node.parentNode.removeChild(comment)


def grab_macro(elt: Any, macros: dict[str, Any]) -> None:
    """Move the definition of a macro from the document to a table of macros.

    Raises:
        XacroException: the name or the parameters are invalid.
    """
    remove_previous_comments(elt)
    name, params = check_attrs(elt, ["name"], ["params"])
    if name == "call" or "." in name:
        raise XacroException(f"a macro cannot be named '{name}'")
    if name.startswith("xacro:"):
        color.warning(f"macro names must not contain prefix 'xacro:': {name}")
        name = name.removeprefix("xacro:")
    macro = macros[name] if name in macros else Macro()
    macro.name, macro.body = name, elt
    macro.history.append(copy.copy(STATE.filestack or [None]))
    macro.params, macro.defaultmap = [], {}
    while params and params.strip():
        parameter, default, params = parse_macro_arg(params)
        macro.params.append(parameter)
        if default is not None:
            macro.defaultmap[parameter] = default
    macros[name] = macro
    replace_node(elt, by=None)


def grab_property(elt: Any, table: Table) -> None:
    """Move the definition of a property from the document to a table of properties.

    Raises:
        XacroException: the name or the attributes are invalid.
    """
    remove_previous_comments(elt)
    name, value, default, remove, scope, lazy = check_attrs(
        elt, ["name"], ["value", "default", "remove", "scope", "lazy_eval"]
    )
    name = eval_text(name, table)
    if not isinstance(name, str) or not is_valid_name(name) or name.startswith("__"):
        raise XacroException(phrase("'{name}' cannot be the name of a property", name=name))
    is_removal = _parse_boolean(remove, table, default=False)
    if (value is not None) + (default is not None) + is_removal > 1:
        raise XacroException(
            phrase("the property '{name}' has more than one of 'value', 'default' and 'remove'", name=name)
        )
    replace_node(elt, by=None)
    if is_removal:
        if name in table:
            del table[name]
        return
    if value is None and default is not None:
        if name in table:
            return
        value = default
    if value is None:
        Table._setitem(table, f"**{name}", elt, unevaluated=False)
        return
    target = _find_target_table(table, scope)
    if target is table and _parse_boolean(lazy, table, default=True):
        table._setitem(name, value, unevaluated=True)
    else:
        target._setitem(name, eval_text(value, table), unevaluated=False)


def eval_default_arg(forward_variable: str | None, default: str | None, symbols: Mapping[str, Any], macro: Any) -> Any:
    """Return the default value of a macro parameter that the call omits.

    Raises:
        XacroException: the caller has no such property, and the parameter has no default.
    """
    if forward_variable is not None and forward_variable in symbols:
        return symbols[forward_variable]
    if default is None:
        raise XacroException(f"there is no property '{forward_variable}' to forward", macro=macro)
    return eval_text(default, symbols)


def _parse_boolean(text: str | None, table: Table, *, default: bool) -> bool:
    return get_boolean_value(eval_text(text, table), text) if text else default


def _find_target_table(table: Table, scope: str | None) -> Table:
    if scope == "global":
        return table.top()
    if scope != "parent":
        return table
    target = table.parent
    if not isinstance(table, NameSpace):
        while isinstance(target, NameSpace):
            target = target.parent
    if not isinstance(target, Table):
        raise XacroException("there is no enclosing scope")
    return target
