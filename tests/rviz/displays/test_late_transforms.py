"""Displays of healthy sensors whose transforms arrive after their messages.

The tests check the changes of their status.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from functools import partial
from typing import Any

import pytest

from linkwright.messages import get_message
from linkwright.rviz import RvizConfig
from linkwright.rviz.displays.base.display import ViewerDisplay
from tests.rviz.clouds.test_clouds import make_cloud, make_scan, xyz_array
from tests.skipping import skipping
from tests.viewer.scene import World, open_world

DURATION_S = 10.0
TF_PERIOD_S = 1 / 20

SENSORS = {"LaserScan": 1 / 10, "PointCloud2": 1 / 15, "Odometry": 1 / 50}
"""Displays with the period of their messages, in seconds."""

_DISPLAY = """
    - Class: rviz_default_plugins/{cls}
      Enabled: true
      Name: {cls}
      Topic: {{Value: /{cls}}}"""
FILE = f"""\
Visualization Manager:
  Displays:{"".join(_DISPLAY.format(cls=cls) for cls in SENSORS)}
  Global Options:
    Fixed Frame: odom
"""


def make_message(cls: str, stamp_ns: int) -> Any:
    """Return a driver's message: stamped with the current time, in a moving frame."""
    if cls == "LaserScan":
        instance = make_scan([1.0, 2.0, 3.0])
    elif cls == "PointCloud2":
        instance = make_cloud(xyz_array([(1, 0, 0), (0, 1, 0)]))
    else:
        instance = get_message("nav_msgs/msg/Odometry")()
        instance.pose.pose.orientation.w = 1.0
    instance.header.frame_id = "base"
    instance.header.stamp.sec, instance.header.stamp.nanosec = divmod(stamp_ns, 1_000_000_000)
    return instance


def record_levels(display: ViewerDisplay, monkeypatch: pytest.MonkeyPatch) -> dict[str, list[str]]:
    """Return the successive levels of each row."""
    facts: dict[str, list[str]] = {}
    set_status = display.set_status

    def record(rows: list[Any]) -> None:
        for row in rows:
            levels = facts.setdefault(row.name, [])
            if levels[-1:] != [row.level]:
                levels.append(row.level)
        set_status(rows)

    monkeypatch.setattr(display, "set_status", record)
    return facts


async def call_periodically(period: float, call: Callable[[], object]) -> None:
    for _ in range(round(DURATION_S / period)):
        call()
        await asyncio.sleep(period)


async def publish_robot(world: World, tf_delay: float) -> None:
    """Publish a robot's transforms at 20 Hz, later than the messages of its sensors."""
    driver, now_ns = world.graph.create_node("driver"), world.graph.timebase.now_ns
    publishers = {cls: driver.create_publisher(type(make_message(cls, 0)), f"/{cls}", 10) for cls in SENSORS}
    poses = {("odom", "base"): (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)}
    world.move(poses)
    await world.settle()

    def publish_sensor_message(cls: str) -> None:
        publishers[cls].publish(make_message(cls, now_ns()))

    def move_later() -> None:
        asyncio.get_running_loop().call_later(tf_delay, world.move, poses)

    sensing = (call_periodically(period, partial(publish_sensor_message, cls)) for cls, period in SENSORS.items())
    await asyncio.gather(*sensing, call_periodically(TF_PERIOD_S, move_later))


@skipping
@pytest.mark.parametrize("tf_delay", [0.03, 0.2])
async def test_displays_with_late_transforms_have_ok_status(tf_delay, monkeypatch):
    async with open_world(RvizConfig.parse(FILE)) as world:
        facts = {cls: record_levels(world.display(cls), monkeypatch) for cls in SENSORS}
        await publish_robot(world, tf_delay)
        await world.settle()
        for cls, rows in facts.items():
            assert {"Topic", "Transform"} <= rows.keys(), cls
            assert {name: levels for name, levels in rows.items() if levels != ["ok"]} == {}, cls
            assert world.display(cls).data()
