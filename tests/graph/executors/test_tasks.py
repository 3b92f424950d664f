"""Tasks: callables and coroutines that executors run, in turns."""

from __future__ import annotations

import asyncio
import threading

import pytest

from linkwright.graph import Graph
from linkwright.graph.executors import MultiThreadedExecutor, SingleThreadedExecutor, Task
from linkwright.graph.loop.future import Future
from tests.work import lines_run


@pytest.fixture
def executor():
    with SingleThreadedExecutor() as executor:
        yield executor


class TestTaskWithoutExecutor:
    """A task without an executor runs a step at each call."""

    def test_task_runs_callable(self):
        task = Task(lambda word: word.upper(), ("done",))
        assert not task.done()
        task()
        assert task.result() == "DONE"

    def test_task_passes_keyword_arguments(self):
        task = Task(lambda word=None: word, kwargs={"word": "done"})
        task()
        assert task.result() == "done"

    def test_task_runs_coroutine_function_in_steps(self):
        steps = []

        async def work():
            steps.append(1)
            await asyncio.sleep(0)
            steps.append(2)
            return "done"

        task = Task(work)
        task()
        assert (steps, task.done()) == ([1], False)
        task()
        assert (steps, task.result()) == ([1, 2], "done")

    def test_task_runs_coroutine(self):
        async def work():
            return "done"

        task = Task(work())
        task()
        assert task.result() == "done"

    def test_task_runs_callable_returning_coroutine(self):
        async def work():
            return "done"

        task = Task(lambda: work())  # noqa: PLW0108  # a callable that is no coroutine function
        task()
        assert task.result() == "done"

    def test_task_keeps_exception(self):
        def fail():
            raise ValueError("mine")

        task = Task(fail)
        task()
        assert task.done()
        assert str(task.exception()) == "mine"
        with pytest.raises(ValueError, match="mine"):
            task.result()

    def test_task_runs_once(self):
        runs = []
        task = Task(lambda: runs.append(1))
        task()
        task()
        assert runs == [1]

    def test_canceled_task_does_not_run(self):
        runs = []
        task = Task(lambda: runs.append(1))
        task.cancel()
        task()
        assert task.cancelled()
        assert not task.done()
        assert runs == []

    def test_cancel_after_completion_does_nothing(self):
        task = Task(lambda: None)
        task()
        task.cancel()
        assert not task.cancelled()

    def test_cancel_closes_coroutine(self):
        closed = []

        async def work():
            try:
                await Future()
            finally:
                closed.append(1)

        task = Task(work)
        task()
        task.cancel()
        assert closed == [1]

    def test_executing_is_true_while_task_runs(self):
        during = []
        task = Task(lambda: during.append(task.executing()))
        assert not task.executing()
        task()
        assert during == [True]
        assert not task.executing()


