"""The types, values and exceptions of ``rclpy.parameter``, and values by node name."""

from __future__ import annotations

import array
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from enum import Enum
from functools import cache, lru_cache
from types import GenericAlias
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, did_you_mean, foreign, phrase

ANY_NODE = "/**"


class ParameterRules:
    """Parameter values by node name pattern.

    A pattern is a node's full name, in which ``*`` matches one part and ``**`` any number of parts. As in rcl, patterns
    are ordered by their first appearance. If two patterns match a node, the later one applies.

    Attributes:
        files: the paths of the parameter files from which the values were read.
        skipped_findings: patterns, each with a finding about a parameter that is not set because its value is not
            allowed.
    """

    def __init__(self) -> None:
        self._values: dict[str, dict[str, Any]] = {}
        self.files: list[str] = []
        self.skipped_findings: list[tuple[str, Diagnostic]] = []

    def __bool__(self) -> bool:
        return bool(self._values)

    def __iter__(self) -> Iterator[tuple[str, Mapping[str, Any]]]:
        """Iterate over the patterns, each with its values by parameter name."""
        return iter(self._values.items())

    def set(self, pattern: str, name: str, value: Any) -> None:
        """Set a parameter's value for a pattern, replacing an earlier value for the same pattern."""
        self.section(pattern)[name] = value

    def section(self, pattern: str) -> dict[str, Any]:
        """Return the values for a pattern, as a dictionary to which values may be added.

        If the pattern has no leading slash, one is added.
        """
        return self._values.setdefault(pattern if pattern.startswith("/") else f"/{pattern}", {})

    def add(self, other: ParameterRules) -> None:
        """Add other rules, whose values override earlier values for the same pattern."""
        for pattern, values in other:
            self.section(pattern).update(values)
        self.files += other.files
        self.skipped_findings += other.skipped_findings

    @property
    def patterns(self) -> list[str]:
        """The patterns, in the order in which they apply."""
        return list(self._values)

    def matches_node(self, full_name: str) -> bool:
        """Return whether any pattern matches a node."""
        return any(_compile_pattern(pattern).fullmatch(full_name) for pattern in self._values)

    def unmatched_patterns(self, full_names: Iterable[str]) -> list[str]:
        """Return the patterns that match none of the given nodes."""
        names = list(full_names)
        return [value for value in self._values if not any(map(_compile_pattern(value).fullmatch, names))]

    def for_node(self, full_name: str) -> dict[str, Any]:
        """Return the values for a node, by parameter name.

        Args:
            full_name: the node's namespace and name, such as ``/robot/talker``.
        """
        node_values: dict[str, Any] = {}
        for pattern, values in self._values.items():
            if _compile_pattern(pattern).fullmatch(full_name):
                node_values.update(values)
        return node_values

    def skipped_findings_for(self, full_name: str) -> list[Diagnostic]:
        """Return the findings about a node's parameters that are not set.

        Their values are not allowed.
        """
        return [finding for pattern, finding in self.skipped_findings if _compile_pattern(pattern).fullmatch(full_name)]


@lru_cache(maxsize=256)
def _compile_pattern(pattern: str) -> re.Pattern[str]:
    while "/**/**" in pattern:  # Equivalent to a single ``/**``, but many of them take very long to match.
        pattern = pattern.replace("/**/**", "/**")
    escaped = re.escape(pattern).replace(r"/\*\*", r"(/\w+)*").replace(r"/\*", r"(/\w+)")
    return re.compile(escaped)


class ParameterException(LinkwrightError):  # noqa: N818  # rclpy's name, which users' code catches
    """The base of rclpy's parameter exceptions.

    Args:
        error_msg: what is wrong.
        parameters: the name or names of the parameters concerned.
        code: the code of the finding.
        hint: how to fix the mistake.
    """

    def __init__(
        self, error_msg: Phrase, parameters: str | list[str], *, code: str = "GRAPH201", hint: Phrase | None = None
    ) -> None:
        super().__init__(
            Diagnostic(code, phrase("{error_msg}: {parameters}", error_msg=error_msg, parameters=parameters), hint=hint)
        )


class ParameterNotDeclaredException(ParameterException):
    """Raised when a parameter is used that the node has not declared.

    Args:
        parameters: the name of the parameter, or several names.
        declared_names: the declared names, for the hint.
    """

    def __init__(self, parameters: str | list[str], declared_names: Iterable[str] = ()) -> None:
        first_name = parameters if isinstance(parameters, str) else next(iter(parameters), "")
        hint = did_you_mean(first_name, declared_names) or phrase(
            "declare it first: self.declare_parameter('{name}', DEFAULT)", name=first_name
        )
        super().__init__(phrase("Invalid access to undeclared parameter(s)"), parameters, code="GRAPH202", hint=hint)


