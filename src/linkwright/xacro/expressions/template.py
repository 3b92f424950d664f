"""Texts with ``${...}`` and ``$(...)``, compiled once and evaluated in any scope.

If a text is exactly one token, its value keeps its type, such as a float or a list. Otherwise, the values of the
tokens are joined to a string. The result is not evaluated again.

The lexer splits a text into ``${expressions}``, ``$(substitutions)`` and literal text. It tries the rules of
ros/xacro in this order at each position:

- Two or more dollars before a brace or parenthesis lose one of them and make the bracket literal.
- ``${`` extends to the first ``}``.
- ``$(`` extends to the first ``)``.
- Anything else is literal text, which may contain single dollars.

Substitutions are ``$(arg name)``, ``$(find package)`` and similar commands. The text between the parentheses is split
at blanks into a command and its arguments. Each ``$(find ...)`` in the result is evaluated, too, so that the value of
an argument may contain one.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from enum import Enum

from linkwright.diagnostics import LinkwrightError, did_you_mean, foreign, joined, phrase, term
from linkwright.loading.lean_dataclasses import NamedTuple
from linkwright.loading.lean_typing import Any
from linkwright.xacro.cache import TextCompiler
from linkwright.xacro.expressions import sandbox
from linkwright.xacro.expressions.bounded import RefusalError
from linkwright.xacro.expressions.expression import Expression, compile_expression
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
_REFERENCE = r"\$\(([^()$]+)\)"  # not compiled here because few files need it


def substitute(body: str, session: Context) -> str:
    """Return the value of ``$(body)``.

    Raises:
        Fault: if the command is unknown, lacks arguments, or finds nothing. The offsets are relative to the body.
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
    """Return the value of an environment variable, or None if it is not set.

    Variables that every ROS installation sets have a default value.
    """
    value = os.environ.get(name)
    if value is not None:
        return value
    from linkwright.packages.ament import ROS_VARIABLES  # imported here because few robots need it

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
    """Return the fault for a package that is not found, with the message of the package finder."""
    diagnostic = error.diagnostics[0]
    fault = Fault(diagnostic.code, diagnostic.message, hint=diagnostic.hint)
    fault.notes.extend(diagnostic.notes)
    return fault


class TokenKind(Enum):
    """The kinds of tokens."""

    TEXT = "text"
    EXPRESSION = "expression"
    SUBSTITUTION = "substitution"


class Token(NamedTuple):
    """A token of a text.

    Attributes:
        kind: the kind of the token.
        text: the text that a TEXT token yields; for other kinds, the text between the brackets.
        start: the offset of the token's first character.
        end: the offset after the token's last character.
    """

    kind: TokenKind
    text: str
    start: int
    end: int


_PIECE = r"""(?x)
    \$(?P<escaped>\$+[{(])
  | \$\{(?P<expression>[^}]*)\}
  | \$\((?P<substitution>[^)]*)\)
  | (?P<text>[^$]+|\$[^{($]+|\$\Z)
    """  # not compiled here because small files seldom need it

_KINDS = {
    "escaped": TokenKind.TEXT,
    "expression": TokenKind.EXPRESSION,
    "substitution": TokenKind.SUBSTITUTION,
    "text": TokenKind.TEXT,
}


def tokenize(text: str) -> list[Token]:
    """Return the tokens of a text, which together cover the whole text.

    Raises:
        Fault: XAC101 for a bracket that is never closed or a dollar sign without a meaning.
    """
    if text.startswith("${") and text.find("}") == len(text) - 1:
        return [Token(TokenKind.EXPRESSION, text[2:-1], 0, len(text))]  # the usual form of a text with a dollar
    pattern = re.compile(_PIECE)
    tokens: list[Token] = []
    at = 0
    while at < len(text):
        match = pattern.match(text, at)
        if match is None:
            raise _not_a_token(text, at)
        name = match.lastgroup
        assert name is not None, "every alternative of the pattern is named"
        tokens.append(Token(_KINDS[name], match[name], at, match.end()))
        at = match.end()
    return tokens