class TestTaskInExecutor:
    def test_executor_runs_task_when_spinning(self, executor):
        task = executor.create_task(lambda: "done")
        assert not task.done()
        executor.spin_once(timeout_sec=0)
        assert task.result() == "done"

    def test_tasks_run_in_order_of_creation(self, executor):
        order = []
        for number in range(5):
            executor.create_task(order.append, number)
        for _ in range(5):
            executor.spin_once(timeout_sec=0)
        assert order == [0, 1, 2, 3, 4]

    def test_created_task_ends_wait(self, executor):
        calls = []
        threading.Timer(0.05, executor.create_task, [calls.append, 1]).start()
        executor.spin_once(timeout_sec=60.0)
        assert calls == [1]

    def test_coroutine_waits_for_future(self, executor):
        future = Future()

        async def work():
            return await future

        task = executor.create_task(work)
        executor.spin_once(timeout_sec=0)
        executor.spin_once(timeout_sec=0)
        assert not task.done()
        future.set_result("done")
        executor.spin_once(timeout_sec=0)
        assert task.result() == "done"

    def test_awaiting_future_does_not_busy_loop(self, executor):
        async def work():
            await Future()

        executor.create_task(work)
        executor.spin_once(timeout_sec=0)
        assert lines_run(lambda: executor.spin_once(timeout_sec=0.1)) < 1_000

    def test_future_exception_is_raised_by_await(self, executor):
        future = Future()

        async def work():
            with pytest.raises(ValueError, match="mine"):
                await future
            return "caught"

        task = executor.create_task(work)
        executor.spin_once(timeout_sec=0)
        future.set_exception(ValueError("mine"))
        executor.spin_once(timeout_sec=0)
        assert task.result() == "caught"

    def test_tasks_can_await_each_other(self, executor):
        async def first():
            return 1

        first_task = executor.create_task(first)

        async def second():
            return await first_task + 1

        second_task = executor.create_task(second)
        executor.spin_once(timeout_sec=0)
        executor.spin_once(timeout_sec=0)
        assert (first_task.done(), second_task.done()) == (True, False)
        executor.spin_once(timeout_sec=0)
        assert second_task.result() == 2

    def test_task_can_await_later_task(self, executor):
        later = []

        async def first():
            return await later[0] + 1

        async def second():
            return 1

        first_task = executor.create_task(first)
        later.append(executor.create_task(second))
        executor.spin_until_future_complete(first_task, timeout_sec=60.0)
        assert first_task.result() == 2

    def test_executor_runs_done_callbacks(self, executor):
        order = []
        future = executor.create_future()
        future.add_done_callback(lambda completed: order.append(completed.result()))
        future.set_result("done")
        assert order == []
        executor.spin_once(timeout_sec=0)
        assert order == ["done"]

    def test_deep_chain_of_awaits_completes(self, executor):
        future = Future()

        async def deep(level):
            return await future if level == 0 else await deep(level - 1) + 1

        task = executor.create_task(deep, 100)
        executor.spin_once(timeout_sec=0)
        future.set_result(0)
        executor.spin_until_future_complete(task, timeout_sec=60.0)
        assert task.result() == 100

    def test_coroutine_timer_callback_continues_in_next_step(self, executor):
        graph = Graph(threads=True)
        node = graph.create_node("tested", start_parameter_services=False)
        steps = []

        async def work():
            steps.append(1)
            await asyncio.sleep(0)
            steps.append(2)

        node.create_timer(0.02, work)
        executor.add_node(node)
        executor.spin_once(timeout_sec=60.0)
        assert steps == [1]
        executor.spin_once(timeout_sec=0)
        assert steps == [1, 2]
        graph.close_threadsafe()

    def test_hundred_coroutines_complete_in_four_threads(self):
        futures = [Future() for _ in range(100)]

        async def work(number):
            value = await futures[number]
            await asyncio.sleep(0)
            return value + 1

        with MultiThreadedExecutor(4) as executor:
            tasks = [executor.create_task(work, number) for number in range(100)]
            thread = threading.Thread(target=executor.spin, daemon=True)
            thread.start()
            for number, future in enumerate(futures):
                future.set_result(number)
            for number, task in enumerate(tasks):
                assert task.wait(60.0)
                assert task.result() == number + 1
            executor.shutdown()
            thread.join(60.0)

    async def test_executor_runs_inside_event_loop(self, executor):
        future = Future()

        async def work():
            return await future

        task = executor.create_task(work)
        executor.spin_once(timeout_sec=0)
        future.set_result("done")
        await asyncio.sleep(0)
        executor.spin_once(timeout_sec=0)
        assert task.result() == "done"

    async def test_asyncio_can_await_task(self, executor):
        async def work():
            return "done"

        task = executor.create_task(work)
        waiting = asyncio.ensure_future(_get_result(task))
        await asyncio.sleep(0)
        executor.spin_once(timeout_sec=0)
        assert await waiting == "done"


async def _get_result(task):
    return await task
