"""The XML reader that builds a tree with the position of each node.

The input is a file, or a text that replaces the content of a file, such as an unsaved text.
"""

from __future__ import annotations

import os
import re
from bisect import bisect_right
from collections.abc import Callable, Mapping
from pyexpat import ExpatError, ParserCreate  # the parser of xml.parsers.expat, without importing its packages

from linkwright.diagnostics import (
    Diagnostic,
    LinkwrightError,
    Phrase,
    SourceText,
    as_typed,
    foreign,
    missing_file_hint,
    phrase,
)
from linkwright.files.input_files import MAX_TEXT_BYTES, NoWriterError, read_file
from linkwright.loading.lean_typing import TYPE_CHECKING, NoReturn
from linkwright.xmltree.decoding import Decoded, decode_with_encoding, wrap_text
from linkwright.xmltree.nodes import Comment, Document, Element, Node, ProcessingInstruction, Text

if TYPE_CHECKING:
    from pathlib import Path


MAX_ENTITY_GROWTH = 1_000_000
"""The maximum number of characters to which all entities of one document may expand."""

_ENTITY_REFERENCE = r"&([^\s#;&<]+);"  # compiled on first use, because few files need it


class EntityGuard:
    """The lengths of texts after the expansion of the internal entities of a document."""

    def __init__(self) -> None:
        self._values: dict[str, str] = {}
        self._lengths: dict[str, int] = {}

    def __bool__(self) -> bool:
        return bool(self._values)

    def declare(self, name: str, value: str) -> None:
        """Record an internal entity.

        As XML requires, the first declaration of a name applies.
        """
        self._values.setdefault(name, value)

    def growth(self, text: str) -> int:
        """Return the total expanded length of the references to declared entities in a text."""
        return sum(self._expanded_length(name, ()) for name in re.findall(_ENTITY_REFERENCE, text))

    def _expanded_length(self, name: str, enclosing_names: tuple[str, ...]) -> int:
        value = self._values.get(name)
        if (
            value is None or name in enclosing_names
        ):  # predefined, undeclared or recursive: the parser reports recursion
            return 0
        expanded_length = self._lengths.get(name)
        if expanded_length is None:
            if len(enclosing_names) > 100:
                return MAX_ENTITY_GROWTH + 1
            expanded_length = len(value) + sum(
                self._expanded_length(nested_name, (*enclosing_names, name))
                for nested_name in re.findall(_ENTITY_REFERENCE, value)
            )
            expanded_length = self._lengths[name] = min(expanded_length, MAX_ENTITY_GROWTH + 1)
        return expanded_length


_NON_ASCII = rb"[\x80-\xff]+"  # compiled on first use, because few files need it
_CDATA_START = len("<![CDATA[")


def parse(
    text: str | bytes, name: str, *, blanks: bool = True, read_as: str | None = None, any_prefix: bool = False
) -> Document:
    """Parse an XML text into a document.

    Names keep their prefixes. Entities that the document declares are expanded, and external entities are refused.

    Args:
        text: the XML text, or the bytes of a file, which are decoded.
        name: the name of the text in messages: a path, or a name in angle brackets such as ``<stdin>``.
        blanks: whether to keep text nodes that consist of whitespace; only documents that are written again need such
            nodes.
        read_as: a text of the same length to parse instead, in which a lenient parser replaced constructs that XML
            forbids.
        any_prefix: whether to accept names with undeclared prefixes.

    Raises:
        LinkwrightError: XML104 (not text), XML105 (empty), XML106 (a Git LFS pointer) or XML2xx (not well-formed XML),
            with the location.
    """
    text, encoding = decode_with_encoding(text, name) if isinstance(text, bytes) else wrap_text(text, name)
    document = _Reader(SourceText(name, text), blanks=blanks, read_as=read_as, any_prefix=any_prefix).read()
    document.encoding = encoding
    return document


def parse_file(path: str | Path) -> Document:
    """Parse an XML file into a document.

    Raises:
        LinkwrightError: XML101 (no such file), XML102 (a folder), XML103 (cannot be read), or an error of `parse`.
    """
    return parse(read_bytes(path), str(path))


