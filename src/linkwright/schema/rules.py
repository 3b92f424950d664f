"""Rules that describe the elements and attributes of a language as data."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from linkwright.loading.lean_dataclasses import dataclass, field
from linkwright.loading.lean_typing import Any

Version = tuple[int, int]
"""Major and minor version of a language."""


@dataclass(frozen=True, slots=True, eq=False)
class ValueType:
    """The type of a value in a file.

    Attributes:
        name: the name in messages and documentation, such as ``3 numbers``.
        read: the function that parses a text, and raises `ValueError` for an invalid text.
        write: the function that formats a value, and returns None for a value that is not written.
    """

    name: str
    read: Callable[[str], Any] = str
    write: Callable[[Any], str | None] = str


@dataclass(frozen=True, slots=True, eq=False)
class AttributeRule:
    """The rule of an attribute, or of the text inside an element.

    Attributes:
        name: the name as written in the file.
        type: the type of the value.
        meaning: one phrase for hints, hover texts and documentation.
        unit: the SI unit, or an empty string.
        required: whether the element cannot be read without the attribute.
        default: the value of an absent attribute, as text, or None if there is none.
        since: the version that added the attribute; in files of older versions it is ignored.
        until: the version that made a required attribute optional, or None.
        later_default: a version, and the default from this version on.
        usually_written: whether the attribute is usually written although it is not required.
        field: the field of the object that stores the value; by default, the field with the attribute's name.
        get: the function that returns the value to write from the object, if this is not simply the field.
    """

    name: str
    type: ValueType
    meaning: str
    unit: str = ""
    required: bool = False
    default: str | None = None
    since: Version = (1, 0)
    until: Version | None = None
    later_default: tuple[Version, Any] | None = None
    usually_written: bool = False
    field: str = ""
    get: Callable[[Any], Any] | None = None

    @property
    def target(self) -> str:
        """The name of the object's field that stores the attribute's value."""
        return self.field or self.name

    def value_in(self, instance: Any) -> Any:
        """Return the attribute's value from an object."""
        return getattr(instance, self.target) if self.get is None else self.get(instance)

    def is_required(self, version: Version) -> bool:
        """Return whether files of a version must contain the attribute."""
        return self.required and (self.until is None or version < self.until)

    def absent_value(self, version: Version) -> Any:
        """Return the parsed default in a version of the language, or None if there is none."""
        if self.later_default is not None and version >= self.later_default[0]:
            return self.later_default[1]
        return None if self.default is None else self.type.read(self.default)


@dataclass(frozen=True, slots=True, eq=False)
class ElementRule:
    """The rule of an element in its parent: attributes, children, and the object for it.

    Attributes:
        tag: the element's name.
        meaning: one phrase for hover texts and documentation.
        attribute_rules: the rules of the attributes, by name.
        child_rules: the rules of the children, by tag, including the element's own tag if it is recursive.
        attributes: the rules of the attributes, in the order of the documentation.
        children: the rules of the children that are read, in the order in which they are written.
        required: whether the parent element cannot be read without this element.
        is_repeated: whether all elements with the tag are read; otherwise, only the first element is read.
        since: the version that added the element.
        text: the rule of the text inside, for an element whose value is its text.
        choice: whether the first child selects one of several kinds, so that its object is the object of this element.
        make: the function that creates the object from keyword arguments: the fields of attributes and children. The
            object must not be false. None if the values are fields of the parent's object, as for
            ``<mass value="1"/>``.
        passes_element: whether `make` receives the element as the argument ``element``.
        field: the field of the parent's object; by default, the field with the name of the tag.
        get: the function that returns the value to write from the parent's object, if this is not simply the field.
        default: the default of an absent element: an object, or the tuple of values for the fields of the parent's
            object.
        is_owner: whether messages about the contents of the element name this element, as for the color of a material.
        keeps_element: whether an element with unreadable parts still results in an object, with defaults for these
            parts. An unreadable part that may occur many times is `UNREADABLE`.
        is_recursive: whether the element may contain elements of its own kind.
        check: the function that checks a value, given its element, its owner and the report. It returns the value to
            use instead, or `UNREADABLE`.
    """

    tag: str
    meaning: str
    attribute_rules: Mapping[str, AttributeRule] = field(init=False, repr=False)
    child_rules: Mapping[str, ElementRule] = field(init=False, repr=False)
    attributes: tuple[AttributeRule, ...] = ()
    children: tuple[ElementRule, ...] = ()
    required: bool = False
    is_repeated: bool = False
    since: Version = (1, 0)
    text: AttributeRule | None = None
    choice: bool = False
    make: Callable[..., Any] | None = None
    passes_element: bool = False
    field: str = ""
    get: Callable[[Any], Any] | None = None
    default: Any = None
    is_owner: bool = False
    keeps_element: bool = False
    is_recursive: bool = False
    check: Callable[..., Any] | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "attribute_rules", {rule.name: rule for rule in self.attributes})
        own_rule = {self.tag: self} if self.is_recursive else {}
        object.__setattr__(self, "child_rules", {rule.tag: rule for rule in self.children} | own_rule)

    @property
    def target(self) -> str:
        """The name of the parent's field that stores the element's object."""
        return self.field or self.tag

    @property
    def is_inline(self) -> bool:
        """Whether the element's values are fields of the parent's object."""
        return self.make is None and not self.choice

    @property
    def is_value(self) -> bool:
        """Whether the element's only value is its text, as for ``<mass>2.5</mass>`` of SDF."""
        return self.text is not None and not (self.attributes or self.children)

    def value_in(self, instance: Any) -> Any:
        """Return the object or objects of this element from the parent's object."""
        return getattr(instance, self.target) if self.get is None else self.get(instance)

    @property
    def values(self) -> tuple[AttributeRule, ...]:
        """The rules of the element's own values: its attributes, and the text inside."""
        return self.attributes if self.text is None else (*self.attributes, self.text)
