"""Normalize the code of a source by function.

Layout, comments, docstrings and output are left out.
"""

from __future__ import annotations

import ast
import bisect
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import PurePosixPath
from typing import NamedTuple

from linkwright.diagnostics import SourceText
from linkwright.review.sources.cpp.preprocessor import Conditions
from linkwright.review.sources.names import CPP_SUFFIXES
from linkwright.review.sources.python.effective_statements import list_effective_statements
from linkwright.review.sources.python_names import parse_source
from linkwright.review.sources.statements.cpp import is_output, read_cpp_blocks
from linkwright.review.sources.statements.literals import normalize_number
from linkwright.review.sources.statements.python import get_blocks, list_called_names
from linkwright.review.sources.statements.tokens import Token, TokenKind, join_tokens

_OUTPUT_FUNCTION = re.compile(
    r"p?print|log\w*|(?:local|ros)?_?(?:debug|info|warn|warning|err|error|critical|exception|fatal)|echo", re.IGNORECASE
)
"""The functions that only print or log."""
_FUNCTION_NAME = re.compile(r"(?:\w+(?:\.|::))*(?:~?\w+|operator\W+)")
_ASSERTIONS = frozenset({"assert", "ROS_ASSERT", "ROS_ASSERT_MSG"})
"""The first words of statements that stop the program if a condition does not hold."""
_CONTROL_KEYWORDS = frozenset({"if", "for", "while", "switch", "catch"})
_BRANCH_KEYWORDS = frozenset({"else", "do", "try"})


class Part(NamedTuple):
    """A statement, or the head of a compound statement.

    Attributes:
        text: the normalized code.
        first_line: the number of its first line.
        last_line: the number of its last line.
        start: the offset of its first character; 0 in Python, where statements are in the order of the source.
        written: the code as the source has it, in one line; empty in Python, where it is the normalized code.
    """

    text: str
    first_line: int
    last_line: int
    start: int = 0
    written: str = ""


@dataclass
class Code:
    """The code of a source.

    Attributes:
        functions: the statements of each function, by qualified name. The first statement is the head.
        outside: the statements outside of functions by class; statements outside of classes have an empty name.
        imports: the imports of a Python source, one for each name.
    """

    functions: dict[str, list[Part]] = field(default_factory=dict)
    outside: dict[str, list[Part]] = field(default_factory=dict)
    imports: list[Part] = field(default_factory=list)

    def get_body(self, name: str) -> list[str]:
        """Return the code of a function without its head."""
        return [part.text for part in self.functions.get(name, ())[1:]]


def read_code(source: SourceText) -> Code:
    """Return the code of a Python or C++ source; empty if it cannot be read with certainty."""
    try:
        if PurePosixPath(source.name).suffix in CPP_SUFFIXES:
            return _read_cpp(source)
        code = Code()
        tree = parse_source(source).tree
        imports = [node for node in ast.walk(tree) if isinstance(node, (ast.Import, ast.ImportFrom))]
        code.imports = [_make_import_part(node, alias) for node in imports for alias in node.names]
        _read_python(tree.body, "", code)
    except (ValueError, SyntaxError, RecursionError):
        return Code()
    return code


# --- Python -------------------------------------------------------------------------------------------------------


def _read_python(body: Sequence[ast.stmt], scope: str, code: Code) -> None:
    """Add the code of a module or class to `code`."""
    for node in body:
        if isinstance(node, ast.ClassDef):
            name = f"{scope}.{node.name}".lstrip(".")
            code.outside.setdefault(name, []).append(_make_python_part(node, ""))
            _read_python(node.body, name, code)
        elif isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            parts = code.functions.setdefault(f"{scope}.{node.name}".lstrip("."), [])
            parts.extend(_make_python_parts([node], ""))
        else:
            code.outside.setdefault(scope, []).extend(_make_python_parts([node], ""))


def _make_python_parts(body: Sequence[ast.stmt], indent: str) -> Iterator[Part]:
    """Yield the statements of a block in depth-first order."""
    for node in list_effective_statements(body):
        if is_skipped(node):
            continue
        yield _make_python_part(node, indent)
        for index, block in enumerate(get_blocks(node)):
            yield from _make_python_parts(block, f"{indent}{index or ' '}")


def _make_python_part(node: ast.stmt, indent: str) -> Part:
    """Return a statement without annotations, error messages and nested statements."""
    inner = get_blocks(node)
    first = min([node.lineno, *(decorator.lineno for decorator in getattr(node, "decorator_list", []))])
    last = inner[0][0].lineno - 1 if inner else node.end_lineno or node.lineno
    return Part(indent + ast.unparse(_normalize(node)), first, max(first, last))


def _make_import_part(node: ast.Import | ast.ImportFrom, alias: ast.alias) -> Part:
    """Return the import of one of the names of a statement."""
    names = [alias]
    single = ast.Import(names) if isinstance(node, ast.Import) else ast.ImportFrom(node.module, names, node.level)
    return Part(ast.unparse(single), node.lineno, node.end_lineno or node.lineno)


