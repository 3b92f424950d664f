"""Tasks for boats: states, release, collisions and scores."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from linkwright.messages import get_message
from linkwright.simulation.plugins.boats.tasks import Goal
from linkwright.testing import Recording
from tests.simulation.boats.boat import boat
from tests.simulation.fluids.server import weightless_server
from tests.simulation.test_plugins import SECOND_NS

EQUATOR = (
    "<spherical_coordinates><surface_model>EARTH_WGS84</surface_model><latitude_deg>0</latitude_deg>"
    "<longitude_deg>10</longitude_deg><elevation>0</elevation><heading_deg>0</heading_deg></spherical_coordinates>"
)
EAST_10_M = 10 + 10 / (6378137.0 * pi / 180)
"""The longitude 10 m east of the origin."""
DURATIONS = (
    "<initial_state_duration>2</initial_state_duration><ready_state_duration>3</ready_state_duration>"
    "<running_state_duration>10</running_state_duration>"
)


def task(name: str, parameters: str) -> str:
    return (
        f'<plugin name="vrx::{name}ScoringPlugin" filename="lib{name}ScoringPlugin.so"><vehicle>boat</vehicle>'
        f"<task_name>test</task_name>{DURATIONS}{parameters}</plugin>"
    )


def values_of(message) -> dict[str, object]:
    fields = {1: "bool_value", 2: "integer_value", 3: "double_value", 4: "string_value"}
    return {item.name: getattr(item.value, fields[item.value.type]) for item in message.params}


async def advance(server, graph, seconds: float) -> None:
    server.advance(round(seconds * SECOND_NS))
    await graph.settle()


async def test_task_passes_its_states_releases_boat_and_scores_mean_error():
    """The boat is 10 m from the goal, and moves 0.5 m toward it in each second."""
    plugin = task("Stationkeeping", f"<goal_pose>0 {EAST_10_M} 0</goal_pose><head_error_on>false</head_error_on>")
    async with weightless_server(EQUATOR, plugin, boat("0 0 0 0 0 0")) as (server, graph, log):
        topics = ("/vrx/task/info", "/vrx/release", "/vrx/stationkeeping/mean_pose_error", "/vrx/stationkeeping/goal")
        info, release, errors, goals = (Recording(graph, server.node, topic) for topic in topics)
        await graph.settle()
        goals_before = 0
        for restart in range(2):
            await advance(server, graph, 1.5)
            assert values_of(info.last)["state"] == "initial"
            assert (len(release), len(goals)) == (restart, goals_before)
            await advance(server, graph, 3.0)
            assert values_of(info.last)["state"] == "ready"
            assert len(release) == restart + 1
            assert (goals.last.position.x, goals.last.position.y) == pytest.approx((0.0, EAST_10_M))
            await advance(server, graph, 0.5)
            server.simulation.set_model_velocity("boat", (0.5, 0.0, 0.0), (0.0, 0.0, 0.0))
            await advance(server, graph, 9.5)
            running = values_of(info.last)
            assert running["state"] == "running"
            assert (running["elapsed_time"], running["remaining_time"]) == pytest.approx((9.0, 1.0))
            assert errors.last.data == pytest.approx(10 - 0.5 * 9 / 2, abs=0.05)
            await advance(server, graph, 3.0)
            finished = values_of(info.last)
            assert (finished["state"], finished["timed_out"]) == ("finished", True)
            assert finished["score"] == pytest.approx(10 - 0.5 * 10 / 2, abs=0.05)
            assert (finished["name"], finished["ready_time"], finished["running_time"]) == ("test", 2.0, 5.0)
            goals_before = len(goals)
            server.reset()
        assert not log


@pytest.mark.parametrize(("yaw", "error"), [(0.0, 0.0), (1.0, 1.0), (4.0, 2 * pi - 4.0)])
async def test_error_of_heading_counts_near_goal(yaw, error):
    plugin = task("Stationkeeping", f"<goal_pose_cart>2 0 {yaw}</goal_pose_cart>")
    async with weightless_server(EQUATOR, plugin, boat("0 0 0 0 0 0")) as (server, graph, _):
        errors = Recording(graph, server.node, "/vrx/stationkeeping/pose_error")
        await graph.settle()
        await advance(server, graph, 7.0)
        assert errors.last.data == pytest.approx(2.0 + 0.75**2 * error, rel=1e-4)


async def test_wayfinding_scores_smallest_errors():
    """The boat passes the first waypoint at 1 m, and stays 100 m or more away from the second one."""
    meter = EAST_10_M - 10
    waypoints = "".join(
        f"<waypoint><pose>{north * meter / 10} {10 + east * meter / 10} 0</pose></waypoint>"
        for east, north in ((5, 1), (5, 100))
    )
    plugin = task("Wayfinding", f"<waypoints>{waypoints}</waypoints>")
    async with weightless_server(EQUATOR, plugin, boat("0 0 0 0 0 0")) as (server, graph, log):
        topics = ("/vrx/wayfinding/min_errors", "/vrx/wayfinding/mean_error", "/vrx/wayfinding/waypoints")
        errors, means, goals = (Recording(graph, server.node, topic) for topic in topics)
        await graph.settle()
        await advance(server, graph, 5.0)
        server.simulation.set_model_velocity("boat", (1.0, 0.0, 0.0), (0.0, 0.0, 0.0))
        await advance(server, graph, 9.5)
        assert list(errors.last.data) == pytest.approx([1.0, 100.0], rel=0.01)
        assert means.last.data == pytest.approx(50.5, rel=0.01)
        assert len(goals.last.poses) == 2
        assert not log


async def test_collisions_within_three_seconds_count_once():
    plugin = task("Stationkeeping", "<goal_pose_cart>0 0 0</goal_pose_cart>")
    contacts_type = "ros_gz_interfaces/msg/Contacts"
    async with weightless_server(EQUATOR, plugin, boat("0 0 0 0 0 0")) as (server, graph, _):
        info = Recording(graph, server.node, "/vrx/task/info")
        publisher = graph.create_node("bumper").create_publisher(contacts_type, "/vrx/contacts", 10)
        for name, count in (
            ("buoy::link::c", 0),
            ("boat::boat/base_link::c", 1),
            ("boat::boat/base_link::c", 1),
            ("boat::boat/base_link::c", 2),
        ):
            contact = get_message("ros_gz_interfaces/msg/Contact")()
            contact.collision2.name = name
            publisher.publish(get_message(contacts_type)(contacts=[contact]))
            await graph.settle()
            await advance(server, graph, 2.0)
            assert values_of(info.last)["num_collisions"] == count


@pytest.mark.parametrize(
    ("plugin", "text"),
    [
        (task("Stationkeeping", "<goal_pose>0 0</goal_pose>"), "a goal needs three numbers"),
        (task("Wayfinding", "<waypoints/>"), "<waypoints> needs a <waypoint>"),
        (task("Wayfinding", "").replace("<vehicle>boat</vehicle>", ""), "needs the parameter 'vehicle'"),
    ],
)
async def test_invalid_tasks_are_reported(plugin, text):
    async with weightless_server(plugin) as (_, __, log):
        assert any(text in record.text for record in log), [record.text for record in log]


async def test_other_tasks_are_told_of_with_what_to_use_instead():
    async with weightless_server(task("Wildlife", "")) as (_, __, log):
        texts = [record.text for record in log]
        assert texts[0] == "plugins and sensors that are not simulated: libWildlifeScoringPlugin.so"
        assert "std_msgs/msg/Empty` to release the boat" in texts[1]


def test_heading_error_is_the_smaller_angle():
    goal = Goal(0.0, 0.0, 0.0, 0.0, -3.0)
    assert goal.compute_error((0.0, 0.0, 3.0), with_heading=True) == pytest.approx(2 * np.pi - 6.0)
