"""Find functions of the repository that make launch actions, such as mixin methods."""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from linkwright.diagnostics import SourceText
from linkwright.packages.readers.launch_files import LAUNCH_FUNCTION
from linkwright.packages.readers.python_values import PythonFile, called_name
from linkwright.review.caching import cached_in_review
from linkwright.review.launches.python.names import LaunchPythonFile

_MAX_IMPORT_DEPTH = 5
"""The maximum number of files through which a name is imported."""
_MAX_CALL_DEPTH = 2
"""The maximum number of functions that a function calls one through the other to make actions."""
_MAX_BYTES = 1 << 20
_NODE_MODULES = ("rclpy", "rclpy.node", "rclpy.lifecycle")
_NODE_CALLS = frozenset({"rclpy.init", "rclpy.create_node", "rospy.init_node"})
"""The calls of programs that are a node."""
_ENTRY_FUNCTION = "generate_launch_description"
_MAX_PASSES = 5000
"""The maximum number of loop passes in a launch file that are read one by one."""
_LAUNCH_MODULE = re.compile(r"launch(_\w+)?(\.|$)")
"""The modules whose functions are known actions, or are compared as code."""


@dataclass(frozen=True)
class Function:
    """A function or method.

    Attributes:
        python: the parsed file that defines it.
        node: its definition.
        is_method: whether its first parameter is an object or a class.
        is_nested: whether another function defines it, whose names it uses.
    """

    python: PythonFile
    node: ast.FunctionDef
    is_method: bool = False
    is_nested: bool = False


def imports_actions(path: Path) -> bool:
    """Return whether a Python file imports the actions of launch files.

    Such a file can make actions for other files. A program with a node of its own does not.
    """
    file = _try_parse(path)
    if file is not None and _is_node_program(file.tree):
        return False
    imports = (node for node in ast.walk(file.tree) if isinstance(node, ast.ImportFrom)) if file else ()
    return any(not node.level and _LAUNCH_MODULE.match(node.module or "") for node in imports)


def _is_node_program(tree: ast.Module) -> bool:
    """Return whether a file makes a node of its own and no launch description.

    Such programs start launch files themselves.
    """
    if any(isinstance(node, ast.FunctionDef) and node.name == _ENTRY_FUNCTION for node in tree.body):
        return False
    nodes = list(ast.walk(tree))
    imports = (node for node in nodes if isinstance(node, ast.ImportFrom) and node.module in _NODE_MODULES)
    classes = {alias.asname or alias.name for node in imports for alias in node.names}
    bases = {ast.unparse(base) for node in nodes if isinstance(node, ast.ClassDef) for base in node.bases}
    calls = {called_name(node) for node in nodes if isinstance(node, ast.Call)}
    made = {*classes, "rclpy.node.Node"} & {*bases, *calls}
    return bool(made) or not calls.isdisjoint(_NODE_CALLS)


def find_program_guard(tree: ast.Module) -> ast.If | None:
    """Return the ``if __name__ == "__main__"`` statement of a launch file; None if there is none.

    ``ros2 launch`` calls ``generate_launch_description`` and does not run that statement. In a file without this
    function, the statement may start the actions itself.
    """
    if not any(isinstance(node, ast.FunctionDef) and node.name == _ENTRY_FUNCTION for node in tree.body):
        return None
    statements = (node for node in tree.body if isinstance(node, ast.If))
    return next((node for node in statements if _is_program_test(node.test)), None)


def _is_program_test(test: ast.expr) -> bool:
    """Return whether a test is true only for a file that is run as a program."""
    return isinstance(test, ast.Compare) and any(
        isinstance(node, ast.Name) and node.id == "__name__" for node in (test.left, *test.comparators)
    )