class ParameterAlreadyDeclaredException(ParameterException):
    """Raised when a parameter is declared twice."""

    def __init__(self, parameters: str | list[str]) -> None:
        super().__init__(phrase("Parameter(s) already declared"), parameters, code="GRAPH203")


class InvalidParameterException(ParameterException):
    """Raised when a parameter is declared with a name that is not valid."""

    def __init__(self, parameter_name: str) -> None:
        super().__init__(phrase("Invalid parameter name"), parameter_name, code="GRAPH205")


class InvalidParameterTypeException(ParameterException):
    """Raised when a parameter is set to a value of another type than the declared one.

    Args:
        desired_parameter: the parameter with the refused value.
        expected_type: the name of the declared type.
    """

    def __init__(self, desired_parameter: Parameter, expected_type: object) -> None:
        name, value = desired_parameter.name, desired_parameter.value
        expected_name = getattr(expected_type, "name", expected_type)
        hint = phrase("write {text}.0", text=value) if expected_name == "DOUBLE" and type(value) is int else None
        super().__init__(
            phrase(
                "Trying to set parameter '{name}' to '{value}' of type '{type_name}', expecting type '{expected}'",
                name=name,
                value=value,
                type_name=desired_parameter.type_.name,
                expected=expected_name,
            ),
            name,
            code="GRAPH201",
            hint=hint,
        )


class InvalidParameterValueException(ParameterException):
    """Raised when a callback or the descriptor refuses a parameter's value.

    Args:
        parameter: the parameter's name.
        value: the value.
        reason: why it is refused.
    """

    def __init__(self, parameter: str, value: Any, reason: str) -> None:
        super().__init__(
            phrase(
                "Invalid parameter value ({value}) for parameter. Reason: {reason}", value=value, reason=foreign(reason)
            ),
            parameter,
            code="GRAPH204",
        )
        self.reason = reason


class ParameterImmutableException(ParameterException):
    """Raised when a call would change a read-only parameter."""

    def __init__(self, parameter_name: str) -> None:
        super().__init__(phrase("Attempted to modify read-only parameter"), parameter_name, code="GRAPH206")


class ParameterUninitializedException(ParameterException):
    """Raised when a parameter that was declared with a type only is read before it has a value."""

    def __init__(self, parameter_name: str) -> None:
        super().__init__(
            phrase("The parameter '{name}' is not initialized", name=parameter_name),
            parameter_name,
            code="GRAPH207",
            hint=phrase("declare the parameter with a default, or set it in a parameter file or with -p"),
        )


class ParameterFileNotFoundError(LinkwrightError, FileNotFoundError):
    """Raised when a parameter file does not exist."""


PARAMETER_SEPARATOR_STRING = "."


class ParameterType(Enum):
    """The types of parameters, with the numbers of rcl_interfaces/msg/ParameterType."""

    NOT_SET = 0
    BOOL = 1
    INTEGER = 2
    DOUBLE = 3
    STRING = 4
    BYTE_ARRAY = 5
    BOOL_ARRAY = 6
    INTEGER_ARRAY = 7
    DOUBLE_ARRAY = 8
    STRING_ARRAY = 9

    @classmethod
    def from_parameter_value(cls, parameter_value: Any) -> ParameterType:
        """Return the type of a Python value.

        An empty list counts as a byte array, as in rclpy.

        Raises:
            TypeError: the value is not a valid parameter value.
        """
        if parameter_value is None:
            return cls.NOT_SET
        for parameter_type, classes in _SCALARS:
            if isinstance(parameter_value, classes):
                return parameter_type
        if not isinstance(parameter_value, (list, tuple, array.array)):
            raise TypeError(
                phrase(
                    "The given value is not one of the allowed types '{parameter_value}'.",
                    parameter_value=parameter_value,
                )
            )
        for parameter_type, element in _ARRAYS:
            if all(isinstance(value, element) for value in parameter_value):
                return parameter_type
        raise TypeError(
            phrase(
                "The given value is not a list of one of the allowed types '{parameter_value}'.",
                parameter_value=parameter_value,
            )
        )

    def check(self, parameter_value: Any) -> bool:
        """Return whether a value is valid for a parameter of this type.

        Every array type accepts an empty list.
        """
        if self is ParameterType.NOT_SET:
            return parameter_value is None
        for parameter_type, classes in _SCALARS:
            if self is parameter_type and isinstance(parameter_value, classes):
                return True
        for parameter_type, element in _ARRAYS:
            if self is parameter_type and isinstance(parameter_value, (list, tuple, array.array)):
                return all(isinstance(value, element) for value in parameter_value)
        return False

    @property
    def is_array(self) -> bool:
        """Whether values of the type are lists."""
        return self.value >= ParameterType.BYTE_ARRAY.value

    def __str__(self) -> str:
        # rclpy's nested class has this text, which appears in the reasons of refusals.
        return f"Type.{self.name}"


