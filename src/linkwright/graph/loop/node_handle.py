"""A node as the graph knows it: its name, parts, callback groups and dispatcher, behind the API that users see.

rcl has such an object too (``rcl_node_t``), and rclpy's nodes give theirs as ``node.handle``. Publishers, timers and
the other parts of a node know this, not the node: so a user's class may have any attributes and override any method.
"""

from __future__ import annotations

import weakref
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

from linkwright.graph.faults import InvalidHandleError
from linkwright.graph.log.logger import Logger
from linkwright.graph.names.rules import NodeIdentity, Remappings, expand_service_name, expand_topic_name
from linkwright.graph.time.clock import AlarmSetter, Timebase

if TYPE_CHECKING:
    from typing_extensions import Self


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


class Handle:
    """Entered while its owner is used (rclpy ``handle``).

    Args:
        is_destroyed: whether that was destroyed.
    """

    def __init__(self, is_destroyed: Callable[[], bool]) -> None:
        self._is_destroyed = is_destroyed
        self._users = 0

    @property
    def pointer(self) -> int:
        """A number that distinguishes it from others."""
        return id(self)

    def __enter__(self) -> Self:
        if not self._users and self._is_destroyed():
            raise InvalidHandleError
        self._users += 1
        return self

    def __exit__(self, *_: object) -> None:
        self._users -= 1


class Handled:
    """An object with a `handle`, and with an attribute ``destroyed``."""

    __slots__ = ()

    destroyed: bool

    @property
    def handle(self) -> Handle:
        """To be entered while this is used; raises InvalidHandleError then, if it was destroyed."""
        found = _handles.get(self)
        if found is None:
            owner = weakref.ref(self)
            found = _handles[self] = Handle(lambda: getattr(owner(), "destroyed", True))
        return found


_handles: weakref.WeakKeyDictionary[Handled, Handle] = weakref.WeakKeyDictionary()


P = TypeVar("P", bound="Part")


class Dispatcher(AlarmSetter, Protocol):
    """Runs the calls of entities: an event loop, or an executor. All methods may be called from any thread."""

    def ready(self, entity: Any) -> None:
        """Note that an `Entity` has at least one call to be taken.

        An entity announces itself when its queue was empty before, and again from within `Entity.take` while more
        remain; so nothing piles up here when messages flood in. An entity whose ``dispatcher`` is another one by then
        is skipped.
        """


class HomeGraph(Protocol):
    """A graph, as its nodes and their parts use it."""

    timebase: Timebase

    def add(self, endpoint: Any) -> None:
        """Bring a new endpoint together with those of its name."""

    def remove(self, endpoint: Any) -> None:
        """Take an endpoint away."""

    def forget(self, node: NodeHandle) -> None:
        """Take a node away that is destroyed."""

    def notify_change(self) -> None:
        """Wake the waiters of `wait_until`, which check their condition again."""

    def wait_until(self, holds: Callable[[], bool], timeout_sec: float | None = None) -> bool:
        """Block the calling thread until a condition of the graph holds; whether it does."""

    def watch_lost(self) -> None:
        """Notify subscriptions from now on of publishers of their topics that are lost."""


class Part(Handled):
    """A part of a node, such as an endpoint or a timer; at the end of a ``with`` block it is destroyed.

    Attributes:
        node: whose it is.
        destroyed: whether it was taken out of the node.
    """

    node: NodeHandle
    destroyed = False

    goes_last = False
    """Whether it outlives the other parts of a node that is destroyed, which may use it."""

    def begin(self) -> None:
        """The node has it from now on."""

    def retire(self) -> None:
        """The node has it no longer."""
        self.destroyed = True

    def set_dispatcher(self, dispatcher: Dispatcher | None) -> None:
        """Set the dispatcher that runs its callbacks."""

    def destroy(self) -> None:
        """Take it out of the graph and the node; nothing is called back any more."""
        self.node.remove(self)

    def check_alive(self) -> None:
        """Raise InvalidHandleError when it was destroyed."""
        if self.destroyed:
            raise InvalidHandleError

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy()


