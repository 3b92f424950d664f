"""Every message of the program has its Chinese form: those in the source, and those that the test cases bring up."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import pytest

from linkwright.diagnostics import Diagnostic, LinkwrightError
from linkwright.diagnostics.translation.catalogue import FOLDERS, FOREIGN, Catalogue
from linkwright.diagnostics.translation.translate import translate_with
from linkwright.lint.engine import examine
from linkwright.lint.settings import Settings
from linkwright.urdf import read, schema
from linkwright.urdf.plaintext import parse_as_urdfdom
from linkwright.xacro import expand
from tests.lint.cases import load_cases
from tests.places import REPOSITORY
from tests.repository_tools import load_tool
from tests.xacro.cases import read_cases

TESTS = REPOSITORY / "tests"
OF_THE_USER = {"XAC701", "XAC702", "XAC703", "XAC704", "XAC705"}
"""Codes whose messages are the description's own words."""

_MISTAKE = re.compile(r"^```xml\n(.*?)\n```$", re.MULTILINE | re.DOTALL)


@pytest.fixture(params=FOLDERS)
def texts(request: pytest.FixtureRequest) -> Catalogue:
    return Catalogue(FOLDERS[request.param])


def test_the_source_says_nothing_that_is_not_translated_and_nothing_is_translated_that_it_does_not_say() -> None:
    assert load_tool("messages").problems() == []


def test_a_text_that_is_new_is_found(tmp_path: Path) -> None:
    room = tmp_path / "linkwright" / "urdf"
    room.mkdir(parents=True)
    (room / "reader.py").write_text(
        "def complain(findings, element, kind):\n"
        "    message = f\"{kind} '{element.tag}' is odd\"\n"
        "    report(findings, 'URDF999', message)\n\n\n"
        "def report(findings, code, message, hint=None):\n"
        "    findings.append(Diagnostic(code, message, hint=hint or 'think again'))\n\n\n"
        "def check(findings, element):\n"
        "    complain(findings, element, 'link' if element else 'joint')\n",
        encoding="utf-8",
    )
    tool = load_tool("messages")
    said = tool.Templates(tmp_path / "linkwright").said()
    assert [(each.kind, each.code, each.template) for each in said] == [
        ("hint", "URDF999", "think again"),
        ("message", "URDF999", "joint '{}' is odd"),
        ("message", "URDF999", "link '{}' is odd"),
    ]
    check = tool.Check(FOLDERS["zh"], said)
    assert [line.split(": ", 1)[1] for line in check.missing()] == [
        'hint URDF999: URDF999 lacks "think again"',
        "message URDF999: URDF999 lacks \"joint '{}' is odd\"",
        "message URDF999: URDF999 lacks \"link '{}' is odd\"",
    ]
    assert any("there is no macro '{}'" in line for line in check.stale())


@pytest.mark.parametrize("page", sorted((TESTS / "xacro" / "errors").glob("*.md")), ids=lambda page: page.stem)
def test_mistakes_in_xacro(page: Path, texts: Catalogue, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("LINKWRIGHT_UNSET", raising=False)
    for number, case in enumerate(read_cases(page)):
        folder = tmp_path / str(number)
        folder.mkdir()
        case.write(folder)
        monkeypatch.chdir(folder)
        try:
            found: Iterable[Diagnostic] = expand("main.xacro", case.arguments, packages={"pkg_a": "/a"}).diagnostics
        except LinkwrightError as error:
            found = error.diagnostics
        assert_translated(found, texts)


def test_mistakes_in_urdf(texts: Catalogue) -> None:
    mistakes = _MISTAKE.findall((TESTS / "urdf" / "mistakes.md").read_text(encoding="utf-8"))
    assert len(mistakes) > 80
    for text in mistakes:
        assert_translated(read(parse_as_urdfdom(text, "robot.urdf")).diagnostics, texts)


def test_findings_of_the_rules(texts: Catalogue, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for number, case in enumerate(load_cases()):
        folder = tmp_path / str(number)
        for name, text in case.files.items():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_text(text, encoding="utf-8")
        monkeypatch.chdir(folder)
        settings = replace(Settings(), select=case.selectors)
        assert_translated(examine(folder / next(iter(case.files)), settings=settings).diagnostics, texts)


def test_the_meaning_of_every_element_and_attribute(texts: Catalogue) -> None:
    def visit(rule: schema.ElementRule) -> None:
        texts.text(rule.meaning, "meaning")
        for attribute in rule.attributes:
            texts.text(attribute.meaning, "meaning")
            if attribute.unit:
                texts.text(attribute.unit, "unit")
        for child in rule.children:
            visit(child)

    visit(schema.ROBOT)
    assert not texts.missing


def assert_translated(diagnostics: Iterable[Diagnostic], texts: Catalogue) -> None:
    """Fails on a text or a part of one that the catalogue does not know, unless it is the user's or Python's."""
    for diagnostic in diagnostics:
        texts.missing.clear()
        chinese = translate_with(texts, diagnostic)
        assert (chinese.code, chinese.span, chinese.source) == (diagnostic.code, diagnostic.span, diagnostic.source)
        missing = [text for key, text in texts.missing if key not in (FOREIGN, *OF_THE_USER)]
        assert missing == [], diagnostic.code