_SCALARS = (
    (ParameterType.BOOL, bool),
    (ParameterType.INTEGER, int),
    (ParameterType.DOUBLE, float),
    (ParameterType.STRING, str),
    (ParameterType.BYTE_ARRAY, bytes),
)
_ARRAYS = (
    (ParameterType.BYTE_ARRAY, bytes),
    (ParameterType.BOOL_ARRAY, bool),
    (ParameterType.INTEGER_ARRAY, int),
    (ParameterType.DOUBLE_ARRAY, float),
    (ParameterType.STRING_ARRAY, str),
)
VALUE_FIELDS = {
    ParameterType.BOOL: "bool_value",
    ParameterType.INTEGER: "integer_value",
    ParameterType.DOUBLE: "double_value",
    ParameterType.STRING: "string_value",
    ParameterType.BYTE_ARRAY: "byte_array_value",
    ParameterType.BOOL_ARRAY: "bool_array_value",
    ParameterType.INTEGER_ARRAY: "integer_array_value",
    ParameterType.DOUBLE_ARRAY: "double_array_value",
    ParameterType.STRING_ARRAY: "string_array_value",
}
"""The field of rcl_interfaces/msg/ParameterValue for each type."""


class Parameter:
    """A parameter with its name, type and value.

    Args:
        name: the parameter's name; dots separate levels.
        type_: the parameter's type; by default derived from the value.
        value: bool, int, float, str, bytes, a list of one of these, or None for a parameter that is not set.

    Raises:
        TypeError: the value is not a valid parameter value.
        ValueError: type and value do not match.
    """

    Type = ParameterType

    __class_getitem__: Any = classmethod(GenericAlias)  # As in rclpy, annotations may name the type of the value.

    __slots__ = ("_name", "_type_", "_value")

    def __init__(self, name: str, type_: ParameterType | None = None, value: Any = None) -> None:
        if type_ is None:
            type_ = ParameterType.from_parameter_value(value)
        if not isinstance(type_, ParameterType):
            raise TypeError(f"type must be an instance of '{ParameterType!r}'")
        if not type_.check(value):
            raise ValueError(f"Type '{type_}' and value '{value}' do not agree")
        self._name = name
        self._type_ = type_
        self._value = value

    @classmethod
    def from_parameter_msg(cls, param_msg: Any) -> Parameter:
        """Convert an rcl_interfaces/msg/Parameter to a parameter, with arrays as Python lists."""
        type_ = ParameterType(param_msg.value.type)
        return cls(param_msg.name, type_, parameter_value_to_python(param_msg.value))

    @property
    def name(self) -> str:
        """The parameter's name."""
        return self._name

    @property
    def type_(self) -> ParameterType:
        """The parameter's type."""
        return self._type_

    @property
    def value(self) -> Any:
        """The parameter's value, or None if it is not set."""
        return self._value

    def get_parameter_value(self) -> Any:
        """Return the value as an rcl_interfaces/msg/ParameterValue."""
        from linkwright.messages import get_message

        message = get_message("rcl_interfaces/msg/ParameterValue")()
        message.type = self._type_.value
        if self._type_ is not ParameterType.NOT_SET:
            setattr(message, VALUE_FIELDS[self._type_], self._message_value())
        return message

    def to_parameter_msg(self) -> Any:
        """Convert the parameter to an rcl_interfaces/msg/Parameter."""
        from linkwright.messages import get_message

        return get_message("rcl_interfaces/msg/Parameter")(name=self._name, value=self.get_parameter_value())

    def _message_value(self) -> Any:
        if self._type_ is ParameterType.BYTE_ARRAY:
            return [bytes([value]) if isinstance(value, int) else value for value in self._value]
        return list(self._value) if self._type_.is_array else self._value

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Parameter):
            return NotImplemented
        return (self._name, self._type_, self._value) == (other._name, other._type_, other._value)

    __hash__ = None  # type: ignore[assignment]  # its value may be a list

    def __repr__(self) -> str:
        return f"Parameter({self._name!r}, {self._type_.name}, {self._value!r})"


