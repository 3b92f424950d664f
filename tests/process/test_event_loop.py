"""Coroutines and Ctrl-C, with the same behavior on every Python."""

from __future__ import annotations

import asyncio
import os
import signal

import pytest

from linkwright.process.event_loop import run_coroutine


def interrupt() -> None:
    os.kill(os.getpid(), signal.SIGINT)
    for _ in range(1000):  # Python raises KeyboardInterrupt here at the latest
        pass


def test_run_coroutine_returns_result() -> None:
    async def seven() -> int:
        return 7

    observed = []
    assert run_coroutine(seven, lambda: observed.append(signal.getsignal(signal.SIGINT))) == 7
    assert observed == [signal.default_int_handler]


def test_ctrl_c_cancels_coroutine_at_next_await() -> None:
    steps = []

    async def work() -> None:
        try:
            interrupt()
            steps.append("not in the middle")
            await asyncio.sleep(60)
            steps.append("never")
        finally:
            await asyncio.sleep(0)
            steps.append("cleaned up")

    with pytest.raises(KeyboardInterrupt):
        run_coroutine(work, lambda: None)
    assert steps == ["not in the middle", "cleaned up"]
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_second_ctrl_c_raises_immediately() -> None:
    async def stubborn() -> None:
        interrupt()
        try:
            await asyncio.sleep(60)
        except asyncio.CancelledError:
            interrupt()
            pytest.fail("the second interrupt was not raised")

    with pytest.raises(KeyboardInterrupt):
        run_coroutine(stubborn, lambda: None)


def test_ctrl_c_before_coroutine_starts_is_raised() -> None:
    async def nothing() -> None:
        pytest.fail("the coroutine must not start")

    with pytest.raises(KeyboardInterrupt):
        run_coroutine(nothing, interrupt)


def test_ctrl_c_after_last_await_is_raised() -> None:
    async def quick() -> int:
        interrupt()
        return 3

    with pytest.raises(KeyboardInterrupt):
        run_coroutine(quick, lambda: None)


def test_existing_sigint_handler_is_kept() -> None:
    texts = []
    before = signal.signal(signal.SIGINT, lambda *_: texts.append("mine"))
    try:

        async def work() -> str:
            interrupt()
            await asyncio.sleep(0)
            return "went on"

        assert run_coroutine(work, lambda: None) == "went on"
    finally:
        signal.signal(signal.SIGINT, before)
    assert texts == ["mine"]


def test_remaining_tasks_are_canceled_before_loop_closes() -> None:
    ended = []

    async def beside() -> None:
        try:
            await asyncio.sleep(60)
        finally:
            ended.append("beside")

    async def work() -> None:
        task = asyncio.ensure_future(beside())
        await asyncio.sleep(0)
        assert not task.done()

    run_coroutine(work, lambda: None)
    assert ended == ["beside"]


def test_own_cancellation_is_not_keyboard_interrupt() -> None:
    async def work() -> None:
        raise asyncio.CancelledError

    with pytest.raises(asyncio.CancelledError):
        run_coroutine(work, lambda: None)
