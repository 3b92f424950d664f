"""The writer: the format of ros/xacro on Python 3.11, without losses."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.diagnostics import LinkwrightError
from linkwright.xmltree import Comment, Document, Element, ProcessingInstruction, Text, parse, write, write_element

HEAD = '<?xml version="1.0" ?>\n'


@pytest.mark.parametrize(
    ("text", "written"),
    [
        ("<a/>", "<a/>\n"),
        ("<a></a>", "<a/>\n"),
        ("<a> </a>", "<a> </a>\n"),
        ("<a> x </a>", "<a> x </a>\n"),
        ('<a z="1" B="2" b="3"/>', '<a B="2" b="3" z="1"/>\n'),
        ("<a>\n<b/>\n\n<c/></a>", "<a>\n  <b/>\n  <c/>\n</a>\n"),
        ("<a>x<b/>y\n z</a>", "<a>\n  x\n  <b/>\n  y\n z\n</a>\n"),
        (
            '<a v="&lt;&gt;&amp;&quot;\'&#10;">&lt;&gt;&amp;"\'</a>',
            "<a v=\"&lt;&gt;&amp;&quot;'\n\">&lt;&gt;&amp;&quot;'</a>\n",
        ),
        ("<a><![CDATA[x<y]]></a>", "<a>\n<![CDATA[x<y]]></a>\n"),
        ("<a><!--c--><?p d?></a>", "<a>\n  <!--c-->\n  <?p d?>\n</a>\n"),
        ("<!--p--><a/><?e f?>", "<!--p-->\n<a/>\n<?e f?>\n"),
        ("<!--p--><!DOCTYPE a SYSTEM 'd'><!--q--><a/>", "<!--p-->\n<!DOCTYPE a\n  SYSTEM 'd'>\n<!--q-->\n<a/>\n"),
        ("<!DOCTYPE a PUBLIC 'p' 'd'><a/>", "<!DOCTYPE a\n  PUBLIC 'p'\n  'd'>\n<a/>\n"),
        ("<a><b><c> t </c></b></a>", "<a>\n  <b>\n    <c> t </c>\n  </b>\n</a>\n"),
    ],
)
def test_output_matches_ros_xacro(text: str, written: str) -> None:
    assert write(parse(text, "x")) == HEAD + written


def test_single_element_is_written() -> None:
    assert write_element(parse("<a><b/></a>", "x").root) == "<a>\n  <b/>\n</a>\n"


def test_deep_documents_are_written() -> None:
    text = write(parse("<a>" * 2_000 + "</a>" * 2_000, "x"))
    assert text.count("<a>") == 1_999


def test_cdata_end_marker_is_split() -> None:
    element = Element("a")
    element.children.append(Text("x]]>y", cdata=True))
    assert parse(write(Document(element)), "x").root.text().strip() == "x]]>y"


def test_invalid_comment_is_rejected() -> None:
    element = Element("a")
    element.children.append(Comment("a--b"))
    with pytest.raises(LinkwrightError) as caught:
        write(Document(element))
    assert caught.value.diagnostics[0].code == "XML301"


TEXTS = st.text(alphabet="ab<&>\"'é中", min_size=1, max_size=6)


def build_element(tag: str, attributes: dict[str, str], children: list[Element | Text | Comment]) -> Element:
    element = Element(tag, attributes)
    for child in children:
        last = element.children[-1] if element.children else None
        if not (isinstance(child, Text) and isinstance(last, Text)):  # adjacent texts would be merged
            element.children.append(child)
    return element


ELEMENTS = st.recursive(
    st.builds(Element, st.sampled_from(["a", "b"]), st.dictionaries(st.sampled_from(["k", "l"]), TEXTS)),
    lambda inner: st.builds(
        build_element,
        st.sampled_from(["a", "b", "名"]),
        st.dictionaries(st.sampled_from(["k", "l", "m"]), TEXTS),
        st.lists(st.one_of(inner, TEXTS.map(Text), st.just("c").map(Comment)), max_size=4),
    ),
    max_leaves=10,
)


def element_content(element: Element) -> object:
    inside: list[object] = []
    for child in element.children:
        if isinstance(child, Element):
            inside.append(element_content(child))
        elif isinstance(child, ProcessingInstruction):
            inside.append((child.target, child.data))
        elif child.data.strip():
            inside.append((type(child).__name__, child.data.strip()))
    return element.tag, element.attributes, inside


@given(ELEMENTS)
def test_written_document_is_read_back(element: Element) -> None:
    text = write(Document(element))
    reread = parse(text, "x")
    assert element_content(reread.root) == element_content(element)
