"""XML launch files (``launch_xml``)."""

from __future__ import annotations

from typing import Any

from linkwright.launch.errors.locations import MarkupLocation, SourceLocation
from linkwright.launch.frontend.markup_entity import MarkupEntity
from linkwright.launch.frontend.parser import Parser as AnyParser
from linkwright.launch.frontend.parser import read_file
from linkwright.launch.model.markup.entity import Entity as AnyEntity
from linkwright.launch.model.markup.entity import LocatedText, is_list_of_entities
from linkwright.launch.model.markup.values import get_typed_value
from linkwright.xmltree import Element, parse
from linkwright.xmltree.positions import attribute_name_range, attribute_value_range

_SEPARATOR_SUFFIX = "-sep"


class Entity(MarkupEntity):
    """An element of an XML launch file.

    Args:
        xml_element: the element, of `linkwright.xmltree` or of ``xml.etree.ElementTree``.
        parent: the enclosing entity.
    """

    def __init__(self, xml_element: Any, *, parent: AnyEntity | None = None) -> None:
        self._element = xml_element if isinstance(xml_element, Element) else _from_etree(xml_element)
        super().__init__(self._element.tag, _locate_element(self._element), parent)

    @property
    def children(self) -> list[AnyEntity]:
        """The child elements.

        Reading this property marks all child elements as read.
        """
        self._read_names.update((element.tag, None) for element in self._element.elements())
        return [Entity(element, parent=self) for element in self._element.elements()]

    def assert_entity_completely_parsed(self) -> None:
        """Raise an error if some attributes or child elements have not been read.

        Raises:
            ValueError: LAUNCH116, an attribute or child element was not read.
        """
        tags = [element.tag for element in self._element.elements()]
        self._check_all_read(tags, "element", "Unexpected nested tag(s) found in")
        self._check_all_read(self._element.attributes, "attribute", "Unexpected attribute(s) found in")

    def get_attr(self, name: str, *, data_type: Any = str, optional: bool = False, can_be_str: bool = True) -> Any:
        """Return the value of an attribute, or the child elements with a given tag.

        The value is converted to the type. If there is an attribute ``NAME-sep``, the value is split at this separator
        into a list. See `linkwright.launch.model.markup.entity.Entity`.
        """
        self._read_names[name] = None
        attributes = self._element.attributes
        ros_error = f"Attribute '{name}' of type '{data_type}' not found in Entity '{self.type_name}'"
        if is_list_of_entities(data_type):
            children = [Entity(element, parent=self) for element in self._element.elements(name)]
            if not children and not optional:
                self._fail_missing(name, {element.tag for element in self._element.elements()}, ros_error)
            return children or None
        if name not in attributes:
            if optional:
                return None
            self._fail_missing(name, attributes, ros_error)
        value: Any = LocatedText(attributes[name], _locate_attribute(self._element, name))
        if name + _SEPARATOR_SUFFIX in attributes:
            self._read_names[name + _SEPARATOR_SUFFIX] = None
            value = [
                LocatedText(item, value.source_location) for item in value.split(attributes[name + _SEPARATOR_SUFFIX])
            ]
        try:
            return get_typed_value(value, data_type, can_be_str=can_be_str)
        except (TypeError, ValueError):
            ros_error = (
                f"Attribute '{name}' of Entity '{self.type_name}' expected to be of type '{data_type}'."
                f"'{value}' can not be converted to one of those types"
            )
            self._fail_wrong_type(name, str(value), data_type, ros_error)

    def _locate_part(self, name: str) -> SourceLocation | None:
        element, source = self._element, self._element.source
        if name not in element.attributes:
            child = element.first(name)
            return self.source_location if child is None else _locate_element(child)
        if source is None:
            return None
        if name in self._read_names:
            return _locate_attribute(element, name)
        name_range = attribute_name_range(source.text, element.offset, name)
        return MarkupLocation(source, *name_range) if name_range else self.source_location


class Parser(AnyParser):
    """A parser that reads XML launch files."""

    @classmethod
    def load(cls, file: Any) -> tuple[AnyEntity, AnyParser]:
        """Return the root entity of a path or open file, and a parser for it.

        Raises:
            LinkwrightError: the file is not valid XML.
        """
        name, text = read_file(file)
        return Entity(parse(text, name).root), cls()

    @classmethod
    def get_file_extensions(cls) -> set[str]:
        """Return the file name extensions of XML launch files, without the leading dot."""
        return {"launch.xml"}


def _locate_element(element: Element) -> SourceLocation | None:
    if element.source is None:
        return None
    return MarkupLocation(element.source, element.offset, element.offset + 1 + len(element.tag))


def _locate_attribute(element: Element, name: str) -> SourceLocation | None:
    if element.source is None:
        return None
    value_range = attribute_value_range(element.source.text, element.offset, name)
    return MarkupLocation(element.source, *value_range) if value_range else _locate_element(element)


def _from_etree(element: Any) -> Element:
    converted_element = Element(element.tag, dict(element.attrib))
    converted_element.children.extend(_from_etree(child) for child in element if isinstance(child.tag, str))
    return converted_element
