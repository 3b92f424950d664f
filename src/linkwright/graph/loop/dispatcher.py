"""Entities, the sources of a node's callbacks, and the dispatcher of an event loop.

An entity (a subscription, a timer, a service, ...) notifies its node's dispatcher that it has a call to run. The
dispatcher decides when, and in which thread, it takes the call and runs it. This module contains the dispatcher of the
launcher's event loop. The executors of rclpy are dispatchers, too (`linkwright.graph.executors`).
"""

from __future__ import annotations

import asyncio
import inspect
import threading
import time
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable, Coroutine
from dataclasses import dataclass, field
from functools import partial
from types import CoroutineType
from typing import Any, TypeVar

from linkwright.graph.log.logger import log_failure
from linkwright.graph.loop.node_handle import CallbackGroup, Dispatcher, NodeHandle, Part
from linkwright.graph.time.clock import Alarm, Timebase

T = TypeVar("T")


class Entity(Part, ABC):
    """A source of callbacks that a dispatcher runs.

    Attributes:
        callback_group: decides which entities may run at the same time; the node's default group unless another is
            given.
        dispatcher: runs the entity's calls; None while the node has none, and after the entity was destroyed.
    """

    unblockable = False
    """Whether the entity's calls run no callback of the user, so that they need not wait for a callback group."""

    postponed = 0
    """The number of times that an executor has let other work run first; see ``Executor._postpone``."""

    def __init__(self, node: NodeHandle, callback_group: CallbackGroup | None = None) -> None:
        self.node = node
        self.callback_group = node.default_callback_group if callback_group is None else callback_group
        self.dispatcher: Dispatcher | None = None
        self._announced = False
        # A user's group may lack rclpy's methods.
        add_entity = getattr(self.callback_group, "add_entity", None)
        if add_entity is not None:
            add_entity(self)

    @abstractmethod
    def take(self) -> Callable[[], object] | None:
        """Remove the next call from the entity's queue and return it, or None if there is none.

        The call may raise any exception of the user's code. It may return a coroutine, which the dispatcher runs to
        completion.
        """

    @abstractmethod
    def has_work(self) -> bool:
        """Return whether `take` would return a call."""

    @property
    @abstractmethod
    def description(self) -> str:
        """The description of this entity in log messages."""

    def set_dispatcher(self, dispatcher: Dispatcher | None) -> None:
        """Set the dispatcher that runs the calls, and announce pending calls to it."""
        self.dispatcher = dispatcher
        self._announced = False
        if dispatcher is not None and self.has_work():
            self.announce()

    def announce(self) -> None:
        """Notify the dispatcher that the entity has a call, unless it has been notified already."""
        if not self._announced:
            dispatcher = self.dispatcher
            if dispatcher is not None:
                self._announced = True
                dispatcher.ready(self)

    def _take_from(self, queue: deque[T]) -> T | None:
        """Remove the oldest item from one of the entity's queues and return it.

        Return None if the queue is empty.

        If items remain in the queue, the entity announces itself again.
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
        """Let the node's dispatcher run the entity's calls."""
        self.set_dispatcher(self.node.dispatcher)

    def retire(self) -> None:
        """Stop calling callbacks."""
        self.dispatcher = None
        super().retire()

    def report(self, error: BaseException) -> None:
        """Log an error that a call of the entity raised, with the node's logger."""
        log_failure(self.node.logger, self.description, error)


class GuardCondition(Entity):
    """An entity whose callback is called soon after it is triggered.

    Several triggers before the call result in a single call.
    """

    def __init__(
        self, node: NodeHandle, callback: Callable[[], object] | None, callback_group: CallbackGroup | None = None
    ) -> None:
        super().__init__(node, callback_group)
        self.callback = callback
        self._triggered = False

    @property
    def description(self) -> str:
        """The description of this entity in log messages."""
        return "guard condition callback"

    def trigger(self) -> None:
        """Schedule a call of the callback."""
        if not self.destroyed:
            self._triggered = True
            self.announce()

    def has_work(self) -> bool:
        """Return whether the guard condition was triggered."""
        return self._triggered

    def take(self) -> Callable[[], object] | None:
        """Return the callback if the guard condition was triggered, otherwise None."""
        self._announced = False
        if not self._triggered or self.destroyed:
            return None
        self._triggered = False
        return self.callback