def _not_a_token(text: str, at: int) -> Fault:
    for opening, closing in (("${", "}"), ("$(", ")")):
        if text.startswith(opening, at):
            message = phrase(
                "'{opening}' is never closed: '{shortened}'", opening=opening, shortened=_shortened(text[at:])
            )
            return Fault("XAC101", message, at, len(text), phrase("close it with '{closing}'", closing=closing))
    message = phrase("'$$' has no meaning here: '{shortened}'", shortened=_shortened(text[at:]))
    hint = phrase("'$$' is only for a literal '${' or '$('; write one '$' for a dollar sign")
    return Fault("XAC101", message, at, at + 2, hint)


def _shortened(text: str) -> str:
    return text if len(text) <= 60 else f"{text[:57]}..."


_Part = Callable[["Scope"], Any]
_BRACKET = len("${")


class Template:
    """A compiled text.

    Attributes:
        evaluate: the function that returns the value of the text in a scope. It raises a `Fault` whose offsets are
            relative to the text.
        changes: whether the evaluation may change a value, as ``${items.pop(0)}`` does.
    """

    __slots__ = ("changes", "evaluate")

    def __init__(self, text: str) -> None:
        self.changes = False
        tokens = tokenize(text)
        parts = [None if token.kind is TokenKind.TEXT else self._part(token) for token in tokens]
        only = parts[0] if len(parts) == 1 else None
        self.evaluate: _Part = only or _joined([token.text for token in tokens], parts)

    def _part(self, token: Token) -> _Part:
        kind, text, start, end = token
        if "$" in text:
            return self._nested(token)
        if kind is TokenKind.SUBSTITUTION:
            return _placed(lambda scope: substitute(text, scope.session), start, end)
        try:
            expression = Expression(text)
        except Fault as fault:
            fault.within(start, end, start + _BRACKET)
            raise
        self.changes = self.changes or expression.changes
        return _placed(expression.evaluate, start, end)

    def _nested(self, token: Token) -> _Part:
        """Return the part for a token whose content contains other tokens.

        The content is evaluated first, and its value is the source of the token.
        """
        kind, text, start, end = token
        inner = _placed(compile_template(text).evaluate, start, end)
        self.changes = True  # the source, and so its effects, are not known before the evaluation

        def part(scope: Scope) -> Any:
            source = _as_text(inner(scope))
            try:
                if kind is TokenKind.SUBSTITUTION:
                    return substitute(source, scope.session)
                return compile_expression(source).evaluate(scope)
            except Fault as fault:
                fault.within(start, end, start + _BRACKET if source == text else None)
                raise

        return part


_compiler = TextCompiler(Template)
templates = _compiler.forms
"""The templates compiled so far, by their texts."""


def compile_template(text: str) -> Template:
    """Return the compiled form of a text, which is cached by text.

    Raises:
        Fault: XAC101 or XAC102 if the text is malformed.
    """
    return templates.get(text) or _compiler.make(text)


def _placed(evaluate: _Part, start: int, end: int) -> _Part:
    def part(scope: Scope) -> Any:
        try:
            return evaluate(scope)
        except Fault as fault:
            fault.within(start, end, start + _BRACKET)
            raise

    return part


def _joined(texts: list[str], parts: list[_Part | None]) -> _Part:
    """Return a function that evaluates the parts of a text and joins their values to a string.

    Where a part is None, the text at the same index is used.
    """
    evaluated = [(place, part) for place, part in enumerate(parts) if part is not None]

    def join(scope: Scope) -> str:
        pieces = texts.copy()
        for place, part in evaluated:
            value = part(scope)
            pieces[place] = value if value.__class__ is str else _as_text(value)
        try:
            return sandbox.joined(pieces)
        except RefusalError as error:
            raise Fault("XAC202", phrase("cannot write the value: {error}", error=foreign(error))) from None

    return join


def _as_text(value: Any) -> str:
    if value.__class__ is str:
        return value
    try:
        return sandbox.as_text(value)
    except (RefusalError, ValueError) as error:
        raise Fault("XAC202", phrase("cannot write the value: {error}", error=foreign(error))) from None
