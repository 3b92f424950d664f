"""The nodes of an XML tree, and a context in which the garbage collector runs less often.

Parsing and expanding create many small objects in a short time. Nearly all of these objects stay alive, and no
reference cycles become garbage. The collector still searches them repeatedly, which takes up to a tenth of the time.
Occasionally, it searches every object of the program.
"""

from __future__ import annotations

import gc
from _thread import allocate_lock  # the lock of threading, without importing the rest of threading
from collections.abc import Iterator

from linkwright.diagnostics import SourceText, Span
from linkwright.loading.lean_typing import Any, SupportsIndex
from linkwright.xmltree.decoding import UTF_8

_COLLECTION_THRESHOLD = 50_000
"""The number of new objects after which the collector still runs inside the context."""
_depth_lock = allocate_lock()
_active = 0
_old_thresholds = (0, 0, 0)
_were_frozen = False


class seldom_collected:  # noqa: N801 - it is called in a ``with`` statement, as a function is
    """A context in which the garbage collector runs less often.

    At the end of the context, all objects become part of the oldest generation, which Python seldom searches. A
    process that runs for days calls `gc.collect` from time to time.
    """

    def __enter__(self) -> None:
        global _active, _old_thresholds  # noqa: PLW0603 - there is one collector for the whole process
        with _depth_lock:
            if _active == 0:
                _old_thresholds = gc.get_threshold()
                if 0 < _old_thresholds[0] < _COLLECTION_THRESHOLD:
                    gc.set_threshold(_COLLECTION_THRESHOLD, *_old_thresholds[1:])
            _active += 1

    def __exit__(self, *_: object) -> None:
        global _active  # noqa: PLW0603 - see above
        with _depth_lock:
            _active -= 1
            if _active == 0:
                if not _has_frozen_objects():  # move new objects to the oldest generation without a collection
                    gc.freeze()
                    gc.unfreeze()
                gc.set_threshold(*_old_thresholds)


def _has_frozen_objects() -> bool:
    """Return whether the process has frozen objects, such as a process that forks.

    Once there were some, they are not counted again, also not in a forked process, because that takes longer than
    reading a robot if there are a million.
    """
    global _were_frozen  # noqa: PLW0603 - there is one collector for the whole process
    _were_frozen = _were_frozen or gc.get_freeze_count() > 0
    return _were_frozen


class Text:
    """Character data.

    `cdata` marks a CDATA section, which is written as CDATA and is never evaluated.
    """

    __slots__ = ("cdata", "data", "offset", "source")

    def __init__(self, data: str, source: SourceText | None = None, offset: int = 0, *, cdata: bool = False) -> None:
        self.data = data
        self.source = source
        self.offset = offset
        self.cdata = cdata


class Comment:
    """A comment with the text `data` between ``<!--`` and ``-->``."""

    __slots__ = ("data", "offset", "source")

    def __init__(self, data: str, source: SourceText | None = None, offset: int = 0) -> None:
        self.data = data
        self.source = source
        self.offset = offset


class ProcessingInstruction:
    """A processing instruction: ``<?target data?>``."""

    __slots__ = ("data", "offset", "source", "target")

    def __init__(self, target: str, data: str, source: SourceText | None = None, offset: int = 0) -> None:
        self.target = target
        self.data = data
        self.source = source
        self.offset = offset


