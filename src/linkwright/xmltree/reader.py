"""Reading XML into a tree that knows where each node was written."""

from __future__ import annotations

import re
from bisect import bisect_right
from pathlib import Path
from xml.parsers.expat import ExpatError, ParserCreate

from linkwright.diagnostics import Diagnostic, LinkwrightError, SourceText, missing_file_hint
from linkwright.xmltree.decoding import decode
from linkwright.xmltree.entities import GROWTH_LIMIT, EntityGuard
from linkwright.xmltree.faults import forbidden_entity, syntax_error, undeclared_prefix
from linkwright.xmltree.nodes import Comment, Document, Element, Node, ProcessingInstruction, Text

_BEYOND_ASCII = re.compile(rb"[\x80-\xff]+")
_CDATA_START = len("<![CDATA[")


def parse(text: str | bytes, name: str) -> Document:
    """Read a document.

    Names stay as written. Entities that the document itself declares are expanded; external ones are refused.

    Args:
        text: the document; bytes are decoded as a file is.
        name: what a reader knows the text by: a path, or a name in angle brackets such as ``<stdin>``.

    Raises:
        LinkwrightError: XML104 (not text), XML105 (empty), XML2xx (not well-formed XML), with the place.
    """
    if isinstance(text, bytes):
        text = decode(text, name)
    return _Reader(SourceText(name, text)).read()


def parse_file(path: str | Path) -> Document:
    """Read a document from a file.

    Raises:
        LinkwrightError: XML101 (no such file), XML102 (a folder), XML103 (cannot be read), and those of `parse`.
    """
    return parse(read_bytes(path), str(path))


def read_bytes(path: str | Path) -> bytes:
    """The bytes of a file, or a `LinkwrightError` (XML101, XML102, XML103) that says why there are none."""
    try:
        return Path(path).read_bytes()
    except FileNotFoundError:
        message = f"no such file: '{path}'"
        raise LinkwrightError(Diagnostic("XML101", message, hint=missing_file_hint(Path(path)))) from None
    except IsADirectoryError:
        message = f"'{path}' is a folder, not a file"
        hint = missing_file_hint(Path(path) / "_.xacro")
        raise LinkwrightError(Diagnostic("XML102", message, hint=hint)) from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        advice = "is it yours to read?" if isinstance(error, PermissionError) else None
        raise LinkwrightError(Diagnostic("XML103", f"cannot read '{path}': {reason}", hint=advice)) from None


