"""The elements of a complete or incomplete text."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.language.outline import Outline


def outline_tree(text: str) -> list[object]:
    def of(element) -> object:
        label = (element.label, text[element.tag.start : element.end])
        return (*label, [of(child) for child in element.children]) if element.children else label

    return [of(element) for element in Outline.of(text).elements]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ('<a name="x"><b/></a>', [("a x", '<a name="x"><b/></a>', [("b", "<b/>")])]),
        ("<a><b></a><c/>", [("a", "<a><b></a>", [("b", "<b>")]), ("c", "<c/>")]),
        ("<a></b></a>", [("a", "<a></b></a>")]),
        ("<a><b", [("a", "<a><b", [("b", "<b")])]),
        ('<x:i filename="f"/>', [("x:i f", '<x:i filename="f"/>')]),
    ],
)
def test_unclosed_elements_end_at_parent_or_next_tag(text, expected):
    assert outline_tree(text) == expected


@given(st.text(alphabet='<>/ab="c -!', max_size=40))
def test_child_elements_are_inside_their_parents(text: str):
    for element in Outline.of(text).all():
        assert element.tag.end <= element.end <= len(text)
        for child in element.children:
            assert element.tag.end <= child.tag.start <= child.end <= element.end


def test_elements_around_offset():
    text = "<a><b><c/></b></a>"
    assert [element.tag.name for element in Outline.of(text).elements_around(text.index("<c") + 1)] == ["a", "b", "c"]
