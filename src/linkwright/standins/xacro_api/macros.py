"""Macros as the module ``xacro`` presents them to programs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from linkwright.standins.xacro_api.errors import XacroException
from linkwright.xacro.faults import Fault
from linkwright.xacro.macros import parse_parameters


class Macro:
    """A macro.

    Attributes:
        name: the name of the macro.
        body: the element that defines the macro.
        params: the names of the parameters.
        defaultmap: parameter -> the name of the caller's property to use, if any, and the source of the default.
        history: for each definition, the files that were being processed at that time.
    """

    def __init__(self) -> None:
        self.name = ""
        self.body: Any = None
        self.params: list[str] = []
        self.defaultmap: dict[str, tuple[str | None, str | None]] = {}
        self.history: list[list[str | None]] = []


def parse_macro_arg(s: str) -> tuple[str, tuple[str | None, str | None] | None, str]:
    """Parse the first parameter in a list of macro parameters.

    Returns:
        The name of the parameter, its default and the rest of the list. The default is None for a parameter without a
        default. Otherwise it is a pair of the name of the caller's property to use, or None, and a default text, or
        None.

    Raises:
        XacroException: a quotation mark is not closed.
        IndexError: the list is empty.
    """
    try:
        first, *others = parse_parameters(s)
    except ValueError:
        raise IndexError("there is no parameter in the list") from None
    except Fault as fault:
        raise XacroException(fault.message) from None
    rest = s[others[0].start :] if others else ""
    behind = s[first.start + len(first.name) :].lstrip()
    if not behind.startswith(("=", ":=")):
        return first.name, None, rest
    return first.name, (first.name if first.forward else None, first.default), rest


def resolve_macro(fullname: str, macros: Mapping[str, Any], symbols: Mapping[str, Any]) -> tuple[Any, Any, Any]:
    """Look up a macro by its name, which can have namespace prefixes.

    Returns:
        The table of macros and the table of properties that contain the macro, and the macro.

    Raises:
        KeyError: there is no such macro.
    """
    if fullname in macros:
        return macros, symbols, macros[fullname]
    *namespaces, name = fullname.split(".")
    for namespace in namespaces:
        macros, symbols = macros[namespace], symbols[namespace]
    return macros, symbols, macros[name]
