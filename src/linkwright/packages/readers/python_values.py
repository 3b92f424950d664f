"""Evaluate string and path expressions in a Python file without running the file.

An expression has a value only if the value is certain: literals, names that are assigned once, joined paths, share
folders of packages, and patterns of file names. Every other value is `UNKNOWN`, and rules ignore it.
"""

from __future__ import annotations

import ast
import operator
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from enum import Enum
from functools import cached_property

from linkwright.diagnostics import SourceText, Span, phrase
from linkwright.loading.lean_dataclasses import dataclass
from linkwright.loading.lean_typing import Any, Union


class UnknownType(Enum):
    """The type of `UNKNOWN`, the value of an expression that cannot be evaluated."""

    UNKNOWN = "unknown"


UNKNOWN = UnknownType.UNKNOWN


@dataclass(frozen=True, slots=True)
class SharePath:
    """The share folder of a package, or a path below it.

    Attributes:
        package: the name of the package.
        subpath: the path below the folder, such as ``/urdf/robot.urdf``; empty for the folder itself.
    """

    package: str
    subpath: str = ""


@dataclass(frozen=True, slots=True)
class Pattern:
    """A ``glob`` pattern.

    Attributes:
        text: the pattern.
        recursive: whether ``**`` in the pattern matches any number of folders.
    """

    text: str
    recursive: bool


Value = Union[UnknownType, str, int, float, None, SharePath, Pattern, tuple["Value", ...]]  # noqa: UP007 - recursive

PYTHON_COMPARISONS: Mapping[type[ast.cmpop], Callable[[Any, Any], Any]] = {
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Is: operator.is_,
    ast.IsNot: operator.is_not,
    ast.In: lambda item, items: item in items,
    ast.NotIn: lambda item, items: item not in items,
}
"""The functions that compare two values, by the operators of Python."""
_ALIASED_MODULES = frozenset(
    {
        "ament_index_python",
        "launch",
        "launch_ros",
        "launch_testing",
        "launch_testing_ros",
        "moveit_configs_utils",
        "os",
        "pathlib",
    }
)
"""The packages whose classes and functions the readers of Python files know by their names."""
_MAX_DEPTH = 40
_JOIN_FUNCTIONS = frozenset(
    {"os.path.join", "path.join", "join", "Path", "PurePath", "pathlib.Path", "PathJoinSubstitution"}
)
_SHARE_FUNCTIONS = frozenset({"get_package_share_directory", "get_package_share_path", "FindPackageShare"})


