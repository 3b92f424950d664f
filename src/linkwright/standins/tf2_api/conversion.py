"""The registries of types that can be transformed and converted (tf2_ros ``buffer_interface``)."""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from typing import Any, ClassVar, TypeVar

F = TypeVar("F")
Transformation = Callable[[Any, Any], Any]
Conversion = Callable[[Any], Any]


class TypeException(Exception):
    """A type has not been registered.

    Attributes:
        errstr: the error message.
    """

    def __init__(self, errstr: str) -> None:
        super().__init__(errstr)
        self.errstr = errstr


class NotImplementedException(Exception):
    """A buffer cannot do this."""

    def __init__(self) -> None:
        self.errstr = "CanTransform or LookupTransform not implemented"
        super().__init__(self.errstr)


class TransformRegistration:
    """The functions that transform each type; one registry for all objects of this class."""

    _by_type: ClassVar[dict[Any, Transformation]] = {}

    def add(self, key: Any, callback: Transformation) -> None:
        """Register a type's function of a value and a transform."""
        self._by_type[key] = callback

    def get(self, key: Any) -> Transformation:
        """Return the function for a type.

        Raises:
            TypeException: there is none.
        """
        return _found(self._by_type, key)

    def print_me(self) -> None:
        """Print the registry."""
        print(self._by_type)  # the purpose of the method


class ConvertRegistration:
    """The functions that convert each type to and from messages, or to another type; one registry for all objects."""

    _to_msg: ClassVar[dict[Any, Conversion]] = {}
    _from_msg: ClassVar[dict[Any, Conversion]] = {}
    _direct: ClassVar[dict[Any, Conversion]] = {}

    def add_from_msg(self, key: Any, callback: Conversion) -> None:
        """Register the conversion of a message to a type."""
        self._from_msg[key] = callback

    def add_to_msg(self, key: Any, callback: Conversion) -> None:
        """Register the conversion of a type to a message."""
        self._to_msg[key] = callback

    def add_convert(self, key: tuple[Any, Any], callback: Conversion) -> None:
        """Register the conversion of the first type to the second."""
        self._direct[key] = callback

    def get_from_msg(self, key: Any) -> Conversion:
        """Return the conversion of a message to a type; TypeException if it is not registered."""
        return _found(self._from_msg, key)

    def get_to_msg(self, key: Any) -> Conversion:
        """Return the conversion of a type to a message; TypeException if it is not registered."""
        return _found(self._to_msg, key)

    def get_convert(self, key: tuple[Any, Any]) -> Conversion:
        """Return the conversion of one type to another; TypeException if it is not registered."""
        return _found(self._direct, key)


def convert(a: Any, b_type: Any) -> Any:
    """Convert a value to another type, through a message if necessary; return a copy for the same type.

    Raises:
        TypeException: the conversion is not registered.
    """
    registration = ConvertRegistration()
    try:
        return registration.get_convert((type(a), b_type))(a)
    except TypeException:
        if type(a) is b_type:
            return deepcopy(a)
    return registration.get_from_msg(b_type)(registration.get_to_msg(type(a))(a))


def Stamped(obj: Any, stamp: Any, frame_id: str) -> Any:
    """The object with a header."""
    from linkwright.messages import get_message

    obj.header = get_message("std_msgs/msg/Header")(frame_id=frame_id, stamp=stamp)
    return obj


def _found(table: dict[Any, F], key: Any) -> F:
    if key not in table:
        raise TypeException(f"Type {key} is not loaded or supported")
    return table[key]
