"""mbot drives to a ball in a simulated world, in lock-step.

The same test twice gives the same bits.
"""

from __future__ import annotations

import pytest

from linkwright.messages import get_service
from tests.vision.nodes.seeking_robot import BALL_RADIUS_M, SeekingRobot

pytest.importorskip("mujoco")

TRIGGER = get_service("std_srvs/srv/Trigger")


@pytest.mark.parametrize("ball", [(2.0, 0.5), (-1.5, 1.0), (0.3, -1.8)])
def test_seeker_goes_to_ball(tmp_path, ball):
    with SeekingRobot(tmp_path, ball) as test:
        test.tell("/vision/go_to", "ball")
        assert test.advance_until_said("I am at the ball")
        assert test.spoken() == [
            "I am looking for the ball.",
            "I see the ball and am driving to it.",
            "I am at the ball.",
        ]
        assert test.distance() - BALL_RADIUS_M == pytest.approx(0.5, abs=0.08)
        place = test.robot_pose()
        test.advance(2.0)
        assert test.robot_pose()[:2] == pytest.approx(place[:2], abs=0.02), "the robot stands still"
        responses = {
            name: test.call(f"/vision/describe{name}", TRIGGER.Request()).message for name in ("", "/en", "/zh")
        }
        assert responses[""] == responses["/en"]
        assert responses["/en"].startswith("I see a ball 0.")
        assert "球" in responses["/zh"]


@pytest.mark.slow
def test_seeker_goes_to_red_ball_seen_by_camera(tmp_path):
    with SeekingRobot(tmp_path, (1.6, -0.9), images=True, laser=True) as test:
        test.tell("/vision/go_to", "红色的球")
        assert test.advance_until_said("我到红色的球这里了")
        assert test.distance() - BALL_RADIUS_M == pytest.approx(0.5, abs=0.08)
        describe_sightings = test.call("/vision/describe", TRIGGER.Request())
        assert describe_sightings.message.startswith("I see a red ball 0.")
        assert describe_sightings.message.endswith(" m ahead.")


@pytest.mark.parametrize("language", ["en", "zh"])
def test_answers_are_in_language_of_request(tmp_path, language):
    with SeekingRobot(tmp_path, (1.0, 0.0), seeker={"language": language}) as test:
        for topic, text in (
            ("go_to/zh", "ball"),
            ("go_to/en", "球"),
            ("follow/zh", "ball"),
            ("follow/en", "球"),
            ("go_to", "ball"),
            ("go_to", "球"),
        ):
            test.tell(f"/vision/{topic}", text)
            test.settle()
        test.tell_to_stop()
        test.settle()
        usual = "我在找球。" if language == "zh" else "I am looking for the ball."
        responses = ["我在找球。", "I am looking for the ball."]
        assert test.spoken() == [*responses, *responses, usual, "我在找球。", "我停下了。"]


def test_seeker_follows_moving_ball_until_stopped(tmp_path):
    with SeekingRobot(tmp_path, (1.5, 0.0)) as test:
        test.tell("/vision/follow", "ball")
        test.advance(5.0)
        assert test.distance() - BALL_RADIUS_M == pytest.approx(0.5, abs=0.1)
        test.delete("ball")
        test.put_ball(2.0, 0.3)
        test.advance(5.0)
        assert test.distance() - BALL_RADIUS_M == pytest.approx(0.5, abs=0.1)
        test.tell_to_stop()
        test.advance(0.5)
        assert test.spoken()[-1] == "I am stopping."
        commands = len(test.commands)
        test.delete("ball")
        test.put_ball(3.5, 0.3)
        test.advance(2.0)
        assert len(test.commands) == commands, "no more commands are published"
        assert test.commands.last.linear.x == 0.0


def test_missing_object_is_not_found(tmp_path):
    with SeekingRobot(tmp_path, (2.0, 0.0)) as test:
        test.tell("/vision/go_to", "crate")
        assert test.advance_until_said("I cannot find the crate")
        x, y, *_ = test.robot_pose()
        assert (x, y) == pytest.approx((0.0, 0.0), abs=0.02)


def test_lost_object_is_searched_and_given_up(tmp_path):
    with SeekingRobot(tmp_path, (4.0, 0.0)) as test:
        test.tell("/vision/go_to", "ball")
        test.advance(2.0)
        test.hide()
        assert test.advance_until_said("I have lost the ball")
        assert test.distance() > 1.5
        assert test.commands.last.angular.z == 0.0


def test_end_of_detector_stops_robot(tmp_path):
    with SeekingRobot(tmp_path, (4.0, 0.0)) as test:
        test.tell("/vision/go_to", "ball")
        test.advance(2.0)
        test.detector.cancel()
        assert test.advance_until_said("I receive no detections", 5.0)
        assert test.commands.last.linear.x == 0.0
        assert test.distance() > 2.0


def test_laser_stops_robot_before_obstacle(tmp_path):
    with SeekingRobot(tmp_path, (3.0, 0.0), laser=True, seeker={"blocked_time": 2.0}) as test:
        box = tmp_path / "box.sdf"
        box.write_text(
            "<sdf version='1.6'><model name='box'><static>true</static><link name='link'><collision name='box'>"
            "<geometry><box><size>0.2 0.6 0.6</size></box></geometry></collision></link></model></sdf>"
        )
        test.spawn(box, "box", pose=(1.5, 0.0, 0.3, 0.0, 0.0, 0.0))
        test.tell("/vision/go_to", "ball")
        assert test.advance_until_said("An obstacle is between me and the ball")
        x, *_ = test.robot_pose()
        assert 0.8 < x < 1.2


def test_request_without_object_moves_nothing(tmp_path):
    with SeekingRobot(tmp_path, (2.0, 0.0)) as test:
        test.tell("/vision/go_to", " the ")
        test.tell_to_stop()
        test.advance(1.0)
        assert test.spoken() == []
        assert len(test.commands) == 0
        assert any("does not name an object" in record.text for record in test.log)
