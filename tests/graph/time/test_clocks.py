"""Times, durations, clocks, simulated time and rates."""

import asyncio
import threading
import time

import pytest

from linkwright.graph import (
    Clock,
    ClockChange,
    ClockType,
    Duration,
    Graph,
    InterruptedWaitError,
    JumpThreshold,
    Parameter,
    ROSClock,
    Time,
    TimeJump,
)
from linkwright.graph.executors import SingleThreadedExecutor
from linkwright.graph.faults import NotInitializedError
from linkwright.graph.time.values import INFINITE
from linkwright.messages import get_message
from tests.waiting import wait_until

ClockMessage = get_message("rosgraph_msgs/msg/Clock")
TimeMessage = get_message("builtin_interfaces/msg/Time")
SECOND_NS = 1_000_000_000


def clock_at(seconds):
    return ClockMessage(clock=TimeMessage(sec=int(seconds), nanosec=round(seconds % 1 * SECOND_NS)))


class TestArithmetic:
    def test_times_and_durations_support_arithmetic(self):
        point = Time(seconds=10, nanoseconds=5, clock_type=ClockType.ROS_TIME)
        assert point.seconds_nanoseconds() == (10, 5)
        assert (point + Duration(seconds=1.5)).nanoseconds == 11_500_000_005
        assert Duration(seconds=1.5) + point == point + Duration(seconds=1.5)
        assert (point - Duration(seconds=10)).nanoseconds == 5
        assert point - Time(seconds=11, clock_type=ClockType.ROS_TIME) == Duration(nanoseconds=5 - SECOND_NS)
        assert Duration(seconds=1) * 2.5 == Duration(seconds=2.5)
        assert Duration(seconds=1) * float("inf") == INFINITE
        assert Duration(seconds=2) - Duration(seconds=1) < Duration(seconds=1.5) <= Duration(seconds=1.5)

    def test_times_and_durations_convert_to_messages(self):
        point = Time(nanoseconds=1_500_000_000, clock_type=ClockType.ROS_TIME)
        assert Time.from_msg(point.to_msg()) == point
        span = Duration(seconds=-0.25)
        assert Duration.from_msg(span.to_msg()) == span
        assert (span.to_msg().sec, span.to_msg().nanosec) == (-1, 750_000_000)
        with pytest.raises(TypeError, match=r"builtin_interfaces\.msg\.Time"):
            Time.from_msg(span.to_msg())

    def test_clock_types_do_not_mix(self):
        ros, system = Time(seconds=1, clock_type=ClockType.ROS_TIME), Time(seconds=1)
        with pytest.raises(TypeError, match="Can't compare times with different clock types"):
            assert ros == system
        with pytest.raises(TypeError, match="Can't subtract times with different clock types"):
            ros - system
        with pytest.raises(TypeError):
            ros + system
        with pytest.raises(TypeError, match="Clock type must be a ClockType enum"):
            Time(clock_type="ros")

    @pytest.mark.parametrize("value", [Time(seconds=1), Duration(seconds=1)])
    def test_comparison_with_other_types_depends_on_distribution(self, value, monkeypatch):
        monkeypatch.setenv("ROS_DISTRO", "jazzy")
        assert value != 1
        assert not value == 1  # noqa: SIM201  # another method
        monkeypatch.setenv("ROS_DISTRO", "humble")
        with pytest.raises(TypeError, match=r"Can't compare .* with object of type: <class 'int'>"):
            assert value == 1
        with pytest.raises(TypeError, match="Can't compare"):
            assert value != 1

    def test_negative_times_and_overflows_are_rejected(self):
        with pytest.raises(ValueError, match="must not be negative"):
            Time(seconds=-1)
        with pytest.raises(OverflowError):
            Time(seconds=2**40)
        with pytest.raises(ValueError, match="negative time"):
            Time(seconds=1) - Duration(seconds=2)
        assert str(INFINITE) == "Infinite"
        assert repr(Time(nanoseconds=1)) == "Time(nanoseconds=1, clock_type=SYSTEM_TIME)"


