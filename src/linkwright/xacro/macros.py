"""Macros, their parameters, and tables of macros."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import lru_cache

from linkwright.diagnostics import phrase
from linkwright.loading.lean_dataclasses import NamedTuple
from linkwright.xacro.faults import Fault
from linkwright.xmltree import Element

# These patterns are compiled on first use, because some files do not need them.
_PARAMETER_WITH_DEFAULT = (
    r"\s*(?P<name>[^\s:=]+?)\s*:?=\s*(?P<forward>\^\|?)?(?P<expression>(?:\$\{.*?\}|\$\(.*?\))(?=\s|$))?"
)
_PARAMETER_NAME = r"\s*(?P<name>\S+)\s*"


class Parameter(NamedTuple):
    """A parameter of a macro.

    Attributes:
        name: the name of the parameter. The name of a block begins with one or two asterisks.
        default: the text of the default, or None.
        forward: whether a call without this argument uses the caller's property with the same name.
        start: the offset of the name in the list of parameters.
        default_start: the offset of the default in the list of parameters.
    """

    name: str
    default: str | None
    forward: bool
    start: int
    default_start: int

    @property
    def is_block(self) -> bool:
        """Whether the parameter receives an element of the call instead of an attribute."""
        return self.name.startswith("*")


@lru_cache(maxsize=2000)
def parse_parameters(text: str) -> tuple[Parameter, ...]:
    """Return the parameters that the ``params`` of a macro declares.

    Raises:
        Fault: XAC412 for a default with a quote that is never closed.
    """
    parameters: list[Parameter] = []
    with_defaults: dict[str, Parameter] = {}
    word_ends = _find_word_ends(text)
    with_default, bare = re.compile(_PARAMETER_WITH_DEFAULT), re.compile(_PARAMETER_NAME)
    position = 0
    while position < len(text):
        match = with_default.match(text, position)
        if match is not None:
            start = match.end() if match["expression"] is None else match.start("expression")
            position = match.end() if start < match.end() else word_ends[start]
            if position < 0:
                end = len(text.rstrip())
                message = phrase("this parameter's default has a quote that is never closed")
                raise Fault("XAC412", message, match.start("name"), end)
            name = match["name"]
            parameter = Parameter(
                name, text[start:position] or None, bool(match["forward"]), match.start("name"), start
            )
            with_defaults[name] = parameter
        else:
            match = bare.match(text, position)
            if match is None:
                break  # only whitespace remains
            position = match.end()
            parameter = Parameter(match["name"], None, False, match.start("name"), match.end("name"))
        parameters.append(parameter)
    # As in ros/xacro, the last default applies to all parameters with the same name.
    return tuple(with_defaults.get(parameter.name, parameter) for parameter in parameters)


def _find_word_ends(text: str) -> list[int]:
    """Return the end of the word that begins at each offset, or -1 for an unclosed quote.

    A word ends at whitespace, but may contain quoted whitespace. As in ros/xacro, a quote is closed by the first quote
    of the same kind after which the word can end. For example, ``'''`` is one word: a quote in quotes.
    """
    ends = [len(text)] * (len(text) + 1)
    ends_after_quotes = {"'": -1, '"': -1}  # the end of a word that continues after the nearest closing quote
    for index in range(len(text) - 1, -1, -1):
        letter, following = text[index], ends[index + 1]
        if letter.isspace():
            ends[index] = index
            if letter == "\n":
                ends_after_quotes = dict.fromkeys(ends_after_quotes, -1)
        elif letter in ends_after_quotes:
            ends[index] = ends_after_quotes[letter]
            if following >= 0:
                ends_after_quotes[letter] = following
        else:
            ends[index] = following
    return ends


class Macro:
    """A macro with its parameters and its body.

    Attributes:
        name: the name of the macro.
        parameters: the parameters, in the order of their declaration.
        parameter_names: the names of the parameters.
        body: the element that contains the body.
    """

    __slots__ = ("body", "name", "parameter_names", "parameters")

    def __init__(self, name: str, parameters: tuple[Parameter, ...], body: Element) -> None:
        self.name = name
        self.parameters = parameters
        self.parameter_names = frozenset(parameter.name for parameter in parameters)
        self.body = body


class MacroTable:
    """The macros of a scope, with the table of the enclosing scope.

    The table of a namespace has no enclosing table.
    """

    __slots__ = ("_entries", "_parent")

    def __init__(self, parent: MacroTable | None = None) -> None:
        self._parent = parent
        self._entries: dict[str, Macro | MacroTable] = {}

    def define(self, name: str, entry: Macro | MacroTable) -> None:
        """Bind a name to a macro or to the table of a namespace, replacing an earlier binding."""
        self._entries[name] = entry

    def find(self, name: str) -> Macro | MacroTable | None:
        """Return the macro or table bound to a name in this or an enclosing table, or None."""
        table: MacroTable | None = self
        while table is not None:
            entry = table._entries.get(name)
            if entry is not None:
                return entry
            table = table._parent
        return None

    def names(self) -> Iterator[str]:
        """Yield the full names of all macros that can be called from this scope."""
        table: MacroTable | None = self
        while table is not None:
            for name, entry in table._entries.items():
                if isinstance(entry, Macro):
                    yield name
                else:
                    yield from (f"{name}.{inner}" for inner in entry.names())
            table = table._parent
