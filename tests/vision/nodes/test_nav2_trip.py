"""object_seeker with nav2.

It sends goals to detected objects if this is enabled and nav2 runs.
"""

from __future__ import annotations

from typing import Any

import pytest

from linkwright.graph import ActionServer, CancelResponse
from linkwright.messages import get_action
from tests.vision.nodes.seeking_robot import BALL_RADIUS_M, SeekingRobot

pytest.importorskip("mujoco")

NAVIGATE = "nav2_msgs/action/NavigateToPose"


class Navigator:
    """A server of the action that records its goals; the test ends them."""

    def __init__(self, test: SeekingRobot) -> None:
        self.goals: list[Any] = []
        self.canceled = 0
        self._server = ActionServer(
            test.node,
            NAVIGATE,
            "navigate_to_pose",
            execute_callback=lambda goal: get_action(NAVIGATE).Result(),
            handle_accepted_callback=self.goals.append,
            cancel_callback=self._cancel,
        )

    def _cancel(self, _goal: Any) -> CancelResponse:
        self.canceled += 1
        return CancelResponse.ACCEPT

    def end(self, reached: bool) -> None:
        def finish(goal: Any) -> Any:
            (goal.succeed if reached else goal.abort)()
            return get_action(NAVIGATE).Result()

        self.goals[-1].execute(finish)


@pytest.mark.parametrize(("reached", "message"), [(True, "I am at the ball."), (False, "An obstacle is between")])
def test_seeker_sends_nav2_to_object(tmp_path, reached, message):
    with SeekingRobot(tmp_path, (2.0, 0.0), seeker={"use_nav2": True}) as test:
        navigator = Navigator(test)
        test.tell("/vision/go_to", "ball")
        test.advance(2.0)
        (goal,) = navigator.goals
        pose = goal.request.pose
        assert pose.header.frame_id == "odom"
        assert pose.pose.position.x == pytest.approx(2.0 - BALL_RADIUS_M - 0.5, abs=0.1)
        assert pose.pose.orientation.w == pytest.approx(1.0, abs=0.01)
        assert test.commands.last.linear.x == 0.0, "nav2 drives the robot"
        navigator.end(reached)
        test.advance(0.5)
        assert test.spoken()[-1].startswith(message)
        commands = len(test.commands)
        test.advance(1.0)
        assert len(test.commands) == commands


def test_stop_cancels_nav2_goal(tmp_path):
    with SeekingRobot(tmp_path, (2.0, 0.0), seeker={"use_nav2": True}) as test:
        navigator = Navigator(test)
        test.tell("/vision/go_to", "ball")
        test.advance(2.0)
        test.tell_to_stop()
        test.advance(0.5)
        assert navigator.canceled == 1
        assert test.spoken()[-1] == "I am stopping."


def test_seeker_drives_itself_without_nav2(tmp_path):
    with SeekingRobot(tmp_path, (1.5, 0.0), seeker={"use_nav2": True}) as test:
        test.tell("/vision/go_to", "ball")
        assert test.advance_until_said("I am at the ball")
