"""Elements that are copied unchanged look like other elements."""

from __future__ import annotations

import copy
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.xacro import Limits, expand
from linkwright.xmltree import Comment, Element, write_element

HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'


def write_model(tmp_path: Path, inside: str) -> Path:
    path = tmp_path / "model.xacro"
    path.write_text(f"{HEAD}{inside}</robot>", encoding="utf-8")
    return path


def test_macro_calls_give_separate_elements(tmp_path: Path) -> None:
    macro = '<xacro:macro name="m"><link name="a"><visual/></link></xacro:macro>'
    expansion = expand(write_model(tmp_path, f"{macro}<xacro:m/>\n<xacro:m/>"))
    first, second = expansion.document.root.elements("link")
    assert first.attributes == second.attributes
    assert first is not second
    assert next(first.elements()) is not next(second.elements())
    lines = [expansion.origin(next(link.elements())).trail[0].span.line for link in (first, second)]
    assert lines == [1, 2]


def test_changed_result_does_not_affect_other_results(tmp_path: Path) -> None:
    path = write_model(tmp_path, '<link name="a"><visual name="v"/></link>')
    expansion = expand(path)
    before = str(expansion)
    link = expansion.document.root.first("link")
    link.attributes["name"] = "b"
    link.first("visual").attributes.clear()
    link.children.clear()
    assert str(expand(path)) == before


@pytest.mark.parametrize(
    ("limits", "code", "before"),
    [(Limits(elements=5), "XAC602", 4), (Limits(nesting=5), "XAC601", 5), (Limits(), "", 0)],
)
def test_copied_elements_count_toward_limits(tmp_path: Path, limits: Limits, code: str, before: int) -> None:
    path = write_model(tmp_path, "<a>" * 150 + "</a>" * 150)
    if not code:
        assert str(expand(path, limits=limits)).count("<a") == 150
        return
    with pytest.raises(LinkwrightError) as caught:
        expand(path, limits=limits)
    assert caught.value.diagnostics[0].code == code
    assert caught.value.diagnostics[0].span.column == len(HEAD) + 1 + before * len("<a>")


def test_eval_comments_enables_comments_after_it(tmp_path: Path) -> None:
    inside = (
        '<xacro:property name="p" value="1"/><a><!-- ${p} --><!-- xacro:eval-comments --><!-- ${p} --> '
        "<!-- ${p + 1} -->"
        "<b/><!-- ${p} --><!-- xacro:eval-comments -->text<!-- ${p} --></a>"
    )
    root = expand(write_model(tmp_path, inside)).document.root
    comments = [child.data for child in root.first("a").children if isinstance(child, Comment)]
    assert comments == [" ${p} ", " 1 ", " 2 ", " ${p} ", " ${p} "]


def test_modified_copy_is_written_with_changes(tmp_path: Path) -> None:
    path = write_model(tmp_path, '<link name="a"><visual name="v"> </visual></link>')
    expanded_text = str(expand(path))
    expansion = expand(path)
    visual = expansion.document.root.first("link").first("visual")
    visual.attributes["name"] = "w"
    assert str(expansion) == expanded_text.replace('"v"', '"w"')
    assert str(expand(path)) == expanded_text


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy])
def test_copy_of_copy_is_independent(tmp_path: Path, copied: Callable[[Element], Element]) -> None:
    expansion = expand(write_model(tmp_path, '<link name="a"><visual/></link>'))
    link = copied(expansion.document.root.first("link"))
    link.children.clear()
    assert write_element(link) == '<link name="a"/>\n'


def test_copy_may_be_nested_deeper_than_recursion_limit(tmp_path: Path) -> None:
    depth = 3 * sys.getrecursionlimit()
    path = write_model(tmp_path, "<a>" * depth + "</a>" * depth)
    root = expand(path, limits=Limits(nesting=depth + 10)).document.root
    assert sum(1 for _ in root.walk()) == depth + 1


def test_indentation_follows_depth_of_output(tmp_path: Path) -> None:
    macro = '<xacro:macro name="m"><a><b/></a></xacro:macro>'
    text = str(expand(write_model(tmp_path, f"{macro}<xacro:m/><c><xacro:m/></c><xacro:m/>")))
    assert [line for line in text.splitlines() if "<b/>" in line] == ["    <b/>", "      <b/>", "    <b/>"]


@pytest.mark.parametrize(
    ("inside", "expected"),
    [
        ("<a><b n='&#36;{p}'/></a>", '<b n="1"/>'),
        ("<a><b>&#36;{p}</b></a>", "<b>1</b>"),
        ('<a><b xmlns:xacro="x"/></a>', "<b/>"),
        ('<a><b xacro:n="x"/></a>', "<b/>"),
        ("<a><!-- xacro:eval-comments --><!-- ${p} --></a>", "<!-- 1 -->"),
        ("<a><b/><xacro:if value='${p}'><c/></xacro:if></a>", "<c/>"),
    ],
)
def test_elements_that_need_evaluation_are_not_copied(tmp_path: Path, inside: str, expected: str) -> None:
    assert expected in str(expand(write_model(tmp_path, f'<xacro:property name="p" value="1"/>{inside}')))


def test_long_values_count_toward_character_limit(tmp_path: Path) -> None:
    path = write_model(tmp_path, f'<a><b n="{"x" * 2000}"/></a>')
    with pytest.raises(LinkwrightError) as caught:
        expand(path, limits=Limits(characters=1500))
    assert caught.value.diagnostics[0].code == "XAC605"
