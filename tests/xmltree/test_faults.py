"""The messages about text that is not well-formed."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.xmltree import Overlay, parse, parse_file, reader


def find_fault(text: str | bytes) -> tuple[str, str, int, int, str | None]:
    with pytest.raises(LinkwrightError) as caught:
        parse(text, "robot.urdf")
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.span is not None
    assert diagnostic.source is not None
    return diagnostic.code, diagnostic.message, diagnostic.span.line, diagnostic.span.column, diagnostic.hint


DOUBLE = "write '</b>' in place of the second '<b>' in line 2"
AMPERSAND = "write '&amp;' for the character '&'"
CASES = [
    ("<a>\n  <b></c>\n</a>", "XML201", "'</c>' does not close '<b>'", 2, 6, "write '</b>', or remove it"),
    ("<a>\n  <b>\n</a>", "XML201", "'</a>' does not close '<b>'", 3, 1, "write '</b>' before it"),
    ("<a>\n  <b>x<b>\n</a>", "XML201", "'</a>' does not close '<b>'", 3, 1, DOUBLE),
    ("<xarco:a/>", "XML205", "the prefix 'xarco' of 'xarco:a' is not declared", 1, 2, "did you mean 'xacro:a'?"),
    ("<a>\n  <b>", "XML202", "'<b>' is never closed", 2, 3, "write '</b>' where it ends"),
    ("<a>é<b/>", "XML202", "'<a>' is never closed", 1, 1, "write '</a>' where it ends"),
    ("<a><!-- x", "XML203", "this comment is never closed", 1, 4, "close it with '-->'"),
    ("<a><![CDATA[ x", "XML203", "this CDATA section is never closed", 1, 4, "close it with ']]>'"),
    ("<a>\n<b x='1", "XML203", "this tag has no closing '>'", 2, 1, "look for a missing '>' or a missing quote"),
    ("<a b='1' b='2'/>", "XML204", "the attribute 'b' occurs twice in this element", 1, 10, "keep one of the two"),
    ("<a>\n<é:b/></a>", "XML205", "the prefix 'é' of 'é:b' is not declared", 2, 2, None),
    ("<a x:b='1'/>", "XML205", "the prefix 'x' of 'x:b' is not declared", 1, 4, None),
    ("<a>é & b</a>", "XML206", "'&' does not begin an entity", 1, 6, AMPERSAND),
    ("<a b='x&y'/>", "XML206", "'&' does not begin an entity", 1, 8, AMPERSAND),
    ("<a b=1/>", "XML206", "the value of 'b' is not in quotes", 1, 6, 'write b="..."'),
    ("<a b/>", "XML206", "the attribute 'b' has no value", 1, 4, 'write b="..."'),
    ("<a b='1'c='2'/>", "XML206", "a space is missing between two attributes", 1, 9, None),
    ("<a>1 < 2</a>", "XML206", "'<' does not begin a tag", 1, 6, "write '&lt;'"),
    (
        "<a><!-- a -- b --></a>",
        "XML206",
        "'--' is not allowed inside a comment",
        1,
        11,
        "use other characters, such as '=='",
    ),
    ("<a>\x01</a>", "XML206", "the character U+0001 is not allowed in XML", 1, 4, None),
    ("<a>&nope;</a>", "XML208", "the entity '&nope;' is not defined", 1, 4, AMPERSAND),
    (
        "<a/>\n<b/>",
        "XML207",
        "there is content after the end of the root element",
        2,
        1,
        "keep one root element: an XML file has exactly one",
    ),
    ("hello", "XML206", "this is not XML", 1, 1, None),
    ("# A title\n\nand text", "XML206", "this is not XML", 1, 1, None),
    ("{a: 1} <robot/>", "XML206", "this is not XML", 1, 1, None),
    (
        "\n<?xml version='1.0'?><a/>",
        "XML206",
        "the XML declaration '<?xml' must be at the very start of the file",
        2,
        1,
        None,
    ),
    ("<!-- only -->", "XML206", "there is no root element", 1, 14, None),
]


@pytest.mark.parametrize(("text", "code", "message", "line", "column", "hint"), CASES, ids=[case[2] for case in CASES])
def test_mistakes_have_expected_findings(
    text: str, code: str, message: str, line: int, column: int, hint: str | None
) -> None:
    fault = find_fault(text)
    assert fault[:4] == (code, message, line, column)
    if hint is not None:
        assert fault[4] == hint


def test_mismatched_tag_notes_opening_tag() -> None:
    with pytest.raises(LinkwrightError) as caught:
        parse("<a>\n  <b>\n</a>", "x")
    (note,) = caught.value.diagnostics[0].notes
    assert note.span is not None
    assert (note.message, note.span.line, note.span.column) == ("'<b>' is opened here", 2, 3)


def test_missing_attribute_quote_is_reported() -> None:
    code, _, line, _, hint = find_fault('<a>\n<b x="1 y="2">\n</b></a>')
    assert code == "XML206"
    assert line == 2
    assert hint is not None


@pytest.mark.parametrize("text", ["", "  \n "])
def test_empty_file_is_reported(text: str) -> None:
    code, message, *_ = find_fault(text)
    assert (code, message) == ("XML105", "'robot.urdf' is empty")


@pytest.mark.parametrize(
    ("name", "element"),
    [("arm.xacro", "<robot"), ("package.xml", "<package"), ("a.launch", "<launch>"), ("a.launch.xml", "<launch>")],
)
def test_empty_file_hint_names_root_element(name: str, element: str) -> None:
    with pytest.raises(LinkwrightError) as caught:
        parse("", name)
    assert element in str(caught.value.diagnostics[0].hint)


def test_invalid_utf8_byte_is_reported() -> None:
    code, message, line, column, hint = find_fault(b"<a>\n\xc3\xa9<b n='\xff'/></a>")
    assert (code, message, line, column) == ("XML104", "byte 0xff is not valid UTF-8", 2, 8)
    assert hint is not None


@pytest.mark.parametrize(
    "data",
    [b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR", b"PK\x03\x04\0\0\0", b"\x7fELF\x02\x01\x01\0", b"\0" * 80 + b"\x0c\0\0\0"],
)
def test_binary_file_is_reported(data: bytes) -> None:
    code, message, *_, hint = find_fault(data)
    assert (code, message) == ("XML104", "'robot.urdf' is not a text file")
    assert "check that it is the intended file" in str(hint)


@pytest.mark.parametrize("encoding", ["utf-16-le", "utf-16-be"])
def test_utf_16_without_byte_order_mark_is_reported(encoding: str) -> None:
    code, message, *_, hint = find_fault("<a b='车'/>".encode(encoding))
    assert (code, message) == ("XML104", "'robot.urdf' is in UTF-16 and has no byte order mark")
    assert hint == "save the file as UTF-8"


def test_null_character_is_reported_with_location() -> None:
    assert find_fault(b"<a>\n <b n='\0'/></a>")[:4] == ("XML206", "the character U+0000 is not allowed in XML", 2, 8)


@pytest.mark.parametrize(
    "text",
    [
        "<a>\n<<<<<<< HEAD\n<b/>\n=======\n<c/>\n>>>>>>> theirs\n</a>",
        '<a\n<<<<<<< HEAD\n b="1"\n=======\n b="2"\n>>>>>>> theirs\n/>',
    ],
)
def test_merge_conflict_is_reported(text: str) -> None:
    code, message, line, column, hint = find_fault(text)
    assert (code, message) == ("XML206", "there is an unresolved merge conflict here")
    assert (line, column) == (2, 1)
    assert "keep one of the two" in str(hint)


def test_gbk_text_is_recognized() -> None:
    code, message, line, column, hint = find_fault('<a>\n <b n="机器人底盘"/></a>'.encode("gbk"))
    assert (code, message, line, column) == ("XML104", "byte 0xbb is not valid UTF-8", 2, 8)
    assert "though it looks like GBK" in str(hint)
    assert "GBK" not in str(find_fault("<a n='rübe'/>".encode("latin-1"))[-1])


@pytest.mark.parametrize(
    ("text", "language", "column"),
    [
        ("<a>\n <% 3.times do |i| %><b/><% end %></a>", "ERB", 2),
        ('<a>\n  <b n="<%= 3 %>"/></a>', "ERB", 9),
        ("<%\nn = 3\n%>\n<a/>", "ERB", 1),
        ("{% macro a(b) %}\n<a/>", "Jinja", 1),
        ("{#- told -#}\n<a/>", "Jinja", 1),
    ],
)
def test_template_language_is_named(text: str, language: str, column: int) -> None:
    code, message, _, location, hint = find_fault(text)
    assert (code, location) == ("XML206", column)
    assert message == f"this is a {language} template, not XML"
    assert (
        str(hint)
        == {
            "ERB": "run `erb TEMPLATE > FILE`, and pass that file",
            "Jinja": "render it with Jinja, and pass the rendered file",
        }[language]
    )


def test_error_before_template_is_reported_first() -> None:
    assert find_fault("<a>1 < 2 <% %></a>")[1] == "'<' does not begin a tag"


def test_unknown_encoding_is_reported() -> None:
    with pytest.raises(LinkwrightError) as caught:
        parse(b'<?xml version="1.0" encoding="klingon"?><a>\xff</a>', "x")
    assert caught.value.diagnostics[0].code == "XML104"


def test_unreadable_paths_are_reported(tmp_path: Path) -> None:
    codes = []
    for path in (tmp_path / "none.urdf", tmp_path, Path("a\0b")):
        with pytest.raises(LinkwrightError) as caught:
            parse_file(path)
        codes.append(caught.value.diagnostics[0].code)
    assert codes == ["XML101", "XML102", "XML103"]


def test_missing_file_permission_is_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(_path: Path, _at_most: int) -> bytes:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(reader, "read_file", refuse)  # root, as on some test machines, may read all files
    with pytest.raises(LinkwrightError) as caught:
        parse_file(tmp_path / "a.urdf")
    assert caught.value.diagnostics[0].code == "XML103"
    assert "Permission denied" in caught.value.diagnostics[0].message


def test_namespace_prefix_is_valid_only_below_declaration() -> None:
    parse('<a><b xmlns:k="u"><k:c k:d="1"/></b></a>', "x")
    parse('<a xml:lang="en" xmlns:k="u"><k:b/><c xmlns:k="v"><k:d/></c><k:e/></a>', "x")
    with pytest.raises(LinkwrightError) as caught:
        parse('<a><b xmlns:k="u"/><k:c/></a>', "x")
    assert caught.value.diagnostics[0].code == "XML205"


@pytest.mark.parametrize("name", ["arm.urdf", "arm.xacro"])
def test_git_lfs_pointer_is_recognized(name: str, tmp_path: Path) -> None:
    path = tmp_path / name
    path.write_bytes(b"version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n")
    with pytest.raises(LinkwrightError) as caught:
        parse_file(path)
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code == "XML106"
    assert "Git LFS pointer" in diagnostic.message
    assert "git lfs pull" in (diagnostic.hint or "")
    text = path.read_text()
    for read in (lambda: parse(text, "<stdin>"), lambda: Overlay({path: text}).read(str(path))):
        with pytest.raises(LinkwrightError, match="Git LFS pointer"):
            read()