def accepts(callback: Callable[..., object], count: int, *, unknown: bool) -> bool:
    """Return whether a callback can be called with a number of positional arguments.

    Args:
        callback: the callback.
        count: the number of arguments.
        unknown: the return value for a callable whose signature Python cannot determine.
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


_MAX_CALLS_PER_TURN = 256
_MAX_TURN_S = 0.002
_MAX_TURNS = 1000
"""The maximum number of loop iterations without a call for which `settle` waits for idle coroutines."""


class LoopDispatcher:
    """A dispatcher on the event loop of the thread that creates it.

    Entities are served in rotation: an entity with more calls moves to the end of the queue after each call, so that a
    flood of messages on one topic does not starve the others. In each iteration of the loop the dispatcher runs ready
    entities for a limited time, and then lets the loop serve sockets and timers. Work that becomes ready while a
    callback runs is run afterwards, never inside the callback. Callbacks that are coroutines run as tasks of the
    loop, which end with their node.
    """

    def __init__(self, timebase: Timebase, loop: asyncio.AbstractEventLoop) -> None:
        self._timebase = timebase
        self._loop = loop
        self._thread = threading.get_ident()
        self._ready: deque[Entity] = deque()
        self._is_scheduled = False
        self._is_wake_scheduled = False
        self._closed = False
        self.on_error: Callable[[Entity, Exception], None] = Entity.report
        """Handles the error of a callback. By default, the error is logged."""
        self._tasks: dict[asyncio.Task[None], NodeHandle] = {}
        self._group_states: dict[CallbackGroup, _GroupState] = {}
        timebase.attach(self)

    @property
    def loop(self) -> asyncio.AbstractEventLoop:
        """The event loop that the dispatcher runs on."""
        return self._loop

    def is_own_thread(self) -> bool:
        """Return whether the calling thread is the loop's thread."""
        return threading.get_ident() == self._thread

    def ready(self, entity: Entity) -> None:
        """Queue an entity, so that its next call runs in the loop.

        Callable from any thread.
        """
        self._ready.append(entity)
        if self._is_scheduled:
            return
        if threading.get_ident() == self._thread:
            self._schedule()
        elif not self._is_wake_scheduled:
            self._is_wake_scheduled = True
            self._call_threadsafe(self._wake)

    def call_at(self, steady_ns: int, callback: Callable[[], None]) -> Alarm:
        """Schedule a callback for a time of the timebase's steady clock."""
        if threading.get_ident() == self._thread:
            return self._timebase.call_at(self._loop, steady_ns, partial(self._run_alarm, callback))
        return _ThreadsafeAlarm(self, steady_ns, callback)

    def call_threadsafe(self, callback: Callable[[], None]) -> None:
        """Schedule a callback on the loop, from any thread.

        This has no effect if the loop has ended.
        """
        self._call_threadsafe(callback)

    def forget(self, node: NodeHandle) -> None:
        """Cancel the coroutines of a node."""
        for task, owner in tuple(self._tasks.items()):
            if owner is node:
                task.cancel()

    async def settle(self) -> None:
        """Wait until no work is ready, including calls that other calls make ready.

        Other coroutines on the loop also run until they wait. The number of loop iterations for them is limited, in
        case a coroutine never waits.
        """
        await asyncio.sleep(0)
        turns = 0
        while self._ready or (self._has_other_work() and turns < _MAX_TURNS):
            turns = 0 if self._ready else turns + 1
            await asyncio.sleep(0)

    def _has_other_work(self) -> bool:
        # asyncio's own loop has its queue in this attribute; a loop without the attribute is assumed to be idle.
        return bool(getattr(self._loop, "_ready", ()))

    def close(self) -> None:
        """Drop all work, and cancel running coroutines."""
        self._closed = True
        self._ready.clear()
        self._group_states.clear()
        for task in tuple(self._tasks):
            task.cancel()

    async def join(self) -> None:
        """Wait until the cancelled coroutines have ended."""
        tasks = [task for task in self._tasks if task is not asyncio.current_task()]
        if tasks:
            await asyncio.gather(*tasks, return_exceptions=True)
            await asyncio.sleep(0)  # run one more iteration, so that the loop drops them, too

    def _call_threadsafe(self, callback: Callable[[], None]) -> None:
        try:
            self._loop.call_soon_threadsafe(callback)
        except RuntimeError:  # the loop is closed
            self._is_wake_scheduled = False

    def _wake(self) -> None:
        self._is_wake_scheduled = False
        if self._ready and not self._is_scheduled:
            self._schedule()

    def _run_alarm(self, callback: Callable[[], None]) -> None:
        """Run an alarm's callback and, in the same loop iteration, the calls that it makes ready."""
        if self._is_scheduled:
            callback()
            return
        self._is_scheduled = True
        try:
            callback()
        finally:
            self._run_turn()

    def _schedule(self) -> None:
        if not self._closed:
            self._is_scheduled = True
            self._loop.call_soon(self._run_turn)

    def _run_turn(self) -> None:
        queue = self._ready
        clock = time.perf_counter
        end_s = clock() + _MAX_TURN_S
        try:
            for _ in range(_MAX_CALLS_PER_TURN):
                if not queue:
                    break
                entity = queue.popleft()
                if entity.dispatcher is not self or (self._group_states and self._must_wait(entity)):
                    continue
                call = entity.take()
                if call is None:
                    continue
                try:
                    result = call()
                except Exception as error:  # noqa: BLE001  # a failing callback must not stop other nodes
                    self.on_error(entity, error)
                else:
                    if result is not None and isinstance(result, CoroutineType):
                        self._start(entity, result)
                if clock() > end_s:
                    break
        finally:
            self._is_scheduled = False
            if queue:
                self._schedule()

    # --- coroutines ----------------------------------------------------------------------------------------------

    def _must_wait(self, entity: Entity) -> bool:
        group = entity.callback_group
        state = self._group_states.get(group)
        if state is None or entity.unblockable or group.can_execute(entity):
            return False
        state.waiting.append(entity)
        return True

    def _start(self, entity: Entity, coroutine: Coroutine[Any, Any, object]) -> None:
        group = entity.callback_group
        group.beginning_execution(entity)
        self._group_states.setdefault(group, _GroupState()).coroutines += 1
        task = self._loop.create_task(self._run(entity, coroutine))
        self._tasks[task] = entity.node

        def on_end(task: asyncio.Task[None]) -> None:
            self._tasks.pop(task, None)
            coroutine.close()
            self._release(group, entity)

        task.add_done_callback(on_end)

    async def _run(self, entity: Entity, coroutine: Coroutine[Any, Any, object]) -> None:
        try:
            await coroutine
        except Exception as error:  # noqa: BLE001  # as for callbacks that are not coroutines
            self.on_error(entity, error)

    def _release(self, group: CallbackGroup, entity: Entity) -> None:
        group.ending_execution(entity)
        state = self._group_states.get(group)
        if state is None:
            return
        state.coroutines -= 1
        waiting_entities, state.waiting = state.waiting, []
        if not state.coroutines:
            del self._group_states[group]
        for waiting_entity in waiting_entities:
            self.ready(waiting_entity)


@dataclass(slots=True)
class _GroupState:
    """The running coroutines of a callback group, and the entities that wait for their end."""

    coroutines: int = 0
    waiting: list[Entity] = field(default_factory=list)


class _ThreadsafeAlarm:
    """An alarm that was set by a thread other than the loop's thread."""

    __slots__ = ("_alarm", "_cancelled", "_dispatcher")

    def __init__(self, dispatcher: LoopDispatcher, steady_ns: int, callback: Callable[[], None]) -> None:
        self._dispatcher = dispatcher
        self._alarm: Alarm | None = None
        self._cancelled = False

        def set_up() -> None:
            if not self._cancelled:
                self._alarm = dispatcher.call_at(steady_ns, callback)

        dispatcher.call_threadsafe(set_up)

    def cancel(self) -> None:
        self._cancelled = True
        self._dispatcher.call_threadsafe(self._cancel)

    def _cancel(self) -> None:
        if self._alarm is not None:
            self._alarm.cancel()
