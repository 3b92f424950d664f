"""planner_server and smoother_server on the graph: goals and their errors, canceling, taking over, services."""

from __future__ import annotations

from math import hypot
from pathlib import Path

import numpy as np
import pytest

import linkwright.navigation.substitutes
from linkwright.graph import ActionClient, LogLevel
from linkwright.graph.actions.goal import GoalStatus
from linkwright.graph.parameters.parameter import ParameterRules
from linkwright.messages import classes, get_action, get_message, get_service
from linkwright.messages.definitions.library import Library
from linkwright.navigation.nodes.paths import path_message, poses_from_messages
from linkwright.navigation.nodes.planner_server import PlannerServer
from linkwright.navigation.nodes.smoother_server import SmootherServer
from linkwright.nodes import NodeOptions
from linkwright.nodes.component_container import ComponentContainer, load_request
from tests.navigation.nodes.scene import Scene, walls

SHARE = Path(linkwright.navigation.substitutes.__file__).parent / "share"
COSTMAP = {
    "robot_radius": 0.2,
    "resolution": 0.05,
    "publish_frequency": 5.0,
    "plugins": ["static_layer", "inflation_layer"],
    "inflation_layer.plugin": "nav2_costmap_2d::InflationLayer",
}
SUCCEEDED, CANCELED, ABORTED = GoalStatus.SUCCEEDED, GoalStatus.CANCELED, GoalStatus.ABORTED


@pytest.fixture
def scene(graph, clock) -> Scene:
    return Scene(graph, clock)


def pose(x, y, yaw=0.0, frame="map"):
    return path_message(np.array([[x, y, yaw]]), frame, get_message("builtin_interfaces/msg/Time")()).poses[0]


class Goal:
    """A goal that was sent."""

    def __init__(self, scene, kind, name, fields):
        self.scene, self.kind = scene, get_action(f"nav2_msgs/action/{kind}")
        self.client = ActionClient(scene.node, self.kind, name)
        self.future = self.client.send_goal_async(self.kind.Goal(**fields))
        self.answer = None

    async def accepted(self):
        await self.scene.graph.settle()
        self.handle = self.future.result()
        self.answer = self.handle.get_result_async() if self.handle.accepted else None
        return self

    async def ended(self, seconds=0.5):
        await self.accepted()
        await self.scene.run(seconds)
        assert self.answer.done()
        answer = self.answer.result()
        return answer.status, answer.result


@pytest.fixture
async def server(graph, scene):
    nodes = []

    async def start(kind=PlannerServer, grid=None, costmap=None, **parameters):
        rules = ParameterRules()
        for key, value in {**COSTMAP, **(costmap or {})}.items():
            rules.set("/global_costmap/global_costmap", key, value)
        node = kind(graph, NodeOptions(parameters={"autostart_node": True, **parameters}, parameters_of_others=rules))
        nodes.append(node)
        scene.tell_map(walls() if grid is None else grid)
        scene.tell_pose()
        await scene.run(0.5)
        return node

    yield start
    for planner in nodes:
        planner.close()


@pytest.fixture
def jazzy(monkeypatch):
    """The messages of Jazzy, whose results say why."""
    monkeypatch.setenv("ROS_DISTRO", "jazzy")
    known = {name: kind for name, kind in classes._classes.items() if not name.startswith("nav2_msgs/")}
    monkeypatch.setattr(classes, "_classes", known)
    monkeypatch.setattr(classes, "LIBRARY", Library())


def to_pose(scene, goal, **more):
    return Goal(scene, "ComputePathToPose", "compute_path_to_pose", {"goal": goal, **more})


async def test_compute_path_to_pose_returns_and_publishes_path(scene, server):
    await server()
    plans = []
    scene.node.create_subscription(get_message("nav_msgs/msg/Path"), "/plan", plans.append, 1)
    status, result = await to_pose(scene, pose(3.0, 2.0, 1.0)).ended()
    assert status == SUCCEEDED
    path_poses = poses_from_messages(result.path.poses)
    assert path_poses[0, :2] == pytest.approx(scene.pose[:2])
    assert path_poses[-1] == pytest.approx([3.0, 2.0, 1.0])
    assert result.path.header.frame_id == "map"
    assert len(plans[-1].poses) == len(path_poses)
    length = np.hypot(*np.diff(path_poses[:, :2], axis=0).T).sum()
    assert length == pytest.approx(hypot(2.0, 1.0), rel=0.05)


async def test_goal_without_frame_is_aborted(scene, server, log):
    await server()
    status, result = await to_pose(scene, pose(3.0, 2.0, frame="")).ended()
    assert (status, len(result.path.poses)) == (ABORTED, 0)
    assert any("Failed to transform from  to map" in record.text for record in log)