class TestClocks:
    def test_clock_type_selects_clock(self):
        assert isinstance(Clock(clock_type=ClockType.ROS_TIME), ROSClock)
        assert repr(Clock(clock_type=ClockType.STEADY_TIME)) == "Clock(clock_type=STEADY_TIME)"
        assert abs(Clock().now().nanoseconds - time.time_ns()) < SECOND_NS
        assert Clock(clock_type=ClockType.STEADY_TIME).now().clock_type is ClockType.STEADY_TIME
        with pytest.raises(TypeError):
            Clock(clock_type=3)

    def test_simulated_time_stops_until_set(self):
        clock = ROSClock()
        assert not clock.ros_time_is_active
        clock.set_ros_time_override(Time(seconds=5, clock_type=ClockType.ROS_TIME))
        assert clock.now().nanoseconds > 10**18
        clock.set_ros_time_is_active(True)
        assert clock.now() == Time(seconds=5, clock_type=ClockType.ROS_TIME)

    def test_clock_jumps_are_reported(self):
        clock = ROSClock()
        messages = []
        clock.create_jump_callback(
            JumpThreshold(min_forward=Duration(seconds=1), min_backward=Duration(seconds=-0.5)),
            pre_callback=lambda: messages.append("before"),
            post_callback=messages.append,
        )
        other = clock.create_jump_callback(
            JumpThreshold(min_forward=None, min_backward=None), post_callback=lambda jump: messages.append("other")
        )
        clock.set_ros_time_override(Time(seconds=10, clock_type=ClockType.ROS_TIME))
        clock.set_ros_time_is_active(True)
        assert messages[0] == "before"
        assert messages[1].clock_change is ClockChange.ROS_TIME_ACTIVATED
        assert messages[2] == "other"
        messages.clear()
        for seconds in (10.5, 12.0, 11.8, 11.0):
            clock.set_ros_time_override(Time(seconds=seconds, clock_type=ClockType.ROS_TIME))
        assert messages == [
            "before",
            TimeJump(ClockChange.ROS_TIME_NO_CHANGE, Duration(seconds=1.5)),
            "before",
            TimeJump(ClockChange.ROS_TIME_NO_CHANGE, Duration(nanoseconds=-800_000_000)),
        ]
        other.unregister()
        clock.set_ros_time_is_active(False)
        assert messages[-1].clock_change is ClockChange.ROS_TIME_DEACTIVATED

    def test_jump_thresholds_require_signs(self):
        with pytest.raises(ValueError, match="min_forward must be a positive"):
            JumpThreshold(min_forward=Duration(), min_backward=None)
        with pytest.raises(ValueError, match="min_backward must be a negative"):
            JumpThreshold(min_forward=None, min_backward=Duration(seconds=1))
        with pytest.raises(ValueError, match="At least one"):
            JumpThreshold(min_forward=None, min_backward=None, on_clock_change=False)
        with pytest.raises(ValueError, match="must be callable"):
            ROSClock().create_jump_callback(JumpThreshold(min_forward=None, min_backward=None))

    def test_sleep_for_and_sleep_until_wait(self):
        clock = Clock(clock_type=ClockType.STEADY_TIME)
        start = clock.now()
        assert clock.sleep_for(Duration(seconds=0.02))
        assert clock.now() - start >= Duration(seconds=0.02)
        assert clock.sleep_until(start)
        with pytest.raises(ValueError, match="clock type"):
            clock.sleep_until(Time(seconds=1))

    def test_sleep_ends_on_context_shutdown(self):
        class Ending:
            def __init__(self):
                self.looks = 0

            def ok(self):
                self.looks += 1
                return self.looks < 3

        assert not Clock().sleep_for(Duration(seconds=60), Ending())

    def test_sleep_requires_context(self):
        class Over:
            def ok(self):
                return False

        with pytest.raises(NotInitializedError):
            Clock().sleep_for(Duration(seconds=60), Over())
        clock = Clock()
        clock.context = Over()
        with pytest.raises(NotInitializedError):
            clock.sleep_for(Duration(seconds=60))

    def test_sleep_follows_simulated_time(self):
        clock = ROSClock()
        clock.set_ros_time_is_active(True)
        slept = []
        wake_time = Time(seconds=5, clock_type=ClockType.ROS_TIME)
        thread = threading.Thread(target=lambda: slept.append(clock.sleep_until(wake_time)))
        thread.start()
        clock.set_ros_time_override(Time(seconds=4, clock_type=ClockType.ROS_TIME))
        thread.join(0.05)
        assert slept == []
        clock.set_ros_time_override(wake_time)
        thread.join(60.0)
        assert slept == [True]


