"""What the program may say: the templates of all messages, notes, hints and status lines, found in its source.

A template is a text with ``{}`` for what is filled in. The source is read, not run: a call that makes a diagnostic is
followed from its parameters to the calls of the function around it, until code and texts are known together.
"""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

from program_source import Call, Function, Program, Scope, argument_of, called_name
from program_texts import DEEPEST, Texts, UnboundError, bound_arguments

_CODE = re.compile(r"[A-Z]{2,6}\d{3}")

_AMBIGUOUS = frozenset({"get", "pop", "setdefault", "update"})
"""Methods of dictionaries: who calls a method of ours that bears such a name cannot be told from the name."""

# Which argument of what makes a diagnostic is what: (position, keyword).
_SINKS = {
    "Diagnostic": {"code": (0, "code"), "message": (1, "message"), "hint": (5, "hint")},
    "Fault": {"code": (0, "code"), "message": (1, "message"), "hint": (4, "hint")},
    "report": {"message": (0, "message"), "hint": (4, "hint")},
    "Note": {"note": (0, "message")},
    "replace": {"hint": (9, "hint"), "message": (9, "message")},
    "localized": {"status_line": (0, "line")},
}


@dataclass(frozen=True, order=True)
class Said:
    """One text of the program.

    Attributes:
        kind: ``message``, ``note``, ``hint`` or ``status_line``.
        code: of the diagnostic; empty where it is not known, as for notes.
        template: the text with ``{}`` for what is filled in.
        place: ``file:line`` of the source that makes it.
    """

    kind: str
    code: str
    template: str
    place: str = field(compare=False)


class Templates:
    """Everything that the modules below a folder may say."""

    def __init__(self, package: Path) -> None:
        self._program = Program(package)
        self._texts = Texts(self._program)

    def said(self) -> list[Said]:
        """All texts, by kind, code and template."""
        found: dict[Said, None] = {}
        for name, roles in _SINKS.items():
            for call in self._program.calls[name]:
                for said in self._at(call, roles):
                    found.setdefault(said)
        for (_, name), values in self._program.attributes.items():
            for value, scope in values if name == "hint" else ():
                for text in self._texts.of(value, scope):
                    if re.search("[A-Za-z]", text):
                        place = scope.module.path.relative_to(self._program.package.parent)
                        found.setdefault(Said("hint", "", text, f"{place}:{value.lineno}"))
        return sorted(found)

    def _at(self, call: Call, roles: dict[str, tuple[int, str]]) -> Iterator[Said]:
        for scope in self._bindings(call, roles):
            given = {role: argument_of(call.node, *where) for role, where in roles.items()}
            if called_name(call.node.func) == "report":
                codes = self._codes_of_rule(call, scope)
                if not codes:
                    continue
            elif "code" in given:
                codes = {code for code in self._texts.of(given["code"], scope) if _CODE.fullmatch(code)} or {""}
            else:
                codes = {""}
            for code in codes:
                for kind in ("message", "note", "hint", "status_line"):
                    if given.get(kind) is None:
                        continue
                    for text in self._texts.of(given[kind], scope):
                        if re.search("[A-Za-z]", text):
                            yield Said(kind, code, text, self._program.where(call))

    def _codes_of_rule(self, call: Call, scope: Scope) -> set[str]:
        """The code of the rule whose `report` is called: the class around the call, or what `find_rule` was given."""
        if call.function is None or not isinstance(call.node.func, ast.Attribute):
            return set()
        receiver = call.node.func.value
        if isinstance(receiver, ast.Name) and receiver.id != "self":
            found = [value for _, value in call.function.assigned.get(receiver.id, ()) if isinstance(value, ast.Call)]
            return {code for value in found for code in self._texts.of(value.args[0], scope) if _CODE.fullmatch(code)}
        return {code for code in self._texts.of_class(call.function.owner, "code", scope, 0) if _CODE.fullmatch(code)}

    def _bindings(self, call: Call, roles: dict[str, tuple[int, str]]) -> Iterator[Scope]:
        """The scope of a call, once for each way in which the parameters that matter are given."""
        pending = [(Scope(call.module, call.function), 0)]
        while pending:
            scope, depth = pending.pop()
            try:
                for where in roles.values():
                    argument = argument_of(call.node, *where)
                    if argument is not None:
                        self._texts.of(argument, scope, asking=True)
            except UnboundError as asked:
                more = list(self._bound(asked.function, scope)) if depth < DEEPEST else []
                pending += [(each, depth + 1) for each in more] or [(self._unknown(asked.function, scope), depth + 1)]
            else:
                yield scope

    def _bound(self, function: Function, scope: Scope) -> Iterator[Scope]:
        calls = self._program.calls[function.called]
        if len(self._program.functions[function.called]) > 1:
            same = [call for call in calls if call.module is function.module]
            room = [call for call in calls if call.module.room == function.module.room]
            calls = same or room if function.node.name.startswith("_") else room or calls
        if function.owner and function.called in _AMBIGUOUS:
            return
        for call in calls:
            given = bound_arguments(function, call.node, Scope(call.module, call.function))
            yield _rebound(scope, function, given)

    def _unknown(self, function: Function, scope: Scope) -> Scope:
        return _rebound(scope, function, dict.fromkeys(function.names))


def _rebound(scope: Scope, function: Function, given: dict[str, tuple[ast.AST, Scope] | None]) -> Scope:
    """The scope with the parameters of a function bound: its own, or one on the way to its arguments."""
    known: dict[int, Scope] = {}

    def rebound(scope: Scope) -> Scope:
        if scope.bound is None:
            return Scope(scope.module, function, given) if scope.function is function else scope
        if id(scope) not in known:
            bound = {name: value and (value[0], rebound(value[1])) for name, value in scope.bound.items()}
            known[id(scope)] = Scope(scope.module, scope.function, bound)
        return known[id(scope)]

    return rebound(scope)
