"""Serialize a tree to XML text.

The output matches that of ros/xacro 2.1 on Python up to 3.12: minidom's ``toprettyxml`` with an indentation of two
spaces, attributes in alphabetical order, no texts of only whitespace, and elements that contain only text on one line.
This writer produces the same format on every Python version.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.xmltree.nodes import CachedText, Comment, Document, Element, LazyCopy, Node, ProcessingInstruction, Text

_INDENT = "  "
_MAX_DEPTH = 3_000
"""The maximum nesting depth: the total indentation grows with the square of the depth."""


def write(document: Document) -> str:
    """Return the document as text, with an XML declaration and a final newline.

    Raises:
        LinkwrightError: XML301, a comment contains two dashes, which XML forbids; XML302, elements are nested too
            deeply.
    """
    pieces: list[str] = ['<?xml version="1.0" ?>\n']
    prolog: list[Node] = list(document.prolog)
    root_and_epilog: list[Node] = [document.root, *document.epilog]
    if document.doctype is None:
        _write_nodes(prolog + root_and_epilog, pieces.append)
    else:
        doctype_index = document.doctype_index
        _write_nodes(prolog[:doctype_index], pieces.append)
        pieces.append(f"{document.doctype}\n")
        _write_nodes(prolog[doctype_index:] + root_and_epilog, pieces.append)
    return "".join(pieces)


def write_element(element: Element, depth: int = 0) -> str:
    """Return an element and its content as text, without an XML declaration.

    Args:
        element: the element to write.
        depth: the number of enclosing elements, which determines the indentation.

    Raises:
        LinkwrightError: as for `write`.
    """
    pieces: list[str] = []
    _write_nodes([element], pieces.append, _INDENT * depth)
    return "".join(pieces)


def strip_mixed_text(root: Element) -> Element:
    """Return a copy of an element with whitespace removed around texts next to elements.

    Without this, each write would add whitespace to such texts.
    """
    root_copy = Element(root.tag, dict(root.attributes))
    pending = [(root, root_copy)]  # not recursive, so that the writer can report excessive nesting
    while pending:
        element, copy = pending.pop()
        has_other_nodes = any(not isinstance(child, Text) for child in element.children)
        for child in element.children:
            if isinstance(child, Element):
                child_copy = Element(child.tag, dict(child.attributes))
                copy.children.append(child_copy)
                pending.append((child, child_copy))
            elif has_other_nodes and isinstance(child, Text) and not child.cdata:
                if text := child.data.strip():
                    copy.children.append(Text(text))
            else:
                copy.children.append(child)
    return root_copy


def _write_nodes(nodes: Iterable[Node], write_text: Callable[[str], None], indent: str = "") -> None:
    # A loop with its own stack, because documents may be nested more deeply than Python's call stack allows.
    stack: list[tuple[Iterator[Node], str]] = []
    remaining = iter(nodes)
    base_depth = len(indent) // len(_INDENT)
    while True:
        for node in remaining:
            if isinstance(node, Text):
                data = node.data
                if node.cdata:
                    write_text(f"<![CDATA[{data.replace(']]>', ']]]]><![CDATA[>')}]]>")
                elif data and not data.isspace():
                    write_text(f"{indent}{_escape_text(data)}\n")
            elif isinstance(node, LazyCopy) and node.original is not None:
                write_text(_write_original(node, indent))
            elif isinstance(node, Element):
                tag, children = node.tag, node.children
                attributes = _format_attributes(node.attributes) if node.attributes else ""
                if not children:
                    write_text(f"{indent}<{tag}{attributes}/>\n")
                elif len(children) == 1 and isinstance(only := children[0], Text) and not only.cdata:
                    write_text(f"{indent}<{tag}{attributes}>{_escape_text(only.data)}</{tag}>\n")
                else:
                    write_text(f"{indent}<{tag}{attributes}>\n")
                    stack.append((remaining, f"{indent}</{tag}>\n"))
                    if len(stack) + base_depth > _MAX_DEPTH:
                        raise _make_nesting_error(node)
                    remaining = iter(children)
                    indent += _INDENT
                    break
            elif isinstance(node, Comment):
                write_text(f"{indent}<!--{_format_comment(node)}-->\n")
            else:
                write_text(f"{indent}{_format_instruction(node)}\n")
        else:
            if not stack:
                return
            remaining, closing = stack.pop()
            indent = indent[: -len(_INDENT)]
            write_text(closing)


def _write_original(copy: LazyCopy, indent: str) -> str:
    """Return the text of a lazy copy: its original's text, with the copy's indentation."""
    cache, original = copy.plan, copy.original
    if isinstance(cache, CachedText) and cache.written is not None and cache.written[0] == indent:
        return cache.written[1]
    while isinstance(original, LazyCopy) and original.original is not None:
        original = original.original
    assert original is not None, "asked for only where there is one"
    pieces: list[str] = []
    _write_nodes([original], pieces.append, indent)
    text = "".join(pieces)
    if isinstance(cache, CachedText):
        cache.written = (indent, text)
    return text


def _make_nesting_error(element: Element) -> LinkwrightError:
    message = phrase("elements are nested more than {deepest:,} levels deep", deepest=_MAX_DEPTH)
    return LinkwrightError(Diagnostic("XML302", message, element.span(), source=element.source))


def _format_attributes(attributes: dict[str, str]) -> str:
    names = sorted(attributes) if len(attributes) > 1 else attributes
    text = "".join([f' {name}="{attributes[name]}"' for name in names])
    if "&" in text or "<" in text or ">" in text or text.count('"') != 2 * len(attributes):
        text = "".join([f' {name}="{_escape_text(attributes[name])}"' for name in names])
    return text


def _escape_text(text: str) -> str:
    if "&" in text:
        text = text.replace("&", "&amp;")
    if "<" in text:
        text = text.replace("<", "&lt;")
    if '"' in text:
        text = text.replace('"', "&quot;")
    if ">" in text:
        text = text.replace(">", "&gt;")
    return text


def _format_comment(node: Comment) -> str:
    if "--" in node.data:
        span = node.source.span(node.offset, node.offset + len("<!--")) if node.source else None
        message = phrase("a comment cannot contain '--'")
        raise LinkwrightError(Diagnostic("XML301", message, span=span, source=node.source))
    return node.data


def _format_instruction(node: ProcessingInstruction) -> str:
    return f"<?{node.target} {node.data}?>"