class PythonFile:
    """A parsed Python file.

    Args:
        source: the text of the file.

    Attributes:
        tree: the syntax tree, with the own names of imported classes and functions in place of other names.

    Raises:
        SyntaxError: the text is not valid Python.
        ValueError: the text contains a null byte, or is nested too deeply.
    """

    def __init__(self, source: SourceText) -> None:
        self.source = source
        self.tree = parse_python(source.text)
        replace_import_aliases(self.tree)

    @cached_property
    def _assignments(self) -> dict[str, ast.expr | None]:
        """Name -> assigned expression, or None after several assignments or to a complex target."""
        bindings: dict[str, ast.expr | None] = {}
        for node in ast.walk(self.tree):
            _record_bindings(node, bindings)
        return bindings

    @cached_property
    def _import_sources(self) -> dict[str, list[tuple[str, str]]]:
        sources: dict[str, list[tuple[str, str]]] = {}
        for node in ast.walk(self.tree):
            if isinstance(node, ast.ImportFrom):
                module = "." * node.level + (node.module or "")
                for alias in node.names:
                    sources.setdefault(alias.asname or alias.name, []).append((module, alias.name))
        return sources

    def find_import_sources(self, name: str) -> Sequence[tuple[str, str]]:
        """Return the modules from which the file imports a name, with its name there."""
        return self._import_sources.get(name, ())

    def assigned_expression(self, name: str) -> ast.expr | None:
        """Return the expression assigned to a name, or None if there is not exactly one assignment."""
        return self._assignments.get(name)

    def resolved(self, node: ast.expr) -> ast.expr:
        """Return the expression that is assigned to a name, and any other expression unchanged."""
        for _ in range(_MAX_DEPTH):
            if not isinstance(node, ast.Name):
                break
            value = self.assigned_expression(node.id)
            if value is None:
                break
            node = value
        return node

    def calls(self, *names: str, owner: str | None = None) -> Iterator[ast.Call]:
        """Yield the calls of functions or classes in the order of the text.

        Args:
            names: the last parts of the dotted names of the functions.
            owner: the part of the dotted name before the last; None for any.
        """
        calls = [
            node
            for node in ast.walk(self.tree)
            if isinstance(node, ast.Call)
            and called_name(node).rpartition(".")[2] in names
            and (owner is None or called_name(node).rpartition(".")[0] == owner)
        ]
        yield from sorted(calls, key=lambda node: (node.lineno, node.col_offset))

    def offset(self, line: int, column: int) -> int:
        """Return the character offset of a position in the syntax tree.

        Args:
            line: the line, from 1.
            column: the column as a byte offset in the line, from 0.
        """
        text = self.source.line(line)
        characters = column if text.isascii() else len(text.encode()[:column].decode("utf-8", "replace"))
        return self.source.offset(line, characters + 1)

    def range(self, node: ast.expr | ast.stmt | ast.keyword | ast.alias) -> tuple[int, int]:
        """Return the character offsets of the start and the end of a node, with the end exclusive."""
        start = self.offset(node.lineno, node.col_offset)
        if node.end_lineno is None or node.end_col_offset is None:
            return start, start + 1
        return start, self.offset(node.end_lineno, node.end_col_offset)

    def span(self, node: ast.expr | ast.stmt | ast.keyword | ast.alias) -> Span:
        """Return the location of a node, or of its first line if the node has several lines."""
        start, end = self.range(node)
        line_end = self.source.text.find("\n", start)
        if 0 <= line_end < end:
            end = line_end
        return self.source.span(start, max(end, start + 1))

    # --- values ------------------------------------------------------------------------------------------------------

    def value(self, node: ast.expr | None, depth: int = 0) -> Value:
        """Return the value of an expression, or `UNKNOWN` if the value is not certain."""
        if node is None or depth > _MAX_DEPTH:
            return UNKNOWN
        if isinstance(node, ast.Constant):
            return node.value if isinstance(node.value, (str, int, float, type(None))) else UNKNOWN
        if isinstance(node, ast.Name):
            return self.value(self.assigned_expression(node.id), depth + 1)
        if isinstance(node, (ast.List, ast.Tuple)):
            return tuple(self.value(item, depth + 1) for item in node.elts)
        if isinstance(node, ast.JoinedStr):
            return concatenate([self._piece(piece, depth) for piece in node.values])
        if isinstance(node, ast.BinOp):
            return self._operation(node, depth)
        if isinstance(node, ast.Call):
            return self._call(node, depth)
        return UNKNOWN

    def text(self, node: ast.expr | None) -> str | None:
        """Return the string that an expression evaluates to, or None if it is not a known string."""
        value = self.value(node)
        return value if isinstance(value, str) else None

    def _piece(self, piece: ast.expr, depth: int) -> Value:
        if isinstance(piece, ast.FormattedValue):
            has_default_format = piece.conversion == -1 and piece.format_spec is None
            return self.value(piece.value, depth + 1) if has_default_format else UNKNOWN
        return self.value(piece, depth + 1)

    def _operation(self, node: ast.BinOp, depth: int) -> Value:
        left, right = self.value(node.left, depth + 1), self.value(node.right, depth + 1)
        if isinstance(node.op, ast.Add):
            if isinstance(left, tuple) and isinstance(right, tuple):
                return left + right
            return concatenate([left, right])
        if isinstance(node.op, ast.Div):
            return join_path([left, right])
        if isinstance(node.op, ast.Mod) and isinstance(left, str):
            operands = right if isinstance(right, tuple) else (right,)
            if all(isinstance(value, (str, int)) for value in operands) and left.count("%") == len(operands):
                try:
                    return left % operands
                except (TypeError, ValueError):
                    return UNKNOWN
        return UNKNOWN

    def _call(self, node: ast.Call, depth: int) -> Value:
        name = called_name(node)
        function_name = name.rpartition(".")[2]
        if any(isinstance(argument, ast.Starred) for argument in node.args):
            return UNKNOWN
        if function_name in _SHARE_FUNCTIONS:
            package = self.value(node.args[0] if node.args else argument_of(node, "package"), depth + 1)
            return SharePath(package) if isinstance(package, str) else UNKNOWN
        arguments = [self.value(argument, depth + 1) for argument in node.args]
        if name in _JOIN_FUNCTIONS and arguments:
            if function_name == "PathJoinSubstitution":
                return join_path(arguments[0]) if isinstance(arguments[0], tuple) else UNKNOWN
            return join_path(arguments)
        if function_name == "joinpath" and isinstance(node.func, ast.Attribute):
            return join_path([self.value(node.func.value, depth + 1), *arguments])
        if function_name in ("as_posix", "__str__", "find") and isinstance(node.func, ast.Attribute):
            owner = self.value(node.func.value, depth + 1)
            return owner if isinstance(owner, SharePath) or function_name != "find" else UNKNOWN
        if name == "str" and len(arguments) == 1:
            return arguments[0]
        if function_name in ("glob", "iglob") and name in ("glob", "glob.glob", "iglob", "glob.iglob") and arguments:
            recursive = argument_of(node, "recursive")
            is_recursive = isinstance(recursive, ast.Constant) and bool(recursive.value)
            return Pattern(arguments[0], is_recursive) if isinstance(arguments[0], str) else UNKNOWN
        if function_name == "TextSubstitution":
            return self.value(argument_of(node, "text"), depth + 1)
        return UNKNOWN


