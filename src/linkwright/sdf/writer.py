"""Writing worlds and models as SDF, so that reading them back gives equal ones."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from linkwright.schema import ElementRule, write_element
from linkwright.sdf.models import Model
from linkwright.sdf.reader import OPEN, WITHOUT_EFFECT
from linkwright.sdf.worlds import SDF, Sdf, World
from linkwright.xmltree import Document, Element, write
from linkwright.xmltree.writer import tidied

VERSION = "1.11"
"""The version of what is written: gz Harmonic, which comes with Jazzy, reads no newer one."""
_PREFIX = "http://gazebosim.org/schema"
"""The namespace of prefixes that a file uses without declaring them, which Gazebo's readers allow."""


def save(thing: Sdf | World | Model) -> str:
    """Worlds and models as SDF text; defaults are left out, numbers are as short as they can be without loss.

    The elements inside plugins, and words of SDF without effect here (``<gui>``), are written as they were read.

    Args:
        thing: a world, a model or a whole file; without includes that are resolved.
    """
    if isinstance(thing, World):
        thing = Sdf(VERSION, worlds=(thing,))
    elif isinstance(thing, Model):
        thing = Sdf(VERSION, models=(thing,))
    root = write_element(SDF, replace(thing, version=VERSION), _complete)
    declared = {} if thing.element is None else thing.element.attributes
    root.attributes |= {name: value for name, value in declared.items() if name.startswith("xmlns")}
    for prefix in sorted(_prefixes(root)):
        root.attributes.setdefault(f"xmlns:{prefix}", _PREFIX)
    return write(Document(root))


def _complete(element: Element, rule: ElementRule, instance: Any) -> None:
    """Add the parts that no rule of the tables covers."""
    read: Element | None = getattr(instance, "element", None)
    if read is None:
        return
    if rule.tag in OPEN:
        whole = tidied(read)
        element.attributes = whole.attributes | element.attributes
        element.children = whole.children
        return
    unread = WITHOUT_EFFECT.get(rule.tag, ())
    element.children += (
        tidied(each)
        for each in read.elements()
        if each.tag not in rule.child_rules and (each.tag in unread or ":" in each.tag)
    )


def _prefixes(root: Element) -> Iterator[str]:
    for element in root.walk():
        for name in (element.tag, *element.attributes):
            prefix, colon, _ = name.partition(":")
            if colon and prefix not in ("xmlns", "xml"):
                yield prefix