class NodeHandle(Handle):
    """A node of a graph: its name, its parts, and the dispatcher that runs its callbacks.

    Args:
        graph: the graph it lives in.
        identity: its name.
        remappings: its rules for names of topics and services.
        logger: its logger.
        dispatcher: runs its callbacks; None while nothing does.
        copies_messages: whether its messages are copied, so that their sender may change them afterwards.
        stays_inside: whether it is hidden, with all its endpoints, from other processes.

    Attributes:
        timebase: the time of the graph.
        default_callback_group: the group of entities that are in no other.
        intake: called with each subscription of the node and each message that arrives for it, in any thread; the
            message waits for the callback only if it returns True. None queues all messages.
        strict_callback_groups: whether responses to its requests wait for the callback group of the client.
    """

    def __init__(
        self,
        graph: HomeGraph,
        identity: NodeIdentity,
        *,
        remappings: Remappings,
        logger: Logger,
        dispatcher: Dispatcher | None,
        copies_messages: bool = False,
        stays_inside: bool = False,
    ) -> None:
        super().__init__(lambda: self.is_destroyed)
        self.graph = graph
        self.identity = identity
        self.remappings = remappings
        self.logger = logger
        self.dispatcher = dispatcher
        self.copies_messages = copies_messages
        self.stays_inside = stays_inside
        self.timebase = graph.timebase
        self.default_callback_group: CallbackGroup = MutuallyExclusiveCallbackGroup()
        self.is_destroyed = False
        self.intake: Callable[[Any, Any], bool] | None = None
        self.strict_callback_groups = False
        self._parts: dict[Part, None] = {}
        self._cleanups: dict[Callable[[], object], None] = {}

    def check_alive(self) -> None:
        """Raise InvalidHandleError when the node was destroyed."""
        if self.is_destroyed:
            raise InvalidHandleError

    def set_dispatcher(self, dispatcher: Dispatcher | None) -> None:
        """Set the dispatcher that runs the node's callbacks; None for none.

        Calls that fall due while there is none wait as the quality of service says; the next one is notified of them.
        """
        self.dispatcher = dispatcher
        for part in tuple(self._parts):
            part.set_dispatcher(dispatcher)

    def add(self, part: P) -> P:
        """Take a part into the node, and give it back: its calls are run with the node's.

        Raises:
            InvalidHandleError: the node was destroyed.
        """
        self.check_alive()
        self._parts[part] = None
        part.begin()
        return part

    def remove(self, part: Part) -> bool:
        """Take a part out of the node for good. Whether it was this node's."""
        if part not in self._parts:
            return False
        del self._parts[part]
        part.retire()
        return True

    def parts(self, kind: type[P]) -> tuple[P, ...]:
        """The parts of a kind, in the order in which they were made."""
        return tuple(part for part in tuple(self._parts) if isinstance(part, kind))

    def resolve_topic_name(self, topic: str, *, only_expand: bool = False) -> str:
        """The absolute name of a topic as the node names it, expanded and, unless `only_expand`, remapped.

        Raises:
            InvalidTopicNameError: it is not valid.
        """
        name, namespace = self.identity.name, self.identity.namespace
        full_name = expand_topic_name(topic, name, namespace)
        return full_name if only_expand else self.remappings.topic(full_name, name, namespace)

    def resolve_service_name(self, service: str, *, only_expand: bool = False) -> str:
        """The absolute name of a service or action as the node names it, expanded and, unless `only_expand`, remapped.

        Raises:
            InvalidServiceNameError: it is not valid.
        """
        name, namespace = self.identity.name, self.identity.namespace
        full_name = expand_service_name(service, name, namespace)
        return full_name if only_expand else self.remappings.service(full_name, name, namespace)

    def add_cleanup(self, callback: Callable[[], object]) -> None:
        """Register a callback for the end of the node, before that of its parts; the last one added is called first."""
        self._cleanups[callback] = None

    def remove_cleanup(self, callback: Callable[[], object]) -> None:
        """Undo `add_cleanup`."""
        self._cleanups.pop(callback, None)

    def destroy(self) -> bool:
        """Take the node and all it owns out of the graph. A second call does nothing. Whether this was the first."""
        if self.is_destroyed:
            return False
        self.is_destroyed = True
        for cleanup in tuple(reversed(self._cleanups)):
            cleanup()
        for part in sorted(self._parts, key=lambda part: part.goes_last):
            self.remove(part)
        self.graph.forget(self)
        return True
