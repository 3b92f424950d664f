"""Every message in the source and in the test cases has a Chinese translation."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace
from gettext import NullTranslations
from pathlib import Path
from typing import Any

import pytest

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, term
from linkwright.diagnostics.phrase import FOREIGN
from linkwright.diagnostics.translation import LANGUAGES
from linkwright.diagnostics.translation.translate import load_catalog
from linkwright.lint.engine import examine
from linkwright.lint.explain import find_page, known_codes
from linkwright.lint.settings import Settings
from linkwright.urdf import read, schema
from linkwright.urdf.plaintext import parse_as_urdfdom
from linkwright.xacro import expand
from tests.lint.cases import load_cases
from tests.places import REPOSITORY
from tests.repository_tools import load_tool
from tests.xacro.cases import read_cases

TESTS = REPOSITORY / "tests"
_MISTAKE = re.compile(r"^```xml\n(.*?)\n```$", re.MULTILINE | re.DOTALL)


@pytest.fixture(params=sorted(set(LANGUAGES) - {"en"}))
def words(request: pytest.FixtureRequest) -> Recording:
    return Recording(load_catalog(request.param))


class Recording:
    """A catalog that records the templates without a translation."""

    def __init__(self, translations: NullTranslations) -> None:
        self._translations = translations
        self.missing: list[str] = []

    def gettext(self, message: str) -> str:
        return self._heard(message, self._translations.gettext(message))

    def ngettext(self, singular: str, plural: str, count: int) -> str:
        return self._heard(plural, self._translations.ngettext(singular, plural, count))

    def pgettext(self, context: str, message: str) -> str:
        translation = self._translations.pgettext(context, message)
        return translation if context == FOREIGN else self._heard(message, translation)

    def _heard(self, english: str, translation: str) -> str:
        if translation == english and re.search("[a-z]{3}", re.sub(r"\{\w*[^}]*\}", "", english)):
            self.missing.append(english)
        return translation


@pytest.fixture(scope="module")
def source() -> Any:
    """Return the messages of all modules of the program."""
    return load_tool("catalogs").Source()


@pytest.mark.slow  # reads all of the source, which is the same with each Python
def test_catalogs_match_source(source: Any) -> None:
    tool = load_tool("catalogs")
    assert len(source.templates) > 1000
    for path in sorted(tool.FOLDER.glob("*.po")):
        catalog = tool.read_catalog(path)
        assert list(tool.find_problems(catalog, source)) == []
        assert tool.format_catalog(tool.update_catalog(catalog, source)) == path.read_text(encoding="utf-8")


def test_catalog_problems_are_reported(tmp_path: Path) -> None:
    room = tmp_path / "package" / "urdf"
    room.mkdir(parents=True)
    (room / "reader.py").write_text(
        "phrase(\"'{tag}' is odd\", tag=1)\n"
        "phrase('a new one')\n"
        "phrase('{a} is {b}', a=1)\n"
        "phrase(f'{a}')\n"
        "counted('{count} link', '{count} links', 2)\n"
    )
    (tmp_path / "zh.po").write_text(
        'msgid ""\nmsgstr ""\n"Content-Type: text/plain; charset=utf-8\\n"\n\n'
        'msgid "\'{tag}\' is odd"\nmsgstr "“{tage}”很怪"\n\n'
        'msgid "{count} link"\nmsgid_plural "{count} links"\nmsgstr[0] "{count} 个连杆"\n\n'
        'msgid "an old one"\nmsgstr "旧的"\n',
        encoding="utf-8",
    )
    tool = load_tool("catalogs")
    source = tool.Source(tmp_path / "package")
    assert list(tool.find_problems(tool.read_catalog(tmp_path / "zh.po"), source)) == [
        "urdf/reader.py:3: the placeholders of '{a} is {b}' are not its arguments",
        "urdf/reader.py:4: the template is no literal",
        "the translation of ''{tag}' is odd' has other placeholders",
        "nothing says 'an old one'",
        "urdf/reader.py:2: 'a new one' is not in the catalog",
        "urdf/reader.py:3: '{a} is {b}' is not in the catalog",
    ]
    new = tool.update_catalog(tool.read_catalog(tmp_path / "zh.po"), source)
    assert [message.id for message in new if message.id] == [
        "'{tag}' is odd", "a new one", "{a} is {b}", ("{count} link", "{count} links")
    ]  # fmt: skip
    catalog_text = tool.format_catalog(new)
    (tmp_path / "zh.po").write_text(catalog_text, encoding="utf-8")
    assert tool.format_catalog(tool.update_catalog(tool.read_catalog(tmp_path / "zh.po"), source)) == catalog_text


def test_untranslated_page_title_is_reported(tmp_path: Path) -> None:
    rules, pages = tmp_path / "package" / "lint" / "rules", tmp_path / "package" / "lint" / "pages"
    rules.mkdir(parents=True)
    pages.mkdir()
    (rules / "own.py").write_text(
        'class Own(Rule):\n    """A robot that is odd.\n\n    ## Why\n    """\n\n    code = "LW999"\n'
        'class Even(Rule):\n    """A robot that is even."""\n\n    code = "LW998"\n'
        'class Helper:\n    """No rule."""\n'
    )
    (pages / "own.md").write_text("# Own\n\n## OWN101: a thing is odd\n\nText.\n")
    (tmp_path / "zh.po").write_text(
        'msgid ""\nmsgstr ""\n"Content-Type: text/plain; charset=utf-8\\n"\n\n'
        'msgctxt "rule"\nmsgid "A robot that is even"\nmsgstr "偶数的机器人"\n\n'
        'msgctxt "rule"\nmsgid "A robot that is gone"\nmsgstr "没有了的机器人"\n',
        encoding="utf-8",
    )
    tool = load_tool("catalogs")
    source = tool.Source(tmp_path / "package")
    assert list(tool.find_problems(tool.read_catalog(tmp_path / "zh.po"), source)) == [
        "no page has the title 'A robot that is gone'",
        "lint/rules/own.py:1: the title 'A robot that is odd' is not in the catalog",
        "lint/pages/own.md: the title 'a thing is odd' is not in the catalog",
    ]
    new = tool.update_catalog(tool.read_catalog(tmp_path / "zh.po"), source)
    assert [(message.context, message.id, message.string) for message in new if message.id] == [
        ("rule", "A robot that is even", "偶数的机器人"),
        ("rule", "A robot that is odd", ""),
        ("rule", "a thing is odd", ""),
    ]
    assert "'A robot that is odd' is not translated" in list(tool.find_problems(new, source))


