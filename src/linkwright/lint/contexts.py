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
"""The key of the first description with certain elements, before its content is needed for a comparison."""


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
        self._last_context: FileContext | None = None

    def of_file(self, path: Path) -> FileContext:
        """Return the data that checks of a file with the same settings share.

        Only the data of the last file is stored.
        """
        if self._last_context is None or self._last_context.path != path:
            self._last_context = FileContext(path)
        return self._last_context


class FileContext:
    """The data that checks of a file with several sets of arguments share.

    Attributes:
        path: the file.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._facts: dict[Hashable, XacroFacts] = {}
        self._results: dict[Hashable, dict[tuple[object, ...], _StoredResults]] = {}
        self._frame_numbers: dict[Hashable, int] = {}

    def facts(self, facts: XacroFacts) -> XacroFacts:
        """Return the stored facts about the same files and arguments, or store and return `facts`.

        The values of arguments only matter if names are composed from them.
        """
        documents = tuple(id(file.document) for file in facts.files.values())
        key = (facts.is_library, frozenset(facts.arguments), documents)
        stored_facts = self._facts.get(key)
        if stored_facts is None or (stored_facts.arguments != facts.arguments and stored_facts.substitutes_arguments):
            stored_facts = self._facts[key] = facts
        return stored_facts

    def results_for(self, facts: XacroFacts, root: Element, *, is_whole: bool) -> dict[Any, Any]:
        """Return the results that descriptions with this expansion share.

        The results are empty for the first description with this expansion. The caller adds its results to them.

        Args:
            facts: the facts about the description's files, as `facts` returns them.
            root: the root element of the expansion.
            is_whole: whether no part is missing.
        """
        element_positions = tuple((element.tag, element.offset) for element in root.elements())
        stored_results = self._results.setdefault((facts, is_whole, element_positions), {})
        new_results = _StoredResults(root, {})
        if not stored_results:
            stored_results[_NOT_COMPARED] = (
                new_results  # most expansions differ in their elements, so no content is compared
            )
            return new_results.results
        if _NOT_COMPARED in stored_results:
            first_results = stored_results.pop(_NOT_COMPARED)
            stored_results[self._make_content_key(first_results.root)] = first_results
        return stored_results.setdefault(self._make_content_key(root), new_results).results

    def _make_content_key(self, root: Element) -> tuple[object, ...]:
        """Return the content of an expanded element, with numbers for the origins of its elements.

        Sources are identified by `id`, which is safe because the stored elements keep them alive.
        """
        content: list[object] = []
        numbers: dict[int, int] = {}
        pending: list[tuple[Element, int | None]] = [(root, None)]
        while pending:
            node, number = pending.pop()
            origin_number = self._number_chain(node.origin, numbers) if number is None else number
            while isinstance(node, LazyCopy) and node.original is not None:
                node, number = node.original, origin_number  # not copied yet: the original's content, the copy's origin
            attributes, children = node.attributes, node.children
            content += (
                origin_number,
                node.tag,
                node.offset,
                id(node.source),
                len(attributes),
                *attributes.items(),
                len(children),
            )
            for child in children:
                if isinstance(child, Element):
                    content.append(None)  # a marker for a child element, whose content follows later
                    pending.append((child, number))
                else:
                    is_cdata = child.cdata if isinstance(child, Text) else None
                    content += (type(child), child.data, is_cdata, child.offset, id(child.source))
        return tuple(content)

    def _number_chain(self, origin: object, numbers: dict[int, int]) -> int:
        """Return the number of a chain of macro calls and includes, or 0 if there is no chain.

        New frames of the chain are added to `numbers`, which maps the `id` of each known frame to its number.
        """
        chain: list[Frame] = []
        frame = origin if isinstance(origin, Frame) else None
        while frame is not None and id(frame) not in numbers:
            chain.append(frame)
            frame = frame.outer
        number = 0 if frame is None else numbers[id(frame)]
        for outer in reversed(chain):
            number = self._frame_numbers.setdefault((outer.macro, id(outer.site), number), len(self._frame_numbers) + 1)
            numbers[id(outer)] = number
        return number
