"""Diagnostics of nodes: ``diagnostic_updater``."""

from __future__ import annotations

import diagnostic_updater
import pytest
import rclpy
from diagnostic_msgs.msg import DiagnosticStatus
from diagnostic_updater import (
    CompositeDiagnosticTask,
    DiagnosedPublisher,
    DiagnosticStatusWrapper,
    FrequencyStatus,
    FrequencyStatusParam,
    FunctionDiagnosticTask,
    Heartbeat,
    TimeStampStatus,
    TimeStampStatusParam,
    TopicDiagnostic,
    Updater,
)
from rclpy.time import Time
from sensor_msgs.msg import Imu

from linkwright.standins.diagnostic_api import tasks
from linkwright.testing import SteppedGraph

OK, WARN, ERROR = DiagnosticStatus.OK, DiagnosticStatus.WARN, DiagnosticStatus.ERROR


@pytest.fixture
def graph():
    with SteppedGraph() as stepped:
        stepped.init_rclpy()
        yield stepped


@pytest.fixture
def clock(monkeypatch):
    """A time in seconds, in a list, in the place of the computer's time."""
    seconds = [100.0]

    class Clock:
        def now(self):
            return Time(nanoseconds=round(seconds[0] * 1e9))

    monkeypatch.setattr(tasks, "ROSClock", Clock)
    return seconds


def report(level, message):
    """Return a function of a task that always reports the same."""

    def run(stat):
        stat.summary(level, message)
        stat.add("key", message)
        return stat

    return run


def run(task):
    stat = task.run(DiagnosticStatusWrapper())
    return stat.level, stat.message, {pair.key: pair.value for pair in stat.values}


class TestStatus:
    @pytest.mark.parametrize(("first", "second", "merged"), [
        ((OK, "a"), (OK, "b"), (OK, "a; b")),
        ((OK, ""), (OK, "b"), (OK, "b")),
        ((OK, "a"), (WARN, "b"), (WARN, "b")),
        ((WARN, "a"), (OK, "b"), (WARN, "a")),
        ((ERROR, "a"), (WARN, "b"), (ERROR, "a; b")),
    ])  # fmt: skip
    def test_merged_summary_keeps_higher_level(self, first, second, merged):
        stat = DiagnosticStatusWrapper(level=first[0], message=first[1])
        stat.mergeSummary(*second)
        assert (stat.level, stat.message) == merged
        other = DiagnosticStatusWrapper()
        other.summary(stat)
        assert (other.level, other.message) == merged
        other.clearSummary()
        assert (other.level, other.message) == (OK, "")

    def test_wrapper_is_a_status(self):
        stat = DiagnosticStatusWrapper(name="n")
        stat.add("a", "b")
        assert isinstance(stat, DiagnosticStatus)
        assert (stat.name, stat.values[0].key, stat.values[0].value) == ("n", "a", "b")
        with pytest.raises(TypeError, match="3 arguments"):
            stat.summary(OK, "a", "b")


class TestTasks:
    def test_composite_task_merges_summaries_and_joins_values(self):
        composite = CompositeDiagnosticTask("both")
        composite.addTask(FunctionDiagnosticTask("a", report(WARN, "warm")))
        composite.addTask(FunctionDiagnosticTask("b", report(ERROR, "hot")))
        stat = composite.run(DiagnosticStatusWrapper())
        assert (composite.getName(), stat.level, stat.message) == ("both", ERROR, "warm; hot")
        assert [pair.value for pair in stat.values] == ["warm", "hot"]

    def test_heartbeat_is_alive(self):
        assert run(Heartbeat())[:2] == (OK, "Alive")

    @pytest.mark.parametrize(("events", "level", "message"), [
        (0, ERROR, "No events recorded."), (4, WARN, "Frequency too low."), (9, OK, "Desired frequency met"),
        (22, OK, "Desired frequency met"), (23, WARN, "Frequency too high."),
    ])  # fmt: skip
    def test_frequency_may_be_beyond_bounds_by_tolerance(self, clock, events, level, message):
        status = FrequencyStatus(FrequencyStatusParam({"min": 10, "max": 20}, 0.1, 2))
        for _ in range(events):
            status.tick()
        clock[0] += 1.0
        found_level, found_message, values = run(status)
        assert (found_level, found_message) == (level, message)
        assert values["Actual frequency (Hz)"] == f"{events:.6f}"
        assert values["Minimum acceptable frequency (Hz)"] == "9.000000"
        assert values["Maximum acceptable frequency (Hz)"] == "22.000000"

    def test_frequency_is_averaged_over_window_of_reports(self, clock):
        status = FrequencyStatus(FrequencyStatusParam({"min": 5, "max": 5}, window_size=2))
        counts = []
        for events in (4, 6, 2):
            for _ in range(events):
                status.tick()
            clock[0] += 1.0
            values = run(status)[2]
            counts.append((values["Events in window"], values["Duration of window (s)"]))
        assert counts == [("4", "1.000000"), ("10", "2.000000"), ("8", "2.000000")]
        assert (values["Events since startup"], values["Target frequency (Hz)"]) == ("12", "5.000000")
        status.clear()
        assert run(status)[:2] == (ERROR, "No events recorded.")

    @pytest.mark.parametrize(("stamp", "level", "message"), [
        (102.0, ERROR, "Timestamps too far in future seen."), (99.0, OK, "Timestamps are reasonable."),
        (94.0, ERROR, "Timestamps too far in past seen."), (Time(seconds=98), OK, "Timestamps are reasonable."),
    ])  # fmt: skip
    def test_age_of_timestamps_is_checked(self, clock, stamp, level, message):
        status = TimeStampStatus()
        assert run(status)[:2] == (WARN, "No data since last update.")
        status.tick(stamp)
        assert run(status)[:2] == (level, message)
        assert run(status)[:2] == (WARN, "No data since last update.")

    def test_timestamps_of_zero_and_errors_are_counted(self, clock):
        status = TimeStampStatus(TimeStampStatusParam(0.0, 1.0))
        for _ in range(2):
            status.tick(0.0)
            status.tick(95.0)
            level, message, values = run(status)
        assert (level, message) == (ERROR, "Zero timestamp seen.")
        assert values["Late diagnostic update count:"] == values["Zero seen diagnostic update count:"] == "2"
        assert values["Early diagnostic update count:"] == "0"
        assert values["Latest timestamp delay:"] == "5.000000"


