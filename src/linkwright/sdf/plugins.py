"""``<plugin>``: a library of the simulator, with parameters of any form."""

from __future__ import annotations

from dataclasses import dataclass, field

from linkwright.schema import AttributeRule, ElementRule
from linkwright.sdf.values import TEXT
from linkwright.xmltree import Element


@dataclass(frozen=True, slots=True)
class Plugin:
    """A plugin: the file of the library, its name (in gz-sim that of the class), the element with the parameters."""

    filename: str
    name: str = ""
    element: Element | None = field(default=None, compare=False, repr=False)


PLUGIN = ElementRule(
    "plugin",
    "code that the simulator is to run",
    (
        AttributeRule("filename", TEXT, "the library, with or without lib and .so", required=True, default=""),
        AttributeRule("name", TEXT, "its name; in gz-sim the class", default=""),
    ),
    many=True,
    make=Plugin,
    keeps=True,
    located=True,
    field="plugins",
)
