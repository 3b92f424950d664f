"""Whether a descriptor allows a value; rules and reasons are those of rclpy's ``Node``."""

from __future__ import annotations

from math import isclose
from typing import Any

from linkwright.diagnostics import phrase
from linkwright.graph.parameters.parameter import Parameter, ParameterType

_RELATIVE_TOLERANCE = 1e-6
"""How near floating point values must be to count as equal (rclpy ``Node.PARAM_REL_TOL``)."""

WRONG_TYPE = "Wrong parameter type"
"""How a reason begins that is about the type."""


def objection(parameter: Parameter, descriptor: Any, *, declared: bool, check_read_only: bool) -> str | None:
    """Why a parameter cannot be set, or None. Fills in the descriptor's name, and its type where that is dynamic.

    Args:
        parameter: the name and the new value.
        descriptor: a `ParameterDescriptor` or the message of that name.
        declared: whether the parameter is declared already.
        check_read_only: whether a read-only parameter is left alone; not so while it is declared.
    """
    descriptor.name = parameter.name
    if check_read_only and descriptor.read_only:
        return phrase("Trying to set a read-only parameter: {name}.", name=parameter.name)
    is_set = parameter.type_ is not ParameterType.NOT_SET
    if descriptor.dynamic_typing:
        descriptor.type = parameter.type_.value
    elif declared and not is_set:
        return phrase("Static parameter cannot be undeclared")
    elif is_set and parameter.type_.value != descriptor.type:
        return phrase(
            "Wrong parameter type, expected '{expected}' got '{given}'",
            expected=str(ParameterType(descriptor.type)),
            given=str(parameter.type_),
        )
    if parameter.type_ is ParameterType.INTEGER and descriptor.integer_range:
        return _integer_objection(parameter, descriptor.integer_range[0])
    if parameter.type_ is ParameterType.DOUBLE and descriptor.floating_point_range:
        return _floating_point_objection(parameter, descriptor.floating_point_range[0])
    return None


def _integer_objection(parameter: Parameter, allowed: Any) -> str | None:
    low, high = sorted((allowed.from_value, allowed.to_value))
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
    if allowed.step != 0 and (value - low) % allowed.step != 0:
        return phrase(
            "The parameter value for {name} is not a valid step. Min: {low}, max: {high}, value: {value}, step: {step}",
            name=parameter.name,
            low=low,
            high=high,
            value=value,
            step=allowed.step,
        )
    return None


def _floating_point_objection(parameter: Parameter, allowed: Any) -> str | None:
    low, high = sorted((allowed.from_value, allowed.to_value))
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
    if allowed.step != 0.0:
        nearest = low + round((value - low) / allowed.step) * allowed.step
        if not isclose(nearest, value, rel_tol=_RELATIVE_TOLERANCE):
            return phrase(
                "The parameter value for {name} is not close enough to a valid step."
                " Min: {low}, max: {high}, value: {value}, step: {step}",
                name=parameter.name,
                low=low,
                high=high,
                value=value,
                step=allowed.step,
            )
    return None