class HelperFunctions:
    """The functions of a repository that launch files call.

    Args:
        root: the folder of the repository.
        action_classes: the names of classes whose calls make actions.
    """

    def __init__(self, root: Path, action_classes: frozenset[str]) -> None:
        self._root = root
        self._action_classes = action_classes
        self._names_by_file: dict[PythonFile, frozenset[str]] = {}
        self._functions: dict[tuple[PythonFile, str], Function | None] = {}
        self._value_functions: dict[tuple[PythonFile, str], Function | None] = {}
        self._remaining_passes = _MAX_PASSES

    def reserve_passes(self, count: int) -> bool:
        """Return whether a loop may be read for each item, and count its passes.

        Without a limit, nested loops could have billions of passes.
        """
        if count > self._remaining_passes:
            return False
        self._remaining_passes -= count
        return True

    def find_local_names(self, python: PythonFile) -> frozenset[str]:
        """Return the names of a file's functions that make actions and are called in it.

        A file that is also a program calls the function that launch calls, which is none of them.
        """
        names = self._names_by_file.get(python)
        if names is None:
            skipped = None if (guard := find_program_guard(python.tree)) is None else id(guard)
            statements = [statement for statement in python.tree.body if id(statement) != skipped]
            nodes = (node for statement in statements for node in ast.walk(statement))
            called = {called_name(node) for node in nodes if isinstance(node, ast.Call)}
            definitions = (*_index_definitions(python).values(), *_index_nested_functions(python).values())
            functions = (node for node in definitions if isinstance(node, ast.FunctionDef))
            names = frozenset(
                node.name
                for node in functions
                if node.name in called - {LAUNCH_FUNCTION} and self._makes_actions(python, node)
            )
            self._names_by_file[python] = names
        return names

    def find(self, python: PythonFile, call: ast.Call) -> Function | None:
        """Return the called function if it is in the repository and makes actions, or None."""
        name = called_name(call)
        if name == LAUNCH_FUNCTION and name in _index_definitions(python):
            return None
        key = python, name
        if key not in self._functions:
            self._functions[key] = self._find(python, name)
        return self._functions[key]

    def is_foreign(self, python: PythonFile, call: ast.Call) -> bool:
        """Return whether the called function is imported from a package that is not part of launch."""
        first_name = called_name(call).partition(".")[0]
        modules = [module for module, _ in python.find_import_sources(first_name)]
        return (
            bool(modules)
            and not any(_LAUNCH_MODULE.match(module) for module in modules)
            and not self.find(python, call)
        )

    def is_imported(self, python: PythonFile, name: str) -> bool:
        """Return whether a name is imported from a module that is not part of launch."""
        return any(not _LAUNCH_MODULE.match(module) for module, _ in python.find_import_sources(name))

    def find_imported_value(self, python: PythonFile, name: str, depth: int = 0) -> tuple[PythonFile, ast.expr] | None:
        """Return the expression that a module of the repository assigns to an imported name, with the module.

        The result is None if the name is not imported, or not assigned exactly once.
        """
        for module, imported in python.find_import_sources(name) if depth < _MAX_IMPORT_DEPTH else ():
            if _LAUNCH_MODULE.match(module):
                continue
            for path in self._find_module_files(module, Path(python.source.name)):
                file = _try_parse(path)
                if file is None:
                    continue
                value = file.assigned_expression(imported)
                found = (file, value) if value is not None else self.find_imported_value(file, imported, depth + 1)
                if found is not None:
                    return found
        return None

    def find_value_function(self, python: PythonFile, call: ast.Call) -> Function | None:
        """Return the called function if it is in the repository and only computes and returns a value, or None."""
        name = called_name(call)
        key = python, name
        if key not in self._value_functions:
            self._value_functions[key] = self._find_value_function(python, name)
        return self._value_functions[key]

    def _find_value_function(self, python: PythonFile, name: str) -> Function | None:
        definition = self._find_definition(python, name, 0) if name.isidentifier() else None
        if definition is None:
            return None
        file, node = definition
        if not isinstance(node, ast.FunctionDef):
            return None
        is_simple = not node.decorator_list and node.args.kwarg is None
        if not is_simple or not only_returns_value(node) or self._makes_actions(file, node):
            return None
        return Function(file, node)

    def find_class(self, python: PythonFile, name: str) -> tuple[PythonFile, ast.ClassDef] | None:
        """Return the definition of a class that a file defines or imports from the repository, with its file."""
        definition = self._find_definition(python, name, 0)
        if definition is None or not isinstance(definition[1], ast.ClassDef):
            return None
        return definition[0], definition[1]

    def _find(self, python: PythonFile, name: str) -> Function | None:
        first_name, _, method = name.partition(".")
        if not first_name or "." in method:
            return None
        nested = _index_nested_functions(python).get(name)
        if nested is not None:
            return Function(python, nested, is_nested=True) if self._makes_actions(python, nested) else None
        definition = self._find_definition(python, first_name, 0)
        if definition is None:
            return None
        file, node = definition
        if isinstance(node, ast.FunctionDef):
            return Function(file, node) if self._makes_actions(file, node) and not method else None
        return self._find_method(file, node, method, 0)

    def _find_method(self, file: PythonFile, class_node: ast.ClassDef, name: str, depth: int) -> Function | None:
        """Return a method of a class or of its base classes, or None if it does not make actions."""
        methods = {item.name: item for item in class_node.body if isinstance(item, ast.FunctionDef)}
        method = methods.get(name)
        if method is not None:
            is_method = "staticmethod" not in map(ast.unparse, method.decorator_list)
            return Function(file, method, is_method) if self._makes_actions(file, method) else None
        for base in class_node.bases if depth < _MAX_IMPORT_DEPTH else ():
            definition = self._find_definition(file, base.id, 0) if isinstance(base, ast.Name) else None
            if definition is not None and isinstance(definition[1], ast.ClassDef):
                inherited = self._find_method(definition[0], definition[1], name, depth + 1)
                if inherited is not None:
                    return inherited
        return None

    def _makes_actions(self, python: PythonFile, function: ast.FunctionDef, depth: int = 0) -> bool:
        """Return whether a function makes actions, itself or by a call of another function."""
        names = {called_name(node) for node in ast.walk(function) if isinstance(node, ast.Call)}
        if any(name.rpartition(".")[2] in self._action_classes for name in names):
            return True
        for name in sorted(names) if depth < _MAX_CALL_DEPTH else ():
            definition = self._find_definition(python, name, 0) if name.isidentifier() else None
            if definition is None or not isinstance(definition[1], ast.FunctionDef):
                continue
            if self._makes_actions(definition[0], definition[1], depth + 1):
                return True
        return False

    def _find_definition(
        self, python: PythonFile, name: str, depth: int
    ) -> tuple[PythonFile, ast.FunctionDef | ast.ClassDef] | None:
        """Return the definition of a function or class that a file defines or imports."""
        definition = _index_definitions(python).get(name)
        if definition is not None:
            return python, definition
        if depth >= _MAX_IMPORT_DEPTH:
            return None
        for module, imported in python.find_import_sources(name):
            for path in self._find_module_files(module, Path(python.source.name)):
                file = _try_parse(path)
                imported_definition = None if file is None else self._find_definition(file, imported, depth + 1)
                if imported_definition is not None:
                    return imported_definition
        return None

    def _find_module_files(self, module: str, importer: Path) -> Iterator[Path]:
        """Yield the files of the repository that can be a module."""
        level = len(module) - len(module.lstrip("."))
        parts = tuple(part for part in module.split(".") if part)
        if level:
            folder = importer.parents[min(level, len(importer.parents)) - 1]
            paths = [
                folder.joinpath(*parts, "__init__.py"),
                *([folder.joinpath(*parts).with_suffix(".py")] if parts else []),
            ]
            yield from (path for path in paths if path.is_relative_to(self._root))
            return
        for path in _find_python_files(self._root):
            module_parts = (*path.parts[:-1], path.stem) if path.stem != "__init__" else path.parts[:-1]
            if module_parts[-len(parts) :] == parts:
                yield path


