"""The elements of a description that the URDF schema defines, and the other elements."""

from __future__ import annotations

from functools import cached_property

from linkwright.diagnostics import phrase, term
from linkwright.loading.lean_dataclasses import NamedTuple
from linkwright.schema import ElementRule
from linkwright.urdf import schema
from linkwright.xmltree import Element

EXTENSIONS = frozenset({"gazebo", "transmission", "ros2_control", "sensor", "mujoco", "simulation", "plugin"})
"""Elements of other tools directly in ``<robot>``."""


class SchemaElement(NamedTuple):
    """An element that URDF defines, with its schema rule.

    Attributes:
        element: the element in the document.
        rule: the schema rule: the attributes and children that the element may have.
        parent: the enclosing element, or None for ``<robot>``.
        owner: the link, joint or material that contains the element or is the element, or None for ``<robot>``.
    """

    element: Element
    rule: ElementRule
    parent: Element | None
    owner: Element | None

    @property
    def owner_suffix(self) -> str:
        """The text that follows an element's tag in a message, such as `` of joint 'elbow'``."""
        return "" if self.owner is None or self.owner is self.element else f" of {_describe_owner(self.owner)}"

    def __str__(self) -> str:
        """Return the name of the element for messages, such as ``<limit> of joint 'elbow'``."""
        return _describe_owner(self.element) if self.owner is self.element else f"<{self.rule.tag}>{self.owner_suffix}"


class Structure:
    """The known and unknown elements of a description.

    Each list is computed on first use.

    Args:
        root: the root element.
    """

    def __init__(self, root: Element) -> None:
        self._root = root

    @cached_property
    def schema_elements(self) -> list[SchemaElement]:
        """The elements that URDF defines, in document order.

        The list is empty if the root is not a ``<robot>``.
        """
        return self._classified_elements[0]

    @cached_property
    def unknown_elements(self) -> list[tuple[SchemaElement, Element]]:
        """The elements that URDF does not define in their parents, except elements of other tools.

        Elements of other namespaces are also left out.
        """
        return [
            (schema_element, child)
            for schema_element, child in self._classified_elements[1]
            if not _is_expected(schema_element, child)
        ]

    @cached_property
    def unknown_attributes(self) -> list[tuple[SchemaElement, str]]:
        """The attributes that URDF does not define for their elements.

        Attributes of other namespaces are left out.
        """
        return [
            (schema_element, name)
            for schema_element in self.schema_elements
            for name in schema_element.element.attributes
            if name not in schema_element.rule.attribute_rules and ":" not in name and name != "xmlns"
        ]

    @cached_property
    def _classified_elements(self) -> tuple[list[SchemaElement], list[tuple[SchemaElement, Element]]]:
        """The elements that URDF defines, and the unknown elements in them, both in document order."""
        known_elements: list[SchemaElement] = []
        unknown_elements: list[tuple[SchemaElement, Element]] = []
        pending = [SchemaElement(self._root, schema.ROBOT, None, None)] if self._root.tag == schema.ROBOT.tag else []
        while pending:
            schema_element = pending.pop()
            known_elements.append(schema_element)
            element, rules, _, owner = schema_element
            children = []
            for child in element.elements():
                rule = rules.child_rules.get(child.tag)
                if rule is None:
                    unknown_elements.append((schema_element, child))
                else:
                    children.append(SchemaElement(child, rule, element, owner or child))
            pending.extend(reversed(children))
        return known_elements, unknown_elements


def _is_expected(schema_element: SchemaElement, child: Element) -> bool:
    if ":" in child.tag or (schema_element.rule is schema.ROBOT and child.tag in EXTENSIONS):
        return True
    # The reader reports an unknown shape.
    return schema_element.rule is schema.GEOMETRY and child is next(schema_element.element.elements(), None)


def _describe_owner(element: Element) -> str:
    """Return a link, joint or material as named in messages, such as ``joint 'elbow'``."""
    name = element.attributes.get("name")
    return (
        phrase("a {tag} without a name", tag=term(element.tag))
        if name is None
        else phrase("{tag} '{name}'", tag=term(element.tag), name=name)
    )
