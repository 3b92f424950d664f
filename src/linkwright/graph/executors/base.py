"""The base class of all executors (rclpy ``Executor``): nodes, ready work, tasks, shutdown."""

from __future__ import annotations

import threading
import time
from abc import abstractmethod
from collections import deque
from collections.abc import Callable, Coroutine, Iterator, Sequence
from contextlib import suppress
from functools import partial
from types import CoroutineType, TracebackType
from typing import TYPE_CHECKING, Any, Protocol, TypeVar, overload

from linkwright.graph.executors.task import Task
from linkwright.graph.executors.work import ScheduledCall, WorkQueue
from linkwright.graph.faults import (
    ConditionReachedException,
    ExternalShutdownException,
    ShutdownException,
    TimeoutException,
)
from linkwright.graph.loop.dispatcher import Entity
from linkwright.graph.loop.future import Future, report_self_wait
from linkwright.graph.loop.node_handle import NodeHandle
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

if TYPE_CHECKING:
    from typing_extensions import Self


T = TypeVar("T")

_MAX_POSTPONEMENTS = 2


class Context(Protocol):
    """A context, whose shutdown ends spinning (rclpy ``Context``)."""

    def ok(self) -> bool:
        """Return whether the context is initialized and not shut down."""

    def on_shutdown(self, callback: Callable[[], None]) -> None:
        """Register a callback for the shutdown of the context."""


class SpunNode(Protocol):
    """The part of a node that an executor needs."""

    @property
    def handle(self) -> NodeHandle:
        """The node's handle in the graph."""


def deadline_after(timeout_sec: float | None) -> int | None:
    """Return the end of a timeout in seconds, as a value of ``time.monotonic_ns``.

    Returns None (no limit) if the timeout is None or negative.
    """
    if timeout_sec is None or timeout_sec < 0:
        return None
    return time.monotonic_ns() + int(timeout_sec * NANOSECONDS_PER_SECOND)


