"""Values of node parameters, which may be known only when the launch runs (``launch_ros.parameter_descriptions``).

A substitution is text; which type the parameter gets is decided by ``value_type``, or by YAML's rules where that is not
given, as in launch_ros.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from linkwright.diagnostics import LinkwrightError
from linkwright.launch.context import LaunchContext
from linkwright.launch.frontend.values import normalize_typed_substitution, perform_typed_substitution
from linkwright.launch.places import Place, error_at, located
from linkwright.launch.substitution import (
    SomeSubstitutionsType,
    Substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

SCALARS = (bool, int, float, str)
AS_TEXT = "say that it is text: ParameterValue(VALUE, value_type=str), from launch_ros.parameter_descriptions"

_UNIFORM = (
    "Expected a non-empty sequence, with items of uniform type. Allowed sequence item types are bool, int, float, str."
)
_ALLOWED = (
    "Allowed value types are bytes, bool, int, float, str, Sequence[bool], Sequence[int], Sequence[float], "
    "Sequence[str]. Got {}."
)


class ParameterValue:
    """A value with the type that it is to have.

    Args:
        value: the value, or substitutions that give it as text.
        value_type: bool, int, float, str, or a list of one of these such as ``List[int]``; None for YAML's rules.

    Raises:
        TypeError: the value cannot be of that type.
    """

    def __init__(self, value: Any, *, value_type: Any = None) -> None:
        self.place = Place.of_caller()
        try:
            self._value = normalize_typed_substitution(value, value_type)
        except (TypeError, ValueError) as error:
            raise error_at(self.place, "LAUNCH132", f"the value of a parameter: {error}", promises=error) from error
        self._value_type = value_type
        self._evaluated: Any = None

    @property
    def value(self) -> Any:
        """The value as it was given, with substitutions as lists; once it was evaluated, what came out."""
        return self._value if self._evaluated is None else self._evaluated

    @property
    def value_type(self) -> Any:
        """The type it is to have."""
        return self._value_type

    def evaluate(self, context: LaunchContext, name: str | None = None) -> Any:
        """The value in its type.

        Args:
            context: where substitutions are performed.
            name: of the parameter, for messages.

        Raises:
            LinkwrightError: LAUNCH132, if the text is no such value; ValueError or TypeError too, as launch_ros has it.
        """
        called = f"parameter '{name}'" if name else "the value of a parameter"
        try:
            self._evaluated = perform_typed_substitution(context, self._value, self._value_type)
        except LinkwrightError as error:
            raise located(error, self.place) from error
        except (TypeError, ValueError) as error:
            expected = getattr(self._value_type, "__name__", None) or str(self._value_type)
            if self._value_type is None:
                message = f"{called} is read as YAML, because its type is not said: {error}"
                raise error_at(self.place, "LAUNCH132", message, AS_TEXT, promises=error) from error
            message = f"{called} is not the {expected} that is asked for: {error}"
            raise error_at(self.place, "LAUNCH132", message, promises=error) from error
        return self._evaluated


class Parameter:
    """A name and a value, for ``parameters`` of a node.

    Args:
        name: the name.
        value: see `ParameterValue`.
        value_type: see `ParameterValue`.
    """

    def __init__(self, name: SomeSubstitutionsType, value: Any, *, value_type: Any = None) -> None:
        self._name = normalize_to_list_of_substitutions(name)
        self._parameter_value = ParameterValue(value, value_type=value_type)
        self._rule: tuple[str, Any] | None = None

    @property
    def place(self) -> Place | None:
        """Where it was written."""
        return self._parameter_value.place

    @property
    def name(self) -> list[Substitution] | str:
        """The name as substitutions; once it was evaluated, as text."""
        return self._name if self._rule is None else self._rule[0]

    @property
    def value(self) -> Any:
        """The value, see `ParameterValue.value`."""
        return self._parameter_value.value

    @property
    def value_type(self) -> Any:
        """The type it is to have."""
        return self._parameter_value.value_type

    def evaluate(self, context: LaunchContext) -> tuple[str, Any]:
        """Name and value.

        Raises:
            LinkwrightError: LAUNCH132, if the text is no such value.
        """
        if self._rule is None:
            name = perform_substitutions(context, self._name)
            self._rule = name, self._parameter_value.evaluate(context, name)
        return self._rule


def yaml_value(text: str, name: str, place: Place | None) -> Any:
    """A text by YAML's rules, as launch_ros reads parameters whose type is not said; lists become tuples.

    Raises:
        LinkwrightError: LAUNCH132, it is not YAML, or gives something that no parameter can be; a TypeError too, as
            launch_ros has it.
    """
    value = _loaded(text, name, place)
    if value is None:
        return ""
    if isinstance(value, str):
        # YAML folds the lines of a text. XML means the same either way, and positions in it stay right like this.
        return text if text.lstrip().startswith("<") else value
    if isinstance(value, (*SCALARS, bytes)):
        return value
    if isinstance(value, list):
        return uniform(value, name, place)
    kind = _kind(value)
    message = f"parameter '{name}' is read as YAML, because its type is not said, and becomes {kind}"
    promised = TypeError(_ALLOWED.format(type(value)))
    raise error_at(place, "LAUNCH132", f"{message}, which no parameter can be", AS_TEXT, promises=promised)


def uniform(items: Sequence[Any], name: str, place: Place | None) -> tuple[Any, ...]:
    """Items of one type, of those that lists of parameters may have.

    Raises:
        LinkwrightError: LAUNCH132, they are not, or there is none; a TypeError too, as launch_ros has it.
    """
    kinds = {type(item) for item in items}
    if len(kinds) == 1 and kinds <= set(SCALARS):
        return tuple(items)
    if not items:
        found = "an empty list, whose type nobody can tell"
    else:
        listed = sorted(kind.__name__ for kind in kinds)
        found = (
            f"a list of mixed items ({', '.join(listed)})" if len(kinds) > 1 else f"a list of items of type {listed[0]}"
        )
    message = f"parameter '{name}' becomes {found}, which no parameter can be"
    raise error_at(
        place, "LAUNCH132", message, "give all items one type: bool, int, float or str", promises=TypeError(_UNIFORM)
    )


def _loaded(text: str, name: str, place: Place | None) -> Any:
    import yaml

    try:
        return yaml.load(text, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))  # noqa: S506 - the safe one, in C
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        problem = getattr(error, "problem", None) or str(error).splitlines()[0]
        at = f" in its line {mark.line + 1}, column {mark.column + 1}" if mark else ""
        message = f"parameter '{name}' is read as YAML, because its type is not said, and is none: {problem}{at}"
        promised = TypeError(
            f"Unable to parse the value of parameter {name} as yaml. If the parameter is meant to be a string, try "
            "wrapping it in launch_ros.parameter_descriptions.ParameterValue(value, value_type=str)"
        )
        raise error_at(place, "LAUNCH132", message, AS_TEXT, promises=promised) from error


def _kind(value: Any) -> str:
    names = {dict: "a mapping", list: "a list of mixed items", type(None): "nothing"}
    return names.get(type(value), f"of type {type(value).__name__}")
