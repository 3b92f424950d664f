"""Check the values assigned to fields, as the classes of rosidl_generator_py (Humble) do.

The setters that `linkwright.messages.classes` compiles test for the usual case themselves and call these functions for
all other cases. The functions return the value to store, or raise an AssertionError with the same message as in rclpy.
Unlike in rclpy, numpy arrays and byte buffers may be assigned to sequences of numbers and bools, unless a program
accepts only what ROS accepts (`restrict_to_ros_values`).

numpy is imported only for fixed arrays of numbers, which are stored as numpy arrays, because the import takes longer
than the rest of a command such as ``topic list``. A program that has not imported numpy has no values of numpy's types.
"""

from __future__ import annotations

import math
import sys
from array import array
from collections import UserList, UserString
from collections.abc import Iterable, Sequence
from collections.abc import Set as AbstractSet
from typing import TYPE_CHECKING, Any, NoReturn, TypeGuard, cast

from linkwright.messages.definitions.interfaces import Container, FieldType, Primitive

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class Unset:
    """The type of `UNSET`, the default that marks a constructor argument as missing."""

    def __repr__(self) -> str:
        return "default"


UNSET = Unset()

_accepts_ros_values_only = False
_fixed_as_humble = True


def restrict_to_ros_values(*, as_humble: bool) -> None:
    """Make this process accept only values that the classes of ROS 2 accept.

    Args:
        as_humble: whether constructors convert the values for fixed arrays, as in Humble and earlier, instead of
            checking them.
    """
    global _accepts_ros_values_only, _fixed_as_humble
    _accepts_ros_values_only, _fixed_as_humble = True, as_humble


def refuse_arguments(names: Iterable[str]) -> NoReturn:
    """Raise an AssertionError for constructor arguments that are not fields."""
    raise AssertionError("Invalid arguments passed to constructor: " + ", ".join(sorted(names)))


def check_int(name: str, value: Any, low: int, high: int) -> int:
    """Check an integer and its range.

    As in rclpy, bools are accepted and numpy's integers are not.
    """
    if not isinstance(value, int):
        raise AssertionError(f"The '{name}' field must be of type 'int'")  # noqa: TRY004 - rclpy\'s
    if not low <= value <= high:
        kind = "an integer" if low else "an unsigned integer"
        raise AssertionError(f"The '{name}' field must be {kind} in [{low}, {high}]")
    return value


def check_float(name: str, value: Any, high: float) -> float:
    """Check a float and its range.

    As in rclpy, integers are not accepted.
    """
    if not isinstance(value, float):
        raise AssertionError(f"The '{name}' field must be of type 'float'")  # noqa: TRY004 - rclpy\'s
    if (value < -high or value > high) and not math.isinf(value):
        kind = "a float" if high < 1e300 else "a double"
        raise AssertionError(f"The '{name}' field must be {kind} in [{-high}, {high}]")
    return value


def check_bool(name: str, value: Any) -> bool:
    """Check that a value is a bool."""
    if not isinstance(value, bool):
        raise AssertionError(f"The '{name}' field must be of type 'bool'")  # noqa: TRY004 - rclpy\'s
    return value


def check_byte(name: str, value: Any) -> bytes:
    """Check that a value is a bytes object of length 1."""
    if not (isinstance(value, (bytes, bytearray)) and len(value) == 1):
        raise AssertionError(f"The '{name}' field must be of type 'bytes' or 'ByteString' with length 1")
    return bytes(value)


def check_text(name: str, value: Any, bound: int | None) -> str:
    """Check that a value is a string within its bound."""
    if bound is None:
        if not isinstance(value, str):
            raise AssertionError(f"The '{name}' field must be of type 'str'")
    elif not (isinstance(value, (str, UserString)) and len(value) <= bound):
        raise AssertionError(f"The '{name}' field must be string value not longer than {bound}")
    return str(value) if isinstance(value, UserString) else value


def check_message(name: str, value: Any, cls: type) -> Any:
    """Check that a value is a message of the field's class."""
    if not isinstance(value, cls):
        raise AssertionError(f"The '{name}' field must be a sub message of type '{cls.__name__}'")  # noqa: TRY004 - rclpy\'s
    return value


