"""``<xacro:include>``: the content of other files."""

from __future__ import annotations

import os

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, did_you_mean, display_path, phrase
from linkwright.xacro.expander import Container, Expander, Site, check_attributes, warn_of_global
from linkwright.xacro.expressions.scope import Namespace, Scope, truth
from linkwright.xacro.macros import MacroTable
from linkwright.xacro.origin import Frame, trail
from linkwright.xmltree import Document, Element

_MISSING = "XML101"
_OF_PATTERNS = ("*", "[", "?")


def include(expander: Expander, site: Site) -> None:
    """Put the content of a file, or of all files that match a pattern, in the place of the tag."""
    node, session = site.node, expander.session
    check_attributes(expander, node, ("filename",), ("ns", "optional"))
    scope, macros = _tables(expander, site)
    optional = _is_optional(expander, node)
    child = next(node.elements(), None)
    if child is not None:
        session.warn("XAC503", phrase("'{tag}' inside an include has no effect", tag=child.tag), child.span())
    contents: list[Element] = []
    for path in _paths(expander, site):
        session.depends_on(path)
        container = _content(expander, site, path, scope, macros, optional=optional)
        if container is not None:
            expander.lift_namespaces(container, site)
            contents.append(container)
    output = site.parent.children
    mark = expander.sweeper.sweep(output, followed=site.followed)
    for container in contents:
        expander.splice(container, site)
    if mark:
        expander.sweeper.mark(output)


def _tables(expander: Expander, site: Site) -> tuple[Scope, MacroTable]:
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
    written = node.attributes.get("optional")
    if written is None:
        return False
    try:
        return truth(written)
    except ValueError:
        message = phrase("'optional' is '{written}', which is neither true nor false", written=written)
        hint = phrase("write true or false; it is not evaluated")
        expander.fail_at("XAC305", message, node, node.attribute_span("optional"), hint)


def _paths(expander: Expander, site: Site) -> list[str]:
    name = expander.text_value(site.node, "filename", site.scope)
    path = expander.session.absolute(name)
    if not any(sign in path for sign in _OF_PATTERNS):
        return [path]
    from glob import glob

    root = expander.session.root_dir or None
    paths = sorted(glob(path, root_dir=root))  # noqa: PTH207 - kept as it is written
    if not paths:
        span = site.node.attribute_span("filename")
        expander.session.warn("XAC502", phrase("no file matches '{path}'", path=path), span)
    return paths


def _content(
    expander: Expander, site: Site, path: str, scope: Scope, macros: MacroTable, *, optional: bool
) -> Element | None:
    session = expander.session
    around, file = session.frame, session.file
    try:
        document = _document(expander, site, path)
    except LinkwrightError as error:
        if optional and error.diagnostics[0].code == _MISSING:
            return None
        raise
    expander.enter(Frame(None, site.node, around))
    session.file = path
    try:
        root = document.root
        attributes = expander.attributes(root, scope)
        declared = {name: value for name, value in attributes.items() if name.startswith("xmlns:")}
        container = Container(site.node.tag, declared)
        expander.children(root, container, scope, macros)
    finally:
        session.frame, session.file = around, file
    return container


def _document(expander: Expander, site: Site, path: str) -> Document:
    try:
        return expander.session.read(path)
    except LinkwrightError as error:
        node, frame = site.node, expander.session.frame
        first = error.diagnostics[0]
        if first.span is None:
            hint = first.hint or _nearest_file(expander.session.on_disk(path))
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
                first.code, first.message, first.span, notes=notes, hint=xml_hint(first), source=first.source
            )
        raise LinkwrightError(diagnostic) from None


def xml_hint(diagnostic: Diagnostic) -> Phrase | None:
    """The hint of a mistake in the XML; for the prefix of this language, how to declare it."""
    if diagnostic.code == "XML205" and diagnostic.message.startswith("the prefix 'xacro'"):
        return phrase('declare it on the root element: xmlns:xacro="http://www.ros.org/wiki/xacro"')
    return diagnostic.hint


def _nearest_file(path: str) -> Phrase | None:
    folder, name = os.path.split(path)
    try:
        return did_you_mean(name, os.listdir(folder or "."))  # noqa: PTH208 - names are needed, not paths
    except (OSError, ValueError):
        return phrase("there is no folder '{folder}'", folder=display_path(folder))
