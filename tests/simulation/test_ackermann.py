"""Cars with the plugin of Gazebo classic."""

from __future__ import annotations

from math import tan

import pytest

from linkwright.control.odometry import get_yaw
from linkwright.testing import Recording
from tests.simulation.test_movers import drive
from tests.simulation.test_plugins import SECOND_NS, running_server
from tests.simulation.worlds import GROUND

WHEEL_RADIUS, WHEELBASE, TRACK_WIDTH = 0.1, 0.6, 0.4


def _link(name: str, x: float, y: float, z: float, mass: float, shape: str = "", roll: float = 0.0) -> str:
    moment_of_inertia = mass * 0.005
    collision = (
        f'<collision name="collision"><geometry>{shape}</geometry><surface><friction><ode><mu>1</mu><mu2>1</mu2></ode>'
        "</friction></surface></collision>"
    )
    return (
        f'<link name="{name}"><pose>{x} {y} {z} {roll} 0 0</pose><inertial><mass>{mass}</mass>'
        f"<inertia><ixx>{moment_of_inertia}</ixx><iyy>{moment_of_inertia}</iyy><izz>{moment_of_inertia}</izz></inertia></inertial>"
        f"{collision if shape else ''}</link>"
    )


def _joint(name: str, parent: str, child: str, axis: str, limit: float) -> str:
    return (
        f'<joint name="{name}" type="revolute"><parent>{parent}</parent><child>{child}</child><axis>'
        f'<xyz expressed_in="__model__">{axis}</xyz><limit><lower>{-limit}</lower><upper>{limit}</upper></limit></axis>'
        "</joint>"
    )


def car(plugin: str, wheel: str = f"<cylinder><radius>{WHEEL_RADIUS}</radius><length>0.05</length></cylinder>") -> str:
    """Return a car of 12.4 kg whose frame is between its rear wheels."""
    parts = [_link("base", 0.0, 0.0, 0.15, 4.0), _link("load", WHEELBASE / 2, 0.0, 0.15, 4.0)]
    parts.append('<joint name="fixed" type="fixed"><parent>base</parent><child>load</child></joint>')
    for side, y in (("left", TRACK_WIDTH / 2), ("right", -TRACK_WIDTH / 2)):
        parts += [
            _link(f"{side}_knuckle", WHEELBASE, y, WHEEL_RADIUS, 0.2),
            _link(f"{side}_front", WHEELBASE, y, WHEEL_RADIUS, 1.0, wheel, 1.570796326794897),
            _link(f"{side}_rear", 0.0, y, WHEEL_RADIUS, 1.0, wheel, 1.570796326794897),
            _joint(f"{side}_steering_joint", "base", f"{side}_knuckle", "0 0 1", 0.8),
            _joint(f"front_{side}_joint", f"{side}_knuckle", f"{side}_front", "0 1 0", 1e16),
            _joint(f"rear_{side}_joint", "base", f"{side}_rear", "0 1 0", 1e16),
        ]
    return f'<model name="car">{"".join(parts)}{plugin}</model>'


def plugin(extra: str = "") -> str:
    """Return the plugin with the default names of the joints."""
    return (
        '<plugin name="car" filename="libgazebo_ros_ackermann_drive.so"><publish_odom>true</publish_odom>'
        f"<publish_distance>true</publish_distance>{extra}</plugin>"
    )


async def test_car_drives_straight_with_correct_odometry():
    async with running_server(GROUND, car(plugin())) as (server, graph, log):
        odometry, distance = (Recording(graph, server.node, topic) for topic in ("/odom", "/distance"))
        await drive(server, graph, 0.5)
        begin = server.simulation.model_pose("car")
        await drive(server, graph, 0.5, seconds=2.0)
        end = server.simulation.model_pose("car")
        assert end[0] - begin[0] == pytest.approx(1.0, abs=0.02)
        assert end[1] == pytest.approx(0.0, abs=0.01)
        assert odometry.last.twist.twist.linear.x == pytest.approx(0.5, abs=0.01)
        assert distance.last.data == pytest.approx(end[0], abs=0.01)
        assert not log


@pytest.mark.parametrize("forward", [0.5, -0.5])
async def test_car_turns_according_to_steering(forward):
    async with running_server(GROUND, car(plugin())) as (server, graph, log):
        await drive(server, graph, forward, yaw_rate=0.3, seconds=2.0)
        begin = get_yaw(server.simulation.model_pose("car"))
        await drive(server, graph, forward, yaw_rate=0.3, seconds=1.0)
        yaw = get_yaw(server.simulation.model_pose("car")) - begin
        assert yaw == pytest.approx(0.5 * tan(0.3) / WHEELBASE, rel=0.05)
        left, right = (server.simulation.joint_state(f"car::{side}_steering_joint")[0] for side in ("left", "right"))
        assert abs(left - right) > 0.01
        server.reset()
        server.advance(SECOND_NS)
        assert server.simulation.model_pose("car")[:2] == pytest.approx((0.0, 0.0), abs=5e-3)
        assert not log


async def test_wheel_without_round_collision_is_reported():
    async with running_server(GROUND, car(plugin(), "<box><size>0.2 0.2 0.05</size></box>")) as (server, _, log):
        assert not server.plugins("car")
        assert [record.text for record in log if "needs a collision that is a cylinder or a sphere" in record.text]
