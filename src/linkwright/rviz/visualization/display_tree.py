"""The displays of a configuration: adding, moving, grouping, enabling, undo and redo."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, Generic, TypeVar

from linkwright.page.protocol.configuration import EditKind, EditName
from linkwright.rviz.config.rviz_config import Arrangement, DisplayConfig, RvizConfig
from linkwright.rviz.config.yaml_tree import Memory
from linkwright.rviz.displays.base.display import DisplayHost, ViewerDisplay
from linkwright.rviz.displays.catalogue import make_display

PAUSE = 1.0
"""Seconds without an edit after which another edit of the same subject is a separate one: a drag is one edit."""

State = TypeVar("State")

LONGEST = 500
"""Most edits in the history."""


class Edit(Generic[State]):
    """An edit of a configuration that can be undone and redone.

    Args:
        name: the name of the edit, for menus.
        swap: restores a state, and returns the state that it replaced.
        before: the state before the edit.
        subject: identifies the edited value; quick successive edits of one subject are merged, see `History.is_at`.
            None for an edit that is never merged.
    """

    def __init__(
        self, name: EditName, swap: Callable[[State], State], before: State, subject: str | None = None
    ) -> None:
        self.name = name
        self.subject = subject
        self._swap = swap
        self._other = before

    def turn(self) -> None:
        """Undo the edit if it is in effect, or redo it if it was undone."""
        self._other = self._swap(self._other)


class History:
    """The edits that can be undone and redone, and how many of them are in the saved file.

    Args:
        changed: called whenever `undoable`, `redoable` or `unsaved` may have changed.
        clock: returns the time in seconds.
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
        """The name of the edit that `undo` would revert, or None."""
        return self._done[-1].name if self._done else None

    @property
    def redoable(self) -> EditName | None:
        """The name of the edit that `redo` would repeat, or None."""
        return self._undone[-1].name if self._undone else None

    @property
    def unsaved(self) -> bool:
        """Whether the current state differs from the saved file."""
        return self._touched or self._saved_at != len(self._done)

    def is_at(self, subject: str) -> bool:
        """Return whether an edit of a subject would be merged with the last edit.

        The steps of a drag are merged, for example.
        """
        follows = self._clock() - self._last < PAUSE and not self._undone and self._saved_at != len(self._done)
        return follows and bool(self._done) and self._done[-1].subject == subject

    def prolong(self) -> None:
        """Merge a change with the last edit, whose undo then reverts both."""
        self._last = self._clock()

    def add(self, edit: Edit[Any]) -> None:
        """Add an edit that has just been made, and discard the edits that could be redone."""
        self._last = self._clock()
        if self._saved_at is not None and self._saved_at > len(self._done):
            self._saved_at = None  # the saved state cannot be reached again by redo
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
        """Redo the most recently undone edit, if there is one."""
        if self._undone:
            edit = self._undone.pop()
            edit.turn()
            self._done.append(edit)
            self._end_drag()

    def saved(self) -> None:
        """Mark all edits as saved."""
        self._saved_at, self._touched = len(self._done), False
        self._changed()

    def clear(self) -> None:
        """Clear the history because another file was opened."""
        self._done.clear()
        self._undone.clear()
        self._end_drag()
        self.saved()

    def _end_drag(self) -> None:
        self._last = float("-inf")
        self._changed()


MAXIMUM_DISPLAYS = 1000
"""Most displays; pages may not add more."""

MAXIMUM_NESTING = 20
"""Most groups around a display; pages may not nest deeper, so that the file can be read again."""


