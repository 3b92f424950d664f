"""Conveyor belts, and vehicles with tracks."""

from __future__ import annotations

from math import pi

import pytest

from linkwright.control.odometry import get_yaw
from linkwright.messages import get_message
from linkwright.testing import Recording
from tests.simulation.test_plugins import SECOND_NS, running_server
from tests.simulation.worlds import GROUND, box

FLOAT = "std_msgs/msg/Float64"
BELT_TOPIC = "/model/conveyor/link/belt/track_cmd_vel"


def conveyor_model(parameters: str = "", pose: str = "0 0 0.1 0 0 0") -> str:
    return (
        f'<model name="conveyor"><static>true</static><pose>{pose}</pose><link name="belt">'
        '<collision name="c"><geometry><box><size>6 1 0.2</size></box></geometry></collision></link>'
        '<plugin name="gz::sim::systems::TrackController" filename="gz-sim-track-controller-system">'
        f"<link>belt</link>{parameters}</plugin></model>"
    )


PARCEL = box("parcel", "0 0 0.3 0 0 0", "0.2 0.2 0.2", 1.0)


async def publish_value(graph, topic: str, value: float, name: str = "operator") -> None:
    publisher = graph.create_node(name).create_publisher(FLOAT, topic, 10)
    publisher.publish(get_message(FLOAT)(data=value))
    await graph.settle()


def model_position(server, name: str) -> tuple[float, ...]:
    return server.simulation.model_pose(name)[:2]


