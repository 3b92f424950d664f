"""The display of an IMU."""

from __future__ import annotations

import math

import numpy as np

from linkwright.messages import get_message
from linkwright.rviz import RvizConfig
from tests.viewer.contents import shown_markers
from tests.viewer.scene import open_world

Imu = get_message("sensor_msgs/msg/Imu")
FILE = """\
Visualization Manager:
  Displays:
    - Acceleration properties:
        Acc. vector scale: 0.1
        Enable acceleration: true
      Axes properties: {Axes scale: 0.5}
      Box properties: {Enable box: true, x_scale: 0.1}
      Class: rviz_imu_plugin/Imu
      Enabled: true
      Name: Imu
      Topic: /imu
  Global Options:
    Fixed Frame: base
"""


def make_imu() -> Imu:
    """Return the message of an IMU that is turned by a quarter about z, in the frame ``sensor``."""
    message = Imu()
    message.header.frame_id = "sensor"
    message.orientation.z = message.orientation.w = math.sqrt(0.5)
    message.linear_acceleration.x = 10.0
    return message


def ends(marker: dict) -> np.ndarray:
    return np.asarray(marker["points"]).reshape(-1, 3)


async def test_imu_is_drawn_at_its_frame_once_the_transform_is_known():
    async with open_world(RvizConfig.parse(FILE)) as world:
        world.move_arm()
        publisher = world.graph.create_node("sensor").create_publisher(Imu, "/imu", 10)
        await world.settle()
        publisher.publish(make_imu())
        await world.settle()
        (display,) = world.viewer.displays
        assert len(display._store) == 0
        quarter = (0, 0, math.sqrt(0.5), math.sqrt(0.5))
        world.move({("base", "sensor"): (1, 2, 3, *quarter)}, static=True)
        await world.settle()
        markers = shown_markers(display)
        assert set(markers) == {"box/0", "axes/0", "axes/1", "axes/2", "acceleration/0"}
        # The orientation is relative to the Fixed Frame: the x axis points along y, and so does the acceleration.
        np.testing.assert_allclose(ends(markers["axes/0"]), [(1, 2, 3), (1, 2.5, 3)], atol=1e-6)
        np.testing.assert_allclose(ends(markers["acceleration/0"]), [(1, 2, 3), (1, 3, 3)], atol=1e-6)
        np.testing.assert_allclose(markers["box/0"]["pose"], (1, 2, 3, *quarter), atol=1e-6)
        np.testing.assert_allclose(markers["box/0"]["scale"], (0.1, 1, 1), atol=1e-6)


async def test_orientation_can_be_relative_to_the_frame_and_acceleration_to_the_sensor():
    async with open_world(RvizConfig.parse(FILE)) as world:
        world.move_arm()
        world.move({("base", "sensor"): (0, 0, 0, 0, 0, 1, 0)}, static=True)
        publisher = world.graph.create_node("sensor").create_publisher(Imu, "/imu", 10)
        await world.settle()
        publisher.publish(make_imu())
        await world.settle()
        (display,) = world.viewer.displays
        display.set_property(("fixed_frame_orientation",), False)
        np.testing.assert_allclose(ends(shown_markers(display)["axes/0"])[1], (0, -0.5, 0), atol=1e-6)
        display.set_property(("Acceleration properties", "Derotate acceleration"), False)
        np.testing.assert_allclose(ends(shown_markers(display)["acceleration/0"])[1], (-1, 0, 0), atol=1e-6)
        display.set_property(("Axes properties", "Enable axes"), False)
        assert set(shown_markers(display)) == {"box/0", "acceleration/0"}


async def test_imu_without_an_orientation_is_drawn_as_its_frame():
    async with open_world(RvizConfig.parse(FILE)) as world:
        world.move_arm()
        world.move({("base", "sensor"): (0, 0, 0, 0, 0, 0, 1)}, static=True)
        publisher = world.graph.create_node("sensor").create_publisher(Imu, "/imu", 10)
        await world.settle()
        message = make_imu()
        message.orientation_covariance[0] = -1.0
        publisher.publish(message)
        await world.settle()
        (display,) = world.viewer.displays
        np.testing.assert_allclose(ends(shown_markers(display)["axes/0"])[1], (0.5, 0, 0), atol=1e-6)
