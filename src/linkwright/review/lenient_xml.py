"""Read XML files as TinyXML2 does, which accepts more than XML allows."""

from __future__ import annotations

from pathlib import Path

from linkwright.diagnostics import LinkwrightError
from linkwright.sdf.text import parse_as_gazebo
from linkwright.xacro.cache import read_document
from linkwright.xmltree import Element
from linkwright.xmltree.reader import read_bytes


def read_lenient_root(file: Path) -> Element:
    """Return the root element of a file.

    Comments and blanks may precede the XML declaration.

    Raises:
        LinkwrightError: TinyXML2 cannot read the file either (XML###).
    """
    try:
        return read_document(str(file)).root
    except LinkwrightError:
        return parse_as_gazebo(read_bytes(str(file)), str(file))[0].root
