"""Models that a force and a torque move along waypoints."""

from __future__ import annotations

from math import pi

import pytest

from linkwright.messages import get_message
from tests.simulation.fluids.server import running_server, weightless_server
from tests.simulation.test_plugins import SECOND_NS
from tests.simulation.worlds import box

PAUSE = "/model/cart/trajectory_follower/pause"


def cart_model(parameters: str, pose: str = "0 0 0.1 0 0 0") -> str:
    plugin = (
        '<plugin name="gz::sim::systems::TrajectoryFollower" filename="gz-sim-trajectory-follower-system">'
        f"<link_name>link</link_name>{parameters}</plugin>"
    )
    return box("cart", pose, "0.4 0.4 0.2", 5.0).replace("</model>", f"{plugin}</model>")


def waypoint_elements(*points: str) -> str:
    return f"<waypoints>{''.join(f'<waypoint>{point}</waypoint>' for point in points)}</waypoints>"


def measure_wrench(server) -> list[float]:
    """Return the force and the torque on the cart, after one step."""
    server.advance(SECOND_NS // 100)
    return server.simulation.data.body("cart::link").xfrc_applied.tolist()


async def test_torque_turns_cart_toward_waypoint_before_force_pushes_it():
    for pose, expected in (
        ("0 0 0 0 0 0", [60.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
        ("0 0 0 0 0 0.5", [0.0, 0.0, 0.0, 0.0, 0.0, -50.0]),
        ("0 0 0 0 0 -0.5", [0.0, 0.0, 0.0, 0.0, 0.0, 50.0]),
        ("5 2 0 0 0 -1.5707963", [0.0, -60.0, 0.0, 0.0, 0.0, 0.0]),
    ):
        async with weightless_server(cart_model(waypoint_elements("5 0"), pose)) as (server, _, log):
            assert measure_wrench(server) == pytest.approx(expected, abs=1e-5)
            assert not log


async def test_force_torque_and_tolerances_are_parameters():
    parameters = "<force>3</force><torque>7</torque><bearing_tolerance>30</bearing_tolerance>"
    async with weightless_server(cart_model(waypoint_elements("5 0") + parameters, "0 0 0 0 0 0.5")) as (server, _, __):
        assert measure_wrench(server)[0] == pytest.approx(3.0 * 0.8776, rel=1e-3)
    async with weightless_server(cart_model(waypoint_elements("5 0") + parameters, "0 0 0 0 0 0.6")) as (server, _, __):
        assert measure_wrench(server)[5] == -7.0
    tolerance = "<range_tolerance>6</range_tolerance>"
    async with weightless_server(cart_model(waypoint_elements("5 0") + tolerance)) as (server, _, __):
        assert measure_wrench(server) == [0.0] * 6


async def test_cart_visits_waypoints_in_turn_and_returns_with_loop():
    for loop, expected in (("", 0.0), ("<loop>true</loop>", 1.0)):
        text = cart_model(waypoint_elements("0.2 0", "-0.2 0", "5 0") + loop)
        async with weightless_server(text) as (server, _, __):
            assert measure_wrench(server)[0] == measure_wrench(server)[0] == 0.0  # both waypoints are reached
            assert measure_wrench(server)[0] == 60.0
            server.simulation.set_model_pose("cart", (4.8, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0))
            measure_wrench(server)
            measure_wrench(server)
            has_torque = measure_wrench(server)[5] != 0.0  # toward the first waypoint, behind the cart
            assert float(has_torque) == expected


async def test_line_and_circle_are_relative_to_initial_pose():
    line = "<line><direction>0</direction><length>5</length></line>"
    async with weightless_server(cart_model(line, f"1 2 0 0 0 {pi / 2}")) as (server, _, __):
        measure_wrench(server)  # the first waypoint is the initial position
        assert measure_wrench(server)[:2] == pytest.approx([0.0, 60.0], abs=1e-9)
    async with weightless_server(cart_model("<circle><radius>2</radius></circle>", "1 2 0 0 0 0")) as (server, _, __):
        assert measure_wrench(server)[0] == 60.0
        server.simulation.set_model_pose("cart", (3.0, 2.0, 0.0, 0.0, 0.0, 0.0, 1.0))
        measure_wrench(server)
        assert measure_wrench(server)[5] == 50.0  # the next waypoint is 45 degrees farther on the circle


async def test_message_pauses_cart():
    async with weightless_server(cart_model(waypoint_elements("5 0"))) as (server, graph, _):
        publisher = graph.create_node("operator").create_publisher("std_msgs/msg/Bool", PAUSE, 10)
        for is_paused in (True, False):
            publisher.publish(get_message("std_msgs/msg/Bool")(data=is_paused))
            await graph.settle()
            assert measure_wrench(server)[0] == (0.0 if is_paused else 60.0)


async def test_turning_stops_when_cart_faces_waypoint():
    text = cart_model(waypoint_elements("5 0") + "<zero_vel_on_bearing_reached>true</zero_vel_on_bearing_reached>")
    async with weightless_server(text) as (server, _, __):
        server.simulation.set_model_velocity("cart", (0.5, 0.0, 0.0), (0.0, 0.0, 1.0))
        measure_wrench(server)
        linear, angular = server.simulation.link_velocity("cart::link")
        assert angular == pytest.approx([0.0] * 3, abs=1e-9)
        assert linear[0] == pytest.approx(0.5)


async def test_waypoint_that_is_not_two_numbers_is_reported():
    async with running_server(cart_model(waypoint_elements("5 0 0"))) as (_, __, log):
        assert any("<waypoint> needs two numbers" in record.text for record in log)
