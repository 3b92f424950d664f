"""Timers: periods, order, resets and cancellation."""

import asyncio

import pytest

from linkwright.graph import Graph, JumpClock, SystemClock, Time, TimerInfo
from linkwright.messages import String
from linkwright.messages import Time as TimeMessage


async def test_timers_keep_period(graph, clock):
    start = clock.now_ns()
    calls = []
    graph.create_node("node").create_timer(0.1, lambda: calls.append((clock.now_ns() - start) / 1e9))
    await clock.advance(0.35)
    assert calls == pytest.approx([0.1, 0.2, 0.3])
    await clock.advance(0.05)
    assert calls[-1] == pytest.approx(0.4)


async def test_simultaneous_timers_keep_order(graph, clock):
    node = graph.create_node("node")
    calls = []
    for name in "abc":
        node.create_timer(0.1, lambda name=name: calls.append(name))
    await clock.advance(0.2)
    assert calls == list("abcabc")


async def test_messages_of_timer_arrive_before_next_timer(graph, clock):
    node = graph.create_node("node")
    order = []
    publisher = node.create_publisher(String, "topic", 10)
    node.create_subscription(String, "topic", lambda _message: order.append("message"), 10)
    node.create_timer(0.1, lambda: (order.append("timer"), publisher.publish(String())))
    node.create_timer(0.11, lambda: order.append("later"))
    await clock.advance(0.12)
    assert order == ["timer", "message", "later"]


async def test_repeated_reset_sets_one_alarm_per_period(monkeypatch):
    clock = JumpClock()
    alarms = []
    monkeypatch.setattr(
        clock,
        "call_at",
        lambda loop, time_ns, call: (alarms.append(time_ns), JumpClock.call_at(clock, loop, time_ns, call))[1],
    )
    graph = Graph(clock=clock)
    calls = []
    timer = graph.create_node("node").create_timer(0.1, lambda: calls.append(clock.steady_ns() / 1e9))
    for _ in range(100):
        await clock.advance(0.01)
        timer.reset()
    assert calls == []
    assert len(alarms) <= 12
    await clock.advance(0.25)
    assert calls == pytest.approx([1.1, 1.2])
    timer.timer_period_ns = 30_000_000
    timer.reset()
    await clock.advance(0.04)
    assert calls[-1] == pytest.approx(1.28)
    await graph.close()


async def test_canceled_timer_is_silent_until_reset(graph, clock):
    calls = []
    timer = graph.create_node("node").create_timer(0.1, lambda: calls.append(clock.steady_ns()))
    timer.cancel()
    assert timer.is_canceled()
    await clock.advance(1.0)
    assert calls == []
    timer.reset()
    await clock.advance(0.1)
    assert calls == [1_100_000_000]


async def test_reset_restarts_period(graph, clock):
    calls = []
    timer = graph.create_node("node").create_timer(0.1, lambda: calls.append(clock.steady_ns()))
    await clock.advance(0.06)
    timer.reset()
    await clock.advance(0.11)
    assert calls == [160_000_000]
    timer.timer_period_ns = 20_000_000
    timer.reset()
    await clock.advance(0.041)
    assert calls[1:] == [190_000_000, 210_000_000]


async def test_timer_can_cancel_itself_and_fail(graph, clock, log):
    node = graph.create_node("node")
    calls = []

    def once():
        calls.append(1)
        node.destroy_timer(timer)
        raise RuntimeError("broken")

    timer = node.create_timer(0.1, once)
    node.create_timer(0.1, lambda: calls.append(2))
    await clock.advance(0.2)
    assert calls == [1, 2, 2]
    assert log[0].text.startswith("timer callback failed:\nTraceback")


async def test_missed_timer_calls_are_skipped():
    """After several busy periods, the timer is called once, and its phase does not change."""
    clock = JumpClock()
    graph = Graph(clock=clock, on_log=print)
    calls = []
    graph.create_node("node").create_timer(0.1, lambda: calls.append(clock.steady_ns()))
    clock._steady_ns += 350_000_000
    await clock.advance(0.0)
    await clock.advance(0.1)
    assert calls == [350_000_000, 400_000_000]
    await graph.close()


async def test_timer_period_must_not_be_negative(graph):
    node = graph.create_node("node")
    with pytest.raises(ValueError, match="timer period must be non-negative"):
        node.create_timer(-1.0, print)
    timer = node.create_timer(1.0, print)
    with pytest.raises(ValueError, match="timer period must be non-negative"):
        timer.timer_period_ns = -1


async def test_guard_condition_runs_once_for_many_triggers(graph):
    node = graph.create_node("node")
    calls = []
    guard_condition = node.create_guard_condition(lambda: calls.append(1))
    for _ in range(5):
        guard_condition.trigger()
    assert calls == []
    await graph.settle()
    assert calls == [1]
    guard_condition.trigger()
    await graph.settle()
    assert calls == [1, 1]
    guard_condition.trigger()
    node.destroy_node()
    await graph.settle()
    guard_condition.trigger()
    await graph.settle()
    assert calls == [1, 1]


async def test_clock_jump_changes_stamps_but_not_timers(graph, clock):
    node = graph.create_node("node")
    calls = []
    node.create_timer(0.1, lambda: calls.append(1))
    before = node.get_clock().now()
    clock.jump(-5.0)
    assert node.get_clock().now() < before
    assert node.get_clock().now().nanoseconds == before.nanoseconds - 5_000_000_000
    await graph.settle()
    assert calls == []


def test_time_converts_to_message():
    assert Time(nanoseconds=1_700_000_000_123_456_789).to_msg() == TimeMessage(sec=1_700_000_000, nanosec=123_456_789)


async def test_system_timers_neither_drift_nor_run_early():
    graph = Graph(clock=SystemClock(), on_log=print)
    all_called = asyncio.Event()
    calls = []

    def tick(info: TimerInfo):
        calls.append((info.expected_call_time.nanoseconds, info.actual_call_time.nanoseconds))
        if len(calls) == 20:
            all_called.set()

    graph.create_node("node").create_timer(0.005, tick)
    await asyncio.wait_for(all_called.wait(), 5.0)
    await graph.close()
    # A busy machine makes late calls, but each call belongs to a different period that has begun.
    periods = [divmod(expected - calls[0][0], 5_000_000) for expected, _ in calls]
    assert [remainder for _, remainder in periods] == [0] * 20
    assert [period for period, _ in periods] == sorted({period for period, _ in periods})
    assert all(actual >= expected for expected, actual in calls)
