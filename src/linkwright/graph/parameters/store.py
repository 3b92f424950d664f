"""The parameters of one node, with rclpy's rules for declaring, reading and changing them."""

from __future__ import annotations

import copy
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from math import isclose
from typing import Any

from linkwright.diagnostics import phrase
from linkwright.graph.parameters.parameter import (
    InvalidParameterException,
    InvalidParameterTypeException,
    InvalidParameterValueException,
    Parameter,
    ParameterAlreadyDeclaredException,
    ParameterDescriptor,
    ParameterImmutableException,
    ParameterNotDeclaredException,
    ParameterType,
    ParameterUninitializedException,
    SetParametersResult,
)

_RELATIVE_TOLERANCE = 1e-6
"""The relative tolerance within which floating-point values count as equal (rclpy ``Node.PARAM_REL_TOL``)."""

WRONG_TYPE = "Wrong parameter type"
"""The beginning of every reason that concerns the type of a value."""


def find_refusal_reason(
    parameter: Parameter, descriptor: Any, *, is_declared: bool, check_read_only: bool
) -> str | None:
    """Return the reason why a parameter cannot be set, or None if it can be set.

    Fills in the descriptor's name, and its type if the parameter has dynamic typing.

    Args:
        parameter: the name and the new value.
        descriptor: a `ParameterDescriptor`, or the rcl_interfaces message of the same name.
        is_declared: whether the parameter is declared already.
        check_read_only: whether to refuse a change to a read-only parameter; False while the parameter is being
            declared.
    """
    descriptor.name = parameter.name
    if check_read_only and descriptor.read_only:
        return phrase("Trying to set a read-only parameter: {name}.", name=parameter.name)
    is_set = parameter.type_ is not ParameterType.NOT_SET
    if descriptor.dynamic_typing:
        descriptor.type = parameter.type_.value
    elif is_declared and not is_set:
        return phrase("Static parameter cannot be undeclared")
    elif is_set and parameter.type_.value != descriptor.type:
        return phrase(
            "Wrong parameter type, expected '{expected}' got '{actual}'",
            expected=str(ParameterType(descriptor.type)),
            actual=str(parameter.type_),
        )
    if parameter.type_ is ParameterType.INTEGER and descriptor.integer_range:
        return _check_integer_range(parameter, descriptor.integer_range[0])
    if parameter.type_ is ParameterType.DOUBLE and descriptor.floating_point_range:
        return _check_floating_point_range(parameter, descriptor.floating_point_range[0])
    return None


def _check_integer_range(parameter: Parameter, allowed_range: Any) -> str | None:
    low, high = sorted((allowed_range.from_value, allowed_range.to_value))
    value = parameter.value
    if value in (low, high):
        return None
    if not low < value < high:
        return phrase(
            "Parameter {name} out of range. Min: {low}, Max: {high}, value: {value}",
            name=parameter.name,
            low=low,
            high=high,
            value=value,
        )
    if allowed_range.step != 0 and (value - low) % allowed_range.step != 0:
        return phrase(
            "The parameter value for {name} is not a valid step. Min: {low}, max: {high}, value: {value}, step: {step}",
            name=parameter.name,
            low=low,
            high=high,
            value=value,
            step=allowed_range.step,
        )
    return None


def _check_floating_point_range(parameter: Parameter, allowed_range: Any) -> str | None:
    low, high = sorted((allowed_range.from_value, allowed_range.to_value))
    value = parameter.value
    if isclose(value, low, rel_tol=_RELATIVE_TOLERANCE) or isclose(value, high, rel_tol=_RELATIVE_TOLERANCE):
        return None
    if not low < value < high:
        return phrase(
            "Parameter {name} out of range Min: {low}, Max: {high}, value: {value}",
            name=parameter.name,
            low=low,
            high=high,
            value=value,
        )
    if allowed_range.step != 0.0:
        nearest = low + round((value - low) / allowed_range.step) * allowed_range.step
        if not isclose(nearest, value, rel_tol=_RELATIVE_TOLERANCE):
            return phrase(
                "The parameter value for {name} is not close enough to a valid step."
                " Min: {low}, max: {high}, value: {value}, step: {step}",
                name=parameter.name,
                low=low,
                high=high,
                value=value,
                step=allowed_range.step,
            )
    return None


