"""Drives of gz except the differential drive.

The tests cover cars and mecanum wheels, and the limits of all drives.
"""

from __future__ import annotations

from math import atan, pi

import pytest

from linkwright.control.odometry import get_yaw
from linkwright.messages import get_message
from linkwright.simulation.plugins.limits import SpeedLimits
from linkwright.testing import Recording
from tests.simulation.test_ackermann import TRACK_WIDTH, WHEEL_RADIUS, WHEELBASE, car
from tests.simulation.test_movers import drive
from tests.simulation.test_plugins import SECOND_NS, robot, running_server
from tests.simulation.worlds import GROUND, box

WHEEL = f"<cylinder><radius>{WHEEL_RADIUS}</radius><length>0.05</length></cylinder>"
LENGTH, WIDTH = 0.4, 0.5


def steering_plugin(extra: str = "") -> str:
    """Return the plugin of gz for the car."""
    return (
        '<plugin name="gz::sim::systems::AckermannSteering" filename="gz-sim-ackermann-steering-system">'
        "<left_joint>rear_left_joint</left_joint><right_joint>rear_right_joint</right_joint>"
        "<left_steering_joint>left_steering_joint</left_steering_joint>"
        "<right_steering_joint>right_steering_joint</right_steering_joint>"
        f"<wheel_separation>{TRACK_WIDTH}</wheel_separation><kingpin_width>{TRACK_WIDTH}</kingpin_width>"
        f"<wheel_base>{WHEELBASE}</wheel_base><wheel_radius>{WHEEL_RADIUS}</wheel_radius><steer_p_gain>10</steer_p_gain>"
        f"<topic>cmd_vel</topic><odom_topic>odom</odom_topic><tf_topic>tf</tf_topic>{extra}</plugin>"
    )


def mecanum_robot(extra: str = "", name: str = "robot") -> str:
    """Return a robot of 9 kg with four mecanum wheels and the plugin of gz."""
    text = box(name, "0 0 0.2 0 0 0", "0.6 0.3 0.1", 5.0)
    corners = [(end, side) for end in ("front", "back") for side in ("left", "right")]
    for end, side in corners:
        x, y = (LENGTH / 2 if end == "front" else -LENGTH / 2), (WIDTH / 2 if side == "left" else -WIDTH / 2)
        wheel = (
            f'<link name="{end}_{side}"><pose>{x} {y} -0.1 {pi / 2} 0 0</pose><inertial><mass>1</mass><inertia>'
            "<ixx>0.003</ixx><iyy>0.003</iyy><izz>0.005</izz></inertia></inertial>"
            f'<collision name="collision"><geometry>{WHEEL}</geometry></collision></link>'
            f'<joint name="{end}_{side}_joint" type="revolute"><parent>link</parent><child>{end}_{side}</child>'
            '<axis><xyz expressed_in="__model__">0 1 0</xyz></axis></joint>'
        )
        text = text.replace("</model>", wheel + "</model>")
    names = "".join(f"<{end}_{side}_joint>{end}_{side}_joint</{end}_{side}_joint>" for end, side in corners)
    plugin = (
        f'<plugin name="gz::sim::systems::MecanumDrive" filename="gz-sim-mecanum-drive-system">{names}'
        f"<wheel_separation>{WIDTH}</wheel_separation><wheelbase>{LENGTH}</wheelbase>"
        f"<wheel_radius>{WHEEL_RADIUS}</wheel_radius><topic>cmd_vel</topic><odom_topic>odom</odom_topic>{extra}</plugin>"
    )
    return text.replace("</model>", plugin + "</model>")


def test_speed_limits_apply_to_velocity_acceleration_and_jerk():
    limiter = SpeedLimits(max_velocity=1.0, max_linear_acceleration=2.0, min_acceleration=-4.0).create_limiter("linear")
    assert [limiter.approach(5.0, 0.1) for _ in range(7)] == pytest.approx([0.2, 0.4, 0.6, 0.8, 1.0, 1.0, 1.0])
    assert [limiter.approach(0.0, 0.1) for _ in range(3)] == pytest.approx([0.6, 0.2, 0.0])
    slow = SpeedLimits(max_jerk=10.0, max_linear_velocity=0.1).create_limiter("angular")
    assert [slow.approach(5.0, 0.1) for _ in range(3)] == pytest.approx([0.1, 0.3, 0.6])