def only_returns_value(function: ast.FunctionDef) -> bool:
    """Return whether a function only assigns local names and returns a value."""
    *statements, last = function.body
    return isinstance(last, ast.Return) and last.value is not None and all(map(_is_simple, statements))


def find_returned_value(statements: Sequence[ast.stmt]) -> ast.expr | None:
    """Return what the statements of a function return, as one expression; None if they do anything else.

    An ``if`` statement that returns early becomes a conditional expression. Cases in which the function raises an
    error are left out, because it returns nothing there.
    """
    for index, statement in enumerate(statements):
        if isinstance(statement, ast.Return):
            return statement.value
        if isinstance(statement, ast.If):
            others = [*statement.orelse, *statements[index + 1 :]]
            if _raises(statement.body):
                return find_returned_value(others)
            body, other = find_returned_value(statement.body), find_returned_value(others)
            if body is None or other is None:
                return body if _raises(others) else None
            return ast.copy_location(ast.IfExp(statement.test, body, other), statement)
        if not _is_simple(statement):
            return None
    return None


def _raises(statements: Sequence[ast.stmt]) -> bool:
    return bool(statements) and isinstance(statements[0], ast.Raise)


def _is_simple(statement: ast.stmt) -> bool:
    """Return whether a statement is an import, a docstring or the assignment of a name."""
    return (
        isinstance(statement, (ast.Import, ast.ImportFrom))
        or (isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant))
        or (isinstance(statement, ast.Assign) and all(isinstance(item, ast.Name) for item in statement.targets))
    )