class Executor:
    """An executor that runs the callbacks of nodes.

    This is the base class of all executors, including users' own.

    A user's executor defines `spin_once`, which gets its work from `wait_for_ready_callbacks`. As in rclpy the class is
    not abstract, and may be instantiated.

    Args:
        context: the context whose shutdown ends spinning; None for an executor without a context.
    """

    def __init__(self, *, context: Context | None = None) -> None:
        super().__init__()
        self._context = context
        self._work = WorkQueue()
        self._nodes: dict[NodeHandle, SpunNode] = {}
        self._nodes_lock = threading.RLock()
        self._blocked: deque[Entity] = deque()
        self._is_shutdown = False
        self._spinners: list[int] = []
        self._spinners_changed = threading.Condition(threading.RLock())
        if context is not None:
            context.on_shutdown(self.wake)

    @property
    def context(self) -> Any:
        """The context that the executor belongs to."""
        return self._context

    @property
    def is_spinning(self) -> bool:
        """Whether a thread is spinning the executor."""
        return bool(self._spinners)

    def add_node(self, node: SpunNode) -> bool:
        """Add a node whose callbacks this executor runs from now on.

        A node that belongs to another executor is removed from it. Returns False if the executor already has the node,
        or was shut down.
        """
        with self._nodes_lock:
            if self._is_shutdown or node.handle in self._nodes:
                return False
            handle = node.handle
            self._nodes[handle] = node
        if isinstance(handle.dispatcher, Executor):
            handle.dispatcher.remove_node(node)
        handle.set_dispatcher(self)
        self.wake()
        return True

    def remove_node(self, node: SpunNode) -> None:
        """Stop running the callbacks of a node.

        Pending callbacks stay queued for the node's next executor.
        """
        with self._nodes_lock:
            if self._nodes.pop(node.handle, None) is None:
                return
        node.handle.set_dispatcher(None)
        self.wake()

    def get_nodes(self) -> list[Any]:
        """Return the nodes that were added."""
        with self._nodes_lock:
            return list(self._nodes.values())

    def wake(self) -> None:
        """End the current wait, so that the ready work and the condition are checked again."""
        self._release_blocked()
        self._work.wake()

    @overload
    def create_task(self, callback: Callable[..., Coroutine[Any, Any, T]], *args: Any, **kwargs: Any) -> Task[T]: ...

    @overload
    def create_task(self, callback: Callable[..., T], *args: Any, **kwargs: Any) -> Task[T]: ...

    @overload
    def create_task(self, callback: Coroutine[Any, Any, T], *args: Any, **kwargs: Any) -> Task[T]: ...

    def create_task(self, callback: Any, *args: Any, **kwargs: Any) -> Task[Any]:
        """Run a callable or coroutine while the executor spins, after the work that is ready now.

        Args:
            callback: a callable, a coroutine function or a coroutine.
            args: positional arguments for `callback`.
            kwargs: keyword arguments for `callback`.
        """
        task: Task[Any] = Task(callback, args, kwargs, executor=self)
        self._work.add(task)
        return task

    def create_future(self) -> Future[Any]:
        """Create a future whose done callbacks this executor runs."""
        return Future(executor=self)

    def spin(self) -> None:
        """Run callbacks until the executor or the context is shut down."""
        while not self._is_shutdown and self._is_context_ok():
            self.spin_once()

    def spin_once(self, timeout_sec: float | None = None) -> None:
        """Wait for a callback and run it.

        Args:
            timeout_sec: the maximum wait, in seconds; 0 not to wait, None or a negative number for no limit.
        """
        raise NotImplementedError

    def spin_until_future_complete(self, future: Future[Any], timeout_sec: float | None = None) -> None:
        """Run callbacks until a future is done or cancelled, or the timeout has passed.

        Args:
            future: the future.
            timeout_sec: the maximum time, in seconds; None for no limit.
        """
        report_self_wait(future)
        future.add_waiter(self.wake)
        deadline_ns = deadline_after(timeout_sec)
        while not (future.ended() or self._is_shutdown) and self._is_context_ok():
            if deadline_ns is None:
                self.spin_once_until_future_complete(future)
                continue
            remaining_sec = max(deadline_ns - time.monotonic_ns(), 0) / NANOSECONDS_PER_SECOND
            self.spin_once_until_future_complete(future, remaining_sec)
            if time.monotonic_ns() >= deadline_ns:
                return

    def spin_once_until_future_complete(self, future: Future[Any], timeout_sec: float | None = None) -> None:
        """Wait like `spin_once`, but at most until the future is done."""
        future.add_waiter(self.wake)
        self.spin_once(timeout_sec)

    def shutdown(self, timeout_sec: float | None = None) -> bool:
        """Stop running callbacks, and wait for callbacks that are running in other threads.

        Args:
            timeout_sec: the maximum wait, in seconds; None or a negative number for no limit.

        Returns:
            Whether all of them have ended.
        """
        self._is_shutdown = True
        self._work.wake()
        if not self._wait_for_spinners(deadline_after(timeout_sec)):
            return False
        for node in self.get_nodes():
            self.remove_node(node)
        self._work.clear()
        self._blocked.clear()
        return True

    def can_execute(self, entity: Any) -> bool:
        """Return whether the callback group of an entity allows it to run now."""
        return bool(entity.unblockable or entity.callback_group.can_execute(entity))

    def wait_for_ready_callbacks(
        self,
        timeout_sec: float | None = None,
        nodes: Sequence[SpunNode] | None = None,
        condition: Callable[[], bool] | None = None,
    ) -> tuple[Task[Any], Any, Any]:
        """Wait for a callback or task that is ready to run.

        Args:
            timeout_sec: the maximum wait, in seconds; 0 not to wait, None or a negative number for no limit.
            nodes: the nodes whose callbacks to wait for; None for all nodes.
            condition: ends the wait when it returns True after a `wake`.

        Returns:
            A task to be called, whose ``exception()`` returns the error afterwards; its entity (None for a task that
            was created by `create_task`); and its node.

        Raises:
            TimeoutException: no work was ready in time.
            ShutdownException: the executor was shut down.
            ExternalShutdownException: the context was shut down.
            ConditionReachedException: the condition has become true.
        """
        return next(self._wait_for_ready_callbacks(timeout_sec, nodes, condition))

    def ready(self, entity: Entity) -> None:
        """Queue an entity that has work. See ``Dispatcher.ready``.

        When a node was removed and is added again, as each call of ``rclpy.spin_once`` does, its entities with work
        keep their places in the queue.
        """
        self._work.add_once(entity)

    def call_at(self, steady_ns: int, callback: Callable[[], None]) -> ScheduledCall:
        """Schedule a callback for a value of ``time.monotonic_ns``. See ``Dispatcher.call_at``."""
        return self._work.call_at(steady_ns, callback)

    def run_again(self, task: Task[Any]) -> None:
        """Queue a task to run up to its next await."""
        self._work.add(task)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.shutdown()

    def _is_context_ok(self) -> bool:
        return self._context is None or self._context.ok()

    def _wait_for_ready_callbacks(
        self,
        timeout_sec: float | None = None,
        nodes: Sequence[SpunNode] | None = None,
        condition: Callable[[], bool] | None = None,
    ) -> Iterator[tuple[Task[Any], Any, Any]]:
        """Yield ready tasks, with their entities and nodes, one after another.

        See `wait_for_ready_callbacks`.
        """
        requested_handles = None if nodes is None else {node.handle for node in nodes}
        while True:
            deadline_ns = deadline_after(timeout_sec)
            skipped_items: list[Any] = []
            try:
                item = self._wait_for_next(deadline_ns, condition, begin=False)
                while requested_handles is not None and isinstance(item, Entity) and item.node not in requested_handles:
                    skipped_items.append(item)
                    item = self._wait_for_next(deadline_ns, condition, begin=False)
            finally:
                self._work.add_first(skipped_items)
            if isinstance(item, Task):
                yield item, None, None
            else:
                yield self._make_task(item), item, self._nodes.get(item.node)

    def _wait_for_next(
        self, deadline_ns: int | None, condition: Callable[[], bool] | None, *, begin: bool = True
    ) -> Any:
        """Wait for the next task, or the next entity that its callback group allows to run.

        If `begin` is true, the group is notified that the entity begins to run. Raises the same errors as
        `wait_for_ready_callbacks`.
        """
        while True:
            if self._is_shutdown:
                raise ShutdownException
            if not self._is_context_ok():
                raise ExternalShutdownException
            if condition is not None and condition():
                raise ConditionReachedException
            item = self._work.take()
            if item is None:
                if deadline_ns is not None and time.monotonic_ns() >= deadline_ns:
                    raise TimeoutException
                self._work.wait(deadline_ns)
            elif self._admit(item, begin=begin):
                return item

    def _admit(self, item: Any, *, begin: bool = True) -> bool:
        """Return whether work that was taken from the queue can run now.

        If `begin` is true, the callback group of an entity is notified that the entity begins to run.

        An entity that its callback group does not allow to run yet is set aside.
        """
        if isinstance(item, Task):
            return not item.ended()
        if item.dispatcher is not self:
            return False
        if item.unblockable:
            return not self._postpone(item)
        group = item.callback_group
        if group.can_execute(item) and (not begin or group.beginning_execution(item)):
            return True
        self._block(item)
        return False

    def _postpone(self, client: Entity) -> bool:
        """Move a client's response behind the ready work.

        Return whether the response was moved. rclpy runs tasks and messages before responses: when a client learns that
        its goal was accepted, it has already received the feedback if the goal was executed in the meantime. A response
        is postponed a limited number of times.
        """
        if client.postponed >= _MAX_POSTPONEMENTS or not self._work.has_ready():
            client.postponed = 0
            return False
        client.postponed += 1
        self._work.add_once(client)
        return True

    def _execute(self, item: Any) -> None:
        """Run a task up to its next await, or the next call of an entity.

        The entity's group must have been notified that the entity begins. Exceptions of the user's code propagate.
        """
        if isinstance(item, Task):
            item()
            _raise_fault(item)
            return
        running_entity = item  # `linkwright.graph.loop.future` looks for this local name
        result = None
        try:
            call = running_entity.take()
            if call is not None:
                result = call()
        finally:
            if type(result) is not CoroutineType:
                self._end_execution(running_entity)
        if type(result) is CoroutineType:
            task: Task[Any] = Task(result, executor=self, on_end=partial(self._end_execution, running_entity))
            task()
            _raise_fault(task)

    def _make_task(self, entity: Entity) -> Task[Any]:
        begun = False

        def run() -> object:
            nonlocal begun
            running_entity = entity  # `linkwright.graph.loop.future` looks for this local name
            if not (running_entity.unblockable or running_entity.callback_group.beginning_execution(running_entity)):
                self._block(running_entity)
                return None
            begun = True
            call = running_entity.take()
            return None if call is None else call()

        def on_end() -> None:
            if begun:
                self._end_execution(entity)

        return Task(run, executor=self, on_end=on_end)

    def _end_execution(self, entity: Entity) -> None:
        if not entity.unblockable:
            entity.callback_group.ending_execution(entity)
        if self._blocked:
            self._release_blocked()

    def _block(self, entity: Entity) -> None:
        self._blocked.append(entity)
        if entity.callback_group.can_execute(entity):  # the running member of the group has just ended
            self._release_blocked()

    def _release_blocked(self) -> None:
        released_entities = []
        while self._blocked:
            with suppress(IndexError):  # another thread took the last entity
                released_entities.append(self._blocked.popleft())
        if released_entities:
            self._work.add_first(released_entities)

    def _begin_spinning(self) -> None:
        self._spinners.append(threading.get_ident())

    def _end_spinning(self) -> None:
        with self._spinners_changed:
            self._spinners.remove(threading.get_ident())
            if self._is_shutdown:
                self._spinners_changed.notify_all()

    def _wait_for_spinners(self, deadline_ns: int | None) -> bool:
        current_thread_id = threading.get_ident()
        with self._spinners_changed:
            while any(spinner != current_thread_id for spinner in self._spinners):
                self._work.wake()
                remaining_s = (
                    None if deadline_ns is None else (deadline_ns - time.monotonic_ns()) / NANOSECONDS_PER_SECOND
                )
                if remaining_s is not None and remaining_s <= 0:
                    return False
                self._spinners_changed.wait(remaining_s)
        return True


