"""Diagnostics in Chinese: choosing the language, recognising texts, filling in what is the user's."""

from __future__ import annotations

import io
import json
from collections.abc import Iterator
from unicodedata import east_asian_width

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.cli import main
from linkwright.diagnostics import Diagnostic, Note, Severity, SourceText, print_diagnostics, render
from linkwright.diagnostics.formats import format_diagnostics
from linkwright.diagnostics.translation import language, language_of, localized, set_language, translate, translated
from linkwright.diagnostics.translation.catalogue import FOLDERS, Catalogue
from linkwright.diagnostics.translation.templates import Table, Template

VARIABLES = ("LINKWRIGHT_LANG", "LC_ALL", "LC_MESSAGES", "LANG")


@pytest.fixture(autouse=True)
def no_language(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    for name in VARIABLES:
        monkeypatch.delenv(name, raising=False)
    yield
    set_language(None)


# which language


def test_english_where_nothing_says_otherwise() -> None:
    assert language() == "en"


@pytest.mark.parametrize("name", VARIABLES)
def test_each_variable_can_choose_chinese(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(name, "zh_CN.UTF-8")
    assert language() == "zh"


@pytest.mark.parametrize("stronger", range(3))
def test_a_stronger_variable_wins(stronger: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(VARIABLES[stronger], "en_US.UTF-8")
    for name in VARIABLES[stronger + 1 :]:
        monkeypatch.setenv(name, "zh_CN.UTF-8")
    assert language() == "en"


def test_an_empty_variable_says_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LC_ALL", "")
    monkeypatch.setenv("LANG", "zh_CN")
    assert language() == "zh"


def test_what_is_asked_for_wins(monkeypatch: pytest.MonkeyPatch) -> None:
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
def test_language_of_a_locale(locale: str, found: str | None) -> None:
    assert language_of(locale) == found


def test_an_unknown_language_cannot_be_set() -> None:
    with pytest.raises(ValueError, match="the languages are en, zh"):
        set_language("fr")


# texts with holes


def test_other_texts_do_not_match() -> None:
    template = Template("'{}' in <{}> of {}", "{} {} {}")
    for text in ("", "'", "'a'", "'a' in <b> of", "x 'a' in <b> of c", "'a' in <b of c"):
        assert template.match(text) is None
    assert Template("a{}a", "{}").match("a") is None, "the ends may not overlap"


def test_a_long_text_takes_no_long_time() -> None:
    template = Template("'{}' in <{}> of {} has {} numbers where {} are expected: '{}'", "{}{}{}{}{}{}")
    assert template.match("'a' in <b> of c has 1 numbers where " * 20_000) is None


def test_a_text_made_up_to_nest_without_end_is_left_as_it_is() -> None:
    text = "<a> of " * 5_000 + "the robot"
    assert text[-9:] in in_chinese("URDF131", f"<geometry> of {text} is empty").message


def test_a_template_takes_out_and_puts_in() -> None:
    template = Template("'{}' of '{}'", "“{1}”的“{0}”")
    assert template.match("'a' of 'b'") == ["a", "b"]
    assert template.match("'a' of b") is None
    assert template.fill(("a", "b"), lambda _, text: text) == "“b”的“a”"


def test_other_braces_are_text() -> None:
    template = Template("write ${{}} or {name: value}", "写 ${{}} 或 {name: value}")
    values = template.match("write ${r} or {name: value}")
    assert values == ["r"]
    assert template.fill(values, lambda _, text: text) == "写 ${r} 或 {name: value}"


def test_of_two_templates_the_one_that_says_more_is_taken() -> None:
    table = Table([("{} is bad", "{}不好"), ("it is bad", "它不好"), ("link '{}' is bad", "连杆“{}”不好")])
    found = [table.find(text) for text in ("it is bad", "link 'a' is bad", "x is bad", "good")]
    assert [each and each[0].translation for each in found] == ["它不好", "连杆“{}”不好", "{}不好", None]


@pytest.mark.parametrize(("english", "chinese"), [("'{}'", "“{1}”"), ("'{}' '{}'", "“{}”"), ("'{}'", "无")])
def test_a_translation_with_other_holes_is_refused(english: str, chinese: str) -> None:
    with pytest.raises(ValueError, match="hole"):
        Template(english, chinese)


@given(st.text(), st.text())
def test_what_is_filled_in_comes_through(first: str, second: str) -> None:
    template = Template("'{}'\N{RIGHTWARDS ARROW}{}", "{1}\N{LEFTWARDS ARROW}“{0}”")
    if "\N{RIGHTWARDS ARROW}" not in first + second:
        values = template.match(f"'{first}'\N{RIGHTWARDS ARROW}{second}")
        assert values == [first, second]
        assert template.fill(values, lambda _, text: text) == f"{second}\N{LEFTWARDS ARROW}“{first}”"


# diagnostics


def in_chinese(code: str, message: str, **more: object) -> Diagnostic:
    return translate(Diagnostic(code, message, **more), "zh")  # type: ignore[arg-type]


def test_message_notes_and_hint_are_translated_and_nothing_else() -> None:
    source = SourceText("a.xacro", "<xacro:whell/>")
    span = source.span(0, 12)
    english = Diagnostic(
        "XAC401",
        "there is no macro 'whell'",
        span,
        Severity.WARNING,
        (Note("in macro 'base' called here", span), Note("included from here, 3 times")),
        "did you mean 'wheel', 'whirl' or 'shell'?",
        source,
    )
    chinese = translate(english, "zh")
    assert chinese.message == "没有名为“whell”的宏"
    assert chinese.notes == (Note("在宏“base”中，该宏在这里被调用", span), Note("从这里 include 进来，共 3 次"))
    assert chinese.hint == "是不是想写“wheel”、“whirl”或“shell”？"
    assert (chinese.code, chinese.span, chinese.severity, chinese.source) == ("XAC401", span, Severity.WARNING, source)


def test_a_list_of_many_names_ends_with_how_many_more_there_are() -> None:
    found = in_chinese(
        "LAUNCH113", "argument 'x' is not declared by the launch file", hint="it declares 'a', 'b' and 3 more"
    )
    assert found.hint == "它声明了“a”、“b”和另外 3 个"
    found = in_chinese(
        "LAUNCH113", "argument 'x' is not declared by the launch file", hint="it declares 'a and 3 more'"
    )
    assert found.hint == "它声明了“a and 3 more”"


def test_a_line_about_what_a_command_does(monkeypatch: pytest.MonkeyPatch) -> None:
    assert localized("1 error, 12 warnings") == "1 error, 12 warnings"
    monkeypatch.setenv("LANG", "zh_CN.UTF-8")
    assert localized("1 error, 12 warnings") == "1 个错误，12 个警告"
    assert localized("mended 3 findings in 1 file") == "在 1 个文件里改好了 3 个问题"
    assert localized("2 findings; 1 node, 3 topics, 0 frames") == "2 个问题；1 个节点、3 个话题、0 个坐标系"
    assert localized("something else") == "something else"


def test_parts_are_translated_too() -> None:
    message = "<cylinder> of link 'a' has no 'length'"
    assert in_chinese("URDF120", message).message == "连杆“a”的 <cylinder> 缺少“length”"
    message = "the joints go in a circle, a -> b -> a, and 2 links do not hang from the root 'r'"
    assert in_chinese("URDF153", message).message == "关节形成了环：a -> b -> a，有 2 个连杆没有连到根连杆“r”上"
    found = in_chinese("XML103", "cannot read 'a': Permission denied")
    assert found.message == "无法读取“a”：没有权限"


def test_the_words_of_other_programs_may_stay_english() -> None:
    message = "cannot evaluate 'f(x)': something python says only once"
    assert in_chinese("XAC202", message).message == "无法求值“f(x)”：something python says only once"


def test_unknown_texts_stay() -> None:
    diagnostic = Diagnostic("XAC703", "the user's own warning", notes=(Note("a note"),), hint="a hint")
    assert translate(diagnostic, "zh") == diagnostic


def test_a_text_is_known_for_its_own_code_only() -> None:
    assert in_chinese("URDF101", "there is no macro 'a'").message == "there is no macro 'a'"


@pytest.mark.parametrize("name", ["it's", "a' of 'b", "a\nb", "“引号”", "{}", "{0}", "\\1", "车轮"])
def test_names_come_through_as_they_are(name: str) -> None:
    assert in_chinese("XAC401", f"there is no macro '{name}'").message == f"没有名为“{name}”的宏"
    assert in_chinese("URDF180", f"joint 'j' mimics '{name}', which does not exist").message == (
        f"关节“j”跟随（mimic）的关节“{name}”不存在"
    )


@given(st.text())
def test_any_text_can_be_translated(text: str) -> None:
    for code in ("XAC202", "URDF121", "NOPE"):
        translate(Diagnostic(code, text, notes=(Note(text),), hint=text), "zh")


@pytest.mark.parametrize("folder", FOLDERS.values(), ids=FOLDERS)
def test_catalogues_are_sound(folder: object) -> None:
    texts = Catalogue(FOLDERS["zh"])
    kinds = {key for key, _ in texts.templates()}
    for key, template in texts.templates():  # templates are read, and so checked
        assert template.conversions - {"list", "several"} <= kinds, key
        assert not set(template.translation) & set("\"'`") - set(template.english), (key, template.translation)
        assert template.translation.count("“") == template.translation.count("”"), (key, template.translation)


# output


def finding() -> Diagnostic:
    source = SourceText("a.xacro", '<link name="车轮_${prefx}"/>')
    at = source.text.index("prefx")
    span = source.span(at, at + 5)
    message = "the property 'prefx' is not defined"
    return Diagnostic(
        "XAC201", message, span, notes=(Note("included from here", span),), hint="write python.a", source=source
    )


def test_printing_in_chinese(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LANG", "zh_CN.UTF-8")
    stream = io.StringIO()
    print_diagnostics([finding()], stream)
    assert stream.getvalue() == (
        "错误[XAC201]：属性“prefx”没有定义\n"
        "  --> a.xacro:1:18\n"
        "  |\n"
        '1 | <link name="车轮_${prefx}"/>\n'
        "  |                    ^^^^^\n"
        "   = 注意：从这里 include 进来 (a.xacro:1:18)\n"
        "   = 提示：请写成 python.a\n"
    )


def test_carets_stand_below_their_text_in_a_terminal() -> None:
    lines = render(finding()).splitlines()
    cells = "".join(each * (2 if east_asian_width(each) == "W" else 1) for each in lines[3])
    assert cells[lines[4].index("^") : lines[4].rindex("^") + 1] == "prefx"


@pytest.mark.parametrize(
    ("severity", "word"), [(Severity.ERROR, "错误"), (Severity.WARNING, "警告"), (Severity.INFO, "信息")]
)
def test_severities_in_chinese(severity: Severity, word: str) -> None:
    assert render(Diagnostic("XAC702", "a", severity=severity), lang="zh") == f"{word}[XAC702]：a"


def test_programs_get_english_unless_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LANG", "zh_CN.UTF-8")
    english = format_diagnostics([finding()], "json")
    assert "the property 'prefx' is not defined" in english
    set_language("zh")
    chinese = json.loads(format_diagnostics([finding()], "json"))
    assert "属性“prefx”没有定义" in json.dumps(chinese, ensure_ascii=False)
    assert json.loads(english) != chinese


def test_english_costs_nothing() -> None:
    found = [finding()]
    assert translated(found) is found


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
def test_every_command_takes_a_language(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(words) == 1
    assert capsys.readouterr().err.startswith("错误[")
    assert language() == "en", "one run does not choose for the next"


@pytest.mark.parametrize(
    ("words", "said"), [(["--lang", "fr"], "there is no language 'fr'"), (["--lang"], "needs a language")]
)
def test_a_wrong_language_is_wrong_usage(words: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", "a.urdf", *words]) == 2
    assert said in capsys.readouterr().err


def test_words_after_two_dashes_are_left_alone(capsys: pytest.CaptureFixture[str]) -> None:
    main(["check", "--", "--lang", "zh"])
    assert "错误" not in capsys.readouterr().err


def test_the_overview_names_the_option(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--help"]) == 0
    assert "--lang LANGUAGE" in capsys.readouterr().out