def find_parameter_defaults(function: ast.FunctionDef) -> dict[str, ast.expr]:
    """Return the defaults of the parameters of a function, by name."""
    arguments = function.args
    names = [argument.arg for argument in (*arguments.posonlyargs, *arguments.args)]
    defaults = dict(zip(names[len(names) - len(arguments.defaults) :], arguments.defaults, strict=True))
    keyword_defaults = zip(arguments.kwonlyargs, arguments.kw_defaults, strict=True)
    return defaults | {argument.arg: value for argument, value in keyword_defaults if value is not None}


def _index_definitions(python: PythonFile) -> dict[str, ast.FunctionDef | ast.ClassDef]:
    return {node.name: node for node in python.tree.body if isinstance(node, (ast.FunctionDef, ast.ClassDef))}


def _index_nested_functions(python: PythonFile) -> dict[str, ast.FunctionDef]:
    """Return the functions that the functions of a file define, by names that nothing else has."""
    outer = _index_definitions(python)
    nested = [
        node
        for function in outer.values()
        if isinstance(function, ast.FunctionDef)
        for statement in function.body
        for node in ast.walk(statement)
        if isinstance(node, ast.FunctionDef)
    ]
    names = Counter(node.name for node in nested)
    return {node.name: node for node in nested if names[node.name] == 1 and node.name not in outer}


@cached_in_review(maxsize=8)
def _find_python_files(root: Path) -> tuple[Path, ...]:
    """Return the Python files below a folder.

    The result is cached because the folder does not change during a review.
    """
    files = (
        path
        for path in sorted(root.rglob("*.py"))
        if not any(part.startswith(".") for part in path.relative_to(root).parts)
    )
    return tuple(files)


@cached_in_review(maxsize=64)
def _try_parse(path: Path) -> PythonFile | None:
    """Return a parsed file, or None if it cannot be read."""
    try:
        if path.stat().st_size > _MAX_BYTES:
            return None
        return LaunchPythonFile(SourceText(str(path), path.read_text("utf-8")))
    except (OSError, ValueError, SyntaxError):
        return None
