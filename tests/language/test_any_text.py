"""Requests about texts that are being typed: any state of a text, and any place in it."""

from __future__ import annotations

from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from linkwright.language.colors import colors_in
from linkwright.language.completion import complete
from linkwright.language.definitions import definitions_in
from linkwright.language.extraction import selected_value
from linkwright.language.highlighting import highlights_in
from linkwright.language.hover import definitions_at, explain_at
from linkwright.language.links import file_references
from linkwright.language.macro_extraction import selected_elements
from linkwright.language.refactoring import offers_at
from linkwright.language.suppressing import code_at, suppression
from linkwright.lsp.positions import TextPositions
from linkwright.lsp.requests.navigation import uses_in_file
from linkwright.lsp.requests.texts import folds, format_edits, linked_tags, selections, symbols
from linkwright.packages import PackageFinder

ROBOT = (Path(__file__).parents[2] / "robots/my_robot_description/urdf/mbot_gazebo.xacro").read_text(encoding="utf-8")
FINDER = PackageFinder(start=[Path(__file__).parents[2] / "robots"])
CUT = st.tuples(st.integers(0, len(ROBOT)), st.integers(0, 40), st.text("<>/=\"' ${}()\n机a", max_size=8))


@given(CUT, st.sampled_from(["robot.xacro", "robot.urdf", "robot.world", "robot.srdf"]))
def test_no_state_of_a_text_is_too_much(cut, name):
    start, length, typed = cut
    text = ROBOT[:start] + typed + ROBOT[start + length :]
    offset = start + len(typed)
    file = Path(name)
    names = [*definitions_in(text, file)]
    for item in complete(text, offset, file, names, lambda: FINDER):
        assert 0 <= item.start <= offset
    explained = explain_at(text, offset, file, names)
    assert explained is None or explained.start <= explained.end <= len(text)
    assert set(definitions_at(text, offset, names)) <= set(names)
    positions = TextPositions(text)
    place = positions.position(offset)
    assert positions.offset(place) == offset
    assert all(fold.start_line < fold.end_line for fold in folds(positions))
    (selection,) = selections(positions, [place])
    while selection.parent is not None:
        inner, outer = selection.range, selection.parent.range
        assert outer.start <= inner.start
        assert inner.end <= outer.end
        selection = selection.parent
    ends = [0, *(highlight.end for highlight in highlights_in(text, file))]
    assert ends == sorted(set(ends))
    assert all(0 <= color.start < color.end <= len(text) for color in colors_in(text))
    assert all(text[link.start : link.end] for link in file_references(text, file, FINDER))
    assert all(use.start <= use.end <= len(text) for use in uses_in_file(text, file, offset))
    other = min(offset + 30, len(text))
    for start, end in ((offset, offset), (offset, other)):
        value = selected_value(text, start, end)
        assert value is None or start <= value.start < value.end <= end or start == end
        assert all(one.end <= end for one in selected_elements(text, start, end))
        assert all(offer.title for offer in offers_at(text, file, start, end, names))
    comment = suppression(text, file, "LW104", offset)
    assert comment is None or 0 <= comment.start <= len(text)
    code_at(text, offset)
    symbols(positions)
    linked_tags(positions, place)
    format_edits(positions, file)


LINES = st.lists(st.sampled_from(["a", "机", "🤖", "<", "\n", "\r\n"]), max_size=30).map("".join)


@given(LINES, st.sampled_from(["utf-8", "utf-16", "utf-32"]), st.data())
def test_positions_and_offsets_agree_in_each_encoding(text, encoding, data):
    offset = data.draw(st.integers(0, len(text)).filter(lambda at: text[at - 1 : at + 1] != "\r\n"))
    positions = TextPositions(text, encoding)
    assert positions.offset(positions.position(offset)) == offset
