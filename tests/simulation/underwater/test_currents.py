"""Currents, and services for positions on earth."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from linkwright.messages import get_service
from linkwright.simulation.server.server import ServerOptions
from linkwright.testing import Recording
from tests.simulation.test_plugins import SECOND_NS, running_server

SERVICES = "uuv_world_ros_plugins_msgs/srv"
TOPIC = "/hydrodynamics/current_velocity"


def quantity(tag: str, **values: float) -> str:
    return f"<{tag}>" + "".join(f"<{name}>{value}</{name}>" for name, value in values.items()) + f"</{tag}>"


def current_plugin(*quantities: str) -> str:
    return (
        '<plugin name="current" filename="libuuv_underwater_current_ros_plugin.so"><namespace>hydrodynamics</namespace>'
        f"<constant_current><topic>current_velocity</topic>{''.join(quantities)}</constant_current></plugin>"
    )


async def call(server, graph, name: str, srv_type: str, **fields: float):
    node = graph.create_node(f"client_{server.simulation.time}")
    client = node.create_client(f"{SERVICES}/{srv_type}", name)
    future = client.call_async(get_service(f"{SERVICES}/{srv_type}").Request(**fields))
    await graph.settle()
    server.advance(SECOND_NS // 100)
    await graph.settle()
    return future.result()


async def test_current_has_speed_and_angles():
    plugin = current_plugin(
        quantity("velocity", mean=2, min=0, max=5),
        quantity("horizontal_angle", mean=0.5, min=-3, max=3),
        quantity("vertical_angle", mean=-0.25, min=-3, max=3),
    )
    async with running_server(plugin) as (server, graph, log):
        recording = Recording(graph, server.node, TOPIC)
        await graph.settle()
        server.advance(SECOND_NS)
        await graph.settle()
        linear = recording.last.twist.linear
        expected = 2 * np.array((np.cos(0.5) * np.cos(0.25), np.sin(0.5) * np.cos(0.25), -np.sin(0.25)))
        assert (linear.x, linear.y, linear.z) == pytest.approx(expected)
        assert recording.last.header.frame_id == "world"
        assert len(recording) == 20
        assert not log


async def test_speed_varies_around_its_mean_within_limits():
    plugin = current_plugin(quantity("velocity", mean=1.0, min=0.5, max=2.0, mu=0.9, noiseAmp=0.05))
    async with running_server(plugin, step=0.01) as (server, graph, _):
        recording = Recording(graph, server.node, TOPIC)
        await graph.settle()
        for _ in range(20):
            server.advance(20 * SECOND_NS)
            await graph.settle()
        speeds = np.array([message.twist.linear.x for message in recording])
        assert speeds.min() >= 0.5
        assert speeds.max() <= 2.0
        assert speeds.mean() == pytest.approx(1.0, abs=0.05)
        deviation = 0.05 / np.sqrt(12) / np.sqrt(2 * 0.9 * 0.01)  # of uniform noise in each step
        assert speeds.std() == pytest.approx(deviation, rel=0.15)


@pytest.mark.parametrize(("mistakes", "speed"), [(False, 1.0), (True, 0.0)])
async def test_speed_keeps_its_mean_but_not_in_uuv_simulator(mistakes, speed):
    plugin = current_plugin(quantity("velocity", mean=1.0, min=0.0, max=2.0, mu=0.9))
    async with running_server(plugin, step=0.01, options=ServerOptions(gazebo_mistakes=mistakes)) as (server, graph, _):
        recording = Recording(graph, server.node, TOPIC)
        await graph.settle()
        server.advance(20 * SECOND_NS)
        await graph.settle()
        assert recording.last.twist.linear.x == pytest.approx(speed, abs=1e-3)


async def test_services_get_and_set_current():
    plugin = current_plugin(quantity("velocity", mean=1, min=0, max=5, mu=0.1, noiseAmp=0.0))
    async with running_server(plugin) as (server, graph, log):
        recording = Recording(graph, server.node, TOPIC)
        answer = await call(server, graph, "/hydrodynamics/get_current_velocity_model", "GetCurrentModel")
        assert (answer.mean, answer.min, answer.max, answer.mu, answer.noise) == (1.0, 0.0, 5.0, 0.1, 0.0)
        angle = await call(server, graph, "/hydrodynamics/set_current_horz_angle", "SetCurrentDirection", angle=0.75)
        too_far = await call(server, graph, "/hydrodynamics/set_current_vert_angle", "SetCurrentDirection", angle=3.0)
        assert (angle.success, too_far.success) == (True, False)
        fields = {"mean": 3.0, "min": -1.0, "max": 4.0, "mu": 0.0, "noise": 0.0}
        changed = await call(server, graph, "/hydrodynamics/set_current_velocity_model", "SetCurrentModel", **fields)
        assert changed.success
        server.advance(SECOND_NS // 10)
        await graph.settle()
        linear = recording.last.twist.linear
        assert (linear.x, linear.y) == pytest.approx((3 * np.cos(0.75), 3 * np.sin(0.75)))
        fields = {"velocity": 2.0, "horizontal_angle": 0.0, "vertical_angle": 0.5}
        answer = await call(server, graph, "/hydrodynamics/set_current_velocity", "SetCurrentVelocity", **fields)
        too_fast = await call(
            server, graph, "/hydrodynamics/set_current_velocity", "SetCurrentVelocity", **{**fields, "velocity": 9.0}
        )
        assert (answer.success, too_fast.success) == (True, False)
        server.advance(SECOND_NS // 10)
        await graph.settle()
        assert recording.last.twist.linear.z == pytest.approx(2 * np.sin(0.5))
        server.reset()
        server.advance(SECOND_NS // 10)
        await graph.settle()
        assert recording.last.twist.linear.x == pytest.approx(1.0)
        assert not log


async def test_invalid_process_is_reported():
    async with running_server(current_plugin(quantity("velocity", mean=9, min=0, max=5))) as (_, __, log):
        assert any("<velocity> needs <mean> between <min> and <max>" in record.text for record in log)


async def test_services_convert_positions_on_earth_and_move_the_origin():
    coordinates = (
        "<spherical_coordinates><surface_model>EARTH_WGS84</surface_model><latitude_deg>56</latitude_deg>"
        "<longitude_deg>3</longitude_deg><elevation>10</elevation><heading_deg>0</heading_deg></spherical_coordinates>"
    )
    plugin = '<plugin name="sc" filename="libuuv_sc_ros_interface_plugin.so"/>'
    async with running_server(coordinates, plugin) as (server, graph, log):
        origin = await call(server, graph, "/gazebo/get_origin_spherical_coordinates", "GetOriginSphericalCoord")
        assert (origin.latitude_deg, origin.longitude_deg, origin.altitude) == (56.0, 3.0, 10.0)
        point = get_service(f"{SERVICES}/TransformToSphericalCoord").Request().input
        point.x, point.y, point.z = 100.0, 200.0, -30.0
        there = await call(
            server, graph, "/gazebo/transform_to_spherical_coordinates", "TransformToSphericalCoord", input=point
        )
        meters_per_degree = 6378137.0 * pi / 180
        assert there.latitude_deg == pytest.approx(56 + 200 / meters_per_degree, abs=1e-5)
        assert there.longitude_deg == pytest.approx(3 + 100 / (meters_per_degree * np.cos(np.radians(56))), abs=1e-5)
        back = await call(
            server,
            graph,
            "/gazebo/transform_from_spherical_coordinates",
            "TransformFromSphericalCoord",
            latitude_deg=there.latitude_deg,
            longitude_deg=there.longitude_deg,
            altitude=there.altitude,
        )
        assert (back.output.x, back.output.y, back.output.z) == pytest.approx((100.0, 200.0, -30.0), abs=1e-4)
        fields = {"latitude_deg": 10.0, "longitude_deg": 20.0, "altitude": 5.0}
        answer = await call(
            server, graph, "/gazebo/set_origin_spherical_coordinates", "SetOriginSphericalCoord", **fields
        )
        assert answer.success
        origin = await call(server, graph, "/gazebo/get_origin_spherical_coordinates", "GetOriginSphericalCoord")
        assert origin.latitude_deg == 10.0
        assert not log
