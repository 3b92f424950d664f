"""Diagnostics in Chinese: the choice of the language, the catalog, and inserted values."""

from __future__ import annotations

import io
import json
from collections.abc import Iterator
from unicodedata import east_asian_width

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.cli import main
from linkwright.diagnostics import (
    Diagnostic,
    Note,
    Phrase,
    Severity,
    SourceText,
    counted,
    did_you_mean,
    foreign,
    phrase,
    print_diagnostics,
    quoted_names,
    render,
)
from linkwright.diagnostics.formats import format_diagnostics
from linkwright.diagnostics.translation import language, language_of, localized, set_language, translate, translated
from linkwright.doctor.record import format_names
from tests.repository_tools import load_tool

VARIABLES = ("LINKWRIGHT_LANG", "LC_ALL", "LC_MESSAGES", "LANG")


@pytest.fixture(autouse=True)
def no_language(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    for name in VARIABLES:
        monkeypatch.delenv(name, raising=False)
    yield
    set_language(None)


# which language


def test_language_defaults_to_english() -> None:
    assert language() == "en"


@pytest.mark.parametrize("name", VARIABLES)
def test_environment_variables_choose_chinese(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(name, "zh_CN.UTF-8")
    assert language() == "zh"


@pytest.mark.parametrize("preferred_variable", range(3))
def test_environment_variable_of_higher_priority_wins(preferred_variable: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(VARIABLES[preferred_variable], "en_US.UTF-8")
    for name in VARIABLES[preferred_variable + 1 :]:
        monkeypatch.setenv(name, "zh_CN.UTF-8")
    assert language() == "en"


def test_empty_environment_variable_is_ignored(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LC_ALL", "")
    monkeypatch.setenv("LANG", "zh_CN")
    assert language() == "zh"


def test_set_language_overrides_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LINKWRIGHT_LANG", "zh")
    set_language("en")
    assert language() == "en"


@pytest.mark.parametrize(
    ("locale", "found"),
    [
        ("zh", "zh"),
        ("zh_CN.UTF-8", "zh"),
        ("zh-Hans-CN", "zh"),
        ("ZH", "zh"),
        ("en_GB", "en"),
        ("C", None),
        ("de", None),
    ],
)
def test_language_of_locale(locale: str, found: str | None) -> None:
    assert language_of(locale) == found


def test_unknown_language_is_rejected() -> None:
    with pytest.raises(ValueError, match="the languages are en, zh"):
        set_language("fr")


# diagnostics


def in_chinese(message: Phrase, **arguments: object) -> Diagnostic:
    return translate(Diagnostic("XAC401", message, **arguments), "zh")  # type: ignore[arg-type]


def test_message_notes_and_hint_are_translated() -> None:
    source = SourceText("a.xacro", "<xacro:whell/>")
    span = source.span(0, 12)
    english = Diagnostic(
        "XAC401",
        phrase("there is no macro '{name}'", name="whell"),
        span,
        Severity.WARNING,
        (Note(phrase("the macro '{name}' is defined here", name="base"), span),),
        did_you_mean("whell", ["wheel", "wheels", "wheel_2"]),
        source,
    )
    chinese = translate(english, "zh")
    assert chinese.message == "没有名为“whell”的宏"
    assert chinese.notes == (Note("宏“base”在这里定义", span),)
    assert chinese.hint == "是不是想写“wheel”、“wheels”或“wheel_2”？"
    assert (chinese.code, chinese.span, chinese.severity, chinese.source) == ("XAC401", span, Severity.WARNING, source)


def test_long_name_list_ends_with_remaining_count() -> None:
    text = phrase("published by {senders}", senders=format_names([f"/n{number}" for number in range(9)], 2))
    assert text == "published by '/n0', '/n1' and 7 more"
    assert in_chinese(text).message == "它由“/n0”、“/n1”和另外 7 个发布"


def test_localized_translates_command_summary(monkeypatch: pytest.MonkeyPatch) -> None:
    findings = counted("{count} finding", "{count} findings", 3)
    line = phrase("fixed {findings} in {files}", findings=findings, files=counted("{count} file", "{count} files", 1))
    assert localized(line) == "fixed 3 findings in 1 file"
    monkeypatch.setenv("LANG", "zh_CN.UTF-8")
    assert localized(line) == "在 1 个文件里改好了 3 个问题"
    assert localized("something else") == "something else"


def test_nested_reason_is_translated() -> None:
    reason = foreign(PermissionError(13, "Permission denied").strerror)
    text = phrase("cannot read '{path}': {reason}", path="a", reason=reason)
    assert in_chinese(text).message == "无法读取“a”：没有权限"


def test_unknown_foreign_text_stays_english() -> None:
    reason = foreign(ValueError("something python says only once"))
    text = phrase("cannot read '{path}': {reason}", path="a", reason=reason)
    assert in_chinese(text).message == "无法读取“a”：something python says only once"


def test_untranslatable_diagnostic_is_unchanged() -> None:
    diagnostic = Diagnostic("XAC703", foreign("the user's own warning"), notes=(Note(foreign("a note")),))
    assert translate(diagnostic, "zh") == diagnostic


@pytest.mark.parametrize("name", ["it's", "a' of 'b", "a\nb", "“引号”", "{}", "{0}", "\\1", "车轮"])
def test_special_characters_in_names_are_kept(name: str) -> None:
    assert in_chinese(phrase("there is no macro '{name}'", name=name)).message == f"没有名为“{name}”的宏"


@given(st.text())
def test_arbitrary_text_can_be_inserted(text: str) -> None:
    for message in (phrase("there is no macro '{name}'", name=text), foreign(text), quoted_names([text, text], " or ")):
        in_chinese(message)


def test_chinese_catalog_uses_chinese_punctuation() -> None:
    tool = load_tool("catalogs")
    for message in tool.read_catalog(tool.FOLDER / "zh.po"):
        english = "".join(message.id)
        for chinese in [message.string] if isinstance(message.string, str) else message.string:
            assert message.id == "" or not set(chinese) & set("\"'`") - set(english), chinese
            assert chinese.count("“") == chinese.count("”"), chinese


# output


def make_finding() -> Diagnostic:
    source = SourceText("a.xacro", '<link name="车轮_${prefx}"/>')
    offset = source.text.index("prefx")
    span = source.span(offset, offset + 5)
    message = phrase("the property '{name}' is not defined", name="prefx")
    return Diagnostic(
        "XAC201",
        message,
        span,
        notes=(Note(phrase("included from here"), span),),
        hint=phrase("write python.{name}", name="a"),
        source=source,
    )


def test_diagnostics_are_printed_in_chinese(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LANG", "zh_CN.UTF-8")
    stream = io.StringIO()
    print_diagnostics([make_finding()], stream)
    assert stream.getvalue() == (
        "错误[XAC201]：属性“prefx”没有定义\n"
        "  --> a.xacro:1:18\n"
        "  |\n"
        '1 | <link name="车轮_${prefx}"/>\n'
        "  |                    ^^^^^\n"
        "   = 注意：从这里 include 进来 (a.xacro:1:18)\n"
        "   = 提示：请写成 python.a\n"
    )


def test_carets_align_below_double_width_characters() -> None:
    lines = render(make_finding()).splitlines()
    cells = "".join(character * (2 if east_asian_width(character) == "W" else 1) for character in lines[3])
    assert cells[lines[4].index("^") : lines[4].rindex("^") + 1] == "prefx"


@pytest.mark.parametrize(
    ("severity", "word"), [(Severity.ERROR, "错误"), (Severity.WARNING, "警告"), (Severity.INFO, "信息")]
)
def test_severities_are_translated(severity: Severity, word: str) -> None:
    assert render(Diagnostic("XAC702", "a", severity=severity), lang="zh") == f"{word}[XAC702]：a"


def test_machine_formats_stay_english_unless_language_is_set(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LANG", "zh_CN.UTF-8")
    english = format_diagnostics([make_finding()], "json")
    assert "the property 'prefx' is not defined" in english
    set_language("zh")
    chinese = json.loads(format_diagnostics([make_finding()], "json"))
    assert "属性“prefx”没有定义" in json.dumps(chinese, ensure_ascii=False)
    assert json.loads(english) != chinese


def test_translated_returns_same_list_in_english() -> None:
    diagnostics = [make_finding()]
    assert translated(diagnostics) is diagnostics


# the command line


@pytest.mark.parametrize(
    "words",
    [
        ["check", "none.urdf", "--lang", "zh"],
        ["--lang", "zh_CN", "check", "none.urdf"],
        ["check", "--lang=zh", "none.urdf"],
        ["launch", "--lang", "zh", "none.launch.py"],
        ["pkg", "--lang", "zh", "create", "9"],
    ],
)
def test_commands_accept_lang_option(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(words) == 1
    assert capsys.readouterr().err.startswith("错误[")
    assert language() == "en", "the option applies to one run only"


@pytest.mark.parametrize(
    ("words", "message"), [(["--lang", "fr"], "there is no language 'fr'"), (["--lang"], "needs a language")]
)
def test_invalid_lang_option_is_a_usage_error(
    words: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["check", "a.urdf", *words]) == 2
    assert message in capsys.readouterr().err


def test_lang_option_after_double_dash_is_ignored(capsys: pytest.CaptureFixture[str]) -> None:
    main(["check", "--", "--lang", "zh"])
    assert "错误" not in capsys.readouterr().err


def test_main_help_lists_lang_option(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--help"]) == 0
    assert "--lang LANGUAGE" in capsys.readouterr().out


def test_help_and_usage_errors_are_translated(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["topic", "--lang", "zh", "--help"]) == 0
    output = capsys.readouterr().out
    assert "列出、打印、发布和测量话题" in output
    assert "显示这段帮助后结束" in output
    assert main(["check", "--lang", "zh"]) == 2
    assert "缺少必需的参数：FILE|FOLDER|NAME:=VALUE" in capsys.readouterr().err
    assert main(["check"]) == 2
    assert "the following arguments are required" in capsys.readouterr().err
