"""The nodes of an XML tree, and the garbage collector's rest while one is built.

Running Python's garbage collector less often while a tree is built.

Reading and expanding make many small objects at once. Nearly all of them stay, and none form reference cycles that are
garbage. The collector searches them again and again all the same, which costs up to a tenth of the time; now and then
it searches every object of the program.
"""

from __future__ import annotations

import gc
from _thread import allocate_lock  # threading.Lock without the rest of threading
from collections.abc import Iterator

from linkwright.diagnostics import SourceText, Span
from linkwright.loading.lean_typing import Any, SupportsIndex
from linkwright.xmltree.decoding import UTF_8

_SELDOM = 50_000
"""After how many new objects the collector looks all the same."""
_depth_lock = allocate_lock()
_active = 0
_before = (0, 0, 0)


class seldom_collected:  # noqa: N801 - it is called in a ``with`` statement, as a function is
    """Let the garbage collector run less often inside a ``with`` block; new objects then count as old."""

    def __enter__(self) -> None:
        global _active, _before  # noqa: PLW0603 - there is one collector for the whole process
        with _depth_lock:
            if _active == 0:
                _before = gc.get_threshold()
                if 0 < _before[0] < _SELDOM:
                    gc.set_threshold(_SELDOM, *_before[1:])
            _active += 1

    def __exit__(self, *_: object) -> None:
        global _active  # noqa: PLW0603 - see above
        with _depth_lock:
            _active -= 1
            if _active == 0:
                if gc.get_freeze_count() == 0:  # new objects become old without a collection
                    gc.freeze()
                    gc.unfreeze()
                gc.set_threshold(*_before)


class Text:
    """Character data. `cdata` marks a CDATA section, which is written back as one and never evaluated."""

    __slots__ = ("cdata", "data", "offset", "source")

    def __init__(self, data: str, source: SourceText | None = None, offset: int = 0, *, cdata: bool = False) -> None:
        self.data = data
        self.source = source
        self.offset = offset
        self.cdata = cdata


class Comment:
    """A comment; `data` is the text between the dashes."""

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
    """An element.

    Attributes:
        tag: the name as written, with its prefix.
        attributes: name as written -> value, in document order.
        children: elements, texts, comments and processing instructions, in document order.
        source: the text it was read from; None for an element made by a program.
        offset: character offset of its ``<`` in that text.
        origin: what produced it if it was not simply read (the xacro room's chain of macro calls), else None.
        plan: the xacro room's plan for expanding it, else None; to change an element of a tree
            that was expanded, set it to None, on the elements around as well.
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
        """The child elements, all or those of one tag, in document order."""
        for child in self.children:
            if isinstance(child, Element) and (tag is None or child.tag == tag):
                yield child

    def walk(self) -> Iterator[Element]:
        """The element itself and all elements inside, in document order."""
        pending = [self]
        while pending:
            element = pending.pop()
            yield element
            pending += [child for child in reversed(element.children) if isinstance(child, Element)]

    def first(self, tag: str) -> Element | None:
        """The first child element of a tag, or None."""
        for child in self.children:
            if isinstance(child, Element) and child.tag == tag:
                return child
        return None

    def text(self) -> str:
        """The character data directly inside, joined."""
        return "".join(child.data for child in self.children if isinstance(child, Text))

    def span(self) -> Span | None:
        """The place of the start tag's name, ``<`` included; None for an element made by a program."""
        if self.source is None:
            return None
        return self.source.span(self.offset, self.offset + 1 + len(self.tag))

    def attribute_span(self, name: str) -> Span | None:
        """The place of an attribute's value in the source, else of the element (absent or made by a program)."""
        from linkwright.xmltree.positions import attribute_value_range

        if self.source is None:
            return None
        found = attribute_value_range(self.source.text, self.offset, name)
        return self.source.span(*found) if found else self.span()


class CachedText:
    """The text that an element was written as, kept for the next time.

    Attributes:
        written: the blanks before it, and the text; None until it is written.
    """

    __slots__ = ("written",)

    def __init__(self) -> None:
        self.written: tuple[str, str] | None = None


_lock = allocate_lock()


class LazyCopy(Element):
    """An element that stays as it was read: a copy of another one, made on first access.

    Most of a description is only written again, and the original is enough for that.

    Attributes:
        original: the element that it is a copy of; None once it has attributes and children of its own.
        plan: holds the text of the original.
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
        # Python comes here when a slot is empty.
        if name in ("attributes", "children"):
            with _lock:  # two threads that look at once find the same children
                original = self.original
                if original is not None:
                    self.original = None
                    _fill(self, original)
        return object.__getattribute__(self, name)

    def __reduce_ex__(self, protocol: SupportsIndex) -> Any:
        """For `copy` and `pickle`, which read the state."""
        _ = self.children
        return super().__reduce_ex__(protocol)


def _fill(copy: LazyCopy, original: Element) -> None:
    """Give a copy attributes and children of its own; texts and comments are shared."""
    origin = copy.origin
    pending: list[tuple[Element, Element]] = [(copy, original)]
    while pending:  # not by recursion: elements may be nested deeper than Python's calls
        made, original = pending.pop()
        while isinstance(original, LazyCopy) and original.original is not None:
            original = original.original
        made.attributes = original.attributes.copy()
        children: list[Node] = []
        for child in original.children:
            if isinstance(child, Element):
                inner = Element(child.tag, None, child.source, child.offset, origin)
                inner.plan = child.plan
                pending.append((inner, child))
                children.append(inner)
            else:
                children.append(child)
        made.children = children


Node = Element | Text | Comment | ProcessingInstruction


class Document:
    """A parsed document: the nodes before the root, the root, the nodes after it.

    Attributes:
        prolog: comments and processing instructions before the root.
        root: the root element.
        epilog: comments and processing instructions after the root.
        doctype: the document type declaration as it is written back, or None.
        doctype_index: how many nodes of the prolog precede the document type declaration.
        source: the text it was read from; None for a document made by a program.
        encoding: of the file; ``utf-8`` for any text that is valid as such, and for texts without a file.
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
