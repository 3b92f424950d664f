"""The history of edits: undo, redo and merged edits."""

from __future__ import annotations

from linkwright.page.protocol.configuration import EditName
from linkwright.rviz.visualization.display_tree import MAX_EDITS, MERGE_INTERVAL_S, Edit, History


class EditedValue:
    """A number, and edits of it."""

    def __init__(self) -> None:
        self.now = 0.0
        self.told = 0
        self.number = 0
        self.history = History(self._on_change, lambda: self.now)

    def _on_change(self) -> None:
        self.told += 1

    def set(self, number: int, subject: str | None = "number") -> None:
        if subject is not None and self.history.would_merge(subject):
            self.history.merge_change()
        else:
            self.history.add(Edit(EditName("set", "number"), self.swap, self.number, subject))
        self.number = number

    def swap(self, number: int) -> int:
        before, self.number = self.number, number
        return before


def test_edits_are_undone_and_redone():
    value = EditedValue()
    for number in (1, 2, 3):
        value.set(number, None)
    value.history.undo()
    value.history.undo()
    assert (value.number, value.history.undo_name, value.history.redo_name) == (
        1,
        EditName("set", "number"),
        EditName("set", "number"),
    )
    value.history.redo()
    assert value.number == 2
    value.set(9, None)
    value.history.redo()
    assert (value.number, value.history.redo_name) == (9, None)
    for _ in range(5):
        value.history.undo()
    assert (value.number, value.history.undo_name) == (0, None)


def test_edits_of_one_drag_are_merged():
    value = EditedValue()
    for number in (1, 2, 3):
        value.now += MERGE_INTERVAL_S / 2
        value.set(number)
    value.now += MERGE_INTERVAL_S * 2
    value.set(4)
    value.history.undo()
    assert value.number == 3
    value.history.undo()
    assert value.number == 0
    value.history.redo()
    assert value.number == 3


def test_edits_of_different_values_are_not_merged():
    value = EditedValue()
    value.set(1, "a")
    value.set(2, "b")
    value.history.undo()
    assert value.number == 1


def test_saved_state_is_tracked_through_undo_and_redo():
    value = EditedValue()
    value.set(1)
    value.history.mark_saved()
    assert not value.history.has_unsaved_edits
    value.set(2)  # not merged with the previous edit, which is saved
    assert value.history.has_unsaved_edits
    value.history.undo()
    assert (value.number, value.history.has_unsaved_edits) == (1, False)
    value.history.undo()
    assert value.history.has_unsaved_edits
    value.set(7)
    value.history.undo()
    assert value.history.has_unsaved_edits  # the saved state cannot be restored
    value.history.mark_saved()
    assert not value.history.has_unsaved_edits


def test_permanent_edit_counts_as_unsaved():
    value = EditedValue()
    value.history.add_permanent_edit()
    assert value.history.has_unsaved_edits
    value.history.mark_saved()
    assert not value.history.has_unsaved_edits
    value.history.add_permanent_edit()
    value.history.clear()
    assert not value.history.has_unsaved_edits


def test_history_length_is_limited():
    value = EditedValue()
    for number in range(MAX_EDITS + 10):
        value.set(number, None)
    steps = 0
    while value.history.undo_name:
        value.history.undo()
        steps += 1
    assert steps == MAX_EDITS
    assert value.history.has_unsaved_edits
