"""Write worlds and models as SDF.

Reading the output gives equal worlds and models.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

from linkwright import xmltree
from linkwright.schema import ElementRule, write_element
from linkwright.sdf.models import MODEL, Model
from linkwright.sdf.reader import OPEN_TAGS, TAGS_WITHOUT_EFFECT
from linkwright.sdf.worlds import SDF, Sdf, World
from linkwright.xmltree import Document, Element, write
from linkwright.xmltree.writer import strip_mixed_text

WRITTEN_VERSION = "1.11"
"""The SDF version of the output, which is the newest that gz Harmonic, and so ROS Jazzy, can read."""
_DEFAULT_NAMESPACE = "http://gazebosim.org/schema"
"""The namespace for prefixes that a file uses but does not declare. Gazebo accepts such files."""
_PLACEHOLDER_NAME = "\x01"
"""The name of a placeholder model, which the written models replace. XML does not allow this character."""


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
    """Return the text of a model for `save_world`.

    The includes of the model must not be resolved.
    """
    element = write_element(MODEL, model, _restore_ignored_content)
    return WrittenModel(xmltree.write_element(element, depth=2), frozenset(_iterate_prefixes(element)))


def save_world(world: World, models: Sequence[WrittenModel]) -> str:
    """Return the SDF text of a world, from models that are already written.

    The result is the same as from `save`. A caller that writes a world after each of many changes only has to write the
    changed models again.

    Args:
        world: the world without its models.
        models: the text of each model, in order.
    """
    if not models:
        return save(world)
    root = _make_root(Sdf(WRITTEN_VERSION, worlds=(replace(world, models=(Model(_PLACEHOLDER_NAME),)),)))
    _declare_prefixes(root, {prefix for model in models for prefix in model.prefixes})
    text_before, _, text_after = write(Document(root)).partition(
        xmltree.write_element(Element("model", {"name": _PLACEHOLDER_NAME}), depth=2)
    )
    return "".join((text_before, *(model.text for model in models), text_after))


def save(document: Sdf | World | Model) -> str:
    """Return worlds and models as SDF text.

    Defaults are left out, and numbers are as short as possible without loss. The content of plugins, and elements that
    Linkwright ignores, such as ``<gui>``, are written as they were read.

    Args:
        document: a world, a model or the content of a file; its includes must not be resolved.
    """
    if isinstance(document, World):
        document = Sdf(WRITTEN_VERSION, worlds=(document,))
    elif isinstance(document, Model):
        document = Sdf(WRITTEN_VERSION, models=(document,))
    root = _make_root(document)
    _declare_prefixes(root)
    return write(Document(root))


def _make_root(sdf: Sdf) -> Element:
    """Return the root element of a file, with the namespaces that the original declares."""
    root = write_element(SDF, replace(sdf, version=WRITTEN_VERSION), _restore_ignored_content)
    source_attributes = {} if sdf.element is None else sdf.element.attributes
    root.attributes |= {name: value for name, value in source_attributes.items() if name.startswith("xmlns")}
    return root


def _declare_prefixes(root: Element, extra_prefixes: Iterable[str] = ()) -> None:
    """Declare the XML prefixes in `extra_prefixes` and in `root` and its descendants."""
    for prefix in sorted({*_iterate_prefixes(root), *extra_prefixes}):
        root.attributes.setdefault(f"xmlns:{prefix}", _DEFAULT_NAMESPACE)


def _restore_ignored_content(element: Element, rule: ElementRule, instance: Any) -> None:
    """Add the content of the original element that has no rule but must be kept."""
    source_element: Element | None = getattr(instance, "element", None)
    if source_element is None:
        return
    if rule.tag in OPEN_TAGS:
        stripped = strip_mixed_text(source_element)
        element.attributes = stripped.attributes | element.attributes
        element.children = stripped.children
        return
    ignored_tags = TAGS_WITHOUT_EFFECT.get(rule.tag, ())
    element.children += (
        strip_mixed_text(element)
        for element in source_element.elements()
        if element.tag not in rule.child_rules and (element.tag in ignored_tags or ":" in element.tag)
    )


def _iterate_prefixes(root: Element) -> Iterator[str]:
    for element in root.walk():
        for name in (element.tag, *element.attributes):
            prefix, colon, _ = name.partition(":")
            if colon and prefix not in ("xmlns", "xml"):
                yield prefix
