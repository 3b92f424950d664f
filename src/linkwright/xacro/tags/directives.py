"""The xacro tags except macro calls, such as properties, conditions and includes."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, did_you_mean, display_path, phrase, term
from linkwright.loading.lean_typing import Any
from linkwright.xacro.expander import Container, Directive, Expander, Site, check_attributes, warn_of_global
from linkwright.xacro.expressions.expression import is_identifier
from linkwright.xacro.expressions.scope import Namespace, Scope, evaluate_truth
from linkwright.xacro.faults import Frame, find_xml_hint, trail
from linkwright.xacro.macros import MacroTable
from linkwright.xacro.tags.macro_calls import call_dynamically, define_macro
from linkwright.xmltree import Document, Element

_MISSING_FILE_CODE = "XML101"
_PATTERN_CHARACTERS = ("*", "[", "?")


def include(expander: Expander, site: Site) -> None:
    """Expand ``<xacro:include>``: insert the content of one file, or of all matching files."""
    node, session = site.node, expander.session
    check_attributes(expander, node, ("filename",), ("ns", "optional"))
    scope, macros = _find_target_tables(expander, site)
    optional = _is_optional(expander, node)
    child = next(node.elements(), None)
    if child is not None:
        session.warn("XAC503", phrase("'{tag}' inside an include has no effect", tag=child.tag), child.span())
    contents: list[Element] = []
    for path in _find_included_paths(expander, site):
        session.add_dependency(path)
        container = _expand_file(expander, site, path, scope, macros, optional=optional)
        if container is not None:
            expander.lift_namespaces(container, site)
            contents.append(container)
    output = site.parent.children
    needs_mark = expander.sweeper.sweep(output, has_followers=site.has_followers)
    for container in contents:
        expander.splice(container, site)
    if needs_mark:
        expander.sweeper.move_marker(output)


def _find_target_tables(expander: Expander, site: Site) -> tuple[Scope, MacroTable]:
    if not site.node.attributes.get("ns"):
        return site.scope, site.macros
    name = expander.text_value(site.node, "ns", site.scope)
    macros = MacroTable()
    site.macros.define(name, macros)
    scope = Namespace(site.scope, expander.session)
    warn_of_global(expander, site.node, name, "ns")
    site.scope.bind(name, scope)
    return scope, macros


def _is_optional(expander: Expander, node: Element) -> bool:
    text = node.attributes.get("optional")
    if text is None:
        return False
    try:
        return evaluate_truth(text)
    except ValueError:
        message = phrase("'optional' is '{value}', which is neither true nor false", value=text)
        hint = phrase("write true or false; it is not evaluated")
        expander.fail_at("XAC305", message, node, node.attribute_span("optional"), hint)


def _find_included_paths(expander: Expander, site: Site) -> list[str]:
    name = expander.text_value(site.node, "filename", site.scope)
    path = expander.session.relative_to_current_file(name)
    if not any(character in path for character in _PATTERN_CHARACTERS):
        return [path]
    from glob import glob

    root = expander.session.root_dir or None
    paths = sorted(glob(path, root_dir=root))  # noqa: PTH207 - kept as it is written
    if not paths:
        span = site.node.attribute_span("filename")
        expander.session.warn("XAC502", phrase("no file matches '{path}'", path=path), span)
    return paths


def _expand_file(
    expander: Expander, site: Site, path: str, scope: Scope, macros: MacroTable, *, optional: bool
) -> Element | None:
    session = expander.session
    outer_frame, outer_file = session.frame, session.file
    try:
        document = _read_document(expander, site, path)
    except LinkwrightError as error:
        if optional and error.diagnostics[0].code == _MISSING_FILE_CODE:
            return None
        raise
    expander.enter(Frame(None, site.node, outer_frame))
    session.file = path
    try:
        root = document.root
        attributes = expander.attributes(root, scope)
        namespaces = {name: value for name, value in attributes.items() if name.startswith("xmlns:")}
        container = Container(site.node.tag, namespaces)
        expander.expand_children(root, container, scope, macros)
    finally:
        session.frame, session.file = outer_frame, outer_file
    return container


def _read_document(expander: Expander, site: Site, path: str) -> Document:
    try:
        return expander.session.read(path)
    except LinkwrightError as error:
        node, frame = site.node, expander.session.frame
        first = error.diagnostics[0]
        if first.span is None:
            hint = first.hint or _suggest_file(expander.session.resolve_path(path))
            diagnostic = Diagnostic(
                first.code,
                first.message,
                node.attribute_span("filename"),
                notes=trail(frame),
                hint=hint,
                source=node.source,
            )
        else:
            notes = (*first.notes, Frame(None, node, frame).note(), *trail(frame))
            diagnostic = Diagnostic(
                first.code, first.message, first.span, notes=notes, hint=find_xml_hint(first), source=first.source
            )
        raise LinkwrightError(diagnostic) from None


def _suggest_file(path: str) -> Phrase | None:
    folder, name = os.path.split(path)
    try:
        return did_you_mean(name, os.listdir(folder or "."))  # noqa: PTH208 - names are needed, not paths
    except (OSError, ValueError):
        return phrase("there is no folder '{folder}'", folder=display_path(folder))


_OPTIONAL_ATTRIBUTES = ("value", "default", "remove", "scope", "lazy_eval")


def define_property(expander: Expander, site: Site) -> None:
    """Expand ``<xacro:property>``: define or remove a property."""
    node, scope = site.node, site.scope
    expander.sweep(site)
    check_attributes(expander, node, ("name",), _OPTIONAL_ATTRIBUTES)
    name = _evaluate_name(expander, node, scope)
    attributes = node.attributes
    if len(attributes) == 2 and "value" in attributes:  # the usual case, without further attributes
        warn_of_global(expander, node, name, "name")
        scope.define(name, attributes["value"], lazy=True, element=node)
        return
    is_removal = _evaluate_boolean(expander, node, "remove", scope, default=False)
    if ("value" in attributes) + ("default" in attributes) + is_removal > 1:
        message = phrase("the property '{name}' has more than one of 'value', 'default' and 'remove'", name=name)
        expander.fail_at("XAC304", message, node, node.span(), phrase("keep one of them"))
    if is_removal and _remove_property(expander, node, name, scope):
        return
    if "default" in attributes:
        if "scope" in attributes:
            message = phrase("the default of '{name}' applies to this scope only, so 'scope' has no effect", name=name)
            expander.session.warn("XAC308", message, node.attribute_span("scope"))
        if name in scope:
            return
    attribute = next((key for key in ("value", "default") if key in attributes), None)
    if attribute is None:
        target, _ = _find_target_scope(expander, node, name, scope)
        target.bind(f"**{name}", node)
        return
    is_lazy = _evaluate_boolean(expander, node, "lazy_eval", scope, default=True)
    target, is_local = _find_target_scope(expander, node, name, scope)
    warn_of_global(expander, node, name, "name")
    if is_lazy and is_local:
        target.define(name, attributes[attribute], lazy=True, element=node, attribute=attribute)
    else:
        target.define(name, expander.value(node, attribute, scope))


def _evaluate_name(expander: Expander, node: Element, scope: Scope) -> str:
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


def _evaluate_boolean(expander: Expander, node: Element, attribute: str, scope: Scope, *, default: bool) -> bool:
    if not node.attributes.get(attribute):
        return default
    value = expander.value(node, attribute, scope)
    try:
        return evaluate_truth(value)
    except ValueError:
        message = phrase("'{name}' is '{text}', which is neither true nor false", name=attribute, text=value)
        expander.fail_at("XAC305", message, node, node.attribute_span(attribute), phrase("write true or false"))


def _remove_property(expander: Expander, node: Element, name: str, scope: Scope) -> bool:
    """Remove a property from all scopes, and return whether it existed.

    If it did not exist, the caller must define a block with this name, as in ros/xacro.
    """
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


def _find_target_scope(expander: Expander, node: Element, name: str, scope: Scope) -> tuple[Scope, bool]:
    """Return the scope for a property, and whether it is the tag's scope."""
    scope_name = node.attributes.get("scope")
    if scope_name == "global":
        return scope.document_scope(), False
    if scope_name != "parent":
        return scope, True
    target = scope.parent
    if not isinstance(scope, Namespace):
        while isinstance(target, Namespace):
            target = target.parent
    if target is None or target.parent is None:
        message = phrase("the property '{name}' has no enclosing scope", name=name)
        hint = phrase("leave 'scope' out, because it is only for properties of a macro")
        expander.fail_at("XAC307", message, node, node.attribute_span("scope"), hint)
    return target, False


