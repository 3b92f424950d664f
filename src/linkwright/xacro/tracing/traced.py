"""Traced expansions for explanations and logs, at no cost for other expansions.

The trees are copied with a probe at the beginning of every element and macro, and before every text with a dollar.
A probe is a xacro tag like any other. The observer defines its effect, and can access the element that is being
produced, the scope, and the enclosing calls and includes. Probes stay in the result because a block is expanded
twice. They are removed at the end.
"""

from __future__ import annotations

from collections.abc import Mapping

from linkwright.xacro.expander import Directive, Expander
from linkwright.xacro.limits import recursion_limit_for
from linkwright.xacro.session import Inputs, Session, read_main_document
from linkwright.xacro.tags.macro_calls import call_macro
from linkwright.xmltree import Document, Element, Node, Text

_PREFIX = "xacro:"

PROBE = "xacro:.probe"
"""The tag of probes, which no file can contain: XML does not allow its name."""


class TracedSession(Session):
    """A session that inserts probes into the files as it reads them.

    Args:
        inputs: the inputs of the expansion.
        probes: whether to insert probes.
    """

    def __init__(self, inputs: Inputs, *, probes: bool = True) -> None:
        super().__init__(inputs.name, inputs.arguments, inputs.packages, inputs.limits, inputs.root_dir, inputs.overlay)
        self._probes = probes
        self._documents: dict[str, Document] = {}

    def read(self, path: str) -> Document:
        """Return the document of a file, with probes if they are enabled; see `Session.read`."""
        if not self._probes:
            return super().read(path)
        document = self._documents.get(path)
        if document is None:
            document = self._documents[path] = with_probes(super().read(path))
        return document


def expand_traced(
    inputs: Inputs,
    session: Session,
    directives: Mapping[str, Directive],
    call: Directive = call_macro,
) -> Document:
    """Expand with other directives, without a banner or warnings about unused arguments.

    Args:
        inputs: the inputs of the expansion.
        session: the session of the expansion.
        directives: the functions that expand xacro's own tags, by tag, with a function for `PROBE` if there are probes.
        call: the function that expands macro calls.

    Raises:
        LinkwrightError: the errors of the description.
    """
    document = read_main_document(session, inputs.text)
    if inputs.text is not None and PROBE in directives:
        document = with_probes(document)
    with recursion_limit_for(inputs.limits):
        return without_probes(Expander(session, directives, call).expand_document(document))


def with_probes(document: Document) -> Document:
    """Return a copy of a document with probes.

    The `origin` of a probe is the element or text of the original that follows the probe.
    """
    root = Element(document.root.tag, document.root.attributes, document.root.source, document.root.offset)
    pending = [(document.root, root)]
    while pending:
        original, copy = pending.pop()
        if _is_watched(original):
            copy.children.append(_make_probe(original))
        for child in original.children:
            if isinstance(child, Element):
                child_copy = Element(child.tag, child.attributes, child.source, child.offset)
                pending.append((child, child_copy))
                copy.children.append(child_copy)
                continue
            if isinstance(child, Text) and "$" in child.data and not child.cdata:
                copy.children.append(_make_probe(child))
            copy.children.append(child)
    return _make_document(document, root)


def without_probes(document: Document) -> Document:
    """Remove the probes from a document, and return the document."""
    pending = [document.root]
    while pending:
        element = pending.pop()
        remaining_nodes: list[Node] = []
        for child in element.children:
            if isinstance(child, Element):
                if child.tag == PROBE:
                    continue
                pending.append(child)
            remaining_nodes.append(child)
        element.children = remaining_nodes
    return document


def recorded_probe(record: object) -> Element:
    """Return a probe that is kept in the result.

    The `origin` of the probe is the record of the enclosing element.
    """
    return Element(PROBE, origin=record)


def _make_probe(original: Element | Text) -> Element:
    return Element(PROBE, source=original.source, offset=original.offset, origin=original)


def _is_watched(element: Element) -> bool:
    return not element.tag.startswith(_PREFIX) or element.tag in ("xacro:element", "xacro:macro")


def _make_document(document: Document, root: Element) -> Document:
    result = Document(root, document.source)
    result.prolog, result.epilog = document.prolog, document.epilog
    result.doctype, result.doctype_index = document.doctype, document.doctype_index
    return result
