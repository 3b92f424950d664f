"""Compare the parameters of macros in templates of SDF, and read calls of macros."""

from __future__ import annotations

import ast
import re
from collections.abc import Collection, Iterator

from linkwright.diagnostics import Phrase, joined, phrase, quoted_names
from linkwright.packages.readers.python_values import parse_python_expression

PARAMETERS = re.compile(r"(?:^|.* )macro \S+ @parameters")
"""The path of the parameters of a macro."""
_DEFAULT = re.compile(r"\s*=.*", re.DOTALL)
_IMPORT = re.compile(r"\{%[-+]?\s*import\s+\S+\s+as\s+(?P<module>\w+)[^%]*%\}")
_IMPORTED_MACROS = re.compile(
    r"\{%[-+]?\s*from\s+\S+\s+import\s+(?P<names>[\w\s,]+?)\s*(?:with\w* context\s*)?[-+]?%\}"
)
_MACRO = re.compile(r"\{%[-+]?\s*macro\s+(?P<name>\w+)")


def find_parameters_reason(old: str, new: str) -> Phrase | None:
    """Return why other parameters of a macro are breaking, or None if they are not.

    Jinja accepts calls that do not pass a parameter, but none that pass an unknown one.

    Args:
        old: the old list of parameters, as written.
        new: the new list.
    """
    old_names, new_names = list(_split_parameters(old)), list(_split_parameters(new))
    lost = [name for name in old_names if name not in new_names]
    reasons = []
    if lost:
        reasons.append(phrase("calls that pass {names} by name fail", names=quoted_names(lost)))
    shared = min(len(old_names), len(new_names))
    shifted = [
        name for name in old_names[:shared] if name in new_names and old_names.index(name) != new_names.index(name)
    ]
    if shifted:
        first = quoted_names(shifted[:1])
        reasons.append(phrase("calls that pass {names} by position set another parameter", names=first))
    return joined(reasons, "; ") if reasons else None


def find_macro_names(text: str) -> Collection[str]:
    """Return the names of the macros that a template defines or imports, and of the modules with macros."""
    names = {match["name"] for match in _MACRO.finditer(text)}
    names |= {match["module"] for match in _IMPORT.finditer(text)}
    for match in _IMPORTED_MACROS.finditer(text):
        names |= {item.split()[-1] for item in match["names"].split(",") if item.strip()}
    return names


def read_call(content: str, names: Collection[str]) -> tuple[str, list[tuple[str, str]]] | None:
    """Return the macro and the arguments of a call by parameter, or None if an expression is not a call of a macro.

    Arguments that are passed by position have the name ``argument``.

    Args:
        content: the expression.
        names: the names of macros and of modules with macros.
    """
    try:
        call = parse_python_expression(" ".join(content.split()))
    except (SyntaxError, ValueError):
        return None
    if not isinstance(call, ast.Call) or any(keyword.arg is None for keyword in call.keywords):
        return None
    name = ast.unparse(call.func)
    if name.partition(".")[0] not in names:
        return None
    arguments = [("argument", ast.unparse(argument)) for argument in call.args]
    return name, [*arguments, *((keyword.arg or "", ast.unparse(keyword.value)) for keyword in call.keywords)]


def _split_parameters(text: str) -> Iterator[str]:
    """Yield the names in a list of parameters; commas in defaults do not separate them."""
    start = depth = 0
    for position, character in enumerate(f"{text},"):
        depth += {"(": 1, "[": 1, "{": 1, ")": -1, "]": -1, "}": -1}.get(character, 0)
        if character == "," and depth == 0:
            name = _DEFAULT.sub("", text[start:position]).strip()
            start = position + 1
            if name:
                yield name
