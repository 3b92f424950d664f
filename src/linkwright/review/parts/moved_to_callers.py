"""Find links and joints that a macro no longer makes, because its callers in the repository make them now.

The robots of the repository hide such a change: they have the same links and joints as before. Descriptions of other
repositories that call the macro lack them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from linkwright.diagnostics import phrase
from linkwright.review.breaking import quote_first
from linkwright.review.parts.include_graph import IncludeGraphs
from linkwright.review.parts.outline import Outline
from linkwright.review.parts.part_pair import PartPair
from linkwright.xmltree import Element

_LINK, _JOINT = "link", "joint"
_Key = tuple[str, str]
"""The kind of an element, link or joint, and its name."""


def compare_moved_to_callers(pair: PartPair, graphs: IncludeGraphs, renamed: Mapping[str, str]) -> None:
    """Report the links and joints that callers of a macro newly make instead of the macro.

    Args:
        pair: both versions of the file with the macro.
        graphs: the includes of both versions.
        renamed: the new names of macros, by old name.
    """
    for old_name, old in pair.old.macros.items():
        new = pair.new.macros.get(renamed.get(old_name, old_name))
        if new is None:
            continue
        remaining = {(element.tag, element.attributes.get("name", "")) for element in new.element.walk()}
        lost = {
            key: element
            for key, element in _list_parts(old.element).items()
            if key not in remaining and pair.is_expanded(element, is_old=True)
        }
        added = dict(_find_added_parts(graphs, new.name)) if lost else {}
        moved = [key for key in lost if key in added]
        if not moved:
            continue
        names = quote_first(name for _, name in moved)
        text = phrase(
            "macro '{name}': no longer makes {names}, but {file} does", name=new.name, names=names, file=added[moved[0]]
        )
        reason = phrase("other callers of the macro lack {names} unless they make them", names=names)
        if len(moved) == 1:
            reason = phrase("other callers of the macro lack '{name}' unless they make it", name=moved[0][1])
        pair.add(text, lost[moved[0]], None, reason)


def _list_parts(root: Element) -> dict[_Key, Element]:
    """Return the links and joints directly in an element whose names do not depend on values."""
    return {
        (child.tag, name): child
        for child in root.elements()
        if child.tag in (_LINK, _JOINT) and (name := child.attributes.get("name", "")) and "$" not in name
    }


def _find_added_parts(graphs: IncludeGraphs, macro: str) -> Iterator[tuple[_Key, str]]:
    """Yield the links and joints that the files with calls of a macro newly make, with the file."""
    old_outlines = dict(graphs.old.iterate_outlines())
    for path, outline in graphs.new.iterate_outlines():
        old = old_outlines.get(path)
        if old is None or not (_calls(old, macro) and _calls(outline, macro)):
            continue
        for key in _list_parts(outline.root).keys() - _list_parts(old.root).keys():
            yield key, path


def _calls(outline: Outline, macro: str) -> bool:
    return any(element.tag == f"xacro:{macro}" for element in outline.root.walk())
