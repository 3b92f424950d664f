"""The reader: the tree, and the locations of its nodes."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.diagnostics import LinkwrightError
from linkwright.xmltree import Comment, Element, ProcessingInstruction, Text, parse, parse_file


def all_nodes(element: Element) -> list[Element | Text | Comment | ProcessingInstruction]:
    tree_nodes: list[Element | Text | Comment | ProcessingInstruction] = [element]
    for child in element.children:
        tree_nodes.extend(all_nodes(child) if isinstance(child, Element) else [child])
    return tree_nodes


def test_names_attributes_and_children_are_preserved() -> None:
    document = parse('<r:robot xmlns:r="u" z="1" a=" 2 "><a/>t<b/><a r:k="v"/></r:robot>', "x")
    root = document.root
    assert root.tag == "r:robot"
    assert list(root.attributes.items()) == [("xmlns:r", "u"), ("z", "1"), ("a", " 2 ")]
    assert [child.tag for child in root.elements()] == ["a", "b", "a"]
    assert [child.tag for child in root.elements("a")] == ["a", "a"]
    assert root.first("b") is root.children[2]
    assert root.text() == "t"


def test_walk_visits_elements_in_document_order() -> None:
    root = parse("<r><a><b/>text<c><d/></c></a><!-- e --><f/></r>", "x").root
    assert [element.tag for element in root.walk()] == ["r", "a", "b", "c", "d", "f"]


def test_every_node_has_source_location() -> None:
    text = (
        '<?xml version="1.0"?>\n<!-- 前 -->\n<robot name="轮">\n  <!--c-->文<a\n b="é">x &lt; y</a><?pi d?>'
        "<![CDATA[<é>]]>\r\n<b/>ü</robot>\n<!-- after -->"
    )
    document = parse(text, "x")
    for node in [*document.prolog, *all_nodes(document.root), *document.epilog]:
        remaining_text = text[node.offset :]
        if isinstance(node, Element):
            assert remaining_text.startswith("<" + node.tag)
        elif isinstance(node, Comment):
            assert remaining_text.startswith(f"<!--{node.data}-->")
        elif isinstance(node, ProcessingInstruction):
            assert remaining_text.startswith(f"<?{node.target} {node.data}?>")
        elif "<" not in node.data or node.cdata:
            assert remaining_text.replace("\r\n", "\n").startswith(node.data)
        else:
            assert remaining_text.startswith("x &lt; y")
    span = document.root.first("a").span()  # type: ignore[union-attr]
    assert span is not None
    assert (span.line, span.column, span.end_column) == (4, 12, 14)


def test_attribute_spans_are_found() -> None:
    root = parse("<robot\n  name = 'a &amp; b'   名=\"é\" /><!---->", "x").root
    for name, place in (("name", (2, 11, 20)), ("名", (2, 27, 28)), ("absent", (1, 1, 7))):
        span = root.attribute_span(name)
        assert span is not None
        assert (span.line, span.column, span.end_column) == place
    assert Element("made").span() is None
    assert Element("made").attribute_span("x") is None


def test_cdata_comments_and_instructions_are_preserved() -> None:
    document = parse("<?a b?><!--p--><r>t<![CDATA[c]]><!--i--><?k v?></r><!--e-->", "x")
    assert [type(node) for node in document.prolog] == [ProcessingInstruction, Comment]
    assert [type(node) for node in document.root.children] == [Text, Text, Comment, ProcessingInstruction]
    first, second = document.root.children[:2]
    assert isinstance(first, Text)
    assert isinstance(second, Text)
    assert (first.data, first.cdata, second.data, second.cdata) == ("t", False, "c", True)
    assert isinstance(document.epilog[0], Comment)


def test_internal_entities_are_expanded() -> None:
    document = parse('<!DOCTYPE r [<!ENTITY e "v"><!ENTITY f "&e;&e;">]><r a="&f;">&f;&#33;</r>', "x")
    assert document.root.attributes == {"a": "vv"}
    assert document.root.text() == "vv!"
    assert document.doctype == '<!DOCTYPE r [<!ENTITY e "v"><!ENTITY f "&e;&e;">]>'


def test_line_endings_are_normalized_only_in_tree() -> None:
    document = parse("<r>a\r\nb</r>", "x")
    assert document.root.text() == "a\nb"
    assert document.source is not None
    assert document.source.text == "<r>a\r\nb</r>"


def test_long_text_is_one_node() -> None:
    data = "x &amp; " * 400_000
    assert [type(node) for node in parse(f"<r>{data}</r>", "x").root.children] == [Text]


def test_deep_documents_are_read() -> None:
    document = parse("<a>" * 50_000 + "</a>" * 50_000, "x")
    assert document.root.tag == "a"


@pytest.mark.parametrize(
    ("data", "text"),
    [
        ("<r>é</r>".encode(), "é"),
        (b"\xef\xbb\xbf<r>x</r>", "x"),
        ("<r>é</r>".encode("utf-16"), "é"),
        ('<?xml version="1.0" encoding="ISO-8859-1"?><r>é</r>'.encode("latin-1"), "é"),
        ('<?xml version="1.0" encoding="ISO-8859-1"?><r>é</r>'.encode(), "é"),
    ],
)
def test_encodings_are_detected(data: bytes, text: str) -> None:
    assert parse(data, "x").root.text() == text


def test_parse_file_reads_file(tmp_path: Path) -> None:
    path = tmp_path / "a.urdf"
    path.write_bytes(b"<robot/>")
    document = parse_file(path)
    assert document.root.tag == "robot"
    assert document.source is not None
    assert document.source.name == str(path)


NAMES = st.sampled_from(["a", "b", "名", "x-y.z", "_1"])
VALUES = st.text(alphabet="ab <&>\"'é\n\t中", max_size=6)


def escape(text: str) -> str:
    return "".join(f"&#{ord(character)};" if character in "<&>\"'\n\t" else character for character in text)


def write_element(name: str, attributes: dict[str, str], children: list[str]) -> str:
    inside = "".join(f' {key}="{escape(value)}"' for key, value in attributes.items())
    return f"<{name}{inside}>{''.join(children)}</{name}>"


TREES = st.recursive(
    VALUES.map(escape),
    lambda inner: st.builds(
        write_element, NAMES, st.dictionaries(NAMES, VALUES, max_size=3), st.lists(inner, max_size=4)
    ),
    max_leaves=12,
)


@given(st.lists(TREES, max_size=4))
def test_tree_matches_element_tree(parts: list[str]) -> None:
    text = write_element("root", {}, parts)
    actual, theirs = parse(text, "x").root, ET.fromstring(text)
    pending = [(actual, theirs)]
    while pending:
        element, expected = pending.pop()
        assert element.tag == expected.tag
        assert element.attributes == expected.attrib
        assert element.text() == (expected.text or "") + "".join(child.tail or "" for child in expected)
        assert text.startswith(f"<{element.tag}", element.offset)
        pending.extend(zip(element.elements(), expected, strict=True))


@given(st.text(alphabet="<>/&;=\"'ab !-[]?x:é\n\x01", max_size=25))
def test_random_text_is_read_or_rejected_with_location(text: str) -> None:
    try:
        ET.fromstring(text)
        well_formed = True
    except ET.ParseError:
        well_formed = False
    if well_formed:
        assert isinstance(parse(text, "x").root, Element)
        return
    with pytest.raises(LinkwrightError) as caught:
        parse(text, "x")
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code.startswith("XML")
    assert diagnostic.span is not None
    assert diagnostic.span.line <= text.count("\n") + 1


def test_whitespace_only_text_can_be_omitted() -> None:
    text = "<a>\n  <b> x </b> <!-- c -->\n  <c> </c><![CDATA[ ]]></a>"
    root = parse(text, "a", blanks=False).root
    assert [type(child).__name__ for child in root.children] == ["Element", "Comment", "Element"]
    assert root.first("b").text() == " x "
    assert root.first("c").children == []
    assert root.first("c").offset == text.index("<c>")
