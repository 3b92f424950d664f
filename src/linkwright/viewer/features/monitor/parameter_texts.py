"""Parameters as texts for the page, and back."""

from __future__ import annotations

from typing import Any, cast

from linkwright.diagnostics import phrase
from linkwright.graph import Parameter
from linkwright.graph.parameters.file_text import plain_value
from linkwright.graph.parameters.parameter import ParameterType
from linkwright.viewer.protocol.parameters import ParameterKind, ParameterRow, SetParameter

_KINDS: dict[ParameterType, ParameterKind] = {kind: cast("ParameterKind", kind.name.lower()) for kind in ParameterType}
_TYPES = {text: kind for kind, text in _KINDS.items()}
_ARTICLES = {
    "bool": phrase("true or false"),
    "integer": phrase("a whole number"),
    "double": phrase("a number"),
    "byte": phrase("a byte, 0 to 255"),
}
_BOOLS = {"true": True, "false": False}
_LONGS = range(-(2**63), 2**63)


def parameter_row(descriptor: Any, value: Any) -> ParameterRow:
    """What the page shows of a parameter.

    Args:
        descriptor: rcl_interfaces/msg/ParameterDescriptor.
        value: rcl_interfaces/msg/ParameterValue.
    """
    limits = [*descriptor.floating_point_range, *descriptor.integer_range]
    minimum, maximum, step = ("", "", "")
    if limits:
        minimum, maximum = str(limits[0].from_value), str(limits[0].to_value)
        step = str(limits[0].step) if limits[0].step else ""
    kind, values = value_texts(value)
    return ParameterRow(
        name=descriptor.name,
        kind=kind,
        values=values,
        description=descriptor.description,
        constraints=descriptor.additional_constraints,
        read_only=descriptor.read_only,
        minimum=minimum,
        maximum=maximum,
        step=step,
    )


def value_texts(value: Any) -> tuple[ParameterKind, list[str]]:
    """The kind of a value (rcl_interfaces/msg/ParameterValue), and a text for each of its elements."""
    plain = plain_value(value)
    kind = ParameterType(value.type)
    if kind is ParameterType.NOT_SET:
        return _KINDS[kind], []
    return _KINDS[kind], [_text(each) for each in (plain if kind.is_array else [plain])]


def parameter_of(wanted: SetParameter) -> Parameter:
    """The parameter that a page wants to have set.

    Raises:
        ValueError: a text stands for no value of the kind; the text says which.
    """
    kind = _TYPES[wanted.kind]
    if kind is ParameterType.NOT_SET:
        return Parameter(wanted.name, kind)
    element = wanted.kind.removesuffix("_array")
    values = [_value(element, text) for text in wanted.values]
    if kind.is_array:
        return Parameter(wanted.name, kind, values)
    if len(values) != 1:
        raise ValueError(f"a {element} is one value, not {len(values)}")
    return Parameter(wanted.name, kind, values[0])


def _text(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return str(value[0]) if isinstance(value, bytes) else str(value)


def _value(kind: str, text: str) -> Any:
    if kind == "string":
        return text
    try:
        if kind == "bool":
            return _BOOLS[text.strip().lower()]
        if kind == "double":
            return float(text)
        number = int(text, 0)
        if kind == "byte":
            return bytes([number])
    except (ValueError, KeyError):
        raise ValueError(f"'{text}' is not {_ARTICLES[kind]}") from None
    if number not in _LONGS:
        raise ValueError(f"{text} is more than 64 bits can hold")
    return number
