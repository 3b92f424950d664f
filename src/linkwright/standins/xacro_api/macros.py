"""Macros in the API of the module ``xacro``."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from linkwright.standins.xacro_api.errors import XacroException
from linkwright.xacro.faults import Fault
from linkwright.xacro.macros import parse_parameters


class Macro:
    """The definition of a macro.

    Attributes:
        name: the name of the macro, without the prefix ``xacro:``.
        body: the element that defines the macro.
        params: the names of the parameters.
        defaultmap: for each parameter with a default, the name of the caller's property to use and the default text;
            each may be None.
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
        The name of the parameter, its default, and the rest of the list. The default is None for a parameter without a
        default, and otherwise a pair: the name of the caller's property to use, and the default text. Each part of the
        pair may be None.

    Raises:
        XacroException: a quotation mark is not closed.
        IndexError: the list is empty.
    """
    try:
        first_parameter, *further_parameters = parse_parameters(s)
    except ValueError:
        raise IndexError("there is no parameter in the list") from None
    except Fault as fault:
        raise XacroException(fault.message) from None
    remaining_text = s[further_parameters[0].start :] if further_parameters else ""
    text_after_name = s[first_parameter.start + len(first_parameter.name) :].lstrip()
    if not text_after_name.startswith(("=", ":=")):
        return first_parameter.name, None, remaining_text
    return (
        first_parameter.name,
        (first_parameter.name if first_parameter.forward else None, first_parameter.default),
        remaining_text,
    )


def resolve_macro(fullname: str, macros: Mapping[str, Any], symbols: Mapping[str, Any]) -> tuple[Any, Any, Any]:
    """Look up a macro by its name.

    The name can have namespace prefixes.

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
