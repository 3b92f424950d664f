"""Report the meshes of compared robots whose addresses are of another kind, although they name the same files."""

from __future__ import annotations

import re
from collections.abc import Iterator

from linkwright.diagnostics import counted, phrase
from linkwright.review.parts.part_pair import PartPair
from linkwright.xmltree import Element

_ADDRESS = re.compile(r"(?P<start>package://|\$\(find +)(?P<package>[\w.-]+)\)?/(?P<path>.*)")
_FIND = "$(find"
_PLAIN = ".urdf"


def compare_mesh_addresses(pair: PartPair) -> None:
    """Report the kinds of addresses that change, once for each pair of kinds, such as ``package:// -> $(find ...)``.

    RViz does not load a path without ``file://``, and a path is that of one computer. Plain URDF, addresses with
    ``file://`` and meshes that no compared robot shows have lines of their own.

    Args:
        pair: both versions of a file, to which the changes are added.
    """
    if pair.new_path.endswith(_PLAIN):
        return
    old_kinds: dict[str, set[str]] = {}
    for file, kind, _ in _find_meshes(pair.old.root):
        old_kinds.setdefault(file, set()).add(kind)
    groups: dict[tuple[str, str], list[Element]] = {}
    for file, kind, element in _find_meshes(pair.new.root):
        kinds = old_kinds.get(file, set())
        if len(kinds) == 1 and kind not in kinds and pair.is_expanded(element, is_old=False):
            groups.setdefault((next(iter(kinds)), kind), []).append(element)
    for (old, new), elements in groups.items():
        text = counted(
            "address of {count} mesh: {old} -> {new}", "addresses of {count} meshes: {old} -> {new}", len(elements),
            old=old, new=new,
        )  # fmt: skip
        is_path = new.startswith(_FIND)
        pair.add(phrase("{change}, without file://", change=text) if is_path else text, None, elements[0])


def _find_meshes(root: Element) -> Iterator[tuple[str, str, Element]]:
    """Yield the meshes that name a file of a package: the file, the kind of the address, and the element."""
    for element in root.walk():
        match = _ADDRESS.fullmatch(element.attributes.get("filename", "").strip()) if element.tag == "mesh" else None
        if match is not None:
            kind = f"{_FIND} ...)" if match["start"].startswith(_FIND) else match["start"]
            yield f"{match['package']}/{match['path']}", kind, element
