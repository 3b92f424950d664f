"""Find the tests under which a Python launch file ends the launch with an error."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from linkwright.packages.readers.python_values import PythonFile, called_name
from linkwright.review.launches.outlines import FailingTest

_EXIT_FUNCTIONS = ("sys.exit", "exit", "quit", "os._exit")
"""The calls that end the process."""
_OPPOSITES: Mapping[type[ast.cmpop], type[ast.cmpop]] = {
    ast.Eq: ast.NotEq,
    ast.In: ast.NotIn,
    ast.Is: ast.IsNot,
    ast.IsNot: ast.Is,
    ast.NotEq: ast.Eq,
    ast.NotIn: ast.In,
}
_MAX_EXPRESSIONS = 20
"""The maximum number of expressions that are followed to find the arguments of a test."""
_FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)


@dataclass(frozen=True)
class _Scope:
    """The parameters of the function around a test.

    Attributes:
        calls: the arguments of each call of the function, by parameter.
        unbound: the parameters whose values are unknown in a call.
    """

    calls: Sequence[Mapping[str, ast.expr]] = ()
    unbound: frozenset[str] = field(default_factory=frozenset)


def find_failing_tests(python: PythonFile) -> dict[int, tuple[FailingTest, ...]]:
    """Return the tests of the ``if`` statements around each failing statement, by the identity of the statement."""
    return dict(_find_tests(python, python.tree, (), _Scope()))


def _find_tests(
    python: PythonFile, node: ast.AST, tests: tuple[FailingTest, ...], scope: _Scope
) -> Iterator[tuple[int, tuple[FailingTest, ...]]]:
    if isinstance(node, ast.If):
        inner = (*tests, _read_test(python, node.test, scope))
        others = (*tests, *(_read_test(python, test, scope) for test in _negate(node.test)))
        for body, body_tests in ((node.body, inner), (node.orelse, others)):
            yield from ((id(statement), body_tests) for statement in body if _ends_launch(statement))
            yield from _find_tests_in_body(python, body, body_tests, scope)
    else:
        children = [child for child in ast.iter_child_nodes(node) if not isinstance(child, ast.expr)]
        if isinstance(node, _FUNCTIONS):
            tests, scope = (), _bind_parameters(python, node)
        yield from _find_tests_in_body(python, children, tests, scope)


def _find_tests_in_body(
    python: PythonFile, body: Sequence[ast.AST], tests: tuple[FailingTest, ...], scope: _Scope
) -> Iterator[tuple[int, tuple[FailingTest, ...]]]:
    for child in body:
        yield from _find_tests(python, child, tests, scope)


def _negate(test: ast.expr) -> list[ast.expr]:
    """Return the tests all of which hold if a test does not hold."""
    if isinstance(test, ast.UnaryOp) and isinstance(test.op, ast.Not):
        return [test.operand]
    if isinstance(test, ast.BoolOp) and isinstance(test.op, ast.Or):
        return [negated for value in test.values for negated in _negate(value)]
    opposite = _OPPOSITES.get(type(test.ops[0])) if isinstance(test, ast.Compare) and len(test.ops) == 1 else None
    if isinstance(test, ast.Compare) and opposite is not None:
        return [ast.Compare(test.left, [opposite()], test.comparators)]
    return [ast.UnaryOp(ast.Not(), test)]


def _bind_parameters(python: PythonFile, function: ast.FunctionDef | ast.AsyncFunctionDef) -> _Scope:
    """Return the arguments with which a file calls one of its functions.

    A function that is only passed on, such as to ``OpaqueFunction``, has none.
    """
    calls = [node for node in ast.walk(python.tree) if isinstance(node, ast.Call)]
    calls = [call for call in calls if isinstance(call.func, ast.Name) and call.func.id == function.name]
    parameters = [*function.args.posonlyargs, *function.args.args]
    positional = [parameter.arg for parameter in parameters]
    names = [*positional, *(parameter.arg for parameter in function.args.kwonlyargs)]
    defaults = dict(zip(reversed(positional), reversed(function.args.defaults), strict=False))
    pairs = zip(function.args.kwonlyargs, function.args.kw_defaults, strict=True)
    defaults.update((parameter.arg, default) for parameter, default in pairs if default is not None)
    bindings = []
    for call in calls:
        arguments = dict(zip(positional, call.args, strict=False))
        arguments.update((keyword.arg, keyword.value) for keyword in call.keywords if keyword.arg)
        is_unpacked = any(isinstance(argument, ast.Starred) for argument in call.args)
        is_unpacked = is_unpacked or any(keyword.arg is None for keyword in call.keywords)
        bindings.append({} if is_unpacked else {**defaults, **arguments})
    unbound = frozenset(name for name in names if any(name not in binding for binding in bindings))
    return _Scope(bindings, unbound)


def _ends_launch(statement: ast.stmt) -> bool:
    """Return whether a statement raises an exception or ends the process."""
    if isinstance(statement, ast.Raise):
        return True
    value = statement.value if isinstance(statement, ast.Expr) else None
    return isinstance(value, ast.Call) and called_name(value) in _EXIT_FUNCTIONS


def _read_test(python: PythonFile, test: ast.expr, scope: _Scope) -> FailingTest:
    """Return a test with the values that it accepts, such as of ``kind not in ("a", "b")``."""
    subject, accepted = "", frozenset[str]()
    names = {node.id for node in ast.walk(test) if isinstance(node, ast.Name)}
    is_known = scope.unbound.isdisjoint(names)
    if isinstance(test, ast.Compare) and len(test.ops) == 1:
        values = _find_accepted_values(python, test.ops[0], test.comparators[0])
        if values:
            left = [_bind(test.left, call) for call in scope.calls] or [test.left]
            texts = {_unparse(node) for node in left}
            accepted = frozenset(map(ast.dump, values))
            subject = texts.pop() if len(texts) == 1 else _unparse(test.left)
            is_known = is_known and not all(ast.dump(node) in accepted for node in left)
    arguments = [_find_arguments(python, test, call) for call in scope.calls or ({},)]
    return FailingTest(_unparse(test), subject, accepted, frozenset.intersection(*arguments), is_known)


def _bind(node: ast.expr, call: Mapping[str, ast.expr]) -> ast.expr:
    """Return the argument of a call if an expression is a parameter, or else the expression."""
    return call.get(node.id, node) if isinstance(node, ast.Name) else node


def _find_arguments(python: PythonFile, test: ast.expr, call: Mapping[str, ast.expr]) -> frozenset[str]:
    """Return the arguments of the launch file whose values are tested in a call of the function around the test."""
    expressions = [test]
    for expression in expressions:
        for name in (node for node in ast.walk(expression) if isinstance(node, ast.Name)):
            value = python.resolved(_bind(name, call) if expression is test else name)
            if len(expressions) < _MAX_EXPRESSIONS and all(value is not other for other in (name, *expressions)):
                expressions.append(value)
    calls = [node for expression in expressions for node in ast.walk(expression) if isinstance(node, ast.Call)]
    return frozenset(
        str(node.args[0].value)
        for node in calls
        if called_name(node).rpartition(".")[2] == "LaunchConfiguration"
        and node.args
        and isinstance(node.args[0], ast.Constant)
    )


def _find_accepted_values(python: PythonFile, operator: ast.cmpop, node: ast.expr) -> list[ast.expr]:
    """Return the only values for which a test does not hold; empty if they are unknown."""
    values = python.resolved(node)
    if isinstance(operator, ast.NotEq):
        return [values] if isinstance(values, ast.Constant) else []
    items: Sequence[ast.expr | None] = []
    if isinstance(operator, ast.NotIn) and isinstance(values, (ast.Tuple, ast.List, ast.Set)):
        items = values.elts
    elif isinstance(operator, ast.NotIn) and isinstance(values, ast.Dict):
        items = values.keys
    constants: list[ast.expr] = [item for item in items if isinstance(item, ast.Constant)]
    return constants if len(constants) == len(items) else []


def _unparse(node: ast.AST) -> str:
    return " ".join(ast.unparse(node).split())
