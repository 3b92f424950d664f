"""Executors: the threads of callbacks, the ends of waits, and errors."""

from __future__ import annotations

import threading
import time

import pytest

from linkwright.graph import Graph
from linkwright.graph.executors import (
    ConditionReachedException,
    Executor,
    ExternalShutdownException,
    MultiThreadedExecutor,
    MutuallyExclusiveCallbackGroup,
    ReentrantCallbackGroup,
    ShutdownException,
    SingleThreadedExecutor,
    TimeoutException,
)
from linkwright.graph.loop.future import Future
from linkwright.messages import String
from tests.waiting import TIMEOUT_S, is_waiting, wait_until
from tests.work import lines_run

both_executors = pytest.mark.parametrize("kind", [SingleThreadedExecutor, MultiThreadedExecutor])


class Context:
    """A context as executors see it."""

    def __init__(self):
        self.is_ok = True
        self.callbacks = []

    def ok(self):
        return self.is_ok

    def on_shutdown(self, callback):
        self.callbacks.append(callback)

    def shutdown(self):
        self.is_ok = False
        for callback in self.callbacks:
            callback()


@pytest.fixture
def graph():
    graph = Graph(threads=True, on_log=lambda _record: None)
    yield graph
    graph.close_threadsafe()


@pytest.fixture
def node(graph):
    return graph.create_node("tested", start_parameter_services=False, enable_rosout=False)


@pytest.fixture
def executor(node):
    with SingleThreadedExecutor() as executor:
        executor.add_node(node)
        yield executor


def spin_in_thread(executor):
    """Spin an executor in a daemon thread, and return the thread.

    A failing test then does not block the others.
    """
    thread = threading.Thread(target=executor.spin, daemon=True)
    thread.start()
    return thread


class TestWaiting:
    @both_executors
    def test_timer_is_called(self, kind, node):
        called = threading.Event()
        node.create_timer(0.02, called.set)
        with kind() as executor:
            executor.add_node(node)
            executor.spin_once(timeout_sec=TIMEOUT_S)
            assert called.wait(TIMEOUT_S)

    def test_spin_once_waits_for_timeout(self, executor):
        start = time.monotonic()
        executor.spin_once(timeout_sec=0.05)
        assert time.monotonic() - start >= 0.05

    def test_zero_timeout_does_not_block(self, executor, monkeypatch):
        monkeypatch.setattr(threading.Condition, "wait", lambda *_: pytest.fail("spin_once waits"))
        executor.spin_once(timeout_sec=0)

    def test_zero_timeout_runs_ready_callback(self, node, executor):
        received = []
        node.create_subscription(String, "chatter", received.append, 10)
        node.create_publisher(String, "chatter", 10).publish(String(data="here"))
        executor.spin_once(timeout_sec=0)
        assert [message.data for message in received] == ["here"]

    def test_spin_once_runs_one_callback(self, node, executor):
        received = []
        node.create_subscription(String, "chatter", received.append, 10)
        publisher = node.create_publisher(String, "chatter", 10)
        publisher.publish(String(data="1"))
        publisher.publish(String(data="2"))
        executor.spin_once(timeout_sec=0)
        assert len(received) == 1
        executor.spin_once(timeout_sec=0)
        assert len(received) == 2

    def test_queue_keeps_messages_up_to_qos_depth(self, node, executor):
        received = []
        node.create_subscription(String, "chatter", lambda message: received.append(message.data), 3)
        publisher = node.create_publisher(String, "chatter", 10)
        for number in range(10):
            publisher.publish(String(data=str(number)))
        for _ in range(10):
            executor.spin_once(timeout_sec=0)
        assert received == ["7", "8", "9"]

    def test_added_node_ends_wait(self, graph):
        node = graph.create_node("late")
        called = threading.Event()
        with SingleThreadedExecutor() as executor:
            thread = threading.Thread(target=executor.spin, daemon=True)
            thread.start()
            wait_until(lambda: is_waiting(thread))
            node.create_timer(0.01, called.set)
            executor.add_node(node)
            assert called.wait(TIMEOUT_S)
        thread.join(TIMEOUT_S)
        assert not thread.is_alive()

    def test_message_from_another_thread_ends_wait(self, node, executor):
        received = []
        node.create_subscription(String, "chatter", received.append, 10)
        publisher = node.create_publisher(String, "chatter", 10)
        thread = spin_in_thread(executor)
        wait_until(lambda: is_waiting(thread))  # without a timeout
        publisher.publish(String())
        wait_until(lambda: received)
        executor.shutdown()
        thread.join(TIMEOUT_S)

    def test_waiting_does_not_busy_loop(self, node, executor):
        node.create_timer(10.0, lambda: None)
        assert lines_run(lambda: executor.spin_once(timeout_sec=0.1)) < 1_000

    def test_canceled_timer_is_not_called(self, node, executor):
        called = []
        timer = node.create_timer(0.01, lambda: called.append(1))
        timer.cancel()
        executor.spin_once(timeout_sec=0.05)
        assert called == []

    def test_canceled_timers_leave_no_alarms(self, node, executor):
        timer = node.create_timer(100.0, lambda: None)
        for _ in range(1000):
            timer.reset()
        assert len(executor._work._alarms) < 200


