"""Convert text and substitutions to typed values (``launch.utilities.type_utils``).

The types are ``int``, ``float``, ``bool``, ``str`` and uniform lists of these, written ``List[int]`` or ``list[int]``.
The type None means that YAML's rules determine the type.
"""

from __future__ import annotations

import typing
from collections.abc import Iterable, Sequence
from typing import Any

from linkwright.launch.model.substitution import (
    SomeSubstitutionsType,
    Substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

ScalarTypesTuple = (int, float, bool, str)
ListTypesTuple = (typing.List[int], typing.List[float], typing.List[bool], typing.List[str])  # noqa: UP006 - compared by users
AllowedTypesTuple = ScalarTypesTuple + ListTypesTuple

ScalarTypesType = type[int] | type[float] | type[bool] | type[str]
ListTypesType = type[list[int]] | type[list[float]] | type[list[bool]] | type[list[str]]
AllowedTypesType = ScalarTypesType | ListTypesType
ScalarValueType = int | float | bool | str
ListValueType = list[int] | list[float] | list[bool] | list[str]
SequenceValueType = Sequence[int] | Sequence[float] | Sequence[bool] | Sequence[str]
AllowedValueType = ScalarValueType | SequenceValueType
SomeScalarType = SomeSubstitutionsType | ScalarValueType
SomeSequenceType = Sequence[SomeScalarType]
SomeValueType = SomeScalarType | SomeSequenceType
NormalizedScalarType = list[Substitution] | ScalarValueType
NormalizedSequenceType = list[NormalizedScalarType]
NormalizedValueType = NormalizedScalarType | NormalizedSequenceType
StrSomeScalarType = SomeScalarType
StrSomeSequenceType = Sequence[ScalarValueType]
StrSomeValueType = StrSomeScalarType | StrSomeSequenceType

_BOOLEANS_BY_DIGIT = {"1": "true", "0": "false"}


def is_typing_list(data_type: Any) -> bool:
    """Return whether a type is ``List``, ``List[...]`` or ``list[...]``.

    The plain ``list`` is not such a type.
    """
    return data_type is typing.List or typing.get_origin(data_type) is list  # noqa: UP006 - users may pass it


def is_valid_scalar_type(data_type: Any) -> bool:
    """Return whether a type is one of ``int``, ``float``, ``bool`` and ``str``."""
    return data_type in ScalarTypesTuple


def extract_type(data_type: Any) -> tuple[Any, bool]:
    """Return the scalar type of a type or of its list items, and whether the type is a list.

    Raises:
        ValueError: the type is neither a scalar type nor a list of one.
    """
    is_list = is_typing_list(data_type) and bool(typing.get_args(data_type))
    scalar = typing.get_args(data_type)[0] if is_list else data_type
    if not is_valid_scalar_type(scalar):
        raise ValueError(f"Unrecognized data type: {data_type}")
    return scalar, is_list


def is_instance_of_valid_type(value: Any, can_be_str: bool = False) -> bool:
    """Return whether a value is a scalar of an allowed type, or a list of one such type.

    If `can_be_str` is set, lists may contain strings among other items.
    """
    if not isinstance(value, list):
        return isinstance(value, ScalarTypesTuple)
    item_types = {_find_scalar_type(item) for item in value}
    if None in item_types:
        return False
    return len(item_types - {str}) <= 1 if can_be_str else len(item_types) <= 1


def _find_scalar_type(value: Any) -> type | None:
    return next((scalar_type for scalar_type in (bool, int, float, str) if isinstance(value, scalar_type)), None)


def is_instance_of(value: Any, data_type: Any = None, can_be_str: bool = False) -> bool:
    """Return whether a value has a type.

    The type None accepts all allowed types. If `can_be_str` is set, strings are also accepted.

    Raises:
        ValueError: the type is not allowed.
    """
    if data_type is None:
        return is_instance_of_valid_type(value, can_be_str=can_be_str)
    scalar_type, is_list = extract_type(data_type)
    accepted_types = (scalar_type, str) if can_be_str else (scalar_type,)
    if is_list:
        return isinstance(value, list) and all(isinstance(item, accepted_types) for item in value)
    return isinstance(value, accepted_types)


def coerce_to_type(value: str, data_type: Any = None, can_be_str: bool = False) -> Any:
    """Convert a string to a value of a type.

    Args:
        value: the string.
        data_type: the type; None applies YAML's rules.
        can_be_str: whether to return a string unchanged if it cannot be converted, because it may contain a
            substitution.

    Raises:
        TypeError: the value is not a string.
        ValueError: the string cannot be converted, or the type is not allowed.
    """
    if not isinstance(value, str):
        raise TypeError(f"expected 'value' to be of type '{str}', but got {value!r} of type {type(value)}")
    if data_type is None:
        return _parse_yaml(value, f"Failed to convert '{value}' using yaml rules", can_be_str)
    scalar_type, is_list = extract_type(data_type)
    if is_list:
        return _coerce_to_list(value, scalar_type, can_be_str)
    if scalar_type is str:
        return value
    if scalar_type is bool:
        parsed = _parse_yaml(
            _BOOLEANS_BY_DIGIT.get(value, value), f"Failed to convert '{value}' to '{bool}'", can_be_str
        )
        if isinstance(parsed, (bool, str) if can_be_str else bool):
            return parsed
        raise ValueError(f"Cannot convert value '{value}' to '{bool}'")
    try:
        return scalar_type(value)
    except ValueError:
        if can_be_str:
            return value
        raise


def _coerce_to_list(value: str, scalar_type: type, can_be_str: bool) -> Any:
    accepted_types = (str, scalar_type) if can_be_str else (scalar_type,)
    message = f"Cannot convert value '{value}' to a list of '{scalar_type.__name__}'"
    parsed = _parse_yaml(value, message, can_be_str)
    if not isinstance(parsed, list):
        raise ValueError(message)  # noqa: TRY004 - as in ROS
    if not all(isinstance(item, accepted_types) for item in parsed):
        raise ValueError(f"{message}, got {parsed}")
    return parsed


def _parse_yaml(value: str, message: str, can_be_str: bool) -> Any:
    import yaml

    if not value:
        return value
    try:
        parsed = yaml.safe_load(value)
    except Exception as error:
        if can_be_str:
            return value
        raise ValueError(f"{message}: yaml.safe_load() failed\n{error}") from error
    if not is_instance_of_valid_type(parsed, can_be_str=can_be_str):
        raise ValueError(f"{message}: output type is not allowed, got {type(parsed)}")
    return parsed


def coerce_list(value: list[str], data_type: Any = None, can_be_str: bool = False) -> list[Any]:
    """Convert a list of strings to a list of values of a scalar type. See `coerce_to_type`.

    Raises:
        TypeError: the value is not a list of strings.
        ValueError: a string cannot be converted, the values have different types, or the type is not allowed.
    """
    if not isinstance(value, list):
        raise TypeError(f"expected 'value' to be of type '{list}', but got {value!r} of type {type(value)}")
    values = [coerce_to_type(item, data_type, can_be_str=can_be_str) for item in value]
    if not is_instance_of_valid_type(values, can_be_str=can_be_str):
        raise ValueError(f"cannot convert value to {data_type}. Got value=`{value}`")
    return values


def get_typed_value(value: str | list[str], data_type: Any = None, can_be_str: bool = False) -> Any:
    """Convert a string or a list of strings to a value of a type. See `coerce_to_type`.

    Raises:
        TypeError: the value is a list although the type is not, or it is neither a string nor a list of strings.
        ValueError: the value cannot be converted, or the type is not allowed.
    """
    if not isinstance(value, list):
        return coerce_to_type(value, data_type, can_be_str=can_be_str)
    if data_type is not None:
        data_type, is_list = extract_type(data_type)
        if not is_list:
            raise TypeError(f"Cannot convert input '{value}' of type '{type(value)}' to '{data_type}'")
    return coerce_list(value, data_type, can_be_str=can_be_str)


# --- values that contain substitutions ------------------------------------------------------------------------


def is_substitution(value: Any) -> bool:
    """Return whether a value is a substitution, or an iterable with at least one.

    The other items of the iterable must be strings.
    """
    if isinstance(value, Substitution):
        return True
    if isinstance(value, str) or not isinstance(value, Iterable):
        return False
    items = list(value)
    return all(isinstance(item, (Substitution, str)) for item in items) and any(
        isinstance(item, Substitution) for item in items
    )


def is_normalized_substitution(value: Any) -> bool:
    """Return whether a value is a non-empty list that contains only substitutions."""
    return isinstance(value, list) and bool(value) and all(isinstance(item, Substitution) for item in value)


def read_boolean(value: Any) -> Any:
    """Return the boolean that a string represents, and any other value unchanged.

    Raises:
        ValueError: the string is not a boolean.
    """
    return coerce_to_type(value, bool) if isinstance(value, str) else value


def normalize_typed_substitution(value: Any, data_type: Any) -> Any:
    """Normalize the substitutions in a value to lists of substitutions.

    A list of strings and substitutions is one value: ``['a', TextSubstitution(text='b')]`` means ``'ab'``.

    Raises:
        TypeError: the value cannot have the type, whatever its substitutions evaluate to.
        ValueError: the type is not allowed.
    """
    if is_substitution(value):
        return normalize_to_list_of_substitutions(value)
    if isinstance(value, ScalarTypesTuple):
        if not is_instance_of(value, data_type):
            raise TypeError(f"value='{value}' is not an instance of {data_type}")
        return value
    if not isinstance(value, Sequence):
        raise TypeError(f"value={value!r} of type {type(value)} is neither a value, a substitution nor a list")
    scalar_type, is_list = (None, True) if data_type is None else extract_type(data_type)
    if not is_list:
        raise TypeError(f"value='{value}' is a list, and {data_type} is expected")
    items = [normalize_to_list_of_substitutions(item) if is_substitution(item) else item for item in value]
    plain_items = [item for item in items if not isinstance(item, list)]
    if not is_instance_of(plain_items, None if scalar_type is None else list[scalar_type]):  # type: ignore[valid-type]  # a type made here
        raise TypeError(f"value='{value}' is not a list of {data_type if scalar_type is None else scalar_type}")
    return items


def perform_typed_substitution(context: Any, value: Any, data_type: Any = None) -> Any:
    """Evaluate the result of `normalize_typed_substitution` to a value of a type.

    Raises:
        TypeError: a value without substitutions has another type.
        ValueError: the evaluated text cannot be converted to the type.
    """
    if is_normalized_substitution(value):
        return coerce_to_type(perform_substitutions(context, value), data_type)
    if not isinstance(value, list):
        if not is_instance_of(value, data_type):
            raise TypeError(f"value='{value}' is not an instance of {data_type}")
        return value
    scalar_type = None if data_type is None else extract_type(data_type)[0]
    evaluated_items = [
        coerce_to_type(perform_substitutions(context, item), scalar_type) if is_normalized_substitution(item) else item
        for item in value
    ]
    if not is_instance_of(evaluated_items, data_type):
        raise ValueError(f"value='{value}' is not an instance of {data_type}, got {evaluated_items}")
    return evaluated_items


_TYPE_NAMES: dict[str, Any] = {
    **{kind.__name__: kind for kind in ScalarTypesTuple},
    **{f"list[{typing.get_args(kind)[0].__name__}]": kind for kind in ListTypesTuple},
    **{f"list_of_{typing.get_args(kind)[0].__name__}": kind for kind in ListTypesTuple},
}


def get_data_type_from_identifier(type_identifier: str) -> Any:
    """Return the type with a name such as ``int``, ``list[int]`` or ``list_of_int``.

    Raises:
        ValueError: there is no such type.
    """
    if type_identifier not in _TYPE_NAMES:
        raise ValueError(f"Got invalid type identifier '{type_identifier}'")
    return _TYPE_NAMES[type_identifier]
