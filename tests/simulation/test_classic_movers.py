"""Plugins of Gazebo Classic that move models: velocities, drives without ROS, and tricycles."""

from __future__ import annotations

from math import cos, pi, sin, tan

import numpy as np
import pytest

from linkwright.control.odometry import get_yaw
from linkwright.messages import get_message
from linkwright.simulation.server.server import ServerOptions
from linkwright.testing import Recording
from tests.simulation.test_movers import drive
from tests.simulation.test_plugins import SECOND_NS, robot, running_server
from tests.simulation.worlds import GROUND, box

RADIUS, SEPARATION = 0.05, 0.26


def block(library: str, parameters: str, pose: str = "0 0 5 0 0 0") -> str:
    plugin = f'<plugin name="mover" filename="{library}">{parameters}</plugin>'
    return box("block", pose, "0.4 0.4 0.2", 5.0).replace("</model>", f"{plugin}</model>")


def wheel(name: str, x: float, y: float, parent: str = "base", joint: str = "", radius: float = 0.1) -> str:
    return f"""
<link name="{name}"><pose>{x} {y} {radius} 0 0 0</pose><inertial><mass>0.5</mass>
  <inertia><ixx>0.002</ixx><iyy>0.002</iyy><izz>0.002</izz></inertia></inertial>
  <collision name="c"><pose>0 0 0 {pi / 2} 0 0</pose>
    <geometry><cylinder><radius>{radius}</radius><length>0.04</length></cylinder></geometry></collision></link>
<joint name="{joint or name}" type="revolute"><parent>{parent}</parent><child>{name}</child>
  <axis><xyz>0 1 0</xyz></axis></joint>"""


BASE = """<link name="base"><pose>0 0 0.15 0 0 0</pose><inertial><mass>10</mass>
  <inertia><ixx>0.3</ixx><iyy>0.3</iyy><izz>0.3</izz></inertia></inertial></link>"""


async def test_initial_velocity_is_set_at_start_and_after_reset():
    parameters = "<linear>1 2 0</linear><angular>0 0 0.5</angular>"
    async with running_server(block("libInitialVelocityPlugin.so", parameters), gravity="0 0 0") as (server, _, log):
        for _ in range(2):
            server.advance(SECOND_NS)
            x, y, z = server.simulation.link_pose("block::link")[:3]
            assert (x, y, z) == pytest.approx((1.0, 2.0, 5.0), abs=1e-3)
            assert get_yaw(server.simulation.model_pose("block")) == pytest.approx(0.5, abs=1e-3)
            server.reset()
        assert not log


