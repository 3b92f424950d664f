"""What runs the callbacks of nodes: the contract between the things that call back and the executors.

An entity (a subscription, a timer, a service, ...) tells the dispatcher of its node that it has something to do; the
dispatcher decides when, and in which thread, it takes that from the entity and does it. The event loop of the launcher
is one dispatcher (`linkwright.graph.executor`), the executors of rclpy are others (`linkwright.graph.executors`).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from linkwright.graph.entity import Entity


class CallbackGroup(Protocol):
    """Says which entities may run at the same time (rclpy ``CallbackGroup``)."""

    def can_execute(self, entity: Entity) -> bool:
        """Whether the entity may run now."""

    def beginning_execution(self, entity: Entity) -> bool:
        """Take note that the entity runs now; False when it may not."""

    def ending_execution(self, entity: Entity) -> None:
        """Take note that the entity has run."""


class Alarm(Protocol):
    """A callback that will be called at a time."""

    def cancel(self) -> None:
        """Do not call it."""


class Dispatcher(Protocol):
    """Runs what entities have to do. All methods may be called from any thread."""

    def ready(self, entity: Entity) -> None:
        """Take note that the entity has at least one call to be taken.

        An entity says so when its queue was empty before, and again from within `Entity.take` while more remain; so
        nothing piles up here when messages flood in. An entity whose ``dispatcher`` is another one by then is skipped.
        """

    def call_at(self, steady_ns: int, callback: Callable[[], None]) -> Alarm:
        """Call something once at a count of the graph's timebase; never in the caller's frame.

        What is called only makes entities ready: it is quick, and none of the user's code.
        """


class ExclusiveGroup:
    """The default group of a node: one entity at a time."""

    __slots__ = ("__weakref__", "_running")

    def __init__(self) -> None:
        self._running: Entity | None = None

    def can_execute(self, entity: Entity) -> bool:  # noqa: ARG002
        """Whether none runs."""
        return self._running is None

    def beginning_execution(self, entity: Entity) -> bool:
        """Take note that the entity runs now; False when another one does."""
        if self._running is not None:
            return False
        self._running = entity
        return True

    def ending_execution(self, entity: Entity) -> None:
        """Take note that the entity has run."""
        if self._running is entity:
            self._running = None


class FreeGroup:
    """A group without rules: all its entities may run at the same time."""

    __slots__ = ("__weakref__",)

    def can_execute(self, entity: Entity) -> bool:  # noqa: ARG002
        """Always."""
        return True

    def beginning_execution(self, entity: Entity) -> bool:  # noqa: ARG002
        """Always."""
        return True

    def ending_execution(self, entity: Entity) -> None:
        """Nothing to note."""


FREE_GROUP = FreeGroup()
"""For what belongs to no group in rclpy: the execution of an action's goals."""
