"""Mistakes of Gazebo that are reproduced only on request."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from linkwright.messages import get_message
from linkwright.simulation.plugins.sensors.clouds import fill_camera_cloud
from linkwright.simulation.server.server import ServerOptions
from linkwright.testing import Recording
from tests.simulation.test_diff_drive import classic_plugin
from tests.simulation.test_movers import drive, moving_box_model, planar_plugin
from tests.simulation.test_plugins import robot, running_server
from tests.simulation.worlds import GROUND

with_and_without_mistake = pytest.mark.parametrize("with_mistake", [False, True])


@with_and_without_mistake
async def test_backward_velocity_sign_mistake_is_optional(with_mistake):
    options = ServerOptions(gazebo_mistakes=with_mistake)
    async with running_server(GROUND, robot(classic_plugin(source=0)), options=options) as (server, graph, _):
        odometry = Recording(graph, server.node, "/odom")
        await drive(server, graph, -0.3, seconds=2.0)
        message = odometry.last
        assert message.twist.twist.linear.x == pytest.approx(0.3 if with_mistake else -0.3, abs=0.01)
        assert message.pose.pose.position.x < -0.3


@with_and_without_mistake
async def test_p3d_velocity_frame_mistake_is_optional(with_mistake):
    p3d = (
        '<plugin name="p3d" filename="libgazebo_ros_p3d.so"><ros><remapping>odom:=told</remapping></ros>'
        "<body_name>link</body_name><frame_name>frame</frame_name><update_rate>10</update_rate></plugin>"
    )
    frame = f'<link name="frame"><pose>0 0 0 0 0 {pi / 2}</pose></link>'
    joint = '<joint name="held" type="fixed"><parent>world</parent><child>frame</child></joint>'
    text = moving_box_model(planar_plugin() + p3d).replace("</model>", f"{frame}{joint}</model>")
    async with running_server(GROUND, text, options=ServerOptions(gazebo_mistakes=with_mistake)) as (server, graph, _):
        recording = Recording(graph, server.node, "/told")
        await drive(server, graph, 0.5)
        velocity = recording.last.twist.twist.linear
        assert (velocity.x, velocity.y) == pytest.approx((0.0, 0.5 if with_mistake else -0.5), abs=0.01)


@with_and_without_mistake
def test_point_color_mistake_is_optional(with_mistake):
    cloud = get_message("sensor_msgs/msg/PointCloud2")()
    fill_camera_cloud(cloud, np.zeros((1, 1, 3)), np.array([[[1, 2, 3]]], np.uint8), swap_red_blue=with_mistake)
    assert list(bytes(cloud.data)[16:19]) == ([1, 2, 3] if with_mistake else [3, 2, 1])
