"""planner_server and smoother_server on the graph.

The tests cover goals and errors, cancellation, preemption, services.
"""

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
from tests.navigation.nodes.fake_robot import FakeRobot, make_room_cells

SHARE_FOLDER = Path(linkwright.navigation.substitutes.__file__).parent / "share"
COSTMAP = {
    "robot_radius": 0.2,
    "resolution": 0.05,
    "publish_frequency": 5.0,
    "plugins": ["static_layer", "inflation_layer"],
    "inflation_layer.plugin": "nav2_costmap_2d::InflationLayer",
}
SUCCEEDED, CANCELED, ABORTED = GoalStatus.SUCCEEDED, GoalStatus.CANCELED, GoalStatus.ABORTED


@pytest.fixture
def robot(graph, clock) -> FakeRobot:
    return FakeRobot(graph, clock)


def make_pose(x, y, yaw=0.0, frame="map"):
    return path_message(np.array([[x, y, yaw]]), frame, get_message("builtin_interfaces/msg/Time")()).poses[0]


class SentGoal:
    """A goal that was sent."""

    def __init__(self, robot, action_type, name, fields):
        self.scene, self.action_type = robot, get_action(f"nav2_msgs/action/{action_type}")
        self.client = ActionClient(robot.node, self.action_type, name)
        self.future = self.client.send_goal_async(self.action_type.Goal(**fields))
        self.answer = None

    async def wait_accepted(self):
        await self.scene.graph.settle()
        self.handle = self.future.result()
        self.answer = self.handle.get_result_async() if self.handle.accepted else None
        return self

    async def wait_ended(self, seconds=0.5):
        await self.wait_accepted()
        await self.scene.run(seconds)
        assert self.answer.done()
        response = self.answer.result()
        return response.status, response.result


@pytest.fixture
async def start_server(graph, robot):
    nodes = []

    async def start(kind=PlannerServer, grid=None, costmap=None, **parameters):
        rules = ParameterRules()
        for key, value in {**COSTMAP, **(costmap or {})}.items():
            rules.set("/global_costmap/global_costmap", key, value)
        node = kind(graph, NodeOptions(parameters={"autostart_node": True, **parameters}, parameters_of_others=rules))
        nodes.append(node)
        robot.publish_map(make_room_cells() if grid is None else grid)
        robot.publish_pose()
        await robot.run(0.5)
        return node

    yield start
    for planner in nodes:
        planner.close()


@pytest.fixture
def jazzy(monkeypatch):
    """Use the messages of Jazzy, whose results have error messages."""
    monkeypatch.setenv("ROS_DISTRO", "jazzy")
    other_classes = {name: kind for name, kind in classes._classes.items() if not name.startswith("nav2_msgs/")}
    monkeypatch.setattr(classes, "_classes", other_classes)
    monkeypatch.setattr(classes, "LIBRARY", Library())


def plan_to_pose(robot, goal, **fields):
    return SentGoal(robot, "ComputePathToPose", "compute_path_to_pose", {"goal": goal, **fields})


async def test_compute_path_to_pose_returns_and_publishes_path(robot, start_server):
    await start_server()
    plans = []
    robot.node.create_subscription(get_message("nav_msgs/msg/Path"), "/plan", plans.append, 1)
    status, result = await plan_to_pose(robot, make_pose(3.0, 2.0, 1.0)).wait_ended()
    assert status == SUCCEEDED
    path_poses = poses_from_messages(result.path.poses)
    assert path_poses[0, :2] == pytest.approx(robot.pose[:2])
    assert path_poses[-1] == pytest.approx([3.0, 2.0, 1.0])
    assert result.path.header.frame_id == "map"
    assert len(plans[-1].poses) == len(path_poses)
    length = np.hypot(*np.diff(path_poses[:, :2], axis=0).T).sum()
    assert length == pytest.approx(hypot(2.0, 1.0), rel=0.05)


async def test_goal_without_frame_is_aborted(robot, start_server, log):
    await start_server()
    status, result = await plan_to_pose(robot, make_pose(3.0, 2.0, frame="")).wait_ended()
    assert (status, len(result.path.poses)) == (ABORTED, 0)
    assert any("Failed to transform from  to map" in record.text for record in log)


async def test_start_pose_and_goal_frame_are_respected(robot, start_server):
    await start_server()
    start = make_pose(0.5, 2.5)
    status, result = await plan_to_pose(
        robot, make_pose(1.5, 0.0, frame="base_link"), start=start, use_start=True
    ).wait_ended()
    path_poses = poses_from_messages(result.path.poses)
    assert status == SUCCEEDED
    assert path_poses[[0, -1], :2] == pytest.approx(np.array([[0.5, 2.5], [2.5, 1.0]]))


