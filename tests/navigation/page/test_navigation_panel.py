"""The panel of nav2."""

from __future__ import annotations

from contextlib import asynccontextmanager
from typing import Any

from linkwright.graph import DurabilityPolicy, Graph, QoSProfile
from linkwright.messages import get_message, get_service
from linkwright.rviz import RvizConfig
from tests.viewer.scene import open_page, open_world

FILE = """\
Panels:
  - Class: rviz_common/Displays
    Name: Displays
  - Class: nav2_rviz_plugins/Navigation 2
    Name: Navigation 2
Visualization Manager:
  Displays: []
"""
Feedback = get_message("nav2_msgs/action/NavigateToPose_FeedbackMessage")
GoalStatus = get_message("action_msgs/msg/GoalStatus")
GoalStatusArray = get_message("action_msgs/msg/GoalStatusArray")
PAUSE, RESUME, RESET = 1, 2, 3


class Nav2:
    """The services and topics of nav2 that the panel uses."""

    def __init__(self, graph: Graph) -> None:
        node = graph.create_node("nav2")
        self.active = True
        self.refuses = False
        self.log = node.get_logger()
        self.commands: list[tuple[str, int]] = []
        self.cancel_count = 0
        for name in ("navigation", "localization"):
            manager = f"/lifecycle_manager_{name}"
            node.create_service(get_service("std_srvs/srv/Trigger"), f"{manager}/is_active", self._is_active)
            manage = get_service("nav2_msgs/srv/ManageLifecycleNodes")
            node.create_service(
                manage, f"{manager}/manage_nodes", lambda *messages, name=name: self._manage(name, *messages)
            )
        node.create_service(
            get_service("action_msgs/srv/CancelGoal"), "/navigate_to_pose/_action/cancel_goal", self._cancel
        )
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.status = node.create_publisher(GoalStatusArray, "/navigate_to_pose/_action/status", latched)
        self.feedback = node.create_publisher(Feedback, "/navigate_to_pose/_action/feedback", 10)

    def _is_active(self, _: Any, response: Any) -> Any:
        response.success = self.active
        return response

    def _manage(self, name: str, request: Any, response: Any) -> Any:
        self.commands.append((name, request.command))
        self.active = request.command in (0, RESUME)
        response.success = not self.refuses
        return response

    def _cancel(self, _: Any, response: Any) -> Any:
        self.cancel_count += 1
        return response

    def publish_goal_states(self, *statuses: int) -> None:
        """Publish the states of goals, each accepted a second after the previous one."""
        message = GoalStatusArray()
        for number, status in enumerate(statuses):
            goal_status = GoalStatus(status=status)
            goal_status.goal_info.stamp.sec = number
            goal_status.goal_info.goal_id.uuid = [number] * 16
            message.status_list.append(goal_status)
        self.status.publish(message)

    def publish_progress(self, distance: float) -> None:
        message = Feedback()
        message.feedback.distance_remaining = distance
        message.feedback.navigation_time.sec, message.feedback.navigation_time.nanosec = 12, 500_000_000
        message.feedback.estimated_time_remaining.sec = 75
        message.feedback.number_of_recoveries = 2
        self.feedback.publish(message)


@asynccontextmanager
async def navigation_page():
    """Run nav2's services, and a page that shows the panel."""
    async with open_world() as world:
        nav2 = Nav2(world.graph)
        async with open_page(world.viewer) as client:
            await client.opened()
            await client.send("watch_navigation", open=True)
            yield world, nav2, client


async def test_manager_states_are_shown():
    async with navigation_page() as (_, nav2, client):
        await client.until("navigation_state", navigation="active", localization="active")
        nav2.active = False
        await client.until("navigation_state", navigation="inactive", localization="inactive")


async def test_panel_without_nav2_shows_unknown_and_rejects_commands():
    async with open_world() as world, open_page(world.viewer) as client:
        await client.opened()
        await client.send("watch_navigation", open=True)
        first = await client.until("navigation_state")
        assert (first["navigation"], first["localization"], first["goal"]) == ("unknown", "unknown", "none")
        await client.send("command_navigation", command="pause")
        await client.until(
            "navigation_state", problem="no lifecycle manager of nav2 is running; start nav2 first", busy=False
        )