async def test_car_drives_commanded_circle_with_correct_odometry():
    async with running_server(GROUND, car(steering_plugin())) as (server, graph, log):
        odometry, transforms = (Recording(graph, server.node, topic) for topic in ("/odom", "/tf"))
        await drive(server, graph, 0.5, yaw_rate=0.3, seconds=2.0)
        begin = get_yaw(server.simulation.model_pose("car"))
        await drive(server, graph, 0.5, yaw_rate=0.3, seconds=1.0)
        pose = server.simulation.model_pose("car")
        assert get_yaw(pose) - begin == pytest.approx(0.3, rel=0.05)
        message = odometry.last
        assert (message.header.frame_id, message.child_frame_id) == ("car/odom", "car/base")
        assert (message.pose.pose.position.x, message.pose.pose.position.y) == pytest.approx(pose[:2], abs=0.05)
        assert message.twist.twist.linear.x == pytest.approx(0.5, abs=0.02)
        assert message.twist.twist.angular.z == pytest.approx(0.3, rel=0.05)
        assert len(odometry) == len(transforms) == 150
        server.reset()
        server.advance(SECOND_NS)
        assert server.simulation.model_pose("car")[:2] == pytest.approx((0.0, 0.0), abs=5e-3)
        assert not log


async def test_car_respects_steering_limit_backward():
    async with running_server(GROUND, car(steering_plugin("<steering_limit>0.3</steering_limit>"))) as (
        server,
        graph,
        log,
    ):
        odometry = Recording(graph, server.node, "/odom")
        await drive(server, graph, -0.5, yaw_rate=5.0, seconds=2.0)
        left, right = (server.simulation.joint_state(f"car::{side}_steering_joint")[0] for side in ("left", "right"))
        radius = WHEELBASE / 0.29552020666133955
        expected = (atan(WHEELBASE / (-radius - TRACK_WIDTH / 2)), atan(WHEELBASE / (-radius + TRACK_WIDTH / 2)))
        assert (left, right) == pytest.approx(expected, abs=0.01)
        assert odometry.last.twist.twist.linear.x == pytest.approx(-0.5, abs=0.02)
        assert odometry.last.twist.twist.angular.z > 0.2
        assert not log


async def test_steering_only_follows_angle():
    steering_only = steering_plugin("<steering_only>true</steering_only>").replace("<topic>cmd_vel</topic>", "")
    async with running_server(GROUND, car(steering_only)) as (server, graph, log):
        node = graph.create_node("driver")
        publisher = node.create_publisher("std_msgs/msg/Float64", "/model/car/steer_angle", 10)
        publisher.publish(get_message("std_msgs/msg/Float64")(data=0.4))
        await graph.settle()
        server.advance(2 * SECOND_NS)
        left, right = (server.simulation.joint_state(f"car::{side}_steering_joint")[0] for side in ("left", "right"))
        assert left > 0.4 > right > 0.3
        assert not log


async def test_car_without_wheel_joints_is_reported():
    none = steering_plugin().replace("<left_joint>rear_left_joint</left_joint>", "")
    async with running_server(GROUND, car(none)) as (server, _, log):
        assert not server.plugins("car")
        assert [
            record.text for record in log if "needs wheel joints on both sides, and positive dimensions" in record.text
        ]


