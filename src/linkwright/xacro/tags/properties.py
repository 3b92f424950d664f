"""``<xacro:property>``: names for values and for pieces of XML."""

from __future__ import annotations

from linkwright.diagnostics import phrase
from linkwright.xacro.expander import Expander, Site
from linkwright.xacro.expressions.expression import is_identifier
from linkwright.xacro.expressions.literals import truth
from linkwright.xacro.expressions.scope import Namespace, Scope
from linkwright.xacro.tags.attributes import check_attributes, warn_of_global
from linkwright.xmltree import Element

_OPTIONAL = ("value", "default", "remove", "scope", "lazy_eval")


def define_property(expander: Expander, site: Site) -> None:
    """Define a property, or remove one."""
    node, scope = site.node, site.scope
    expander.sweep(site)
    check_attributes(expander, node, ("name",), _OPTIONAL)
    name = _name(expander, node, scope)
    attributes = node.attributes
    if len(attributes) == 2 and "value" in attributes:  # as nearly always
        warn_of_global(expander, node, name, "name")
        scope.define(name, attributes["value"], lazy=True, element=node)
        return
    remove = _flag(expander, node, "remove", scope, default=False)
    if ("value" in attributes) + ("default" in attributes) + remove > 1:
        message = phrase("the property '{name}' has more than one of 'value', 'default' and 'remove'", name=name)
        expander.fail_at("XAC304", message, node, node.span(), phrase("keep one of them"))
    if remove and _remove(expander, node, name, scope):
        return
    if "default" in attributes:
        if "scope" in attributes:
            message = phrase(
                "the default of '{name}' applies to this scope only; 'scope' has no effect with it", name=name
            )
            expander.session.warn("XAC308", message, node.attribute_span("scope"))
        if name in scope:
            return
    attribute = next((key for key in ("value", "default") if key in attributes), None)
    if attribute is None:
        target, _ = _target(expander, node, name, scope)
        target.bind(f"**{name}", node)
        return
    lazy = _flag(expander, node, "lazy_eval", scope, default=True)
    target, local = _target(expander, node, name, scope)
    warn_of_global(expander, node, name, "name")
    if lazy and local:
        target.define(name, attributes[attribute], lazy=True, element=node, attribute=attribute)
    else:
        target.define(name, expander.value(node, attribute, scope))


def _name(expander: Expander, node: Element, scope: Scope) -> str:
    name = node.attributes["name"]
    if "$" in name:
        name = expander.text_value(node, "name", scope)
    if not is_identifier(name):
        message = phrase("'{name}' cannot be the name of a property", name=name)
        hint = phrase("a name consists of letters, digits and underscores, and is not a Python keyword")
        expander.fail_at("XAC303", message, node, node.attribute_span("name"), hint)
    if name.startswith("__"):
        message = phrase("the name '{name}' begins with two underscores", name=name)
        expander.fail_at("XAC303", message, node, node.attribute_span("name"))
    return name


def _flag(expander: Expander, node: Element, attribute: str, scope: Scope, *, default: bool) -> bool:
    if not node.attributes.get(attribute):
        return default
    value = expander.value(node, attribute, scope)
    try:
        return truth(value)
    except ValueError:
        message = phrase(
            "'{attribute}' is '{value}', which is neither true nor false", attribute=attribute, value=value
        )
        expander.fail_at("XAC305", message, node, node.attribute_span(attribute), phrase("write true or false"))


def _remove(expander: Expander, node: Element, name: str, scope: Scope) -> bool:
    """Remove a value. False if there is none: then, as in ros/xacro, the element defines a block of this name."""
    span = node.attribute_span("name")
    if name not in scope:
        expander.session.warn("XAC310", phrase("there is no property '{name}' to remove", name=name), span)
        return False
    if name in expander.session.globals.values:
        expander.session.warn(
            "XAC310", phrase("'{name}' is a name that xacro provides and cannot be removed", name=name), span
        )
    scope.remove(name)
    return True


def _target(expander: Expander, node: Element, name: str, scope: Scope) -> tuple[Scope, bool]:
    """The scope that a property goes to, and whether that is the scope of its tag."""
    where = node.attributes.get("scope")
    if where == "global":
        return scope.document_scope(), False
    if where != "parent":
        return scope, True
    target = scope.parent
    if not isinstance(scope, Namespace):
        while isinstance(target, Namespace):
            target = target.parent
    if target is None or target.parent is None:
        message = phrase("there is no scope around this one for '{name}'", name=name)
        hint = phrase("'scope' is for properties defined inside a macro; leave it out here")
        expander.fail_at("XAC307", message, node, node.attribute_span("scope"), hint)
    return target, False
