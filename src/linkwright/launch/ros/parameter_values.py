"""Values of node parameters (``launch_ros.parameter_descriptions``).

The values may contain substitutions, which evaluate to text. As in launch_ros, ``value_type`` is the type of the
parameter. Without ``value_type``, YAML's rules determine the type.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from linkwright.diagnostics import LinkwrightError, Phrase, foreign, joined, phrase
from linkwright.launch.errors.locations import Located, SourceLocation, error_at, with_location
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.markup.values import normalize_typed_substitution, perform_typed_substitution
from linkwright.launch.model.substitution import (
    SomeSubstitutionsType,
    Substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

SCALARS = (bool, int, float, str)
STRING_HINT = phrase(
    "declare it as a string: ParameterValue(VALUE, value_type=str), from launch_ros.parameter_descriptions"
)

_UNIFORM_TEXT = (
    "Expected a non-empty sequence, with items of uniform type. Allowed sequence item types are bool, int, float, str."
)
_ALLOWED_TEXT = (
    "Allowed value types are bytes, bool, int, float, str, Sequence[bool], Sequence[int], Sequence[float], "
    "Sequence[str]. Got {}."
)


class ParameterValue(Located):
    """The value of a parameter, with an optional type.

    Args:
        value: the value, or substitutions that evaluate to the text of the value.
        value_type: bool, int, float, str, or a list of one of these such as ``List[int]``; None to apply YAML's rules.

    Raises:
        TypeError: the value cannot have this type.
    """

    def __init__(self, value: Any, *, value_type: Any = None) -> None:
        try:
            self._value = normalize_typed_substitution(value, value_type)
        except (TypeError, ValueError) as error:
            raise error_at(
                self.source_location,
                "LAUNCH132",
                phrase("the value of a parameter is not valid: {error}", error=foreign(error)),
                ros_error=error,
            ) from error
        self._value_type = value_type
        self._evaluated: Any = None

    @property
    def value(self) -> Any:
        """The normalized value, or the evaluated value after a call of `evaluate`."""
        return self._value if self._evaluated is None else self._evaluated

    @property
    def value_type(self) -> Any:
        """The type of the value, or None to apply YAML's rules."""
        return self._value_type

    def evaluate(self, context: LaunchContext, name: str | None = None) -> Any:
        """Evaluate the substitutions, and return the value in the requested type.

        Args:
            context: the launch context for the substitutions.
            name: the name of the parameter, for messages; None if it is not known.

        Raises:
            LinkwrightError: LAUNCH132, the text is not a value of the type. As in launch_ros, the error is also a
                ValueError or TypeError.
        """
        subject = phrase("parameter '{name}'", name=name) if name else phrase("the value of a parameter")
        try:
            self._evaluated = perform_typed_substitution(context, self._value, self._value_type)
        except LinkwrightError as error:
            raise with_location(error, self.source_location) from error
        except (TypeError, ValueError) as error:
            expected = getattr(self._value_type, "__name__", None) or str(self._value_type)
            if self._value_type is None:
                message = phrase(
                    "{subject} has no type and is not YAML: {error}",
                    subject=subject,
                    error=foreign(error),
                )
                raise error_at(self.source_location, "LAUNCH132", message, STRING_HINT, ros_error=error) from error
            message = phrase(
                "{subject} is not of the requested type {expected}: {error}",
                subject=subject,
                expected=expected,
                error=foreign(error),
            )
            raise error_at(self.source_location, "LAUNCH132", message, ros_error=error) from error
        return self._evaluated


