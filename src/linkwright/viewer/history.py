"""What was edited, to take it back and do it again."""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from collections.abc import Callable

from linkwright.viewer.protocol import EditName

PAUSE = 1.0
"""Seconds without an edit after which another edit of the same thing is one of its own: a drag is one edit."""

LONGEST = 500
"""Most edits remembered."""


class Edit(ABC):
    """Something that was done.

    Args:
        name: what it was, for menus.
        subject: edits of one subject that follow each other quickly are one, see `is_at`; None for none such.
    """

    def __init__(self, name: EditName, subject: str | None = None) -> None:
        self.name = name
        self.subject = subject

    @abstractmethod
    def undo(self) -> None:
        """Take it back."""

    @abstractmethod
    def redo(self) -> None:
        """Do it again."""


class History:
    """Edits that were done, those that were taken back, and where among them the file was saved.

    Args:
        changed: called whenever `undoable`, `redoable` or `unsaved` may be another.
        clock: seconds.
    """

    def __init__(self, changed: Callable[[], None], clock: Callable[[], float] = time.monotonic) -> None:
        self._changed = changed
        self._clock = clock
        self._done: list[Edit] = []
        self._undone: list[Edit] = []
        self._saved_at: int | None = 0
        self._touched = False
        self._last = float("-inf")

    @property
    def undoable(self) -> EditName | None:
        """What `undo` would take back."""
        return self._done[-1].name if self._done else None

    @property
    def redoable(self) -> EditName | None:
        """What `redo` would do again."""
        return self._undone[-1].name if self._undone else None

    @property
    def unsaved(self) -> bool:
        """Whether the file lacks something."""
        return self._touched or self._saved_at != len(self._done)

    def is_at(self, subject: str) -> bool:
        """Whether an edit of a subject would be one with the last: a drag goes on."""
        follows = self._clock() - self._last < PAUSE and not self._undone and self._saved_at != len(self._done)
        return follows and bool(self._done) and self._done[-1].subject == subject

    def prolong(self) -> None:
        """The last edit went on. It knows what was there at first; what there is at last is seen when it is undone."""
        self._last = self._clock()

    def add(self, edit: Edit) -> None:
        """Remember an edit that was done."""
        self._last = self._clock()
        if self._saved_at is not None and self._saved_at > len(self._done):
            self._saved_at = None  # what was saved lies on a way that is left now
        self._undone.clear()
        self._done.append(edit)
        if len(self._done) > LONGEST:
            del self._done[0]
            self._saved_at = self._saved_at - 1 if self._saved_at else None
        self._changed()

    def touch(self) -> None:
        """Something was edited that cannot be taken back."""
        if not self._touched:
            self._touched = True
            self._changed()

    def undo(self) -> None:
        """Take back the last edit, if there is one."""
        if self._done:
            edit = self._done.pop()
            edit.undo()
            self._undone.append(edit)
            self._end_drag()

    def redo(self) -> None:
        """Do again what was taken back last, if there is anything."""
        if self._undone:
            edit = self._undone.pop()
            edit.redo()
            self._done.append(edit)
            self._end_drag()

    def saved(self) -> None:
        """The file has everything now."""
        self._saved_at, self._touched = len(self._done), False
        self._changed()

    def clear(self) -> None:
        """Forget everything: the file is another."""
        self._done.clear()
        self._undone.clear()
        self._end_drag()
        self.saved()

    def _end_drag(self) -> None:
        self._last = float("-inf")
        self._changed()
