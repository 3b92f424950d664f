"""The exceptions of parameters: rclpy's, by its names and in its words, with our hints."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, did_you_mean, foreign, phrase

if TYPE_CHECKING:
    from linkwright.graph.parameters.parameter import Parameter


class ParameterException(LinkwrightError):  # noqa: N818  # rclpy's name, which users' code catches
    """The base of rclpy's parameter exceptions.

    Args:
        error_msg: the mistake.
        parameters: the name, or the names, of the parameters concerned.
        code: the diagnostic's code.
        hint: how to fix it.
    """

    def __init__(
        self, error_msg: Phrase, parameters: str | list[str], *, code: str = "GRAPH201", hint: Phrase | None = None
    ) -> None:
        super().__init__(
            Diagnostic(code, phrase("{error_msg}: {parameters}", error_msg=error_msg, parameters=parameters), hint=hint)
        )


class ParameterNotDeclaredException(ParameterException):
    """A parameter is used that the node has not declared.

    Args:
        parameters: its name, or the names of several.
        declared: the names that there are, for the hint.
    """

    def __init__(self, parameters: str | list[str], declared: Iterable[str] = ()) -> None:
        first = parameters if isinstance(parameters, str) else next(iter(parameters), "")
        hint = did_you_mean(first, declared)
        super().__init__(phrase("Invalid access to undeclared parameter(s)"), parameters, code="GRAPH202", hint=hint)


class ParameterAlreadyDeclaredException(ParameterException):
    """A parameter is declared twice."""

    def __init__(self, parameters: str | list[str]) -> None:
        super().__init__(phrase("Parameter(s) already declared"), parameters, code="GRAPH203")


class InvalidParameterException(ParameterException):
    """A parameter is declared under a name that is not valid."""

    def __init__(self, parameter_name: str) -> None:
        super().__init__(phrase("Invalid parameter name"), parameter_name, code="GRAPH205")


class InvalidParameterTypeException(ParameterException):
    """A parameter is given a value of another type than it is declared with.

    Args:
        desired_parameter: the parameter with the value.
        expected_type: the name of the type it is declared with.
    """

    def __init__(self, desired_parameter: Parameter, expected_type: object) -> None:
        name, value = desired_parameter.name, desired_parameter.value
        expected = getattr(expected_type, "name", expected_type)
        hint = phrase("write {value}.0", value=value) if expected == "DOUBLE" and type(value) is int else None
        super().__init__(
            phrase(
                "Trying to set parameter '{name}' to '{value}' of type '{type_name}', expecting type '{expected}'",
                name=name,
                value=value,
                type_name=desired_parameter.type_.name,
                expected=expected,
            ),
            name,
            code="GRAPH201",
            hint=hint,
        )


class InvalidParameterValueException(ParameterException):
    """A parameter is given a value that a callback or its descriptor refuses.

    Args:
        parameter: its name.
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
    """A read-only parameter is to be changed."""

    def __init__(self, parameter_name: str) -> None:
        super().__init__(phrase("Attempted to modify read-only parameter"), parameter_name, code="GRAPH206")


class ParameterUninitializedException(ParameterException):
    """A parameter is read that was declared with a type and has no value yet."""

    def __init__(self, parameter_name: str) -> None:
        super().__init__(
            phrase("The parameter '{name}' is not initialized", name=parameter_name),
            parameter_name,
            code="GRAPH207",
            hint=phrase("give it a default when it is declared, or a value in a parameter file or with -p"),
        )


class ParameterFileNotFoundError(LinkwrightError, FileNotFoundError):
    """There is no parameter file at a path."""
