"""A formatter for XML that changes only the whitespace inside tags and between nodes.

Everything else is unchanged: the order of attributes, quotes, entities, comments, processing instructions, line
endings, elements with text, and values that contain line endings. An element on one line stays on one line if it
fits. Attributes stay on their lines, and a comment stays beside the element on its line. Several blank lines become
one. Therefore, a robot expands to the same bytes before and after formatting.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterator, Sequence

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import NamedTuple, dataclass, field
from linkwright.xmltree.nodes import Document, Element, Node, Text
from linkwright.xmltree.reader import parse
from linkwright.xmltree.style import Style
from linkwright.xmltree.tokens import Kind, Token, TokenAttribute, tokens

_BOM = "\ufeff"
_SPACED_TAG_END, _TIGHT_TAG_END = lazy_pattern(r"[^\S\n]/>"), lazy_pattern(r"\S/>")


class TextEdit(NamedTuple):
    """A replacement of the lines from `first` up to but excluding `last`, counted from 0."""

    first: int
    last: int
    lines: tuple[str, ...]


@dataclass(slots=True)
class _Node:
    """A token, with the content of its element if it is a start tag.

    Attributes:
        token: the start tag of an element, or any other token.
        children: the nodes inside the element, including text nodes.
        closing: the end tag of an element, or None for ``<a/>`` and other tokens.
    """

    token: Token
    children: list[_Node] = field(default_factory=list)
    closing: Token | None = None

    @property
    def end(self) -> int:
        """The offset after the node."""
        return self.token.end if self.closing is None else self.closing.end

    @property
    def is_blank(self) -> bool:
        """Whether the node is a text that consists of whitespace."""
        return self.token.kind is Kind.TEXT and not self.token.text.strip()

    @property
    def is_verbatim(self) -> bool:
        """Whether whitespace in the content may be significant and must not change.

        This is the case if the content is only whitespace or includes text, or if the element has ``xml:space``.
        """
        kinds = (Kind.TEXT, Kind.CDATA)
        return (
            all(child.is_blank for child in self.children)
            or any(child.token.kind in kinds and not child.is_blank for child in self.children)
            or any(attribute.name == "xml:space" for attribute in self.token.attributes())
        )


def format_text(text: str, name: str, style: Style = Style()) -> str:  # noqa: B008 - a tuple of numbers
    """Return an XML text in a uniform format.

    A formatted text is returned unchanged.

    Args:
        text: the text, with the line endings and the byte order mark of its file.
        name: the name of the text in messages.
        style: the style options.

    Raises:
        LinkwrightError: if the text is not XML (see `linkwright.xmltree.parse`), or XML303 if formatting would change
            its meaning.
    """
    original = parse(text, name)
    byte_order_mark = _BOM if text.startswith(_BOM) else ""
    newline = "\r\n" if text.count("\r\n") * 2 > text.count("\n") else "\n"
    body = text[len(byte_order_mark) :]
    layout = _Layout(body, style, newline)
    formatted = byte_order_mark + layout.document(_read_nodes(body))
    if not _are_equal(_list_top_nodes(original), _list_top_nodes(parse(formatted, name))):
        message = phrase("'{file}' cannot be formatted without changing its meaning", file=name)
        raise LinkwrightError(Diagnostic("XML303", message, hint=phrase("report this as a bug, and attach the file")))
    return formatted


def changes(original: str, changed: str, lines: tuple[int, int] | None = None) -> list[TextEdit]:
    """Return the line edits that turn one text into another.

    Args:
        original: the original text.
        changed: the new text.
        lines: the first and the last line (exclusive, counted from 0) of the range that an edit must touch, or None for
            all edits.
    """
    old, new = original.splitlines(keepends=True), changed.splitlines(keepends=True)
    matcher = difflib.SequenceMatcher(None, old, new, autojunk=False)
    return [
        TextEdit(first, last, tuple(new[start:end]))
        for kind, first, last, start, end in matcher.get_opcodes()
        if kind != "equal" and (lines is None or (first < lines[1] and max(last, first + 1) > lines[0]))
    ]


def apply_edits(original: str, edits: Sequence[TextEdit]) -> str:
    """Return a text after applying edits to its lines."""
    lines = original.splitlines(keepends=True)
    for edit in sorted(edits, reverse=True):
        lines[edit.first : edit.last] = edit.lines
    return "".join(lines)


def _read_nodes(text: str) -> list[_Node]:
    """Return the top-level nodes of a well-formed text."""
    top_nodes: list[_Node] = []
    parents: list[_Node] = []
    for token in tokens(text):
        if token.kind is Kind.END:
            parents.pop().closing = token
            continue
        node = _Node(token)
        (parents[-1].children if parents else top_nodes).append(node)
        if token.kind is Kind.START and not token.is_empty_element:
            parents.append(node)
    return top_nodes


class _Layout:
    """The writer of nodes in a uniform format.

    Args:
        text: the text of the nodes.
        style: the style options.
        newline: the line ending to write.
    """

    def __init__(self, text: str, style: Style, newline: str) -> None:
        self._text = text
        self._style = style
        self._newline = newline
        spaced_count, tight_count = len(_SPACED_TAG_END.findall(text)), len(_TIGHT_TAG_END.findall(text))
        self._empty_tag_end = " />" if spaced_count > tight_count else "/>"

    def document(self, nodes: Sequence[_Node]) -> str:
        """Return the formatted text of a document."""
        return self._format_lines(nodes, 0).strip("\r\n") + self._newline

    def _format_lines(self, nodes: Sequence[_Node], depth: int) -> str:
        """Return the formatted text of nodes, each on separate lines with its line ending.

        A comment stays on the line of another node if it is on that line in the original.
        """
        parts: list[str] = []
        previous: _Node | None = None
        blanks = ""
        for node in nodes:
            if node.is_blank:
                blanks = node.token.text
                continue
            if previous is not None and "\n" not in blanks and self._is_beside(previous, node):
                parts[-1:] = [" ", self._format_node(node, depth), self._newline]
            else:
                if blanks.count("\n") > 1:
                    parts.append(self._newline)
                parts += [self._make_margin(depth), self._format_node(node, depth), self._newline]
            previous, blanks = node, ""
        if blanks.count("\n") > 1:
            parts.append(self._newline)
        return "".join(parts)

    @staticmethod
    def _is_beside(previous: _Node, node: _Node) -> bool:
        """Return whether one of two adjacent nodes is a comment on the other one's line."""
        return Kind.COMMENT in (previous.token.kind, node.token.kind) and Kind.INSTRUCTION not in (
            previous.token.kind,
            node.token.kind,
        )

    def _format_node(self, node: _Node, depth: int) -> str:
        if node.token.kind is not Kind.START:
            return node.token.text
        start = self._format_start_tag(node.token, depth)
        if node.closing is None:
            return start
        end = f"</{node.closing.name}>"
        if node.is_verbatim:
            return start + self._text[node.token.end : node.closing.start] + end
        if "\n" not in self._text[node.token.start : node.end]:
            line = self._format_on_one_line(node)
            if len(self._make_margin(depth)) + len(line) <= self._style.width:
                return line
        inner = self._format_lines(node.children, depth + 1)
        return start + self._newline + inner + self._make_margin(depth) + end

    def _format_on_one_line(self, node: _Node) -> str:
        """Return a node with its content on one line."""
        if node.token.kind is not Kind.START:
            return node.token.text
        start = self._format_tag_on_one_line(node.token)
        if node.closing is None:
            return start
        if node.is_verbatim:
            content = self._text[node.token.end : node.closing.start]
        else:
            content = "".join(self._one_line_texts(node.children))
        return f"{start}{content}</{node.closing.name}>"

    def _one_line_texts(self, nodes: Sequence[_Node]) -> Iterator[str]:
        """Yield the texts of nodes that are written on one line.

        Whitespace beside a comment becomes one space, and other whitespace is removed.
        """
        previous: _Node | None = None
        has_blanks = False
        for node in nodes:
            if node.is_blank:
                has_blanks = True
                continue
            if has_blanks and previous is not None and self._is_beside(previous, node):
                yield " "
            yield self._format_on_one_line(node)
            previous, has_blanks = node, False

    def _format_start_tag(self, tag: Token, depth: int) -> str:
        """Return a formatted start tag.

        Attributes stay on their lines. If a line becomes too long, its attributes continue on the next line.
        """
        attributes = tag.attributes()
        margin = self._make_margin(depth)
        line = self._format_tag_on_one_line(tag)
        is_broken = bool(attributes) and "\n" in tag.text[: attributes[-1].end - tag.start]
        if not attributes or (not is_broken and len(margin) + len(line) <= self._style.width):
            return line
        rows = self._group_by_line(tag, attributes)
        opening = f"<{tag.name}"
        step = self._make_margin(depth + 1)
        if rows[0] and len(rows) > 1 and self._compute_column(rows[1][0]) == self._compute_column(rows[0][0]):
            step = margin + " " * (len(opening) + 1)
        lines = [margin + opening]
        for index, row in enumerate(rows):
            if index:
                lines.append(step.removesuffix(" "))
            for attribute in row:
                attribute_text = _format_attribute(attribute)
                has_content = lines[-1].strip() not in ("", opening)
                first_line = attribute_text.split("\n")[0].rstrip("\r")
                if has_content and len(lines[-1].rsplit("\n", 1)[-1]) + 1 + len(first_line) > self._style.width:
                    lines.append(step.removesuffix(" "))
                lines[-1] += " " + attribute_text
        ending = self._format_ending(tag)
        if not rows[0] and "\n" in tag.text[attributes[-1].end - tag.start :]:
            lines.append(margin + ending.strip())
        else:
            lines[-1] += ending
        return self._newline.join(lines).removeprefix(margin)

    def _compute_column(self, attribute: TokenAttribute) -> int:
        return attribute.start - self._text.rfind("\n", 0, attribute.start)

    def _format_tag_on_one_line(self, tag: Token) -> str:
        attribute_text = "".join(f" {_format_attribute(attribute)}" for attribute in tag.attributes())
        return f"<{tag.name}{attribute_text}{self._format_ending(tag)}"

    def _format_ending(self, tag: Token) -> str:
        return self._empty_tag_end if tag.is_empty_element else ">"

    @staticmethod
    def _group_by_line(tag: Token, attributes: Sequence[TokenAttribute]) -> list[list[TokenAttribute]]:
        """Return the attributes by line.

        The first row is on the line of the tag's name, and may be empty.
        """
        rows: list[list[TokenAttribute]] = [[]]
        end = tag.name_start + len(tag.name)
        for attribute in attributes:
            if "\n" in tag.text[end - tag.start : attribute.start - tag.start]:
                rows.append([])
            rows[-1].append(attribute)
            end = attribute.end
        return rows

    def _make_margin(self, depth: int) -> str:
        return " " * (self._style.indent * depth)


def _format_attribute(attribute: TokenAttribute) -> str:
    return f"{attribute.name}={attribute.quote}{attribute.value}{attribute.quote}"


def _list_top_nodes(document: Document) -> list[Node]:
    return [*document.prolog, document.root, *document.epilog]


def _are_equal(first: Sequence[Node], second: Sequence[Node]) -> bool:
    """Return whether two lists of nodes are equal, apart from texts that consist of whitespace."""
    pairs = [([*first], [*second])]
    while pairs:
        left, right = ([node for node in nodes if not _is_blank(node)] for nodes in pairs.pop())
        if len(left) != len(right):
            return False
        for node, other in zip(left, right, strict=True):
            if type(node) is not type(other):
                return False
            if isinstance(node, Element) and isinstance(other, Element):
                if node.tag != other.tag or [*node.attributes.items()] != [*other.attributes.items()]:
                    return False
                pairs.append((node.children, other.children))
            elif getattr(node, "data", None) != getattr(other, "data", None):
                return False
    return True


def _is_blank(node: Node) -> bool:
    return isinstance(node, Text) and not node.cdata and not node.data.strip()