@pytest.fixture
def simulated_time(graph):
    """Return a node with simulated time, and a function that sets that time."""
    node = graph.create_node("simulated", parameters={"use_sim_time": True})
    publisher = graph.create_node("simulator").create_publisher(ClockMessage, "/clock", 10)
    return node, lambda seconds: publisher.publish(clock_at(seconds))


class TestSimulatedTime:
    async def test_clock_follows_clock_topic(self, simulated_time):
        node, set_time = simulated_time
        assert node.get_clock().ros_time_is_active
        assert node.get_clock().now().nanoseconds == 0
        set_time(12.5)
        assert node.get_clock().now() == Time(seconds=12.5, clock_type=ClockType.ROS_TIME)
        set_time(3)
        assert node.get_clock().now_ns() == 3 * SECOND_NS

    async def test_use_sim_time_can_be_set_later(self, graph):
        node = graph.create_node("node")
        publisher = graph.create_node("simulator").create_publisher(ClockMessage, "/clock", 10)
        assert publisher.get_subscription_count() == 0
        node.set_parameters([Parameter("use_sim_time", value=True)])
        publisher.publish(clock_at(7))
        assert node.get_clock().now_ns() == 7 * SECOND_NS
        node.set_parameters([Parameter("use_sim_time", value=False)])
        assert publisher.get_subscription_count() == 0
        assert node.get_clock().now_ns() == graph.clock.now_ns()

    async def test_timers_follow_simulated_time(self, graph, simulated_time, clock):
        node, set_time = simulated_time
        set_time(100)
        calls = []
        node.create_timer(1.0, lambda: calls.append(node.get_clock().now_ns() / SECOND_NS))
        await clock.advance(60.0)
        assert calls == []
        for seconds in (100.5, 101.0, 101.9, 102.1, 105.5, 106.0):
            set_time(seconds)
            await graph.settle()
        assert calls == [101.0, 102.1, 105.5, 106.0]

    async def test_time_jump_back_keeps_timers(self, graph, simulated_time):
        node, set_time = simulated_time
        set_time(100)
        calls = []
        timer = node.create_timer(1.0, lambda: calls.append(node.get_clock().now_ns() / SECOND_NS))
        slow_timer = node.create_timer(50.0, lambda: calls.append("once"))
        set_time(101)
        await graph.settle()
        set_time(5)
        assert timer.time_until_next_call() == SECOND_NS
        assert slow_timer.time_until_next_call() == 50 * SECOND_NS
        for seconds in (5.9, 6.0, 7.0):
            set_time(seconds)
            await graph.settle()
        assert calls == [101.0, 6.0, 7.0]
        set_time(55)
        await graph.settle()
        assert calls[3:] == [55.0, "once"]

    async def test_timers_keep_remaining_period_when_switching_to_simulated_time(self, graph, clock):
        node = graph.create_node("node")
        publisher = graph.create_node("simulator").create_publisher(ClockMessage, "/clock", 10)
        calls = []
        timer = node.create_timer(1.0, lambda: calls.append(1))
        await clock.advance(0.4)
        node.set_parameters([Parameter("use_sim_time", value=True)])
        await clock.advance(10.0)
        assert calls == []
        assert timer.time_until_next_call() == 600_000_000
        publisher.publish(clock_at(0.5))
        node.set_parameters([Parameter("use_sim_time", value=False)])
        await clock.advance(0.05)
        assert calls == []
        await clock.advance(0.1)
        assert calls == [1]

    async def test_steady_timers_ignore_simulated_time(self, graph, simulated_time, clock):
        node, set_time = simulated_time
        calls = []
        steady = Clock(clock_type=ClockType.STEADY_TIME, timebase=graph.timebase)
        node.create_timer(1.0, lambda: calls.append(1), clock=steady)
        set_time(1000)
        await graph.settle()
        assert calls == []
        await clock.advance(2.0)
        assert calls == [1, 1]

    async def test_use_sim_time_must_be_boolean(self, graph, log):
        node = graph.create_node("node")
        (result,) = node.set_parameters([Parameter("use_sim_time", value="yes")])
        assert not result.successful
        assert not node.get_clock().ros_time_is_active

    async def test_rates_follow_simulated_time(self, graph, simulated_time):
        node, set_time = simulated_time
        set_time(10)
        rate = node.create_rate(2.0)
        turns = []

        async def work():
            for _ in range(3):
                await rate.wait()
                turns.append(node.get_clock().now_ns() / SECOND_NS)

        task = asyncio.ensure_future(work())
        await graph.settle()
        for seconds in (10.4, 10.5, 11.2, 11.5):
            set_time(seconds)
            await graph.settle()
            await asyncio.sleep(0)
        assert turns == [10.5, 11.2, 11.5]
        await task

    async def test_simulated_time_ends_with_node(self, graph, simulated_time):
        node, set_time = simulated_time
        calls = []
        node.create_timer(1.0, lambda: calls.append(1))
        node.destroy_node()
        set_time(100)
        await graph.settle()
        assert calls == []


