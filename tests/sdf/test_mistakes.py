"""The errors of `mistakes.md`: message, location, marked text, notes and hint."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import linkwright.sdf
from tests.sdf.mistakes import describe_findings

PAGE = (Path(__file__).parent / "mistakes.md").read_text(encoding="utf-8")
SECTION = re.compile(r"^### (.+?)\n\n```xml\n(.*?)\n```\n\n```text\n(.*?)\n```$", re.MULTILINE | re.DOTALL)
MISTAKES = [pytest.param(text, said, id=title) for title, text, said in SECTION.findall(PAGE)]


def test_page_of_mistakes_is_parsed():
    assert len(MISTAKES) == PAGE.count("\n### ") > 40


@pytest.mark.parametrize(("text", "message"), MISTAKES)
def test_mistake_gives_expected_message(text, message):
    assert describe_findings(text) == message


def test_every_sdf_code_is_covered_by_tests():
    tests = Path(__file__).parent
    room = Path(linkwright.sdf.__file__).parent
    source_codes = {code for file in room.glob("*.py") for code in re.findall(r'"(SDF\d{3})"', file.read_text("utf-8"))}
    files = ("test_from_urdf.py", "test_includes.py", "test_reader.py", "test_to_urdf.py")
    tested_texts = PAGE + "".join((tests / file).read_text(encoding="utf-8") for file in files)
    assert source_codes - set(re.findall(r"SDF\d{3}", tested_texts)) == set()
