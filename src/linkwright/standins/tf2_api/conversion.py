"""Registries of transformations and conversions by type (tf2_ros ``buffer_interface``)."""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from typing import Any, ClassVar, TypeVar

F = TypeVar("F")
Transformation = Callable[[Any, Any], Any]
Conversion = Callable[[Any], Any]


class TypeException(Exception):
    """Raised when no function is registered for a type.

    Attributes:
        errstr: the error message.
    """

    def __init__(self, errstr: str) -> None:
        super().__init__(errstr)
        self.errstr = errstr


class NotImplementedException(Exception):
    """Raised when a buffer does not support an operation."""

    def __init__(self) -> None:
        self.errstr = "CanTransform or LookupTransform not implemented"
        super().__init__(self.errstr)


class TransformRegistration:
    """The functions that transform values, by type.

    All objects of this class share one registry.
    """

    _by_type: ClassVar[dict[Any, Transformation]] = {}

    def add(self, key: Any, callback: Transformation) -> None:
        """Register the function that transforms values of a type."""
        self._by_type[key] = callback

    def get(self, key: Any) -> Transformation:
        """Return the function that transforms values of a type.

        Raises:
            TypeException: the type is not registered.
        """
        return _find_registered(self._by_type, key)

    def print_me(self) -> None:
        """Print the registered types and their functions."""
        print(self._by_type)  # the purpose of this method is to print


class ConvertRegistration:
    """The functions that convert types to messages, from messages, or to other types.

    All objects of this class share one registry.
    """

    _to_msg: ClassVar[dict[Any, Conversion]] = {}
    _from_msg: ClassVar[dict[Any, Conversion]] = {}
    _direct: ClassVar[dict[Any, Conversion]] = {}

    def add_from_msg(self, key: Any, callback: Conversion) -> None:
        """Register the conversion from messages to a type."""
        self._from_msg[key] = callback

    def add_to_msg(self, key: Any, callback: Conversion) -> None:
        """Register the conversion from a type to messages."""
        self._to_msg[key] = callback

    def add_convert(self, key: tuple[Any, Any], callback: Conversion) -> None:
        """Register the conversion from the first type of a pair to the second."""
        self._direct[key] = callback

    def get_from_msg(self, key: Any) -> Conversion:
        """Return the function that converts messages to a type.

        Raises:
            TypeException: no such conversion is registered.
        """
        return _find_registered(self._from_msg, key)

    def get_to_msg(self, key: Any) -> Conversion:
        """Return the function that converts a type to messages.

        Raises:
            TypeException: no such conversion is registered.
        """
        return _find_registered(self._to_msg, key)

    def get_convert(self, key: tuple[Any, Any]) -> Conversion:
        """Return the function that converts the first type of a pair to the second.

        Raises:
            TypeException: no such conversion is registered.
        """
        return _find_registered(self._direct, key)


def convert(a: Any, b_type: Any) -> Any:
    """Convert a value to another type, through a message if necessary.

    If the value already has this type and no conversion is registered, return a copy.

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
    """Add a header with a stamp and a frame to an object, and return the object."""
    from linkwright.messages import get_message

    obj.header = get_message("std_msgs/msg/Header")(frame_id=frame_id, stamp=stamp)
    return obj


def _find_registered(registry: dict[Any, F], key: Any) -> F:
    if key not in registry:
        raise TypeException(f"Type {key} is not loaded or supported")
    return registry[key]
