"""The conversion of literals, and the values that count as true."""

from __future__ import annotations

import math
from contextlib import suppress
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.xacro.expressions.scope import evaluate_truth, parse_literal


def convert_literal(value: str) -> Any:
    """Convert a literal by the documented rule, without optimizations."""
    if len(value) >= 2 and value[0] == value[-1] == "'":
        return value[1:-1]
    if "_" in value:
        return value
    with suppress(ValueError):
        return int(value)
    with suppress(ValueError):
        return float(value)
    return {"true": True, "True": True, "false": False, "False": False}.get(value, value)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        *(("007", 7), (" 5 ", 5), ("1.50", 1.5), ("1e2", 100.0), ("+4", 4), (".5", 0.5), ("5.", 5.0)),
        *(("true", True), ("True", True), ("false", False), ("TRUE", "TRUE"), ("yes", "yes"), ("0x10", "0x10")),
        *(("1_000", "1_000"), ("'5'", "5"), ("'x y'", "x y"), ("''", ""), ("", ""), ("'", "'"), ("infinity", math.inf)),
        *(("link", "link"), ("-", "-"), ("e5", "e5"), ("1e400", math.inf), ("٣", 3), ("null", "null")),
    ],
)
def test_literals_are_converted(text: str, value: object) -> None:
    assert parse_literal(text) == value
    assert type(parse_literal(text)) is type(value)


@given(
    st.one_of(st.text(max_size=8), st.text(alphabet="0123456789.+-eE_'infatrueTF ", max_size=8), st.floats().map(str))
)
def test_literal_shortcuts_match_reference(text: str) -> None:
    expected, value = convert_literal(text), parse_literal(text)
    assert type(value) is type(expected)
    assert value == expected or (math.isnan(value) and math.isnan(expected))


@given(st.one_of(st.integers(), st.booleans(), st.none(), st.lists(st.integers())))
def test_value_that_is_not_a_string_is_unchanged(value: object) -> None:
    assert parse_literal(value) is value


TRUE = ["true", "True", "1", " 1 ", "-1", "2", 0.5, [0]]
FALSE = ["false", "False", "0", "00", 0.0, [], None]


@pytest.mark.parametrize(("value", "holds"), [*((value, True) for value in TRUE), *((value, False) for value in FALSE)])
def test_truth_values_are_evaluated(value: object, holds: bool) -> None:
    assert evaluate_truth(value) is holds


@pytest.mark.parametrize("value", ["1.0", "", "yes", "TRUE", " true", "none"])
def test_invalid_truth_value_is_an_error(value: str) -> None:
    with pytest.raises(ValueError):
        evaluate_truth(value)