class TestNodes:
    def test_nodes_are_listed(self, graph, node, executor):
        other = graph.create_node("other")
        assert executor.add_node(other) is True
        assert executor.add_node(other) is False
        assert executor.get_nodes() == [node, other]
        executor.remove_node(other)
        assert executor.get_nodes() == [node]

    def test_removed_node_is_not_run(self, node, executor):
        called = []
        node.create_timer(0.01, lambda: called.append(1))
        executor.remove_node(node)
        executor.spin_once(timeout_sec=0.05)
        assert called == []

    def test_pending_callbacks_wait_for_next_executor(self, node, executor):
        received = []
        node.create_subscription(String, "chatter", received.append, 10)
        publisher = node.create_publisher(String, "chatter", 10)
        publisher.publish(String(data="1"))
        executor.remove_node(node)
        publisher.publish(String(data="2"))
        executor.spin_once(timeout_sec=0)
        assert received == []
        with SingleThreadedExecutor() as other:
            other.add_node(node)
            other.spin_once(timeout_sec=0)
            other.spin_once(timeout_sec=0)
        assert [message.data for message in received] == ["1", "2"]

    def test_destroyed_subscription_is_not_run(self, node, executor):
        received = []
        subscription = node.create_subscription(String, "chatter", received.append, 10)
        node.create_publisher(String, "chatter", 10).publish(String())
        node.destroy_subscription(subscription)
        executor.spin_once(timeout_sec=0)
        assert received == []


class TestFaults:
    def test_callback_exception_is_raised_by_spin(self, node, executor):
        def fail():
            raise ValueError("mine")

        node.create_timer(0.01, fail)
        with pytest.raises(ValueError, match="mine"):
            executor.spin()

    def test_threaded_callback_exception_is_raised_by_spin(self, node):
        def fail():
            raise ValueError("mine")

        node.create_timer(0.01, fail)
        with MultiThreadedExecutor(2) as executor:
            executor.add_node(node)
            with pytest.raises(ValueError, match="mine"):
                executor.spin()

    def test_task_exception_is_raised_by_spin(self, executor):
        def fail():
            raise ValueError("mine")

        task = executor.create_task(fail)
        with pytest.raises(ValueError, match="mine"):
            executor.spin_once(timeout_sec=0)
        assert isinstance(task.exception(), ValueError)

    def test_coroutine_exception_after_await_is_raised_by_spin(self, node, executor):
        future = Future()

        async def fail():
            await future
            raise ValueError("mine")

        timer = node.create_timer(0.01, fail)
        executor.spin_once(timeout_sec=TIMEOUT_S)
        timer.cancel()
        future.set_result(None)
        with pytest.raises(ValueError, match="mine"):
            executor.spin_once(timeout_sec=TIMEOUT_S)

    def test_spin_continues_after_exception(self, node, executor):
        received = []

        def receive(message):
            received.append(message.data)
            if message.data == "bad":
                raise ValueError

        node.create_subscription(String, "chatter", receive, 10)
        publisher = node.create_publisher(String, "chatter", 10)
        publisher.publish(String(data="bad"))
        publisher.publish(String(data="good"))
        with pytest.raises(ValueError):
            executor.spin_once(timeout_sec=0)
        executor.spin_once(timeout_sec=0)
        assert received == ["bad", "good"]


