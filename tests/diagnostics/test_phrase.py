"""Translatable texts, in English and in other languages."""

from __future__ import annotations

import copy
import pickle
from gettext import NullTranslations

import pytest

from linkwright.diagnostics.phrase import (
    Phrase,
    counted,
    foreign,
    joined,
    phrase,
    quoted,
    quoted_names,
    term,
)

CHINESE = {
    "there is no macro '{name}'": "没有名为“{name}”的宏",
    "<{tag}> of {owner} is empty": "{owner}的 <{tag}> 是空的",
    "link '{name}'": "连杆“{name}”",
    "it holds {things}": "其中有{things}",
    "it is {length:.1f} m long": "它长 {length:.1f} 米",
    "write {{{name}}}": "请写 {{{name}}}",
    "{count} error": "{count} 个错误",
    "'{name}'": "“{name}”",
    ("term", ", "): "、",
    ("term", " or "): "或",
    ("term", "; "): "；",
    "cannot read it: {reason}": "无法读取：{reason}",
    ("term", "joint"): "关节",
    ("foreign", "Permission denied"): "没有权限",
}


class Chinese(NullTranslations):
    def gettext(self, message: str) -> str:
        return CHINESE.get(message, message)

    def ngettext(self, singular: str, plural: str, count: int) -> str:
        return CHINESE[singular]

    def pgettext(self, context: str, message: str) -> str:
        return CHINESE.get((context, message), message)


def in_chinese(text: Phrase) -> str:
    return text.translated_text(Chinese())


def test_phrase_equals_its_english_text() -> None:
    text = phrase("there is no macro '{name}'", name="whell")
    assert text == "there is no macro 'whell'"
    assert (text.template, text.arguments) == ("there is no macro '{name}'", {"name": "whell"})


def test_template_is_translated_and_arguments_are_kept() -> None:
    assert in_chinese(phrase("there is no macro '{name}'", name="{whell}")) == "没有名为“{whell}”的宏"


def test_nested_phrases_are_translated_with_spaces_between_scripts() -> None:
    text = phrase("<{tag}> of {owner} is empty", tag="geometry", owner=phrase("link '{name}'", name="a"))
    assert text == "<geometry> of link 'a' is empty"
    assert in_chinese(text) == "连杆“a”的 <geometry> 是空的"
    assert in_chinese(phrase("it holds {things}", things=joined(["a", "b"]))) == "其中有 a、b"


def test_number_format_is_kept_in_translation() -> None:
    text = phrase("it is {length:.1f} m long", length=1.25)
    assert text == "it is 1.2 m long"
    assert in_chinese(text) == "它长 1.2 米"


def test_braces_are_literal_without_arguments() -> None:
    assert phrase("write {a: 1}") == "write {a: 1}"
    text = phrase("write {{{name}}}", name="a")
    assert (text, in_chinese(text)) == ("write {a}", "请写 {a}")


@pytest.mark.parametrize(("count", "english"), [(0, "0 errors"), (1, "1 error"), (2, "2 errors")])
def test_counted_chooses_singular_or_plural(count: int, english: str) -> None:
    text = counted("{count} error", "{count} errors", count)
    assert text == english
    assert in_chinese(text) == f"{count} 个错误"


@pytest.mark.parametrize(
    ("names", "english", "chinese"),
    [
        ([], "", ""),
        (["a"], "'a'", "“a”"),
        (["a", "b"], "'a' or 'b'", "“a”或“b”"),
        (["a", "b", "c"], "'a', 'b' or 'c'", "“a”、“b”或“c”"),
    ],
)
def test_quoted_names_are_joined(names: list[str], english: str, chinese: str) -> None:
    text = quoted_names(names, " or ")
    assert (text, in_chinese(text)) == (english, chinese)


def test_texts_are_joined_with_separator() -> None:
    text = joined([quoted("a"), quoted("b"), "c"], "; ")
    assert (text, in_chinese(text)) == ("'a'; 'b'; c", "“a”；“b”；c")


def test_terms_and_foreign_texts_are_translated_as_a_whole() -> None:
    assert in_chinese(term("joint")) == "关节"
    assert in_chinese(term("transmission")) == "transmission"
    error = OSError(13, "Permission denied")
    assert in_chinese(phrase("cannot read it: {reason}", reason=foreign(error.strerror))) == "无法读取：没有权限"
    assert in_chinese(foreign("{odd}")) == "{odd}"


def test_exception_keeps_its_phrase() -> None:
    text = phrase("there is no macro '{name}'", name="a")
    for argument in (ValueError(text), foreign(ValueError(text))):
        assert in_chinese(phrase("cannot read it: {reason}", reason=argument)) == "无法读取：没有名为“a”的宏"


@pytest.mark.parametrize(
    "text",
    [
        phrase("there is no macro '{name}'", name="a"),
        counted("{count} error", "{count} errors", 2),
        quoted_names("ab", " or "),
        term("joint"),
    ],
)
def test_copied_and_pickled_phrases_stay_translatable(text: Phrase) -> None:
    for copied in (copy.deepcopy(text), pickle.loads(pickle.dumps(text))):
        assert (copied, type(copied), in_chinese(copied)) == (text, type(text), in_chinese(text))
