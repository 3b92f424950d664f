"""Plugins that move whole robots, in a plane or by skid steering.

They publish the true pose.
"""

from __future__ import annotations

from math import pi

import pytest

from linkwright.control.odometry import get_yaw
from linkwright.messages import get_message
from linkwright.testing import Recording
from tests.simulation.test_plugins import SECOND_NS, robot, running_server
from tests.simulation.worlds import GROUND, box

FRICTIONLESS = "<surface><friction><ode><mu>0</mu><mu2>0</mu2></ode></friction></surface>"


async def drive(server, graph, forward=0.0, sideways=0.0, yaw_rate=0.0, seconds=1.0) -> None:
    """Publish a velocity command, and advance the time."""
    twist = get_message("geometry_msgs/msg/Twist")()
    twist.linear.x, twist.linear.y, twist.angular.z = forward, sideways, yaw_rate
    node = graph.create_node("driver")
    node.create_publisher(get_message("geometry_msgs/msg/Twist"), "/cmd_vel", 10).publish(twist)
    await graph.settle()
    server.advance(round(seconds * SECOND_NS))
    await graph.settle()
    node.destroy_node()


def moving_box_model(plugin: str, pose: str = "0 0 0.1 0 0 0") -> str:
    """Return a box on the ground with a plugin."""
    return box("mbot", pose, "0.4 0.4 0.2", 5.0, FRICTIONLESS).replace("</model>", f"{plugin}</model>")


def planar_plugin(extra: str = "") -> str:
    """Return the plugin of Gazebo classic."""
    return f'<plugin name="move" filename="libgazebo_ros_planar_move.so">{extra}</plugin>'


async def test_planar_move_drives_in_any_direction_with_robot_frame_odometry():
    async with running_server(GROUND, moving_box_model(planar_plugin(), f"0 0 0.1 0 0 {pi / 2}")) as (
        server,
        graph,
        log,
    ):
        odometry, transforms = (Recording(graph, server.node, topic) for topic in ("/odom", "/tf"))
        await drive(server, graph, 0.5, 0.25)
        x, y, _, *_ = server.simulation.model_pose("mbot")
        assert (x, y) == pytest.approx((-0.25, 0.5), abs=2e-3)
        message = odometry.last
        assert len(odometry) == len(transforms) == 20
        assert (message.header.frame_id, message.child_frame_id) == ("odom", "base_footprint")
        assert (message.pose.pose.position.x, message.pose.pose.position.y) == pytest.approx((x, y))
        assert (message.twist.twist.linear.x, message.twist.twist.linear.y) == pytest.approx((0.5, 0.25), abs=1e-3)
        await drive(server, graph, yaw_rate=1.0)
        assert get_yaw(server.simulation.model_pose("mbot")) == pytest.approx(pi / 2 + 1.0, abs=2e-3)
        assert not log


async def test_planar_move_overcomes_wheel_friction_and_resets():
    async with running_server(GROUND, robot(planar_plugin("<update_rate>50</update_rate>"))) as (server, graph, log):
        await drive(server, graph, sideways=0.5)
        assert server.simulation.model_pose("mbot")[1] == pytest.approx(0.5, abs=0.03)
        server.reset()
        server.advance(SECOND_NS)
        assert server.simulation.model_pose("mbot")[:2] == pytest.approx((0.0, 0.0), abs=1e-3)
        assert not log