async def test_start_pose_and_goal_frame_are_respected(scene, server):
    await server()
    start = pose(0.5, 2.5)
    status, result = await to_pose(scene, pose(1.5, 0.0, frame="base_link"), start=start, use_start=True).ended()
    path_poses = poses_from_messages(result.path.poses)
    assert status == SUCCEEDED
    assert path_poses[[0, -1], :2] == pytest.approx(np.array([[0.5, 2.5], [2.5, 1.0]]))


async def test_compute_path_through_poses_visits_all_poses(scene, server):
    await server()
    goals = [pose(1.0, 2.0), pose(3.0, 2.0), pose(3.0, 1.0, 2.0)]
    goal = Goal(scene, "ComputePathThroughPoses", "compute_path_through_poses", {"goals": goals})
    status, result = await goal.ended()
    path_poses = poses_from_messages(result.path.poses)
    assert status == SUCCEEDED
    assert path_poses[-1] == pytest.approx([3.0, 1.0, 2.0])
    for goal_pose in goals[:2]:
        x, y = goal_pose.pose.position.x, goal_pose.pose.position.y
        assert np.hypot(path_poses[:, 0] - x, path_poses[:, 1] - y).min() < 1e-6


def divided():
    grid = walls()
    grid.cells[:, 40:44] = 100
    return grid


@pytest.mark.parametrize(
    ("goal", "code", "why"),
    [
        (pose(2.1, 1.5), "GOAL_OCCUPIED", "Goal Coordinates of(2.100000, 1.500000) was in lethal cost"),
        (pose(3.0, 1.5), "NO_VALID_PATH", "Failed to create plan with tolerance of: 0.500000"),
        (pose(9.0, 1.5), "GOAL_OUTSIDE_MAP", "Goal Coordinates of(9.000000, 1.500000) was outside bounds"),
        (pose(0.0, 0.0, frame="moon"), "TF_ERROR", "Unable to transform poses to global frame"),
    ],
)
async def test_planning_failure_has_error_code_and_message(jazzy, scene, server, goal, code, why):
    await server(grid=divided())
    status, result = await to_pose(scene, goal).ended()
    assert status == ABORTED
    assert result.error_code == getattr(result, code)
    assert result.error_msg == why
    assert not len(result.path.poses)


async def test_planning_failure_is_logged(scene, server, logged):
    await server(grid=divided())
    status, _ = await to_pose(scene, pose(2.1, 1.5)).ended()
    assert status == ABORTED
    assert logged("WARN")[-1] == (
        "GridBased plugin failed to plan from (1.00, 1.00) to (2.10, 1.50): "
        '"Goal Coordinates of(2.100000, 1.500000) was in lethal cost"'
    )


async def test_planning_without_map_fails(jazzy, scene, graph):
    node = PlannerServer(graph, NodeOptions(parameters={"autostart_node": True}))
    scene.tell_pose()
    await scene.run(0.5)
    goal = await to_pose(scene, pose(2.0, 1.0)).accepted()
    await scene.run(0.9)
    assert not goal.answer.done()
    await scene.run(0.5)
    result = goal.answer.result().result
    assert (result.error_code, result.error_msg) == (result.TIMEOUT, "Costmap timed out waiting for update")
    node.close()


async def test_planning_waits_for_costmap_and_can_be_canceled(scene, graph):
    node = PlannerServer(graph, NodeOptions(parameters={"autostart_node": True, "costmap_update_timeout": 60.0}))
    scene.tell_pose()
    await scene.run(0.5)
    goal = await to_pose(scene, pose(2.0, 1.0)).accepted()
    await scene.run(5.0)
    assert not goal.answer.done()
    goal.handle.cancel_goal_async()
    await scene.run(0.2)
    assert goal.answer.result().status == CANCELED
    node.close()


async def test_new_goal_preempts_running_goal(scene, graph):
    node = PlannerServer(graph, NodeOptions(parameters={"autostart_node": True, "costmap_update_timeout": 60.0}))
    scene.tell_pose()
    await scene.run(0.5)
    first = await to_pose(scene, pose(2.0, 1.0)).accepted()
    await scene.run(1.0)
    second = await to_pose(scene, pose(3.0, 1.0)).accepted()
    scene.tell_map(walls())
    scene.tell_pose()
    await scene.run(1.0)
    assert first.answer.result().status == ABORTED
    assert second.answer.result().status == SUCCEEDED
    node.close()


async def test_planners_are_chosen_by_name(jazzy, scene, server, log):
    smac = {"Smac.plugin": "nav2_smac_planner/SmacPlannerHybrid", "Smac.minimum_turning_radius": 0.4}
    near = {"Near.plugin": "nav2_navfn_planner::NavfnPlanner", "Near.tolerance": 0.0}
    await server(planner_plugins=["Smac", "Near"], **smac, **near)
    logged = [record.text for record in log]
    assert [
        text
        for text in logged
        if text.startswith("nav2_smac_planner/SmacPlannerHybrid is not supported: plans of 'Smac'")
    ]
    assert not [text for text in logged if "Near" in text and "is not supported" in text]
    by_wall = pose(0.15, 1.5)
    assert (await to_pose(scene, by_wall, planner_id="Smac").ended())[0] == SUCCEEDED
    status, result = await to_pose(scene, by_wall, planner_id="Near").ended()
    assert (status, result.error_code) == (ABORTED, result.GOAL_OCCUPIED)
    status, result = await to_pose(scene, by_wall, planner_id="Far").ended()
    assert (result.error_code, result.error_msg) == (result.INVALID_PLANNER, "Planner id Far is invalid")