class TestShutdown:
    def test_shutdown_ends_spin_in_another_thread(self, node, executor):
        node.create_timer(10_000.0, lambda: None)
        thread = spin_in_thread(executor)
        wait_until(lambda: is_waiting(thread))
        assert executor.shutdown() is True
        thread.join(TIMEOUT_S)
        assert not thread.is_alive()

    def test_shutdown_can_be_called_from_callback(self, node, executor):
        node.create_timer(0.01, executor.shutdown)
        executor.spin()

    def test_shutdown_waits_for_running_callback(self, node, executor):
        has_begun, may_end, ended = threading.Event(), threading.Event(), []

        def work():
            has_begun.set()
            assert may_end.wait(TIMEOUT_S)
            ended.append(1)

        node.create_timer(0.01, work)
        thread = spin_in_thread(executor)
        assert has_begun.wait(TIMEOUT_S)
        assert executor.shutdown(timeout_sec=0.01) is False
        threading.Timer(0.05, may_end.set).start()
        assert executor.shutdown() is True
        assert ended == [1]
        thread.join(TIMEOUT_S)

    def test_shutdown_ends_threads(self, node):
        before = threading.active_count()
        called = threading.Event()
        node.create_timer(0.01, called.set)
        executor = MultiThreadedExecutor(4)
        executor.add_node(node)
        executor.spin_once(timeout_sec=TIMEOUT_S)
        assert called.wait(TIMEOUT_S)
        assert threading.active_count() > before
        assert executor.shutdown() is True
        assert threading.active_count() == before

    @both_executors
    def test_waiting_for_callbacks_after_shutdown_raises(self, kind):
        executor = kind()
        executor.shutdown()
        with pytest.raises(ShutdownException):
            executor.wait_for_ready_callbacks()

    @both_executors
    def test_spin_after_shutdown_returns_immediately(self, kind):
        executor = kind()
        executor.shutdown()
        executor.spin()
        executor.spin_once()
        assert executor.add_node(object()) is False


class TestContext:
    def test_context_shutdown_raises_in_single_threaded_spin(self):
        context = Context()
        executor = SingleThreadedExecutor(context=context)
        threading.Timer(0.05, context.shutdown).start()
        with pytest.raises(ExternalShutdownException):
            executor.spin()

    def test_context_shutdown_ends_multi_threaded_spin(self):
        context = Context()
        executor = MultiThreadedExecutor(2, context=context)
        threading.Timer(0.05, context.shutdown).start()
        executor.spin()
        executor.shutdown()

    def test_context_shutdown_in_callback_ends_spin(self, node):
        context = Context()
        with SingleThreadedExecutor(context=context) as executor:
            executor.add_node(node)
            node.create_timer(0.01, context.shutdown)
            executor.spin()


