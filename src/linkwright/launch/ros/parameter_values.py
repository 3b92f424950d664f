"""Values of node parameters, which may be known only when the launch runs.

A substitution is text; which type the parameter gets is decided by ``value_type``, or by YAML's rules where
that is not given, as in launch_ros.
"""

from __future__ import annotations

import typing
from collections.abc import Iterable, Sequence
from typing import Any

from linkwright.launch.context import LaunchContext
from linkwright.launch.places import Place, error_at
from linkwright.launch.substitution import (
    SomeSubstitutionsType,
    Substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

SCALARS = (bool, int, float, str)


class ParameterValue:
    """A value with the type that it is to have.

    Args:
        value: the value, or substitutions that give it as text.
        value_type: bool, int, float, str, or a list of one of these such as ``List[int]``; None for YAML's
        rules.
    """

    def __init__(self, value: Any, *, value_type: Any = None) -> None:
        self._value = normalize_to_list_of_substitutions(value) if is_substitution(value) else value
        self._value_type = value_type
        self.place = Place.of_caller()

    @property
    def value(self) -> Any:
        """The value; substitutions as a list."""
        return self._value

    @property
    def value_type(self) -> Any:
        """The type it is to have."""
        return self._value_type

    def evaluate(self, context: LaunchContext) -> Any:
        """The value in its type.

        Raises:
            LinkwrightError: LAUNCH132, if the text is no such value.
        """
        if isinstance(self._value, list) and self._value and isinstance(self._value[0], Substitution):
            text = perform_substitutions(context, self._value)
            return typed_value(text, self._value_type, "value", self.place)
        return checked_value(self._value, self._value_type, self.place)


class Parameter(ParameterValue):
    """A name and a value, for ``parameters`` of a node."""

    def __init__(self, name: SomeSubstitutionsType, value: Any, *, value_type: Any = None) -> None:
        super().__init__(value, value_type=value_type)
        self._name = normalize_to_list_of_substitutions(name)

    @property
    def name(self) -> list[Substitution]:
        """The name, as substitutions."""
        return self._name

    def named_value(self, context: LaunchContext) -> tuple[str, Any]:
        """Name and value.

        Raises:
            LinkwrightError: LAUNCH132, if the text is no such value.
        """
        return perform_substitutions(context, self._name), self.evaluate(context)


def is_substitution(value: Any) -> bool:
    """Whether a value is text that is known only later: a substitution, or a list of texts with one in it."""
    if isinstance(value, Substitution):
        return True
    return (
        isinstance(value, (list, tuple))
        and any(isinstance(each, Substitution) for each in value)
        and all(isinstance(each, (str, Substitution)) for each in value)
    )


def typed_value(text: str, value_type: Any, name: str, place: Place | None) -> Any:
    """A text as a value of a type, by YAML's rules unless the type is str.

    Raises:
        LinkwrightError: LAUNCH132, if it is no such value.
    """
    if value_type is str:
        return text
    value = yaml_value(text, name, place)
    if value_type is None:
        return value
    if value_type is float and type(value) is int:
        return float(value)
    if typing.get_origin(value_type) in (list, typing.List):  # noqa: UP006 - launch files write either
        (item_type,) = typing.get_args(value_type) or (str,)
        if isinstance(value, list):
            return [
                float(item)
                if item_type is float and type(item) is int
                else checked_value(str(item) if item_type is str else item, item_type, place)
                for item in value
            ]
    return checked_value(value, value_type, place)


def checked_value(value: Any, value_type: Any, place: Place | None) -> Any:
    """A value that is there already, after a look at its type.

    Raises:
        LinkwrightError: LAUNCH132, if it has another type than is asked for.
    """
    if value_type is None or (typing.get_origin(value_type) is not None and isinstance(value, (list, tuple))):
        return list(value) if isinstance(value, tuple) else value
    if type(value) is value_type:
        return value
    expected = getattr(value_type, "__name__", str(value_type))
    raise error_at(place, "LAUNCH132", f"the value {value!r} is {_kind(value)}, not the {expected} that is asked for")


def yaml_value(text: str, name: str, place: Place | None) -> Any:
    """A text by YAML's rules, as launch_ros reads parameters whose type is not said.

    Raises:
        LinkwrightError: LAUNCH132, if it is not YAML, or gives something that no parameter can be.
    """
    import yaml

    fix = "say that it is text: ParameterValue(VALUE, value_type=str), from launch_ros.parameter_descriptions"
    try:
        value = yaml.safe_load(text)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        problem = getattr(error, "problem", None) or str(error).splitlines()[0]
        at = f" in its line {mark.line + 1}, column {mark.column + 1}" if mark else ""
        message = f"parameter '{name}' is read as YAML, because its type is not said, and is none: {problem}{at}"
        raise error_at(place, "LAUNCH132", message, fix) from error
    if isinstance(value, str):
        # YAML folds the lines of a text. XML means the same either way, and positions in it stay right like
        # this.
        return text if text.lstrip().startswith("<") else value
    if isinstance(value, SCALARS) or (isinstance(value, list) and _is_uniform(value)):
        return value
    message = f"parameter '{name}' is read as YAML, because its type is not said, and becomes {_kind(value)}"
    raise error_at(place, "LAUNCH132", f"{message}, which no parameter can be", fix)


def _is_uniform(values: Sequence[Any]) -> bool:
    kinds = {type(value) for value in values}
    return len(kinds) <= 1 and kinds <= set(SCALARS)


def uniform_list(values: Iterable[Any]) -> list[Any]:
    """A list as launch_ros makes its items alike: floats where numbers are mixed, else texts."""
    items = list(values)
    kinds = {type(item) for item in items}
    if kinds <= {int, float} and len(kinds) == 2:
        return [float(item) for item in items]
    if len(kinds) <= 1:
        return items
    return [str(item).lower() if isinstance(item, bool) else str(item) for item in items]


def _kind(value: Any) -> str:
    names = {dict: "a mapping", list: "a list of mixed items", type(None): "nothing"}
    return names.get(type(value), f"of type {type(value).__name__}")