class TestUpdater:
    def test_statuses_of_all_tasks_are_published_each_period(self, graph):
        node = rclpy.create_node("driver")
        arrays = graph.record("/diagnostics")
        updater = Updater(node)
        updater.setHardwareID("motor-7")
        updater.add("left", report(OK, "fine"))
        updater.add(FunctionDiagnosticTask("right", report(WARN, "warm")))
        graph.settle()
        assert [(array.status[0].name, array.status[0].message) for array in arrays] == [
            ("driver: left", "Node starting up"), ("driver: right", "Node starting up")]  # fmt: skip
        graph.advance(2.0)
        assert len(arrays) == 4
        assert [(status.name, status.level, status.message, status.hardware_id) for status in arrays.last.status] == [
            ("driver: left", OK, "fine", "motor-7"), ("driver: right", WARN, "warm", "motor-7")]  # fmt: skip
        assert arrays.last.header.stamp.sec > 0

    def test_removed_task_is_not_published(self, graph):
        updater = Updater(rclpy.create_node("driver"))
        arrays = graph.record("/diagnostics")
        updater.add("left", report(ERROR, "broken"))
        assert updater.removeByName("left")
        assert not updater.removeByName("left")
        updater.force_update()
        graph.settle()
        assert list(arrays.last.status) == []

    def test_broadcast_has_one_message_for_all_tasks(self, graph):
        updater = Updater(rclpy.create_node("driver"))
        arrays = graph.record("/diagnostics")
        updater.add("left", report(OK, "fine"))
        updater.add("right", report(OK, "fine"))
        updater.broadcast(ERROR, "shutting down")
        graph.settle()
        assert [(status.level, status.message) for status in arrays.last.status] == [(ERROR, "shutting down")] * 2

    def test_parameters_set_period_and_full_name(self):
        with SteppedGraph() as graph:
            parameters = ["-p", "diagnostic_updater.period:=0.5", "-p", "diagnostic_updater.use_fqn:=true"]
            graph.init_rclpy(["--ros-args", *parameters])
            updater = Updater(rclpy.create_node("driver", namespace="arm"))
            arrays = graph.record("/diagnostics")
            updater.add("left", report(OK, "fine"))
            graph.advance(2.0)
            assert len(arrays) == 5
            assert arrays.last.status[0].name == "/arm/driver: left"
            assert updater.period == 0.5
            updater.period = 1.0
            graph.advance(2.0)
            assert len(arrays) == 7

    def test_missing_hardware_id_is_logged_once_all_is_ok(self, graph):
        updater = Updater(rclpy.create_node("driver"))
        level = WARN

        def run_task(stat):
            return report(level, "x")(stat)

        updater.add("left", run_task)
        graph.advance(2.0)
        assert not [record for record in graph.log if "No HW_ID was set" in record.text]
        level = OK
        graph.advance(3.0)
        assert len([record for record in graph.log if "No HW_ID was set" in record.text]) == 1

    def test_verbose_updater_logs_statuses_that_are_not_ok(self, graph):
        updater = Updater(rclpy.create_node("driver"))
        updater.verbose = True
        updater.add("left", report(ERROR, "broken"))
        updater.force_update()
        assert any("Name: left, status b'\\x02': broken" in record.text for record in graph.log)

    def test_task_that_returns_nothing_is_named(self, graph):
        updater = Updater(rclpy.create_node("driver"))
        updater.add("left", lambda stat: None)
        with pytest.raises(TypeError, match="'left' must return the status"):
            updater.force_update()

    def test_published_topic_is_checked(self, graph, clock):
        node = rclpy.create_node("driver")
        updater = Updater(node)
        arrays = graph.record("/diagnostics")
        publisher = DiagnosedPublisher(
            node.create_publisher(Imu, "imu", 10), updater, FrequencyStatusParam({"min": 1}), TimeStampStatusParam()
        )
        received = graph.record("/imu")
        message = Imu()
        message.header.stamp = Time(seconds=90).to_msg()
        publisher.publish(message)
        clock[0] += 0.5
        updater.force_update()
        graph.settle()
        assert len(received) == 1
        (status,) = arrays.last.status
        assert status.name == "driver: /imu topic status"
        assert (status.level, status.message) == (ERROR, "Timestamps too far in past seen.")
        assert isinstance(publisher, TopicDiagnostic)
        publisher.clear_window()
        updater.force_update()
        graph.settle()
        assert arrays.last.status[0].message == "No events recorded.; No data since last update."


def test_submodules_are_those_of_the_package():
    from diagnostic_updater._publisher import HeaderlessTopicDiagnostic

    assert diagnostic_updater.HeaderlessTopicDiagnostic is HeaderlessTopicDiagnostic