class Element:
    """An XML element.

    Attributes:
        tag: the name as written, including its prefix.
        attributes: the values of attributes in document order, by name as written.
        children: elements, texts, comments and processing instructions, in document order.
        source: the text that contains the element, or None for an element created by a program.
        offset: the character offset of the element's ``<`` in the source.
        origin: the chain of macro calls and includes that produced the element in an expansion, or None.
        plan: the plan for expanding the element with xacro, or None. Before an element of an expanded tree is changed,
            the plan must be set to None in the element and in all enclosing elements.
    """

    __slots__ = ("attributes", "children", "offset", "origin", "plan", "source", "tag")

    def __init__(
        self,
        tag: str,
        attributes: dict[str, str] | None = None,
        source: SourceText | None = None,
        offset: int = 0,
        origin: object = None,
    ) -> None:
        self.tag = tag
        self.attributes: dict[str, str] = {} if attributes is None else attributes
        self.children: list[Node] = []
        self.source = source
        self.offset = offset
        self.origin = origin
        self.plan: object = None

    def __repr__(self) -> str:
        return f"<{self.tag} {self.attributes}>"

    def elements(self, tag: str | None = None) -> Iterator[Element]:
        """Yield the child elements in document order, or only the children with a tag."""
        for child in self.children:
            if isinstance(child, Element) and (tag is None or child.tag == tag):
                yield child

    def walk(self) -> Iterator[Element]:
        """Yield this element and all elements inside it, in document order."""
        pending = [self]
        while pending:
            element = pending.pop()
            yield element
            pending += [child for child in reversed(element.children) if isinstance(child, Element)]

    def first(self, tag: str) -> Element | None:
        """Return the first child element with a tag, or None."""
        for child in self.children:
            if isinstance(child, Element) and child.tag == tag:
                return child
        return None

    def text(self) -> str:
        """Return the joined character data directly inside the element."""
        return "".join(child.data for child in self.children if isinstance(child, Text))

    def span(self) -> Span | None:
        """Return the location of ``<`` and the name, or None if there is no source."""
        if self.source is None:
            return None
        return self.source.span(self.offset, self.offset + 1 + len(self.tag))

    def attribute_span(self, name: str) -> Span | None:
        """Return an attribute value's location in the source, or None if the node has no source.

        If the attribute is absent or was created by a program, the location of the element is returned.
        """
        from linkwright.xmltree.positions import attribute_value_range

        if self.source is None:
            return None
        value_range = attribute_value_range(self.source.text, self.offset, name)
        return self.source.span(*value_range) if value_range else self.span()


class CachedText:
    """A cache for the written text of an element.

    Attributes:
        written: the whitespace before the element, and the element's text; None until the element is written.
    """

    __slots__ = ("written",)

    def __init__(self) -> None:
        self.written: tuple[str, str] | None = None


_lock = allocate_lock()


class LazyCopy(Element):
    """An unchanged copy of an element that creates its attributes and children on first access.

    Most copies are only written, which does not require attributes and children of their own.

    Attributes:
        original: the copied element, or None once the copy has its own attributes and children.
        plan: the plan of the original, which caches its text.
    """

    __slots__ = ("original",)

    def __init__(self, original: Element, origin: object) -> None:
        self.tag = original.tag
        self.source = original.source
        self.offset = original.offset
        self.origin = origin
        self.plan = original.plan
        self.original: Element | None = original

    def __getattr__(self, name: str) -> Any:
        # Python calls this method if a slot is empty.
        if name in ("attributes", "children"):
            with _lock:  # two threads must not create different children
                original = self.original
                if original is not None:
                    self.original = None
                    _fill(self, original)
        return object.__getattribute__(self, name)

    def __reduce_ex__(self, protocol: SupportsIndex) -> Any:
        """Return the state for `copy` and `pickle`."""
        _ = self.children
        return super().__reduce_ex__(protocol)


def _fill(copy: LazyCopy, original: Element) -> None:
    """Give a copy its own attributes and children.

    Texts and comments are shared with the original.
    """
    origin = copy.origin
    pending: list[tuple[Element, Element]] = [(copy, original)]
    while pending:  # no recursion, because elements may be nested more deeply than Python's call stack allows
        target, original = pending.pop()
        while isinstance(original, LazyCopy) and original.original is not None:
            original = original.original
        target.attributes = original.attributes.copy()
        children: list[Node] = []
        for child in original.children:
            if isinstance(child, Element):
                child_copy = Element(child.tag, None, child.source, child.offset, origin)
                child_copy.plan = child.plan
                pending.append((child_copy, child))
                children.append(child_copy)
            else:
                children.append(child)
        target.children = children


Node = Element | Text | Comment | ProcessingInstruction


class Document:
    """A parsed document: the nodes before the root, the root, and the nodes after it.

    Attributes:
        prolog: comments and processing instructions before the root.
        root: the root element.
        epilog: comments and processing instructions after the root.
        doctype: the document type declaration in the form in which it is written, or None.
        doctype_index: the number of nodes in the prolog before the document type declaration.
        source: the text of the document, or None for a document created by a program.
        encoding: the encoding of the file, which is ``utf-8`` for any valid UTF-8 text and for texts without a file.
    """

    __slots__ = ("doctype", "doctype_index", "encoding", "epilog", "prolog", "root", "source")

    def __init__(self, root: Element, source: SourceText | None = None) -> None:
        self.prolog: list[Comment | ProcessingInstruction] = []
        self.root = root
        self.epilog: list[Comment | ProcessingInstruction] = []
        self.doctype: str | None = None
        self.doctype_index = 0
        self.encoding = UTF_8
        self.source = source