class TestRates:
    def test_rate_sleeps_while_another_thread_spins(self):
        graph = Graph(threads=True, on_log=print)
        node = graph.create_node("node")
        rate = node.create_rate(100.0)
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        thread = threading.Thread(target=executor.spin)
        thread.start()
        start = time.monotonic()
        for _ in range(3):
            rate.sleep()
        assert time.monotonic() - start >= 0.019
        executor.shutdown()
        thread.join(60.0)
        graph.close_threadsafe()
        with pytest.raises(InterruptedWaitError):
            rate.sleep()

    def test_sleep_of_a_node_that_another_executor_took_is_reported(self, monkeypatch):
        monkeypatch.setattr("linkwright.graph.loop.timer._MAX_QUIET_WAIT_S", 0.05)
        records = []
        graph = Graph(threads=True, on_log=records.append)
        node = graph.create_node("node")
        rate, owner, taker = node.create_rate(100.0), SingleThreadedExecutor(), SingleThreadedExecutor()
        owner.add_node(node)
        owner_thread = threading.Thread(target=owner.spin)
        owner_thread.start()
        rate.sleep()
        assert records == []
        taker.add_node(node)  # as rclpy.spin_once(node) does
        taker.remove_node(node)
        sleeper = threading.Thread(target=rate.sleep)
        sleeper.start()
        wait_until(lambda: records, 60.0)
        assert "no executor runs the callbacks of this node" in records[0].text
        owner.add_node(node)
        sleeper.join(60.0)
        assert not sleeper.is_alive()
        owner.shutdown()
        owner_thread.join(60.0)
        graph.close_threadsafe()

    def test_node_destruction_ends_rate_sleep(self):
        graph = Graph(threads=True, on_log=print)
        node = graph.create_node("node")
        rate = node.create_rate(0.001)
        raised = []

        def sleep():
            with pytest.raises(InterruptedWaitError):
                rate.sleep()
            raised.append(True)

        thread = threading.Thread(target=sleep)
        thread.start()
        graph.close_threadsafe()
        thread.join(60.0)
        assert raised == [True]

    async def test_rate_must_be_positive(self, graph):
        with pytest.raises(ValueError, match="must be > 0"):
            graph.create_node("node").create_rate(0.0)
