"""The compiler from the syntax tree of an expression to nested closures.

There is one method for each kind of node that expressions may use. Nodes of any other kind are refused. A closure
receives the environment and returns the value of its node. The sandbox performs the operations on values. Every closure
that can fail stores its position in the text, so that the columns in messages are exact.
"""

from __future__ import annotations

import _ast as ast  # _ast only has the node classes, whereas the import of ast is slow
import operator
import re
from collections.abc import Callable, Iterator

from linkwright.diagnostics import Phrase, foreign, phrase
from linkwright.loading.lean_typing import Any
from linkwright.xacro.expressions import sandbox
from linkwright.xacro.expressions.bounded import RefusalError, checked_keys
from linkwright.xacro.expressions.calls import Function, bind_parameters, call, charge_value, cost
from linkwright.xacro.expressions.scope import Environment
from linkwright.xacro.expressions.yaml_data import COPIED_TYPES, YamlDict, YamlMapping, wrap
from linkwright.xacro.faults import Fault

Closure = Callable[[Any], Any]
_Binder = Callable[["Environment", Any], None]

_MUTATING_METHODS = frozenset(
    {
        *("add", "append", "clear", "discard", "extend", "insert", "pop", "popitem", "remove", "reverse"),
        *("setdefault", "sort", "update"),
    }
)

_NUMBER_WITH_UNIT = r"\s*([-+]?[0-9.]+)\s*[^\W\d]+\s*"  # compiled on first use, because few files need it
_GENERATOR_COST = 10
"""The number of steps that a generator costs, because of its memory."""
_LINE = r"[^\r\n]*(?:\r\n?|\n|\Z)"
_MAX_DEPTH = 500
"""The maximum nesting of the nodes of an expression. A sum with n terms has n levels."""

FAILURES = (
    ArithmeticError,
    LookupError,
    AttributeError,
    MemoryError,
    RuntimeError,
    TypeError,
    ValueError,
    RefusalError,
)
"""The exceptions that Python's operations raise for unsuitable values."""

_UNARY: dict[str, Callable[[Any], Any]] = {
    "Not": operator.not_,
    "USub": operator.neg,
    "UAdd": operator.pos,
    "Invert": operator.invert,
}

_COMPARISONS: dict[str, Callable[[Any, Any], Any]] = {
    "Eq": operator.eq,
    "NotEq": operator.ne,
    "Lt": operator.lt,
    "LtE": operator.le,
    "Gt": operator.gt,
    "GtE": operator.ge,
    "Is": operator.is_,
    "IsNot": operator.is_not,
    "In": lambda item, container: sandbox.contains(container, item),
    "NotIn": lambda item, container: not sandbox.contains(container, item),
}


def fault_from_error(error: Exception, segment: str, start: int, end: int) -> Fault:
    """Return the fault for a Python exception that a segment of an expression raised."""
    segment = " ".join(segment.split())
    if len(segment) > 60:
        segment = f"{segment[:57]}..."
    if isinstance(error, RefusalError):
        message = phrase("'{segment}' is refused: {error}", segment=segment, error=foreign(error))
        hint_on_limits = phrase("expressions have limits, so that opening a robot from an unknown source is safe")
        return Fault("XAC204", message, start, end, hint_on_limits)
    reason = str(error) or error.__class__.__name__
    hint = None
    if isinstance(error, KeyError):
        reason = phrase("there is no key {error}", error=foreign(error))
    elif isinstance(error, TypeError) and "str" in reason and ("concatenate" in reason or "+:" in reason):
        hint = phrase("convert the number to a string with str(...)")
    elif isinstance(error, RecursionError):
        reason = phrase("it is nested too deeply")
    elif isinstance(error, ZeroDivisionError):
        reason = "division by zero"  # Before Python 3.14, the message depends on the kind of number.
    return Fault(
        "XAC202",
        phrase("cannot evaluate '{segment}': {reason}", segment=segment, reason=foreign(reason)),
        start,
        end,
        hint,
    )