@pytest.mark.parametrize(
    ("command", "displacement"),
    [((0.5, 0.0, 0.0), (0.5, 0.0, 0.0)), ((0.0, 0.5, 0.0), (0.0, 0.5, 0.0)), ((0.0, 0.0, 1.0), (0.0, 0.0, 1.0))],
    ids=["forward", "sideways", "turning"],
)
async def test_mecanum_drive_moves_in_any_direction_with_correct_odometry(command, displacement):
    async with running_server(GROUND, mecanum_robot()) as (server, graph, log):
        odometry = Recording(graph, server.node, "/odom")
        await drive(server, graph, *command, seconds=1.0)
        begin, message = server.simulation.model_pose("robot"), odometry.last.pose.pose.position
        await drive(server, graph, *command, seconds=1.0)
        end, last = server.simulation.model_pose("robot"), odometry.last
        assert end[2] == pytest.approx(0.2, abs=2e-3)
        assert (end[0] - begin[0], end[1] - begin[1], get_yaw(end) - get_yaw(begin)) == pytest.approx(
            displacement, abs=0.01
        )
        position = last.pose.pose.position
        assert (position.x - message.x, position.y - message.y) == pytest.approx(displacement[:2], abs=0.01)
        twist = last.twist.twist
        assert (twist.linear.x, twist.linear.y, twist.angular.z) == pytest.approx(command, abs=0.01)
        assert not log


async def test_mecanum_wheels_turn_oppositely_sideways_and_stop_on_reset():
    async with running_server(GROUND, mecanum_robot("<max_linear_velocity>0.2</max_linear_velocity>")) as (
        server,
        graph,
        log,
    ):
        await drive(server, graph, 0.0, 1.0, seconds=1.0)
        names = ("front_left", "front_right", "back_left", "back_right")
        speeds = [server.simulation.joint_state(f"robot::{name}_joint")[1] * WHEEL_RADIUS for name in names]
        assert speeds == pytest.approx([-0.2, 0.2, 0.2, -0.2], abs=0.01)
        server.reset()
        server.advance(SECOND_NS)
        assert server.simulation.model_pose("robot")[:2] == pytest.approx((0.0, 0.0), abs=2e-3)
        assert not log


async def test_velocity_control_sets_velocity_in_model_frame():
    plugin = (
        '<plugin name="gz::sim::systems::VelocityControl" filename="gz-sim-velocity-control-system">'
        "<initial_linear>0 0 0.5</initial_linear></plugin>"
    )
    text = box("drone", f"0 0 5 0 0 {pi / 2}").replace("</model>", f"{plugin}</model>")
    async with running_server(GROUND, text) as (server, graph, log):
        server.advance(SECOND_NS)
        assert server.simulation.model_pose("drone")[2] == pytest.approx(5.5, abs=0.02)
        twist = get_message("geometry_msgs/msg/Twist")()
        twist.linear.x, twist.angular.z = 0.3, 0.1
        node = graph.create_node("pilot")
        node.create_publisher("geometry_msgs/msg/Twist", "/model/drone/cmd_vel", 10).publish(twist)
        await graph.settle()
        server.advance(SECOND_NS)
        x, y, z, *_ = server.simulation.model_pose("drone")
        assert (x, y, z) == pytest.approx((-0.015, 0.3, 5.5), abs=0.02)
        assert get_yaw(server.simulation.model_pose("drone")) == pytest.approx(pi / 2 + 0.1, abs=1e-3)
        assert not log


async def test_disabled_drive_comes_to_rest():
    plugin = (
        '<plugin name="drive" filename="gz-sim-diff-drive-system"><left_joint>left_joint</left_joint>'
        "<right_joint>right_joint</right_joint><wheel_separation>0.38</wheel_separation>"
        "<wheel_radius>0.06</wheel_radius><topic>cmd_vel</topic><max_acceleration>1</max_acceleration>"
        "<min_acceleration>-1</min_acceleration></plugin>"
    )
    async with running_server(GROUND, robot(plugin)) as (server, graph, log):
        await drive(server, graph, 0.5, seconds=2.0)
        node = graph.create_node("guard")
        publisher = node.create_publisher("std_msgs/msg/Bool", "/model/mbot/enable", 10)
        publisher.publish(get_message("std_msgs/msg/Bool")(data=False))
        await graph.settle()
        server.advance(SECOND_NS)
        begin = server.simulation.model_pose("mbot")[0]
        await drive(server, graph, 0.5, seconds=1.0)
        assert begin > 0.8
        assert server.simulation.model_pose("mbot")[0] - begin == pytest.approx(0.0, abs=2e-3)
        assert not log
