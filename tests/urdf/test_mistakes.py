"""The errors of `mistakes.md`: message, location, marked text, notes and hint."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

import linkwright.urdf
from tests.corpora import OWN
from tests.urdf.mistakes import describe_findings

PAGE = (Path(__file__).parent / "mistakes.md").read_text(encoding="utf-8")
SECTION = re.compile(r"^### (.+?)\n\n```xml\n(.*?)\n```\n\n```text\n(.*?)\n```$", re.MULTILINE | re.DOTALL)
MISTAKES = [pytest.param(text, said, id=title) for title, text, said in SECTION.findall(PAGE)]

VERDICTS = json.loads((OWN.folder / "verdicts.json").read_text(encoding="utf-8"))["urdfdom"]
NO_TREES = {"A loop below the root", "A loop beside the root", "A link with two parents"}
"""Cases that urdfdom accepts, and then follows the joints endlessly or loses a joint."""


def test_all_cases_of_page_are_parsed():
    assert len(MISTAKES) == PAGE.count("\n### ") > 80


@pytest.mark.parametrize(("text", "message"), MISTAKES)
def test_message_matches_page(text, message):
    assert describe_findings(text) == message


@pytest.mark.parametrize(("text", "message"), MISTAKES)
def test_urdfdom_verdict_matches_findings(text, message, request):
    title = request.node.callspec.id
    urdfdom = VERDICTS[title]
    if title in NO_TREES:
        assert (urdfdom["accepts"], urdfdom["errors"]) == (True, [])
        return
    assert urdfdom["accepts"] == message.endswith("robot: kept")
    assert bool(urdfdom["errors"]) == ("error URDF" in message)


def test_all_reader_codes_are_on_page():
    room = Path(linkwright.urdf.__file__).parent
    written = {
        code
        for file in room.glob("*.py")
        if file.name != "diagram.py"
        for code in re.findall(r'"(URDF\d{3})"', file.read_text(encoding="utf-8"))
    }
    assert written - set(re.findall(r"^(?:error|warning) (URDF\d{3})", PAGE, re.MULTILINE)) == set()
