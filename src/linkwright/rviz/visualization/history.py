"""Undo and redo."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any, Generic, TypeVar

from linkwright.page.protocol.configuration import EditName

PAUSE = 1.0
"""Seconds without an edit after which another edit of the same subject is a separate one: a drag is one edit."""

State = TypeVar("State")

LONGEST = 500
"""Most edits in the history."""


class Edit(Generic[State]):
    """An edit of a configuration that can be undone and redone.

    Args:
        name: the name of the edit, for menus.
        swap: restores a state, and returns the present one.
        before: the state before.
        subject: quick successive edits of one subject are merged, see `History.is_at`; None for no merging.
    """

    def __init__(
        self, name: EditName, swap: Callable[[State], State], before: State, subject: str | None = None
    ) -> None:
        self.name = name
        self.subject = subject
        self._swap = swap
        self._other = before

    def turn(self) -> None:
        """Undo the edit, or redo it after that."""
        self._other = self._swap(self._other)


class History:
    """The edits that can be undone and redone, and how many of them the saved file has.

    Args:
        changed: called whenever `undoable`, `redoable` or `unsaved` may have changed.
        clock: seconds.
    """

    def __init__(self, changed: Callable[[], None], clock: Callable[[], float] = time.monotonic) -> None:
        self._changed = changed
        self._clock = clock
        self._done: list[Edit[Any]] = []
        self._undone: list[Edit[Any]] = []
        self._saved_at: int | None = 0
        self._touched = False
        self._last = float("-inf")

    @property
    def undoable(self) -> EditName | None:
        """The edit that `undo` would revert."""
        return self._done[-1].name if self._done else None

    @property
    def redoable(self) -> EditName | None:
        """The edit that `redo` would repeat."""
        return self._undone[-1].name if self._undone else None

    @property
    def unsaved(self) -> bool:
        """Whether the file lacks an edit."""
        return self._touched or self._saved_at != len(self._done)

    def is_at(self, subject: str) -> bool:
        """Return whether an edit of a subject would be merged with the last one, as the steps of a drag are."""
        follows = self._clock() - self._last < PAUSE and not self._undone and self._saved_at != len(self._done)
        return follows and bool(self._done) and self._done[-1].subject == subject

    def prolong(self) -> None:
        """Merge a change with the last edit, which has the state before."""
        self._last = self._clock()

    def add(self, edit: Edit[Any]) -> None:
        """Add an edit that was done."""
        self._last = self._clock()
        if self._saved_at is not None and self._saved_at > len(self._done):
            self._saved_at = None  # the saved state is on the branch that is dropped here
        self._undone.clear()
        self._done.append(edit)
        if len(self._done) > LONGEST:
            del self._done[0]
            self._saved_at = self._saved_at - 1 if self._saved_at else None
        self._changed()

    def touch(self) -> None:
        """Record an edit that cannot be undone."""
        if not self._touched:
            self._touched = True
            self._changed()

    def undo(self) -> None:
        """Undo the last edit, if there is one."""
        if self._done:
            edit = self._done.pop()
            edit.turn()
            self._undone.append(edit)
            self._end_drag()

    def redo(self) -> None:
        """Redo the edit that was undone last, if there is one."""
        if self._undone:
            edit = self._undone.pop()
            edit.turn()
            self._done.append(edit)
            self._end_drag()

    def saved(self) -> None:
        """Note that the file has all edits."""
        self._saved_at, self._touched = len(self._done), False
        self._changed()

    def clear(self) -> None:
        """Clear the history: another file was opened."""
        self._done.clear()
        self._undone.clear()
        self._end_drag()
        self.saved()

    def _end_drag(self) -> None:
        self._last = float("-inf")
        self._changed()
