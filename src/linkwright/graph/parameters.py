"""Node parameters: typed values that are declared, read, and changed with the node's consent."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean


class ParameterType(Enum):
    """The types that a parameter can have; numbers as in rcl_interfaces/msg/ParameterType."""

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
    def of(cls, value: object) -> ParameterType:
        """The type of a Python value; an empty list counts as one of strings.

        Raises:
            TypeError: a parameter cannot have that value.
        """
        if value is None:
            return cls.NOT_SET
        if type(value) in _SCALARS:
            return _SCALARS[type(value)]
        if isinstance(value, bytes):
            return cls.BYTE_ARRAY
        if isinstance(value, (list, tuple)):
            element_types = {type(element) for element in value} or {str}
            if len(element_types) == 1 and (found := _ARRAYS.get(element_types.pop())):
                return found
        raise TypeError(f"{value!r} is not a value that a parameter can have")

    def accepts(self, value: object) -> bool:
        """Whether a parameter of this type may be set to a value; any array takes an empty list."""
        if value in ([], ()) and self in _ARRAYS.values():
            return True
        return ParameterType.of(value) is self

    def __str__(self) -> str:
        return self.name.lower().replace("not_set", "not set")


_SCALARS: dict[type, ParameterType] = {
    bool: ParameterType.BOOL,
    int: ParameterType.INTEGER,
    float: ParameterType.DOUBLE,
    str: ParameterType.STRING,
}
_ARRAYS: dict[type, ParameterType] = {
    bool: ParameterType.BOOL_ARRAY,
    int: ParameterType.INTEGER_ARRAY,
    float: ParameterType.DOUBLE_ARRAY,
    str: ParameterType.STRING_ARRAY,
}


class Parameter:
    """A name and a value.

    Args:
        name: the parameter's name; dots separate levels.
        type_: its type; worked out from the value when left out.
        value: bool, int, float, str, bytes, a list of one of the first four, or None for one that is not set.

    Raises:
        TypeError: a parameter cannot have that value.
        ValueError: type and value do not agree.
    """

    Type = ParameterType

    __slots__ = ("name", "type_", "value")

    def __init__(self, name: str, type_: ParameterType | None = None, value: Any = None) -> None:
        if type_ is not None and not type_.accepts(value):
            raise ValueError(f"parameter '{name}' is of type {type_}, which {value!r} is not")
        self.name = name
        self.type_ = ParameterType.of(value) if type_ is None else type_
        self.value: Any = list(value) if isinstance(value, (list, tuple)) else value

    def __repr__(self) -> str:
        return f"Parameter({self.name!r}, {self.type_.name}, {self.value!r})"


@dataclass(frozen=True, slots=True)
class ParameterDescriptor:
    """What a node says of a parameter it declares.

    Attributes:
        type: the type, where the default value does not show it (an empty list).
        description: what the parameter is for.
        read_only: it has the value it was declared with for good.
    """

    type: ParameterType | None = None
    description: str = ""
    read_only: bool = False


@dataclass(frozen=True, slots=True)
class SetParametersResult:
    """Whether parameters were set, and why not."""

    successful: bool
    reason: str = ""


class ParameterNotDeclaredError(LinkwrightError):
    """A parameter is read that the node has not declared."""

    def __init__(self, name: str, declared: Iterable[str]) -> None:
        super().__init__(
            Diagnostic("GRAPH202", f"parameter '{name}' is not declared", hint=did_you_mean(name, declared))
        )


class ParameterAlreadyDeclaredError(LinkwrightError):
    """A parameter is declared twice."""

    def __init__(self, name: str) -> None:
        super().__init__(Diagnostic("GRAPH203", f"parameter '{name}' is already declared"))


class InvalidParameterTypeError(LinkwrightError):
    """A parameter is given a value of another type than the node declares."""

    def __init__(self, name: str, expected: ParameterType, value: object) -> None:
        reason = _wrong_type(name, expected, value).rstrip(".")
        hint = f"write {value}.0" if expected is ParameterType.DOUBLE and type(value) is int else None
        super().__init__(Diagnostic("GRAPH201", f"parameter '{name}' has invalid type: {reason}", hint=hint))


class InvalidParameterValueError(LinkwrightError):
    """A parameter is given a value that the node refuses; the message is the node's reason."""

    def __init__(self, name: str, reason: str) -> None:
        super().__init__(Diagnostic("GRAPH204", f"parameter '{name}' could not be set: {reason}"))
        self.reason = reason


