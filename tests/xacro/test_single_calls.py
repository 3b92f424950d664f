"""No function call takes long, because an expansion can only be stopped between calls."""

from __future__ import annotations

import contextlib
import math
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.xacro import expand
from linkwright.xacro.expressions import sandbox
from linkwright.xacro.expressions.bounded import RefusalError, checked_keys
from linkwright.xacro.expressions.builtin_names import MATHEMATICS, tokenize
from linkwright.xacro.expressions.calls import call
from linkwright.xacro.faults import Fault
from linkwright.xacro.limits import Budget, Limits
from tests.work import ends

from .evaluating import evaluate

LONG_LENGTH = 300_000
COLLIDING_NUMBERS = [i * sys.hash_info.modulus for i in range(60_000)]
"""Integers with equal hashes."""
COLLIDING_PAIRS = [(number, number) for number in COLLIDING_NUMBERS]
NUMBERS = [3**12_000 - i for i in range(200)] * 1_000
TEXTS = {
    "one letter": "a" * LONG_LENGTH,
    "half": "a" * (LONG_LENGTH // 2),
    "other end": "a" * (LONG_LENGTH // 2) + "b",
    "other beginning": "ab" + "a" * (LONG_LENGTH // 2),
    "many letters": "".join(map(chr, range(0x100, 0x8100))),
    "high letters": "\xe9" * LONG_LENGTH,
    "codec": "punycode",
    "other codec": "idna",
    "words": "a b " * (LONG_LENGTH // 4),
}


@contextlib.contextmanager
def assert_ends_soon() -> Iterator[None]:
    """Check that the body ends soon, with or without an error."""
    faults = (Fault, RefusalError, TypeError, ValueError, LookupError, ArithmeticError, AttributeError)
    with ends(), contextlib.suppress(*faults):
        yield


def call_quickly(function: Callable[..., Any], *arguments: Any) -> None:
    with assert_ends_soon():
        call(Budget(Limits()), function, list(arguments), {})


def find_methods(kind: type) -> list[str]:
    grown = {name for owner, name in sandbox._GROWING_METHODS if owner is kind}
    return sorted(sandbox._ALLOWED_ATTRIBUTES[kind] | grown)


@pytest.mark.parametrize("name", find_methods(str))
def test_string_methods_end_quickly(name: str) -> None:
    for text in TEXTS.values():
        method = sandbox.attribute(text, name)
        call_quickly(method)
        for argument in (*TEXTS.values(), 2**30):
            call_quickly(method, argument)
        call_quickly(method, "a", "b")


@pytest.mark.parametrize("name", find_methods(bytes))
def test_bytes_methods_end_quickly(name: str) -> None:
    for text in (b"a" * LONG_LENGTH, b"ab" + b"a" * (LONG_LENGTH // 2), b"a-" * (LONG_LENGTH // 2)):
        for argument in (b"ab" + b"a" * (LONG_LENGTH // 2), "punycode", "idna", "utf-7"):
            call_quickly(sandbox.attribute(text, name), argument)


@pytest.mark.parametrize("kind", [set, frozenset, dict, list, tuple])
def test_collection_methods_end_quickly_with_colliding_keys(kind: type) -> None:
    for name in find_methods(kind):
        for items in (
            COLLIDING_NUMBERS,
            iter(COLLIDING_NUMBERS),
            COLLIDING_PAIRS,
            map(abs, COLLIDING_NUMBERS),
            zip(COLLIDING_NUMBERS, COLLIDING_NUMBERS, strict=True),
        ):
            owner = kind({1: 1}) if kind is not dict else {1: 1}
            call_quickly(sandbox.attribute(owner, name), items)


@pytest.mark.parametrize("name", sorted(name for name, value in MATHEMATICS.items() if callable(value)))
def test_math_functions_end_quickly(name: str) -> None:
    function = MATHEMATICS[name]
    for arguments in ((NUMBERS,), NUMBERS, (NUMBERS, NUMBERS), (NUMBERS[0],), NUMBERS[:2], (2000, 1000)):
        call_quickly(function, *arguments)


@pytest.mark.parametrize(
    "text",
    [
        "python.set({})",
        "python.frozenset({})",
        "dict(python.zip({}, {}))",
        "dict([[i, i] for i in {}])",
        "python.set([1]).union({})",
        "python.set([1]) | python.set(map(python.abs, {}))",
        "xacro.dotify([(i, i) for i in {}])",
        "python.set((i, i) for i in {})",
        "python.set([complex(-1000003.0 * i, i) for i in python.range(60000)] + {})",
    ],
)
def test_colliding_keys_are_rejected(text: str) -> None:
    source = text.format(*["[i * 2305843009213693951 for i in python.range(60000)]"] * 2)
    source = source.replace("complex", "python.complex")
    with assert_ends_soon(), pytest.raises(Fault, match=r"same hash|more than \d+"):
        evaluate("${len(" + source + ")}")


def test_equal_or_few_colliding_keys_are_accepted() -> None:
    assert checked_keys([7] * 5_000) == [7] * 5_000
    assert len(set(checked_keys(COLLIDING_NUMBERS[:900]))) == 900
    assert checked_keys([["a"], {}] * 1_000) == [["a"], {}] * 1_000
    assert len(set(checked_keys(i / 7 for i in range(50_000)))) == 50_000


@pytest.mark.parametrize("form", ["{}: 1\n", "? {}\n: 1\n"])
def test_colliding_keys_in_yaml_are_rejected(tmp_path: Path, form: str) -> None:
    (tmp_path / "a.yaml").write_text("".join(form.format(number) for number in COLLIDING_NUMBERS))
    text = "<robot name=\"r\" xmlns:xacro='x'><a v=\"${len(xacro.load_yaml('a.yaml'))}\"/></robot>"
    with assert_ends_soon(), pytest.raises(LinkwrightError, match="60 bits"):
        expand(tmp_path / "a.xacro", text=text)


def test_long_numbers_in_yaml_are_rejected(tmp_path: Path) -> None:
    (tmp_path / "a.yaml").write_text("a: " + ":".join(["59"] * 300_000))
    text = "<robot name=\"r\" xmlns:xacro='x'><a v=\"${xacro.load_yaml('a.yaml')}\"/></robot>"
    with assert_ends_soon(), pytest.raises(LinkwrightError, match="4,000 characters"):
        expand(tmp_path / "a.xacro", text=text)


@pytest.mark.parametrize("sep", ["\\\\](a+)+b", "\\\\](a|aa)+$", "^\\\\](.*)*x[", "\\\\]((a*)*)*b"])
def test_tokenize_ends_quickly_with_pattern_as_separator(sep: str) -> None:
    for text in ("\\" + "a" * 40, "\\" + "aa" * 5_000):
        with assert_ends_soon():
            tokenize(text, sep)


def test_tokenize_treats_separator_as_regular_expression_class() -> None:
    assert tokenize("a\\b]xc", "\\\\]b") == ["a", "xc"]
    assert tokenize("1]2[3,4", "][,") == ["1", "2", "3", "4"]
    assert tokenize("1-2^3", "-^") == ["1", "2", "3"]


def test_common_math_and_string_calls_work() -> None:
    assert evaluate("${math.gcd(12, 18, 27)}") == 3
    if hasattr(math, "sumprod"):
        assert evaluate("${math.sumprod([1, 2], [3, 4])}") == 11
    assert evaluate("${list(map(str.strip, [' a ', 'b ']))}") == ["a", "b"]
    assert evaluate("${'a,b,c'.rsplit(sep=',', maxsplit=1)}") == ["a,b", "c"]
    assert evaluate("${'xxaxx'.strip('x')}") == "a"
    assert evaluate("${'é'.encode('latin-1')}") == b"\xe9"