def _raise_fault(task: Task[Any]) -> None:
    if task.done():
        fault = task.exception()
        if fault is not None:
            raise fault


class SpinningExecutor(Executor):
    """The base class of executors that spin in a loop.

    Subclasses define one iteration of the loop.
    """

    def spin(self) -> None:
        """Run callbacks until the executor or the context is shut down."""
        self._begin_spinning()
        try:
            while not self._is_shutdown and self._is_context_ok():
                self._run_next(None, None)
        finally:
            self._end_spinning()

    def spin_once(self, timeout_sec: float | None = None) -> None:
        """Wait for a callback, then run it in this thread or in another.

        See ``Executor.spin_once``.
        """
        self._spin_single(timeout_sec, None)

    def spin_once_until_future_complete(self, future: Future[Any], timeout_sec: float | None = None) -> None:
        """Wait like `spin_once`, but at most until the future is done."""
        future.add_waiter(self.wake)
        self._spin_single(timeout_sec, future.ended)

    def _spin_single(self, timeout_sec: float | None, condition: Callable[[], bool] | None) -> None:
        self._begin_spinning()
        try:
            self._run_next(deadline_after(timeout_sec), condition)
        finally:
            self._end_spinning()

    @abstractmethod
    def _run_next(self, deadline_ns: int | None, condition: Callable[[], bool] | None) -> None:
        """Wait for a callback, then run it in this thread or in another.

        Args:
            deadline_ns: the value of ``time.monotonic_ns`` at which the wait ends; None for no limit.
            condition: ends the wait when it returns True after a `wake`.
        """
