"""XML for TinyXML2 is read in linear time."""

from __future__ import annotations

import pytest

from linkwright.diagnostics import phrase
from linkwright.sdf.text import parse_as_gazebo
from linkwright.xmltree.tinyxml import parse_as_tinyxml

MANY = "<!-- a - b -->\n" * 60


@pytest.mark.parametrize("before", ["", '<?xml version="1.0"?>\n'])
def test_many_consecutive_comments_are_read(before):
    text = f"{before}{MANY}<robot>{MANY}<link/></robot>{MANY}"
    for document, warnings in (parse_as_tinyxml(text, "r.urdf", phrase("readers")), parse_as_gazebo(text, "r.urdf")):
        assert document.root.tag == "robot"
        assert not warnings


@pytest.mark.parametrize("text", [f"{MANY}words\n{MANY}<robot/>", f"<?xml version='1.0'?>{MANY}words <robot/>{MANY}"])
def test_text_between_comments_before_root_is_reported(text):
    _, warnings = parse_as_tinyxml(text, "r.urdf", phrase("readers"))
    (warning,) = warnings
    assert warning.span is not None
    assert text.splitlines()[warning.span.line - 1][warning.span.column - 1 :].startswith("words")


def test_declaration_after_comments_is_reported():
    _, warnings = parse_as_gazebo(f'{MANY}<?xml version="1.0"?><sdf/>{MANY}', "w.sdf")
    (warning,) = warnings
    assert warning.span is not None
    assert (warning.span.line, warning.span.column) == (61, 1)
