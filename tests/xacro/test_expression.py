"""Expressions have the same values as in Python."""

from __future__ import annotations

import ast
import math
import operator
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.xacro.faults import Fault

from .evaluating import evaluate

PYTHON = [
    "1 + 2 * 3 - 4 / 5",
    "7 // 2, 7 % 3, 2 ** 8, -7 // 2, ~5, 6 ^ 3, 6 | 1, 6 & 3, 1 << 4, 32 >> 2",
    "1 < 2 < 3, 1 < 3 < 2, 1 == 1.0, 'a' != 'b', 2 in [1, 2], 'x' not in 'abc', None is None, [] is not None",
    "1 and 2, 0 and 1, 0 or 'x', '' or 0 or None, not 1",
    "'yes' if 1 > 0 else 'no'",
    "'hello'[1:3], 'hello'[::-1], [1, 2, 3][-1], (4, 5)[0], [1, 2, 3, 4][1::2]",
    "'%.3f|%5d|%s' % (1.23456, 7, 'x')",
    "[x * y for x in [1, 2] for y in (3, 4) if x != y - 2]",
    "sorted([3, 1, 2], key=lambda v: -v)",
    "[(lambda a, b=2, *c, d, e=5, **f: (a, b, c, d, e, len(f)))(1, d=4), (lambda *a, **k: (a, len(k)))(1, 2, z=3)]",
    "(lambda f: f(3))(lambda n: n * 2)",
    "[f(2) for f in [lambda n, k=k: n * k for k in [1, 2, 3]]]",
    "sum(x * x for x in range(4))",
    "max(*[1, 5], 3), min([2, 1]), len('abc'), round(2.567, 2), round(2.5), abs(-2)",
    "dict(a=1, **dict(b=2)), list(dict(a=1).items()), dict(a=1).get('z', 0)",
    "[*[1, 2], *(3,)], (*'ab',)",
    "' x '.strip().upper().replace('X', 'y'), 'a,b'.split(','), '-'.join(['a', 'b']), 'abc'.find('c')",
    "list(zip([1, 2], 'ab')), list(enumerate('a')), list(map(str, [1])), list(filter(None, [0, 1]))",
    "isinstance(1, int), isinstance('a', (int, str)), int('7') + float('1.5'), str(1.0), bool([])",
    "[[x for x in range(y)] for y in range(3)]",
    "set([1, 1]), frozenset([2]), tuple([1]), divmod(7, 2), complex(1, 2) * 1j, repr('a'), ord('a')",
    "any([0, 1]), all([]), hash(1) == 1, [1, 2, 3].index(2), (1, 1).count(1)",
    "1_000, 0x1F, 0b11, 1e3, 1j, True, None, ..., b'x'",
    "'a' 'b'",
    "(1,\n 2)",
]


@pytest.mark.parametrize("source", PYTHON)
def test_expression_value_matches_python(source: str) -> None:
    python = evaluate("${python.vars(python)}")
    assert evaluate("${" + source + "}", **python) == eval(source)


ATOMS = st.one_of(
    st.integers(min_value=0, max_value=99).map(str),
    st.floats(min_value=0, max_value=99, allow_nan=False).map(repr),
    st.sampled_from(["a", "b", "'s'", "[1, 2]", "True"]),
)
EXPRESSIONS = st.recursive(
    ATOMS,
    lambda inner: st.one_of(
        st.tuples(inner, st.sampled_from(["+", "-", "*", "/", "//", "%", "<", "==", "and", "or", "in"]), inner).map(
            lambda parts: f"({parts[0]} {parts[1]} {parts[2]})"
        ),
        inner.map(lambda operand: f"(-{operand})"),
        inner.map(lambda operand: f"(not {operand})"),
        st.tuples(inner, inner, inner).map(lambda parts: f"({parts[0]} if {parts[1]} else {parts[2]})"),
        inner.map(lambda operand: f"[{operand} for k in [1, 2]]"),
    ),
    max_leaves=8,
)


@given(EXPRESSIONS)
def test_random_expression_matches_python_or_both_fail(source: str) -> None:
    try:
        expected = eval(source, {"a": 2.5, "b": 3})
    except (TypeError, ValueError, ArithmeticError):
        with pytest.raises(Fault):
            evaluate("${" + source + "}", a=2.5, b=3)
        return
    value = evaluate("${" + source + "}", a=2.5, b=3)
    assert value == expected or (math.isnan(value) and math.isnan(expected))
    assert type(value) is type(expected)


@given(st.floats(allow_nan=False), st.sampled_from([operator.add, operator.mul, operator.sub]), st.integers())
def test_arithmetic_matches_python(left: float, operation: Any, right: int) -> None:
    sign = {operator.add: "+", operator.mul: "*", operator.sub: "-"}[operation]
    try:
        expected = operation(left, right)
    except OverflowError:
        return
    assert repr(evaluate("${l " + sign + " r}", l=left, r=right)) == repr(expected)


def test_single_name_returns_same_object() -> None:
    items = [1, 2]
    assert evaluate("${items}", items=items) is items
    assert evaluate("${ items }", items=items) is items


def test_several_tokens_give_a_string() -> None:
    assert evaluate("${1}${2}") == "12"
    assert evaluate(" ${1}") == " 1"
    assert evaluate("${1}") == 1


def test_unsupported_syntax_nodes_are_rejected() -> None:
    for source in ("(yield)", "await x"):
        with pytest.raises(Fault) as caught:
            evaluate("${" + source + "}")
        assert caught.value.code in ("XAC102", "XAC204")


def test_every_syntax_node_is_compiled_or_rejected() -> None:
    from linkwright.xacro.expressions.compiler import Compiler

    refused = {"Await", "Interpolation", "Starred", "TemplateStr", "Yield", "YieldFrom"}
    old = {"Bytes", "Ellipsis", "NameConstant", "Num", "Str"}
    kinds = {kind.__name__ for kind in ast.expr.__subclasses__()} - old - {"Index", "ExtSlice"}
    compiled = {kind for kind in kinds if hasattr(Compiler, f"_{kind.lower()}")}
    assert kinds - compiled <= refused


@pytest.mark.parametrize(
    ("text", "start", "end"),
    [
        ("x ${a + nope}", 8, 12),
        ("${ nope }", 3, 7),
        ("${[k for k in nope]}", 14, 18),
        ("${'é' + nope}", 8, 12),
        ("${(1,\n nope)}", 7, 11),
        ("${a.nope}", 4, 8),
        ("${1 + 1/0}", 6, 9),
        ("${len(5)}", 2, 8),
        ("$(arg  nope)", 7, 11),
    ],
)
def test_error_spans_are_exact(text: str, start: int, end: int) -> None:
    with pytest.raises(Fault) as caught:
        evaluate(text, a=1.5)
    assert (caught.value.start, caught.value.end) == (start, end)
