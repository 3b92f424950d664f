"""The types of fields as rosidl_parser has them, for ``SLOT_TYPES``, which code written for rclpy reads."""

from __future__ import annotations

from collections.abc import Sequence

from linkwright.messages.definitions.interfaces import Container, FieldType, Structure


class AbstractType:
    """Any type; types of the same content are equal."""

    __slots__ = ()

    def _content(self) -> tuple[object, ...]:
        classes = reversed(type(self).__mro__)
        return tuple(getattr(self, name) for cls in classes for name in getattr(cls, "__slots__", ()))

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and isinstance(other, AbstractType) and self._content() == other._content()

    def __hash__(self) -> int:
        return hash((type(self), self._content()))

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(repr(value) for value in self._content())})"


class AbstractNestableType(AbstractType):
    """A type that an array or a sequence may have for its values."""

    __slots__ = ()


class BasicType(AbstractNestableType):
    """A number, a bool, a byte or a character, under the name that IDL has for it."""

    __slots__ = ("typename",)

    def __init__(self, typename: str) -> None:
        self.typename = typename


class NamedType(AbstractNestableType):
    """A type by a name without namespaces."""

    __slots__ = ("name",)

    def __init__(self, name: str) -> None:
        self.name = name


class NamespacedType(AbstractNestableType):
    """A structure: ``NamespacedType(['std_msgs', 'msg'], 'Header')``."""

    __slots__ = ("name", "namespaces")

    def __init__(self, namespaces: Sequence[str], name: str) -> None:
        self.namespaces = tuple(namespaces)
        self.name = name

    def _content(self) -> tuple[object, ...]:
        return self.namespaces, self.name

    def namespaced_name(self) -> tuple[str, ...]:
        """The namespaces and the name."""
        return (*self.namespaces, self.name)


class AbstractGenericString(AbstractNestableType):
    """Any text."""

    __slots__ = ()

    def has_maximum_size(self) -> bool:
        """Whether its length is bounded."""
        return False


class AbstractString(AbstractGenericString):
    """Text in UTF-8."""

    __slots__ = ()


class AbstractWString(AbstractGenericString):
    """Text in UTF-16."""

    __slots__ = ()


class BoundedString(AbstractString):
    """Text of at most so many characters."""

    __slots__ = ("maximum_size",)

    def __init__(self, maximum_size: int) -> None:
        self.maximum_size = maximum_size

    def has_maximum_size(self) -> bool:
        """True."""
        return True


class UnboundedString(AbstractString):
    """Text of any length."""

    __slots__ = ()


class BoundedWString(AbstractWString):
    """Text in UTF-16 of at most so many characters."""

    __slots__ = ("maximum_size",)

    def __init__(self, maximum_size: int) -> None:
        self.maximum_size = maximum_size

    def has_maximum_size(self) -> bool:
        """True."""
        return True


class UnboundedWString(AbstractWString):
    """Text in UTF-16 of any length."""

    __slots__ = ()


class AbstractNestedType(AbstractType):
    """Several values of one type."""

    __slots__ = ("value_type",)

    def __init__(self, value_type: AbstractNestableType) -> None:
        self.value_type = value_type

    def has_maximum_size(self) -> bool:
        """Whether the number of values is bounded."""
        return False


class Array(AbstractNestedType):
    """A fixed number of values."""

    __slots__ = ("size",)

    def __init__(self, value_type: AbstractNestableType, size: int) -> None:
        super().__init__(value_type)
        self.size = size

    def has_maximum_size(self) -> bool:
        """True."""
        return True


class AbstractSequence(AbstractNestedType):
    """Any number of values."""

    __slots__ = ()


class BoundedSequence(AbstractSequence):
    """At most so many values."""

    __slots__ = ("maximum_size",)

    def __init__(self, value_type: AbstractNestableType, maximum_size: int) -> None:
        super().__init__(value_type)
        self.maximum_size = maximum_size

    def has_maximum_size(self) -> bool:
        """True."""
        return True


class UnboundedSequence(AbstractSequence):
    """Any number of values."""

    __slots__ = ()


def slot_types(structure: Structure) -> tuple[AbstractType, ...]:
    """The types of a structure's fields, in their order."""
    return tuple(slot_type(field.type) for field in structure.fields)


def slot_type(kind: FieldType) -> AbstractType:
    """The type of one field."""
    value_type = _value_type(kind)
    if kind.container is Container.ONE:
        return value_type
    if kind.container is Container.ARRAY:
        assert kind.size is not None
        return Array(value_type, kind.size)
    return UnboundedSequence(value_type) if kind.size is None else BoundedSequence(value_type, kind.size)


def _value_type(kind: FieldType) -> AbstractNestableType:
    primitive = kind.primitive
    if primitive is None:
        *namespaces, name = kind.base.split("/")
        return NamespacedType(namespaces, name)
    if primitive.python is not str:
        return BasicType(primitive.idl_name)
    if kind.base == "wstring":
        return UnboundedWString() if kind.string_bound is None else BoundedWString(kind.string_bound)
    return UnboundedString() if kind.string_bound is None else BoundedString(kind.string_bound)
