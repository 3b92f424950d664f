"""The tokens of complete and incomplete texts, compared with the reader."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.xmltree import Element, parse
from linkwright.xmltree.tokens import Kind, tokens

ROBOTS = sorted((Path(__file__).parents[2] / "robots").rglob("*.xacro"))
MARKUP = st.text(alphabet="<>/!?-[]=\"' \nab:", max_size=60)


def token_kinds(text: str) -> list[tuple[str, str, bool]]:
    return [(token.kind.name, token.text, token.is_closed) for token in tokens(text)]


def attribute_names(text: str) -> list[tuple[str, str | None, str]]:
    (tag,) = tokens(text)
    return [(attribute.name, attribute.value, attribute.quote) for attribute in tag.attributes()]


@given(MARKUP)
def test_tokens_cover_all_characters(text: str):
    token_list = [*tokens(text)]
    assert "".join(token.text for token in token_list) == text
    assert [token.start for token in token_list] == [
        sum(len(earlier.text) for earlier in token_list[:index]) for index in range(len(token_list))
    ]


@given(MARKUP)
def test_token_attributes_have_correct_positions(text: str):
    for token in tokens(text):
        for attribute in token.attributes():
            assert text[attribute.start :].startswith(attribute.name)
            assert token.start < attribute.start <= attribute.value_start <= attribute.value_end <= attribute.end
            assert attribute.value in (None, text[attribute.value_start : attribute.value_end])


def _all_elements(element: Element):
    yield element
    for child in element.elements():
        yield from _all_elements(child)


@pytest.mark.parametrize("path", ROBOTS, ids=lambda path: path.name)
def test_start_tags_match_parsed_tree(path: Path):
    text = path.read_text(encoding="utf-8")
    tree = {element.offset: element for element in _all_elements(parse(text, path.name).root)}
    starts = [token for token in tokens(text) if token.kind is Kind.START]
    assert [token.start for token in starts] == sorted(tree)
    for token in starts:
        assert token.name == tree[token.start].tag
        assert [attribute.name for attribute in token.attributes()] == [*tree[token.start].attributes]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("a<!-- b", [("TEXT", "a", True), ("COMMENT", "<!-- b", False)]),
        ("<a<b/>", [("START", "<a", False), ("START", "<b/>", True)]),
        ("<![CDATA[<a>]]></b", [("CDATA", "<![CDATA[<a>]]>", True), ("END", "</b", False)]),
        ('<a b="1>0">', [("START", '<a b="1>0">', True)]),
        ('<a b="\n<c/>', [("START", '<a b="\n', False), ("START", "<c/>", True)]),
        (
            '<!DOCTYPE a [<!ENTITY b "]>">]><a/>',
            [("DECLARATION", '<!DOCTYPE a [<!ENTITY b "]>">]>', True), ("START", "<a/>", True)],
        ),
    ],
)
def test_incomplete_markup_ends_before_next_tag(text, expected):
    assert token_kinds(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("<a b", [("b", None, "")]),
        ("<a b=", [("b", "", "")]),
        ('<a b="', [("b", "", '"')]),
        ('<a b="x y', [("b", "x y", '"')]),
        ('<a b=\'"\' c = "d"/>', [("b", '"', "'"), ("c", "d", '"')]),
        ("<a b=1 c>", [("b", "1", ""), ("c", None, "")]),
        ('<a b="x/>', [("b", "x", '"')]),
    ],
)
def test_incomplete_attributes_are_found(text, expected):
    assert attribute_names(text) == expected


@pytest.mark.parametrize("piece", ["<", "<!", "<![", '<a b="', "<!--", "<a '", "<a b=", '"', "<!DOCTYPE ["])
def test_tokenizing_hostile_text_takes_linear_time(piece: str):
    """A quadratic pattern would take minutes, and the test would reach its time limit."""
    attribute_lists = [token.attributes() for token in tokens("<a " + piece * 200_000)]
    assert attribute_lists
