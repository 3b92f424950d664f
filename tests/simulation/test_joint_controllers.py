"""Joints that controllers of gz hold or move."""

from __future__ import annotations

import pytest

from linkwright.messages import get_message
from tests.simulation.test_plugins import SECOND_NS, running_server

GRAVITY_TORQUE = 1.0 * 9.81 * 0.5
"""The torque of gravity on the level arm in N m."""


def arm_model(plugin: str, limit: str = "<lower>-2</lower><upper>2</upper>") -> str:
    """Return a level arm of 1 kg on a joint to the world; its center is 0.5 m from the joint."""
    inertia = "<ixx>0.01</ixx><iyy>0.1</iyy><izz>0.1</izz>"
    return (
        '<model name="arm"><pose>0 0 2 0 0 0</pose><link name="link"><inertial><pose>0.5 0 0 0 0 0</pose>'
        f"<mass>1</mass><inertia>{inertia}</inertia></inertial></link>"
        '<joint name="shoulder" type="revolute"><parent>world</parent><child>link</child><axis><xyz>0 1 0</xyz>'
        f"<limit>{limit}</limit></axis></joint>{plugin}</model>"
    )


def position_controller(extra: str) -> str:
    """Return the position controller."""
    return (
        '<plugin name="gz::sim::systems::JointPositionController" filename="gz-sim-joint-position-controller-system">'
        f"<joint_name>shoulder</joint_name>{extra}</plugin>"
    )


def velocity_controller(extra: str = "") -> str:
    """Return the velocity controller."""
    return (
        '<plugin name="gz::sim::systems::JointController" filename="gz-sim-joint-controller-system">'
        f"<joint_name>shoulder</joint_name>{extra}</plugin>"
    )


async def publish_command(graph, server, topic: str, value: float, seconds: float) -> None:
    """Publish a command, and advance the time."""
    node = graph.create_node("commander")
    node.create_publisher("std_msgs/msg/Float64", topic, 10).publish(get_message("std_msgs/msg/Float64")(data=value))
    await graph.settle()
    server.advance(round(seconds * SECOND_NS))
    node.destroy_node()


async def test_position_controller_holds_joint_within_velocity_limit():
    text = arm_model(
        position_controller("<use_velocity_commands>true</use_velocity_commands>"), "<velocity>0.5</velocity>"
    )
    async with running_server(text) as (server, graph, log):
        server.advance(SECOND_NS)
        assert server.simulation.joint_state("arm::shoulder")[0] == pytest.approx(0.0, abs=2e-3)
        await publish_command(graph, server, "/model/arm/joint/shoulder/_0/cmd_pos", 1.0, 1.0)
        angle, speed = server.simulation.joint_state("arm::shoulder")
        assert (angle, speed) == pytest.approx((0.5, 0.5), abs=0.03)
        server.advance(2 * SECOND_NS)
        angle, speed = server.simulation.joint_state("arm::shoulder")
        assert (angle, speed) == pytest.approx((1.0, 0.0), abs=2e-3)
        assert not log


async def test_position_controller_respects_limits_and_reset():
    text = arm_model(position_controller("<use_velocity_commands>1</use_velocity_commands><topic>/reach</topic>"))
    async with running_server(text) as (server, graph, log):
        await publish_command(graph, server, "/reach", 5.0, 3.0)
        assert server.simulation.joint_state("arm::shoulder")[0] == pytest.approx(2.0, abs=2e-3)
        server.reset()
        server.advance(SECOND_NS)
        assert server.simulation.joint_state("arm::shoulder")[0] == pytest.approx(0.0, abs=2e-3)
        assert not log


async def test_position_controller_without_integral_gain_sags_under_gravity():
    gains = "<p_gain>100</p_gain><i_gain>0</i_gain><d_gain>20</d_gain>"
    async with running_server(arm_model(position_controller(gains))) as (server, _, log):
        server.advance(5 * SECOND_NS)
        angle, speed = server.simulation.joint_state("arm::shoulder")
        assert 100.0 * angle == pytest.approx(GRAVITY_TORQUE, rel=0.01)
        assert speed == pytest.approx(0.0, abs=1e-4)
        assert not log


@pytest.mark.parametrize(
    "settings",
    ["", "<use_force_commands>true</use_force_commands><p_gain>50</p_gain><i_gain>200</i_gain><i_max>50</i_max>"],
)
async def test_velocity_controller_reaches_commanded_velocity(settings):
    text = arm_model(velocity_controller(settings), "<lower>-1e16</lower><upper>1e16</upper>").replace("0 1 0", "0 0 1")
    async with running_server(text) as (server, graph, log):
        await publish_command(graph, server, "/model/arm/joint/shoulder/cmd_vel", 1.5, 3.0)
        assert server.simulation.joint_state("arm::shoulder")[1] == pytest.approx(1.5, abs=0.01)
        assert not log


async def test_velocity_controller_holds_level_arm():
    async with running_server(arm_model(velocity_controller())) as (server, _, log):
        server.advance(2 * SECOND_NS)
        assert server.simulation.joint_state("arm::shoulder")[0] == pytest.approx(0.0, abs=2e-3)
        assert not log


async def test_second_joint_axis_is_rejected():
    async with running_server(arm_model(position_controller("<joint_index>1</joint_index>"))) as (server, _, log):
        assert not server.plugins("arm")
        assert [record.text for record in log if "only the first axis" in record.text]


async def test_arm_on_fixed_base_is_held():
    base = '<link name="base"/><joint name="anchor" type="fixed"><parent>world</parent><child>base</child></joint>'
    text = arm_model(position_controller("<use_velocity_commands>true</use_velocity_commands>"))
    text = text.replace("<parent>world</parent>", "<parent>base</parent>").replace("<joint", f"{base}<joint", 1)
    async with running_server(text) as (server, graph, log):
        await publish_command(graph, server, "/model/arm/joint/shoulder/_0/cmd_pos", -1.0, 2.0)
        assert server.simulation.joint_state("arm::shoulder")[0] == pytest.approx(-1.0, abs=2e-3)
        assert not log


async def test_joint_force_acts_until_changed_or_reset():
    plugin = (
        '<plugin name="gz::sim::systems::ApplyJointForce" filename="gz-sim-apply-joint-force-system">'
        "<joint_name>shoulder</joint_name></plugin>"
    )
    text = arm_model(plugin, "<lower>-1e16</lower><upper>1e16</upper>").replace("0 1 0", "0 0 1")
    inertia = 0.1 + 1.0 * 0.5**2
    async with running_server(text) as (server, graph, log):
        await publish_command(graph, server, "/model/arm/joint/shoulder/cmd_force", 0.7, 1.0)
        assert server.simulation.joint_state("arm::shoulder")[1] == pytest.approx(0.7 / inertia, rel=0.01)
        await publish_command(graph, server, "/model/arm/joint/shoulder/cmd_force", -0.7, 1.0)
        assert server.simulation.joint_state("arm::shoulder")[1] == pytest.approx(0.0, abs=0.01)
        server.reset()
        server.advance(SECOND_NS)
        assert server.simulation.joint_state("arm::shoulder") == pytest.approx((0.0, 0.0), abs=1e-6)
        assert not log