class _Reader:
    """Builds the tree from expat's events.

    Positions are byte offsets while reading, which is what expat gives; for a text that is not plain ASCII they are
    turned into character offsets at the end.
    """

    def __init__(self, source: SourceText) -> None:
        self._source = source
        self._data = source.text.encode("utf-8", "surrogatepass")
        self._is_ascii = source.text.isascii()
        self._parser = parser = ParserCreate("utf-8")
        parser.buffer_text = True
        parser.specified_attributes = True  # the defaults of a DTD are not written, so they are not there
        parser.buffer_size = max(1024, min(len(self._data), 1 << 20))
        parser.StartElementHandler = self._start
        parser.EndElementHandler = self._end
        parser.CharacterDataHandler = self._characters
        parser.CommentHandler = self._comment
        parser.ProcessingInstructionHandler = self._instruction
        parser.StartCdataSectionHandler = self._start_cdata
        parser.EndCdataSectionHandler = self._end_cdata
        parser.StartDoctypeDeclHandler = self._start_doctype
        parser.EndDoctypeDeclHandler = self._end_doctype
        parser.EntityDeclHandler = self._entity
        parser.ExternalEntityRefHandler = self._external_entity
        parser.SkippedEntityHandler = self._skipped_entity
        self._entities = EntityGuard()
        self._root: Element | None = None
        self._stack: list[Element] = []
        self._children: list[Node] = []  # the children of the innermost open element
        self._outside: list[Comment | ProcessingInstruction] = []
        self._prolog: list[Comment | ProcessingInstruction] = []
        self._cdata_at: int | None = None
        self._doctype: str | None = None
        self._doctype_at = 0
        self._in_doctype = False
        self._declared = {"xml", "xmlns"}  # prefixes declared on the root element
        self._known: set[str] = set()  # names whose prefix was found to be declared
        self._scopes: list[tuple[Element, set[str]]] = []  # prefixes declared further in

    def read(self) -> Document:
        try:
            self._parser.Parse(self._data, True)
        except ExpatError as error:
            open_elements = [(element.tag, self._character(element.offset)) for element in self._stack]
            offset = self._character(self._parser.ErrorByteIndex)
            raise syntax_error(self._source, error, offset, open_elements) from None
        finally:
            self._release()
        assert self._root is not None, "expat accepts no document without a root element"
        document = Document(self._root, self._source)
        document.prolog, document.epilog = self._prolog, self._outside
        document.doctype, document.doctype_index = self._doctype, self._doctype_at
        if not self._is_ascii:
            _to_character_offsets(document, self._data)
        return document

    def _release(self) -> None:
        # The handlers are bound methods: without this, parser and reader would wait for the garbage collector.
        parser = self._parser
        for handler in ("StartElement", "EndElement", "CharacterData", "Comment", "ProcessingInstruction"):
            setattr(parser, f"{handler}Handler", None)
        for handler in ("StartCdataSection", "EndCdataSection", "StartDoctypeDecl", "EndDoctypeDecl"):
            setattr(parser, f"{handler}Handler", None)
        for handler in ("EntityDecl", "ExternalEntityRef", "SkippedEntity"):
            setattr(parser, f"{handler}Handler", None)

    def _character(self, byte_offset: int) -> int:
        return len(self._data[: max(0, byte_offset)].decode("utf-8", "replace"))

    # elements

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        element = Element(tag, attributes, self._source, self._parser.CurrentByteIndex)
        if self._root is None:
            self._begin_root(element)
        else:
            self._children.append(element)
        self._stack.append(element)
        self._children = element.children
        if not (tag in self._known and attributes.keys() <= self._known):
            self._check_prefixes(element)

    def _begin_root(self, element: Element) -> None:
        self._root = element
        self._prolog, self._outside = self._outside, []
        self._declared.update(name[6:] for name in element.attributes if name.startswith("xmlns:"))
        if self._entities and self._entities.growth(self._source.text) > GROWTH_LIMIT:
            message = f"the entities of this document expand to more than {GROWTH_LIMIT:,} characters"
            raise forbidden_entity(self._source, self._source.text.find("<!ENTITY"), message)

    def _end(self, _tag: str) -> None:
        element = self._stack.pop()
        if self._scopes and self._scopes[-1][0] is element:
            self._scopes.pop()
        if self._stack:
            self._children = self._stack[-1].children

    def _check_prefixes(self, element: Element) -> None:
        if element is not self._root:
            inner = {name[6:] for name in element.attributes if name.startswith("xmlns:")}
            if inner - self._declared:
                self._scopes.append((element, inner))
        for name in (element.tag, *element.attributes):
            prefix, colon, _ = name.partition(":")
            if not colon or prefix in self._declared:
                self._known.add(name)
            elif not any(prefix in declared for _, declared in self._scopes):
                offset = self._source.text.find(name, self._character(element.offset))
                raise undeclared_prefix(self._source, offset, name)

    # character data

    def _characters(self, data: str) -> None:
        children = self._children
        last = children[-1] if children else None
        if self._cdata_at is not None:
            if isinstance(last, Text) and last.cdata and last.offset == self._cdata_at:
                last.data += data
            else:
                children.append(Text(data, self._source, self._cdata_at, cdata=True))
        elif isinstance(last, Text) and not last.cdata:
            last.data += data
        else:
            children.append(Text(data, self._source, self._text_start(data)))

    def _text_start(self, data: str) -> int:
        # Expat hands text over when it meets what follows it, so the place is counted back from there; a text that
        # is longer as written than as read (entities, Windows line ends) begins after the tag before it.
        end = self._parser.CurrentByteIndex
        if self._is_ascii:
            start = end - len(data)
            if self._source.text.startswith(data, start):
                return start
        else:
            raw = data.encode("utf-8", "surrogatepass")
            if self._data.endswith(raw, 0, end):
                return end - len(raw)
        return self._data.rfind(b">", 0, end) + 1

    def _start_cdata(self) -> None:
        self._cdata_at = self._parser.CurrentByteIndex + _CDATA_START

    def _end_cdata(self) -> None:
        self._cdata_at = None

    # comments and processing instructions

    def _comment(self, data: str) -> None:
        self._keep(Comment(data, self._source, self._parser.CurrentByteIndex))

    def _instruction(self, target: str, data: str) -> None:
        self._keep(ProcessingInstruction(target, data, self._source, self._parser.CurrentByteIndex))

    def _keep(self, node: Comment | ProcessingInstruction) -> None:
        if self._stack:
            self._children.append(node)
        elif not self._in_doctype:
            self._outside.append(node)

    # document type and entities

    def _start_doctype(self, name: str, system_id: str | None, public_id: str | None, _subset: bool) -> None:
        self._in_doctype = True
        self._doctype_at = len(self._outside)
        self._doctype = f"<!DOCTYPE {name}"
        if public_id:
            self._doctype += f"\n  PUBLIC '{public_id}'\n  '{system_id}'"
        elif system_id:
            self._doctype += f"\n  SYSTEM '{system_id}'"

    def _end_doctype(self) -> None:
        self._in_doctype = False
        assert self._doctype is not None, "expat ends only a document type declaration that it began"
        end = self._parser.CurrentByteIndex
        start = self._data.find(b"<!DOCTYPE")
        declaration = self._data[start:end].decode("utf-8", "replace")
        if "[" in declaration:
            subset = declaration[declaration.index("[") + 1 : declaration.rindex("]")]
            self._doctype += f" [{subset}]"
        self._doctype += ">"

    def _entity(
        self,
        name: str,
        is_parameter: bool,
        value: str | None,
        _base: str | None,
        _system_id: str | None,
        _public_id: str | None,
        _notation: str | None,
    ) -> None:
        if value is not None and not is_parameter:
            self._entities.declare(name, value)

    def _external_entity(
        self, context: str | None, _base: str | None, system_id: str | None, _public_id: str | None
    ) -> int:
        offset = self._character(self._parser.CurrentByteIndex)
        message = f"the entity '&{context};' would read another file ('{system_id}')"
        raise forbidden_entity(self._source, offset, message)

    def _skipped_entity(self, name: str, is_parameter: bool) -> None:
        if not is_parameter:
            offset = self._character(self._parser.CurrentByteIndex)
            raise forbidden_entity(self._source, offset, f"the entity '&{name};' is not defined")


def _to_character_offsets(document: Document, data: bytes) -> None:
    """Turn the byte offsets of all nodes into character offsets."""
    ends: list[int] = []
    extra = [0]  # how many bytes more than characters there are up to each end
    for run in _BEYOND_ASCII.finditer(data):
        ends.append(run.end())
        extra.append(extra[-1] + len(run[0]) - len(run[0].decode("utf-8", "replace")))
    nodes: list[Node] = [*document.prolog, document.root, *document.epilog]
    while nodes:
        node = nodes.pop()
        node.offset -= extra[bisect_right(ends, node.offset)]
        if isinstance(node, Element):
            nodes.extend(node.children)
