"""Formatted XML has the same meaning, and formatting it again changes nothing."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.diagnostics import LinkwrightError
from linkwright.xacro import expand
from linkwright.xmltree import parse
from linkwright.xmltree.formatting import apply_edits, changes, format_text
from linkwright.xmltree.style import Style

SHARED = Path(__file__).parents[3] / "shared"
FILES = sorted(
    path
    for folder in (Path(__file__).parents[2] / "robots", SHARED / "corpus" / "robots", SHARED / "worlds")
    for ending in ("*.xacro", "*.urdf", "*.sdf", "*.world", "package.xml", "*.launch.xml")
    for path in folder.rglob(ending)
)

CASES = {
    "levels are indented": ("<a>\n<b>\n      <c/>\n</b></a>", "<a>\n  <b>\n    <c/>\n  </b>\n</a>\n"),
    "spaces in tags": ('<a  b = "1"\tc=\'"\' ></a >', '<a b="1" c=\'"\'></a>\n'),
    "an element on one line stays there": (
        '<a>\n<b> <c x="1"/> </b>\n</a>',
        '<a>\n  <b><c x="1"/></b>\n</a>\n',
    ),
    "siblings get lines": ("<a>\n<b/> <c/>\n</a>", "<a>\n  <b/>\n  <c/>\n</a>\n"),
    "a comment stays beside what it is about": (
        "<a>\n<b/>   <!-- of b -->\n<!-- of c --> <c/>\n</a>",
        "<a>\n  <b/> <!-- of b -->\n  <!-- of c --> <c/>\n</a>\n",
    ),
    "one blank line stays of several": ("<a>\n\n\n<b/>\n \n<c/></a>", "<a>\n\n  <b/>\n\n  <c/>\n</a>\n"),
    "lines of a comment stay": ("<a>\n  <!-- x\n\ty -->\n</a>", "<a>\n  <!-- x\n\ty -->\n</a>\n"),
    "texts stay": ("<a>\n<b> x\n  y </b>\n<c>1 <d/> 2</c></a>", "<a>\n  <b> x\n  y </b>\n  <c>1 <d/> 2</c>\n</a>\n"),
    "blanks alone stay": ("<a>\n<b>\n\n </b></a>", "<a>\n  <b>\n\n </b>\n</a>\n"),
    "space that is declared stays": (
        '<a>\n<b xml:space="preserve">\n<c/></b></a>',
        '<a>\n  <b xml:space="preserve">\n<c/></b>\n</a>\n',
    ),
    "attributes keep their lines, indented by one step": (
        '<a>\n<b\n   c="1" d="2"\n     e="3"/>\n</a>',
        '<a>\n  <b\n    c="1" d="2"\n    e="3"/>\n</a>\n',
    ),
    "a bracket keeps its line": ('<a>\n<b\n c="1"\n/>\n</a>', '<a>\n  <b\n    c="1"\n  />\n</a>\n'),
    "aligned attributes stay aligned": (
        '<a>\n    <b c="1"\n       d="2"/>\n</a>',
        '<a>\n  <b c="1"\n     d="2"/>\n</a>\n',
    ),
    "a value with lines stays": ('<a b="\n  c\n"/>', '<a b="\n  c\n"/>\n'),
    "a tag that is too long continues": (
        '<a>\n<b first="1234567890" second="1234567890"/>\n</a>',
        '<a>\n  <b first="1234567890"\n    second="1234567890"/>\n</a>\n',
    ),
    "the space before a bracket is that of the file": (
        "<a>\n<b />\n<c />\n<d/>\n</a>",
        "<a>\n  <b />\n  <c />\n  <d />\n</a>\n",
    ),
    "line ends are those of the file": ("<a>\r\n<b/>\r\n</a>\r\n", "<a>\r\n  <b/>\r\n</a>\r\n"),
    "the byte order mark stays": ("\ufeff<a>\n<b/></a>", "\ufeff<a>\n  <b/>\n</a>\n"),
    "declarations and entities stay": (
        '<?xml version="1.0"?>  <!DOCTYPE a [<!ENTITY b "c">]>\n<a>&b;</a>\n\n<!-- end -->',
        '<?xml version="1.0"?>\n<!DOCTYPE a [<!ENTITY b "c">]>\n<a>&b;</a>\n\n<!-- end -->\n',
    ),
}


@pytest.mark.parametrize(("before", "after"), CASES.values(), ids=CASES)
def test_text_is_formatted(before: str, after: str):
    style = Style(width=40)
    assert format_text(before, "a.xml", style) == after
    assert format_text(after, "a.xml", style) == after


def test_indent_is_configurable():
    assert format_text("<a><b/>\n</a>", "a.xml", Style(indent=4)) == "<a>\n    <b/>\n</a>\n"


def test_malformed_xml_is_not_formatted():
    with pytest.raises(LinkwrightError) as caught:
        format_text("<a>\n<b></a>", "a.xml")
    assert caught.value.diagnostics[0].code.startswith("XML2")


def test_range_changes_only_its_lines():
    before = "<a>\n<b/>\n<c/>\n\n<d/>\n</a>\n"
    after = format_text(before, "a.xml")
    assert apply_edits(before, changes(before, after, (4, 5))) == "<a>\n<b/>\n<c/>\n\n  <d/>\n</a>\n"
    assert apply_edits(before, changes(before, after)) == after


TEXTS = st.sampled_from(["", " ", "\n", "\n\n  ", " x ", "<!-- c -->", "<?p q?>", "<![CDATA[ ]]>", "&lt;"])
TREES = st.recursive(
    st.tuples(TEXTS, st.sampled_from(['<b c="1" />', "<b\n c='1'\n  d=\"2\"/>", "<b/>"]), TEXTS).map("".join),
    lambda inner: st.tuples(TEXTS, st.sampled_from(["<e>", '<e f="\n">']), inner, inner, st.just("</e>"), TEXTS).map(
        "".join
    ),
    max_leaves=8,
)


@given(TREES.map(lambda inner: f"<a>{inner}</a>"))
def test_formatting_is_idempotent_and_preserves_expansion(text: str):
    formatted = format_text(text, "a.xml", Style(width=20))
    assert str(expand(formatted)) == str(expand(text))
    assert format_text(formatted, "a.xml", Style(width=20)) == formatted


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_corpus_files_are_formatted_idempotently(path: Path):
    text = path.read_bytes().decode("utf-8", "replace")
    try:
        parse(text, path.name)
    except LinkwrightError:
        return
    formatted = format_text(text, path.name)
    assert format_text(formatted, path.name) == formatted
