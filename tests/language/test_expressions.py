"""Expressions: insertion keeps the value, and a part can be extracted."""

from __future__ import annotations

import ast

from hypothesis import given
from hypothesis import strategies as st

from linkwright.language.expressions import (
    decode_entities,
    expressions_in,
    is_subexpression,
    parse_expression,
    substitute_name,
)

NUMBERS = st.sampled_from(["1", "2.5", "-3", "0.1"])
SIGNS = st.sampled_from([" + ", " - ", "*", " / ", " ** ", " &lt; ", " and ", " or ", " == "])


def combine_expressions(inner_expressions: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    return st.one_of(
        st.tuples(inner_expressions, SIGNS, inner_expressions).map("".join),
        inner_expressions.map(lambda text: f"({text})"),
        inner_expressions.map(lambda text: f"-{text}"),
        inner_expressions.map(lambda text: f"abs({text})"),
        st.tuples(inner_expressions, inner_expressions, inner_expressions).map(
            lambda texts: f"{texts[0]} if {texts[1]} else {texts[2]}"
        ),
    )


VALUES = st.recursive(NUMBERS, combine_expressions, max_leaves=4)
USES = st.recursive(st.one_of(NUMBERS, st.just("name")), combine_expressions, max_leaves=4).filter(
    lambda text: "name" in text
)


def tree(text: str) -> str:
    return ast.dump(ast.parse(decode_entities(text), mode="eval").body)


@given(USES, VALUES)
def test_substituted_expression_is_one_operand(use, value):
    start = use.index("name")
    new = substitute_name(use, start, start + len("name"), value)
    assert new is not None
    assert tree(new) == tree(f"{use[:start]}({value}){use[start + len('name') :]}")


@given(USES, VALUES)
def test_substituted_expression_is_a_subexpression(use, value):
    start = use.index("name")
    new = substitute_name(use, start, start + len("name"), value)
    assert new is not None
    begin = start + (new[start:] != value + use[start + len("name") :])
    assert is_subexpression(new, begin, begin + len(value))


@given(st.text("${}()ab+'1 ", max_size=20))
def test_expression_functions_survive_any_text(text):
    for expression in expressions_in(text):
        assert text[expression.start : expression.start + 2] == "${"
        assert text[slice(*expression.inner_range)] == expression.source
    parse_expression(text)
    is_subexpression(text, 1, 3)
    substitute_name(text, 1, 3, "a + b")