_XML_NAME = r"[^\W\d][\w.\-]*(:[^\W\d][\w.\-]*)?"  # compiled on first use, because few files need it
"""An approximation of the pattern for names in XML."""


def declare_argument(expander: Expander, site: Site) -> None:
    """Expand ``<xacro:arg name default/>``: set a default unless the argument has a value."""
    node, session = site.node, expander.session
    check_attributes(expander, node, ("name", "default"), ())
    name = node.attributes["name"]
    session.known_arguments.add(name)
    if name not in session.arguments:
        session.arguments[name] = expander.text_value(node, "default", site.scope)
    expander.sweep(site)


def expand_condition(expander: Expander, site: Site) -> None:
    """Expand ``<xacro:if value>`` or ``<xacro:unless value>``: insert or omit the content."""
    node, scope, session = site.node, site.scope, expander.session
    output = site.parent.children
    marker_holder: list[Any] = []  # holds the marker until the end of the tag, unless a tag inside moves it
    if expander.sweeper.sweep(output, has_followers=site.has_followers):
        expander.sweeper.move_marker(marker_holder)
    check_attributes(expander, node, ("value",), ())
    value = expander.value(node, "value", scope)
    try:
        condition = evaluate_truth(value)
    except ValueError:
        message = phrase(
            "the condition '{value}' evaluates to '{other_value}', not to true or false",
            value=node.attributes["value"],
            other_value=value,
        )
        hint = phrase("write a condition that evaluates to true, false or an integer")
        expander.fail_at("XAC305", message, node, node.attribute_span("value"), hint)
    if condition is (node.tag == "xacro:if"):
        if "$" in node.attributes["value"] and session.may_change_values(node.attributes["value"]):
            expander.attributes(node, scope)  # ros/xacro evaluates the attributes of inserted elements a second time
        container = Container(node.tag)
        expander.expand_children(node, container, scope, site.macros)
        expander.splice(container, site)
    if marker_holder:
        expander.sweeper.move_marker(output)


