"""Converts between the trees of `linkwright.xmltree` and documents of ``xml.dom.minidom``.

The nodes are minidom's, with two differences: elements are serialized in the format of ros/xacro, and elements and
texts record their locations. ros/xacro instead replaces minidom's writing method for the entire process.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any
from xml.dom import XMLNS_NAMESPACE, minidom

from linkwright.diagnostics import SourceText
from linkwright.xmltree import Comment, Document, Element, Node, ProcessingInstruction, Text

_NO_PREFIX = ""


class DomElement(minidom.Element):
    """A minidom element that records its location.

    Attributes:
        place: the source text and the offset of the element, or None.
    """

    place: tuple[SourceText, int] | None = None

    def writexml(self, writer: Any, indent: str = "", addindent: str = "", newl: str = "") -> None:
        """Write the element with sorted attributes and without whitespace-only text.

        An element that contains only text is written on one line.
        """
        attributes = dict(self.attributes.items())
        written = "".join(f' {name}="{escape_text(attributes[name])}"' for name in sorted(attributes))
        writer.write(f"{indent}<{self.tagName}{written}")
        children = self.childNodes
        if not children:
            writer.write(f"/>{newl}")
        elif len(children) == 1 and children[0].nodeType == minidom.Node.TEXT_NODE:
            writer.write(f">{escape_text(children[0].data)}</{self.tagName}>{newl}")
        else:
            writer.write(f">{newl}")
            for child in children:
                if child.nodeType != minidom.Node.TEXT_NODE or (child.data and not child.data.isspace()):
                    child.writexml(writer, indent + addindent, addindent, newl)
            writer.write(f"{indent}</{self.tagName}>{newl}")


class DomText(minidom.Text):
    """Character data that is serialized identically in all versions of Python.

    Attributes:
        place: the source text and the offset of the character data, or None.
    """

    __slots__ = ("place",)
    place: tuple[SourceText, int] | None

    def writexml(self, writer: Any, indent: str = "", _addindent: str = "", newl: str = "") -> None:
        """Write the character data, escaped."""
        writer.write(f"{indent}{escape_text(self.data)}{newl}")


def escape_text(text: str) -> str:
    """Escape a string for use in element content and attributes."""
    return text.replace("&", "&amp;").replace("<", "&lt;").replace('"', "&quot;").replace(">", "&gt;")


def fill(target: minidom.Document, document: Document) -> None:
    """Fill a minidom document from a tree; an existing root element is reused if it is a `DomElement`."""
    old = target.documentElement
    kept = old if isinstance(old, DomElement) else None
    for node in list(target.childNodes):
        target.removeChild(node)
    before = [_leaf(target, node) for node in document.prolog]
    target.doctype = None
    if document.doctype is not None:
        target.doctype = _doctype(document.doctype)
        before.insert(document.doctype_index, target.doctype)
    root = _tree(target, document.root, kept)
    for node in [*before, root, *(_leaf(target, node) for node in document.epilog)]:
        target.appendChild(node)


def read(document: minidom.Document) -> Document:
    """Convert a minidom document to a tree; nodes that `fill` created keep their locations."""
    root = document.documentElement
    element = _element(root)
    pending: list[tuple[Any, Element]] = [(root, element)]
    while pending:
        original, copy = pending.pop()
        for child in original.childNodes:
            if child.nodeType == minidom.Node.ELEMENT_NODE:
                twin = _element(child)
                pending.append((child, twin))
                copy.children.append(twin)
            else:
                node = _node(child)
                if node is not None:
                    copy.children.append(node)
    place = getattr(root, "place", None)
    result = Document(element, place[0] if place else None)
    after = False
    for child in document.childNodes:
        if child is root:
            after = True
        elif child.nodeType == minidom.Node.DOCUMENT_TYPE_NODE:
            result.doctype, result.doctype_index = child.toxml(), len(result.prolog)
        else:
            node = _node(child)
            if isinstance(node, (Comment, ProcessingInstruction)):
                (result.epilog if after else result.prolog).append(node)
    return result


def is_same(document: minidom.Document, tree: Document) -> bool:
    """Return whether a document still matches a tree, so that the locations in the tree are valid."""
    pending = [(document.documentElement, tree.root)]
    while pending:
        theirs, ours = pending.pop()
        if theirs is None or theirs.tagName != ours.tag:
            return False
        if dict(theirs.attributes.items()) != ours.attributes:
            return False
        elements = [child for child in theirs.childNodes if child.nodeType == minidom.Node.ELEMENT_NODE]
        inside = list(ours.elements())
        if len(elements) != len(inside):
            return False
        pending.extend(zip(elements, inside, strict=True))
    return True


def _tree(owner: minidom.Document, root: Element, kept: DomElement | None) -> DomElement:
    top, spaces = _create(owner, root, {}, kept)
    pending = [(root, top, spaces)]
    while pending:
        original, made, spaces = pending.pop()
        for child in original.children:
            if isinstance(child, Element):
                below, inner = _create(owner, child, spaces, None)
                if child.children:
                    pending.append((child, below, inner))
                made.appendChild(below)
            else:
                made.appendChild(_leaf(owner, child))
    return top


def _create(
    owner: minidom.Document, element: Element, spaces: Mapping[str, str], kept: DomElement | None
) -> tuple[DomElement, Mapping[str, str]]:
    """Create the minidom element for an element, without its children.

    Returns:
        The minidom element, and the namespaces in scope in its content.
    """
    declared = {name: value for name, value in element.attributes.items() if name.startswith("xmlns")}
    if declared:
        spaces = {**spaces, **{name.partition(":")[2]: value for name, value in declared.items()}}
    prefix, colon, local = element.tag.rpartition(":")
    space = spaces.get(prefix if colon else _NO_PREFIX)
    node = kept if kept is not None else DomElement(element.tag, space, prefix or None, local)
    if kept is not None:
        kept.tagName = kept.nodeName = element.tag
        for name in list(kept.attributes.keys()):
            kept.removeAttribute(name)
        for child in list(kept.childNodes):
            kept.removeChild(child)
    node.ownerDocument = owner
    node.place = (element.source, element.offset) if element.source else None
    for name, value in element.attributes.items():
        if name in declared:
            node.setAttributeNS(XMLNS_NAMESPACE, name, value)
        elif ":" in name:
            node.setAttributeNS(spaces.get(name.partition(":")[0]), name, value)
        else:
            node.setAttribute(name, value)
    return node, spaces


def _leaf(owner: minidom.Document, node: Node) -> Any:
    if isinstance(node, Text) and not node.cdata:
        made = DomText()
        made.data = node.data
        made.ownerDocument = owner
        made.place = (node.source, node.offset) if node.source else None
        return made
    if isinstance(node, Text):
        return owner.createCDATASection(node.data)
    if isinstance(node, Comment):
        return owner.createComment(node.data)
    assert isinstance(node, ProcessingInstruction), "elements are not leaves"
    return owner.createProcessingInstruction(node.target, node.data)


def _doctype(text: str) -> minidom.DocumentType:
    name = text.split(None, 2)[1].rstrip(">")
    doctype = minidom.parseString(f"{text}<{name}/>").doctype  # noqa: S318 - our reader has let it pass
    assert doctype is not None, "the text is a declaration"
    doctype.parentNode = None
    return doctype


def _element(node: Any) -> Element:
    attributes = dict(node.attributes.items())
    place = getattr(node, "place", None)
    return Element(node.tagName, attributes, *place) if place else Element(node.tagName, attributes)


def _node(node: Any) -> Text | Comment | ProcessingInstruction | None:
    kind = node.nodeType
    if kind == minidom.Node.TEXT_NODE:
        place = getattr(node, "place", None)
        return Text(node.data, *place) if place else Text(node.data)
    if kind == minidom.Node.CDATA_SECTION_NODE:
        return Text(node.data, cdata=True)
    if kind == minidom.Node.COMMENT_NODE:
        return Comment(node.data)
    if kind == minidom.Node.PROCESSING_INSTRUCTION_NODE:
        return ProcessingInstruction(node.target, node.data)
    return None