def read_bytes(path: str | Path) -> bytes:
    """Return the bytes of a file.

    Raises:
        LinkwrightError: XML101, XML102 or XML103, with the reason.
    """
    try:
        data = read_file(path, MAX_TEXT_BYTES)
    except FileNotFoundError:
        message = phrase("no such file: '{path}'", path=as_typed(path))
        raise LinkwrightError(Diagnostic("XML101", message, hint=_make_missing_hint(path))) from None
    except IsADirectoryError:
        message = phrase("'{path}' is a folder, not a file", path=path)
        hint = _make_missing_hint(os.path.join(path, "_.xacro"))  # noqa: PTH118 - pathlib takes long to import
        raise LinkwrightError(Diagnostic("XML102", message, hint=hint)) from None
    except NoWriterError:
        pipe = phrase("it is a pipe without a writer")
        message = phrase("cannot read '{path}': {reason}", path=path, reason=pipe)
        raise LinkwrightError(
            Diagnostic("XML103", message, hint=phrase("start the program that writes to it first"))
        ) from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        permission_hint = (
            phrase("check that you have permission to read it") if isinstance(error, PermissionError) else None
        )
        raise LinkwrightError(
            Diagnostic(
                "XML103",
                phrase("cannot read '{path}': {reason}", path=path, reason=foreign(reason)),
                hint=permission_hint,
            )
        ) from None
    if len(data) == MAX_TEXT_BYTES:  # for example a device that produces endless data
        reason = phrase("it has more than {count} million bytes", count=MAX_TEXT_BYTES // 1_000_000)
        message = phrase("cannot read '{path}': {reason}", path=path, reason=reason)
        raise LinkwrightError(Diagnostic("XML103", message))
    return data


def _make_missing_hint(path: str | Path) -> Phrase:
    from pathlib import Path

    return missing_file_hint(Path(path))


class _Reader:
    """A reader that builds the tree from expat's events.

    During parsing, positions are expat's byte offsets. For a text with non-ASCII characters, they are converted to
    character offsets at the end. Nearly all events are start tags, end tags and texts, so the handlers for these are
    closures, which are faster than methods.
    """

    def __init__(self, source: SourceText, *, blanks: bool, read_as: str | None, any_prefix: bool) -> None:
        self._source = source
        self._any_prefix = any_prefix
        text = source.text if read_as is None else read_as
        self._data = text.encode("utf-8", "surrogatepass")
        self._is_ascii = text.isascii()
        self._keep_blanks = blanks
        self._parser = parser = ParserCreate("utf-8")
        parser.buffer_text = True
        parser.specified_attributes = True  # ignore attribute defaults of a DTD, which are not written in the document
        parser.buffer_size = max(1024, min(len(self._data), 1 << 20))
        parser.CommentHandler = self._add_comment
        parser.ProcessingInstructionHandler = self._add_instruction
        parser.StartCdataSectionHandler = self._start_cdata
        parser.EndCdataSectionHandler = self._end_cdata
        parser.StartDoctypeDeclHandler = self._start_doctype
        parser.EndDoctypeDeclHandler = self._end_doctype
        parser.EntityDeclHandler = self._entity
        parser.ExternalEntityRefHandler = self._external_entity
        parser.SkippedEntityHandler = self._skipped_entity
        self._entities = EntityGuard()
        self._top = Element("")  # The parent of the root and of the nodes outside the root.
        self._open = [self._top]
        self._cdata_at: int | None = None
        self._doctype: str | None = None
        self._doctype_at = 0
        self._in_doctype = False
        self._handle_elements()

    def _handle_elements(self) -> None:
        source, parser, open_elements = self._source, self._parser, self._open
        begin, finish = open_elements.append, open_elements.pop

        def start(tag: str, attributes: dict[str, str]) -> None:
            element = Element(tag, attributes, source, parser.CurrentByteIndex)
            open_elements[-1].children.append(element)
            begin(element)

        def end(_tag: str) -> None:
            finish()

        parser.StartElementHandler = start
        parser.EndElementHandler = end
        parser.CharacterDataHandler = self._characters_handler()

    def _characters_handler(self) -> Callable[[str], None]:
        source, parser, open_elements = self._source, self._parser, self._open
        text, is_ascii, keep_blanks = source.text, self._is_ascii, self._keep_blanks

        def characters(data: str) -> None:
            if not keep_blanks and data.isspace():
                return
            children = open_elements[-1].children
            if self._cdata_at is not None or (children and isinstance(children[-1], Text)):
                self._add_characters(data, children)
                return
            # Expat reports text only when it reaches the next node, so subtract the length to get the start of the
            # text.
            text_offset = parser.CurrentByteIndex - len(data)
            if not (is_ascii and text.startswith(data, text_offset)):
                text_offset = self._find_text_start(data)
            children.append(Text(data, source, text_offset))

        return characters

    def read(self) -> Document:
        try:
            self._parser.Parse(self._data, True)
        except ExpatError as error:
            from linkwright.xmltree.faults import syntax_error  # imported here because most texts are well-formed

            self._check_prefixes()
            open_elements = [(element.tag, self._character_offset(element.offset)) for element in self._open[1:]]
            offset = self._character_offset(self._parser.ErrorByteIndex)
            raise syntax_error(self._source, error, offset, open_elements) from None
        finally:
            self._release()
        self._check_prefixes()
        top_nodes = self._top.children
        root_index, root = next((index, node) for index, node in enumerate(top_nodes) if isinstance(node, Element))
        document = Document(root, self._source)
        document.prolog, document.epilog = (
            _select_comments_and_instructions(top_nodes[:root_index]),
            _select_comments_and_instructions(top_nodes[root_index + 1 :]),
        )
        document.doctype, document.doctype_index = self._doctype, self._doctype_at
        if not self._is_ascii:
            _to_character_offsets(document, self._data)
        return document

    def _release(self) -> None:
        # Break the reference cycle between parser and handlers, so that both are freed without the garbage collector.
        parser = self._parser
        for handler in ("StartElement", "EndElement", "CharacterData", "Comment", "ProcessingInstruction"):
            setattr(parser, f"{handler}Handler", None)
        for handler in ("StartCdataSection", "EndCdataSection", "StartDoctypeDecl", "EndDoctypeDecl"):
            setattr(parser, f"{handler}Handler", None)
        for handler in ("EntityDecl", "ExternalEntityRef", "SkippedEntity"):
            setattr(parser, f"{handler}Handler", None)

    def _character_offset(self, byte_offset: int) -> int:
        return len(self._data[: max(0, byte_offset)].decode("utf-8", "replace"))

    # prefixes

    def _check_prefixes(self) -> None:
        """Raise if the prefix of a name is not declared in the element or in an enclosing element."""
        if self._any_prefix:
            return
        used_prefixes = {name.partition(":")[0] for name in self._parser.intern if name and ":" in name}
        for root in self._top.elements():
            declared_prefixes = {"xml", "xmlns", *_list_declared_prefixes(root)}
            if used_prefixes <= declared_prefixes:
                return  # the usual case
            pending = [(root, declared_prefixes)]
            while pending:
                element, declared_prefixes = pending.pop()
                declared_prefixes = declared_prefixes.union(_list_declared_prefixes(element))
                for name in (element.tag, *element.attributes):
                    prefix, colon, _ = name.partition(":")
                    if colon and prefix not in declared_prefixes:
                        offset = self._source.text.find(name, self._character_offset(element.offset))
                        self._refuse_prefix(offset, name)
                pending.extend((child, declared_prefixes) for child in reversed(list(element.elements())))

    def _refuse_prefix(self, offset: int, name: str) -> NoReturn:
        from linkwright.xmltree.faults import undeclared_prefix_error

        raise undeclared_prefix_error(self._source, offset, name)

    def _refuse_entity(self, offset: int, message: Phrase) -> NoReturn:
        from linkwright.xmltree.faults import forbidden_entity_error

        raise forbidden_entity_error(self._source, offset, message)

    # character data

    def _add_characters(self, data: str, children: list[Node]) -> None:
        """Add character data inside a CDATA section, or after other character data."""
        last_child = children[-1] if children else None
        if self._cdata_at is not None:
            if isinstance(last_child, Text) and last_child.cdata and last_child.offset == self._cdata_at:
                last_child.data += data
            else:
                children.append(Text(data, self._source, self._cdata_at, cdata=True))
        elif isinstance(last_child, Text) and not last_child.cdata:
            last_child.data += data
        else:
            children.append(Text(data, self._source, self._find_text_start(data)))

    def _find_text_start(self, data: str) -> int:
        # If the source of a text is longer than its parsed form, because of entities or Windows line endings, the text
        # begins after the previous tag.
        end = self._parser.CurrentByteIndex
        encoded = data.encode("utf-8", "surrogatepass")
        if self._data.endswith(encoded, 0, end):
            return end - len(encoded)
        return self._data.rfind(b">", 0, end) + 1

    def _start_cdata(self) -> None:
        self._cdata_at = self._parser.CurrentByteIndex + _CDATA_START

    def _end_cdata(self) -> None:
        self._cdata_at = None

    # comments and processing instructions

    def _add_comment(self, data: str) -> None:
        self._append(Comment(data, self._source, self._parser.CurrentByteIndex))

    def _add_instruction(self, target: str, data: str) -> None:
        self._append(ProcessingInstruction(target, data, self._source, self._parser.CurrentByteIndex))

    def _append(self, node: Comment | ProcessingInstruction) -> None:
        if not self._in_doctype:
            self._open[-1].children.append(node)

    # document type and entities

    def _start_doctype(self, name: str, system_id: str | None, public_id: str | None, _subset: bool) -> None:
        self._in_doctype = True
        self._doctype_at = len(self._top.children)
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
        if self._entities and self._entities.growth(self._source.text) > MAX_ENTITY_GROWTH:
            message = phrase(
                "the entities of this document expand to more than {growth_limit:,} characters",
                growth_limit=MAX_ENTITY_GROWTH,
            )
            self._refuse_entity(self._source.text.find("<!ENTITY"), message)

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
        offset = self._character_offset(self._parser.CurrentByteIndex)
        message = phrase("the entity '&{entity};' would read another file ('{file}')", entity=context, file=system_id)
        self._refuse_entity(offset, message)

    def _skipped_entity(self, name: str, is_parameter: bool) -> None:
        if not is_parameter:
            offset = self._character_offset(self._parser.CurrentByteIndex)
            self._refuse_entity(offset, phrase("the entity '&{name};' is not defined", name=name))


def _list_declared_prefixes(element: Element) -> list[str]:
    return [name[6:] for name in element.attributes if name.startswith("xmlns:")]


def _select_comments_and_instructions(nodes: list[Node]) -> list[Comment | ProcessingInstruction]:
    return [node for node in nodes if isinstance(node, (Comment, ProcessingInstruction))]


def _to_character_offsets(document: Document, data: bytes) -> None:
    """Convert the byte offsets of all nodes to character offsets."""
    ends: list[int] = []
    surplus = [0]  # bytes minus characters, up to the end of each run of non-ASCII characters
    for run in re.finditer(_NON_ASCII, data):
        ends.append(run.end())
        surplus.append(surplus[-1] + len(run[0]) - len(run[0].decode("utf-8", "replace")))
    nodes: list[Node] = [*document.prolog, document.root, *document.epilog]
    while nodes:
        node = nodes.pop()
        node.offset -= surplus[bisect_right(ends, node.offset)]
        if isinstance(node, Element):
            nodes.extend(node.children)


class Overlay:
    """Replacement texts of files, such as unsaved texts in an editor, and access to files.

    Args:
        texts: the replacement texts by path. The files need not exist.
    """

    def __init__(self, texts: Mapping[str | os.PathLike[str], str] | None = None) -> None:
        self._texts: dict[str | os.PathLike[str], str] = {
            _to_real_path(path): text for path, text in (texts or {}).items()
        }
        self._documents: dict[str, Document] = {}

    @property
    def texts(self) -> Mapping[str | os.PathLike[str], str]:
        """The replacement texts by the real paths of the files."""
        return self._texts

    def text(self, path: str | os.PathLike[str]) -> str | None:
        """Return the replacement text of a file, or None if the file has no replacement."""
        return self._texts.get(_to_real_path(path)) if self._texts else None

    def document(self, path: str) -> Document | None:
        """Return the document of a file's replacement text, or None if the file has no replacement.

        A replacement text is parsed only once.

        Raises:
            LinkwrightError: the text is not XML; see `linkwright.xmltree.parse`.
        """
        text = self.text(path)
        if text is None:
            return None
        if path not in self._documents:
            self._documents[path] = parse(text, path)
        return self._documents[path]

    def read(self, path: str) -> Decoded:
        """Return the text and the encoding of a file.

        Raises:
            LinkwrightError: XML101 to XML104 or XML106, the file cannot be read or is not text.
        """
        text = self.text(path)
        return decode_with_encoding(read_bytes(path), path) if text is None else wrap_text(text, path)


def _to_real_path(path: str | os.PathLike[str]) -> str:
    """Return the real path of a file, so that all paths to it have the same key.

    Packages are often installed as symbolic links.
    """
    return os.path.realpath(path)