def _record_bindings(node: ast.AST, bindings: dict[str, ast.expr | None]) -> None:
    if isinstance(node, ast.Assign):
        for target in node.targets:
            _bind(target, node.value, bindings)
    elif isinstance(node, ast.AnnAssign) and node.value is not None:
        _bind(node.target, node.value, bindings)
    elif isinstance(node, (ast.AugAssign, ast.NamedExpr, ast.For, ast.AsyncFor, ast.comprehension)):
        _bind(node.target, None, bindings)
    elif isinstance(node, ast.withitem) and node.optional_vars is not None:
        _bind(node.optional_vars, None, bindings)
    elif isinstance(node, ast.arg):
        bindings[node.arg] = None
    elif isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
        bindings[node.name] = None


def _bind(target: ast.expr, value: ast.expr | None, bindings: dict[str, ast.expr | None]) -> None:
    if isinstance(target, ast.Name):
        bindings[target.id] = None if target.id in bindings else value
    elif isinstance(target, (ast.Tuple, ast.List)):
        for element in target.elts:
            _bind(element, None, bindings)
    elif isinstance(target, ast.Starred):
        _bind(target.value, None, bindings)


def parse_python(text: str) -> ast.Module:
    """Return the syntax tree of a Python source, without warnings about its code.

    Raises:
        SyntaxError: the text is not Python.
        ValueError: it is nested too deeply.
    """
    with _reading_foreign_code():
        return ast.parse(text)


def parse_python_expression(text: str) -> ast.expr:
    """Return the syntax tree of a Python expression, without warnings about its code.

    Raises:
        SyntaxError: the text is not an expression.
        ValueError: it is nested too deeply.
    """
    with _reading_foreign_code():
        return ast.parse(text, mode="eval").body


