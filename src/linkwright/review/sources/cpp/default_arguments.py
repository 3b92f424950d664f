"""Find the names that C++ functions use by default, because the default of an argument is a part of them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from linkwright.review.sources.cpp.functions import split_parameters
from linkwright.review.sources.cpp.values import TEXT
from linkwright.review.sources.parameter_defaults import split_sum

_DEFINITION = re.compile(r"\b\w+\s*::\s*(?P<function>\w+)\s*\((?P<parameters>[^(){};]*)\)[^(){};]*\{")
_NAMED = re.compile(r"(?P<name>\w+)\s*(?:=(?P<default>[^=].*))?\Z", re.DOTALL)

_LOCAL = re.compile(r"\bstring\s+(?P<name>\w+)\s*=\s*(?P<value>[^;]+);")


class _Default(NamedTuple):
    """The default of an argument.

    Attributes:
        name: the name of the argument in the declaration.
        value: the default as written.
    """

    name: str
    value: str


class DefaultArgument(NamedTuple):
    """A name that a function uses by default.

    Attributes:
        argument: the argument whose default is a part of the name.
        name: the name.
    """

    argument: str
    name: str


def find_default_argument(expression: str, line: int, text: str, headers: Sequence[str]) -> DefaultArgument | None:
    """Return the name that an expression in a function gives by default, or None if it is unknown.

    Args:
        expression: a sum of literal texts and variables. One variable is an argument of the function, or a local
            variable that such a sum initializes.
        line: the line of the expression.
        text: the text of the source without comments.
        headers: the texts of the headers without comments, which declare the function.
    """
    position = sum(map(len, text.splitlines(keepends=True)[: line - 1]))
    definitions = [match for match in _DEFINITION.finditer(text) if match.start() < position]
    if not definitions:
        return None
    definition = definitions[-1]
    defaults = _find_defaults(definition, headers)
    values = {name: item.value for name, item in defaults.items()}
    body = text[definition.end() : position]
    local = {match["name"]: match["value"] for match in _LOCAL.finditer(body)}
    used: list[str] = []
    parts = list(_evaluate(expression, {**values, **local}, used))
    arguments = {defaults[name].name for name in used if name in defaults and name not in local}
    assigned = _LOCAL.sub("", body)
    is_changed = any(re.search(rf"(?<![\w.>]){name}\s*\+?=(?!=)", assigned) for name in used)
    known = [part for part in parts if part is not None]
    if len(known) < len(parts) or len(arguments) != 1 or is_changed:
        return None
    return DefaultArgument(arguments.pop(), "".join(known))


def _find_defaults(definition: re.Match[str], headers: Sequence[str]) -> dict[str, _Default]:
    """Return the defaults in the declaration of a function, by the names of the arguments in its definition."""
    declaration = re.compile(rf"(?<![\w.>:]){definition['function']}\s*\((?P<parameters>[^(){{}};]*)\)[^(){{}};]*;")
    own = [_NAMED.search(item.strip()) for item in split_parameters(definition["parameters"])]
    found = [
        [_NAMED.search(item.strip()) for item in split_parameters(match["parameters"])]
        for header in headers
        for match in declaration.finditer(header)
    ]
    fitting = [items for items in found if len(items) == len(own)]
    if len(fitting) != 1:
        return {}
    pairs = zip(own, fitting[0], strict=True)
    return {
        item["name"]: _Default(other["name"], other["default"])
        for item, other in pairs
        if item and other and other["default"]
    }


def _evaluate(expression: str, values: dict[str, str], used: list[str]) -> Iterator[str | None]:
    """Yield the parts of the text of a sum, with None for an unknown one, and list the variables that it uses."""
    for part in split_sum(expression):
        literal = TEXT.fullmatch(part)
        if literal is not None or part not in values:
            yield None if literal is None else literal["text"]
        else:
            used.append(part)
            yield from _evaluate(values[part], {name: value for name, value in values.items() if name != part}, used)