OnSetParameters = Callable[[list[Parameter]], SetParametersResult]
PostSetParameters = Callable[[list[Parameter]], object]

_ACCEPTED = SetParametersResult(successful=True)


class ParameterStore:
    """The parameters of one node.

    Args:
        overrides: values that take the place of defaults when parameters of these names are declared. Mappings in it
            stand for names with dots: ``{"zeros": {"j": 1.0}}`` gives ``zeros.j``.
    """

    def __init__(self, overrides: Mapping[str, Any]) -> None:
        self._overrides = dict(_flattened(overrides))
        self._parameters: dict[str, Parameter] = {}
        self._descriptors: dict[str, ParameterDescriptor] = {}
        self.on_set: list[OnSetParameters] = []
        self.post_set: list[PostSetParameters] = []

    @property
    def overrides(self) -> Mapping[str, Any]:
        """The overrides by full name."""
        return self._overrides

    def declare(self, name: str, value: Any, descriptor: ParameterDescriptor | None) -> Parameter:
        """Create a parameter with its override or else the default given; see ``Node.declare_parameter``."""
        if name in self._parameters:
            raise ParameterAlreadyDeclaredError(name)
        descriptor = descriptor or ParameterDescriptor()
        declared = descriptor.type or ParameterType.of(value)
        initial = self._overrides.get(name, value)
        try:
            agrees = initial is None or declared is ParameterType.NOT_SET or declared.accepts(initial)
        except TypeError as error:
            raise InvalidParameterValueError(name, str(error)) from None
        if not agrees:
            raise InvalidParameterTypeError(name, declared, initial)
        parameter = Parameter(name, None if initial is None or declared is ParameterType.NOT_SET else declared, initial)
        verdict = self._ask([parameter])
        if not verdict.successful:
            raise InvalidParameterValueError(name, verdict.reason)
        self._parameters[name] = parameter
        self._descriptors[name] = descriptor
        return parameter

    def get(self, name: str) -> Parameter:
        """A declared parameter."""
        parameter = self._parameters.get(name)
        if parameter is None:
            raise ParameterNotDeclaredError(name, self._parameters)
        return parameter

    def names(self) -> list[str]:
        """Names of all declared parameters, in order of declaration."""
        return list(self._parameters)

    def with_prefix(self, prefix: str) -> dict[str, Parameter]:
        """The parameters below a prefix, by the rest of their names after its dot."""
        start = f"{prefix}."
        return {name[len(start) :]: parameter for name, parameter in self._parameters.items() if name.startswith(start)}

    def set_together(self, parameters: Sequence[Parameter]) -> SetParametersResult:
        """Set all of them or, if one cannot be set, none."""
        for parameter in parameters:
            objection = self._objection(parameter)
            if objection:
                return SetParametersResult(successful=False, reason=objection)
        verdict = self._ask(list(parameters))
        if not verdict.successful:
            return verdict
        for parameter in parameters:
            self._parameters[parameter.name] = parameter
        for callback in tuple(self.post_set):
            callback(list(parameters))
        return _ACCEPTED

    def _objection(self, parameter: Parameter) -> str | None:
        declared = self._parameters.get(parameter.name)
        if declared is None:
            return f"parameter '{parameter.name}' cannot be set because it was not declared"
        if self._descriptors[parameter.name].read_only:
            return f"parameter '{parameter.name}' cannot be set because it is read-only"
        if declared.type_ is not ParameterType.NOT_SET and not declared.type_.accepts(parameter.value):
            return _wrong_type(parameter.name, declared.type_, parameter.value)
        return None

    def _ask(self, parameters: list[Parameter]) -> SetParametersResult:
        for callback in tuple(self.on_set):
            verdict = callback(parameters)
            if not verdict.successful:
                return verdict
        return _ACCEPTED


def _wrong_type(name: str, expected: ParameterType, value: object) -> str:
    return (
        f"Wrong parameter type, parameter {{{name}}} is of type {{{expected}}}, "
        f"setting it to {{{ParameterType.of(value)}}} is not allowed."
    )


def _flattened(values: Mapping[str, Any], prefix: str = "") -> Iterable[tuple[str, Any]]:
    for name, value in values.items():
        if isinstance(value, Mapping):
            yield from _flattened(value, f"{prefix}{name}.")
        else:
            yield prefix + name, value
