"""Texts with ``${...}`` and ``$(...)``, compiled once and evaluated in any scope.

If a text is exactly one token, its value keeps its type, such as a float or a list. Otherwise, the values of the
tokens are joined to a string. The result is not evaluated again.

The lexer splits a text into ``${expressions}``, ``$(substitutions)`` and literal text. It tries the rules of
ros/xacro in this order at each position:

- If two or more dollars precede a brace or parenthesis, one dollar is removed and the bracket is literal.
- ``${`` extends to the first ``}``.
- ``$(`` extends to the first ``)``.
- Anything else is literal text, which may contain single dollars.

Substitutions are ``$(arg name)``, ``$(find package)`` and similar commands. The text between the parentheses is split
at spaces into a command and its arguments. Each ``$(find ...)`` in the result is evaluated, too, so that the value of
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
from linkwright.xacro.expressions.builtin_names import MATHEMATICS
from linkwright.xacro.expressions.expression import Expression, compile_expression
from linkwright.xacro.expressions.sandbox import as_text
from linkwright.xacro.expressions.scope import Context, Scope
from linkwright.xacro.faults import Fault

_COMMANDS = ("arg", "find", "env", "optenv", "dirname", "cwd", "eval")
_COMMANDS_HINT = phrase("the commands are {commands}", commands=joined(_COMMANDS))
_DIRNAME_WARNING = phrase("the command 'dirname' always fails in ros/xacro")
_DIRNAME_HINT = phrase("write $(find PACKAGE)/FOLDER, or ${xacro.abs_filename('FILE')} for a file beside this one")
_SUBSTITUTION = r"\$\(([^()$]+)\)"  # compiled on first use, because few files need it


def substitute(body: str, session: Context) -> str:
    """Return the value of ``$(body)``.

    Raises:
        Fault: if the command does not exist, lacks arguments, or fails. The offsets are relative to the body.
    """
    if not body:
        return "$()"
    if body == "cwd":
        return session.working_directory
    if body.startswith("eval "):
        return _eval_text(body[len("eval ") :], session)
    _check_characters(body)
    value = _run_command(body, session, only_find=False)
    if "$(" not in value:
        return value
    return re.sub(_SUBSTITUTION, lambda match: _evaluate_find(match[0], match[1], session), value)


def _check_characters(body: str) -> None:
    for character in "$(":
        offset = body.find(character)
        if offset >= 0:
            raise Fault(
                "XAC213",
                phrase("'{character}' is not allowed inside '$(...)'", character=character),
                offset,
                offset + 1,
            )


def _evaluate_find(text: str, body: str, session: Context) -> str:
    words = body.split()
    if words and words[0] in _COMMANDS and words[0] != "find":
        return text
    return _run_command(body, session, only_find=True)


def _run_command(body: str, session: Context, *, only_find: bool) -> str:
    words = [word for word in body.split(" ") if word]
    if not words:
        raise Fault("XAC213", phrase("there is no command between the parentheses"), hint=_COMMANDS_HINT)
    command = words[0]
    evaluate = _COMMAND_FUNCTIONS.get(command)
    if evaluate is None:
        hint = did_you_mean(command, _COMMANDS) or _COMMANDS_HINT
        offset = body.find(command)
        raise Fault(
            "XAC212",
            phrase("there is no substitution command '{command}'", command=command),
            offset,
            offset + len(command),
            hint,
        )
    try:
        return evaluate(words[1:], session)
    except Fault as fault:
        if fault.start is None and len(words) > 1 and not only_find:
            fault.start = body.find(words[1], len(command))
            fault.end = fault.start + len(words[1])
        raise


def _check_single_argument(command: str, argument_kind: str, words: list[str]) -> str:
    if len(words) != 1:
        raise Fault(
            "XAC213",
            phrase(
                "'$({command} ...)' takes one {argument}, but {count} are given",
                command=command,
                argument=term(argument_kind),
                count=len(words),
            )
            if words
            else phrase(
                "'$({command} ...)' takes one {argument}, but none is given",
                command=command,
                argument=term(argument_kind),
            ),
        )
    return words[0]


def _arg_value(words: list[str], session: Context) -> str:
    return session.argument(_check_single_argument("arg", "name", words))


def _package_folder(words: list[str], session: Context) -> str:
    return session.package(_check_single_argument("find", "package", words))


def _env_value(words: list[str], _session: Context) -> str:
    name = _check_single_argument("env", "name", words)
    value = _environment_value(name)
    if value is None:
        hint = phrase("write $(optenv {name} DEFAULT) if it may be unset", name=name)
        raise Fault("XAC214", phrase("the environment variable '{name}' is not set", name=name), hint=hint)
    return value


def _optenv_value(words: list[str], _session: Context) -> str:
    if not words:
        raise Fault("XAC213", phrase("'$(optenv ...)' takes a name and a default, but neither is given"))
    value = _environment_value(words[0])
    return " ".join(words[1:]) if value is None else value


def _environment_value(name: str) -> str | None:
    """Return the value of an environment variable, or None if it is not set.

    Variables that every ROS installation sets have a default value.
    """
    value = os.environ.get(name)
    if value is not None:
        return value
    from linkwright.packages.ament import ROS_VARIABLES  # imported here because few robots need it

    return ROS_VARIABLES.get(name)


def _dirname_value(_words: list[str], session: Context) -> str:
    session.warn("XAC904", _DIRNAME_WARNING, hint=_DIRNAME_HINT)
    return os.path.dirname(os.path.realpath(session.file))  # noqa: PTH120 - pathlib takes long to import


_COMMAND_FUNCTIONS: dict[str, Callable[[list[str], Context], str]] = {
    "arg": _arg_value,
    "find": _package_folder,
    "env": _env_value,
    "optenv": _optenv_value,
    "dirname": _dirname_value,
}


def _eval_text(source: str, session: Context) -> str:
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
    names: dict[str, Any] = {name: _convert_value(value) for name, value in session.arguments.items()}
    names.update(MATHEMATICS)
    names.update({"list": list, "dict": dict, "map": map, "str": str, "float": float, "int": int})
    names.update({"true": True, "false": False})
    names["arg"] = lambda name: _convert_value(session.argument(name))
    names["env"] = lambda name: _env_value([name], session)
    names["optenv"] = lambda name, default="": default if (value := _environment_value(name)) is None else value
    names["find"] = session.package
    return names


def _convert_value(value: str) -> Any:
    try:
        return float(value) if "." in value else int(value)
    except ValueError:
        return {"true": True, "false": False}.get(value.lower(), value)


def package_fault(error: LinkwrightError) -> Fault:
    """Convert the package finder's error for a missing package to a fault."""
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


