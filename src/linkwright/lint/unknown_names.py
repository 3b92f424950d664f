"""Elements and attributes that no URDF reader uses, and the names probably intended."""

from __future__ import annotations

from linkwright.diagnostics import Span, words_of
from linkwright.diagnostics.misspellings import find_misspelled
from linkwright.lint.extension_names import CHILD_TAGS
from linkwright.lint.structure import EXTENSIONS, SchemaElement
from linkwright.lint.subject import Subject
from linkwright.schema import ElementRule
from linkwright.urdf import schema
from linkwright.xmltree import Element

INNER_EXTENSIONS = frozenset({"contact", "sensor", "verbose", "self_collision_checking", "plugin", "gazebo"})
"""Elements of other tools inside of links and joints."""
_SHARED_ATTRIBUTES = frozenset({"type"})
"""URDF attributes that other tools also give to other elements, such as Franka's ``<dynamics>``."""

_OTHER_ELEMENTS = {
    "pose": "origin",
    "transform": "origin",
    "inertia_tensor": "inertia",
    "limits": "limit",
    "safety": "safety_controller",
    "color": "color",
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


def _index_parents() -> dict[str, tuple[str, ...]]:
    """Return the elements that may contain each element, by tag."""
    parents: dict[str, dict[str, None]] = {}
    pending: list[ElementRule] = [schema.ROBOT]
    while pending:
        rule = pending.pop()
        for child in rule.children:
            parents.setdefault(child.tag, {})[rule.tag] = None
            pending.append(child)
    return {tag: tuple(sorted(parent_tags)) for tag, parent_tags in parents.items()}


PARENT_TAGS = _index_parents()


def _list_attributes() -> frozenset[str]:
    """Return the names of all attributes of URDF elements."""
    names: set[str] = set()
    pending: list[ElementRule] = [schema.ROBOT]
    while pending:
        rule = pending.pop()
        names.update(attribute.name for attribute in rule.attributes)
        pending.extend(rule.children)
    return frozenset(names)


_MASS_NAMES = frozenset({"weight", "density"})
_EXTENSION_ELEMENTS = frozenset(tag for tags in CHILD_TAGS.values() for tag in tags)
_EXPECTED_ELEMENTS = frozenset({*PARENT_TAGS, *_OTHER_ELEMENTS, *_EXTENSION_ELEMENTS, *_MASS_NAMES})
_EXPECTED_ATTRIBUTES = (
    frozenset({*_list_attributes(), *PARENT_TAGS, *_OTHER_ELEMENTS, *_OTHER_ATTRIBUTES, *_MASS_NAMES})
    - _SHARED_ATTRIBUTES
)


def is_expected_element(tag: str) -> bool:
    """Return whether the author of an element expects an effect, because its name is known.

    Known names occur in URDF or in a related format, or contain the name of a URDF element as a word. Any other name
    is a private extension, such as one that a vendor's software reads.
    """
    return tag in _EXPECTED_ELEMENTS or not PARENT_TAGS.keys().isdisjoint(words_of(tag))


def is_expected_attribute(name: str) -> bool:
    """Return whether authors expect an attribute to have an effect, because its name is known."""
    return name.casefold() in _EXPECTED_ATTRIBUTES


def find_reader_hints(subject: Subject) -> dict[Span | None, str]:
    """Return the hints of the URDF reader's diagnostics, by location.

    A diagnostic without a hint has an empty string.
    """
    return {diagnostic.span: diagnostic.hint or "" for diagnostic in subject.reading.diagnostics}


def find_intended_element(rule: ElementRule, child: Element) -> str | None:
    """Return the allowed element that an unknown element probably misspells, or None."""
    if child.tag in PARENT_TAGS:
        return None
    allowed_tags = [child.tag for child in rule.children]
    equivalent = _OTHER_ELEMENTS.get(child.tag.casefold())
    if equivalent in allowed_tags:
        return equivalent
    if rule is schema.ROBOT:
        allowed_tags = [*allowed_tags, *EXTENSIONS]
    return find_misspelled(child.tag, allowed_tags)


def is_misspelled(name: str, intended: str) -> bool:
    """Return whether a name is a misspelling of another.

    The equivalent in another format is not a misspelling.
    """
    return find_misspelled(name, [intended]) is not None


def find_intended_attribute(schema_element: SchemaElement, attribute: str) -> str | None:
    """Return the absent attribute that an unknown attribute probably misspells, or None."""
    absent_attributes = [
        rule.name for rule in schema_element.rule.attributes if rule.name not in schema_element.element.attributes
    ]
    equivalent = _OTHER_ATTRIBUTES.get(attribute.casefold())
    if equivalent in absent_attributes:
        return equivalent
    return find_misspelled(attribute, absent_attributes)


def describe_location(schema_element: SchemaElement) -> str:
    """Return the name of an element for messages, as the location of another element."""
    return "<robot>" if schema_element.rule is schema.ROBOT else str(schema_element)


def attribute_name_span(element: Element, attribute: str) -> Span | None:
    """Return the location of an attribute's name, or None if the element has no source.

    If the source does not contain the attribute, the location of the element is returned.
    """
    from linkwright.xmltree.positions import attribute_name_range

    source = element.source
    if source is None:
        return None
    name_range = attribute_name_range(source.text, element.offset, attribute)
    return source.span(*name_range) if name_range else element.span()