PreSetParameters = Callable[[list[Parameter]], list[Parameter]]
OnSetParameters = Callable[[list[Parameter]], Any]
"""Returns a `SetParametersResult`, or an rcl_interfaces message of the same name."""
PostSetParameters = Callable[[list[Parameter]], object]

_EMPTY_LIST_MESSAGE = (
    "parameter list cannot be empty, this might be due to pre_set_parameters_callback modifying the original "
    "parameters list."
)
_INVALID_RESULT_MESSAGE = "Callback returned an invalid type"
_NAME_ONLY_WARNING = (
    "when declaring parameter named '{}', declaring a parameter only providing its name is deprecated. You have to "
    'either:\n\t- Pass a name and a default value different to "PARAMETER NOT SET" (and optionally a descriptor).\n'
    "\t- Pass a name and a parameter type.\n\t- Pass a name and a descriptor with `dynamic_typing=True"
)


@dataclass(slots=True)
class ParameterChange:
    """The parameters that a successful call has added, changed or deleted."""

    new: list[Parameter] = field(default_factory=list)
    changed: list[Parameter] = field(default_factory=list)
    deleted: list[Parameter] = field(default_factory=list)


class ParameterStore:
    """The parameters of one node.

    Args:
        overrides: values that replace the defaults when parameters with these names are declared. Nested mappings
            represent dotted names: ``{"zeros": {"j": 1.0}}`` sets ``zeros.j``.
        allow_undeclared: whether undeclared parameters may be set and read.
        on_change: receives each successful change, before the callbacks in `post_set`.

    Attributes:
        pre_set, on_set, post_set: the node's callbacks, in the reverse order of their registration.
    """

    def __init__(
        self,
        overrides: Mapping[str, Any],
        *,
        allow_undeclared: bool = False,
        on_change: Callable[[ParameterChange], None] = lambda _: None,
    ) -> None:
        self.overrides: Mapping[str, Any] = dict(_flatten(overrides))
        self.allow_undeclared = allow_undeclared
        self._on_change = on_change
        self._parameters: dict[str, Parameter] = {}
        self._descriptors: dict[str, Any] = {}
        self.pre_set: list[PreSetParameters] = []
        self.on_set: list[OnSetParameters] = []
        self.post_set: list[PostSetParameters] = []

    def __contains__(self, name: str) -> bool:
        return name in self._parameters

    def names(self) -> list[str]:
        """Return the names of all declared parameters, in order of declaration."""
        return list(self._parameters)

    def declare(
        self, name: str, default: Any, descriptor: Any, *, only_name: bool = False, ignore_override: bool = False
    ) -> Parameter:
        """Declare a parameter with its override, or the given default if there is no override.

        See ``Node.declare_parameter``.
        """
        if not name:
            raise InvalidParameterException(name)
        descriptor = copy.copy(descriptor)  # the same object may be passed for several parameters
        if only_name:
            warnings.warn(_NAME_ONLY_WARNING.format(name), stacklevel=4)
            descriptor.dynamic_typing = True
        value = self._determine_type(name, default, descriptor)
        if not ignore_override and name in self.overrides:
            value = self.overrides[name]
        parameter = _make_parameter(name, value, descriptor)
        if name in self._parameters:
            raise ParameterAlreadyDeclaredException([name])
        result = self._set([parameter], descriptors={name: descriptor}, keep_unset=True)
        if not result.successful:
            if result.reason.startswith(WRONG_TYPE):
                raise InvalidParameterTypeException(parameter, ParameterType(descriptor.type))
            raise InvalidParameterValueException(name, parameter.value, result.reason)
        return self._parameters[name]

    def undeclare(self, name: str) -> None:
        """Undeclare a parameter. See ``Node.undeclare_parameter``."""
        if name not in self._parameters:
            raise ParameterNotDeclaredException(name, self._parameters)
        if self._descriptors[name].read_only:
            raise ParameterImmutableException(name)
        del self._parameters[name], self._descriptors[name]

    def get(self, name: str) -> Parameter:
        """Return a parameter. See ``Node.get_parameter``."""
        parameter = self._parameters.get(name)
        if parameter is not None:
            if parameter.type_ is ParameterType.NOT_SET and not self._descriptors[name].dynamic_typing:
                raise ParameterUninitializedException(name)
            return parameter
        if self.allow_undeclared:
            return Parameter(name)
        raise ParameterNotDeclaredException(name, self._parameters)

    def get_if_set(self, name: str) -> Parameter | None:
        """Return a parameter if it has a value, otherwise None."""
        parameter = self._parameters.get(name)
        return None if parameter is None or parameter.type_ is ParameterType.NOT_SET else parameter

    def get_type(self, name: str) -> ParameterType:
        """Return the type of a parameter's value."""
        if name in self._parameters:
            return self._parameters[name].type_
        if self.allow_undeclared:
            return ParameterType.NOT_SET
        raise ParameterNotDeclaredException(name, self._parameters)

    def find_by_prefix(self, prefix: str) -> dict[str, Parameter]:
        """Return the parameters below a prefix, with the rest of their names as keys.

        For an empty prefix the result contains all parameters.
        """
        full_prefix = f"{prefix}." if prefix else ""
        return {
            name[len(full_prefix) :]: parameter
            for name, parameter in self._parameters.items()
            if name.startswith(full_prefix)
        }

    def get_descriptor(self, name: str) -> Any:
        """Return the stored descriptor of a parameter.

        If undeclared parameters are allowed, a name that is not declared results in an empty descriptor.

        Raises:
            ParameterNotDeclaredException: the parameter is not declared.
        """
        if name in self._descriptors:
            return self._descriptors[name]
        if self.allow_undeclared:
            return ParameterDescriptor()
        raise ParameterNotDeclaredException(name, self._parameters)

    def replace_descriptor(self, name: str, descriptor: Any) -> None:
        """Replace a parameter's descriptor by an object with the same content, without any checks."""
        self._descriptors[name] = descriptor

    def set_descriptor(self, name: str, descriptor: Any, alternative: Any) -> Parameter | None:
        """Replace the descriptor of a parameter. See ``Node.set_descriptor``.

        Return the resulting parameter, or None if the parameter is not declared but undeclared parameters are allowed.
        """
        if name not in self._parameters:
            if self.allow_undeclared:
                return None
            raise ParameterNotDeclaredException(name, self._parameters)
        if self._descriptors[name].read_only:
            raise ParameterImmutableException(name)
        current = self.get(name)
        fallback = current if alternative is None else Parameter(name, value=alternative)
        reason = None
        for candidate in (current, fallback):
            reason = find_refusal_reason(candidate, descriptor, is_declared=True, check_read_only=False)
            if reason is None:
                self._parameters[name] = candidate
                self._descriptors[name] = descriptor
                return candidate
        raise InvalidParameterValueException(name, fallback.value, reason or "")

    def set_atomically(self, parameters: Sequence[Parameter]) -> Any:
        """Set either all parameters or none. See ``Node.set_parameters_atomically``."""
        new_parameters = list(parameters)
        if self.pre_set:
            new_parameters = [parameter for callback in tuple(self.pre_set) for parameter in callback(list(parameters))]
            if not new_parameters:
                return SetParametersResult(successful=False, reason=_EMPTY_LIST_MESSAGE)
        if not all(isinstance(parameter, Parameter) for parameter in new_parameters):
            raise TypeError(phrase("parameter must be instance of type '{parameter}'", parameter=repr(Parameter)))
        undeclared = [parameter.name for parameter in new_parameters if parameter.name not in self._parameters]
        if undeclared and not self.allow_undeclared:
            raise ParameterNotDeclaredException(undeclared, self._parameters)
        return self._set([self._with_declared_type(parameter) for parameter in new_parameters])

    def _with_declared_type(self, parameter: Parameter) -> Parameter:
        """Return a parameter, with the declared array type if its value is an empty list.

        The element type of an empty list cannot be determined from the value.
        """
        descriptor = self._descriptors.get(parameter.name)
        if descriptor is None or descriptor.dynamic_typing or not _is_empty_list(parameter.value):
            return parameter
        declared_type = ParameterType(descriptor.type)
        return Parameter(parameter.name, declared_type, []) if declared_type.is_array else parameter

    def _determine_type(self, name: str, default: Any, descriptor: Any) -> Any:
        """Set the descriptor's type, and return the default value.

        Return None if only a type is given.

        Raises:
            ValueError: the type is NOT_SET, or conflicts with dynamic typing.
        """
        if isinstance(default, ParameterType):
            if default is ParameterType.NOT_SET:
                raise ValueError(f"Cannot declare parameter {{{name}}} as statically typed of type NOT_SET")
            if descriptor.dynamic_typing:
                raise ValueError(
                    f"When declaring parameter {{{name}}} passing a descriptor with"
                    "`dynamic_typing=True` is not allowed when the parameter type is provided"
                )
            descriptor.type = default.value
            return None
        if not descriptor.dynamic_typing:
            if _is_empty_list(default) and ParameterType(descriptor.type).is_array:
                return default
            default_type = ParameterType.from_parameter_value(default)
            if default_type is ParameterType.NOT_SET:
                raise ValueError(
                    "Cannot declare a statically typed parameter with default value of type PARAMETER_NOT_SET"
                )
            descriptor.type = default_type.value
        return default

    def _set(
        self, parameters: list[Parameter], *, descriptors: Mapping[str, Any] | None = None, keep_unset: bool = False
    ) -> Any:
        """Set all parameters or none.

        If `descriptors` is given, the parameters are being declared. Unless `keep_unset` is true, parameters that are
        set to no value are undeclared.
        """
        relevant_descriptors = self._descriptors if descriptors is None else descriptors
        for parameter in parameters:
            descriptor = relevant_descriptors.get(parameter.name)
            if descriptor is None:
                continue
            is_declared = parameter.name in self._parameters
            reason = find_refusal_reason(
                parameter, descriptor, is_declared=is_declared, check_read_only=descriptors is None
            )
            if reason is not None:
                return SetParametersResult(successful=False, reason=reason)
        for callback in tuple(self.on_set):
            result = callback(parameters)
            if not hasattr(result, "successful"):
                name = getattr(callback, "__qualname__", callback)
                warnings.warn(f"{_INVALID_RESULT_MESSAGE}, it should return SetParametersResult: {name}", stacklevel=5)
                return SetParametersResult(successful=False, reason=_INVALID_RESULT_MESSAGE)
            if not result.successful:
                return result
        change = ParameterChange()
        for parameter in parameters:
            self._apply(parameter, descriptors, change, keep_unset=keep_unset)
        self._on_change(change)
        for callback in tuple(self.post_set):
            callback(parameters)
        return SetParametersResult(successful=True)

    def _apply(
        self, parameter: Parameter, descriptors: Mapping[str, Any] | None, change: ParameterChange, *, keep_unset: bool
    ) -> None:
        name = parameter.name
        if parameter.type_ is ParameterType.NOT_SET and not keep_unset:
            change.deleted.append(parameter)
            self._parameters.pop(name, None)
            self._descriptors.pop(name, None)
            return
        if descriptors is not None:
            self._descriptors[name] = descriptors[name]
        elif name not in self._descriptors:
            self._descriptors[name] = ParameterDescriptor(name, parameter.type_.value, dynamic_typing=True)
        (change.new if self.get_if_set(name) is None else change.changed).append(parameter)
        self._parameters[name] = parameter


def _is_empty_list(value: Any) -> bool:
    return isinstance(value, (list, tuple)) and not value


def _make_parameter(name: str, value: Any, descriptor: Any) -> Parameter:
    """Return a parameter to be declared.

    Raises:
        InvalidParameterValueException: the value is not a valid parameter value.
    """
    if isinstance(value, Parameter):
        value = value.value
    declared_type = ParameterType(descriptor.type)
    if _is_empty_list(value) and declared_type.is_array and not descriptor.dynamic_typing:
        return Parameter(name, declared_type, [])
    try:
        return Parameter(name, value=list(value) if isinstance(value, tuple) else value)
    except TypeError as error:
        raise InvalidParameterValueException(name, value, str(error)) from None


def _flatten(values: Mapping[str, Any], prefix: str = "") -> Iterable[tuple[str, Any]]:
    for name, value in values.items():
        if isinstance(value, Mapping):
            yield from _flatten(value, f"{prefix}{name}.")
        else:
            yield prefix + name, value
