"""Tasks for boats in Gazebo Classic: their messages; states and scores are tested with the tasks for gz."""

from __future__ import annotations

import pytest

from linkwright.testing import Recording
from tests.simulation.boats.boat import boat
from tests.simulation.boats.test_tasks import DURATIONS, EAST_10_M, EQUATOR, advance
from tests.simulation.fluids.server import weightless_server


def task(name: str, parameters: str) -> str:
    return (
        f'<plugin name="{name}_scoring_plugin" filename="lib{name}_scoring_plugin.so"><vehicle>boat</vehicle>'
        f"<task_name>test</task_name>{DURATIONS}{parameters}</plugin>"
    )


async def test_stationkeeping_publishes_its_goal_once_and_its_errors():
    plugin = task("stationkeeping", f"<goal_pose>0 {EAST_10_M} 0</goal_pose><head_error_on>false</head_error_on>")
    async with weightless_server(EQUATOR, plugin, boat("0 0 0 0 0 0")) as (server, graph, log):
        topics = ("/vrx/task/info", "goal", "pose_error", "mean_pose_error")
        names = (topic if topic.startswith("/") else f"/vrx/station_keeping/{topic}" for topic in topics)
        info, goals, errors, means = (Recording(graph, server.node, name) for name in names)
        await graph.settle()
        await advance(server, graph, 1.5)
        assert (info.last.state, len(goals)) == ("initial", 0)
        await advance(server, graph, 8.0)
        assert len(goals) == 1
        position = goals.last.pose.position
        assert (position.latitude, position.longitude) == pytest.approx((0.0, EAST_10_M))
        assert (errors.last.data, means.last.data) == pytest.approx((10.0, 10.0), abs=0.01)
        message = info.last
        assert (message.name, message.state, message.timed_out) == ("test", "running", False)
        assert (message.ready_time.sec, message.running_time.sec, message.elapsed_time.sec) == (2, 5, 4)
        assert message.remaining_time.sec == 6
        assert message.score == pytest.approx(10.0, abs=0.01)
        assert not log


async def test_wayfinding_publishes_its_path_once_and_the_smallest_errors():
    waypoints = f"<waypoints><waypoint><pose>0 {EAST_10_M} 0</pose></waypoint></waypoints>"
    plugin = task("wayfinding", waypoints)
    async with weightless_server(EQUATOR, plugin, boat("0 0 0 0 0 0")) as (server, graph, log):
        topics = ("waypoints", "min_errors", "mean_error")
        paths, errors, means = (Recording(graph, server.node, f"/vrx/wayfinding/{topic}") for topic in topics)
        await graph.settle()
        await advance(server, graph, 7.5)
        assert [len(path.poses) for path in paths] == [1]
        assert paths.last.poses[0].pose.position.longitude == pytest.approx(EAST_10_M)
        assert list(errors.last.data) == pytest.approx([10.0], abs=0.01)
        assert (errors.last.layout.dim[0].size, means.last.data) == (1, pytest.approx(10.0, abs=0.01))
        assert not log