class DisplayTree:
    """The displays, which correspond to the entries of the configuration.

    Changes made through this class can be undone. A removed display is stopped; undoing the removal creates another
    display with the same ID and section of the file.

    Args:
        config: the configuration with the entries.
        host: the visualization that the displays are part of.
        history: the history of edits.
        rearranged: called when displays were added, removed, moved or renamed, before new ones start.

    Attributes:
        displays: every display, each group before its contents.
    """

    def __init__(
        self,
        config: RvizConfig,
        host: DisplayHost,
        history: History,
        *,
        rearranged: Callable[[], None],
    ) -> None:
        self._host = host
        self._history = history
        self._rearranged = rearranged
        self._running = False
        self.displays: list[ViewerDisplay] = []
        self.fill(config)

    def fill(self, config: RvizConfig) -> None:
        """Create the displays of a configuration, without starting them."""
        self._config = config
        self.displays = [self._make(entry) for entry in config.walk()]
        self._notify_arrangement()

    def start(self) -> None:
        """Start all displays."""
        self._running = True
        for display in self.displays:
            display.start()

    def stop(self) -> None:
        """Stop all displays."""
        self._running = False
        for display in self.displays:
            display.stop()

    def find(self, identity: str) -> ViewerDisplay | None:
        """Return the display with an ID, or None if there is none."""
        return next((display for display in self.displays if display.id == identity), None)

    # --- edits -------------------------------------------------------------------------------------------------

    def check(self, display: ViewerDisplay, value: bool) -> None:
        """Set the check box of a display, which also enables or disables a group's contents."""
        if value == display.config.checked:
            return
        before, enabled = display.config.box, self._enabled()
        display.config.checked = value
        self._notify_check_box(display, enabled)
        name = EditName("enable" if value else "disable", display.config.name)
        self._history.add(Edit(name, partial(self._swap_box, display.id), before))

    def add(
        self,
        entry: DisplayConfig,
        group: DisplayConfig | None = None,
        prepare: Callable[[ViewerDisplay], None] | None = None,
    ) -> ViewerDisplay:
        """Add a display at the end of a group or of the top level, and return the display.

        Args:
            entry: the display's entry, which is not yet in the file.
            group: the group that will contain the display; None for the top level.
            prepare: called with the display before it starts, to set properties.

        Raises:
            ValueError: `group` is not a group, the display would be nested too deeply, or there are too many displays.
        """
        self._check_room([entry])
        _check_nesting(group, [entry])
        display = self._make(entry)
        if prepare is not None:
            prepare(display)
        self._rearrange(EditName("add", entry.name), lambda: self._config.insert(entry, group), [display])
        return display

    def duplicate(self, displays: Sequence[ViewerDisplay]) -> None:
        """Insert a copy after each of these displays.

        Raises:
            ValueError: there are too many displays.
        """
        entries = _outermost(displays)
        self._check_room(entries)

        def copy() -> None:
            for entry in entries:
                siblings = self._config.siblings(entry.group)
                self._config.insert(self._config.duplicate(entry), entry.group, siblings.index(entry) + 1)

        self._rearrange(_named("duplicate", displays), copy)

    def remove(self, displays: Sequence[ViewerDisplay]) -> None:
        """Remove displays; a group is removed with its contents."""

        def take_away() -> None:
            for entry in _outermost(displays):
                self._config.remove(entry)

        self._rearrange(_named("remove", displays), take_away)

    def move(
        self, displays: Sequence[ViewerDisplay], group: DisplayConfig | None, before: DisplayConfig | None
    ) -> None:
        """Move displays into a group, or to the top level.

        Args:
            displays: the displays to move.
            group: the group; None for the top level.
            before: the entry to insert before; None for the end.

        Raises:
            ValueError: the target is not a group, is inside one of the displays, or the displays would be nested too
                deeply.
        """
        moved = _outermost(displays)
        if group is not None and (not group.is_group or any(group in entry.walk() for entry in moved)):
            raise ValueError(f"displays cannot be put into '{group.name}'")
        _check_nesting(group, moved)

        def shift() -> None:
            siblings = self._config.siblings(group)
            after = siblings[siblings.index(before) :] if before in siblings else []
            target = next((entry for entry in after if entry not in moved), None)
            for entry in moved:
                self._config.remove(entry)
                self._config.insert(entry, group, siblings.index(target) if target else None)

        self._rearrange(_named("move", displays), shift)

    def gather(self, displays: Sequence[ViewerDisplay], name: str) -> None:
        """Move displays into a new group at the position of the first of them.

        Raises:
            ValueError: there are too many displays, or the group would be nested too deeply.
        """
        moved = _outermost(displays)
        around, at = moved[0].group, self._config.siblings(moved[0].group).index(moved[0])
        group = self._config.make_group(name)
        self._check_room([group])
        _check_nesting(around, moved, more=1)

        def put_together() -> None:
            self._config.insert(group, around, at)
            for entry in moved:
                self._config.remove(entry)
                self._config.insert(entry, group)

        self._rearrange(EditName("group", name), put_together)

    def rename(self, display: ViewerDisplay, name: str) -> None:
        """Rename a display."""
        if name == display.config.name:
            return
        section = display.config.section
        before = section.memory("Name")

        def swap(memory: Memory) -> Memory:
            now = section.memory("Name")
            section.recall(memory)
            self._notify_arrangement()
            self._rearranged()
            return now

        display.config.name = name
        self._notify_arrangement()
        self._rearranged()
        self._history.add(Edit(EditName("rename", name), swap, before))

    # --- applying and reverting edits --------------------------------------------------------------------------

    def _swap_box(self, identity: str, box: list[Memory]) -> list[Memory]:
        """Restore the file's entry of a display's check box, and return the replaced entry."""
        display = self.find(identity)
        if display is None:
            return box
        now, enabled = display.config.box, self._enabled()
        display.config.box = box
        self._notify_check_box(display, enabled)
        return now

    def _notify_check_box(self, display: ViewerDisplay, enabled: dict[DisplayConfig, bool]) -> None:
        """Send a display's check box to pages, and notify the displays that were enabled or disabled.

        `enabled` contains whether each display was enabled before the change.
        """
        display.set_checked(display.config.checked)
        for other in self.displays:
            if other.enabled != enabled[other.config]:
                other.enabled_changed()

    def arrange(self, arrangement: Arrangement) -> Arrangement:
        """Restore an arrangement, and return the replaced one."""
        before, enabled = self._config.arrangement(), self._enabled()
        self._config.arrange(arrangement)
        self._follow(enabled)
        return before

    def _rearrange(self, name: EditName, change: Callable[[], None], made: Sequence[ViewerDisplay] = ()) -> None:
        before, enabled = self._config.arrangement(), self._enabled()
        change()
        self._follow(enabled, made)
        self._history.add(Edit(name, self.arrange, before))

    def _enabled(self) -> dict[DisplayConfig, bool]:
        return {display.config: display.enabled for display in self.displays}

    def _follow(self, enabled: dict[DisplayConfig, bool], made: Sequence[ViewerDisplay] = ()) -> None:
        """Match the displays to the configuration's entries: start new displays and stop removed ones.

        Args:
            enabled: whether each display was enabled before the change.
            made: displays that were already created for new entries.
        """
        there = {display.config: display for display in self.displays}
        new = {display.config: display for display in made}
        entries = list(self._config.walk())
        for entry in there.keys() - set(entries):
            there[entry].stop()
        self.displays = [there.get(entry) or new.get(entry) or self._make(entry) for entry in entries]
        self._notify_arrangement()
        self._rearranged()
        for display in self.displays:
            if display.config not in there:
                self._begin(display)
            elif display.enabled != enabled[display.config]:
                display.enabled_changed()

    def _notify_arrangement(self) -> None:
        for display in self.displays:
            display.arranged(self.displays)

    def _begin(self, display: ViewerDisplay) -> None:
        if self._running:
            display.start()
            display.frames_changed()
        for message in display.messages():
            self._host.pages.publish(message)

    def _check_room(self, entries: Sequence[DisplayConfig]) -> None:
        if len(self.displays) + sum(1 for entry in entries for _ in entry.walk()) > MAXIMUM_DISPLAYS:
            raise ValueError(f"there can be no more than {MAXIMUM_DISPLAYS} displays")

    def _make(self, entry: DisplayConfig) -> ViewerDisplay:
        entry.identity = entry.identity or next(self._host.context.display_ids)
        return make_display(self._host, entry.identity, entry)


def _check_nesting(group: DisplayConfig | None, entries: Sequence[DisplayConfig], more: int = 0) -> None:
    """Raise ValueError if entries would be nested too deeply in a group.

    `more` is the number of further groups that will enclose the entries.
    """
    if _depth(group) + more + max(map(_height, entries)) > MAXIMUM_NESTING:
        raise ValueError(f"groups cannot be nested deeper than {MAXIMUM_NESTING}")


def _depth(group: DisplayConfig | None) -> int:
    """Return how many groups enclose the contents of a group; 0 for None, the top level."""
    return 0 if group is None else 1 + _depth(group.group)


def _height(entry: DisplayConfig) -> int:
    """Return the number of nested groups in an entry, including the entry itself if it is a group."""
    return 1 + max(map(_height, entry.displays), default=0) if entry.is_group else 0


def _outermost(displays: Sequence[ViewerDisplay]) -> list[DisplayConfig]:
    """Return the entries of those displays that are not inside another one of them."""
    entries = [display.config for display in displays]
    return [entry for entry in entries if not any(entry in other.walk() for other in entries if other is not entry)]


def _named(kind: EditKind, displays: Sequence[ViewerDisplay]) -> EditName:
    return EditName(kind, ", ".join(display.config.name for display in displays))