_TOKENS = r"""(?x)
    \$(?P<escaped>\$+[{(])
  | \$\{(?P<expression>[^}]*)\}
  | \$\((?P<substitution>[^)]*)\)
  | (?P<text>[^$]+|\$[^{($]+|\$\Z)
    """  # compiled on first use, because small files seldom need it

_KINDS = {
    "escaped": TokenKind.TEXT,
    "expression": TokenKind.EXPRESSION,
    "substitution": TokenKind.SUBSTITUTION,
    "text": TokenKind.TEXT,
}


def tokenize(text: str) -> list[Token]:
    """Split a text into tokens that cover the whole text.

    Raises:
        Fault: XAC101 for a bracket that is never closed or a dollar sign without a meaning.
    """
    if text.startswith("${") and text.find("}") == len(text) - 1:
        return [Token(TokenKind.EXPRESSION, text[2:-1], 0, len(text))]  # the usual form of a text with a dollar
    pattern = re.compile(_TOKENS)
    tokens: list[Token] = []
    offset = 0
    while offset < len(text):
        match = pattern.match(text, offset)
        if match is None:
            raise _make_token_fault(text, offset)
        name = match.lastgroup
        assert name is not None, "every alternative of the pattern is named"
        tokens.append(Token(_KINDS[name], match[name], offset, match.end()))
        offset = match.end()
    return tokens


