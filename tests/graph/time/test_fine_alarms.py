"""Alarms of an event loop with finer resolution than its own timers."""

from __future__ import annotations

import asyncio
import gc
import os
import time
import weakref

import pytest

from linkwright.graph import SystemClock
from linkwright.graph.time.fine_alarms import FineAlarms, get_fine_alarms
from tests.waiting import eventually

MILLISECOND_NS = 1_000_000


async def alarms() -> FineAlarms:
    fine = get_fine_alarms(asyncio.get_running_loop())
    if fine is None:
        pytest.skip("this system's event loops wait with a resolution of microseconds")
    return fine


async def test_alarms_are_called_in_order_and_never_early():
    fine, now_ns = await alarms(), time.monotonic_ns()
    calls = []
    for late_ns in (3 * MILLISECOND_NS, 400_000, 0, 400_000, -5):
        due_ns = now_ns + late_ns
        fine.call_at(due_ns, lambda due_ns=due_ns: calls.append((due_ns, time.monotonic_ns())))
    assert calls == []
    await eventually(lambda: len(calls) == 5)
    assert [due_ns - now_ns for due_ns, _ in calls] == [-5, 0, 400_000, 400_000, 3 * MILLISECOND_NS]
    assert all(called_ns >= due_ns for due_ns, called_ns in calls)


def test_each_event_loop_has_its_own_alarms():
    async def called() -> None:
        fine, was_called = await alarms(), asyncio.Event()
        fine.call_at(time.monotonic_ns(), was_called.set)
        await asyncio.wait_for(was_called.wait(), 20)

    for _ in range(20):  # most loops get the address of the previous one
        asyncio.run(called())
        gc.collect()


async def test_alarm_canceled_by_earlier_alarm_is_not_called():
    fine, calls, later = await alarms(), [], []

    def cancel():
        later[0].cancel()

    due_ns = time.monotonic_ns()
    fine.call_at(due_ns, cancel)
    later.append(fine.call_at(due_ns, lambda: calls.append("second")))
    fine.call_at(due_ns, lambda: calls.append("third"))
    await eventually(lambda: calls)
    assert calls == ["third"]


async def test_rescheduled_alarm_runs_in_next_loop_iteration():
    fine, calls = await alarms(), []

    def again():
        calls.append("alarm")
        if len(calls) < 9:
            fine.call_at(time.monotonic_ns(), again)
            asyncio.get_running_loop().call_soon(calls.append, "other")

    fine.call_at(time.monotonic_ns(), again)
    await eventually(lambda: len(calls) == 9)
    assert calls == ["alarm", "other"] * 4 + ["alarm"]


async def test_exception_in_alarm_keeps_other_alarms():
    fine, calls = await alarms(), []

    def interrupted():
        raise SystemExit

    due_ns = time.monotonic_ns()
    fine.call_at(due_ns, interrupted)
    fine.call_at(due_ns, lambda: calls.append("next"))
    with pytest.raises(SystemExit):
        fine.run()
    await eventually(lambda: calls)


async def test_short_waits_use_fine_alarms_and_long_waits_the_event_loop():
    await alarms()
    clock, loop = SystemClock(), asyncio.get_running_loop()
    long = clock.call_at(loop, clock.steady_ns() + 1000 * MILLISECOND_NS, lambda: None)
    assert isinstance(long, asyncio.TimerHandle)
    long.cancel()
    short = clock.call_at(loop, clock.steady_ns() + MILLISECOND_NS, lambda: None)
    assert not isinstance(short, asyncio.TimerHandle)


def test_event_loop_without_readers_uses_its_own_timers():
    class Blind(asyncio.SelectorEventLoop):
        def add_reader(self, *_):
            raise NotImplementedError

    loop, calls = Blind(), []
    try:
        assert get_fine_alarms(loop) is None
        clock = SystemClock()
        clock.call_at(loop, clock.steady_ns(), lambda: (calls.append("called"), loop.stop()))
        loop.run_forever()
        assert calls == ["called"]
    finally:
        loop.close()


def test_timer_file_is_closed_with_event_loop(monkeypatch):
    close, closed, watched = os.close, [], []
    monkeypatch.setattr(os, "close", lambda file: (closed.append(file), close(file)))

    class Watching(asyncio.SelectorEventLoop):
        def add_reader(self, file, *call):
            watched.append(file)
            super().add_reader(file, *call)

    loop = Watching()
    loop_reference, is_fine = weakref.ref(loop), get_fine_alarms(loop) is not None
    loop.close()
    del loop
    if not is_fine:
        pytest.skip("this system's event loops wait with a resolution of microseconds")
    gc.collect()
    assert loop_reference() is None
    assert watched
    assert set(watched) <= set(closed)