async def test_inactive_server_rejects_goals(scene, graph):
    node = PlannerServer(graph, NodeOptions())
    node.node.trigger_configure()
    goal = await to_pose(scene, pose(2.0, 1.0)).accepted()
    assert not goal.handle.accepted
    node.close()


@pytest.mark.parametrize("kind", [PlannerServer, SmootherServer])
async def test_nav2_bringup_parameters_load_without_warning(graph, log, kind):
    file = SHARE / "nav2_bringup" / "params" / "nav2_params.yaml"
    options = NodeOptions(arguments=["--ros-args", "--params-file", str(file)], parameters={"autostart_node": True})
    node = kind(graph, options)
    assert node.node.is_active
    assert not [record.text for record in log if record.level >= LogLevel.WARN or "are not read" in record.text]
    node.close()


async def test_costmap_in_container_has_parameters_of_process(scene, graph):
    rules = ParameterRules()
    rules.set("/global_costmap/global_costmap", "robot_radius", 0.33)
    container = ComponentContainer(graph, NodeOptions(parameters_of_others=rules))
    request = load_request()
    request.package_name, request.plugin_name = "nav2_planner", "nav2_planner::PlannerServer"
    client = scene.node.create_client(
        get_service("composition_interfaces/srv/LoadNode"), "/ComponentManager/_container/load_node"
    )
    future = client.call_async(request)
    await graph.settle()
    assert future.result().full_node_name == "/planner_server"
    planner = container.loaded[1].node
    assert planner.costmap.get_parameter("robot_radius").value == 0.33
    container.close()


async def test_is_path_valid_checks_costmap(scene, server):
    await server(costmap={"map_topic": "/map"})
    service = get_service("nav2_msgs/srv/IsPathValid")
    client = scene.node.create_client(service, "is_path_valid")
    stamp = get_message("builtin_interfaces/msg/Time")()

    async def ask(*points):
        path = path_message(np.array([(x, y, 0.0) for x, y in points]).reshape(-1, 3), "map", stamp)
        future = client.call_async(service.Request(path=path))
        await scene.graph.settle()
        return future.result()

    assert (await ask((1.0, 1.0), (2.0, 1.0))).is_valid
    assert not (await ask()).is_valid
    assert not (await ask((1.0, 1.0), (3.9, 1.0))).is_valid
    assert (await ask((0.1, 1.0), (1.0, 1.0), (2.0, 1.0))).is_valid  # what lies behind does not count


# --- smoothing --------------------------------------------------------------------------------------------------------


def smooth(scene, poses, **more):
    stamp = get_message("builtin_interfaces/msg/Time")()
    path = path_message(np.array(poses, float).reshape(-1, 3), "map", stamp)
    return Goal(scene, "SmoothPath", "smooth_path", {"path": path, **more})


CORNER = [(1.0 + 0.05 * step, 1.0, 0.0) for step in range(20)] + [(2.0, 1.0 + 0.05 * step, 1.0) for step in range(20)]


async def test_path_is_smoothed(scene, server):
    await server(SmootherServer)
    await server()
    await scene.run(0.5)
    status, result = await smooth(scene, CORNER, check_for_collisions=True).ended()
    assert status == SUCCEEDED
    assert result.was_completed
    path_poses = poses_from_messages(result.path.poses)
    assert path_poses[[0, -1], :2] == pytest.approx(np.array(CORNER)[[0, -1], :2])
    assert np.hypot(path_poses[20, 0] - 2.0, path_poses[20, 1] - 1.0) > 0.01
    assert np.abs(np.diff(path_poses[:-1, 2])).max() < 1.0


async def test_smoothing_failures_have_error_code_and_message(jazzy, scene, server):
    await server(SmootherServer)
    _, result = await smooth(scene, CORNER).ended()
    assert (result.error_code, result.error_msg) == (result.FAILED_TO_SMOOTH_PATH, "Costmap is not available")
    await server()
    await scene.run(0.5)
    _, result = await smooth(scene, []).ended()
    assert result.error_code == result.INVALID_PATH
    _, result = await smooth(scene, CORNER, smoother_id="mine").ended()
    assert (result.error_code, result.error_msg) == (result.INVALID_SMOOTHER, "Invalid Smoother: mine")
    through_wall = [(1.0 - 0.1 * step, 1.0, 3.0) for step in range(12)]
    _, result = await smooth(scene, through_wall, check_for_collisions=True).ended()
    assert result.error_code == result.SMOOTHED_PATH_IN_COLLISION
