"""Entities: the parts of a node that call back; guard conditions, the simplest of them.

An entity (a subscription, a timer, a service, ...) notifies the dispatcher of its node that it has a call to run; the
dispatcher decides when, and in which thread, it takes the call and runs it. The event loop of the launcher
is one dispatcher (`linkwright.graph.loop.dispatcher`), the executors of rclpy are others
(`linkwright.graph.executors`).
"""

from __future__ import annotations

import inspect
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable
from typing import TypeVar

from linkwright.graph.log.logger import log_failure
from linkwright.graph.loop.node_handle import CallbackGroup, Dispatcher, NodeHandle, Part

T = TypeVar("T")


class Entity(Part, ABC):
    """A source of callbacks, from which a dispatcher takes calls.

    Attributes:
        callback_group: which entities may run beside it; the node's default group unless another one is given.
        dispatcher: runs its calls; None while the node has none, and after it was destroyed.
    """

    unblockable = False
    """Whether its calls run none of the user's callbacks, so that no group needs to hold them back."""

    postponed = 0
    """How often an executor has let others run first; see ``Executor._postpone``."""

    def __init__(self, node: NodeHandle, callback_group: CallbackGroup | None = None) -> None:
        self.node = node
        self.callback_group = node.default_callback_group if callback_group is None else callback_group
        self.dispatcher: Dispatcher | None = None
        self._announced = False
        # A user's own group need not derive from rclpy's.
        add_entity = getattr(self.callback_group, "add_entity", None)
        if add_entity is not None:
            add_entity(self)

    @abstractmethod
    def take(self) -> Callable[[], object] | None:
        """The next call that is due, taken out of the entity's queue; None when there is no more.

        The call may raise any exception of the user's; it may give a coroutine, which the dispatcher runs to its end.
        """

    @abstractmethod
    def has_work(self) -> bool:
        """Whether `take` would give a call."""

    @property
    @abstractmethod
    def what(self) -> str:
        """Its name in messages about a failed call."""

    def set_dispatcher(self, dispatcher: Dispatcher | None) -> None:
        """Set the dispatcher that runs the calls; pending ones are announced to it."""
        self.dispatcher = dispatcher
        self._announced = False
        if dispatcher is not None and self.has_work():
            self.announce()

    def announce(self) -> None:
        """Notify the dispatcher that there is a call to take, unless it knows."""
        if not self._announced:
            dispatcher = self.dispatcher
            if dispatcher is not None:
                self._announced = True
                dispatcher.ready(self)

    def _next_of(self, queue: deque[T]) -> T | None:
        """Take the oldest item out of a queue that the entity's calls come from; None when it is empty.

        The items behind it are announced.
        """
        self._announced = False
        try:
            item = queue.popleft()
        except IndexError:
            return None
        if queue:
            self.announce()
        return item

    def begin(self) -> None:
        """Be run by the node's dispatcher."""
        self.set_dispatcher(self.node.dispatcher)

    def retire(self) -> None:
        """Never call back again."""
        self.dispatcher = None
        super().retire()

    def report(self, error: BaseException) -> None:
        """Log in the node's name that a call failed."""
        log_failure(self.node.logger, self.what, error)


class GuardCondition(Entity):
    """Calls back soon after it was triggered: once, however often it was triggered in between."""

    def __init__(
        self, node: NodeHandle, callback: Callable[[], object] | None, callback_group: CallbackGroup | None = None
    ) -> None:
        super().__init__(node, callback_group)
        self.callback = callback
        self._triggered = False

    @property
    def what(self) -> str:
        """How log messages name it."""
        return "guard condition callback"

    def trigger(self) -> None:
        """Make a call of the callback due."""
        if not self.destroyed:
            self._triggered = True
            self.announce()

    def has_work(self) -> bool:
        """Whether it was triggered."""
        return self._triggered

    def take(self) -> Callable[[], object] | None:
        """The callback, if it was triggered."""
        self._announced = False
        if not self._triggered or self.destroyed:
            return None
        self._triggered = False
        return self.callback


def accepts(callback: Callable[..., object], count: int, *, unknown: bool) -> bool:
    """Whether a callback can be called with so many positional arguments.

    Args:
        callback: the callback.
        count: how many.
        unknown: the answer for a callable of which Python does not know.
    """
    try:
        signature = inspect.signature(callback)
    except ValueError:
        return unknown
    try:
        signature.bind(*(None,) * count)
    except TypeError:
        return False
    return True
