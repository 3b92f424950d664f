"""Find the types of the parameters that Python sources declare without a default."""

from __future__ import annotations

import ast
import re

from linkwright.packages.readers.python_values import PythonFile, argument_of, called_name

_TYPES = {"BOOL": "bool", "INTEGER": "int", "DOUBLE": "float", "STRING": "str"}
"""The names of the types in messages of rcl_interfaces, and the names that the types of defaults have."""
_NAMES = f"({'|'.join(_TYPES)})(_ARRAY)?"
_IN_DESCRIPTOR = re.compile(rf"(?:\w+\.)*ParameterType\.PARAMETER_{_NAMES}")
_AS_VALUE = re.compile(rf"(?:\w+\.)*Parameter\.Type\.{_NAMES}")


def find_declared_type(python: PythonFile, value: ast.expr | None, descriptor: ast.expr | None) -> str | None:
    """Return the type with which a parameter is declared without a default, such as ``str`` or ``str[]``, or None.

    Args:
        python: the parsed file.
        value: the expression for the default, which rclpy takes for a type if it is ``Parameter.Type.STRING``.
        descriptor: the expression for the descriptor of the parameter.
    """
    if value is not None:
        return _read_type(_AS_VALUE, value)
    call = None if descriptor is None else python.resolved(descriptor)
    if not isinstance(call, ast.Call) or called_name(call).rpartition(".")[2] != "ParameterDescriptor":
        return None
    return _read_type(_IN_DESCRIPTOR, argument_of(call, "type"))


def _read_type(pattern: re.Pattern[str], node: ast.expr | None) -> str | None:
    match = None if node is None else pattern.fullmatch(ast.unparse(node))
    return None if match is None else _TYPES[match[1]] + ("[]" if match[2] else "")
