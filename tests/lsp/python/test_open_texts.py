"""The Python files of an editor: texts after changes, and findings that move with the text."""

from __future__ import annotations

from typing import Any

from hypothesis import given
from hypothesis import strategies as st

from linkwright.lsp.positions import TextPositions
from linkwright.lsp.python.open_texts import OpenText, to_range

TEXTS = st.text(alphabet="ab 中😀\n", max_size=30)
WORD = "x = 中😀\nvalue = 1\n"


def make_finding(text: str, start: int, end: int) -> dict[str, Any]:
    return {"range": to_range(TextPositions(text), start, end), "message": "m"}


def make_range(line: int, start: int, end: int) -> dict[str, Any]:
    return {"start": {"line": line, "character": start}, "end": {"line": line, "character": end}}


@given(before=TEXTS, inserted=TEXTS, bounds=st.tuples(st.integers(0, 30), st.integers(0, 30)))
def test_ranged_and_full_changes_give_editor_text(before: str, inserted: str, bounds: tuple[int, int]) -> None:
    start, end = sorted(min(bound, len(before)) for bound in bounds)
    after = before[:start] + inserted + before[end:]
    ranges = OpenText("file:///a.py", before, 1, "utf-16")
    ranges.change(2, [{"range": to_range(TextPositions(before), start, end), "text": inserted}])
    full_text = OpenText("file:///a.py", before, 1, "utf-16")
    full_text.change(2, [{"text": after}])
    assert (ranges.text, ranges.version) == (full_text.text, full_text.version) == (after, 2)


def test_several_changes_apply_in_sequence() -> None:
    text = OpenText("file:///a.py", WORD, 1, "utf-16")
    text.change(2, [{"range": make_range(1, 0, 5), "text": "名"}, {"range": make_range(0, 4, 7), "text": "😀"}])
    assert text.text == "x = 😀\n名 = 1\n"


def test_findings_move_with_text_until_next_check() -> None:
    text = OpenText("file:///a.py", WORD, 1, "utf-16")
    text.set_findings("ty", [make_finding(WORD, 7, 12)])
    text.set_findings("ruff", [make_finding(WORD, 0, 1)])
    text.change(2, [{"text": "# 😀\n" + WORD}])
    assert [finding["range"] for finding in text.findings()] == [make_range(2, 0, 5), make_range(1, 0, 1)]
    text.change(3, [{"range": make_range(2, 0, 0), "text": "the_"}, {"range": make_range(1, 0, 0), "text": "😀\n"}])
    assert [finding["range"] for finding in text.findings()] == [make_range(3, 4, 9), make_range(2, 0, 1)]
    text.set_findings("ty", [])
    assert text.findings() == text.findings_of("ruff")


@given(before=TEXTS, after=TEXTS, bounds=st.tuples(st.integers(0, 30), st.integers(0, 30)))
def test_moved_findings_stay_inside_text(before: str, after: str, bounds: tuple[int, int]) -> None:
    start, end = sorted(min(bound, len(before)) for bound in bounds)
    text = OpenText("file:///a.py", before, 1, "utf-16")
    text.set_findings("ty", [make_finding(before, start, end)])
    text.change(2, [{"text": after}])
    [moved] = text.findings()
    assert text.text_in(moved["range"]) in after
    if before[start:end] and before == after:
        assert text.text_in(moved["range"]) == before[start:end]


def test_word_before_position_is_part_of_name() -> None:
    text = OpenText("file:///a.py", "😀 node.create_pub\n", 1, "utf-16")
    assert text.word_before({"line": 0, "character": 11}) == "cre"
    assert text.word_before({"line": 0, "character": 8}) == ""