def parameter_value_to_python(parameter_value: Any) -> Any:
    """Return the Python value of an rcl_interfaces/msg/ParameterValue.

    Return None if the value is not set.

    Raises:
        RuntimeError: the ``type`` of the message is not known (as in rclpy).
    """
    try:
        type_ = ParameterType(parameter_value.type)
    except ValueError:
        raise RuntimeError(f"unexpected parameter type {parameter_value.type}") from None
    if type_ is ParameterType.NOT_SET:
        return None
    value = getattr(parameter_value, VALUE_FIELDS[type_])
    return list(value) if type_.is_array else value


@dataclass(slots=True)
class Range:
    """The range of a numeric parameter: from `from_value` to `to_value`, both inclusive.

    Unless `step` is 0, values are spaced by `step`, starting from `from_value`.
    """

    from_value: float
    to_value: float
    step: float = 0


@dataclass(slots=True)
class ParameterDescriptor:
    """The description of a parameter.

    An rcl_interfaces/msg/ParameterDescriptor may be used instead.

    Attributes:
        name: the parameter's name; filled in when the parameter is declared.
        type: the number of the parameter's type; filled in from the default value, except for an empty list, whose type
            cannot be determined.
        description: the purpose of the parameter.
        additional_constraints: further constraints on the values, in plain words.
        read_only: whether the parameter keeps the value that it was declared with.
        dynamic_typing: whether values of any type may be set, and setting no value undeclares the parameter.
        floating_point_range: at most one `Range`, for DOUBLE.
        integer_range: at most one `Range`, for INTEGER.
    """

    name: str = ""
    type: int | ParameterType = 0
    description: str = ""
    additional_constraints: str = ""
    read_only: bool = False
    dynamic_typing: bool = False
    floating_point_range: list[Range] | tuple[Range, ...] = ()
    integer_range: list[Range] | tuple[Range, ...] = ()

    def __post_init__(self) -> None:
        if isinstance(self.type, ParameterType):
            self.type = self.type.value


@dataclass(frozen=True, slots=True)
class SetParametersResult:
    """The result of setting parameters: whether it succeeded, and the reason for a refusal.

    An rcl_interfaces/msg/SetParametersResult may be used instead.
    """

    successful: bool
    reason: str = ""


# --- messages of rcl_interfaces, whose classes are created on first use ------------------------------------------


@cache
def get_service_type(service: str) -> str:
    """Return the type name of a parameter service.

    An example is ``rcl_interfaces/srv/GetParameters`` for ``get_parameters``.
    """
    return "rcl_interfaces/srv/" + "".join(word.capitalize() for word in service.split("_"))


def get_message_class(name: str) -> Any:
    """Return a message class of rcl_interfaces."""
    from linkwright.messages import get_message

    return get_message(f"rcl_interfaces/msg/{name}")


def to_descriptor_message(descriptor: Any) -> Any:
    """Convert a descriptor to an rcl_interfaces/msg/ParameterDescriptor.

    A descriptor that is already such a message is returned unchanged.
    """
    descriptor_class = get_message_class("ParameterDescriptor")
    if isinstance(descriptor, descriptor_class):
        return descriptor
    message = descriptor_class(
        name=descriptor.name,
        type=descriptor.type,
        description=descriptor.description,
        additional_constraints=descriptor.additional_constraints,
        read_only=descriptor.read_only,
        dynamic_typing=descriptor.dynamic_typing,
    )
    message.integer_range = [_to_range_message("IntegerRange", limits, int) for limits in descriptor.integer_range]
    message.floating_point_range = [
        _to_range_message("FloatingPointRange", limits, float) for limits in descriptor.floating_point_range
    ]
    return message


def to_result_message(result: Any) -> Any:
    """Convert a result to an rcl_interfaces/msg/SetParametersResult.

    A result that is already such a message is returned unchanged.
    """
    result_class = get_message_class("SetParametersResult")
    if isinstance(result, result_class):
        return result
    return result_class(successful=result.successful, reason=result.reason)


def _to_range_message(name: str, limits: Range, kind: type) -> Any:
    return get_message_class(name)(
        from_value=kind(limits.from_value), to_value=kind(limits.to_value), step=kind(limits.step)
    )
