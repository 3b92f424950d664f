"""The internal handle of a node, behind the API that users see.

The handle has the node's name, parts, callback groups and dispatcher.

rcl has such an object as well (``rcl_node_t``), which rclpy's nodes provide as ``node.handle``. Publishers, timers and
the other parts of a node refer to the handle instead of the node, so a user's node class may have any attributes and
override any method.
"""

from __future__ import annotations

import weakref
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

from linkwright.graph.faults import InvalidHandleError, RclError
from linkwright.graph.log.logger import Logger
from linkwright.graph.names.rules import NodeIdentity, Remappings, expand_service_name, expand_topic_name
from linkwright.graph.time.clock import CallScheduler, Timebase

if TYPE_CHECKING:
    from typing_extensions import Self


class CallbackGroup:
    """A group of entities that decides which of them may run.

    This is the base class for users' own groups. An executor calls `can_execute`, then `beginning_execution`, which may
    still refuse, and finally `ending_execution`. When a callback has ended, the executor calls `can_execute` again for
    the entities that were refused.

    As in rclpy the class is not abstract: programs may instantiate it, and methods that are not overridden raise an
    error.
    """

    def __init__(self) -> None:
        super().__init__()
        self.entities: set[weakref.ref[Any]] = set()
        self._forget = self.entities.discard

    def add_entity(self, entity: Any) -> None:
        """Add an entity to the group.

        The group then decides when the entity's callbacks run.
        """
        self.entities.add(weakref.ref(entity, self._forget))

    def has_entity(self, entity: Any) -> bool:
        """Return whether an entity is a member of the group."""
        return weakref.ref(entity) in self.entities

    def can_execute(self, entity: Any) -> bool:
        """Return whether a member may run now."""
        raise NotImplementedError

    def beginning_execution(self, entity: Any) -> bool:
        """Record that a member is about to run, and return False if it may not run."""
        raise NotImplementedError

    def ending_execution(self, entity: Any) -> None:
        """Record that a member has finished running."""
        raise NotImplementedError


class ReentrantCallbackGroup(CallbackGroup):
    """A group whose callbacks may run at any time, even several times in parallel."""

    def can_execute(self, entity: Any) -> bool:
        """Return True, because any member may run."""
        return True

    def beginning_execution(self, entity: Any) -> bool:
        """Return True, because any member may run."""
        return True

    def ending_execution(self, entity: Any) -> None:
        """Do nothing, because there is no state to update."""


class MutuallyExclusiveCallbackGroup(CallbackGroup):
    """A group that runs only one member at a time.

    A coroutine counts as running until it ends, even while it awaits.
    """

    def __init__(self) -> None:
        super().__init__()
        self._active: Any = None
        self._tokens = [None]  # a token: the thread that pops it may run; faster than a lock

    def can_execute(self, entity: Any) -> bool:
        """Return whether no member is running."""
        return self._active is None

    def beginning_execution(self, entity: Any) -> bool:
        """Let a member run if no other member is running, and return whether it may run."""
        try:
            self._tokens.pop()
        except IndexError:
            return False
        self._active = entity
        return True

    def ending_execution(self, entity: Any) -> None:
        """Let the next member run."""
        if self._active is entity:
            self._active = None
            self._tokens.append(None)


class _FreeGroup(ReentrantCallbackGroup):
    """A reentrant group that all nodes of the process share, without a list of its members."""

    def add_entity(self, entity: Any) -> None:
        """Do nothing, because the group keeps no list of its members."""


FREE_GROUP: CallbackGroup = _FreeGroup()
"""The group of work that belongs to no group in rclpy, such as the execution of an action's goals."""


