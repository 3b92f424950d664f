"""Find the default names of topics, services and frames that sources read from parameters."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple

from linkwright.packages.readers.python_values import PythonFile, argument_of, called_name

_READERS = ("get_parameter", "declare_parameter", "get_parameter_or", "get_param")
_MAX_DEPTH = 10
_TEMPLATE = r"(?:<[^<>;()]*>\s*)?"
_TEXT = r"(?:rclcpp\s*::\s*ParameterValue\s*\(\s*)?(?:(?:std\s*::\s*)?string\s*\(\s*)?\"(?P<default>[^\"\\]*)\""
_NAME = r"(?:\w+\s*\+\s*)?\"(?P<name>[^\"\\]+)\""
"""The name of a parameter, perhaps behind the namespace of a plugin."""
_NODE = r"(?:\w+\s*,\s*)?"
"""The node that functions of nav2_util take first."""
_CPP_READ = re.compile(
    rf"\b(?:declare_parameter|get_parameter|auto_declare|param)\s*{_TEMPLATE}\(\s*{_NAME}(?:\s*,\s*{_TEXT})?"
)
"""A call in C++ that returns a parameter."""
_CPP_DECLARED = re.compile(
    rf"\b(?:declare_parameter(?:_if_not_declared)?|auto_declare)\s*{_TEMPLATE}\(\s*{_NODE}{_NAME}\s*,\s*{_TEXT}"
)
SUM = " + "
"""The text between the names of parameters whose values are joined."""
_CPP_TEXT = re.compile(r"(?:std\s*::\s*)?(?:string\s*\(\s*)?[\"'](?P<text>[^\"\\]*)[\"']\s*\)?")
_CPP_VARIABLE = re.compile(r"\s*(?:this\s*->\s*)?(?P<name>[A-Za-z_]\w*)\s*(?:\.c_str\(\)\s*)?")


class ParameterDefault(NamedTuple):
    """A parameter that gives a name, with its default.

    Attributes:
        parameter: the name of the parameter, or the names of those whose values are joined, such as ``prefix + topic``.
        default: the name by default.
        pattern: the texts of a sum with the names of the parameters between them, such as ``<prefix>/state``; empty for
            a single parameter.
    """

    parameter: str
    default: str
    pattern: str = ""


def find_cpp_parameter_default(
    texts: Sequence[str], expression: str, find_known: Callable[[str], str | None]
) -> ParameterDefault | None:
    """Return the parameter that an expression of a C++ source reads, such as ``topic_``; None for others.

    A sum of texts and parameters, such as ``prefix_ + "/state"``, is read as well. A default is empty only if the
    variable keeps it, and nothing asks whether it is empty.

    Args:
        texts: the source without comments, and those of its base classes. The first text that reads a variable counts.
        expression: the text of the expression.
        find_known: returns the default of a parameter whose calls give no literal; None if it is unknown.
    """
    parts = split_sum(expression)
    if len(parts) > 1:
        literals = (_CPP_TEXT.fullmatch(part) for part in parts)
        return _join(
            ParameterDefault("", literal["text"])
            if literal is not None
            else find_cpp_parameter_default(texts, part, find_known)
            for part, literal in zip(parts, literals, strict=True)
        )
    call = _CPP_READ.search(expression)
    variable = _CPP_VARIABLE.fullmatch(expression)
    reads, text = [call] if call is not None else [], texts[0]
    if variable is not None:
        name = re.escape(variable["name"])
        assigned = re.compile(rf"\b{name}\s*(?:=|\()\s*(?:this\s*->\s*|\w+\s*(?:->|\.)\s*)?(?={_CPP_READ.pattern})")
        passed = re.compile(
            rf"\b(?:get_parameter|get_parameter_or|param)\s*{_TEMPLATE}\(\s*{_NAME}\s*,\s*{name}\s*(?:,\s*{_TEXT})?"
        )
        found_reads = ([match for pattern in (assigned, passed) for match in pattern.finditer(item)] for item in texts)
        text, reads = next(((item, found) for item, found in zip(texts, found_reads, strict=True) if found), (text, []))
    defaults = {(match["name"], match["default"] or _find_declared_default(text, match["name"])) for match in reads}
    if len(defaults) != 1:
        return None
    ((parameter, found),) = defaults
    default = found or find_known(parameter)
    is_known = default or (default == "" and variable is not None and _keeps_empty_text(text, variable["name"]))
    return ParameterDefault(parameter.lstrip("~/."), default or "") if is_known else None


def _keeps_empty_text(text: str, variable: str) -> bool:
    """Return whether a C++ source neither sets a variable to another text nor asks whether it is empty."""
    name = re.escape(variable)
    own = rf"\bstring\s+{name}\s*(?:=\s*)?[\"{{(][^;]*;|\b{name}\s*=\s*[^;=]*\b(?:get_|declare_|as_)\w+\s*[<(]"
    assigned = re.sub(own, "", text)
    asked = rf"\b{name}\s*(?:==|!=|\.\s*(?:empty|size|length|compare)\b)|(?:==|!=)\s*{name}\b"
    return re.search(rf"\b{name}\s*(?:\+?=(?!=)|\.\s*(?:append|assign|insert)\b)|{asked}", assigned) is None


def split_sum(expression: str) -> list[str]:
    """Return the operands of the additions in an expression outside of brackets and texts."""
    parts, depth, is_text = [""], 0, False
    for index, character in enumerate(expression):
        is_text ^= character == '"' and expression[index - 1 : index] != "\\"
        if not is_text:
            depth += (character in "([{") - (character in ")]}")
        if character == "+" and depth == 0 and not is_text:
            parts.append("")
        else:
            parts[-1] += character
    return [part.strip() for part in parts]


def _join(parts: Iterable[ParameterDefault | None]) -> ParameterDefault | None:
    """Return the parameters and the default of a sum. Those of a literal text have no name."""
    found = list(parts)
    known = [item for item in found if item is not None]
    names = [item.parameter for item in known if item.parameter]
    if len(known) < len(found) or not names:
        return None
    pattern = "".join(f"<{item.parameter}>" if item.parameter else item.default for item in known)
    return ParameterDefault(SUM.join(names), "".join(item.default for item in known), pattern)


def _find_declared_default(text: str, parameter: str) -> str:
    """Return the default in the only declaration of a parameter in a C++ source; empty if there is none."""
    declared = {match["default"] for match in _CPP_DECLARED.finditer(text) if match["name"] == parameter}
    return declared.pop() if len(declared) == 1 else ""


def find_parameter_default(python: PythonFile, node: ast.expr) -> ParameterDefault | None:
    """Return the parameter that an expression reads, such as ``self.topic``; None for others.

    Args:
        python: the parsed file.
        node: the syntax tree of the expression.
    """
    operands = _list_operands(python.resolved(node))
    if len(operands) > 1:
        texts = (python.text(item) for item in operands)
        return _join(
            find_parameter_default(python, item) if text is None else ParameterDefault("", text)
            for item, text in zip(operands, texts, strict=True)
        )
    for _ in range(_MAX_DEPTH):
        value = python.resolved(node)
        if isinstance(value, ast.Call) and called_name(value).rpartition(".")[2] in _READERS:
            name = python.text(get_name_argument(value))
            default = _find_default(python, value)
            return ParameterDefault((name or "").lstrip("~/"), default) if default else None
        if isinstance(value, ast.Attribute) and isinstance(value.value, ast.Name):
            assigned = _find_assigned_value(python, value)
            if assigned is None:
                return None
            node = assigned
        elif isinstance(value, ast.Attribute):
            node = value.value
        elif isinstance(value, ast.Call) and isinstance(value.func, ast.Attribute) and not value.args:
            node = value.func.value
        elif isinstance(value, ast.Call) and called_name(value) == "str" and len(value.args) == 1:
            node = value.args[0]
        else:
            return None
    return None


def _list_operands(node: ast.expr) -> list[ast.expr]:
    """Return the operands of a sum or the parts of a formatted text; the expression itself if it is neither."""
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
        return [*_list_operands(node.left), *_list_operands(node.right)]
    if isinstance(node, ast.JoinedStr):
        return [item.value if isinstance(item, ast.FormattedValue) else item for item in node.values]
    return [node]


def _find_default(python: PythonFile, call: ast.Call) -> str:
    """Return the default in a call that reads or declares a parameter, or in the only declaration of its name."""
    given = call.args[1] if len(call.args) > 1 else argument_of(call, "default")
    if given is None:
        given = argument_of(call, "value")
    if given is not None:
        return python.text(given) or ""
    name = python.text(get_name_argument(call))
    declarations = find_declarations(python, call, name)
    if len(declarations) == 1:
        return _find_default(python, declarations[0])
    listed = [
        item.elts[1]
        for declared in python.calls("declare_parameters")
        for item in ast.walk(declared)
        if isinstance(item, ast.Tuple) and len(item.elts) > 1 and python.text(item.elts[0]) == name
    ]
    return (python.text(listed[0]) or "") if len(listed) == 1 and name is not None else ""


def get_name_argument(call: ast.Call) -> ast.expr | None:
    """Return the name of a parameter in a call that reads or declares it."""
    return call.args[0] if call.args else argument_of(call, "name")


def find_declarations(python: PythonFile, call: ast.Call, name: str | None) -> list[ast.Call]:
    """Return the other calls that declare the parameter of a call."""
    declarations = python.calls("declare_parameter") if name is not None else ()
    return [
        declared
        for declared in declarations
        if declared is not call and python.text(get_name_argument(declared)) == name
    ]


def _find_assigned_value(python: PythonFile, attribute: ast.Attribute) -> ast.expr | None:
    """Return the only expression that is assigned to an attribute such as ``self.topic``, or None."""
    text = ast.unparse(attribute)
    values = [
        node.value
        for node in ast.walk(python.tree)
        if isinstance(node, (ast.Assign, ast.AnnAssign))
        and node.value is not None
        and any(ast.unparse(item) == text for item in (node.targets if isinstance(node, ast.Assign) else [node.target]))
    ]
    return values[0] if len(values) == 1 else None
