"""The displays of a configuration: adding, moving, grouping, enabling, undo and redo."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, Generic, TypeVar

from linkwright.page.protocol.configuration import EditKind, EditName
from linkwright.rviz.config.rviz_config import Arrangement, DisplayConfig, RvizConfig
from linkwright.rviz.config.yaml_tree import SavedEntry
from linkwright.rviz.displays.base.display import DisplayHost, ViewerDisplay
from linkwright.rviz.displays.catalog import make_display

MERGE_INTERVAL_S = 1.0
"""Edits of the same subject are merged if they follow within this time, in s, so that a drag is one edit."""

State = TypeVar("State")

MAX_EDITS = 500
"""The largest number of edits in the history."""


class Edit(Generic[State]):
    """An edit of a configuration that can be undone and redone.

    Args:
        name: the name of the edit, for menus.
        swap: restores a state, and returns the state that it replaced.
        before: the state before the edit.
        subject: identifies the edited value, or None. Quick successive edits of the same value are merged, see
            `History.would_merge`.
    """

    def __init__(
        self, name: EditName, swap: Callable[[State], State], before: State, subject: str | None = None
    ) -> None:
        self.name = name
        self.subject = subject
        self._swap = swap
        self._other_state = before

    def undo_or_redo(self) -> None:
        """Undo the edit, or redo it if it was undone."""
        self._other_state = self._swap(self._other_state)


class History:
    """The undo history: the edits to undo and redo, and the state that was last saved.

    Args:
        changed: called whenever `undo_name`, `redo_name` or `has_unsaved_edits` may have changed.
        clock: returns the time in seconds.
    """

    def __init__(self, changed: Callable[[], None], clock: Callable[[], float] = time.monotonic) -> None:
        self._changed = changed
        self._clock = clock
        self._done_edits: list[Edit[Any]] = []
        self._undone_edits: list[Edit[Any]] = []
        self._saved_count: int | None = 0
        self._has_permanent_edit = False
        self._last_edit_time = float("-inf")

    @property
    def undo_name(self) -> EditName | None:
        """The name of the edit that `undo` would revert, or None."""
        return self._done_edits[-1].name if self._done_edits else None

    @property
    def redo_name(self) -> EditName | None:
        """The name of the edit that `redo` would repeat, or None."""
        return self._undone_edits[-1].name if self._undone_edits else None

    @property
    def has_unsaved_edits(self) -> bool:
        """Whether the current state differs from the saved file."""
        return self._has_permanent_edit or self._saved_count != len(self._done_edits)

    def would_merge(self, subject: str) -> bool:
        """Return whether an edit of a subject would be merged with the last edit.

        The steps of a drag are merged, for example.
        """
        is_recent = (
            self._clock() - self._last_edit_time < MERGE_INTERVAL_S
            and not self._undone_edits
            and self._saved_count != len(self._done_edits)
        )
        return is_recent and bool(self._done_edits) and self._done_edits[-1].subject == subject

    def merge_change(self) -> None:
        """Merge a change with the last edit, so that both are undone together."""
        self._last_edit_time = self._clock()

    def add(self, edit: Edit[Any]) -> None:
        """Add an edit that was just made, and discard the undone edits."""
        self._last_edit_time = self._clock()
        if self._saved_count is not None and self._saved_count > len(self._done_edits):
            self._saved_count = None  # the saved state can no longer be reached with redo
        self._undone_edits.clear()
        self._done_edits.append(edit)
        if len(self._done_edits) > MAX_EDITS:
            del self._done_edits[0]
            self._saved_count = self._saved_count - 1 if self._saved_count else None
        self._changed()

    def add_permanent_edit(self) -> None:
        """Record an edit that cannot be undone."""
        if not self._has_permanent_edit:
            self._has_permanent_edit = True
            self._changed()

    def undo(self) -> None:
        """Undo the last edit, if there is one."""
        if self._done_edits:
            edit = self._done_edits.pop()
            edit.undo_or_redo()
            self._undone_edits.append(edit)
            self._end_drag()

    def redo(self) -> None:
        """Redo the most recently undone edit, if there is one."""
        if self._undone_edits:
            edit = self._undone_edits.pop()
            edit.undo_or_redo()
            self._done_edits.append(edit)
            self._end_drag()

    def mark_saved(self) -> None:
        """Mark all edits as saved."""
        self._saved_count, self._has_permanent_edit = len(self._done_edits), False
        self._changed()

    def clear(self) -> None:
        """Clear the history because another file was opened."""
        self._done_edits.clear()
        self._undone_edits.clear()
        self._end_drag()
        self.mark_saved()

    def _end_drag(self) -> None:
        self._last_edit_time = float("-inf")
        self._changed()


MAX_DISPLAYS = 1000
"""The largest number of displays that pages may add."""

MAX_NESTING = 20
"""The largest number of groups around a display, so that the file can be read again."""


class DisplayTree:
    """The displays for the entries of a configuration.

    Changes made through this class can be undone. A removed display is stopped. Undoing the removal creates another
    display with the same ID and section of the file.

    Args:
        config: the configuration with the entries.
        host: the visualization that the displays are part of.
        history: the history of edits.
        rearranged: called when displays were added, removed, moved or renamed, before new displays start.

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
        self.displays = [self._create_display(entry) for entry in config.walk()]
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
        """Set the check box of a display.

        The check box of a group also enables or disables its contents.
        """
        if value == display.config.checked:
            return
        old_state, enabled = display.config.check_box_entries, self._get_enabled_states()
        display.config.checked = value
        self._notify_check_box(display, enabled)
        name = EditName("enable" if value else "disable", display.config.name)
        self._history.add(Edit(name, partial(self._swap_check_box, display.id), old_state))

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
        self._check_count([entry])
        _check_nesting(group, [entry])
        display = self._create_display(entry)
        if prepare is not None:
            prepare(display)
        self._rearrange(EditName("add", entry.name), lambda: self._config.insert(entry, group), [display])
        return display

    def duplicate(self, displays: Sequence[ViewerDisplay]) -> None:
        """Insert a copy after each of these displays.

        Raises:
            ValueError: there are too many displays.
        """
        entries = _find_outermost(displays)
        self._check_count(entries)

        def copy() -> None:
            for entry in entries:
                siblings = self._config.siblings(entry.group)
                self._config.insert(self._config.duplicate(entry), entry.group, siblings.index(entry) + 1)

        self._rearrange(_make_edit_name("duplicate", displays), copy)

    def remove(self, displays: Sequence[ViewerDisplay]) -> None:
        """Remove displays, including the contents of groups."""

        def remove_all() -> None:
            for entry in _find_outermost(displays):
                self._config.remove(entry)

        self._rearrange(_make_edit_name("remove", displays), remove_all)

    def move(
        self, displays: Sequence[ViewerDisplay], group: DisplayConfig | None, before: DisplayConfig | None
    ) -> None:
        """Move displays into a group, or to the top level.

        Args:
            displays: the displays to move.
            group: the group; None for the top level.
            before: the entry before which the displays are inserted; None for the end.

        Raises:
            ValueError: the target is not a group, is inside one of the displays, or the displays would be nested too
                deeply.
        """
        entries = _find_outermost(displays)
        if group is not None and (not group.is_group or any(group in entry.walk() for entry in entries)):
            raise ValueError(f"displays cannot be put into '{group.name}'")
        _check_nesting(group, entries)

        def move_all() -> None:
            siblings = self._config.siblings(group)
            later_siblings = siblings[siblings.index(before) :] if before in siblings else []
            target = next((entry for entry in later_siblings if entry not in entries), None)
            for entry in entries:
                self._config.remove(entry)
                self._config.insert(entry, group, siblings.index(target) if target else None)

        self._rearrange(_make_edit_name("move", displays), move_all)

    def group(self, displays: Sequence[ViewerDisplay], name: str) -> None:
        """Move displays into a new group at the position of the first of them.

        Raises:
            ValueError: there are too many displays, or the group would be nested too deeply.
        """
        entries = _find_outermost(displays)
        enclosing_group, index = entries[0].group, self._config.siblings(entries[0].group).index(entries[0])
        group = self._config.make_group(name)
        self._check_count([group])
        _check_nesting(enclosing_group, entries, extra_groups=1)

        def insert_group() -> None:
            self._config.insert(group, enclosing_group, index)
            for entry in entries:
                self._config.remove(entry)
                self._config.insert(entry, group)

        self._rearrange(EditName("group", name), insert_group)

    def rename(self, display: ViewerDisplay, name: str) -> None:
        """Rename a display."""
        if name == display.config.name:
            return
        section = display.config.section
        old_entry = section.copy_entry("Name")

        def swap(saved_entry: SavedEntry) -> SavedEntry:
            replaced = section.copy_entry("Name")
            section.restore(saved_entry)
            self._notify_arrangement()
            self._rearranged()
            return replaced

        display.config.name = name
        self._notify_arrangement()
        self._rearranged()
        self._history.add(Edit(EditName("rename", name), swap, old_entry))

    # --- applying and reverting edits --------------------------------------------------------------------------

    def _swap_check_box(self, identity: str, saved_entries: list[SavedEntry]) -> list[SavedEntry]:
        """Restore the entries of a check box in the file, and return the replaced entries."""
        display = self.find(identity)
        if display is None:
            return saved_entries
        replaced, enabled = display.config.check_box_entries, self._get_enabled_states()
        display.config.check_box_entries = saved_entries
        self._notify_check_box(display, enabled)
        return replaced

    def _notify_check_box(self, display: ViewerDisplay, enabled: dict[DisplayConfig, bool]) -> None:
        """Send a display's check box to pages, and notify the displays that it affects.

        `enabled` contains whether each display was enabled before the change.
        """
        display.set_checked(display.config.checked)
        for other in self.displays:
            if other.enabled != enabled[other.config]:
                other.on_enabled_changed()

    def arrange(self, arrangement: Arrangement) -> Arrangement:
        """Restore an arrangement, and return the arrangement that it replaced."""
        old_arrangement, enabled = self._config.arrangement(), self._get_enabled_states()
        self._config.arrange(arrangement)
        self._apply_config(enabled)
        return old_arrangement

    def _rearrange(
        self, name: EditName, change: Callable[[], None], new_displays: Sequence[ViewerDisplay] = ()
    ) -> None:
        old_arrangement, enabled = self._config.arrangement(), self._get_enabled_states()
        change()
        self._apply_config(enabled, new_displays)
        self._history.add(Edit(name, self.arrange, old_arrangement))

    def _get_enabled_states(self) -> dict[DisplayConfig, bool]:
        return {display.config: display.enabled for display in self.displays}

    def _apply_config(self, enabled: dict[DisplayConfig, bool], new_displays: Sequence[ViewerDisplay] = ()) -> None:
        """Create, start and stop displays to match the configuration.

        Args:
            enabled: whether each display was enabled before the change.
            new_displays: displays that were already created for new entries.
        """
        displays_by_entry = {display.config: display for display in self.displays}
        new_by_entry = {display.config: display for display in new_displays}
        entries = list(self._config.walk())
        for entry in displays_by_entry.keys() - set(entries):
            displays_by_entry[entry].stop()
        self.displays = [
            displays_by_entry.get(entry) or new_by_entry.get(entry) or self._create_display(entry) for entry in entries
        ]
        self._notify_arrangement()
        self._rearranged()
        for display in self.displays:
            if display.config not in displays_by_entry:
                self._start_display(display)
            elif display.enabled != enabled[display.config]:
                display.on_enabled_changed()

    def _notify_arrangement(self) -> None:
        for display in self.displays:
            display.on_displays_rearranged(self.displays)

    def _start_display(self, display: ViewerDisplay) -> None:
        if self._running:
            display.start()
            display.on_frames_changed()
        for message in display.messages():
            self._host.pages.publish(message)

    def _check_count(self, entries: Sequence[DisplayConfig]) -> None:
        if len(self.displays) + sum(1 for entry in entries for _ in entry.walk()) > MAX_DISPLAYS:
            raise ValueError(f"there can be no more than {MAX_DISPLAYS} displays")

    def _create_display(self, entry: DisplayConfig) -> ViewerDisplay:
        entry.identity = entry.identity or next(self._host.context.display_ids)
        return make_display(self._host, entry.identity, entry)