async def test_compute_path_through_poses_visits_all_poses(robot, start_server):
    await start_server()
    goals = [make_pose(1.0, 2.0), make_pose(3.0, 2.0), make_pose(3.0, 1.0, 2.0)]
    goal = SentGoal(robot, "ComputePathThroughPoses", "compute_path_through_poses", {"goals": goals})
    status, result = await goal.wait_ended()
    path_poses = poses_from_messages(result.path.poses)
    assert status == SUCCEEDED
    assert path_poses[-1] == pytest.approx([3.0, 1.0, 2.0])
    for goal_pose in goals[:2]:
        x, y = goal_pose.pose.position.x, goal_pose.pose.position.y
        assert np.hypot(path_poses[:, 0] - x, path_poses[:, 1] - y).min() < 1e-6


def divided_room():
    grid = make_room_cells()
    grid.cells[:, 40:44] = 100
    return grid


@pytest.mark.parametrize(
    ("goal", "code", "reason"),
    [
        (make_pose(2.1, 1.5), "GOAL_OCCUPIED", "Goal Coordinates of(2.100000, 1.500000) was in lethal cost"),
        (make_pose(3.0, 1.5), "NO_VALID_PATH", "Failed to create plan with tolerance of: 0.500000"),
        (make_pose(9.0, 1.5), "GOAL_OUTSIDE_MAP", "Goal Coordinates of(9.000000, 1.500000) was outside bounds"),
        (make_pose(0.0, 0.0, frame="moon"), "TF_ERROR", "Unable to transform poses to global frame"),
    ],
)
async def test_planning_failure_has_error_code_and_message(jazzy, robot, start_server, goal, code, reason):
    await start_server(grid=divided_room())
    status, result = await plan_to_pose(robot, goal).wait_ended()
    assert status == ABORTED
    assert result.error_code == getattr(result, code)
    assert result.error_msg == reason
    assert not len(result.path.poses)


async def test_planning_failure_is_logged(robot, start_server, logged):
    await start_server(grid=divided_room())
    status, _ = await plan_to_pose(robot, make_pose(2.1, 1.5)).wait_ended()
    assert status == ABORTED
    assert logged("WARN")[-1] == (
        "GridBased plugin failed to plan from (1.00, 1.00) to (2.10, 1.50): "
        '"Goal Coordinates of(2.100000, 1.500000) was in lethal cost"'
    )


async def test_planning_without_map_fails(jazzy, robot, graph):
    node = PlannerServer(graph, NodeOptions(parameters={"autostart_node": True}))
    robot.publish_pose()
    await robot.run(0.5)
    goal = await plan_to_pose(robot, make_pose(2.0, 1.0)).wait_accepted()
    await robot.run(0.9)
    assert not goal.answer.done()
    await robot.run(0.5)
    result = goal.answer.result().result
    assert (result.error_code, result.error_msg) == (result.TIMEOUT, "Costmap timed out waiting for update")
    node.close()


async def test_planning_waits_for_costmap_and_can_be_canceled(robot, graph):
    node = PlannerServer(graph, NodeOptions(parameters={"autostart_node": True, "costmap_update_timeout": 60.0}))
    robot.publish_pose()
    await robot.run(0.5)
    goal = await plan_to_pose(robot, make_pose(2.0, 1.0)).wait_accepted()
    await robot.run(5.0)
    assert not goal.answer.done()
    goal.handle.cancel_goal_async()
    await robot.run(0.2)
    assert goal.answer.result().status == CANCELED
    node.close()


async def test_new_goal_preempts_running_goal(robot, graph):
    node = PlannerServer(graph, NodeOptions(parameters={"autostart_node": True, "costmap_update_timeout": 60.0}))
    robot.publish_pose()
    await robot.run(0.5)
    first = await plan_to_pose(robot, make_pose(2.0, 1.0)).wait_accepted()
    await robot.run(1.0)
    second = await plan_to_pose(robot, make_pose(3.0, 1.0)).wait_accepted()
    robot.publish_map(make_room_cells())
    robot.publish_pose()
    await robot.run(1.0)
    assert first.answer.result().status == ABORTED
    assert second.answer.result().status == SUCCEEDED
    node.close()


async def test_planners_are_chosen_by_name(jazzy, robot, start_server, log):
    smac = {"Smac.plugin": "nav2_smac_planner/SmacPlannerHybrid", "Smac.minimum_turning_radius": 0.4}
    near_parameters = {"Near.plugin": "nav2_navfn_planner::NavfnPlanner", "Near.tolerance": 0.0}
    await start_server(planner_plugins=["Smac", "Near"], **smac, **near_parameters)
    texts = [record.text for record in log]
    assert [
        text
        for text in texts
        if text.startswith("nav2_smac_planner/SmacPlannerHybrid is not supported: plans of 'Smac'")
    ]
    assert not [text for text in texts if "Near" in text and "is not supported" in text]
    near_wall = make_pose(0.15, 1.5)
    assert (await plan_to_pose(robot, near_wall, planner_id="Smac").wait_ended())[0] == SUCCEEDED
    status, result = await plan_to_pose(robot, near_wall, planner_id="Near").wait_ended()
    assert (status, result.error_code) == (ABORTED, result.GOAL_OCCUPIED)
    status, result = await plan_to_pose(robot, near_wall, planner_id="Far").wait_ended()
    assert (result.error_code, result.error_msg) == (result.INVALID_PLANNER, "Planner id Far is invalid")


