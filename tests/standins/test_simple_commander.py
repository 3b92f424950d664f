"""nav2_simple_commander as users write it, with servers that answer in another thread."""

from __future__ import annotations

import threading

import pytest
import rclpy
from action_msgs.msg import GoalStatus
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from lifecycle_msgs.srv import GetState
from nav2_msgs.action import ComputePathToPose, NavigateToPose, Spin
from nav2_msgs.srv import ClearEntireCostmap
from nav2_simple_commander.robot_navigator import BasicNavigator, TaskResult
from rclpy.action import ActionServer, CancelResponse
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile

from tests.docs.pages import DOCS, read_blocks


class Servers(Node):
    """The servers of nav2 that are needed here."""

    def __init__(self):
        super().__init__("servers")
        self.cleared = []
        self.held = None
        for name in ("bt_navigator", "amcl"):
            self.create_service(GetState, f"{name}/get_state", self.on_state)
        for which in ("local", "global"):
            self.create_service(
                ClearEntireCostmap,
                f"{which}_costmap/clear_entirely_{which}_costmap",
                lambda _request, response, which=which: self.cleared.append(which) or response,
            )
        latched_qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.estimate = self.create_publisher(PoseWithCovarianceStamped, "amcl_pose", latched_qos)
        self.initial_poses = []
        self.create_subscription(PoseWithCovarianceStamped, "initialpose", self.on_initial_pose, 10)
        ActionServer(
            self,
            NavigateToPose,
            "navigate_to_pose",
            self.on_go,
            handle_accepted_callback=self.on_accepted,
            cancel_callback=lambda _handle: CancelResponse.ACCEPT,
        )
        self.create_timer(0.01, self.on_timer)
        ActionServer(self, Spin, "spin", self.on_spin)
        ActionServer(self, ComputePathToPose, "compute_path_to_pose", self.on_plan)

    def on_state(self, _request, response):
        response.current_state.label = "active"
        return response

    def on_initial_pose(self, message):
        self.initial_poses.append(message)
        self.estimate.publish(message)

    def on_accepted(self, handle):
        if handle.request.pose.pose.position.x < 5.0:
            handle.execute()
        else:
            self.held = handle

    def on_timer(self):
        if self.held is not None and self.held.is_cancel_requested:
            self.held.execute()
            self.held = None

    def on_go(self, handle):
        feedback = NavigateToPose.Feedback()
        feedback.distance_remaining = 1.5
        handle.publish_feedback(feedback)
        if handle.is_cancel_requested:
            handle.canceled()
        elif handle.request.pose.pose.position.x < -5.0:
            handle.abort()
        else:
            handle.succeed()
        return NavigateToPose.Result()

    def on_spin(self, handle):
        handle.succeed()
        return Spin.Result()

    def on_plan(self, handle):
        result = ComputePathToPose.Result()
        result.path.poses = [handle.request.start, handle.request.goal]
        handle.succeed()
        return result


@pytest.fixture
def servers(monkeypatch):
    monkeypatch.setenv("LINKWRIGHT_DDS", "0")
    rclpy.init(args=[])
    node = Servers()
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    thread = threading.Thread(target=executor.spin)
    thread.start()
    yield node
    executor.shutdown()
    rclpy.try_shutdown()
    thread.join()


@pytest.fixture
def navigator(servers):
    return BasicNavigator()


def make_pose(x):
    message = PoseStamped()
    message.header.frame_id = "map"
    message.pose.position.x = x
    return message


def wait_until_finished(navigator):
    while not navigator.isTaskComplete():
        pass
    return navigator.getResult()


def test_navigator_sets_initial_pose_and_goes_to_pose(navigator):
    navigator.setInitialPose(make_pose(0.0))
    navigator.waitUntilNav2Active()
    assert navigator.goToPose(make_pose(1.0))
    assert wait_until_finished(navigator) == TaskResult.SUCCEEDED
    assert navigator.getFeedback().distance_remaining == 1.5


def test_failed_and_canceled_goals_are_reported(navigator):
    assert navigator.goToPose(make_pose(-9.0))
    assert wait_until_finished(navigator) == TaskResult.FAILED
    assert navigator.status == GoalStatus.STATUS_ABORTED
    assert navigator.goToPose(make_pose(9.0))
    assert not navigator.isTaskComplete()
    assert navigator.getResult() == TaskResult.UNKNOWN
    navigator.cancelTask()
    assert wait_until_finished(navigator) == TaskResult.CANCELED


def test_navigator_spins_plans_and_clears_costmaps(navigator, servers):
    assert navigator.spin(spin_dist=1.57, time_allowance=10)
    assert wait_until_finished(navigator) == TaskResult.SUCCEEDED
    assert [waypoint.pose.position.x for waypoint in navigator.getPath(make_pose(0.0), make_pose(2.0)).poses] == [
        0.0,
        2.0,
    ]
    navigator.clearAllCostmaps()
    assert servers.cleared == ["local", "global"]
    navigator.destroyNode()


@pytest.mark.parametrize("page", [DOCS / "tutorial-navigation.md", DOCS / "zh" / "tutorial-navigation.md"])
def test_tutorial_patrol_program_visits_all_rooms(page, servers, monkeypatch, capsys):
    (program,) = [block for block in read_blocks(page) if block.title == "patrol.py"]
    monkeypatch.setattr(rclpy, "init", lambda: None)
    monkeypatch.setattr(rclpy, "shutdown", lambda: None)
    names = {"__name__": "patrol"}
    exec(program.text, names)  # the code is from the documentation
    names["main"]()
    rooms = [line for line in capsys.readouterr().out.splitlines() if line.startswith("in the")]
    assert rooms == ["in the bedroom", "in the study", "in the living room"]
    assert not servers.initial_poses, "the program must not publish an initial pose"
