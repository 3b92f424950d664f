"""Values of parameters as ``ros2 param get`` prints them."""

from __future__ import annotations

from typing import Any

from linkwright.graph.parameters.parameter import VALUE_FIELDS, ParameterType

UNSET_TEXT = "Parameter not set."
_LABELS = {
    ParameterType.BOOL: "Boolean value is:",
    ParameterType.INTEGER: "Integer value is:",
    ParameterType.DOUBLE: "Double value is:",
    ParameterType.STRING: "String value is:",
    ParameterType.BYTE_ARRAY: "Byte values are:",
    ParameterType.BOOL_ARRAY: "Boolean values are:",
    ParameterType.INTEGER_ARRAY: "Integer values are:",
    ParameterType.DOUBLE_ARRAY: "Double values are:",
    ParameterType.STRING_ARRAY: "String values are:",
}


def format_parameter_value(value: Any, *, hide_type: bool) -> str:
    """Return an rcl_interfaces/msg/ParameterValue as a text, with a label for its type unless `hide_type` is set."""
    type_ = ParameterType(value.type)
    if type_ is ParameterType.NOT_SET:
        return UNSET_TEXT
    content = getattr(value, VALUE_FIELDS[type_])
    return str(content) if hide_type else f"{_LABELS[type_]} {content}"