def _normalize(node: ast.stmt) -> ast.stmt:
    """Return a statement in normalized form. The syntax tree is changed."""
    if isinstance(node, ast.Raise) and isinstance(node.exc, ast.Call):
        return ast.Raise(node.exc.func, None)
    if isinstance(node, ast.Assert):
        return ast.Assert(node.test, None)
    if isinstance(node, ast.AnnAssign) and node.value is not None:
        return ast.copy_location(ast.Assign([node.target], node.value), node)
    if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
        node = ast.copy_location(_remove_annotations(node), node)
    elif not get_blocks(node):
        return node
    fields = {name: getattr(node, name) for name in node._fields if hasattr(node, name)}
    fields.update((name, []) for name in ("orelse", "finalbody") if name in fields)
    fields["body"] = [ast.Pass()]
    if "handlers" in fields:
        fields["handlers"] = [ast.ExceptHandler(handler.type, None, [ast.Pass()]) for handler in fields["handlers"]]
        fields["finalbody"] = [] if fields["handlers"] else [ast.Pass()]
    if "cases" in fields:
        fields["cases"] = [ast.match_case(case.pattern, case.guard, [ast.Pass()]) for case in fields["cases"]]
    return ast.copy_location(type(node)(**fields), node)


def _remove_annotations(node: ast.FunctionDef | ast.AsyncFunctionDef) -> ast.FunctionDef | ast.AsyncFunctionDef:
    for argument in ast.walk(node.args):
        if isinstance(argument, ast.arg):
            argument.annotation = None
    node.returns = None
    return node


def is_skipped(node: ast.stmt) -> bool:
    """Return whether a statement does nothing, imports, declares a type, or prints."""
    if isinstance(node, (ast.Import, ast.ImportFrom, ast.Pass)) or (
        isinstance(node, ast.AnnAssign) and node.value is None
    ):
        return True
    if not isinstance(node, ast.Expr):
        return False
    names = list_called_names(node.value)
    return isinstance(node.value, ast.Constant) or (
        bool(names) and (_OUTPUT_FUNCTION.fullmatch(names[0]) is not None or "get_logger" in names)
    )


# --- C++ ----------------------------------------------------------------------------------------------------------


def _read_cpp(source: SourceText) -> Code:
    blocks, functions = read_cpp_blocks(source.text)
    starts = [match.end() for match in re.finditer("\n", source.text)]
    conditions = Conditions(source.text)
    code = Code()
    for name, statements in blocks.items():
        if name and not _FUNCTION_NAME.fullmatch(name):
            continue
        parts = [
            _make_cpp_part(tokens, starts, conditions)
            for statement in statements
            for tokens in _split_unbraced(statement)
            if not is_output(tokens) or _may_fail(tokens)
        ]
        (code.functions if name in functions else code.outside)[name] = parts
    return code


def _split_unbraced(tokens: Sequence[Token]) -> Iterator[Sequence[Token]]:
    """Yield the body of a condition without braces, followed by the condition."""
    end = 0
    if tokens and tokens[0].text in _BRANCH_KEYWORDS:
        end = 1
    elif len(tokens) > 1 and tokens[0].text in _CONTROL_KEYWORDS:
        depth = 0
        for index, token in enumerate(tokens[1:], 1):
            depth += (token.text == "(") - (token.text == ")")
            if depth == 0 and token.text == ")":
                end = index + 1
                break
    if 0 < end < len(tokens):
        yield from _split_unbraced(tokens[end:])
        yield tokens[:end]
    else:
        yield tokens


def _may_fail(tokens: Sequence[Token]) -> bool:
    """Return whether a statement throws an error or asserts a condition."""
    return any(token.text == "throw" or token.text in _ASSERTIONS for token in tokens)


def _make_cpp_part(tokens: Sequence[Token], starts: Sequence[int], conditions: Conditions) -> Part:
    """Return a statement with the conditions of the preprocessor."""
    has_message, texts, condition = _may_fail(tokens), [], ""
    for token in tokens:
        if token.text != "override":
            if conditions.find(token.start) != condition:
                condition = conditions.find(token.start)
                texts.append(f"#if {condition}")
            texts.append(_normalize_token(token, has_message=has_message))
    first, last = (bisect.bisect_right(starts, token.start) + 1 for token in (tokens[0], tokens[-1]))
    return Part(" ".join(texts), first, last, tokens[0].start, join_tokens(tokens))


def _normalize_token(token: Token, *, has_message: bool) -> str:
    """Return a token without error messages and with one notation of numbers."""
    if token.kind is TokenKind.NUMBER:
        return normalize_number(token.text, is_divided=True)
    return '""' if has_message and token.kind is TokenKind.TEXT else token.text