async def test_random_velocity_has_speed_and_limits_and_repeats_with_the_seed():
    parameters = (
        "<link>link</link><initial_velocity>0 0.5 0</initial_velocity><velocity_factor>2</velocity_factor>"
        "<update_period>0.5</update_period><min_x>0.1</min_x><max_x>0</max_x><min_z>0</min_z><max_z>0</max_z>"
    )
    runs = []
    async with running_server(block("libRandomVelocityPlugin.so", parameters)) as (server, _, log):
        for _ in range(2):
            server.advance(SECOND_NS // 4)
            first = server.simulation.link_velocity("block::link")[0]
            assert first == pytest.approx((0.0, 0.5, 0.0), abs=0.02)  # gravity acts for one step
            velocities = []
            for _ in range(6):
                server.advance(SECOND_NS // 2)
                velocities.append(server.simulation.link_velocity("block::link")[0].copy())
            runs.append(np.array(velocities))
            server.reset()
        assert not log
    assert runs[0] == pytest.approx(runs[1])
    assert len({tuple(velocity) for velocity in runs[0].round(6)}) == 6
    assert (runs[0][:, 0] >= -1e-6).all()
    assert (runs[0][:, 0] <= 0.1 + 1e-6).all()  # the limits are swapped if the least one is greater
    assert (np.abs(runs[0][:, 1]) <= 2.0).all()


async def test_random_velocity_needs_first_link_of_free_model():
    static = block("libRandomVelocityPlugin.so", "<link>link</link>").replace("<link ", "<static>1</static><link ", 1)
    async with running_server(static) as (_, graph, log):
        await graph.settle()
        assert [record.text for record in log if "fixed to the world" in record.text]


async def command_drive(server, graph, name: str, forward: float, yaw_rate: float, seconds: float) -> None:
    pose = get_message("geometry_msgs/msg/Pose")()
    pose.position.x, pose.orientation.z, pose.orientation.w = forward, sin(yaw_rate / 2), cos(yaw_rate / 2)
    node = graph.create_node("driver")
    node.create_publisher(type(pose), f"/{name}/vel_cmd", 10).publish(pose)
    await graph.settle()
    server.advance(round(seconds * SECOND_NS))
    node.destroy_node()


@pytest.mark.parametrize("mistakes", [False, True])
async def test_drive_of_transport_turns_as_commanded(mistakes):
    plugin = (
        '<plugin name="drive" filename="libDiffDrivePlugin.so"><left_joint>left_joint</left_joint>'
        "<right_joint>right_joint</right_joint></plugin>"
    )
    options = ServerOptions(gazebo_mistakes=mistakes)
    async with running_server(GROUND, robot(plugin), options=options) as (server, graph, log):
        await command_drive(server, graph, "mbot", 0.3, 0.0, 2.0)
        assert server.simulation.model_pose("mbot")[0] == pytest.approx(0.6, abs=0.03)
        yaw = get_yaw(server.simulation.model_pose("mbot"))
        await command_drive(server, graph, "mbot", 0.0, 0.5, 2.0)
        turned = get_yaw(server.simulation.model_pose("mbot")) - yaw
        assert turned == pytest.approx(-1.0 if mistakes else 1.0, abs=0.08)
        assert not log


@pytest.mark.parametrize(("mistakes", "factor"), [(False, 1.0), (True, 2.0)])
async def test_skid_steering_of_transport_sets_speeds_of_wheels(mistakes, factor):
    corners = {
        "left_front": (0.2, 0.2),
        "left_rear": (-0.2, 0.2),
        "right_front": (0.2, -0.2),
        "right_rear": (-0.2, -0.2),
    }
    wheels = "".join(wheel(f"{name}_wheel", x, y, joint=name) for name, (x, y) in corners.items())
    plugin = '<plugin name="drive" filename="libSkidSteerDrivePlugin.so"/>'
    model = f'<model name="rover"><pose>0 0 2 0 0 0</pose>{BASE}{wheels}{plugin}</model>'
    options = ServerOptions(gazebo_mistakes=mistakes)
    async with running_server(model, options=options, gravity="0 0 0") as (server, graph, _):
        await command_drive(server, graph, "rover", 0.5, 0.4, 1.0)
        speeds = {name: server.simulation.joint_state(f"rover::{name}")[1] for name in corners}
        turn = factor * 0.4 * 0.4 / 2
        for name, speed in speeds.items():
            expected = (0.5 + turn if name.startswith("right") else 0.5 - turn) / 0.1
            assert speed == pytest.approx(expected, rel=0.02), name


def tricycle(extra: str = "") -> str:
    fork = """<link name="fork"><pose>0.5 0 0.2 0 0 0</pose><inertial><mass>0.5</mass>
      <inertia><ixx>0.01</ixx><iyy>0.01</iyy><izz>0.01</izz></inertia></inertial></link>
      <joint name="front_steering_joint" type="revolute"><parent>base</parent><child>fork</child>
      <axis><xyz>0 0 1</xyz><limit><lower>-1.57</lower><upper>1.57</upper></limit></axis></joint>"""
    wheels = (
        wheel("front", 0.5, 0.0, "fork", "front_wheel_joint")
        + wheel("left", 0.0, 0.25, joint="left_wheel_joint")
        + wheel("right", 0.0, -0.25, joint="right_wheel_joint")
    )
    sizes = "<actuatedWheelDiameter>0.2</actuatedWheelDiameter><encoderWheelDiameter>0.2</encoderWheelDiameter>"
    plugin = f'<plugin name="drive" filename="libgazebo_ros_tricycle_drive.so">{sizes}{extra}</plugin>'
    return f'<model name="tricycle">{BASE}{fork}{wheels}{plugin}</model>'


@pytest.mark.parametrize("source", ["world", "encoder"])
async def test_tricycle_turns_about_the_point_of_its_steering_angle(source):
    extra = f"<odometrySource>{source}</odometrySource><publishWheelJointState>true</publishWheelJointState>"
    async with running_server(GROUND, tricycle(extra)) as (server, graph, log):
        topics = ("/odom", "/tf", "/joint_states")
        odometry, transforms, states = (Recording(graph, server.node, topic) for topic in topics)
        speed, angle = 0.3, 0.5
        await drive(server, graph, forward=speed, yaw_rate=angle, seconds=1.0)  # the wheel is steered and accelerates
        start = get_yaw(server.simulation.model_pose("tricycle"))
        server.advance(2 * SECOND_NS)
        await graph.settle()
        turned = get_yaw(server.simulation.model_pose("tricycle")) - start
        yaw_rate = speed * sin(angle) / 0.5  # the driven wheel is 0.5 m in front of the other two
        assert turned == pytest.approx(2 * yaw_rate, rel=0.06)
        twist = odometry.last.twist.twist
        assert twist.angular.z == pytest.approx(yaw_rate, rel=0.08)
        assert twist.linear.x == pytest.approx(yaw_rate * 0.5 / tan(angle), rel=0.06)
        assert (odometry.last.header.frame_id, odometry.last.child_frame_id) == ("odom", "base_link")
        assert len(transforms) == len(odometry)
        assert states.last.name == [
            "front_steering_joint",
            "front_wheel_joint",
            "left_wheel_joint",
            "right_wheel_joint",
        ]
        assert states.last.position[0] == pytest.approx(angle, abs=0.02)
        assert states.last.velocity[1] == pytest.approx(speed / 0.1, rel=0.02)
        assert not log


async def test_tricycle_limits_acceleration_and_steering_speed():
    limits = {"wheelAcceleration": 1, "wheelDeceleration": 2, "steeringSpeed": 0.4}
    extra = "".join(f"<{name}>{limit}</{name}>" for name, limit in limits.items())
    async with running_server(GROUND, tricycle(extra)) as (server, graph, _):
        await drive(server, graph, forward=1.0, yaw_rate=0.3, seconds=0.5)
        assert server.simulation.joint_state("tricycle::front_wheel_joint")[1] <= 2 * 0.5 + 0.05
        assert server.simulation.joint_state("tricycle::front_steering_joint")[0] == pytest.approx(0.2, abs=0.03)
        server.advance(SECOND_NS)
        assert server.simulation.joint_state("tricycle::front_steering_joint")[0] == pytest.approx(0.3, abs=0.01)


async def test_odometry_of_pal_has_velocities_in_different_axes():
    parameters = "<bodyName>link</bodyName><topicName>floating_base</topicName><updateRate>100</updateRate>"
    velocities = "<linear>1 0 0</linear><angular>0.3 0 0</angular>"
    motion = f'<plugin name="start" filename="libInitialVelocityPlugin.so">{velocities}</plugin>'
    model = block("libgazebo_world_odometry.so", parameters, f"0 0 5 0 0 {pi / 2}").replace(
        "</model>", f"{motion}</model>"
    )
    async with running_server(model, gravity="0 0 0") as (server, graph, log):
        recording = Recording(graph, server.node, "/floating_base")
        await graph.settle()
        server.advance(SECOND_NS // 2)
        await graph.settle()
        assert len(recording) == 50
        odometry = recording.last
        assert (odometry.header.frame_id, odometry.child_frame_id) == ("world", "link")
        assert odometry.pose.pose.position.x == pytest.approx(0.5, abs=1e-3)
        linear, angular = odometry.twist.twist.linear, odometry.twist.twist.angular
        assert (linear.x, linear.y, linear.z) == pytest.approx((1.0, 0.0, 0.0), abs=1e-3)
        assert (angular.x, angular.y, angular.z) == pytest.approx((0.0, -0.3, 0.0), abs=1e-3)
        assert not log
