"""Normalization and evaluation of the ``parameters`` of a node (``launch_ros.utilities``).

Parameters are normalized, and thereby checked, when the node is created. Paths become `ParameterFile` objects. Nested
dictionaries become flat dictionaries, with tuples of substitutions as names, and with plain values or tuples of
substitutions as values. Evaluation turns each item into a path, a dictionary of values by name, or a `Parameter`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from linkwright.diagnostics import phrase
from linkwright.launch.errors.locations import SourceLocation, error_at
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.substitution import (
    Substitution,
    TextSubstitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from linkwright.launch.ros.parameter_files import ParameterFile
from linkwright.launch.ros.parameter_values import Parameter, ParameterValue, parse_yaml_value, to_uniform_tuple

Name = tuple[Substitution, ...]
NormalizedDict = dict[Name, Any]


class PlainItem(TextSubstitution):
    """A literal item among substitutions.

    The item keeps its type. For example, a string is not read as YAML.

    Attributes:
        value: the literal.
    """

    def __init__(self, value: Any) -> None:
        super().__init__(text=str(value))
        self.value = value


def normalize_parameters(parameters: Any) -> tuple[Any, ...]:
    """Return the ``parameters`` of a node as normalized items.

    Raises:
        LinkwrightError: LAUNCH132, the parameters are not a list, or an item is not valid; also a TypeError.
    """
    location = SourceLocation.of_caller()
    if isinstance(parameters, (str, Mapping)) or not isinstance(parameters, Sequence):
        ros_error = TypeError(f"Expecting list of parameters, got {parameters}")
        hint = phrase("put the parameters into a list: parameters=[...]")
        raise error_at(
            location, "LAUNCH132", phrase("'parameters' of a node must be a list"), hint, ros_error=ros_error
        )
    return tuple(_normalize_item(item, location) for item in parameters)


def normalize_parameter_dict(
    parameters: Mapping[Any, Any], *, _prefix: Sequence[Substitution] | None = None
) -> NormalizedDict:
    """Return a normalized dictionary of parameters.

    The names in nested dictionaries are joined with dots.

    Raises:
        LinkwrightError: LAUNCH132, a name or value is not valid for a parameter; the error is also a TypeError.
    """
    if not isinstance(parameters, Mapping):
        raise TypeError("expected dict")
    normalized: NormalizedDict = {}
    for key, value in parameters.items():
        name = _normalize_name(key)
        if _prefix:
            name = (*_prefix, TextSubstitution(text="."), *name)
        if isinstance(value, Mapping):
            normalized.update(normalize_parameter_dict(value, _prefix=name))
        else:
            normalized[name] = _normalize_value(value, key)
    return normalized


def evaluate_parameters(context: LaunchContext, parameters: Iterable[Any]) -> tuple[Any, ...]:
    """Return the value of each normalized parameter: a path, a dictionary or a `Parameter`.

    Raises:
        LinkwrightError: LAUNCH132 or LAUNCH133, a value or a file has errors.
    """
    return tuple(_evaluate_item(context, item) for item in parameters)


def evaluate_parameter_dict(context: LaunchContext, parameters: NormalizedDict) -> dict[str, Any]:
    """Return the evaluated values of a normalized dictionary by name.

    Lists become tuples.

    Raises:
        LinkwrightError: LAUNCH132, a value has errors; the error is also a TypeError.
    """
    if not isinstance(parameters, Mapping):
        raise TypeError("expected dict")
    evaluated: dict[str, Any] = {}
    for key, value in parameters.items():
        if not isinstance(key, tuple):
            raise TypeError(f"Expecting tuple of substitutions got {key!r}")
        name = perform_substitutions(context, key)
        evaluated[name] = _evaluate_value(context, name, value)
    return evaluated


# --- normalization ----------------------------------------------------------------------------------------------


def _normalize_item(item: Any, location: SourceLocation | None) -> Any:
    if isinstance(item, Mapping):
        return normalize_parameter_dict(item)
    if isinstance(item, (Parameter, ParameterFile)):
        return item
    if isinstance(item, (str, Path, Substitution, list, tuple)):
        return ParameterFile(item)
    message = phrase("'parameters' of a node contains an item of type {type}", type=type(item).__name__)
    hint = phrase("items must be dictionaries or paths of YAML files")
    raise error_at(location, "LAUNCH132", message, hint, ros_error=TypeError(message))


def _normalize_name(key: Any) -> Name:
    try:
        return tuple(normalize_to_list_of_substitutions(key))
    except TypeError as error:
        message = phrase("the name of a parameter must be a string, not {key}", key=repr(key))
        raise error_at(SourceLocation.of_caller(), "LAUNCH132", message, ros_error=error) from error


def _normalize_value(value: Any, key: Any) -> Any:
    if isinstance(value, str):
        return (PlainItem(value),)
    if isinstance(value, Substitution):
        return (value,)
    if isinstance(value, (bool, int, float, bytes, ParameterValue)):
        return value
    if isinstance(value, Sequence):
        return _normalize_sequence(value, key)
    shown_name = key if isinstance(key, str) else "..."
    if isinstance(value, Path):
        message = phrase(
            "the value of parameter '{parameter}' is a Path, which is not a parameter type", parameter=shown_name
        )
        raise error_at(
            SourceLocation.of_caller(),
            "LAUNCH132",
            message,
            phrase("pass it as a string: str(PATH)"),
            ros_error=TypeError(message),
        )
    message = phrase(
        "parameter '{parameter}' is of type {type}, which is not a parameter type",
        parameter=shown_name,
        type=type(value).__name__,
    )
    ros_error = TypeError(f"Unexpected type for parameter value {value!r}")
    raise error_at(SourceLocation.of_caller(), "LAUNCH132", message, ros_error=ros_error)


def _normalize_sequence(items: Sequence[Any], key: Any) -> tuple[Any, ...]:
    item_kinds = {_find_item_kind(item, key) for item in items}
    if item_kinds <= {int, float}:
        return tuple(items) if len(item_kinds) < 2 else tuple(float(item) for item in items)
    if item_kinds <= {str}:
        return tuple(items)
    if item_kinds == {bool}:
        return tuple(items)
    if Substitution in item_kinds and item_kinds <= {str, Substitution}:
        return tuple(normalize_to_list_of_substitutions(items))
    # The items are evaluated separately. Strings and other values are literals, and each substitution is read as YAML.
    return tuple(
        tuple(normalize_to_list_of_substitutions(item))
        if isinstance(item, (Substitution, list, tuple))
        else (PlainItem(item),)
        for item in items
    )


def _find_item_kind(item: Any, key: Any) -> type:
    for item_type in (Substitution, str, bool, int, float):
        if isinstance(item, item_type):
            return item_type
    if isinstance(item, (list, tuple)) and all(isinstance(element, (str, Substitution)) for element in item):
        return tuple
    shown_name = key if isinstance(key, str) else "..."
    message = phrase(
        "the list of parameter '{parameter}' contains an item of type {type}",
        parameter=shown_name,
        type=type(item).__name__,
    )
    hint = phrase("items must be of type bool, int, float or str")
    raise error_at(SourceLocation.of_caller(), "LAUNCH132", message, hint, ros_error=TypeError(message))


# --- evaluation -------------------------------------------------------------------------------------------------


def _evaluate_item(context: LaunchContext, item: Any) -> Any:
    if isinstance(item, ParameterFile):
        return item.evaluate(context)
    if isinstance(item, Mapping):
        return evaluate_parameter_dict(context, dict(item))
    if isinstance(item, tuple) and item and isinstance(item[0], Substitution):
        return Path(perform_substitutions(context, item))
    return item


def _evaluate_value(context: LaunchContext, name: str, value: Any) -> Any:
    if isinstance(value, ParameterValue):
        return value.evaluate(context, name)
    if not isinstance(value, tuple) or not value:
        return value
    if isinstance(value[0], Substitution):
        return _evaluate_text(context, name, value)
    if isinstance(value[0], tuple):
        location = next(
            (
                substitution.source_location
                for item in value
                for substitution in item
                if substitution.source_location is not None
            ),
            None,
        )
        return to_uniform_tuple([_evaluate_text(context, name, item) for item in value], name, location)
    return value


def _evaluate_text(context: LaunchContext, name: str, substitutions: tuple[Substitution, ...]) -> Any:
    if len(substitutions) == 1 and isinstance(substitutions[0], PlainItem):
        return substitutions[0].value
    return parse_yaml_value(perform_substitutions(context, substitutions), name, substitutions[0].source_location)