@contextmanager
def _reading_foreign_code() -> Iterator[None]:
    """Ignore warnings about the user's code, such as invalid escapes, and report deep nesting as a ValueError."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    except (RecursionError, MemoryError):
        raise ValueError(phrase("it is nested too deeply")) from None


def called_name(node: ast.Call) -> str:
    """Return the dotted name of the called function.

    A part that is not a name is empty.
    """
    parts: list[str] = []
    function: ast.expr = node.func
    while isinstance(function, ast.Attribute):
        parts.append(function.attr)
        function = function.value
    parts.append(function.id if isinstance(function, ast.Name) else "")
    return ".".join(reversed(parts))


def argument_of(node: ast.Call, name: str) -> ast.expr | None:
    """Return the expression for a keyword argument of a call, or None if it is not given."""
    return next((keyword.value for keyword in node.keywords if keyword.arg == name), None)


def concatenate(values: Sequence[Value]) -> Value:
    """Return the concatenation of values, or `UNKNOWN` if it is not known."""
    if not values:
        return ""
    prefix = values[0]
    suffixes = values[1:]
    if not all(isinstance(value, str) for value in suffixes):
        return UNKNOWN
    text = "".join(value for value in suffixes if isinstance(value, str))
    if isinstance(prefix, SharePath):
        return SharePath(prefix.package, prefix.subpath + text)
    return prefix + text if isinstance(prefix, str) else UNKNOWN


def join_path(values: Sequence[Value]) -> Value:
    """Return the path whose components are the values, or `UNKNOWN` if it is not known."""
    if not values:
        return UNKNOWN
    path = values[0]
    for value in values[1:]:
        if not isinstance(value, str) or value.startswith("/"):
            return UNKNOWN
        if isinstance(path, SharePath):
            path = SharePath(path.package, f"{path.subpath.rstrip('/')}/{value}")
        elif isinstance(path, str):
            path = f"{path.rstrip('/')}/{value}" if path else value
        else:
            return UNKNOWN
    return path if isinstance(path, (str, SharePath)) else UNKNOWN


def replace_import_aliases(tree: ast.Module) -> None:
    """Change ``from launch_ros.actions import Node as N`` and each ``N`` to ``Node`` in a syntax tree.

    Only names of modules that readers know are replaced. A name that the file also defines in another way stays, and
    so does one whose own name the file uses for something else. Locations do not change.
    """
    nodes = list(ast.walk(tree))
    aliases = [
        alias
        for node in nodes
        if isinstance(node, ast.ImportFrom)
        and not node.level
        and (node.module or "").partition(".")[0] in _ALIASED_MODULES
        for alias in node.names
        if alias.asname is not None
    ]
    if not aliases:
        return
    bound = _find_bound_names(nodes, [id(alias) for alias in aliases])
    replaced = {alias.asname: alias for alias in aliases if alias.asname not in bound and alias.name not in bound}
    for alias in replaced.values():
        alias.asname = None
    names = {name: alias.name for name, alias in replaced.items()}
    for node in nodes:
        if isinstance(node, ast.Name):
            node.id = names.get(node.id, node.id)


def _find_bound_names(nodes: Sequence[ast.AST], ignored: Sequence[int]) -> set[str]:
    """Return the names that statements define, without those of some imports.

    An import of the same class under its own name does not count.
    """
    bound: set[str] = set()
    for node in nodes:
        if isinstance(node, ast.ImportFrom) and (node.module or "").partition(".")[0] in _ALIASED_MODULES:
            continue
        if isinstance(node, (ast.Import, ast.ImportFrom)):
            bound |= {alias.asname or alias.name for alias in node.names if id(alias) not in ignored}
        elif isinstance(node, ast.Name) and not isinstance(node.ctx, ast.Load):
            bound.add(node.id)
        elif isinstance(node, ast.arg):
            bound.add(node.arg)
        elif isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            bound.add(node.name)
    return bound
