"""Data that checks share during one run: packages, and results for identical expansions.

A description is checked with every set of values that callers pass to its arguments. Most sets read the same files,
and many result in the same robot: an address or a rate only matters to the driver. Therefore, rules that check only
the sources (`Rule.of_sources`) run once for all sets that read the same files, and all rules run once for all sets
with the same expansion.
"""

from __future__ import annotations

from collections.abc import Hashable
from pathlib import Path

from linkwright.loading.lean_dataclasses import NamedTuple
from linkwright.loading.lean_typing import TYPE_CHECKING, Any
from linkwright.xacro.faults import Frame
from linkwright.xmltree import Element, Text
from linkwright.xmltree.nodes import LazyCopy

if TYPE_CHECKING:
    from linkwright.lint.package import PackageContext
    from linkwright.lint.xacro_facts import XacroFacts

_NOT_COMPARED = ()
"""The content of the first description of its parts, until there is another one of the same parts."""


class _StoredResults(NamedTuple):
    root: Element
    results: dict[Any, Any]


class Contexts:
    """The data that checks of several files, or of one file with several argument sets, share.

    Attributes:
        packages: the packages found so far, by folder.
    """

    def __init__(self) -> None:
        self.packages: dict[Path, PackageContext] = {}
        self._last: FileContext | None = None

    def of_file(self, path: Path) -> FileContext:
        """Return the data that checks of a file with the same settings share.

        Only the data of the last file is stored.
        """
        if self._last is None or self._last.path != path:
            self._last = FileContext(path)
        return self._last


class FileContext:
    """The data that checks of a file with several sets of arguments share.

    Attributes:
        path: the file.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._facts: dict[Hashable, XacroFacts] = {}
        self._done: dict[Hashable, dict[tuple[object, ...], _StoredResults]] = {}
        self._places: dict[Hashable, int] = {}

    def facts(self, facts: XacroFacts) -> XacroFacts:
        """Return the stored facts about the same files and arguments, or store and return `facts`.

        The values of arguments only matter if names are composed from them.
        """
        documents = tuple(id(file.document) for file in facts.files.values())
        key = (facts.is_library, frozenset(facts.given), documents)
        known = self._facts.get(key)
        if known is None or (known.given != facts.given and known.substitutes_arguments):
            known = self._facts[key] = facts
        return known

    def results_for(self, facts: XacroFacts, root: Element, *, is_whole: bool) -> dict[Any, Any]:
        """Return the shared results for a description with this expansion, which the caller extends.

        The results are empty for the first description with this expansion.

        Args:
            facts: the facts about the description's files, as `facts` returns them.
            root: the root element of the expansion.
            is_whole: whether no part is missing.
        """
        parts = tuple((element.tag, element.offset) for element in root.elements())
        known = self._done.setdefault((facts, is_whole, parts), {})
        done = _StoredResults(root, {})
        if not known:
            known[_NOT_COMPARED] = done  # most expansions differ in their elements, so no content is compared
            return done.results
        if _NOT_COMPARED in known:
            first = known.pop(_NOT_COMPARED)
            known[self._content(first.root)] = first
        return known.setdefault(self._content(root), done).results

    def _content(self, root: Element) -> tuple[object, ...]:
        """Return the content of an expanded element, with numbers for the origins of its elements.

        Sources are identified by `id`, which is safe because the stored elements keep them alive.
        """
        found: list[object] = []
        numbers: dict[int, int] = {}
        pending: list[tuple[Element, int | None]] = [(root, None)]
        while pending:
            node, number = pending.pop()
            own = self._number(node.origin, numbers) if number is None else number
            while isinstance(node, LazyCopy) and node.original is not None:
                node, number = node.original, own  # not copied yet: the original's content, the copy's origin
            attributes, children = node.attributes, node.children
            found += (own, node.tag, node.offset, id(node.source), len(attributes), *attributes.items(), len(children))
            for child in children:
                if isinstance(child, Element):
                    found.append(None)  # a marker for a child element, whose content follows later
                    pending.append((child, number))
                else:
                    is_cdata = child.cdata if isinstance(child, Text) else None
                    found += (type(child), child.data, is_cdata, child.offset, id(child.source))
        return tuple(found)

    def _number(self, origin: object, numbers: dict[int, int]) -> int:
        """Return the number of a chain of macro calls and includes, or 0 if there is no chain.

        New frames of the chain are added to `numbers`, which maps the `id` of each known frame to its number.
        """
        chain: list[Frame] = []
        frame = origin if isinstance(origin, Frame) else None
        while frame is not None and id(frame) not in numbers:
            chain.append(frame)
            frame = frame.around
        number = 0 if frame is None else numbers[id(frame)]
        for outer in reversed(chain):
            number = self._places.setdefault((outer.macro, id(outer.site), number), len(self._places) + 1)
            numbers[id(outer)] = number
        return number
