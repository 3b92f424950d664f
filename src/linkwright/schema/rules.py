"""The elements and attributes of a language as data."""

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
        name: the name in messages and documentation: ``3 numbers``.
        read: parses a text; raises `ValueError` if the text is not a valid value.
        write: formats a value; returns None for a value without a text.
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
        required: whether the element cannot be read without it.
        default: the value of an absent attribute, as text; None if there is none.
        since: the version that added it; files of older versions ignore it.
        until: the version that made a required attribute optional, or None.
        later_default: a version, and the default from that version on.
        usual: whether it is usually written although it is not required.
        field: the object's field for the value; the attribute's name by default.
        get: returns the value to write from the object, if that is not simply the field.
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
    usual: bool = False
    field: str = ""
    get: Callable[[Any], Any] | None = None

    @property
    def target(self) -> str:
        """The name of the object's field for the attribute's value."""
        return self.field or self.name

    def value_in(self, instance: Any) -> Any:
        """Return the attribute's value in an object."""
        return getattr(instance, self.target) if self.get is None else self.get(instance)

    def is_required(self, version: Version) -> bool:
        """Return whether files of this version must contain the attribute."""
        return self.required and (self.until is None or version < self.until)

    def absent_value(self, version: Version) -> Any:
        """Return the default in this version of the language; None if there is none."""
        if self.later_default is not None and version >= self.later_default[0]:
            return self.later_default[1]
        return None if self.default is None else self.type.read(self.default)


@dataclass(frozen=True, slots=True, eq=False)
class ElementRule:
    """The rule of an element in its place: its attributes, its children, and the object that it is read into.

    Attributes:
        tag: the element's name.
        meaning: one phrase for hover texts and documentation.
        attribute_rules: the rules of its attributes by name.
        child_rules: the rules of its children by tag, including its own tag if it nests.
        attributes: the rules of its attributes, in the order of the documentation.
        children: the rules of the children that are read, in the order in which they are written.
        required: whether the parent element cannot be read without it.
        many: whether all elements with the tag are read; otherwise only the first is.
        since: the version that added it.
        text: the rule of the text inside, for an element whose value is its text.
        choice: whether the first child selects one of several kinds, and its object is this element's object.
        make: creates the object, which must not be false, from keyword arguments: the fields of attributes and
            children; None if they are fields of the parent's object, as for ``<mass value="1"/>``.
        located: whether `make` takes the element, as ``element``.
        field: the field of the parent's object; the tag's name by default.
        get: returns the value to write from the parent's object, if that is not simply its field.
        default: the default of an absent element: an object, or the tuple of values for the fields of the parent's
            object.
        owns: whether messages describe places inside the element by this element, such as a colour by its material.
        keeps: whether an element with unreadable parts still results in an object, with defaults for these parts; an
            unreadable part that may occur many times is `UNREADABLE`.
        nests: whether it may contain elements of its own kind.
        check: checks a value, with its element, its owner and the report; returns the value to use instead, or
            `UNREADABLE`.
    """

    tag: str
    meaning: str
    attribute_rules: Mapping[str, AttributeRule] = field(init=False, repr=False)
    child_rules: Mapping[str, ElementRule] = field(init=False, repr=False)
    attributes: tuple[AttributeRule, ...] = ()
    children: tuple[ElementRule, ...] = ()
    required: bool = False
    many: bool = False
    since: Version = (1, 0)
    text: AttributeRule | None = None
    choice: bool = False
    make: Callable[..., Any] | None = None
    located: bool = False
    field: str = ""
    get: Callable[[Any], Any] | None = None
    default: Any = None
    owns: bool = False
    keeps: bool = False
    nests: bool = False
    check: Callable[..., Any] | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "attribute_rules", {rule.name: rule for rule in self.attributes})
        own = {self.tag: self} if self.nests else {}
        object.__setattr__(self, "child_rules", {rule.tag: rule for rule in self.children} | own)

    @property
    def target(self) -> str:
        """The name of the parent's field for the element's object."""
        return self.field or self.tag

    @property
    def is_inline(self) -> bool:
        """Whether the element's values are fields of the parent's object."""
        return self.make is None and not self.choice

    @property
    def is_value(self) -> bool:
        """Whether the element's only value is the text inside, as for ``<mass>2.5</mass>`` of SDF."""
        return self.text is not None and not (self.attributes or self.children)

    def value_in(self, instance: Any) -> Any:
        """Return the object, or objects, for this element from the parent's object."""
        return getattr(instance, self.target) if self.get is None else self.get(instance)

    @property
    def values(self) -> tuple[AttributeRule, ...]:
        """The rules of the element's own values: its attributes, and the text inside."""
        return self.attributes if self.text is None else (*self.attributes, self.text)
