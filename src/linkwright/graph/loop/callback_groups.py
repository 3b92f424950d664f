"""Callback groups: which callbacks may run at the same time (rclpy ``callback_groups``)."""

from __future__ import annotations

import weakref
from typing import Any


class CallbackGroup:
    """Decides which of its entities may run; a base class for users' own groups.

    An executor asks `can_execute`, then calls `beginning_execution`, which may still refuse, and `ending_execution`. It
    asks again when a callback has ended.

    The class is not abstract: as in rclpy, programs may instantiate it, and a method without an override raises.
    """

    def __init__(self) -> None:
        super().__init__()
        self.entities: set[weakref.ref[Any]] = set()
        self._forget = self.entities.discard

    def add_entity(self, entity: Any) -> None:
        """Make an entity of a node a member; its callbacks then run as the group allows."""
        self.entities.add(weakref.ref(entity, self._forget))

    def has_entity(self, entity: Any) -> bool:
        """Whether an entity is a member."""
        return weakref.ref(entity) in self.entities

    def can_execute(self, entity: Any) -> bool:
        """Whether a member may run now."""
        raise NotImplementedError

    def beginning_execution(self, entity: Any) -> bool:
        """Note that a member is about to run; False when it may not."""
        raise NotImplementedError

    def ending_execution(self, entity: Any) -> None:
        """Note that a member has run."""
        raise NotImplementedError


class ReentrantCallbackGroup(CallbackGroup):
    """Everything may run at any time, also one callback several times at once."""

    def can_execute(self, entity: Any) -> bool:
        """Always."""
        return True

    def beginning_execution(self, entity: Any) -> bool:
        """Always."""
        return True

    def ending_execution(self, entity: Any) -> None:
        """Nothing to record."""


class MutuallyExclusiveCallbackGroup(CallbackGroup):
    """One member runs at a time. A coroutine counts as running until its end, also while it awaits."""

    def __init__(self) -> None:
        super().__init__()
        self._active: Any = None
        self._turn = [None]  # a token: the thread that pops it may run; faster than a lock

    def can_execute(self, entity: Any) -> bool:
        """Whether no member runs."""
        return self._active is None

    def beginning_execution(self, entity: Any) -> bool:
        """Let a member run if none does."""
        try:
            self._turn.pop()
        except IndexError:
            return False
        self._active = entity
        return True

    def ending_execution(self, entity: Any) -> None:
        """Let the next one run."""
        if self._active is entity:
            self._active = None
            self._turn.append(None)


class _FreeGroup(ReentrantCallbackGroup):
    """A group without rules that serves every node of the process, and so remembers none of its members."""

    def add_entity(self, entity: Any) -> None:
        """Nothing to record."""


FREE_GROUP: CallbackGroup = _FreeGroup()
"""For work that belongs to no group in rclpy: the execution of an action's goals."""
