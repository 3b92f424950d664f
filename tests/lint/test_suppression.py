"""Suppression comments and their scope, in XML and in other files."""

from __future__ import annotations

import pytest

from linkwright.diagnostics import SourceText
from linkwright.lint import Settings, check
from linkwright.lint.suppression import find_directives


def suppressed_ranges(text: str) -> list[list[str] | None]:
    return [
        None if directive.ranges is None else [text[start:end] for start, end in directive.ranges]
        for directive in find_directives(SourceText("f", text))
    ]


def directive_words(text: str) -> list[list[str]]:
    return [[word for word, _ in directive.selectors] for directive in find_directives(SourceText("f", text))]


@pytest.mark.parametrize(
    ("comment", "expected"),
    [
        ("<!-- linkwright: ignore -->", []),
        ("<!--linkwright:ignore LW201-->", ["LW201"]),
        ("<!-- linkwright: ignore LW201, LW3 limit-inverted -->", ["LW201", "LW3", "limit-inverted"]),
        ("<!-- linkwright: ignore-file LW201 (because of the vendor) -->", ["LW201"]),
        ("<!-- linkwright: ignore LW201 (see (1), and # 2) -->", ["LW201"]),
        ("<!-- linkwright: ignore LW201 because -->", ["LW201", "because"]),
        ("<!-- linkwright: ignore\n  LW201\n  LW202\n-->", ["LW201", "LW202"]),
    ],
)
def test_suppression_comment_names_codes(comment, expected):
    assert directive_words(f"<robot>{comment}</robot>") == [expected]


@pytest.mark.parametrize("comment", ["<!-- ignore LW201 -->", "<!-- linkwright: ignored -->", "<!-- linkwright -->"])
def test_other_comments_are_not_suppressions(comment):
    assert directive_words(f"<robot>{comment}</robot>") == []


def test_suppression_covers_line_and_next_element():
    assert suppressed_ranges("<r>\n<!-- linkwright: ignore -->\n<a>\n<b/></a>\n</r>") == [["<a>\n<b/></a>"]]
    assert suppressed_ranges("<r>\n<a/> <!-- linkwright: ignore -->\n<b/></r>") == [
        ["<a/> <!-- linkwright: ignore -->\n"]
    ]
    assert suppressed_ranges("<r>\n<!-- linkwright: ignore --> <a>\n</a>\n</r>") == [
        ["<!-- linkwright: ignore --> <a>\n", "<a>\n</a>"]
    ]
    assert suppressed_ranges("<r>\n<!-- linkwright: ignore -->\n<!-- x -->\n<a/></r>") == [["<a/>"]]
    assert suppressed_ranges("<r>\n<!-- linkwright: ignore -->\n</r>") == [[]]
    assert suppressed_ranges("<!-- linkwright: ignore-file -->\n<r/>") == [None]


def test_suppression_in_files_other_than_xml():
    text = "import os\nx = 1  # linkwright: ignore LW842\n# linkwright: ignore LW843 (reason)\ny = 2\nz = 3\n"
    assert directive_words(text) == [["LW842"], ["LW843"]]
    assert suppressed_ranges(text) == [["x = 1  # linkwright: ignore LW842\n"], ["y = 2\n"]]
    assert suppressed_ranges("# linkwright: ignore-file\nx = 1\n") == [None]


def test_unused_suppression_is_reported_with_any_selection(tmp_path):
    path = tmp_path / "robot.urdf"
    path.write_text(
        '<robot name="r">\n  <link name="a"/>\n  <link name="b"/>\n  <joint name="j" type="continuous">\n'
        '    <parent link="a"/>\n    <child link="b"/>\n'
        '    <axis xyz="0 0 2"/> <!-- linkwright: ignore LW221 -->\n'
        "  </joint> <!-- linkwright: ignore LW2 -->\n</robot>\n"
    )
    findings = check(path, settings=Settings(select=("LW001",)))
    assert [(finding.code, finding.span.line) for finding in findings] == [("LW001", 8)]