class Parameter:
    """A parameter in the ``parameters`` of a node.

    Args:
        name: the name of the parameter.
        value: see `ParameterValue`.
        value_type: see `ParameterValue`.
    """

    def __init__(self, name: SomeSubstitutionsType, value: Any, *, value_type: Any = None) -> None:
        self._name = normalize_to_list_of_substitutions(name)
        self._parameter_value = ParameterValue(value, value_type=value_type)
        self._rule: tuple[str, Any] | None = None

    @property
    def source_location(self) -> SourceLocation | None:
        """The location of the parameter in the launch file, or None."""
        return self._parameter_value.source_location

    @property
    def name(self) -> list[Substitution] | str:
        """The name as substitutions, or as text after a call of `evaluate`."""
        return self._name if self._rule is None else self._rule[0]

    @property
    def value(self) -> Any:
        """The value, as in `ParameterValue.value`."""
        return self._parameter_value.value

    @property
    def value_type(self) -> Any:
        """The type of the value, or None to apply YAML's rules."""
        return self._parameter_value.value_type

    def evaluate(self, context: LaunchContext) -> tuple[str, Any]:
        """Return the evaluated name and value.

        Raises:
            LinkwrightError: LAUNCH132, the text is not a value of the type.
        """
        if self._rule is None:
            name = perform_substitutions(context, self._name)
            self._rule = name, self._parameter_value.evaluate(context, name)
        return self._rule


def parse_yaml_value(text: str, name: str, location: SourceLocation | None) -> Any:
    """Return the value of a parameter without a type.

    As in launch_ros, the text is read as YAML.

    Lists become tuples.

    Raises:
        LinkwrightError: LAUNCH132, the text is not YAML, or its value is not valid for a parameter. As in launch_ros,
            the error is also a TypeError.
    """
    value = _load_yaml(text, name, location)
    if value is None:
        return ""
    if isinstance(value, str):
        # YAML folds the lines of a plain text. XML is returned unfolded, which has the same meaning and keeps its
        # locations correct.
        return text if text.lstrip().startswith("<") else value
    if isinstance(value, (*SCALARS, bytes)):
        return value
    if isinstance(value, list):
        return to_uniform_tuple(value, name, location)
    message = phrase(
        "parameter '{name}' has no type; read as YAML, its value is {kind}, which is not a parameter type",
        name=name,
        kind=_describe_type(value),
    )
    ros_error = TypeError(_ALLOWED_TEXT.format(type(value)))
    raise error_at(location, "LAUNCH132", message, STRING_HINT, ros_error=ros_error)


def to_uniform_tuple(items: Sequence[Any], name: str, location: SourceLocation | None) -> tuple[Any, ...]:
    """Return the items of a list parameter as a tuple, if they all have the same valid type.

    Raises:
        LinkwrightError: LAUNCH132, the types differ or are not valid, or the list is empty. As in launch_ros, the
            error is also a TypeError.
    """
    item_types = {type(item) for item in items}
    if len(item_types) == 1 and item_types <= set(SCALARS):
        return tuple(items)
    if not items:
        description = phrase("an empty list, whose type is unknown")
    elif len(item_types) > 1:
        description = phrase(
            "a list of mixed items ({kinds})", kinds=joined(sorted(item_type.__name__ for item_type in item_types))
        )
    else:
        description = phrase("a list of items of type {kind}", kind=next(iter(item_types)).__name__)
    message = phrase("parameter '{name}' is {found}, which is not a parameter type", name=name, found=description)
    raise error_at(
        location,
        "LAUNCH132",
        message,
        phrase("give all items one type: bool, int, float or str"),
        ros_error=TypeError(_UNIFORM_TEXT),
    )


def _load_yaml(text: str, name: str, location: SourceLocation | None) -> Any:
    import yaml

    try:
        return yaml.load(text, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))  # noqa: S506 - the safe loader, in C
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        reason = getattr(error, "problem", None) or str(error).splitlines()[0]
        reason = foreign(reason)
        if mark is not None:
            reason = phrase(
                "{problem} in line {line}, column {column} of its value",
                problem=reason,
                line=mark.line + 1,
                column=mark.column + 1,
            )
        message = phrase(
            "parameter '{name}' has no type and is not YAML: {problem}",
            name=name,
            problem=reason,
        )
        ros_error = TypeError(
            f"Unable to parse the value of parameter {name} as yaml. If the parameter is meant to be a string, try "
            "wrapping it in launch_ros.parameter_descriptions.ParameterValue(value, value_type=str)"
        )
        raise error_at(location, "LAUNCH132", message, STRING_HINT, ros_error=ros_error) from error


def _describe_type(value: Any) -> Phrase:
    names = {dict: phrase("a mapping"), list: phrase("a list of mixed items"), type(None): phrase("nothing")}
    return names.get(type(value)) or phrase("of type {type_name}", type_name=type(value).__name__)