def _check_nesting(group: DisplayConfig | None, entries: Sequence[DisplayConfig], extra_groups: int = 0) -> None:
    """Raise ValueError if entries would be nested too deeply in a group.

    `extra_groups` is the number of further groups that will enclose the entries.
    """
    if _compute_depth(group) + extra_groups + max(map(_compute_height, entries)) > MAX_NESTING:
        raise ValueError(f"groups cannot be nested deeper than {MAX_NESTING}")


def _compute_depth(group: DisplayConfig | None) -> int:
    """Return the number of groups that enclose the contents of a group.

    The top level, None, has depth 0.
    """
    return 0 if group is None else 1 + _compute_depth(group.group)


def _compute_height(entry: DisplayConfig) -> int:
    """Return the nesting depth of the groups in an entry, including the entry itself."""
    return 1 + max(map(_compute_height, entry.displays), default=0) if entry.is_group else 0


def _find_outermost(displays: Sequence[ViewerDisplay]) -> list[DisplayConfig]:
    """Return the entries of the displays that are not inside another of these displays."""
    entries = [display.config for display in displays]
    return [entry for entry in entries if not any(entry in other.walk() for other in entries if other is not entry)]


def _make_edit_name(kind: EditKind, displays: Sequence[ViewerDisplay]) -> EditName:
    return EditName(kind, ", ".join(display.config.name for display in displays))