class Compiler:
    """A compiler for the nodes of one expression.

    Args:
        source: the text of the expression.
        shift: the number of characters before the expression in the enclosing text.

    Attributes:
        may_change_values: whether a compiled node may change a value.
    """

    def __init__(self, source: str, shift: int) -> None:
        self._source = source
        self._shift = shift
        self._is_plain = source.isascii() and "\n" not in source and "\r" not in source
        self._depth = 0
        self.may_change_values = False

    def compile(self, node: ast.AST) -> Closure:
        """Return the closure for a node.

        Raises:
            Fault: XAC204 if expressions may not use such a node.
        """
        method = _METHODS.get(node.__class__)
        if method is None:
            raise self._make_refusal(node)
        self._depth += 1
        if self._depth > _MAX_DEPTH:
            raise Fault("XAC102", phrase("the expression is nested too deeply"))
        closure = method(self, node)
        self._depth -= 1
        return closure

    # locations and failures

    def _find_offsets(self, node: Any) -> tuple[int, int]:
        start, end = node.col_offset, node.end_col_offset
        if not self._is_plain:
            lines = re.findall(_LINE, self._source)  # The columns of ast nodes count UTF-8 bytes.
            start, end = (
                sum(map(len, lines[: number - 1]))
                + len(lines[number - 1].encode("utf-8", "replace")[:column].decode("utf-8", "replace"))
                for number, column in ((node.lineno, start), (node.end_lineno, end))
            )
        return start + self._shift, end + self._shift

    def _segment(self, start: int, end: int) -> str:
        return self._source[start - self._shift : end - self._shift]

    def _make_failure(self, error: Exception, start: int, end: int) -> Fault:
        return fault_from_error(error, self._segment(start, end), start, end)

    def _make_refusal(self, node: ast.AST) -> Fault:
        start, end = self._find_offsets(node)
        message = phrase("'{segment}' is not allowed in an expression", segment=self._segment(start, end))
        return Fault("XAC204", message, start, end)

    def _operand_hint(self, error: Exception, *operands: tuple[ast.expr, Any]) -> Phrase | None:
        """Return a hint on the unsuitable operand, or None.

        Such an operand is a zero, a text, or a number with a unit. Constants get no hint.
        """
        for node, value in operands:
            operand_text = self._segment(*self._find_offsets(node))
            if isinstance(node, ast.Constant) or len(operand_text) > 40:
                continue
            if isinstance(error, ZeroDivisionError) and node is operands[-1][0]:
                return phrase(
                    "'{expression}' is {value} here; if that may happen, "
                    "write 'A / {expression} if {expression} else B'",
                    expression=operand_text,
                    value=repr(value),
                )
            if isinstance(error, TypeError) and isinstance(value, str) and len(value) <= 40:
                match = re.fullmatch(_NUMBER_WITH_UNIT, value)
                if match:
                    return phrase(
                        "'{expression}' is the string '{value}' here; write the number alone: '{quantity}'",
                        expression=operand_text,
                        value=value,
                        quantity=match[1],
                    )
                return phrase(
                    "'{expression}' is the string '{value}' here, not a number", expression=operand_text, value=value
                )
        return None

    # names and constants

    def name(self, name: str, start: int) -> Closure:
        """Return the closure for a name at an offset in the source."""
        text_range = (start + self._shift, start + self._shift + len(name))
        if name.startswith("__"):
            raise Fault("XAC204", phrase("the name '{name}' is not allowed in an expression", name=name), *text_range)

        def look_up(env: Environment) -> Any:
            try:
                return env.lookup(name)
            except KeyError:
                raise env.session.undefined_name_fault(name, env, *text_range) from None

        return look_up

    def _name(self, node: ast.Name) -> Closure:
        return self.name(node.id, self._find_offsets(node)[0] - self._shift)

    def _constant(self, node: ast.Constant) -> Closure:
        value = node.value
        return lambda _env: value

    def _joinedstr(self, node: ast.JoinedStr) -> Closure:
        from ast import copy_location, walk

        for descendant in walk(
            node
        ):  # before Python 3.12, nodes inside an f-string do not have their position in the text
            if isinstance(descendant, ast.expr):
                copy_location(descendant, node)
        compiled_parts = [self.compile(part) for part in node.values]
        return lambda env: sandbox.join_strings([part(env) for part in compiled_parts])

    def _formattedvalue(self, node: ast.FormattedValue) -> Closure:
        value, conversion = self.compile(node.value), node.conversion
        specification = self.compile(node.format_spec) if node.format_spec else lambda _env: ""
        start, end = self._find_offsets(node)

        def formatted(env: Environment) -> Any:
            try:
                result = sandbox.format_field_value(
                    charge_value(env.session.budget, value(env)), conversion, specification(env)
                )
                return charge_value(env.session.budget, result)
            except FAILURES as error:
                raise self._make_failure(error, start, end) from None

        return formatted

    def _namedexpr(self, node: ast.NamedExpr) -> Closure:
        name, value = node.target.id, self.compile(node.value)
        self.name(name, 0)
        self.may_change_values = True

        def assign(env: Environment) -> Any:
            result = value(env)
            env.assign(name, result)
            return result

        return assign

    # operators

    def _binop(self, node: ast.BinOp) -> Closure:
        left, right = self.compile(node.left), self.compile(node.right)
        apply = sandbox.OPERATORS[node.op.__class__.__name__]
        start, end = self._find_offsets(node)

        def binary(env: Environment) -> Any:
            a, b = left(env), right(env)
            try:
                result = apply(a, b)
            except FAILURES as error:
                fault = self._make_failure(error, start, end)
                fault.hint = fault.hint or self._operand_hint(error, (node.left, a), (node.right, b))
                raise fault from None
            if result.__class__ is not float and (steps := cost(result)):
                env.session.budget.charge_steps(steps)
            return result

        return binary

    def _unaryop(self, node: ast.UnaryOp) -> Closure:
        operand = self.compile(node.operand)
        apply = _UNARY[node.op.__class__.__name__]
        start, end = self._find_offsets(node)

        def unary(env: Environment) -> Any:
            value = operand(env)
            try:
                return apply(value)
            except FAILURES as error:
                raise self._make_failure(error, start, end) from None

        return unary

    def _boolop(self, node: ast.BoolOp) -> Closure:
        first, *rest = [self.compile(value) for value in node.values]
        final_value = isinstance(node.op, ast.Or)

        def boolean(env: Environment) -> Any:
            value = first(env)
            for operand in rest:
                if bool(value) is final_value:
                    break
                value = operand(env)
            return value

        return boolean

    def _compare(self, node: ast.Compare) -> Closure:
        first = self.compile(node.left)
        rest = [
            (_COMPARISONS[op.__class__.__name__], self.compile(value))
            for op, value in zip(node.ops, node.comparators, strict=True)
        ]
        start, end = self._find_offsets(node)

        def compare(env: Environment) -> Any:
            left = first(env)
            result: Any = True
            for test, operand in rest:
                right = operand(env)
                if right.__class__ is not YamlDict and (steps := cost(right)):
                    env.session.budget.charge_steps(steps)
                try:
                    result = test(left, right)
                except FAILURES as error:
                    raise self._make_failure(error, start, end) from None
                if not result:
                    break
                left = right
            return result

        return compare

    def _ifexp(self, node: ast.IfExp) -> Closure:
        test, then, otherwise = self.compile(node.test), self.compile(node.body), self.compile(node.orelse)
        return lambda env: then(env) if test(env) else otherwise(env)

    # attributes and items of values

    def _attribute(self, node: ast.Attribute) -> Closure:
        value, name = self.compile(node.value), node.attr
        start, end = self._find_offsets(node)
        start_of_name = end - len(name)
        if name.startswith("__"):
            raise Fault("XAC204", phrase("'.{name}' is not allowed in an expression", name=name), start_of_name, end)

        def attribute(env: Environment) -> Any:
            owner = value(env)
            try:
                result = sandbox.attribute(owner, name)
            except AttributeError as error:
                if owner.__class__ is YamlMapping and name in owner:
                    _warn_of_plain_mapping(env, name)
                    return wrap(owner[name])
                hint = env.session.attribute_hint(owner, name)
                raise Fault("XAC205", foreign(error), start_of_name, end, hint) from None
            except FAILURES as error:
                raise self._make_failure(error, start, end) from None
            if result.__class__ in COPIED_TYPES and (steps := cost(result)):
                env.session.budget.charge_steps(steps)
            return result

        return attribute

    def _subscript(self, node: ast.Subscript) -> Closure:
        value, key = self.compile(node.value), self.compile(node.slice)
        start, end = self._find_offsets(node)

        def subscript(env: Environment) -> Any:
            owner, index = value(env), key(env)
            try:
                result = sandbox.subscript(owner, index)
            except (AttributeError, KeyError) as error:
                message = (
                    phrase("there is no key {error}", error=foreign(error))
                    if isinstance(error, KeyError)
                    else foreign(error)
                )
                hint = env.session.attribute_hint(owner, str(index))
                raise Fault("XAC205", message, start, end, hint) from None
            except FAILURES as error:
                raise self._make_failure(error, start, end) from None
            if (index.__class__ is slice or result.__class__ in COPIED_TYPES) and (steps := cost(result)):
                env.session.budget.charge_steps(steps)
            return result

        return subscript

    def _slice(self, node: ast.Slice) -> Closure:
        parts = [self.compile(part) if part else None for part in (node.lower, node.upper, node.step)]
        return lambda env: slice(*[part(env) if part else None for part in parts])

    # calls

    def _call(self, node: ast.Call) -> Closure:
        function = self.compile(node.func)
        positional = [self._compile_argument(argument) for argument in node.args]
        keyword_closures = [(keyword.arg, self.compile(keyword.value)) for keyword in node.keywords]
        is_simple = not keyword_closures and not any(is_starred for is_starred, _ in positional)
        argument_closures = [closure for _, closure in positional]
        start, end = self._find_offsets(node)
        if isinstance(node.func, ast.Attribute) and node.func.attr in _MUTATING_METHODS:
            self.may_change_values = True

        def call_function(env: Environment) -> Any:
            callee = function(env)
            if is_simple:
                arguments = [closure(env) for closure in argument_closures]
                keywords: dict[str, Any] = {}
            else:
                arguments, keywords = _evaluate_arguments(env, positional, keyword_closures)
            try:
                return call(env.session.budget, callee, arguments, keywords)
            except Fault as fault:
                if fault.span is None and fault.start is None:
                    fault.start, fault.end = start, end
                raise
            except FAILURES as error:
                raise self._make_failure(error, start, end) from None

        return call_function

    def _compile_argument(self, node: ast.expr) -> tuple[bool, Closure]:
        if isinstance(node, ast.Starred):
            return True, self.compile(node.value)
        return False, self.compile(node)

    def _lambda(self, node: ast.Lambda) -> Closure:
        parameters = bind_parameters(node.args, self.compile)
        body = self.compile(node.body)
        return lambda env: Function(parameters(env), body, env)

    # lists, tuples, sets and dicts

    def _list(self, node: ast.List) -> Closure:
        return self._collection(node, list)

    def _tuple(self, node: ast.Tuple) -> Closure:
        return self._collection(node, tuple)

    def _set(self, node: ast.Set) -> Closure:
        return self._collection(node, lambda items: set(checked_keys(items)))

    def _collection(self, node: ast.List | ast.Tuple | ast.Set, build: Callable[[list[Any]], Any]) -> Closure:
        items = [self._compile_argument(item) for item in node.elts]
        start, end = self._find_offsets(node)

        def display(env: Environment) -> Any:
            try:
                return charge_value(env.session.budget, build(_evaluate_arguments(env, items, [])[0]))
            except (RefusalError, TypeError) as error:
                raise self._make_failure(error, start, end) from None

        return display

    def _dict(self, node: ast.Dict) -> Closure:
        items = [
            (self.compile(key) if key else None, self.compile(value))
            for key, value in zip(node.keys, node.values, strict=True)
        ]
        start, end = self._find_offsets(node)

        def display(env: Environment) -> Any:
            result: dict[Any, Any] = {}
            try:
                for key, value in items:
                    result.update(checked_keys(value(env)) if key is None else {key(env): value(env)})
                return charge_value(env.session.budget, result)
            except (RefusalError, TypeError, ValueError) as error:
                raise self._make_failure(error, start, end) from None

        return display

    # comprehensions

    def _listcomp(self, node: ast.ListComp) -> Closure:
        return self._collect_items(node, node.elt, list)

    def _setcomp(self, node: ast.SetComp) -> Closure:
        return self._collect_items(node, node.elt, set)

    def _collect_items(
        self, node: ast.ListComp | ast.SetComp, element: ast.expr, build: Callable[[Iterator[Any]], Any]
    ) -> Closure:
        element_value, iterations = self.compile(element), self._iterations(node.generators)
        start, end = self._find_offsets(node)

        def comprehension(env: Environment) -> Any:
            try:
                return charge_value(env.session.budget, build(element_value(inner) for inner in iterations(env)))
            except (RefusalError, TypeError, ValueError) as error:
                raise self._make_failure(error, start, end) from None

        return comprehension

    def _dictcomp(self, node: ast.DictComp) -> Closure:
        key, value, iterations = self.compile(node.key), self.compile(node.value), self._iterations(node.generators)
        start, end = self._find_offsets(node)

        def comprehension(env: Environment) -> Any:
            try:
                return charge_value(env.session.budget, {key(inner): value(inner) for inner in iterations(env)})
            except (RefusalError, TypeError, ValueError) as error:
                raise self._make_failure(error, start, end) from None

        return comprehension

    def _generatorexp(self, node: ast.GeneratorExp) -> Closure:
        item, iterations = self.compile(node.elt), self._iterations(node.generators)

        def generator(env: Environment) -> Iterator[Any]:
            env.session.budget.charge_steps(_GENERATOR_COST)
            return (item(inner) for inner in iterations(env))

        return generator

    def _iterations(self, generators: list[ast.comprehension]) -> Callable[[Environment], Iterator[Environment]]:
        """Return a function that yields the environment for each iteration of a comprehension."""
        loops = []
        for generator in generators:
            if generator.is_async:
                raise Fault("XAC204", phrase("'async' is not allowed in an expression"))
            conditions = [self.compile(condition) for condition in generator.ifs]
            loops.append((self._target(generator.target), self.compile(generator.iter), conditions))

        def run(env: Environment, depth: int) -> Iterator[Environment]:
            bind, items, conditions = loops[depth]
            for item in items(env):
                env.session.budget.charge_steps(2 + cost(item) if item.__class__ in COPIED_TYPES else 2)
                bind(env, item)
                if all(condition(env) for condition in conditions):
                    if depth + 1 < len(loops):
                        yield from run(env, depth + 1)
                    else:
                        yield env

        return lambda env: run(env.inner(), 0)

    def _target(self, node: ast.expr) -> _Binder:
        if isinstance(node, ast.Name):
            name = node.id
            self.name(name, 0)
            return lambda env, value: env.bind(name, value)
        if isinstance(node, (ast.Tuple, ast.List)) and not any(isinstance(item, ast.Starred) for item in node.elts):
            binders = [self._target(item) for item in node.elts]

            def unpack(env: Environment, value: Any) -> None:
                values = list(value)
                if len(values) != len(binders):
                    raise ValueError(
                        phrase(
                            "the target expects {count} values, but receives {other_count}",
                            count=len(binders),
                            other_count=len(values),
                        )
                    )
                for bind, item in zip(binders, values, strict=True):
                    bind(env, item)

            return unpack
        raise self._make_refusal(node)


def _warn_of_plain_mapping(env: Environment, name: str) -> None:
    message = phrase(
        "ros/xacro fails at '.{name}': 'get', 'pop', 'values', '+' and the like return a plain dict from YAML "
        "data, without access by a dot",
        name=name,
    )
    env.session.warn("XAC902", message, hint=phrase("write ['{name}'] instead of .{name}", name=name))


_METHODS: dict[type[ast.AST], Callable[[Compiler, Any], Closure]] = {
    kind: getattr(Compiler, f"_{kind.__name__.lower()}")
    for kind in vars(ast).values()
    if isinstance(kind, type) and issubclass(kind, ast.AST) and hasattr(Compiler, f"_{kind.__name__.lower()}")
}
"""The methods that compile nodes, by class of node."""


def _evaluate_arguments(
    env: Environment, positional: list[tuple[bool, Closure]], named: list[tuple[str | None, Closure]]
) -> tuple[list[Any], dict[str, Any]]:
    arguments: list[Any] = []
    for starred, closure in positional:
        if starred:
            arguments.extend(closure(env))
        else:
            arguments.append(closure(env))
    keywords: dict[str, Any] = {}
    for name, closure in named:
        keywords.update({name: closure(env)} if name else closure(env))
    return arguments, keywords