def insert_block(expander: Expander, site: Site) -> None:
    """Expand ``<xacro:insert_block name/>``: evaluate a block and insert the result."""
    node, scope = site.node, site.scope
    check_attributes(expander, node, ("name",), ())
    name = node.attributes["name"]
    if f"**{name}" in scope:
        block: Element = scope.lookup(f"**{name}")
        container = Container(block.tag)
        expander.expand_children(block, container, scope, site.macros)
        expander.splice(container, site)
    elif f"*{name}" in scope:
        expander.expand_element(scope.lookup(f"*{name}"), site.parent.children, scope, site.macros)
    else:
        block_names = [block.lstrip("*") for block in scope.blocks()]
        hint = did_you_mean(name, block_names)
        if hint is None and name in scope:
            hint = phrase("'{name}' is a property with a value: write ${{{name}}}", name=name)
        expander.fail_at(
            "XAC406", phrase("there is no block '{name}'", name=name), node, node.attribute_span("name"), hint
        )


def expand_element(expander: Expander, site: Site) -> None:
    """Expand ``<xacro:element xacro:name>``: create an element with an evaluated tag.

    The value of ``xacro:name`` may be any tag.
    """
    node = site.node
    if "xacro:name" not in node.attributes:
        expander.fail_at("XAC301", phrase("'xacro:element' needs the attribute 'xacro:name'"), node, node.span())
    tag = expander.text_value(node, "xacro:name", site.scope)
    _check_name(expander, node, "xacro:name", "element", tag)
    attributes = {name: value for name, value in node.attributes.items() if name != "xacro:name"}
    element = Element(tag, attributes, node.source, node.offset)
    element.children = node.children
    if tag.startswith("xacro:"):
        expander.expand_tag(site._replace(node=element))
    else:
        expander.expand_element(element, site.parent.children, site.scope, site.macros)