class TestFutures:
    @both_executors
    def test_spin_until_future_complete_returns_after_result(self, kind):
        future = Future()
        with kind() as executor:
            threading.Timer(0.05, future.set_result, ["done"]).start()
            executor.spin_until_future_complete(future, timeout_sec=TIMEOUT_S)
        assert future.result() == "done"

    @both_executors
    def test_spin_until_future_complete_times_out(self, kind, node):
        node.create_timer(0.003, lambda: None)
        with kind() as executor:
            executor.add_node(node)
            start = time.monotonic()
            executor.spin_until_future_complete(Future(), timeout_sec=0.1)
            assert time.monotonic() - start >= 0.1

    def test_zero_timeout_does_not_block(self, executor):
        future = Future()
        executor.spin_until_future_complete(future, timeout_sec=0)
        assert not future.done()

    def test_negative_timeout_waits_indefinitely(self, executor):
        future = Future()
        threading.Timer(0.05, future.set_result, [1]).start()
        executor.spin_until_future_complete(future, timeout_sec=-1)
        assert future.done()

    def test_canceled_future_ends_wait(self, executor):
        future = Future()
        threading.Timer(0.05, future.cancel).start()
        executor.spin_until_future_complete(future, timeout_sec=TIMEOUT_S)
        assert future.cancelled()

    def test_repeated_waits_leave_one_waiter(self, executor):
        future = Future()
        for _ in range(50):
            executor.spin_until_future_complete(future, timeout_sec=0)
        assert len(future._waiters) == 1

    def test_completed_future_runs_no_callbacks(self, node, executor):
        received = []
        node.create_subscription(String, "chatter", received.append, 10)
        node.create_publisher(String, "chatter", 10).publish(String())
        future = Future()
        future.set_result(None)
        executor.spin_once_until_future_complete(future, timeout_sec=TIMEOUT_S)
        assert received == []


class TestGroups:
    def test_mutually_exclusive_group_runs_one_callback_at_a_time(self, node):
        running, peaks = [], []
        group = MutuallyExclusiveCallbackGroup()

        def work(_message):
            running.append(1)
            peaks.append(len(running))
            time.sleep(0.01)
            running.pop()

        for topic in ("one", "two", "three"):
            node.create_subscription(String, topic, work, 10, callback_group=group)
        publishers = [node.create_publisher(String, topic, 10) for topic in ("one", "two", "three")]
        with MultiThreadedExecutor(4) as executor:
            executor.add_node(node)
            thread = spin_in_thread(executor)
            for publisher in publishers * 5:
                publisher.publish(String())
            wait_until(lambda: len(peaks) == 15)
            executor.shutdown()
            thread.join(TIMEOUT_S)
        assert max(peaks) == 1

    def test_default_group_is_mutually_exclusive(self, node):
        peaks, running = [], []

        def work(_message):
            running.append(1)
            peaks.append(len(running))
            time.sleep(0.01)
            running.pop()

        node.create_subscription(String, "one", work, 10)
        node.create_subscription(String, "two", work, 10)
        publishers = [node.create_publisher(String, topic, 10) for topic in ("one", "two")]
        with MultiThreadedExecutor(4) as executor:
            executor.add_node(node)
            thread = spin_in_thread(executor)
            for publisher in publishers * 5:
                publisher.publish(String())
            wait_until(lambda: len(peaks) == 10)
            executor.shutdown()
            thread.join(TIMEOUT_S)
        assert max(peaks) == 1

    def test_reentrant_group_runs_callback_concurrently(self, node):
        barrier = threading.Barrier(3, timeout=60.0)
        passed = []

        def meet(_message):
            barrier.wait()
            passed.append(1)

        node.create_subscription(String, "chatter", meet, 10, callback_group=ReentrantCallbackGroup())
        publisher = node.create_publisher(String, "chatter", 10)
        with MultiThreadedExecutor(3) as executor:
            executor.add_node(node)
            thread = spin_in_thread(executor)
            for _ in range(3):
                publisher.publish(String())
            wait_until(lambda: len(passed) == 3)
            executor.shutdown()
            thread.join(TIMEOUT_S)

    def test_mutually_exclusive_group_keeps_message_order(self, node):
        received = []
        node.create_subscription(String, "chatter", lambda message: received.append(int(message.data)), 1000)
        publisher = node.create_publisher(String, "chatter", 1000)
        with MultiThreadedExecutor(4) as executor:
            executor.add_node(node)
            thread = spin_in_thread(executor)
            for number in range(500):
                publisher.publish(String(data=str(number)))
            wait_until(lambda: len(received) == 500)
            executor.shutdown()
            thread.join(TIMEOUT_S)
        assert received == list(range(500))

    def test_coroutine_holds_mutually_exclusive_group_until_end(self, node, executor):
        future, order = Future(), []
        group = MutuallyExclusiveCallbackGroup()

        async def first():
            order.append("begins")
            await future
            order.append("ends")

        guard_condition = node.create_guard_condition(first, callback_group=group)
        other = node.create_guard_condition(lambda: order.append("other"), callback_group=group)
        guard_condition.trigger()
        other.trigger()
        for _ in range(3):
            executor.spin_once(timeout_sec=0)
        assert order == ["begins"]
        future.set_result(None)
        for _ in range(3):
            executor.spin_once(timeout_sec=0)
        assert order == ["begins", "ends", "other"]

    def test_nested_spin_runs_other_groups(self, node, executor):
        calls = []
        inner = node.create_guard_condition(lambda: calls.append("inner"), callback_group=ReentrantCallbackGroup())

        def outer():
            inner.trigger()
            executor.spin_once(timeout_sec=TIMEOUT_S)
            calls.append("outer")

        node.create_guard_condition(outer).trigger()
        executor.spin_once(timeout_sec=TIMEOUT_S)
        assert calls == ["inner", "outer"]

    def test_custom_callback_group_decides_execution(self, node, executor):
        class Every(MutuallyExclusiveCallbackGroup):
            allowed = False

            def can_execute(self, entity):
                return self.allowed and super().can_execute(entity)

        group, calls = Every(), []
        guard_condition = node.create_guard_condition(lambda: calls.append(1), callback_group=group)
        guard_condition.trigger()
        executor.spin_once(timeout_sec=0)
        assert calls == []
        group.allowed = True
        executor.wake()
        executor.spin_once(timeout_sec=0)
        assert calls == [1]

    def test_callback_group_knows_members(self, node):
        group = ReentrantCallbackGroup()
        inside = node.create_timer(1.0, lambda: None, callback_group=group)
        outside = node.create_timer(1.0, lambda: None)
        assert group.has_entity(inside)
        assert not group.has_entity(outside)


