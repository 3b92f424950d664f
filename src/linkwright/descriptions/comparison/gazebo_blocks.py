"""Several ``<gazebo>`` elements for the same link, whose number and order have no meaning."""

from __future__ import annotations

from collections.abc import Sequence

from linkwright.xmltree import Element

GAZEBO = "gazebo"


def joined_block(blocks: Sequence[Element]) -> Element:
    """Return one element with the attributes and the children of several.

    It has the source position of the first one.
    """
    first, *others = blocks
    if not others:
        return first
    joined = Element(first.tag, dict(first.attributes), first.source, first.offset, first.origin)
    joined.children = [child for block in blocks for child in block.children]
    return joined