async def test_conveyor_carries_parcel_forward_and_stops():
    async with running_server(conveyor_model(), PARCEL) as (server, graph, log):
        odometry = Recording(graph, server.node, "/model/conveyor/link/belt/odometry")
        server.advance(3 * SECOND_NS)  # the parcel falls asleep
        await publish_value(graph, BELT_TOPIC, 0.5)
        server.advance(2 * SECOND_NS)
        await graph.settle()
        assert model_position(server, "parcel") == pytest.approx((1.0, 0.0), abs=0.05)
        assert odometry.last.pose.pose.position.x == pytest.approx(1.0, abs=0.01)
        assert odometry.last.twist.twist.linear.x == 0.5
        assert not log
        await publish_value(graph, BELT_TOPIC, 0.0, "other")
        server.advance(SECOND_NS // 2)
        assert server.simulation.link_velocity("parcel::link")[0][0] == pytest.approx(0.0, abs=1e-3)


async def test_belt_moves_in_direction_of_turned_link_and_track():
    for parameters, pose in (
        ("", f"0 0 0.1 0 0 {pi / 2}"),
        (f"<track_orientation>0 0 {pi / 2}</track_orientation>", "0 0 0.1 0 0 0"),
    ):
        async with running_server(conveyor_model(parameters, pose), PARCEL) as (server, graph, _):
            await publish_value(graph, BELT_TOPIC, 0.2)
            server.advance(SECOND_NS)
            assert model_position(server, "parcel") == pytest.approx((0.0, 0.2), abs=0.02)


async def test_speed_is_limited_and_command_expires():
    limits = "<max_velocity>0.3</max_velocity><max_acceleration>0.6</max_acceleration>"
    parameters = f"{limits}<max_command_age>1</max_command_age><min_acceleration>-10</min_acceleration>"
    topics = "<velocity_topic>/go</velocity_topic><odometry_topic>/gone</odometry_topic>"
    async with running_server(conveyor_model(parameters + topics)) as (server, graph, _):
        odometry = Recording(graph, server.node, "/gone")
        await publish_value(graph, "/go", 5.0)
        for seconds, speed in ((0.25, 0.15), (0.5, 0.3), (0.5, 0.0)):
            server.advance(round(seconds * SECOND_NS))
            await graph.settle()
            assert odometry.last.twist.twist.linear.x == pytest.approx(speed, abs=0.01)


# --- vehicles ---------------------------------------------------------------------------------------------------------


def _track(side: str, y: float) -> str:
    return (
        f'<link name="{side}"><pose>0 {y} 0 0 0 0</pose><inertial><mass>5</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy>'
        '<izz>0.1</izz></inertia></inertial><collision name="c"><geometry><box><size>0.6 0.1 0.1</size></box>'
        f'</geometry></collision></link><joint name="{side}_joint" type="fixed"><parent>body</parent>'
        f"<child>{side}</child></joint>"
        f'<plugin name="{side}" filename="gz-sim-track-controller-system"><link>{side}</link></plugin>'
    )


def tank_model(extra: str = "", tracks: str = "<left_track><link>left</link></left_track>") -> str:
    plugin = (
        '<plugin name="gz::sim::systems::TrackedVehicle" filename="gz-sim-tracked-vehicle-system">'
        f"{tracks}<right_track><link>right</link></right_track><tracks_separation>0.5</tracks_separation>"
        f"<track_height>0.1</track_height>{extra}</plugin>"
    )
    return (
        '<model name="tank"><pose>0 0 0.05 0 0 0</pose><link name="body"><inertial><mass>10</mass><inertia>'
        "<ixx>0.5</ixx><iyy>0.5</iyy><izz>0.5</izz></inertia></inertial></link>"
        f"{_track('left', 0.25)}{_track('right', -0.25)}{plugin}</model>"
    )


async def drive(server, graph, forward: float, turning: float, seconds: float) -> None:
    """Command a velocity, and advance the time in steps.

    The tracks get their commands between the steps.
    """
    twist = get_message("geometry_msgs/msg/Twist")()
    twist.linear.x, twist.angular.z = forward, turning
    node = graph.create_node("driver")
    node.create_publisher("geometry_msgs/msg/Twist", "/model/tank/cmd_vel", 10).publish(twist)
    for _ in range(round(seconds * 50)):
        await graph.settle()
        server.advance(SECOND_NS // 50)


async def test_vehicle_drives_straight_and_publishes_odometry():
    async with running_server(GROUND, tank_model()) as (server, graph, log):
        odometry = Recording(graph, server.node, "/model/tank/odometry")
        await drive(server, graph, 0.5, 0.0, 2.0)
        await graph.settle()
        assert model_position(server, "tank") == pytest.approx((1.0, 0.0), abs=0.05)
        message = odometry.last
        assert message.pose.pose.position.x == pytest.approx(1.0, abs=0.03)
        assert message.twist.twist.linear.x == pytest.approx(0.5)
        assert (message.header.frame_id, message.child_frame_id) == ("tank/odom", "tank/body")
        assert not log


@pytest.mark.parametrize("turning", [1.0, -1.0])
async def test_vehicle_turns_on_the_spot_with_speed_of_its_tracks(turning):
    async with running_server(GROUND, tank_model()) as (server, graph, _):
        await drive(server, graph, 0.0, turning, 1.0)
        speed = 0.5 / (2 * 0.5) * turning  # of the tracks; their corners are at a distance of 0.42 m from the center
        assert get_yaw(server.simulation.model_pose("tank")) == pytest.approx(speed / 0.42, rel=0.1)
        assert model_position(server, "tank") == pytest.approx((0.0, 0.0), abs=0.02)


async def test_vehicle_drives_arc_around_center_of_rotation():
    async with running_server(GROUND, tank_model()) as (server, graph, _):
        await drive(server, graph, 0.5, 0.5, 1.0)
        assert 0.2 < get_yaw(server.simulation.model_pose("tank")) < 1.2
        x, y = model_position(server, "tank")
        assert x > 0.3
        assert y > 0.02


async def test_limits_and_steering_efficiency():
    limits = "<linear_velocity><max_velocity>0.1</max_velocity></linear_velocity>"
    async with running_server(GROUND, tank_model(limits)) as (server, graph, _):
        await drive(server, graph, 5.0, 0.0, 1.0)
        assert model_position(server, "tank")[0] == pytest.approx(0.1, abs=0.02)
    async with running_server(GROUND, tank_model()) as (server, graph, _):
        speeds = Recording(graph, server.node, "/model/tank/link/right/track_cmd_vel")
        await publish_value(graph, "/model/tank/steering_efficiency", 1.0)
        await drive(server, graph, 0.0, 1.0, 0.1)
        assert speeds.last.data == pytest.approx(0.25)


async def test_missing_track_is_reported():
    async with running_server(GROUND, tank_model(tracks="")) as (_, __, log):
        assert any("<left_track> is missing" in record.text for record in log)


async def test_belt_keeps_its_direction_while_nothing_touches_it():
    async with running_server(conveyor_model(), PARCEL.replace("0 0 0.3", "0 0 1")) as (server, graph, _):
        await publish_value(graph, BELT_TOPIC, 0.5)
        server.advance(2 * SECOND_NS)
        assert model_position(server, "parcel")[0] > 0.6
