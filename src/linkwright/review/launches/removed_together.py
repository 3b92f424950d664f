"""Tell in one line which arguments a launch file lost together with the action that got them."""

from __future__ import annotations

from collections.abc import Sequence

from linkwright.diagnostics import Phrase, joined_first, phrase
from linkwright.review.changes import MAX_NAMES
from linkwright.review.file_pair import FilePair
from linkwright.review.launches.argument_uses import is_used
from linkwright.review.launches.effects import explain_argument_removal
from linkwright.review.launches.outlines import Entry, LaunchOutline
from linkwright.review.launches.titles import format_title

_MIN_ARGUMENTS = 3
"""The minimum number of arguments of one action that are one line."""


class RemovedArguments:
    """The removed arguments of a launch file that only a removed action used.

    Args:
        removed: the removed actions and arguments.
        old: the outline of the old file.
    """

    def __init__(self, removed: Sequence[Entry], old: LaunchOutline) -> None:
        self._old = old
        self._users: dict[int, tuple[Entry, list[Entry]]] = {}
        actions = [entry for entry in removed if not entry.has_value]
        for argument in (entry for entry in removed if entry.kind == "argument"):
            users = [entry for entry in old.entries if entry.kind != "argument" and is_used(argument.name, [entry])]
            if len(users) == 1 and any(users[0] is action for action in actions):
                self._users.setdefault(id(users[0]), (users[0], []))[1].append(argument)
        self._users = {key: group for key, group in self._users.items() if len(group[1]) >= _MIN_ARGUMENTS}
        self._lost: dict[int, list[Entry]] = {}

    def add(self, entry: Entry, reason: Phrase | None) -> bool:
        """Collect a removed argument if others left with the same action and nothing else is to be said about it."""
        if entry.kind != "argument" or reason != explain_argument_removal(entry.name, is_ros1=self._old.is_ros1):
            return False
        for key, (_, arguments) in self._users.items():
            if any(entry is argument for argument in arguments):
                self._lost.setdefault(key, []).append(entry)
                return True
        return False

    def report(self, pair: FilePair) -> None:
        """Report the collected arguments, with the action that used them."""
        for key, arguments in self._lost.items():
            names = joined_first([f"'{argument.name}'" for argument in arguments], MAX_NAMES)
            text = phrase(
                "arguments removed with {entry}: {names}", entry=format_title(self._users[key][0]), names=names
            )
            reason = phrase("values that callers pass for these arguments have no effect")
            if self._old.is_ros1:
                reason = phrase("launch files that pass these arguments to the file fail")
            pair.add(text, pair.location(arguments[0].span, is_old=True), reason)
