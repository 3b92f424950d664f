"""Substitution arguments: ``$(arg name)``, ``$(find package)`` and their like.

The text between the parentheses is split at blanks into a command and its arguments. Each ``$(find ...)`` in the result
is evaluated too, so that the value of an argument may contain one.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable

from linkwright.diagnostics import LinkwrightError, did_you_mean, joined, phrase, term
from linkwright.loading.lean_typing import Any
from linkwright.xacro.expressions.expression import compile_expression
from linkwright.xacro.expressions.sandbox import as_text
from linkwright.xacro.expressions.scope import Context, Scope
from linkwright.xacro.expressions.symbols import MATHEMATICS
from linkwright.xacro.faults import Fault

_COMMANDS = ("arg", "find", "env", "optenv", "dirname", "cwd", "eval")
_KNOWN = phrase("the commands are {commands}", commands=joined(_COMMANDS))
_NO_DIRECTORY = phrase("ros/xacro knows the command 'dirname', but it always fails")
_INSTEAD_OF_DIRECTORY = phrase(
    "write $(find PACKAGE)/FOLDER, or ${xacro.abs_filename('FILE')} for a file beside this one"
)
_REFERENCE = r"\$\(([^()$]+)\)"  # not compiled here: few files need it


def substitute(body: str, session: Context) -> str:
    """The value of ``$(body)``.

    Raises:
        Fault: the command is unknown, lacks its arguments, or finds nothing; the offsets count from the beginning of
            the body.
    """
    if not body:
        return "$()"
    if body == "cwd":
        return session.working_directory
    if body.startswith("eval "):
        return _evaluated(body[len("eval ") :], session)
    _check_characters(body)
    value = _command(body, session, only_find=False)
    if "$(" not in value:
        return value
    return re.sub(_REFERENCE, lambda match: _found_again(match[0], match[1], session), value)


def _check_characters(body: str) -> None:
    for sign in "$(":
        at = body.find(sign)
        if at >= 0:
            raise Fault("XAC213", phrase("'{sign}' is not allowed inside '$(...)'", sign=sign), at, at + 1)


def _found_again(text: str, body: str, session: Context) -> str:
    words = body.split()
    if words and words[0] in _COMMANDS and words[0] != "find":
        return text
    return _command(body, session, only_find=True)


def _command(body: str, session: Context, *, only_find: bool) -> str:
    words = [word for word in body.split(" ") if word]
    if not words:
        raise Fault("XAC213", phrase("there is no command between the parentheses"), hint=_KNOWN)
    command = words[0]
    evaluate = _EVALUATE.get(command)
    if evaluate is None:
        hint = did_you_mean(command, _COMMANDS) or _KNOWN
        at = body.find(command)
        raise Fault(
            "XAC212", phrase("unknown substitution command '{command}'", command=command), at, at + len(command), hint
        )
    try:
        return evaluate(words[1:], session)
    except Fault as fault:
        if fault.start is None and len(words) > 1 and not only_find:
            fault.start = body.find(words[1], len(command))
            fault.end = fault.start + len(words[1])
        raise


def _one(command: str, what: str, words: list[str]) -> str:
    if len(words) != 1:
        raise Fault(
            "XAC213",
            phrase(
                "'$({command} ...)' takes one {what}, but {count} are given",
                command=command,
                what=term(what),
                count=len(words),
            )
            if words
            else phrase("'$({command} ...)' takes one {what}, but none is given", command=command, what=term(what)),
        )
    return words[0]


def _argument(words: list[str], session: Context) -> str:
    return session.argument(_one("arg", "name", words))


def _package(words: list[str], session: Context) -> str:
    return session.package(_one("find", "package", words))


def _variable(words: list[str], _session: Context) -> str:
    name = _one("env", "name", words)
    value = _environment(name)
    if value is None:
        hint = phrase("write $(optenv {name} DEFAULT) if it may be unset", name=name)
        raise Fault("XAC214", phrase("the environment variable '{name}' is not set", name=name), hint=hint)
    return value


def _optional_variable(words: list[str], _session: Context) -> str:
    if not words:
        raise Fault("XAC213", phrase("'$(optenv ...)' takes a name and a default, but neither is given"))
    value = _environment(words[0])
    return " ".join(words[1:]) if value is None else value


def _environment(name: str) -> str | None:
    """A variable of the environment; those that each ROS installation sets are there without one, too."""
    value = os.environ.get(name)
    if value is not None:
        return value
    from linkwright.packages.ament import ROS_VARIABLES  # few robots need the room of packages for it

    return ROS_VARIABLES.get(name)


def _directory(_words: list[str], session: Context) -> str:
    session.warn("XAC904", _NO_DIRECTORY, hint=_INSTEAD_OF_DIRECTORY)
    return os.path.dirname(os.path.realpath(session.file))  # noqa: PTH120 - pathlib takes long to import


_EVALUATE: dict[str, Callable[[list[str], Context], str]] = {
    "arg": _argument,
    "find": _package,
    "env": _variable,
    "optenv": _optional_variable,
    "dirname": _directory,
}


def _evaluated(source: str, session: Context) -> str:
    scope = Scope(None, session, _names_for_eval(session))
    try:
        return as_text(compile_expression(source).evaluate(scope))
    except Fault as fault:
        if fault.start is not None and fault.end is not None:
            fault.start, fault.end = fault.start + len("eval "), fault.end + len("eval ")
        if source.count("(") > source.count(")"):
            fault.hint = phrase("the first ')' ends the substitution; write ${...} for an expression with parentheses")
        raise


def _names_for_eval(session: Context) -> dict[str, Any]:
    names: dict[str, Any] = {name: _typed(value) for name, value in session.arguments.items()}
    names.update(MATHEMATICS)
    names.update({"list": list, "dict": dict, "map": map, "str": str, "float": float, "int": int})
    names.update({"true": True, "false": False})
    names["arg"] = lambda name: _typed(session.argument(name))
    names["env"] = lambda name: _variable([name], session)
    names["optenv"] = lambda name, default="": default if (value := _environment(name)) is None else value
    names["find"] = session.package
    return names


def _typed(value: str) -> Any:
    try:
        return float(value) if "." in value else int(value)
    except ValueError:
        return {"true": True, "false": False}.get(value.lower(), value)


def package_fault(error: LinkwrightError) -> Fault:
    """The fault for a package that is not found, with the message of the package finder."""
    diagnostic = error.diagnostics[0]
    fault = Fault(diagnostic.code, diagnostic.message, hint=diagnostic.hint)
    fault.notes.extend(diagnostic.notes)
    return fault
