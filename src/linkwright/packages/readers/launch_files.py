"""Reader for Python launch files, which are parsed but not run."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from contextlib import suppress

from linkwright.diagnostics import SourceText, Span
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import dataclass, field
from linkwright.packages.readers.python_values import (
    PythonFile,
    SharePath,
    Value,
    argument_of,
    called_name,
    concatenate,
)
from linkwright.packages.readers.setup_py import SyntaxProblem, make_syntax_problem

LAUNCH_FUNCTION = "generate_launch_description"
_TEST_FUNCTION = "generate_test_description"
_TEST_PACKAGES = frozenset({"launch_testing", "launch_pytest"})
_LAUNCH_SUFFIXES = (".launch.py", "_launch.py")
_WRITE_MODES = frozenset("wax")
"""The modes in which ``open`` creates a file."""
_PATH_FUNCTIONS = frozenset({"join", "Path", "PurePath", "joinpath", "PathJoinSubstitution", "str", "as_posix"})
_WORD_SEPARATOR = lazy_pattern(r"\s+|:=|=|file://")
"""The separators of paths from other text in a command line."""
_PUNCTUATION = frozenset(".,;:!?'\")]}")
"""The ends of words of a message."""


@dataclass(frozen=True, slots=True)
class EvaluatedText:
    """An expression that evaluates to a text: the text, its syntax node and its location."""

    text: str
    node: ast.expr
    span: Span


@dataclass(frozen=True, slots=True)
class StartedNode:
    """The package and executable of a ``Node`` in a launch file, each None if it is not known."""

    package: EvaluatedText | None
    executable: EvaluatedText | None


@dataclass(frozen=True, slots=True)
class SharedFile:
    """A path in a share folder that a launch file constructs.

    Attributes:
        package: the name of the package.
        path: the path below the folder.
        span: the location of the expression.
        has_separator: whether a slash separates the folder from the path, which is outside of the folder without it.
    """

    package: str
    path: str
    span: Span
    has_separator: bool = True


@dataclass
class LaunchFile:
    """The nodes, paths and imports of a Python launch file.

    Attributes:
        path: the path relative to the package.
        error: the syntax error, or None if the file is valid Python.
        python_file: the parsed file, or None.
        has_function: whether the file may define ``generate_launch_description``.
        is_test: whether launch_testing or pytest runs the file; such a file requires other functions.
        nodes: the nodes that the file starts.
        shares: the packages whose share folder the file uses.
        paths: the complete paths in share folders that the file constructs.
        imports: the packages that the file imports from, with the locations.
        written_files: the files that the launch file itself writes, as package and path.
    """

    source: SourceText
    path: str
    error: SyntaxProblem | None = None
    python_file: PythonFile | None = None
    has_function: bool = False
    is_test: bool = False
    nodes: list[StartedNode] = field(default_factory=list)
    shares: list[EvaluatedText] = field(default_factory=list)
    paths: list[SharedFile] = field(default_factory=list)
    imports: list[tuple[str, Span]] = field(default_factory=list)
    written_files: frozenset[tuple[str, str]] = frozenset()


def is_launch_file(path: str) -> bool:
    """Return whether a path has the name of a Python launch file."""
    return path.endswith(_LAUNCH_SUFFIXES)


def read_launch_file(source: SourceText, path: str) -> LaunchFile:
    """Read the facts of a launch file.

    Args:
        source: the text of the file.
        path: the path relative to the package.
    """
    facts = LaunchFile(source, path)
    try:
        python_file = facts.python_file = PythonFile(source)
    except (SyntaxError, ValueError) as error:
        facts.error = make_syntax_problem(source, error)
        return facts
    facts.has_function = any(map(_may_define_function, python_file.tree.body))
    _read_imports(python_file, facts)
    facts.is_test = any(map(_defines_test, python_file.tree.body)) or any(
        package in _TEST_PACKAGES for package, _ in facts.imports
    )
    for call in python_file.calls("Node", "LifecycleNode", "ComposableNode"):
        package, executable = argument_of(call, "package"), argument_of(call, "executable")
        facts.nodes.append(StartedNode(_evaluate_text(python_file, package), _evaluate_text(python_file, executable)))
    for call in python_file.calls("get_package_share_directory", "get_package_share_path", "FindPackageShare"):
        argument = call.args[0] if call.args else argument_of(call, "package")
        expression = _evaluate_text(python_file, argument)
        if expression is not None:
            facts.shares.append(expression)
    written_paths = (python_file.value(node) for node in _find_written_paths(python_file))
    facts.written_files = frozenset(
        (share_path.package, share_path.subpath.strip("/"))
        for share_path in written_paths
        if isinstance(share_path, SharePath)
    )
    with suppress(RecursionError):  # raised for a sum of a thousand terms, whose paths are ignored
        _PathReader(python_file, facts).visit(python_file.tree)
    return facts


def _may_define_function(node: ast.stmt) -> bool:
    if isinstance(node, ast.ImportFrom) and any(alias.name == "*" for alias in node.names):
        return True
    return _defines_function(node, LAUNCH_FUNCTION) or isinstance(node, (ast.If, ast.Try))  # a branch may define it


def _defines_test(node: ast.stmt) -> bool:
    return _defines_function(node, _TEST_FUNCTION) or (
        isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)) and node.name.startswith("test_")
    )


def _defines_function(node: ast.stmt, name: str) -> bool:
    if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
        return node.name == name
    if isinstance(node, ast.ImportFrom):
        return any((alias.asname or alias.name) == name for alias in node.names)
    return isinstance(node, ast.Assign) and any(
        isinstance(target, ast.Name) and target.id == name for target in node.targets
    )


def _read_imports(python_file: PythonFile, facts: LaunchFile) -> None:
    spans: dict[str, Span] = {}
    for node in ast.walk(python_file.tree):
        if isinstance(node, ast.ImportFrom) and node.module and not node.level:
            spans.setdefault(node.module.partition(".")[0], python_file.span(node))
        elif isinstance(node, ast.Import):
            for alias in node.names:
                spans.setdefault(alias.name.partition(".")[0], python_file.span(node))
    facts.imports = list(spans.items())


def _find_written_paths(python_file: PythonFile) -> Iterator[ast.expr]:
    """Yield the expressions for the paths of files that are written."""
    for call in python_file.calls("open", owner=""):
        mode = call.args[1] if len(call.args) > 1 else argument_of(call, "mode")
        if call.args and _WRITE_MODES.intersection(python_file.text(mode) or ""):
            yield call.args[0]
    for call in python_file.calls("write_text", "write_bytes"):
        if isinstance(call.func, ast.Attribute):
            yield call.func.value
    for call in python_file.calls("copy", "copy2", "copyfile", "move", owner="shutil"):
        yield from call.args[1:2]


def _evaluate_text(python_file: PythonFile, node: ast.expr | None) -> EvaluatedText | None:
    if node is None:
        return None
    text = python_file.text(node)
    return None if text is None else EvaluatedText(text, node, python_file.span(node))


class _PathReader(ast.NodeVisitor):
    """A visitor that finds the paths in share folders, without prefixes of longer paths."""

    def __init__(self, python_file: PythonFile, facts: LaunchFile) -> None:
        self._python_file = python_file
        self._facts = facts
        self._path_depth = 0
        self._names_in_paths = _find_names_in_path_operations(python_file.tree)

    def visit_Assign(self, node: ast.Assign) -> None:
        names = [target.id for target in node.targets if isinstance(target, ast.Name)]
        if any(name in self._names_in_paths for name in names):
            self._path_depth += 1  # the value is only the beginning of other paths
            self.generic_visit(node)
            self._path_depth -= 1
        else:
            self.generic_visit(node)

    def generic_visit(self, node: ast.AST) -> None:
        if not _is_path_operation(node):
            super().generic_visit(node)
            return
        assert isinstance(node, ast.expr)
        if not self._path_depth:
            value = self._python_file.value(node)
            for path in (value,) if isinstance(value, SharePath) else _find_words(self._python_file, node):
                if path.subpath:
                    has_separator = path.subpath.startswith("/")
                    file = SharedFile(
                        path.package, path.subpath.strip("/"), self._python_file.span(node), has_separator
                    )
                    self._facts.paths.append(file)
        self._path_depth += 1
        super().generic_visit(node)
        self._path_depth -= 1


def _find_names_in_path_operations(tree: ast.AST) -> set[str]:
    names = set()
    pending = [(tree, False)]
    while pending:
        node, is_in_path = pending.pop()
        is_in_path = is_in_path or _is_path_operation(node)
        if is_in_path and isinstance(node, ast.Name):
            names.add(node.id)
        pending.extend((child, is_in_path) for child in ast.iter_child_nodes(node))
    return names


def _find_words(python_file: PythonFile, node: ast.expr) -> Iterator[SharePath]:
    """Yield the paths that are words of a command line, such as in ``"-r " + path``."""
    words: list[list[Value]] = [[]]
    for operand in _split_operands(node):
        value = python_file.value(operand)
        first, *others = _WORD_SEPARATOR.split(value) if isinstance(value, str) else [value]
        words[-1].append(first)
        words += [[piece] for piece in others]
    for word in words:
        path = concatenate([piece for piece in word if piece != ""])
        if isinstance(path, SharePath) and path.subpath[-1:] not in _PUNCTUATION:
            yield path


def _split_operands(node: ast.expr) -> Iterator[ast.expr]:
    """Yield the expressions whose values are joined to a text."""
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
        yield from _split_operands(node.left)
        yield from _split_operands(node.right)
    elif isinstance(node, ast.JoinedStr):
        for piece in node.values:
            is_plain = isinstance(piece, ast.FormattedValue) and piece.conversion == -1 and piece.format_spec is None
            yield piece.value if is_plain and isinstance(piece, ast.FormattedValue) else piece
    else:
        yield node


def _is_path_operation(node: ast.AST) -> bool:
    if isinstance(node, ast.BinOp):
        return isinstance(node.op, (ast.Add, ast.Div))
    if isinstance(node, ast.JoinedStr):
        return True
    return isinstance(node, ast.Call) and called_name(node).rpartition(".")[2] in _PATH_FUNCTIONS
