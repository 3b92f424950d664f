"""The classes of rosidl_parser for field types.

Programs read them from ``SLOT_TYPES``.
"""

from __future__ import annotations

from collections.abc import Sequence

from linkwright.messages.definitions.interfaces import Container, FieldType, Structure


class AbstractType:
    """The base class of all field types.

    Types with the same content are equal.
    """

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
    """The base class of types that are allowed as the values of an array or a sequence."""

    __slots__ = ()


class BasicType(AbstractNestableType):
    """A number, bool, byte or character type.

    `typename` is its name in IDL.
    """

    __slots__ = ("typename",)

    def __init__(self, typename: str) -> None:
        self.typename = typename


class NamedType(AbstractNestableType):
    """A type with a name that has no namespaces."""

    __slots__ = ("name",)

    def __init__(self, name: str) -> None:
        self.name = name


class NamespacedType(AbstractNestableType):
    """The type of a nested message, such as ``NamespacedType(['std_msgs', 'msg'], 'Header')``."""

    __slots__ = ("name", "namespaces")

    def __init__(self, namespaces: Sequence[str], name: str) -> None:
        self.namespaces = tuple(namespaces)
        self.name = name

    def _content(self) -> tuple[object, ...]:
        return self.namespaces, self.name

    def namespaced_name(self) -> tuple[str, ...]:
        """Return the namespaces followed by the name."""
        return (*self.namespaces, self.name)


class AbstractGenericString(AbstractNestableType):
    """The base class of the string types."""

    __slots__ = ()

    def has_maximum_size(self) -> bool:
        """Return whether the length is bounded."""
        return False


class AbstractString(AbstractGenericString):
    """A UTF-8 string."""

    __slots__ = ()


class AbstractWString(AbstractGenericString):
    """A UTF-16 string."""

    __slots__ = ()


class BoundedString(AbstractString):
    """A UTF-8 string with a maximum number of characters."""

    __slots__ = ("maximum_size",)

    def __init__(self, maximum_size: int) -> None:
        self.maximum_size = maximum_size

    def has_maximum_size(self) -> bool:
        """Return True, because the length is bounded."""
        return True


class UnboundedString(AbstractString):
    """A UTF-8 string of any length."""

    __slots__ = ()


class BoundedWString(AbstractWString):
    """A UTF-16 string with a maximum number of characters."""

    __slots__ = ("maximum_size",)

    def __init__(self, maximum_size: int) -> None:
        self.maximum_size = maximum_size

    def has_maximum_size(self) -> bool:
        """Return True, because the length is bounded."""
        return True


class UnboundedWString(AbstractWString):
    """A UTF-16 string of any length."""

    __slots__ = ()


class AbstractNestedType(AbstractType):
    """The base class of arrays and sequences, which have several values of one type."""

    __slots__ = ("value_type",)

    def __init__(self, value_type: AbstractNestableType) -> None:
        self.value_type = value_type

    def has_maximum_size(self) -> bool:
        """Return whether the number of values is bounded."""
        return False


class Array(AbstractNestedType):
    """An array of a fixed number of values."""

    __slots__ = ("size",)

    def __init__(self, value_type: AbstractNestableType, size: int) -> None:
        super().__init__(value_type)
        self.size = size

    def has_maximum_size(self) -> bool:
        """Return True, because the number of values is fixed."""
        return True


class AbstractSequence(AbstractNestedType):
    """The base class of sequences with or without a maximum length."""

    __slots__ = ()


class BoundedSequence(AbstractSequence):
    """A sequence with a maximum number of values."""

    __slots__ = ("maximum_size",)

    def __init__(self, value_type: AbstractNestableType, maximum_size: int) -> None:
        super().__init__(value_type)
        self.maximum_size = maximum_size

    def has_maximum_size(self) -> bool:
        """Return True, because the number of values is bounded."""
        return True


class UnboundedSequence(AbstractSequence):
    """A sequence of any number of values."""

    __slots__ = ()


def make_slot_types(structure: Structure) -> tuple[AbstractType, ...]:
    """Return a type object for each field of a structure, in the order of the fields."""
    return tuple(make_slot_type(field.type) for field in structure.fields)


def make_slot_type(kind: FieldType) -> AbstractType:
    """Return the type object for a field type of a definition."""
    value_type = _make_value_type(kind)
    if kind.container is Container.ONE:
        return value_type
    if kind.container is Container.ARRAY:
        assert kind.size is not None
        return Array(value_type, kind.size)
    return UnboundedSequence(value_type) if kind.size is None else BoundedSequence(value_type, kind.size)


def _make_value_type(kind: FieldType) -> AbstractNestableType:
    primitive = kind.primitive
    if primitive is None:
        *namespaces, name = kind.base.split("/")
        return NamespacedType(namespaces, name)
    if primitive.python is not str:
        return BasicType(primitive.idl_name)
    if kind.base == "wstring":
        return UnboundedWString() if kind.string_bound is None else BoundedWString(kind.string_bound)
    return UnboundedString() if kind.string_bound is None else BoundedString(kind.string_bound)
