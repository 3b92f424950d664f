"""Something of a node that calls back."""

from __future__ import annotations

import traceback
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, TypeVar

from linkwright.diagnostics import LinkwrightError
from linkwright.graph.faults import InvalidHandleError
from linkwright.graph.handle import Handled

if TYPE_CHECKING:
    from linkwright.graph.dispatch import CallbackGroup, Dispatcher
    from linkwright.graph.node import Node

T = TypeVar("T")


class Entity(Handled, ABC):
    """What a dispatcher takes calls from.

    Attributes:
        node: whose it is.
        callback_group: which entities may run beside it; None stands for the node's default group.
        dispatcher: what runs its calls; None while the node has none, and after it was destroyed.
    """

    unblockable = False
    """Whether its calls run none of the user's callbacks, so that no group needs to hold them back."""

    postponed = 0
    """How often an executor has let others run first; see ``Executor._postpone``."""

    def __init__(self, node: Node, callback_group: CallbackGroup | None = None) -> None:
        self.node = node
        self.callback_group = callback_group
        self.dispatcher: Dispatcher | None = None
        self.destroyed = False
        self._announced = False
        add_entity = getattr(callback_group, "add_entity", None)
        if add_entity is not None:
            add_entity(self)

    @abstractmethod
    def take(self) -> Callable[[], object] | None:
        """The next call that is due, taken out of the entity's queue; None when there is none any more.

        What the call raises is the user's; it may give a coroutine, which the dispatcher runs to its end.
        """

    @abstractmethod
    def has_work(self) -> bool:
        """Whether `take` would give a call."""

    @property
    @abstractmethod
    def what(self) -> str:
        """What it is, for messages about a failed call."""

    def set_dispatcher(self, dispatcher: Dispatcher | None) -> None:
        """Have the calls run by a dispatcher from now on; what is pending is announced to it."""
        self.dispatcher = dispatcher
        self._announced = False
        if dispatcher is not None and self.has_work():
            self.announce()

    def announce(self) -> None:
        """Tell the dispatcher that there is something to take, unless it knows."""
        if not self._announced:
            dispatcher = self.dispatcher
            if dispatcher is not None:
                self._announced = True
                dispatcher.ready(self)

    def _next_of(self, queue: deque[T]) -> T | None:
        """What waits longest, taken out of the queue that the entity's calls come from; None when there is nothing.

        What waits behind it is announced.
        """
        self._announced = False
        try:
            item = queue.popleft()
        except IndexError:
            return None
        if queue:
            self.announce()
        return item

    def report(self, error: BaseException) -> None:
        """Say in the node's log that a call failed.

        An error in the user's input is told by its own words, anything else with the traceback that its author needs.
        """
        if isinstance(error, LinkwrightError):
            problem = f" {error}"
        else:
            lines = traceback.format_exception(type(error), error, error.__traceback__)
            problem = "\n" + "".join(lines).rstrip()
        self.node.get_logger().error(f"{self.what} failed:{problem}")

    def retire(self) -> None:
        """Never call back again."""
        self.destroyed = True
        self.dispatcher = None

    def check_alive(self) -> None:
        """Raise InvalidHandleError when it was destroyed."""
        if self.destroyed:
            raise InvalidHandleError