def set_attribute(expander: Expander, site: Site) -> None:
    """Expand ``<xacro:attribute name value/>``: set an attribute of the enclosing element."""
    node = site.node
    check_attributes(expander, node, ("name", "value"), ())
    name = expander.text_value(node, "name", site.scope)
    _check_name(expander, node, "name", "attribute", name)
    value = expander.value(node, "value", site.scope)
    previous_warning = expander.unwritable.pop((id(site.parent), name), None)
    if previous_warning is not None:  # the previous value is not written
        expander.session.withdraw(previous_warning[1])
    if isinstance(site.parent, Container) and not name.startswith("xmlns:"):
        message = phrase(
            "ros/xacro drops the attribute '{name}': it is inside <{tag}>, not directly in its element",
            name=name,
            tag=site.parent.tag,
        )
        hint = phrase(
            "write it directly in the element, with an expression for its value, or put each variant of the "
            "element in a condition"
        )
        expander.session.warn("XAC901", message, node.span(), hint)
    elif not isinstance(value, str):
        _warn_of_non_text(expander, site, name, value)
    site.parent.attributes[name] = expander.output_text(node, "value", value)


def _warn_of_non_text(expander: Expander, site: Site, name: str, value: object) -> None:
    """Warn about a value that is not text.

    The warning is withdrawn if another value replaces this one.
    """
    node = site.node
    type_name = type(value).__name__
    message = (
        phrase(
            "ros/xacro fails to write the attribute '{name}': its value has the type {kind} and is not text",
            name=name,
            kind=type_name,
        )
        if value
        else phrase(
            "ros/xacro writes the attribute '{name}' empty: its value has the type {kind} and is not text",
            name=name,
            kind=type_name,
        )
    )
    expression = node.attributes["value"].strip()
    hint = phrase("convert it to a string: {expression}", expression="${str(" + expression[2:-1].strip() + ")}")
    diagnostic = expander.session.warn("XAC903", message, node.attribute_span("value"), hint)
    if diagnostic is not None:
        expander.unwritable[id(site.parent), name] = (site.parent, diagnostic)


def _check_name(expander: Expander, node: Element, attribute: str, kind: str, name: str) -> None:
    if not re.fullmatch(_XML_NAME, name):
        message = (
            phrase("'{name}' cannot be the name of an {kind}", name=name, kind=term(kind))
            if name
            else phrase("this {kind} has an empty name", kind=term(kind))
        )
        expander.fail_at("XAC309", message, node, node.attribute_span(attribute))


DIRECTIVES: Mapping[str, Directive] = {
    "xacro:arg": declare_argument,
    "xacro:attribute": set_attribute,
    "xacro:call": call_dynamically,
    "xacro:element": expand_element,
    "xacro:if": expand_condition,
    "xacro:include": include,
    "xacro:insert_block": insert_block,
    "xacro:macro": define_macro,
    "xacro:property": define_property,
    "xacro:unless": expand_condition,
}
"""Tag -> the function that expands it. Any other tag with the prefix is a macro call."""
