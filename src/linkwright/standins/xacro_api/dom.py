"""Conversion between trees of `linkwright.xmltree` and documents of ``xml.dom.minidom``.

The documents consist of minidom nodes with two differences: elements are serialized in the format of ros/xacro, and
elements and texts record their locations. In contrast, ros/xacro replaces minidom's writing method for the entire
process.
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
        source_position: the source text and the offset of the element; None if the element was not read from a text.
    """

    source_position: tuple[SourceText, int] | None = None

    def writexml(self, writer: Any, indent: str = "", addindent: str = "", newl: str = "") -> None:
        """Write the element with sorted attributes and without whitespace-only text.

        An element that contains only text is written on one line.
        """
        attributes = dict(self.attributes.items())
        attributes_text = "".join(f' {name}="{escape_text(attributes[name])}"' for name in sorted(attributes))
        writer.write(f"{indent}<{self.tagName}{attributes_text}")
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
        source_position: the source text and the offset of the data; None if the data was not read from a text.
    """

    __slots__ = ("source_position",)
    source_position: tuple[SourceText, int] | None

    def writexml(self, writer: Any, indent: str = "", _addindent: str = "", newl: str = "") -> None:
        """Write the character data, escaped."""
        writer.write(f"{indent}{escape_text(self.data)}{newl}")


def escape_text(text: str) -> str:
    """Escape a string for use in element content and attributes."""
    return text.replace("&", "&amp;").replace("<", "&lt;").replace('"', "&quot;").replace(">", "&gt;")


def fill_document(target: minidom.Document, document: Document) -> None:
    """Replace the content of a minidom document with a tree.

    A root that is a `DomElement` is reused.
    """
    old_root = target.documentElement
    reusable_root = old_root if isinstance(old_root, DomElement) else None
    for node in list(target.childNodes):
        target.removeChild(node)
    prolog_nodes = [_create_dom_leaf(target, node) for node in document.prolog]
    target.doctype = None
    if document.doctype is not None:
        target.doctype = _create_dom_doctype(document.doctype)
        prolog_nodes.insert(document.doctype_index, target.doctype)
    root = _create_dom_tree(target, document.root, reusable_root)
    for node in [*prolog_nodes, root, *(_create_dom_leaf(target, node) for node in document.epilog)]:
        target.appendChild(node)


def read_document(document: minidom.Document) -> Document:
    """Convert a minidom document to a tree.

    Nodes that `fill_document` created keep their locations.
    """
    root = document.documentElement
    element = _to_tree_element(root)
    pending: list[tuple[Any, Element]] = [(root, element)]
    while pending:
        original, copy = pending.pop()
        for child in original.childNodes:
            if child.nodeType == minidom.Node.ELEMENT_NODE:
                child_copy = _to_tree_element(child)
                pending.append((child, child_copy))
                copy.children.append(child_copy)
            else:
                node = _to_tree_node(child)
                if node is not None:
                    copy.children.append(node)
    source_position = getattr(root, "source_position", None)
    result = Document(element, source_position[0] if source_position else None)
    is_after_root = False
    for child in document.childNodes:
        if child is root:
            is_after_root = True
        elif child.nodeType == minidom.Node.DOCUMENT_TYPE_NODE:
            result.doctype, result.doctype_index = child.toxml(), len(result.prolog)
        else:
            node = _to_tree_node(child)
            if isinstance(node, (Comment, ProcessingInstruction)):
                (result.epilog if is_after_root else result.prolog).append(node)
    return result


def is_same(document: minidom.Document, tree: Document) -> bool:
    """Return whether a document has the elements and attributes of a tree.

    If so, the locations of the tree apply to it.
    """
    pending = [(document.documentElement, tree.root)]
    while pending:
        dom_element, tree_element = pending.pop()
        if dom_element is None or dom_element.tagName != tree_element.tag:
            return False
        if dict(dom_element.attributes.items()) != tree_element.attributes:
            return False
        elements = [child for child in dom_element.childNodes if child.nodeType == minidom.Node.ELEMENT_NODE]
        tree_children = list(tree_element.elements())
        if len(elements) != len(tree_children):
            return False
        pending.extend(zip(elements, tree_children, strict=True))
    return True


def _create_dom_tree(owner: minidom.Document, root: Element, reused: DomElement | None) -> DomElement:
    dom_root, namespaces = _create_dom_element(owner, root, {}, reused)
    pending = [(root, dom_root, namespaces)]
    while pending:
        original, dom_parent, namespaces = pending.pop()
        for child in original.children:
            if isinstance(child, Element):
                dom_child, child_namespaces = _create_dom_element(owner, child, namespaces, None)
                if child.children:
                    pending.append((child, dom_child, child_namespaces))
                dom_parent.appendChild(dom_child)
            else:
                dom_parent.appendChild(_create_dom_leaf(owner, child))
    return dom_root


def _create_dom_element(
    owner: minidom.Document, element: Element, namespaces: Mapping[str, str], reused: DomElement | None
) -> tuple[DomElement, Mapping[str, str]]:
    """Create the minidom element for an element, without its children.

    If `reused` is not None, it is emptied and reused.

    Returns:
        The minidom element, and the XML namespaces by prefix that apply to its content.
    """
    declarations = {name: value for name, value in element.attributes.items() if name.startswith("xmlns")}
    if declarations:
        namespaces = {**namespaces, **{name.partition(":")[2]: value for name, value in declarations.items()}}
    prefix, colon, local_name = element.tag.rpartition(":")
    namespace = namespaces.get(prefix if colon else _NO_PREFIX)
    node = reused if reused is not None else DomElement(element.tag, namespace, prefix or None, local_name)
    if reused is not None:
        reused.tagName = reused.nodeName = element.tag
        for name in list(reused.attributes.keys()):
            reused.removeAttribute(name)
        for child in list(reused.childNodes):
            reused.removeChild(child)
    node.ownerDocument = owner
    node.source_position = (element.source, element.offset) if element.source else None
    for name, value in element.attributes.items():
        if name in declarations:
            node.setAttributeNS(XMLNS_NAMESPACE, name, value)
        elif ":" in name:
            node.setAttributeNS(namespaces.get(name.partition(":")[0]), name, value)
        else:
            node.setAttribute(name, value)
    return node, namespaces


def _create_dom_leaf(owner: minidom.Document, node: Node) -> Any:
    if isinstance(node, Text) and not node.cdata:
        dom_text = DomText()
        dom_text.data = node.data
        dom_text.ownerDocument = owner
        dom_text.source_position = (node.source, node.offset) if node.source else None
        return dom_text
    if isinstance(node, Text):
        return owner.createCDATASection(node.data)
    if isinstance(node, Comment):
        return owner.createComment(node.data)
    assert isinstance(node, ProcessingInstruction), "elements are not leaves"
    return owner.createProcessingInstruction(node.target, node.data)


def _create_dom_doctype(text: str) -> minidom.DocumentType:
    name = text.split(None, 2)[1].rstrip(">")
    doctype = minidom.parseString(f"{text}<{name}/>").doctype  # noqa: S318 - checked by Linkwright's reader
    assert doctype is not None, "the text is a declaration"
    doctype.parentNode = None
    return doctype


def _to_tree_element(node: Any) -> Element:
    attributes = dict(node.attributes.items())
    source_position = getattr(node, "source_position", None)
    return Element(node.tagName, attributes, *source_position) if source_position else Element(node.tagName, attributes)


def _to_tree_node(node: Any) -> Text | Comment | ProcessingInstruction | None:
    kind = node.nodeType
    if kind == minidom.Node.TEXT_NODE:
        source_position = getattr(node, "source_position", None)
        return Text(node.data, *source_position) if source_position else Text(node.data)
    if kind == minidom.Node.CDATA_SECTION_NODE:
        return Text(node.data, cdata=True)
    if kind == minidom.Node.COMMENT_NODE:
        return Comment(node.data)
    if kind == minidom.Node.PROCESSING_INSTRUCTION_NODE:
        return ProcessingInstruction(node.target, node.data)
    return None
