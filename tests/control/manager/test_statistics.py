"""The manager's ~/statistics: the durations of controllers and hardware, for subscribers."""

from __future__ import annotations

from math import sqrt

import pytest

from linkwright.control.hardware.timing import Timing
from linkwright.graph.qos.profile import DurabilityPolicy, QoSProfile
from tests.control.manager.test_ros2_control_node import CONTROL, advance, call_service, start_manager_node

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def test_timing_statistics():
    timing = Timing()
    for time_ns in (0, 10_000_000, 20_000_000, 40_000_000):
        timing.measure(lambda *_: None, time_ns, 0.01)
    values_by_name = dict(timing.items())
    assert values_by_name["periodicity/sample_count"] == 2.0
    assert (values_by_name["periodicity/min"], values_by_name["periodicity/max"]) == pytest.approx((50.0, 100.0))
    assert values_by_name["periodicity/average"] == pytest.approx(75.0)
    assert values_by_name["periodicity/standard_deviation"] == pytest.approx(sqrt(625.0))
    assert values_by_name["periodicity/current_value"] == pytest.approx(50.0)
    assert values_by_name["execution_time/sample_count"] == 4.0
    assert values_by_name["execution_time/min"] >= 0.0


async def test_statistics_are_published_each_second_to_subscribers(graph, clock, tmp_path, monkeypatch):
    monkeypatch.setenv("ROS_DISTRO", "jazzy")
    node_under_test = start_manager_node(graph, tmp_path, CONTROL)
    node = graph.create_node("test_node")
    assert (await call_service(graph, node, "load_controller", name="broadcaster")).ok
    assert (await call_service(graph, node, "configure_controller", name="broadcaster")).ok
    assert (await call_service(graph, node, "switch_controller", activate_controllers=["broadcaster"], strictness=2)).ok
    await advance(graph, clock, 150)
    controller = node_under_test._manager.controllers["broadcaster"]
    assert controller.timing is None
    value_messages, statistics_messages, name_messages = [], [], []
    message_type = "pal_statistics_msgs/msg/Statistics"
    value_subscription = node.create_subscription(
        f"{message_type}Values", "/controller_manager/statistics/values", value_messages.append, 10
    )
    node.create_subscription(
        f"{message_type}Names", "/controller_manager/statistics/names", name_messages.append, LATCHED
    )
    full_subscription = node.create_subscription(
        message_type, "/controller_manager/statistics/full", statistics_messages.append, 10
    )
    await advance(graph, clock, 250)
    assert controller.timing is not None
    assert len(name_messages) == 1
    assert len(name_messages[0].names) == len(value_messages[-1].values)
    assert name_messages[0].names_version == value_messages[-1].names_version == 1
    values_by_name = {statistic.name: statistic.value for statistic in statistics_messages[-1].statistics}
    assert values_by_name["broadcaster.stats/periodicity/average"] == pytest.approx(100.0)
    assert values_by_name["broadcaster.stats/execution_time/sample_count"] >= 99.0
    assert values_by_name["arm.stats/read_cycle/periodicity/average"] == pytest.approx(100.0)
    assert values_by_name["arm.stats/write_cycle/execution_time/min"] >= 0.0
    node.destroy_subscription(value_subscription)
    node.destroy_subscription(full_subscription)
    await advance(graph, clock, 150)
    assert controller.timing is None


async def test_humble_has_no_statistics_topics(graph, tmp_path, monkeypatch):
    monkeypatch.setenv("ROS_DISTRO", "humble")
    start_manager_node(graph, tmp_path, CONTROL)
    assert not [name for name, _ in graph.get_topic_names_and_types() if "statistics" in name]