def _make_token_fault(text: str, offset: int) -> Fault:
    for opening, closing in (("${", "}"), ("$(", ")")):
        if text.startswith(opening, offset):
            message = phrase(
                "'{opening}' is never closed: '{shortened}'", opening=opening, shortened=_shorten(text[offset:])
            )
            return Fault("XAC101", message, offset, len(text), phrase("close it with '{closing}'", closing=closing))
    message = phrase("'$$' has no meaning here: '{shortened}'", shortened=_shorten(text[offset:]))
    hint = phrase("'$$' is only for a literal '${' or '$('; write one '$' for a dollar sign")
    return Fault("XAC101", message, offset, offset + 2, hint)


def _shorten(text: str) -> str:
    return text if len(text) <= 60 else f"{text[:57]}..."


_Part = Callable[["Scope"], Any]
_BRACKET_LENGTH = len("${")


class Template:
    """A compiled text.

    Attributes:
        evaluate: the function that returns the value of the text in a scope. It raises a `Fault` whose offsets are
            relative to the text.
        may_change_values: whether the evaluation may change a value, as ``${items.pop(0)}`` does.
    """

    __slots__ = ("evaluate", "may_change_values")

    def __init__(self, text: str) -> None:
        self.may_change_values = False
        tokens = tokenize(text)
        parts = [None if token.kind is TokenKind.TEXT else self._compile_part(token) for token in tokens]
        single_part = parts[0] if len(parts) == 1 else None
        self.evaluate: _Part = single_part or _join_parts([token.text for token in tokens], parts)

    def _compile_part(self, token: Token) -> _Part:
        kind, text, start, end = token
        if "$" in text:
            return self._compile_nested(token)
        if kind is TokenKind.SUBSTITUTION:
            return _with_offsets(lambda scope: substitute(text, scope.session), start, end)
        try:
            expression = Expression(text)
        except Fault as fault:
            fault.shift_to_enclosing_text(start, end, start + _BRACKET_LENGTH)
            raise
        self.may_change_values = self.may_change_values or expression.may_change_values
        return _with_offsets(expression.evaluate, start, end)

    def _compile_nested(self, token: Token) -> _Part:
        """Return the evaluator for a token that contains other tokens.

        The inner tokens are evaluated first; their value is the source of the outer token.
        """
        kind, text, start, end = token
        inner = _with_offsets(compile_template(text).evaluate, start, end)
        self.may_change_values = True  # the source, and so its effects, are not known before the evaluation

        def part(scope: Scope) -> Any:
            source = _to_checked_text(inner(scope))
            try:
                if kind is TokenKind.SUBSTITUTION:
                    return substitute(source, scope.session)
                return compile_expression(source).evaluate(scope)
            except Fault as fault:
                fault.shift_to_enclosing_text(start, end, start + _BRACKET_LENGTH if source == text else None)
                raise

        return part


_compiler = TextCompiler(Template)
templates = _compiler.forms
"""The templates compiled so far, by text."""


def compile_template(text: str) -> Template:
    """Return the compiled form of a text, from the cache if possible.

    Raises:
        Fault: XAC101 or XAC102 if the text is malformed.
    """
    return templates.get(text) or _compiler.make(text)


def _with_offsets(evaluate: _Part, start: int, end: int) -> _Part:
    def part(scope: Scope) -> Any:
        try:
            return evaluate(scope)
        except Fault as fault:
            fault.shift_to_enclosing_text(start, end, start + _BRACKET_LENGTH)
            raise

    return part


def _join_parts(texts: list[str], parts: list[_Part | None]) -> _Part:
    """Return a function that evaluates the parts of a text and joins their values to a string.

    If a part is None, the text at the same index is used instead.
    """
    indexed_parts = [(index, part) for index, part in enumerate(parts) if part is not None]

    def join(scope: Scope) -> str:
        pieces = texts.copy()
        for position, part in indexed_parts:
            value = part(scope)
            pieces[position] = value if value.__class__ is str else _to_checked_text(value)
        try:
            return sandbox.join_strings(pieces)
        except RefusalError as error:
            raise Fault("XAC202", phrase("cannot write the value: {error}", error=foreign(error))) from None

    return join


def _to_checked_text(value: Any) -> str:
    if value.__class__ is str:
        return value
    try:
        return sandbox.as_text(value)
    except (RefusalError, ValueError) as error:
        raise Fault("XAC202", phrase("cannot write the value: {error}", error=foreign(error))) from None
