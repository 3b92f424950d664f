"""Format the parameters of macros as they are written."""

from __future__ import annotations

from linkwright.xacro.macros import Parameter


def has_default(parameter: Parameter) -> bool:
    """Return whether calls can leave out a parameter."""
    return parameter.default is not None or parameter.forward


def format_default(parameter: Parameter) -> str:
    """Return a default as written, with single spaces."""
    text = " ".join((parameter.default or "").split())
    return f"^|{text}" if parameter.forward and text else "^" if parameter.forward else text


def format_parameter(parameter: Parameter) -> str:
    """Return a parameter as written, with its default."""
    return f"{parameter.name}:={format_default(parameter)}" if has_default(parameter) else parameter.name