class Handle:
    """A context that is entered while its owner is in use (rclpy ``handle``).

    Args:
        is_destroyed: a function that returns whether the owner was destroyed.
    """

    def __init__(self, is_destroyed: Callable[[], bool]) -> None:
        self._is_destroyed = is_destroyed
        self._use_count = 0

    @property
    def pointer(self) -> int:
        """A number that distinguishes this handle from others."""
        return id(self)

    def __enter__(self) -> Self:
        if not self._use_count and self._is_destroyed():
            raise InvalidHandleError
        self._use_count += 1
        return self

    def __exit__(self, *_: object) -> None:
        self._use_count -= 1


class HasHandle:
    """An object with a `handle`, and with an attribute ``destroyed``."""

    __slots__ = ()

    destroyed: bool

    @property
    def handle(self) -> Handle:
        """The handle to enter while this object is in use.

        Entering the handle raises InvalidHandleError if the object was destroyed.
        """
        handle = _handles.get(self)
        if handle is None:
            owner = weakref.ref(self)
            handle = _handles[self] = Handle(lambda: getattr(owner(), "destroyed", True))
        return handle


_handles: weakref.WeakKeyDictionary[HasHandle, Handle] = weakref.WeakKeyDictionary()


P = TypeVar("P", bound="Part")


class Dispatcher(CallScheduler, Protocol):
    """The interface of an event loop or executor that runs the calls of entities.

    All methods may be called from any thread.
    """

    def ready(self, entity: Any) -> None:
        """Queue an `Entity` that has at least one call.

        An entity calls this method when its queue was empty before, and again from `Entity.take` while more calls
        remain. The dispatcher's queue therefore does not grow during a flood of messages. An entity whose
        ``dispatcher`` has changed before it is served is skipped.
        """


class HomeGraph(Protocol):
    """The part of a graph that its nodes and their parts need."""

    timebase: Timebase

    def add(self, endpoint: Any) -> None:
        """Connect a new endpoint to the endpoints with the same name."""

    def remove(self, endpoint: Any) -> None:
        """Remove an endpoint."""

    def forget(self, node: NodeHandle) -> None:
        """Remove a node that was destroyed."""

    def notify_change(self) -> None:
        """Wake the threads in `wait_until`, so that they check their conditions again."""

    def wait_until(self, condition: Callable[[], bool], timeout_sec: float | None = None) -> bool:
        """Block the calling thread until a condition of the graph holds.

        Return whether the condition holds.
        """

    def watch_lost(self) -> None:
        """Start notifying subscriptions of lost publishers of their topics."""


class Part(HasHandle):
    """A part of a node, such as an endpoint or a timer.

    Leaving its ``with`` block destroys it.

    Attributes:
        node: the node that owns the part.
        destroyed: whether the part was removed from the node.
    """

    node: NodeHandle
    destroyed = False

    goes_last = False
    """Whether the part is removed after the other parts when its node is destroyed, because they may use it."""

    def begin(self) -> None:
        """Start operating.

        The node calls this method after it has added the part.
        """

    def retire(self) -> None:
        """Stop operating.

        The node calls this method when it removes the part.
        """
        self.destroyed = True

    def set_dispatcher(self, dispatcher: Dispatcher | None) -> None:
        """Set the dispatcher that runs the part's callbacks."""

    def destroy(self) -> None:
        """Remove the part from the graph and the node, and stop calling its callbacks."""
        self.node.remove(self)

    def check_alive(self) -> None:
        """Check that the part can be used.

        Raises:
            InvalidHandleError: the part was destroyed.
            RclError: a signal has shut down the context.
        """
        if self.destroyed:
            raise InvalidHandleError
        self.node.check_valid()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy()