async def test_inactive_server_rejects_goals(robot, graph):
    node = PlannerServer(graph, NodeOptions())
    node.node.trigger_configure()
    goal = await plan_to_pose(robot, make_pose(2.0, 1.0)).wait_accepted()
    assert not goal.handle.accepted
    node.close()


@pytest.mark.parametrize("kind", [PlannerServer, SmootherServer])
async def test_nav2_bringup_parameters_load_without_warning(graph, log, kind):
    file = SHARE_FOLDER / "nav2_bringup" / "params" / "nav2_params.yaml"
    options = NodeOptions(arguments=["--ros-args", "--params-file", str(file)], parameters={"autostart_node": True})
    node = kind(graph, options)
    assert node.node.is_active
    assert not [record.text for record in log if record.level >= LogLevel.WARN or "are not read" in record.text]
    node.close()


async def test_costmap_in_container_has_parameters_of_process(robot, graph):
    rules = ParameterRules()
    rules.set("/global_costmap/global_costmap", "robot_radius", 0.33)
    container = ComponentContainer(graph, NodeOptions(parameters_of_others=rules))
    request = load_request()
    request.package_name, request.plugin_name = "nav2_planner", "nav2_planner::PlannerServer"
    client = robot.node.create_client(
        get_service("composition_interfaces/srv/LoadNode"), "/ComponentManager/_container/load_node"
    )
    future = client.call_async(request)
    await graph.settle()
    assert future.result().full_node_name == "/planner_server"
    planner = container.loaded[1].node
    assert planner.costmap.get_parameter("robot_radius").value == 0.33
    container.close()


async def test_is_path_valid_checks_costmap(robot, start_server):
    await start_server(costmap={"map_topic": "/map"})
    service = get_service("nav2_msgs/srv/IsPathValid")
    client = robot.node.create_client(service, "is_path_valid")
    stamp = get_message("builtin_interfaces/msg/Time")()

    async def ask(*points):
        path = path_message(np.array([(x, y, 0.0) for x, y in points]).reshape(-1, 3), "map", stamp)
        future = client.call_async(service.Request(path=path))
        await robot.graph.settle()
        return future.result()

    assert (await ask((1.0, 1.0), (2.0, 1.0))).is_valid
    assert not (await ask()).is_valid
    assert not (await ask((1.0, 1.0), (3.9, 1.0))).is_valid
    assert (await ask((0.1, 1.0), (1.0, 1.0), (2.0, 1.0))).is_valid  # the part behind the robot is not checked


# --- smoothing --------------------------------------------------------------------------------------------------------


def smooth_path(robot, poses, **fields):
    stamp = get_message("builtin_interfaces/msg/Time")()
    path = path_message(np.array(poses, float).reshape(-1, 3), "map", stamp)
    return SentGoal(robot, "SmoothPath", "smooth_path", {"path": path, **fields})


CORNER = [(1.0 + 0.05 * step, 1.0, 0.0) for step in range(20)] + [(2.0, 1.0 + 0.05 * step, 1.0) for step in range(20)]


async def test_path_is_smoothed(robot, start_server):
    await start_server(SmootherServer)
    await start_server()
    await robot.run(0.5)
    status, result = await smooth_path(robot, CORNER, check_for_collisions=True).wait_ended()
    assert status == SUCCEEDED
    assert result.was_completed
    path_poses = poses_from_messages(result.path.poses)
    assert path_poses[[0, -1], :2] == pytest.approx(np.array(CORNER)[[0, -1], :2])
    assert np.hypot(path_poses[20, 0] - 2.0, path_poses[20, 1] - 1.0) > 0.01
    assert np.abs(np.diff(path_poses[:-1, 2])).max() < 1.0


async def test_smoothing_failures_have_error_code_and_message(jazzy, robot, start_server):
    await start_server(SmootherServer)
    _, result = await smooth_path(robot, CORNER).wait_ended()
    assert (result.error_code, result.error_msg) == (result.FAILED_TO_SMOOTH_PATH, "Costmap is not available")
    await start_server()
    await robot.run(0.5)
    _, result = await smooth_path(robot, []).wait_ended()
    assert result.error_code == result.INVALID_PATH
    _, result = await smooth_path(robot, CORNER, smoother_id="mine").wait_ended()
    assert (result.error_code, result.error_msg) == (result.INVALID_SMOOTHER, "Invalid Smoother: mine")
    through_wall = [(1.0 - 0.1 * step, 1.0, 3.0) for step in range(12)]
    _, result = await smooth_path(robot, through_wall, check_for_collisions=True).wait_ended()
    assert result.error_code == result.SMOOTHED_PATH_IN_COLLISION