class TestOwnExecutors:
    def test_ready_callback_has_entity_and_node(self, node, executor):
        received = []
        subscription = node.create_subscription(String, "chatter", received.append, 10)
        node.create_publisher(String, "chatter", 10).publish(String())
        handler, entity, its_node = executor.wait_for_ready_callbacks(timeout_sec=TIMEOUT_S)
        assert (entity, its_node) == (subscription, node)
        assert received == []
        handler()
        assert len(received) == 1
        assert handler.exception() is None

    def test_callback_exception_is_kept_in_handler(self, node, executor):
        def fail():
            raise ValueError("mine")

        node.create_guard_condition(fail).trigger()
        handler, _, _ = executor.wait_for_ready_callbacks(timeout_sec=TIMEOUT_S)
        handler()
        assert str(handler.exception()) == "mine"

    def test_ready_callbacks_can_be_limited_to_nodes(self, graph, node, executor):
        other = graph.create_node("other")
        executor.add_node(other)
        calls = []
        node.create_guard_condition(lambda: calls.append("node")).trigger()
        other.create_guard_condition(lambda: calls.append("other")).trigger()
        handler, _, its_node = executor.wait_for_ready_callbacks(timeout_sec=1.0, nodes=[other])
        assert its_node is other
        handler()
        executor.spin_once(timeout_sec=0)
        assert calls == ["other", "node"]

    def test_wait_end_raises_specific_exception(self, executor):
        with pytest.raises(TimeoutException):
            executor.wait_for_ready_callbacks(timeout_sec=0)
        with pytest.raises(ConditionReachedException):
            executor.wait_for_ready_callbacks(condition=lambda: True)

    def test_base_class_spin_calls_spin_once_repeatedly(self, node):
        class Own(Executor):
            times = 0

            def spin_once(self, timeout_sec=None):
                self.times += 1
                handler, _, _ = self.wait_for_ready_callbacks(timeout_sec=timeout_sec)
                handler()

        with Own() as executor:
            executor.add_node(node)
            node.create_timer(0.005, lambda: executor.times == 3 and executor.shutdown())
            executor.spin()
            assert executor.times == 3

    def test_multi_threaded_executor_warns_about_single_thread(self):
        with pytest.warns(UserWarning, match="single thread"):
            MultiThreadedExecutor(1)
