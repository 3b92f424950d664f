"""Outlines of launch files, which are read but not run: their actions with their settings."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from linkwright.diagnostics import Span

CONDITION = "condition"
NAMESPACE = "namespace"
NAMESPACE_OF_INCLUDED = "namespace of its nodes"
"""The setting of an include that is not one of the arguments that it passes."""
REMAPPING = "remapping "
READING = "reading"
PARAMETER = "parameter "
_VARIABLE = re.compile(r"\$\((?:var|arg) (?P<name>[^() ]+)(?: (?P<default>[^()]*))?\)")
_MAX_DEPTH = 5
"""The number of variables whose values may contain variables."""
_MAX_LENGTH = 10_000


@dataclass(frozen=True)
class Entry:
    """An action of a launch file.

    Attributes:
        kind: ``argument``, ``variable``, ``node``, ``process``, ``include``; ``remapping``, ``parameter``,
            ``parameters`` or ``environment`` of all nodes that follow; ``reading`` of an environment variable;
            ``handler`` of an event; ``action`` of a package that is not read.
        name: the name of the argument or variable, ``package/executable`` of the node, the command, the path of the
            file, or the function that makes the action.
        settings: the values, by name. The value of an argument is its default.
        span: where it is.
    """

    kind: str
    name: str
    settings: dict[str, str]
    span: Span

    @property
    def has_value(self) -> bool:
        """Whether it declares an argument or sets a variable."""
        return self.kind in ("argument", "variable")

    def is_same_name(self, setting: str, old: str | None, new: str | None) -> bool:
        """Return whether a changed setting is a remapping of a name to itself, which is the same as none."""
        if self.kind == "node" and setting.startswith(REMAPPING):
            source = setting.removeprefix(REMAPPING)
        elif self.kind == "remapping" and setting == "to":
            source = self.name
        else:
            return False
        return (old or source) == (new or source)


@dataclass(frozen=True)
class CodePart:
    """A statement or element of a launch file that makes no action.

    Attributes:
        text: a form without names of variables, comments and layout.
        source: the statement as it is written.
        span: where it is.
        failing_condition: the condition under which the statement ends the launch with an error; empty for other
            statements.
    """

    text: str
    source: str
    span: Span
    failing_condition: str = ""


@dataclass(frozen=True)
class LaunchOutline:
    """The outline of a launch file.

    Attributes:
        entries: the entries in the order of the text.
        code: the rest of the file.
    """

    entries: list[Entry]
    code: list[CodePart]

    def resolved(self, text: str) -> str:
        """Return a text with the defaults of arguments in place of ``$(var NAME)``."""
        for _ in range(_MAX_DEPTH):
            resolved = _VARIABLE.sub(self._value, text)
            if resolved == text or len(resolved) > _MAX_LENGTH:
                break
            text = resolved
        return text

    def _value(self, variable: re.Match[str]) -> str:
        value = self._values.get(variable["name"], variable["default"])
        return variable[0] if value is None else value

    @cached_property
    def _values(self) -> dict[str, str]:
        """The defaults and values of arguments, and those of variables, if there is only one, by name."""
        values: dict[str, set[str]] = {}
        for entry in self.entries:
            value = entry.settings.get("value", entry.settings.get("default"))
            if entry.has_value and value is not None:
                values.setdefault(entry.name, set()).add(value)
        return {name: next(iter(found)) for name, found in values.items() if len(found) == 1}


@dataclass(frozen=True)
class Scope:
    """The settings that enclosing groups give to an action.

    Attributes:
        conditions: the conditions of the groups, the outermost first.
        namespaces: the namespaces that they push.
    """

    conditions: tuple[str, ...] = ()
    namespaces: tuple[str, ...] = ()

    @property
    def depth(self) -> int:
        """The number of settings."""
        return len(self.conditions) + len(self.namespaces)

    def under(self, condition: str) -> Scope:
        """Return the scope inside an action with a condition, which is empty if it has none."""
        return Scope((*self.conditions, condition), self.namespaces) if condition else self

    def pushed(self, namespace: str) -> Scope:
        """Return the scope after a namespace is pushed."""
        return Scope(self.conditions, (*self.namespaces, namespace)) if namespace else self

    def settings(self, kind: str, own: Mapping[str, str]) -> dict[str, str]:
        """Return the settings of an action with those of its scope."""
        settings = dict(own)
        conditions = [*self.conditions, *filter(None, [own.get(CONDITION)])]
        settings.pop(CONDITION, None)
        if conditions:
            settings[CONDITION] = " and ".join(dict.fromkeys(conditions))
        key = NAMESPACE if kind == "node" else NAMESPACE_OF_INCLUDED
        if self.namespaces and kind in ("node", "include"):
            settings[key] = _joined_namespace([*self.namespaces, *filter(None, [own.get(key)])])
        return settings


def _joined_namespace(names: Sequence[str]) -> str:
    """Return the namespace after pushes; a name that begins with ``/`` replaces those before it."""
    text = ""
    for name in names:
        text = name if name.startswith("/") or not text else f"{text}/{name}"
    return text
