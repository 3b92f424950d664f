"""Macros: their parameters, and the tables they are found in."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import lru_cache

from linkwright.diagnostics import phrase
from linkwright.loading.lean_dataclasses import NamedTuple
from linkwright.xacro.faults import Fault
from linkwright.xmltree import Element

# Not compiled here: not every file needs them.
_PARAMETER = r"\s*(?P<name>[^\s:=]+?)\s*:?=\s*(?P<forward>\^\|?)?(?P<expression>(?:\$\{.*?\}|\$\(.*?\))(?=\s|$))?"
_BARE = r"\s*(?P<name>\S+)\s*"


class Parameter(NamedTuple):
    """A parameter of a macro.

    Attributes:
        name: its name; that of a block begins with one or two asterisks.
        default: the text of its default, or None.
        forward: whether it takes the caller's property of the same name if it has no argument.
        start: offset of its name in the list of parameters.
        default_start: offset of its default there.
    """

    name: str
    default: str | None
    forward: bool
    start: int
    default_start: int

    @property
    def is_block(self) -> bool:
        """Whether it takes an element of the call rather than an attribute."""
        return self.name.startswith("*")


@lru_cache(maxsize=2000)
def parse_parameters(text: str) -> tuple[Parameter, ...]:
    """The parameters that the ``params`` of a macro declare.

    Raises:
        Fault: XAC412 for a default whose quotes do not match.
    """
    parameters: list[Parameter] = []
    with_sign: dict[str, Parameter] = {}
    ends = _ends_of_words(text)
    with_default, bare = re.compile(_PARAMETER), re.compile(_BARE)
    at = 0
    while at < len(text):
        match = with_default.match(text, at)
        if match is not None:
            start = match.end() if match["expression"] is None else match.start("expression")
            at = match.end() if start < match.end() else ends[start]
            if at < 0:
                end = len(text.rstrip())
                message = phrase("this parameter's default has a quote that is never closed")
                raise Fault("XAC412", message, match.start("name"), end)
            name = match["name"]
            parameter = Parameter(name, text[start:at] or None, bool(match["forward"]), match.start("name"), start)
            with_sign[name] = parameter
        else:
            match = bare.match(text, at)
            if match is None:
                break  # only blanks are left
            at = match.end()
            parameter = Parameter(match["name"], None, False, match.start("name"), match.end("name"))
        parameters.append(parameter)
    # Of parameters declared twice the default that is written last holds for all, as in ros/xacro.
    return tuple(with_sign.get(parameter.name, parameter) for parameter in parameters)


def _ends_of_words(text: str) -> list[int]:
    """Return where the word that begins at each offset ends, or -1 where a quote in it is never closed.

    A word ends at a blank, and in quotes there may be blanks. As in ros/xacro, a quote is closed by the first one of
    its kind behind which the word can end: ``'''`` is one word, a quote in quotes.
    """
    ends = [len(text)] * (len(text) + 1)
    behind = {"'": -1, '"': -1}  # where a word ends that continues behind the nearest closing quote
    for at in range(len(text) - 1, -1, -1):
        letter, following = text[at], ends[at + 1]
        if letter.isspace():
            ends[at] = at
            if letter == "\n":
                behind = dict.fromkeys(behind, -1)
        elif letter in behind:
            ends[at] = behind[letter]
            if following >= 0:
                behind[letter] = following
        else:
            ends[at] = following
    return ends


class Macro:
    """A macro.

    Attributes:
        name: its name.
        parameters: its parameters, in the order of their declaration.
        known: their names.
        body: the element that holds its body.
    """

    __slots__ = ("body", "known", "name", "parameters")

    def __init__(self, name: str, parameters: tuple[Parameter, ...], body: Element) -> None:
        self.name = name
        self.parameters = parameters
        self.known = frozenset(parameter.name for parameter in parameters)
        self.body = body


class MacroTable:
    """The macros of a scope, and the table around it; a namespace's table has none around it."""

    __slots__ = ("_entries", "_parent")

    def __init__(self, parent: MacroTable | None = None) -> None:
        self._parent = parent
        self._entries: dict[str, Macro | MacroTable] = {}

    def define(self, name: str, entry: Macro | MacroTable) -> None:
        """Give a name to a macro or to the table of a namespace; an earlier one of that name is forgotten."""
        self._entries[name] = entry

    def find(self, name: str) -> Macro | MacroTable | None:
        """Look a name up, here and then in the tables around."""
        table: MacroTable | None = self
        while table is not None:
            entry = table._entries.get(name)
            if entry is not None:
                return entry
            table = table._parent
        return None

    def names(self) -> Iterator[str]:
        """The full names of all macros that can be called from here."""
        table: MacroTable | None = self
        while table is not None:
            for name, entry in table._entries.items():
                if isinstance(entry, Macro):
                    yield name
                else:
                    yield from (f"{name}.{inner}" for inner in entry.names())
            table = table._parent
