"""Checks that all tags of the language share."""

from __future__ import annotations

from linkwright.diagnostics import did_you_mean, nearest, phrase
from linkwright.xacro.expander import Expander
from linkwright.xacro.faults import attribute_name
from linkwright.xmltree import Element


def check_attributes(expander: Expander, node: Element, required: tuple[str, ...], optional: tuple[str, ...]) -> None:
    """Check that a tag has the attributes it needs, and warn of those that mean nothing on it.

    Raises:
        LinkwrightError: XAC301 when one is missing.
    """
    attributes = node.attributes
    for name in required:
        if name not in attributes:
            near = nearest(name, [attribute for attribute in attributes if attribute not in optional])
            missing = (
                phrase("write {name}=\"...\" for '{near}'", name=name, near=near[0])
                if near
                else phrase('write {name}="..."', name=name)
            )
            expander.fail_at(
                "XAC301",
                phrase("'{tag}' lacks its attribute '{name}'", tag=node.tag, name=name),
                node,
                node.span(),
                missing,
            )
    if len(attributes) == len(required):
        return
    if optional and attributes.keys() <= {*required, *optional}:
        return
    for name in attributes:
        if name in required or name in optional or name.startswith("xmlns:"):
            continue
        hint = did_you_mean(name, required + optional)
        message = phrase("'{tag}' does not accept the attribute '{name}'", tag=node.tag, name=name)
        expander.session.warn("XAC302", message, attribute_name(node, name), hint)


def warn_of_global(expander: Expander, node: Element, name: str, attribute: str) -> None:
    """Warn that a name which the language provides gets another meaning."""
    if name in expander.session.globals.values:
        message = phrase("'{name}' is a name that xacro provides, and is redefined here", name=name)
        span = node.attribute_span(attribute) if attribute == "name" else attribute_name(node, attribute)
        expander.session.warn("XAC306", message, span)