def test_checked_titles_match_rule_pages(source: Any) -> None:
    pages = [find_page(code) for code in known_codes()]
    assert {str(page.title) for page in pages if page} == set(source.titles)


@pytest.mark.parametrize("page", sorted((TESTS / "xacro" / "errors").glob("*.md")), ids=lambda page: page.stem)
def test_xacro_errors_are_translated(
    page: Path, words: Recording, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("LINKWRIGHT_UNSET", raising=False)
    for number, case in enumerate(read_cases(page)):
        folder = tmp_path / str(number)
        folder.mkdir()
        case.write(folder)
        monkeypatch.chdir(folder)
        try:
            diagnostics: Iterable[Diagnostic] = expand(
                "main.xacro", case.arguments, packages={"pkg_a": "/a"}
            ).diagnostics
        except LinkwrightError as error:
            diagnostics = error.diagnostics
        assert_translated(diagnostics, words)


def test_urdf_errors_are_translated(words: Recording) -> None:
    mistakes = _MISTAKE.findall((TESTS / "urdf" / "mistakes.md").read_text(encoding="utf-8"))
    assert len(mistakes) > 80
    for text in mistakes:
        document, forbidden = parse_as_urdfdom(text, "robot.urdf")
        assert_translated((*forbidden, *read(document).diagnostics), words)


def test_rule_findings_are_translated(words: Recording, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for number, case in enumerate(load_cases()):
        folder = tmp_path / str(number)
        for name, text in case.files.items():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_text(text, encoding="utf-8")
        monkeypatch.chdir(folder)
        settings = replace(Settings(), select=case.selectors)
        assert_translated(examine(folder / next(iter(case.files)), settings=settings).diagnostics, words)


def test_schema_meanings_and_units_are_translated(words: Recording) -> None:
    def visit(rule: schema.ElementRule) -> None:
        term(rule.meaning).translated_text(words)
        for attribute in rule.attributes:
            term(attribute.meaning).translated_text(words)
            if attribute.unit:
                term(attribute.unit).translated_text(words)
        for child in rule.children:
            visit(child)

    visit(schema.ROBOT)
    assert not words.missing


def assert_translated(diagnostics: Iterable[Diagnostic], words: Recording) -> None:
    """Fail for a text that is not a phrase, or has no translation.

    The parts of a phrase need translations, too.
    """
    for diagnostic in diagnostics:
        words.missing.clear()
        for text in (diagnostic.message, diagnostic.hint, *(note.message for note in diagnostic.notes)):
            if text is not None:
                assert isinstance(text, Phrase), (diagnostic.code, text)
                text.translated_text(words)
        assert words.missing == [], diagnostic.code