def check_values(name: str, value: Any, kind: FieldType, cls: type) -> Any:
    """Check a list of bools, bytes, strings or messages, and return the list itself."""
    if cls is bool and not _accepts_ros_values_only and is_array(value) and value.dtype.kind == "b":
        value = value.ravel().tolist()
    if not (
        _is_collection(value)
        and _is_length_valid(value, kind)
        and (set(map(type, value)) <= {cls} or all(isinstance(item, cls) for item in value))
        and (kind.string_bound is None or all(len(item) <= kind.string_bound for item in value))
    ):
        raise AssertionError(f"The '{name}' field must be {_describe_valid_value(kind, cls)}")
    return value


def check_fixed_array(name: str, value: Any, kind: FieldType) -> NDArray[Any]:
    """Check a fixed-length array of numbers, and return it as a numpy array."""
    import numpy as np

    primitive = cast(Primitive, kind.primitive)
    if isinstance(value, np.ndarray):
        if value.dtype != np.dtype(primitive.dtype):
            raise AssertionError(f"The '{name}' numpy.ndarray() must have the dtype of 'numpy.{primitive.dtype}'")
        if value.size != kind.size:
            raise AssertionError(f"The '{name}' numpy.ndarray() must have a size of {kind.size}")
        return value
    return np.array(_check_numbers(name, value, kind, primitive), dtype=primitive.dtype)


def check_sequence(name: str, value: Any, kind: FieldType) -> array[Any]:
    """Check a sequence of numbers, and return it as an ``array.array``.

    An array of the right type is returned without a copy.
    """
    primitive = cast(Primitive, kind.primitive)
    assert primitive.array_code is not None
    if isinstance(value, array):
        if value.typecode != primitive.array_code:
            raise AssertionError(f"The '{name}' array.array() must have the type code of '{primitive.array_code}'")
        if kind.size is not None and len(value) > kind.size:
            raise AssertionError(f"The '{name}' array.array() must have a size <= {kind.size}")
        return value
    if is_array(value) and not _accepts_ros_values_only:
        return _sequence_from_numpy(name, value, kind, primitive)
    if primitive.array_code == "B" and (
        isinstance(value, (bytes, bytearray)) or (isinstance(value, memoryview) and not _accepts_ros_values_only)
    ):
        return _sequence_from_buffer(name, value, kind)
    return array(primitive.array_code, _check_numbers(name, value, kind, primitive))


def to_sequence(name: str, value: Any, kind: FieldType) -> array[Any]:
    """Convert the numbers in a constructor argument to an ``array.array``.

    As in rclpy, a constructor accepts integers for floats.
    """
    primitive = cast(Primitive, kind.primitive)
    code = primitive.array_code
    assert code is not None
    if value.__class__ is array and value.typecode == code and kind.size is None:  # four times as fast
        return value
    if not _accepts_ros_values_only and (isinstance(value, (bytes, bytearray, memoryview)) or is_array(value)):
        return check_sequence(name, value, kind)
    if isinstance(value, array) and value.typecode == code:
        return check_sequence(name, value, kind)
    return check_sequence(name, array(code, value), kind)


def to_fixed_array(name: str, value: Any, kind: FieldType) -> NDArray[Any]:
    """Convert the numbers in a constructor argument to a numpy array of fixed length."""
    import numpy as np

    primitive = cast(Primitive, kind.primitive)
    if not _fixed_as_humble:
        return check_fixed_array(name, value, kind)
    if value.__class__ is np.ndarray and value.dtype.char == primitive.array_code:  # three times as fast
        converted = value.copy()
    else:
        converted = np.array(value, dtype=primitive.dtype)
    if converted.size != kind.size:
        raise AssertionError(f"The '{name}' numpy.ndarray() must have a size of {kind.size}")
    if _accepts_ros_values_only and converted.shape != (kind.size,):
        raise AssertionError(f"The '{name}' numpy.ndarray() must have the shape ({kind.size},)")
    return converted


# --- values of numpy, recognized without importing numpy ------------------------------------------------------------


