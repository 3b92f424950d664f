"""Writes worlds and models as SDF that gives equal worlds and models when it is read."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

from linkwright import xmltree
from linkwright.schema import ElementRule, write_element
from linkwright.sdf.models import MODEL, Model
from linkwright.sdf.reader import OPEN, WITHOUT_EFFECT
from linkwright.sdf.worlds import SDF, Sdf, World
from linkwright.xmltree import Document, Element, write
from linkwright.xmltree.writer import strip_mixed_text

VERSION = "1.11"
"""The SDF version of the output: gz Harmonic, which Jazzy ships, reads no newer one."""
_PREFIX = "http://gazebosim.org/schema"
"""The namespace of prefixes that a file uses without declaring them, which Gazebo's readers allow."""
_GAP = "\x01"
"""The name of the placeholder of previously written models: XML has no such character."""


@dataclass(frozen=True, slots=True)
class WrittenModel:
    """The text of a model that is part of a world.

    Attributes:
        text: the text of the model's element.
        prefixes: the XML prefixes of names in the text.
    """

    text: str
    prefixes: frozenset[str]


def save_model_of_world(model: Model) -> WrittenModel:
    """Return the text of a model for `save_world`; the model must not have resolved includes."""
    element = write_element(MODEL, model, _complete)
    return WrittenModel(xmltree.write_element(element, depth=2), frozenset(_prefixes(element)))


def save_world(world: World, models: Sequence[WrittenModel]) -> str:
    """Return the SDF text of a world, using models that are already written.

    The text is the text that `save` returns. A caller that writes a world after each of many changes only has to write
    the changed models again.

    Args:
        world: the world without its models.
        models: the written models.
    """
    if not models:
        return save(world)
    root = _element(Sdf(VERSION, worlds=(replace(world, models=(Model(_GAP),)),)))
    _declare(root, {prefix for model in models for prefix in model.prefixes})
    before, _, after = write(Document(root)).partition(xmltree.write_element(Element("model", {"name": _GAP}), depth=2))
    return "".join((before, *(model.text for model in models), after))


def save(document: Sdf | World | Model) -> str:
    """Return worlds and models as SDF text.

    Defaults are left out, and numbers are as short as possible without loss. The elements inside plugins, and SDF
    elements without effect here (``<gui>``), are written as they were read.

    Args:
        document: a world, a model or a whole file, without resolved includes.
    """
    if isinstance(document, World):
        document = Sdf(VERSION, worlds=(document,))
    elif isinstance(document, Model):
        document = Sdf(VERSION, models=(document,))
    root = _element(document)
    _declare(root)
    return write(Document(root))


def _element(sdf: Sdf) -> Element:
    """Return the element of a whole file, with the XML namespaces that the file declared when read."""
    root = write_element(SDF, replace(sdf, version=VERSION), _complete)
    declared = {} if sdf.element is None else sdf.element.attributes
    root.attributes |= {name: value for name, value in declared.items() if name.startswith("xmlns")}
    return root


def _declare(root: Element, more: Iterable[str] = ()) -> None:
    """Declare the XML prefixes that an element uses, and those in `more`."""
    for prefix in sorted({*_prefixes(root), *more}):
        root.attributes.setdefault(f"xmlns:{prefix}", _PREFIX)


def _complete(element: Element, rule: ElementRule, instance: Any) -> None:
    """Add the content of the original element that the rules of the tables do not cover."""
    read: Element | None = getattr(instance, "element", None)
    if read is None:
        return
    if rule.tag in OPEN:
        whole = strip_mixed_text(read)
        element.attributes = whole.attributes | element.attributes
        element.children = whole.children
        return
    unread = WITHOUT_EFFECT.get(rule.tag, ())
    element.children += (
        strip_mixed_text(element)
        for element in read.elements()
        if element.tag not in rule.child_rules and (element.tag in unread or ":" in element.tag)
    )


def _prefixes(root: Element) -> Iterator[str]:
    for element in root.walk():
        for name in (element.tag, *element.attributes):
            prefix, colon, _ = name.partition(":")
            if colon and prefix not in ("xmlns", "xml"):
                yield prefix
