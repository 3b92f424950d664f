"""Write the tests of a Python launch file as expressions of the arguments of the file, and find tests of objects."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping
from copy import deepcopy
from typing import NamedTuple

from linkwright.diagnostics import Span, phrase
from linkwright.packages.readers.python_values import PythonFile, argument_of, called_name
from linkwright.review.caching import cached_in_review
from linkwright.review.file_pair import FilePair
from linkwright.review.launches.expressions import unparse_on_one_line
from linkwright.review.launches.python.helpers import find_parameter_defaults, find_returned_value
from linkwright.review.launches.python.names import LaunchPythonFile
from linkwright.review.sources.reading import try_read_source

_CONFIGURATION = "LaunchConfiguration"
SUBSTITUTIONS = frozenset(
    {_CONFIGURATION, "Command", "EnvironmentVariable", "FindPackageShare", "PathJoinSubstitution", "PythonExpression"}
)
"""The classes of substitutions that launch files often use."""
_CONFIGURATIONS = "launch_configurations"
"""The attribute of a launch context with the values of the arguments."""
_TEXT_METHODS = frozenset({"lower", "strip", "upper"})
_TRUE_TEXTS = ("y", "yes", "t", "true", "on", "1")
"""The texts that ``strtobool`` of distutils takes for true, in any case."""
_MAX_CALL_DEPTH = 3
_EQUALITIES = (ast.Eq, ast.In)
_INEQUALITIES = (ast.NotEq, ast.NotIn)
_Function = ast.FunctionDef | ast.AsyncFunctionDef


class _UnknownTestError(Exception):
    """A test whose value does not only depend on arguments of the launch file."""


class _ObjectTest(NamedTuple):
    """A comparison of a substitution with a text, which are never equal.

    Attributes:
        source: the comparison as it is written.
        name: the name of the argument.
        is_always: whether the comparison is always true; else it never is.
        span: the location of the comparison.
    """

    source: str
    name: str
    is_always: bool
    span: Span


@cached_in_review(maxsize=64)
def read_tests(python: PythonFile) -> dict[str, str]:
    """Return the tests of ``if`` statements as ``$(eval ...)`` with ``$(var NAME)`` in it, by their source.

    Tests that depend on anything else than arguments, and those that have several meanings, are left out.
    """
    tests: dict[str, str | None] = {}
    for function, node in walk_functions(python.tree, None):
        if isinstance(node, (ast.If, ast.IfExp)):
            source = unparse_on_one_line(node.test)
            try:
                value = f"$(eval {ast.unparse(ArgumentReader(python, function).read_test(node.test))})"
            except _UnknownTestError:
                value = None
            tests[source] = value if tests.get(source, value) == value else None
    return {source: value for source, value in tests.items() if value is not None}


def report_object_tests(pair: FilePair) -> None:
    """Report the comparisons of substitutions with texts that only the new version of a launch file has."""
    known = {test.source for test in _find_object_tests(try_parse_version(pair, is_old=True))}
    for test in _find_object_tests(try_parse_version(pair)):
        if test.source not in known:
            text = phrase(
                "`{test}` compares the object LaunchConfiguration('{name}') with a text, instead of its value",
                test=test.source,
                name=test.name,
            )
            reason = phrase("the condition is always true") if test.is_always else phrase("the condition is never true")
            pair.add(text, pair.location(test.span), reason)


def try_parse_version(pair: FilePair, *, is_old: bool = False) -> PythonFile | None:
    """Return a version of a Python launch file, or None if it cannot be parsed."""
    source = try_read_source(pair.old_file if is_old else pair.new_file)
    try:
        return None if source is None else LaunchPythonFile(source)
    except (SyntaxError, ValueError):
        return None


def _find_object_tests(python: PythonFile | None) -> Iterator[_ObjectTest]:
    for function, node in walk_functions(python.tree, None) if python is not None else ():
        operator = node.ops[0] if isinstance(node, ast.Compare) and len(node.ops) == 1 else None
        if python is None or not isinstance(node, ast.Compare) or operator is None:
            continue
        reader = ArgumentReader(python, function)
        for item, other in ((node.left, node.comparators[0]), (node.comparators[0], node.left)):
            name = reader.find_object(item)
            is_membership = isinstance(operator, (ast.In, ast.NotIn))
            if (
                name is None
                or not reader.is_text(other, is_list=is_membership)
                or (is_membership and item is not node.left)
            ):
                continue
            if isinstance(operator, (*_EQUALITIES, *_INEQUALITIES)):
                source = unparse_on_one_line(node)
                yield _ObjectTest(source, name, isinstance(operator, _INEQUALITIES), python.span(node))


def walk_functions(node: ast.AST, function: _Function | None) -> Iterator[tuple[_Function | None, ast.AST]]:
    """Yield the nodes below a node, each with the innermost function around it."""
    for child in ast.iter_child_nodes(node):
        yield function, child
        yield from walk_functions(child, child if isinstance(child, _Function) else function)


class ArgumentReader:
    """A reader of the tests of a function.

    Args:
        python: the file.
        function: the function; None for the file itself.
        passed: the values of the parameters if a test calls the function; None for a function that makes actions.
        depth: the depth of nested calls at which the function is read.
    """

    def __init__(
        self,
        python: PythonFile,
        function: _Function | None,
        passed: Mapping[str, ast.expr] | None = None,
        depth: int = 0,
    ) -> None:
        self._python = python
        self._depth = depth
        parameters = function.args.args if function is not None else []
        self._names = {parameter.arg for parameter in parameters}
        if passed is None:
            passed = find_opaque_arguments(python, function) if function is not None else {}
        self._arguments = passed

    def read_test(self, node: ast.expr) -> ast.expr:
        """Return a test as an expression of texts, in which ``$(var NAME)`` is a value.

        Raises:
            _UnknownTestError: its value is unknown.
        """
        if isinstance(node, ast.BoolOp):
            return ast.BoolOp(node.op, [self.read_test(value) for value in node.values])
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
            return ast.UnaryOp(node.op, self.read_test(node.operand))
        if isinstance(node, ast.Compare) and len(node.ops) == 1:
            return self._read_comparison(node, node.ops[0], node.comparators[0])
        if self.find_object(node) is not None:
            return ast.Constant(True)  # the object, not its value
        value = self._resolve(node)
        if isinstance(value, ast.Constant) and isinstance(value.value, bool):
            return value
        if value is not node and isinstance(value, (ast.BoolOp, ast.UnaryOp, ast.Compare)):
            return self.read_test(value)
        if isinstance(value, ast.IfExp):
            return ast.IfExp(*map(self.read_test, (value.test, value.body, value.orelse)))
        if isinstance(value, ast.Call):
            called = self._enter_function(value)
            if called is not None:
                return called[0].read_test(called[1])
            function = called_name(value).rpartition(".")[2]
            if function == "bool" and len(value.args) == 1:
                return self.read_test(value.args[0])
            if function == "strtobool" and len(value.args) == 1:
                return _make_true_test(self._read_text(value.args[0]))
        return ast.Compare(self._read_text(node), [ast.NotEq()], [ast.Constant("")])

    def _read_comparison(self, node: ast.Compare, operator: ast.cmpop, right: ast.expr) -> ast.expr:
        if not isinstance(operator, (*_EQUALITIES, *_INEQUALITIES)):
            raise _UnknownTestError
        is_list = isinstance(operator, (ast.In, ast.NotIn))
        if self.find_object(node.left) is not None and self.is_text(right, is_list=is_list):
            return ast.Constant(isinstance(operator, _INEQUALITIES))
        if not is_list:
            return ast.Compare(self._read_text(node.left), [operator], [self._read_text(right)])
        values = self._resolve(right)
        if not isinstance(values, (ast.List, ast.Tuple, ast.Set)):
            raise _UnknownTestError
        items: ast.expr = ast.List([self._read_text(item) for item in values.elts], ast.Load())
        return ast.Compare(self._read_text(node.left), [operator], [items])

    def _read_text(self, node: ast.expr) -> ast.expr:
        """Return an expression of texts.

        Raises:
            _UnknownTestError: it is something else.
        """
        value = self._resolve(node)
        if isinstance(value, ast.Constant) and isinstance(value.value, str):
            return value
        if isinstance(value, ast.Subscript) and _is_configurations(value.value):
            return _make_variable(self._resolve(value.slice))
        if isinstance(value, ast.IfExp):
            return ast.IfExp(self.read_test(value.test), self._read_text(value.body), self._read_text(value.orelse))
        if isinstance(value, ast.Subscript):
            return ast.Subscript(self._read_texts(value.value), self._read_text(value.slice), ast.Load())
        if not isinstance(value, ast.Call):
            raise _UnknownTestError
        called = self._enter_function(value)
        if called is not None:
            return called[0]._read_text(called[1])
        function = called_name(value).rpartition(".")[2]
        owner = value.func.value if isinstance(value.func, ast.Attribute) else None
        if function == "str" and len(value.args) == 1:
            return self._read_text(value.args[0])
        if function in _TEXT_METHODS and owner is not None and not value.args:
            return ast.Call(ast.Attribute(self._read_text(owner), function, ast.Load()), [], [])
        if function == "get" and owner is not None and _is_configurations(owner) and value.args:
            return _make_variable(self._resolve(value.args[0]))
        performed = owner if function == "perform" else None
        if function == "perform_substitution" and value.args:
            performed = value.args[0]
        name = None if performed is None else self.find_object(performed)
        if name is None:
            raise _UnknownTestError
        return _make_variable(ast.Constant(name))

    def _read_texts(self, node: ast.expr) -> ast.Dict:
        """Return a dictionary of literal texts.

        Raises:
            _UnknownTestError: it is something else.
        """
        value = self._resolve(node)
        keys = [key for key in value.keys if key is not None] if isinstance(value, ast.Dict) else []
        if not isinstance(value, ast.Dict) or len(keys) < len(value.keys):
            raise _UnknownTestError
        if not all(map(self.is_text, (*keys, *value.values))):
            raise _UnknownTestError
        return ast.Dict(list(map(self._resolve, keys)), list(map(self._resolve, value.values)))

    def find_object(self, node: ast.expr) -> str | None:
        """Return the name of the argument whose substitution an expression is; None for other expressions."""
        value = self._resolve(node)
        if not isinstance(value, ast.Call) or called_name(value).rpartition(".")[2] != _CONFIGURATION:
            return None
        name = value.args[0] if value.args else argument_of(value, "variable_name")
        name = None if name is None else self._resolve(name)
        return name.value if isinstance(name, ast.Constant) and isinstance(name.value, str) else None

    def find_substitution(self, node: ast.expr) -> ast.Call | None:
        """Return the call that makes the substitution which an expression is; None for other expressions."""
        value = self._arguments.get(node.id) if isinstance(node, ast.Name) and node.id in self._names else None
        if value is None and not (isinstance(node, ast.Name) and node.id in self._names):
            value = self._python.resolved(node)
        is_call = isinstance(value, ast.Call) and called_name(value).rpartition(".")[2] in SUBSTITUTIONS
        return value if is_call and isinstance(value, ast.Call) else None

    def is_text(self, node: ast.expr, *, is_list: bool = False) -> bool:
        """Return whether an expression is a literal text, or a list of them."""
        value = self._resolve(node)
        if is_list:
            is_known = isinstance(value, (ast.List, ast.Tuple, ast.Set))
            return is_known and all(
                self.is_text(item) for item in ast.iter_child_nodes(value) if isinstance(item, ast.expr)
            )
        return isinstance(value, ast.Constant) and isinstance(value.value, str)

    def _enter_function(self, call: ast.Call) -> tuple[ArgumentReader, ast.expr] | None:
        """Return the value that a called function of the file returns, with a reader of it; None for other calls.

        Raises:
            _UnknownTestError: the value of a call of the file is unknown.
        """
        name = called_name(call)
        definitions = [
            node for node in ast.walk(self._python.tree) if isinstance(node, ast.FunctionDef) and node.name == name
        ]
        if not definitions:
            return None
        function = definitions[0]
        returned = find_returned_value(function.body)
        if len(definitions) > 1 or returned is None or self._depth >= _MAX_CALL_DEPTH:
            raise _UnknownTestError
        names = [parameter.arg for parameter in function.args.args]
        passed = dict(zip(names, call.args, strict=False))
        passed |= {keyword.arg: keyword.value for keyword in call.keywords if keyword.arg is not None}
        values = find_parameter_defaults(function) | {name: self._replace_names(item) for name, item in passed.items()}
        is_clear = not any(
            isinstance(part, ast.Name) and part.id in names and part is not values.get(part.id)
            for value in values.values()
            for part in ast.walk(value)
        )
        if not is_clear:
            raise _UnknownTestError
        return ArgumentReader(self._python, function, values, self._depth + 1), returned

    def _replace_names(self, node: ast.expr) -> ast.expr:
        """Return an expression with the values of the parameters of the function in place of their names."""
        arguments = self._arguments

        class Replacement(ast.NodeTransformer):
            def visit_Name(self, node: ast.Name) -> ast.expr:
                return arguments.get(node.id, node)

        return node if not arguments else Replacement().visit(deepcopy(node))

    def _resolve(self, node: ast.expr) -> ast.expr:
        """Return the value of a name, also of a parameter of a function that ``OpaqueFunction`` calls."""
        value = self._python.resolved(node)
        if isinstance(value, ast.Name) and value.id in self._names:
            return self._python.resolved(self._arguments.get(value.id, value))
        return value


def _make_variable(name: ast.expr) -> ast.expr:
    if not isinstance(name, ast.Constant) or not isinstance(name.value, str):
        raise _UnknownTestError
    return ast.Constant(f"$(var {name.value})")


def _make_true_test(text: ast.expr) -> ast.expr:
    lower = ast.Call(ast.Attribute(text, "lower", ast.Load()), [], [])
    items: list[ast.expr] = [ast.Constant(item) for item in _TRUE_TEXTS]
    return ast.Compare(lower, [ast.In()], [ast.List(items, ast.Load())])


def _is_configurations(node: ast.expr) -> bool:
    return isinstance(node, ast.Attribute) and node.attr == _CONFIGURATIONS


def find_opaque_arguments(python: PythonFile, function: _Function) -> Mapping[str, ast.expr]:
    """Return the expressions that ``OpaqueFunction`` passes to a function, by the names of its parameters.

    Without exactly one such action, and if the file calls the function itself, they are unknown.
    """
    calls = [node for node in ast.walk(python.tree) if isinstance(node, ast.Call)]
    actions = [
        call
        for call in calls
        if called_name(call).rpartition(".")[2] == "OpaqueFunction"
        and isinstance(called := (call.args[0] if call.args else argument_of(call, "function")), ast.Name)
        and called.id == function.name
    ]
    if len(actions) != 1 or any(called_name(call) == function.name for call in calls):
        return {}
    passed = argument_of(actions[0], "args")
    values = None if passed is None else python.resolved(passed)
    names = [parameter.arg for parameter in function.args.args[1:]]
    items = values.elts if isinstance(values, (ast.List, ast.Tuple)) else []
    arguments = dict(zip(names, map(python.resolved, items), strict=False))
    keywords = argument_of(actions[0], "kwargs")
    named = None if keywords is None else python.resolved(keywords)
    if isinstance(named, ast.Dict):
        pairs = zip(named.keys, named.values, strict=True)
        arguments |= {str(key.value): python.resolved(value) for key, value in pairs if isinstance(key, ast.Constant)}
    return arguments