def is_array(value: Any) -> TypeGuard[NDArray[Any]]:
    """Return whether a value is a ``numpy.ndarray``."""
    array_class = find_ndarray_class()
    return array_class is not None and isinstance(value, array_class)


def is_scalar(value: Any) -> TypeGuard[np.generic]:
    """Return whether a value is a numpy scalar, such as ``numpy.float64``."""
    scalar_class = getattr(sys.modules.get("numpy"), "generic", None)
    return scalar_class is not None and isinstance(value, scalar_class)


def find_ndarray_class() -> type[NDArray[Any]] | None:
    """Return ``numpy.ndarray``, or None if numpy has not been imported."""
    return getattr(sys.modules.get("numpy"), "ndarray", None)


# --- helpers of the checks ------------------------------------------------------------------------------------------


def _is_collection(value: Any) -> bool:
    return value.__class__ is list or (
        isinstance(value, (Sequence, AbstractSet, UserList)) and not isinstance(value, (str, UserString))
    )


def _is_length_valid(value: Any, kind: FieldType) -> bool:
    if kind.container is Container.ARRAY:
        return len(value) == kind.size
    return kind.size is None or len(value) <= kind.size


def _check_numbers(name: str, value: Any, kind: FieldType, primitive: Primitive) -> Any:
    if not (
        _is_collection(value)
        and _is_length_valid(value, kind)
        and (set(map(type, value)) <= {primitive.python} or all(isinstance(item, primitive.python) for item in value))
        and _are_in_range(value, primitive)
    ):
        raise AssertionError(f"The '{name}' field must be {_describe_valid_value(kind, primitive.python)}")
    return value if isinstance(value, (list, tuple)) else list(value)


def _are_in_range(values: Any, primitive: Primitive) -> bool:
    if not len(values):
        return True
    if primitive.is_integer:
        return bool(min(values) >= primitive.low and max(values) <= primitive.high)
    if primitive.array_code == "d":  # A Python float always fits into a double.
        return True
    return all(-primitive.high <= value <= primitive.high or not math.isfinite(value) for value in values)


def _sequence_from_numpy(name: str, value: NDArray[Any], kind: FieldType, primitive: Primitive) -> array[Any]:
    import numpy as np

    code = primitive.array_code
    assert code is not None
    target_type = np.dtype(primitive.dtype)
    value = value.ravel()
    are_integers = target_type.kind in "iu" and value.dtype.kind in "iu"
    can_convert = are_integers or np.can_cast(value.dtype, target_type, "same_kind")
    if not (
        can_convert
        and _is_length_valid(value, kind)
        and (value.dtype == target_type or not are_integers or _are_in_range(value, primitive))
    ):
        raise AssertionError(f"The '{name}' field must be {_describe_valid_value(kind, primitive.python)}")
    converted = array(code)
    converted.frombytes(np.ascontiguousarray(value, dtype=target_type).data.cast("B"))
    return converted


def _sequence_from_buffer(name: str, value: bytes | bytearray | memoryview, kind: FieldType) -> array[Any]:
    converted = array("B")
    converted.frombytes(value)
    if not _is_length_valid(converted, kind):
        raise AssertionError(f"The '{name}' field must be {_describe_valid_value(kind, int)}")
    return converted


def _describe_valid_value(kind: FieldType, python: type) -> str:
    """Return the description of a valid value for an array or sequence, in rclpy's wording."""
    phrases = ["a set or sequence"]
    if kind.container is Container.ARRAY:
        phrases.append(f"with length {kind.size}")
    elif kind.size is not None:
        phrases.append(f"with length <= {kind.size}")
    if kind.string_bound is not None:
        phrases.append(f"and each string value not longer than {kind.string_bound}")
    phrases.append(f"and each value of type '{python.__name__}'")
    primitive = kind.primitive
    if primitive is not None and primitive.is_integer:
        integer = "integer" if primitive.low else "unsigned integer"
        phrases.append(f"and each {integer} in [{primitive.low}, {primitive.high}]")
    elif primitive is not None and primitive.python is float:
        type_word = "double" if primitive.array_code == "d" else "float"
        phrases.append(f"and each {type_word} in [{-primitive.high:f}, {primitive.high:f}]")
    return " ".join(phrases)
