"""The properties, arguments and packages that a text uses, found without evaluating it.

Names are used in ``${...}`` and ``$(...)``. The lexer of the xacro room splits the text, and Python's `ast` parses the
expressions. A text that composes a name from values is *open*: the names that it uses are not known before the
evaluation.
"""

from __future__ import annotations

import ast
import warnings
from collections.abc import Iterator
from functools import lru_cache

from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import dataclass, field
from linkwright.xacro.expressions.template import Token, TokenKind, tokenize
from linkwright.xacro.faults import Fault

_IDENTIFIER = lazy_pattern(r"[^\W\d]\w*")
_PLACEHOLDER = "pasted_here__"
DEPRECATED = {
    "load_yaml": "xacro.load_yaml",
    "abs_filename": "xacro.abs_filename",
    "dotify": "xacro.dotify",
    "sorted": "python.sorted",
    "range": "python.range",
}
"""Functions that still have a deprecated bare name, with the names to use instead."""


@dataclass(frozen=True, slots=True)
class BareCall:
    """A call of a function by its deprecated bare name, with the offset of the name."""

    name: str
    offset: int


@dataclass(frozen=True, slots=True)
class Mentions:
    """The names that a text mentions.

    Attributes:
        names: the names in the expressions of the text.
        arguments: the names of the arguments that the text uses.
        pasted_arguments: the subset of `arguments` whose values are substituted into an expression.
        packages: the offset of ``$(find package)`` in the text, by package.
        is_open: whether names are composed from values.
        has_open_arguments: whether names of arguments are composed from values.
        bare_calls: the calls of functions by a deprecated name.
    """

    names: frozenset[str] = frozenset()
    arguments: frozenset[str] = frozenset()
    pasted_arguments: frozenset[str] = frozenset()
    packages: tuple[tuple[str, int], ...] = ()
    is_open: bool = False
    has_open_arguments: bool = False
    bare_calls: tuple[BareCall, ...] = ()


_NONE = Mentions()


def mentions(text: str) -> Mentions:
    """Return the names that a text mentions."""
    return _find_mentions(text) if "$" in text else _NONE


def is_constant(text: str) -> bool:
    """Return whether a text has the same value in every scope, because it mentions no names."""
    text_mentions = mentions(text)
    return not (
        text_mentions.names
        or text_mentions.arguments
        or text_mentions.packages
        or text_mentions.is_open
        or text_mentions.has_open_arguments
    ) and ("$(env" not in text and "$(optenv" not in text and "$(cwd" not in text and "$(dirname" not in text)


def identifiers(text: str) -> frozenset[str]:
    """Return all words in a text that could be names."""
    return frozenset(_IDENTIFIER.findall(text))


@lru_cache(maxsize=20_000)
def _find_mentions(text: str) -> Mentions:
    collector = _MentionCollector()
    collector.text(text, 0)
    return Mentions(
        frozenset(collector.names),
        frozenset(collector.arguments),
        frozenset(collector.pasted),
        tuple(collector.packages),
        collector.is_open,
        collector.has_open_arguments,
        tuple(collector.bare_calls),
    )


@dataclass
class _MentionCollector:
    names: set[str] = field(default_factory=set)
    arguments: set[str] = field(default_factory=set)
    pasted: set[str] = field(default_factory=set)
    packages: list[tuple[str, int]] = field(default_factory=list)
    is_open: bool = False
    has_open_arguments: bool = False
    bare_calls: list[BareCall] = field(default_factory=list)

    def text(self, text: str, shift: int) -> None:
        try:
            tokens = tokenize(text)
        except Fault:
            self.names |= identifiers(text)
            return
        for token in tokens:
            if token.kind is TokenKind.EXPRESSION:
                self.expression(token, shift + token.start + 2)
            elif token.kind is TokenKind.SUBSTITUTION:
                self.substitution(token, shift + token.start + 2)

    def expression(self, token: Token, shift: int) -> None:
        source = token.text
        if "$" in source:
            self.text(source, shift)
            source = self._with_placeholders(source)
        tree = _parse_expression(source)
        if tree is None:
            self.names |= identifiers(source)
            self.is_open = self.is_open or _PLACEHOLDER in source
            return
        start = shift + len(token.text) - len(token.text.lstrip())
        local_names = set(_bound_names(tree))
        for node in ast.walk(tree):
            if isinstance(node, ast.Name):
                self._name(node.id)
            elif isinstance(node, ast.Attribute):
                self.names.add(node.attr)
            elif isinstance(node, ast.Call):
                self._call(node, local_names, start if "\n" not in source and source.isascii() else None, token.text)

    def _with_placeholders(self, source: str) -> str:
        try:
            tokens = tokenize(source)
        except Fault:
            return source
        pieces = []
        for token in tokens:
            if token.kind is TokenKind.TEXT:
                pieces.append(token.text)
                continue
            words = token.text.split()
            if token.kind is TokenKind.SUBSTITUTION and len(words) == 2 and words[0] == "arg":
                pieces.append(f"{_PLACEHOLDER}{words[1]}" if words[1].isidentifier() else _PLACEHOLDER)
            else:
                pieces.append(_PLACEHOLDER)
        return "".join(pieces)

    def _name(self, name: str) -> None:
        if _PLACEHOLDER not in name:
            self.names.add(name)
        elif name.startswith(_PLACEHOLDER) and name[len(_PLACEHOLDER) :] in self.arguments:
            self.pasted.add(name[len(_PLACEHOLDER) :])  # the value of an argument is the whole name
        else:
            self.is_open = True

    def _call(self, node: ast.Call, local_names: set[str], start: int | None, text: str) -> None:
        function = node.func
        function_name = function.attr if isinstance(function, ast.Attribute) else getattr(function, "id", "")
        if function_name == "arg":
            argument = node.args[0] if node.args else None
            if isinstance(argument, ast.Constant) and isinstance(argument.value, str):
                self.arguments.add(argument.value)
            else:
                self.has_open_arguments = True
        is_bare = isinstance(function, ast.Name) and function_name in DEPRECATED and function_name not in local_names
        if is_bare and start is not None and "$" not in text:
            self.bare_calls.append(BareCall(function_name, start + function.col_offset))

    def substitution(self, token: Token, shift: int) -> None:
        body = token.text
        if "$" in body:
            self.text(body, shift)
        words = body.split()
        if len(words) < 2:
            return
        command = words[0]
        if command == "arg":
            if "$" in body:
                self.has_open_arguments = True
            else:
                self.arguments.add(words[1])
        elif command == "find" and "$" not in body:
            self.packages.append((words[1], shift + body.index(words[1], len(command))))
        elif command == "eval":
            self.arguments |= identifiers(body)


def _parse_expression(source: str) -> ast.expr | None:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return ast.parse(source.strip(), mode="eval").body
    except (SyntaxError, ValueError, MemoryError, RecursionError):
        return None


def _bound_names(tree: ast.expr) -> Iterator[str]:
    """Yield the names that an expression binds itself, in lambdas and comprehensions."""
    for node in ast.walk(tree):
        if isinstance(node, ast.arg):
            yield node.arg
        elif isinstance(node, ast.comprehension):
            for target in ast.walk(node.target):
                if isinstance(target, ast.Name):
                    yield target.id
