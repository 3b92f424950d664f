"""Futures: results, errors, cancellation and threads."""

import asyncio
import threading

import pytest

from linkwright.graph import Future
from linkwright.graph.loop.future import StepsByExecutor


def test_future_returns_result():
    future, received = Future(), []
    future.add_done_callback(received.append)
    assert not future.done()
    assert future.result() is None
    future.set_result(3)
    assert (future.done(), future.cancelled(), future.ended()) == (True, False, True)
    assert future.result() == 3
    assert future.exception() is None
    future.add_done_callback(received.append)
    assert received == [future, future]


def test_future_raises_exception():
    future = Future()
    future.set_exception(ValueError("no"))
    assert future.done()
    with pytest.raises(ValueError, match="no"):
        future.result()
    assert isinstance(future.exception(), ValueError)


def test_unretrieved_exception_is_reported(capsys):
    future = Future()
    future.set_exception(ValueError("lost"))
    del future
    assert capsys.readouterr().err == "The following exception was never retrieved: lost\n"


def test_future_can_be_canceled():
    future, received = Future(), []
    future.add_done_callback(received.append)
    future.cancel()
    future.cancel()
    assert (future.done(), future.cancelled(), future.ended()) == (False, True, True)
    assert received == [future]
    completed = Future()
    completed.set_result(1)
    completed.cancel()
    assert not completed.cancelled()


def test_done_callbacks_can_be_removed():
    future, received = Future(), []
    future.add_done_callback(received.append)
    assert future.remove_done_callback(received.append) == 1
    assert future.remove_done_callback(received.append) == 0
    future.set_result(1)
    assert received == []


def test_executor_runs_done_callbacks():
    tasks = []

    class Executor:
        def create_task(self, callback, *arguments):
            tasks.append((callback, arguments))

    future = Future(executor=Executor())
    future.add_done_callback(print)
    future.set_result(1)
    assert tasks == [(print, (future,))]


async def test_future_can_be_awaited():
    future = Future()
    asyncio.get_running_loop().call_later(0.001, future.set_result, 5)
    assert await future == 5
    assert await future == 5


async def test_future_completed_by_another_thread_resumes_await():
    future = Future()
    threading.Timer(0.01, future.set_result, [7]).start()
    assert await asyncio.wait_for(_return_value(future), 5.0) == 7


async def test_task_awaiting_future_can_be_canceled():
    future = Future()
    task = asyncio.ensure_future(_return_value(future))
    await asyncio.sleep(0)
    task.cancel()
    with pytest.raises(asyncio.CancelledError):
        await task
    future.set_result(1)
    await asyncio.sleep(0)


async def _return_value(future):
    return await future


async def test_executor_steps_coroutine_inside_event_loop():
    """In rclpy's executors, a coroutine yields the future that it awaits."""
    future = Future()
    coroutine = _return_value(future)
    with StepsByExecutor():
        assert coroutine.send(None) is future
        future.set_result(4)
        with pytest.raises(StopIteration) as ended:
            coroutine.send(None)
    assert ended.value.value == 4


def test_thread_can_wait_for_future():
    future = Future()
    assert not future.wait(0.01)
    threading.Timer(0.01, future.set_result, [1]).start()
    assert future.wait(60.0)
