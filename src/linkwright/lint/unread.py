"""Elements and attributes that no URDF reader uses, and the names probably intended."""

from __future__ import annotations

from linkwright.diagnostics import Span, words_of
from linkwright.diagnostics.misspellings import misspelling_of
from linkwright.lint.extension_names import CHILDREN
from linkwright.lint.structure import EXTENSIONS, Place
from linkwright.lint.subject import Subject
from linkwright.schema import ElementRule
from linkwright.urdf import schema
from linkwright.xmltree import Element

INNER_EXTENSIONS = frozenset({"contact", "sensor", "verbose", "self_collision_checking", "plugin", "gazebo"})
"""Elements of other tools inside of links and joints."""
_KINDS = frozenset({"type"})
"""Attributes of URDF that other tools give to more elements, such as Franka's ``<dynamics>``."""

_OTHER_ELEMENTS = {
    "pose": "origin",
    "transform": "origin",
    "inertia_tensor": "inertia",
    "limits": "limit",
    "safety": "safety_controller",
    "colour": "color",
    "shape": "geometry",
    "collider": "collision",
}
_OTHER_ATTRIBUTES = {
    "min": "lower",
    "max": "upper",
    "max_velocity": "velocity",
    "max_effort": "effort",
    "pos": "xyz",
    "position": "xyz",
    "euler": "rpy",
    "orientation": "rpy",
    "file": "filename",
    "uri": "filename",
    "url": "filename",
    "ratio": "multiplier",
    "gain": "multiplier",
    "rgb": "rgba",
    "dampening": "damping",
    "ypr": "rpy",
}


def _parents_by_tag() -> dict[str, tuple[str, ...]]:
    """Return the elements that may contain each element, by tag."""
    homes: dict[str, dict[str, None]] = {}
    waiting: list[ElementRule] = [schema.ROBOT]
    while waiting:
        rule = waiting.pop()
        for child in rule.children:
            homes.setdefault(child.tag, {})[rule.tag] = None
            waiting.append(child)
    return {tag: tuple(sorted(found)) for tag, found in homes.items()}


HOMES = _parents_by_tag()


def _attributes() -> frozenset[str]:
    """Return the names of all attributes of URDF elements."""
    found: set[str] = set()
    waiting: list[ElementRule] = [schema.ROBOT]
    while waiting:
        rule = waiting.pop()
        found.update(attribute.name for attribute in rule.attributes)
        waiting.extend(rule.children)
    return frozenset(found)


_WORDS_FOR_MASS = frozenset({"weight", "density"})
_OF_OTHER_FORMATS = frozenset(tag for tags in CHILDREN.values() for tag in tags)
_EXPECTED_ELEMENTS = frozenset({*HOMES, *_OTHER_ELEMENTS, *_OF_OTHER_FORMATS, *_WORDS_FOR_MASS})
_EXPECTED_ATTRIBUTES = (
    frozenset({*_attributes(), *HOMES, *_OTHER_ELEMENTS, *_OTHER_ATTRIBUTES, *_WORDS_FOR_MASS}) - _KINDS
)


def is_expected_element(tag: str) -> bool:
    """Return whether authors expect an element to have an effect, because its name is known.

    Known names are those of URDF and of related formats. Any other name is a private extension, such as one that a
    vendor's software reads.
    """
    return tag in _EXPECTED_ELEMENTS or not HOMES.keys().isdisjoint(words_of(tag))


def is_expected_attribute(name: str) -> bool:
    """Return whether authors expect an attribute to have an effect, because its name is known."""
    return name.casefold() in _EXPECTED_ATTRIBUTES


def hints_of_reader(subject: Subject) -> dict[Span | None, str]:
    """Return the hints of the URDF reader's diagnostics, by location.

    A diagnostic without a hint has an empty text.
    """
    return {found.span: found.hint or "" for found in subject.reading.diagnostics}


def intended_element(rule: ElementRule, child: Element) -> str | None:
    """Return the allowed element that was probably intended by an unknown one, or None."""
    if child.tag in HOMES:
        return None
    known = [child.tag for child in rule.children]
    other = _OTHER_ELEMENTS.get(child.tag.casefold())
    if other in known:
        return other
    if rule is schema.ROBOT:
        known = [*known, *EXTENSIONS]
    return misspelling_of(child.tag, known)


def is_misspelt(name: str, meant: str) -> bool:
    """Return whether a name is a misspelling of another, and not its equivalent in another format."""
    return misspelling_of(name, [meant]) is not None


def intended_attribute(place: Place, attribute: str) -> str | None:
    """Return the absent attribute that was probably intended by an unknown one, or None."""
    known = [rule.name for rule in place.rule.attributes if rule.name not in place.element.attributes]
    other = _OTHER_ATTRIBUTES.get(attribute.casefold())
    if other in known:
        return other
    return misspelling_of(attribute, known)


def location_phrase(place: Place) -> str:
    """Return the text by which a message names an element as the location of another element."""
    return "<robot>" if place.rule is schema.ROBOT else str(place)


def attribute_name_span(element: Element, attribute: str) -> Span | None:
    """Return the location of an attribute's name in the source, or None if it is not found."""
    from linkwright.xmltree.positions import attribute_name_range

    source = element.source
    if source is None:
        return None
    found = attribute_name_range(source.text, element.offset, attribute)
    return source.span(*found) if found else element.span()