async def test_goal_progress_is_shown_until_next_goal():
    async with navigation_page() as (_, nav2, client):
        await client.until("navigation_state", navigation="active")
        nav2.publish_goal_states(2)
        nav2.publish_progress(3.456)
        message = await client.until("navigation_state", distance=3.46)
        assert (message["goal"], message["eta"], message["elapsed"], message["recoveries"]) == ("active", 75.0, 12.5, 2)
        nav2.publish_progress(float("nan"))
        await client.until("navigation_state", distance=None, eta=75.0)
        nav2.publish_goal_states(4, 2)
        await client.until("navigation_state", goal="active", eta=None, recoveries=None)
        nav2.publish_goal_states(4, 4)
        await client.until("navigation_state", goal="succeeded")


async def test_goal_failure_is_shown_with_error_until_next_goal():
    async with open_world() as world:
        nav2 = Nav2(world.graph)
        async with open_page(world.viewer) as client:
            await client.opened()
            nav2.publish_goal_states(2)
            world.graph.create_node("camera").get_logger().error("no light")
            nav2.log.error("Goal failed: the goal is in an obstacle")
            nav2.publish_goal_states(6)
            message = await client.until("goal_outcome", failed=True)
            assert message["reason"] == "Goal failed: the goal is in an obstacle"
            nav2.publish_goal_states(6, 2)
            await client.until("goal_outcome", failed=False, reason="")


async def test_goal_failure_before_page_opened_is_not_shown():
    async with open_world() as world:
        nav2 = Nav2(world.graph)
        nav2.publish_goal_states(6)
        async with open_page(world.viewer) as client:
            await client.opened()
            nav2.publish_goal_states(6, 5)
            messages = [message for message in await client.drain(0.6) if isinstance(message, dict)]
            assert not any(message["failed"] for message in messages if message["type"] == "goal_outcome")


async def test_buttons_command_both_managers_in_order_of_nav2():
    async with navigation_page() as (_, nav2, client):
        await client.until("navigation_state", navigation="active")
        await client.send("command_navigation", command="pause")
        await client.until("navigation_state", navigation="inactive", busy=False)
        await client.send("command_navigation", command="resume")
        await client.until("navigation_state", navigation="active", busy=False)
        assert nav2.commands == [
            ("navigation", PAUSE),
            ("localization", PAUSE),
            ("localization", RESUME),
            ("navigation", RESUME),
        ]
        nav2.refuses = True
        await client.send("command_navigation", command="pause")
        message = await client.until("navigation_state", busy=False, navigation="active")
        assert (
            message["problem"]
            == "lifecycle_manager_navigation could not execute the command; see its log for the reason"
        )


async def test_goal_is_canceled_by_cancel_and_reset():
    async with navigation_page() as (_, nav2, client):
        nav2.publish_goal_states(2)
        await client.until("navigation_state", goal="active", navigation="active")
        await client.send("command_navigation", command="cancel")
        await client.until("navigation_state", busy=True)
        await client.until("navigation_state", busy=False, problem="")
        assert (nav2.cancel_count, nav2.commands) == (1, [])
        await client.send("command_navigation", command="reset")
        await client.until("navigation_state", busy=True)
        await client.until("navigation_state", busy=False, problem="")
        assert (nav2.cancel_count, nav2.commands) == (2, [("navigation", RESET), ("localization", RESET)])


async def test_closed_panel_has_no_subscriptions():
    async with navigation_page() as (world, _, client):
        await client.until("navigation_state", navigation="active")
        await client.send("watch_navigation", open=False)
        await client.drain()
        assert world.viewer.context.node.count_subscribers("/navigate_to_pose/_action/feedback") == 0


def test_panel_of_rviz_file_is_recognized_and_kept():
    config = RvizConfig.parse(FILE)
    assert config.warnings == []
    assert config.panels.shown == ["displays", "navigation"]
    assert config.text() == FILE
    config.panels.show(["displays"])
    assert "Navigation 2" not in config.text()
    config.panels.show(["displays", "navigation"])
    assert config.text() == FILE


def test_added_panel_is_saved_with_nav2_class():
    config = RvizConfig.parse(FILE.replace("  - Class: nav2_rviz_plugins/Navigation 2\n    Name: Navigation 2\n", ""))
    config.panels.show(["displays", "navigation"])
    assert "Class: nav2_rviz_plugins/Navigation 2" in config.text()
