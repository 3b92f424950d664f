"""Serialization of a tree to text.

The form is that of ros/xacro 2.1 on Python up to 3.12: minidom's ``toprettyxml`` with an indentation of two blanks,
attributes in alphabetical order, no blank text, and elements that contain only text on one line. This writer produces
the same form on every Python version.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.xmltree.nodes import CachedText, Comment, Document, Element, LazyCopy, Node, ProcessingInstruction, Text

_INDENT = "  "
_DEEPEST = 3_000
"""How deep elements may nest: the indentation grows with the square of it."""


def write(document: Document) -> str:
    """Return the document as text, with an XML declaration and a final newline.

    Raises:
        LinkwrightError: XML301 if a comment created by a program contains two dashes, which XML forbids; XML302 if
            elements are nested thousands of levels deep.
    """
    pieces: list[str] = ['<?xml version="1.0" ?>\n']
    before: list[Node] = list(document.prolog)
    after: list[Node] = [document.root, *document.epilog]
    if document.doctype is None:
        _write_nodes(before + after, pieces.append)
    else:
        at = document.doctype_index
        _write_nodes(before[:at], pieces.append)
        pieces.append(f"{document.doctype}\n")
        _write_nodes(before[at:] + after, pieces.append)
    return "".join(pieces)


def write_element(element: Element, depth: int = 0) -> str:
    """Return an element and its content as text, without an XML declaration.

    Args:
        element: the element.
        depth: the number of enclosing elements, which determines the indentation.

    Raises:
        LinkwrightError: XML301; see `write`.
    """
    pieces: list[str] = []
    _write_nodes([element], pieces.append, _INDENT * depth)
    return "".join(pieces)


def strip_mixed_text(root: Element) -> Element:
    """Return a copy in which texts next to elements are stripped.

    Otherwise, each write would add blanks to such texts.
    """
    top = Element(root.tag, dict(root.attributes))
    todo = [(root, top)]  # no recursion, because the writer reports excessive nesting
    while todo:
        element, copy = todo.pop()
        mixed = any(not isinstance(child, Text) for child in element.children)
        for child in element.children:
            if isinstance(child, Element):
                inner = Element(child.tag, dict(child.attributes))
                copy.children.append(inner)
                todo.append((child, inner))
            elif mixed and isinstance(child, Text) and not child.cdata:
                if text := child.data.strip():
                    copy.children.append(Text(text))
            else:
                copy.children.append(child)
    return top


def _write_nodes(nodes: Iterable[Node], put: Callable[[str], None], indent: str = "") -> None:
    # A loop with its own stack, because documents may be nested more deeply than Python's call stack allows.
    stack: list[tuple[Iterator[Node], str]] = []
    remaining = iter(nodes)
    around = len(indent) // len(_INDENT)
    while True:
        for node in remaining:
            if isinstance(node, Text):
                data = node.data
                if node.cdata:
                    put(f"<![CDATA[{data.replace(']]>', ']]]]><![CDATA[>')}]]>")
                elif data and not data.isspace():
                    put(f"{indent}{_escaped(data)}\n")
            elif isinstance(node, LazyCopy) and node.original is not None:
                put(_text_of_original(node, indent))
            elif isinstance(node, Element):
                tag, children = node.tag, node.children
                attributes = _attributes(node.attributes) if node.attributes else ""
                if not children:
                    put(f"{indent}<{tag}{attributes}/>\n")
                elif len(children) == 1 and isinstance(only := children[0], Text) and not only.cdata:
                    put(f"{indent}<{tag}{attributes}>{_escaped(only.data)}</{tag}>\n")
                else:
                    put(f"{indent}<{tag}{attributes}>\n")
                    stack.append((remaining, f"{indent}</{tag}>\n"))
                    if len(stack) + around > _DEEPEST:
                        raise _too_deep(node)
                    remaining = iter(children)
                    indent += _INDENT
                    break
            elif isinstance(node, Comment):
                put(f"{indent}<!--{_comment(node)}-->\n")
            else:
                put(f"{indent}{_instruction(node)}\n")
        else:
            if not stack:
                return
            remaining, closing = stack.pop()
            indent = indent[: -len(_INDENT)]
            put(closing)


def _text_of_original(copy: LazyCopy, indent: str) -> str:
    """Return the text of a lazy copy, which is that of its original with another indentation."""
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


def _too_deep(element: Element) -> LinkwrightError:
    message = phrase("elements are nested more than {deepest:,} deep", deepest=_DEEPEST)
    return LinkwrightError(Diagnostic("XML302", message, element.span(), source=element.source))


def _attributes(attributes: dict[str, str]) -> str:
    names = sorted(attributes) if len(attributes) > 1 else attributes
    text = "".join([f' {name}="{attributes[name]}"' for name in names])
    if "&" in text or "<" in text or ">" in text or text.count('"') != 2 * len(attributes):
        text = "".join([f' {name}="{_escaped(attributes[name])}"' for name in names])
    return text


def _escaped(text: str) -> str:
    if "&" in text:
        text = text.replace("&", "&amp;")
    if "<" in text:
        text = text.replace("<", "&lt;")
    if '"' in text:
        text = text.replace('"', "&quot;")
    if ">" in text:
        text = text.replace(">", "&gt;")
    return text


def _comment(node: Comment) -> str:
    if "--" in node.data:
        span = node.source.span(node.offset, node.offset + len("<!--")) if node.source else None
        message = phrase("a comment cannot contain '--'")
        raise LinkwrightError(Diagnostic("XML301", message, span=span, source=node.source))
    return node.data


def _instruction(node: ProcessingInstruction) -> str:
    return f"<?{node.target} {node.data}?>"
