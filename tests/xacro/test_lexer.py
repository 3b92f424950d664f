"""The tokens of expressions, for examples and for any text."""

from __future__ import annotations

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from linkwright.xacro.expressions.template import Token, TokenKind, tokenize
from linkwright.xacro.faults import Fault

TEXTS = st.text(alphabet="$${}()ab 1", max_size=30)


@pytest.mark.parametrize(
    ("text", "tokens"),
    [
        ("", []),
        ("plain", [(TokenKind.TEXT, "plain")]),
        ("${a}", [(TokenKind.EXPRESSION, "a")]),
        ("$(arg a)", [(TokenKind.SUBSTITUTION, "arg a")]),
        ("x${a}y", [(TokenKind.TEXT, "x"), (TokenKind.EXPRESSION, "a"), (TokenKind.TEXT, "y")]),
        ("$${a}", [(TokenKind.TEXT, "${"), (TokenKind.TEXT, "a}")]),
        ("$$$(a", [(TokenKind.TEXT, "$$("), (TokenKind.TEXT, "a")]),
        ("${a}}", [(TokenKind.EXPRESSION, "a"), (TokenKind.TEXT, "}")]),
        ("${'$(x)'}", [(TokenKind.EXPRESSION, "'$(x)'")]),
        ("$", [(TokenKind.TEXT, "$")]),
        ("$x", [(TokenKind.TEXT, "$x")]),
        ("a$", [(TokenKind.TEXT, "a"), (TokenKind.TEXT, "$")]),
        ("$5.00", [(TokenKind.TEXT, "$5.00")]),
        ("$()", [(TokenKind.SUBSTITUTION, "")]),
    ],
)
def test_text_is_split_into_tokens(text: str, tokens: list[tuple[TokenKind, str]]) -> None:
    assert [(token.kind, token.text) for token in tokenize(text)] == tokens


@pytest.mark.parametrize(
    ("text", "start", "end"),
    [("a${b", 1, 4), ("$(b", 0, 3), ("ab$$c", 2, 4), ("x$$", 1, 3), ("${a}$$ ${b}", 4, 6)],
)
def test_malformed_text_is_rejected_with_location(text: str, start: int, end: int) -> None:
    with pytest.raises(Fault) as caught:
        tokenize(text)
    assert (caught.value.code, caught.value.start, caught.value.end) == ("XAC101", start, end)


def _read_tokens(text: str) -> list[Token] | None:
    try:
        return tokenize(text)
    except Fault:
        return None


@given(TEXTS)
def test_tokens_cover_whole_text(text: str) -> None:
    tokens = _read_tokens(text)
    assume(tokens is not None)
    assert tokens is not None
    starts = [token.start for token in tokens]
    ends = [token.end for token in tokens]
    assert starts == [0, *ends][: len(starts)]
    assert all(start < end for start, end in zip(starts, ends, strict=True))
    assert (ends or [0])[-1] == len(text)


@given(st.text(alphabet="$a {(", max_size=10).map(lambda text: text + "${a"))
def test_only_dollars_can_be_malformed(text: str) -> None:
    assume("$$" not in text)
    with pytest.raises(Fault) as caught:
        tokenize(text)
    assert caught.value.start is not None
    assert text[caught.value.start] == "$"


@given(TEXTS)
def test_text_without_dollars_is_unchanged(text: str) -> None:
    plain = text.replace("$", "")
    assert "".join(token.text for token in tokenize(plain)) == plain
    assert len(tokenize(plain)) <= 1


@given(st.text(alphabet="ab {$(", max_size=10), st.integers(min_value=1, max_value=4))
def test_escaping_removes_one_dollar(rest_of_text: str, dollars: int) -> None:
    rest_of_text = rest_of_text.replace("$", "")
    tokens = tokenize("$" * (dollars + 1) + "{" + rest_of_text)
    assert "".join(token.text for token in tokens) == "$" * dollars + "{" + rest_of_text
    assert all(token.kind is TokenKind.TEXT for token in tokens)