async def test_planar_move_of_static_model_is_reported():
    text = moving_box_model(planar_plugin()).replace("<link", "<static>true</static><link", 1)
    async with running_server(GROUND, text) as (server, _, log):
        server.advance(SECOND_NS // 10)
        assert not server.plugins("mbot")
        assert [record.text for record in log if "fixed to the world" in record.text]


async def test_skid_steering_accepts_ros_1_parameters():
    plugin = (
        '<plugin name="skid" filename="libgazebo_ros_skid_steer_drive.so"><leftFrontJoint>left_joint</leftFrontJoint>'
        "<leftRearJoint>left_joint</leftRearJoint><rightFrontJoint>right_joint</rightFrontJoint>"
        "<rightRearJoint>right_joint</rightRearJoint><wheelSeparation>0.38</wheelSeparation>"
        "<wheelDiameter>0.12</wheelDiameter><broadcastTF>false</broadcastTF></plugin>"
    )
    async with running_server(GROUND, robot(plugin)) as (server, graph, log):
        odometry, transforms = (Recording(graph, server.node, topic) for topic in ("/odom", "/tf"))
        await drive(server, graph, 0.5, seconds=1.0)
        begin = server.simulation.model_pose("mbot")[0]
        await drive(server, graph, 0.5, seconds=1.0)
        assert server.simulation.model_pose("mbot")[0] - begin == pytest.approx(0.5, abs=0.01)
        assert odometry.last.twist.twist.linear.x == pytest.approx(0.5, abs=0.01)
        assert len(transforms) == 0
        assert not log


async def test_p3d_publishes_pose_in_world_or_other_link_frame():
    def p3d(name: str, extra: str) -> str:
        return (
            f'<plugin name="{name}" filename="libgazebo_ros_p3d.so"><ros><remapping>odom:={name}</remapping></ros>'
            f"<body_name>left_wheel</body_name>{extra}<update_rate>10</update_rate></plugin>"
        )

    plugins = [p3d("truth", "<xyz_offset>0 0 1</xyz_offset>"), p3d("inside", "<frame_name>base_link</frame_name>")]
    async with running_server(GROUND, robot(*plugins, planar_plugin())) as (server, graph, log):
        truth, inside = (Recording(graph, server.node, topic) for topic in ("/truth", "/inside"))
        await drive(server, graph, 0.5)
        link = server.simulation.link_pose("mbot::left_wheel")
        odometry = truth.last
        assert (odometry.header.frame_id, odometry.child_frame_id, len(truth)) == ("world", "left_wheel", 10)
        position = odometry.pose.pose.position
        assert (position.x, position.y, position.z) == pytest.approx((link[0], link[1], link[2] + 1.0), abs=1e-3)
        assert odometry.twist.twist.linear.x == pytest.approx(0.5, abs=0.02)
        position = inside.last.pose.pose.position
        assert (position.x, position.y, position.z) == pytest.approx((0.0, 0.19, -0.05), abs=1e-3)
        assert inside.last.header.frame_id == "base_link"
        assert inside.last.twist.twist.linear.x == pytest.approx(0.0, abs=1e-3)
        assert not log


@pytest.mark.parametrize("dimensions", [2, 3])
async def test_gz_odometry_publisher_matches_model_pose(dimensions):
    plugin = (
        '<plugin name="gz::sim::systems::OdometryPublisher" filename="gz-sim-odometry-publisher-system">'
        f"<odom_frame>odom</odom_frame><dimensions>{dimensions}</dimensions></plugin>"
    )
    async with running_server(
        GROUND, moving_box_model(plugin + planar_plugin("<publish_odom_tf>0</publish_odom_tf>"))
    ) as (
        server,
        graph,
        log,
    ):
        topics = ("/model/mbot/odometry", "/model/mbot/odometry_with_covariance", "/model/mbot/pose")
        odometry, uncertain, transforms = (Recording(graph, server.node, topic) for topic in topics)
        await drive(server, graph, 0.5)
        message = odometry.last
        assert len(odometry) == len(uncertain) == len(transforms) == 50
        assert (message.header.frame_id, message.child_frame_id) == ("odom", "mbot/base_footprint")
        assert message.pose.pose.position.x == pytest.approx(0.5, abs=2e-3)
        assert message.pose.pose.position.z == pytest.approx(0.1 if dimensions == 3 else 0.0, abs=1e-3)
        assert message.twist.twist.linear.x == pytest.approx(0.5, abs=1e-3)
        assert not log