class NodeHandle(Handle):
    """A node of a graph: its name, its parts, and the dispatcher that runs its callbacks.

    Args:
        graph: the graph that the node belongs to.
        identity: the node's name.
        remappings: the node's remapping rules for topics and services.
        logger: the node's logger.
        dispatcher: runs the node's callbacks; None while there is none.
        copies_messages: whether messages are copied, so that the node may change a message after publishing it.
        stays_inside: whether the node and its endpoints are hidden from other processes.

    Attributes:
        timebase: the time of the graph.
        default_callback_group: the group of entities that are in no other group.
        message_filter: called, in any thread, with a subscription of the node and a message that arrives for it;
            returns whether to queue the message for the callback. None queues all messages.
        is_valid: whether no signal has shut down the context. If one has, the node is not destroyed yet, but as in rcl
            it can no longer publish, send requests, or create parts.
        strict_callback_groups: whether a response waits until the callback group of the client allows it to run, as in
            rclpy.
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
        self.is_valid = True
        self.message_filter: Callable[[Any, Any], bool] | None = None
        self.strict_callback_groups = False
        self._parts: dict[Part, None] = {}
        self._cleanups: dict[Callable[[], object], None] = {}

    def check_alive(self) -> None:
        """Raise InvalidHandleError if the node was destroyed."""
        if self.is_destroyed:
            raise InvalidHandleError

    def check_valid(self) -> None:
        """Raise RclError if a signal has shut down the context."""
        if not self.is_valid:
            raise RclError("the context is invalid: rclpy shut it down when it received a signal such as Ctrl-C")

    def set_dispatcher(self, dispatcher: Dispatcher | None) -> None:
        """Set the dispatcher that runs the node's callbacks, or None for no dispatcher.

        Without a dispatcher, calls remain queued within the limits of their QoS. The next dispatcher is notified of
        them.
        """
        self.dispatcher = dispatcher
        for part in tuple(self._parts):
            part.set_dispatcher(dispatcher)

    def add(self, part: P) -> P:
        """Add a part to the node, and return the part.

        The node's dispatcher runs the part's callbacks.

        Raises:
            InvalidHandleError: the node was destroyed.
            RclError: a signal has shut down the context.
        """
        self.check_alive()
        self.check_valid()
        self._parts[part] = None
        part.begin()
        return part

    def remove(self, part: Part) -> bool:
        """Remove a part from the node permanently.

        Return whether the part belonged to this node.
        """
        if part not in self._parts:
            return False
        del self._parts[part]
        part.retire()
        return True

    def parts(self, kind: type[P]) -> tuple[P, ...]:
        """Return the node's parts of one class, in order of creation."""
        return tuple(part for part in tuple(self._parts) if isinstance(part, kind))

    def resolve_topic_name(self, topic: str, *, only_expand: bool = False) -> str:
        """Return the absolute name of a topic.

        The name is expanded and, unless `only_expand` is true, remapped.

        Raises:
            InvalidTopicNameError: the topic name is not valid.
        """
        name, namespace = self.identity.name, self.identity.namespace
        full_name = expand_topic_name(topic, name, namespace)
        return full_name if only_expand else self.remappings.topic(full_name, name, namespace)

    def resolve_service_name(self, service: str, *, only_expand: bool = False) -> str:
        """Return the absolute name of a service or action. See `resolve_topic_name`.

        Raises:
            InvalidServiceNameError: the service name is not valid.
        """
        name, namespace = self.identity.name, self.identity.namespace
        full_name = expand_service_name(service, name, namespace)
        return full_name if only_expand else self.remappings.service(full_name, name, namespace)

    def add_cleanup(self, callback: Callable[[], object]) -> None:
        """Register a callback that is called before the node's parts are destroyed.

        Cleanups run in the reverse order of their registration.
        """
        self._cleanups[callback] = None

    def remove_cleanup(self, callback: Callable[[], object]) -> None:
        """Unregister a callback that was registered with `add_cleanup`."""
        self._cleanups.pop(callback, None)

    def destroy(self) -> bool:
        """Remove the node and all its parts from the graph.

        Return whether this was the first call.

        A second call does nothing.
        """
        if self.is_destroyed:
            return False
        self.is_destroyed = True
        for cleanup in tuple(reversed(self._cleanups)):
            cleanup()
        for part in sorted(self._parts, key=lambda part: part.goes_last):
            self.remove(part)
        self.graph.forget(self)
        return True
