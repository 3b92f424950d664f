"""Expressions: the subset of Python that ``${...}`` may contain.

Python itself parses an expression. The syntax tree is turned, once for each text, into nested closures (see
`compiler`), so no text is ever passed to Python's ``eval``.
"""

from __future__ import annotations

import _ast as ast  # _ast only has the node classes, whereas the import of ast is slow
import re
from types import GeneratorType

from linkwright.diagnostics import foreign, phrase
from linkwright.diagnostics.lookalikes import lookalike_hint
from linkwright.loading.lean_typing import Any
from linkwright.xacro.cache import TextCompiler
from linkwright.xacro.expressions.compiler import FAILURES, Closure, Compiler, fault_from_error
from linkwright.xacro.expressions.scope import Scope
from linkwright.xacro.faults import Fault

_MAX_LENGTH = 20_000
_ITERATOR_TYPES = frozenset({GeneratorType, enumerate, filter, map, reversed, zip})
"""Types of iterators that are exhausted immediately: thousands of nested iterators would overflow the stack."""
_WARNING_TRIGGERS = r"\\|\d\.?[^\W\d]"  # compiled on first use, because few files need it
_CLOSING_BRACKETS = {"(": ")", "[": "]"}
_SYNTAX_HINTS = (
    ("{", phrase("'}' ends the expression, so there is no way to write a dict or set in it; load one from YAML")),
    ("&&", phrase("write 'and'")),
    ("||", phrase("write 'or'")),
    ("!", phrase("write 'not'")),
    ("$", phrase("write names in an expression without a dollar sign")),
    ("?", phrase("write 'A if CONDITION else B'")),
)


class Expression:
    """A compiled expression.

    Attributes:
        source: the text of the expression.
        evaluate: the function that returns the value of the expression in a scope. It raises a `Fault` whose offsets
            are relative to the source.
        may_change_values: whether the evaluation may change a value, as ``items.pop(0)`` does.
    """

    __slots__ = ("evaluate", "may_change_values", "source")

    def __init__(self, source: str) -> None:
        self.source = source
        stripped = source.strip()
        compiler = Compiler(stripped, len(source) - len(source.lstrip()))
        if stripped.isidentifier() and stripped.isascii() and stripped not in _KEYWORDS:
            self.evaluate: Closure = compiler.name(stripped, 0)
        else:
            self.evaluate = _exhaust_iterator(compiler.compile(_parse(source, stripped).body), source)
        self.may_change_values = compiler.may_change_values


_KEYWORDS = frozenset(
    {
        *("False", "None", "True", "and", "as", "assert", "async", "await", "break", "class", "continue", "def"),
        *("del", "elif", "else", "except", "finally", "for", "from", "global", "if", "import", "in", "is"),
        *("lambda", "nonlocal", "not", "or", "pass", "raise", "return", "try", "while", "with", "yield"),
    }
)


_compiler = TextCompiler(Expression)
expressions = _compiler.forms
"""The expressions compiled so far, by source. The expressions inside templates are not included."""


def compile_expression(source: str) -> Expression:
    """Return the compiled form of an expression, from the cache if possible.

    Raises:
        Fault: XAC102 or XAC204 if the expression is malformed or forbidden.
    """
    return expressions.get(source) or _compiler.make(source)


def _exhaust_iterator(closure: Closure, source: str) -> Closure:
    """Return a closure that evaluates all items of an iterator immediately."""

    def evaluate(scope: Scope) -> Any:
        try:
            value = closure(scope)
            return iter(list(value)) if value.__class__ in _ITERATOR_TYPES else value
        except FAILURES as error:  # an error during the iteration, such as in a generator
            raise fault_from_error(error, source.strip(), 0, len(source)) from None

    return evaluate


def is_identifier(name: str) -> bool:
    """Return whether a name is valid for a property: a Python identifier that is not a keyword.

    If Python treats two forms of a name as equal, such as a ligature and its letters, only the plain form is valid.
    """
    if not name.isascii():
        from unicodedata import normalize

        if normalize("NFKC", name) != name:
            return False
    return name.isidentifier() and name not in _KEYWORDS


def _parse(source: str, stripped: str) -> ast.Expression:
    if not stripped:
        raise Fault(
            "XAC102", phrase("the expression is empty"), hint=phrase("write a property or a value between the braces")
        )
    if len(stripped) > _MAX_LENGTH:
        raise Fault("XAC102", phrase("the expression is longer than {longest:,} characters", longest=_MAX_LENGTH))
    try:
        if re.search(_WARNING_TRIGGERS, stripped):
            import warnings

            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                return _parse_syntax_tree(stripped)
        return _parse_syntax_tree(stripped)
    except SyntaxError as error:
        raise _make_syntax_fault(source, stripped, error) from None
    except (ValueError, MemoryError, RecursionError) as error:
        raise Fault(
            "XAC102",
            phrase(
                "'{shortened}' is not an expression: {error}",
                shortened=_shorten(stripped),
                error=foreign(str(error) or phrase("it is nested too deeply")),
            ),
        ) from None


def _parse_syntax_tree(source: str) -> ast.Expression:
    tree = compile(source, "<expression>", "eval", ast.PyCF_ONLY_AST)
    assert isinstance(tree, ast.Expression), "the mode 'eval' returns an ast.Expression"
    return tree


def _make_syntax_fault(source: str, stripped: str, error: SyntaxError) -> Fault:
    reason = error.msg.removeprefix("f-string: ")
    message = phrase("'{shortened}' is not an expression: {error}", shortened=_shorten(stripped), error=foreign(reason))
    hint = next((hint for sign, hint in _SYNTAX_HINTS if sign in stripped), None)
    if "!=" in stripped and hint == "write 'not'":
        hint = None
    if hint is None and "invalid character" in reason:
        hint = lookalike_hint(stripped)
    if hint is None and "was never closed" in reason:
        hint = phrase("close it with '{closing}'", closing=_CLOSING_BRACKETS.get(reason[1:2], ")"))
    fault = Fault("XAC102", message, hint=hint)
    lines = stripped.split("\n")
    if error.lineno and error.offset and error.lineno <= len(lines):
        leading_blanks = len(source) - len(source.lstrip())
        line_start = sum(len(line) + 1 for line in lines[: error.lineno - 1])
        offset = min(line_start + error.offset - 1, max(0, len(stripped) - 1))
        fault.start, fault.end = leading_blanks + offset, leading_blanks + offset + 1
    return fault


def _shorten(text: str) -> str:
    text = " ".join(text.split())
    return text if len(text) <= 60 else f"{text[:57]}..."
