"""Durations and rates of controllers and hardware, published on ``~/statistics/...``.

Source: controller_manager of ros2_control since Jazzy (topics, names, units: execution times in microseconds,
periodicity in Hz). A deliberate difference: nothing is measured without a subscription; measuring starts within a
second after the first subscription.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from linkwright.control.hardware.timing import Timing
from linkwright.control.manager.manager import ControllerManager
from linkwright.graph.qos.profile import LATCHED_QOS
from linkwright.graph.stepped.node import SteppedNode
from linkwright.messages import get_message

_PACKAGE = "pal_statistics_msgs/msg"


class StatisticsTopics:
    """The topics on which the statistics of a manager are published.

    Args:
        manager: the manager.
        node: the manager's node.
    """

    def __init__(self, manager: ControllerManager, node: SteppedNode) -> None:
        self._manager = manager
        self._full_output = node.publisher(f"{_PACKAGE}/Statistics", "~/statistics/full")
        self._names_output = node.publisher(f"{_PACKAGE}/StatisticsNames", "~/statistics/names", LATCHED_QOS)
        self._values = node.publisher(f"{_PACKAGE}/StatisticsValues", "~/statistics/values")
        self._published_names: list[str] = []
        self._version = 0

    def publish(self) -> None:
        """Publish the statistics, or switch measuring off if there is no subscription.

        The caller is a timer with a period of 1 s.
        """
        has_subscription = self._full_output.is_wanted or self._values.is_wanted
        timings = dict(self._list_timings(enabled=has_subscription))
        if not has_subscription:
            return
        statistics = {f"{name}/{kind}": value for name, timing in timings.items() for kind, value in timing.items()}
        stamp = self._manager.node.get_clock().now().to_msg()
        if list(statistics) != self._published_names:
            self._published_names, self._version = list(statistics), self._version + 1
            names = get_message(f"{_PACKAGE}/StatisticsNames")(names=self._published_names, names_version=self._version)
            names.header.stamp = stamp
            self._names_output.publish(names)
        values: Any = get_message(f"{_PACKAGE}/StatisticsValues")(
            values=list(statistics.values()), names_version=self._version
        )
        values.header.stamp = stamp
        self._values.publish(values)
        if self._full_output.is_wanted:
            statistic_type = get_message(f"{_PACKAGE}/Statistic")
            message = get_message(f"{_PACKAGE}/Statistics")(
                statistics=[statistic_type(name=name, value=value) for name, value in statistics.items()]
            )
            message.header.stamp = stamp
            self._full_output.publish(message)

    def _list_timings(self, *, enabled: bool) -> Iterator[tuple[str, Timing]]:
        """Switch measuring on or off, and yield each timing with the prefix of its name."""
        for name, loaded in self._manager.controllers.items():
            loaded.timing = (loaded.timing or Timing()) if enabled else None
            if loaded.timing is not None:
                yield f"{name}.stats", loaded.timing
        for name, hardware in self._manager.resources.components.items():
            hardware.timings = (hardware.timings or (Timing(), Timing())) if enabled else None
            if hardware.timings is not None:
                for cycle, timing in zip(("read_cycle", "write_cycle"), hardware.timings, strict=True):
                    yield f"{name}.stats/{cycle}", timing
