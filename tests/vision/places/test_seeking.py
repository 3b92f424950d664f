"""Searching for an object and driving to it, with a simulated robot."""

from __future__ import annotations

from math import atan2, cos, hypot, inf, pi, sin

import pytest

from linkwright.vision.places.object_requests import Answer
from linkwright.vision.places.seeker import Observation, Phase, Seeker, SeekSettings

PERIOD_S = 0.1


class Robot:
    """A robot that follows its commands in a plane with one object.

    Its field of view is 40 degrees to either side.
    """

    def __init__(self, seeker, target=None, radius=0.15):
        self.seeker, self.target, self.radius = seeker, target, radius
        self.x = self.y = self.heading = self.time = 0.0
        self.seen_at, self.time_since_detections, self.free_distance = -inf, 0.0, inf
        self.way = 0.0
        self.hidden = False

    def step(self):
        view = Observation(
            self.time, self.heading, time_since_detections=self.time_since_detections, free_distance=self.free_distance
        )
        if self.target is not None:
            away = hypot(self.target[0] - self.x, self.target[1] - self.y)
            bearing = atan2(self.target[1] - self.y, self.target[0] - self.x) - self.heading
            bearing = (bearing + pi) % (2 * pi) - pi
            if abs(bearing) < 0.7 and not self.hidden:
                self.seen_at = self.time
            if self.seen_at > -inf:
                seen_ago = self.time - self.seen_at
                view = Observation(
                    self.time,
                    self.heading,
                    bearing,
                    away - self.radius,
                    seen_ago,
                    self.time_since_detections,
                    self.free_distance,
                )
        move = self.seeker.step(view)
        self.heading += move.angular * PERIOD_S
        self.x += move.linear * cos(self.heading) * PERIOD_S
        self.y += move.linear * sin(self.heading) * PERIOD_S
        self.way += abs(move.linear) * PERIOD_S
        self.time += PERIOD_S
        return move

    def advance(self, seconds):
        """Return the events of the next seconds, and the maximum speeds."""
        moves = [self.step() for _ in range(round(seconds / PERIOD_S))]
        return [move.event for move in moves if move.event is not None]


@pytest.mark.parametrize("target", [(2.0, 0.0), (1.0, -1.5), (-2.0, 0.5), (0.3, 0.0)])
def test_seeker_turns_until_object_is_seen_and_goes_there(target):
    seeker = Seeker()
    robot = Robot(seeker, target)
    seeker.begin()
    assert robot.advance(60)[-1] is Answer.ARRIVED
    assert seeker.phase is Phase.IDLE
    surface = hypot(target[0] - robot.x, target[1] - robot.y) - robot.radius
    assert surface == pytest.approx(0.5, abs=0.05) or (surface < 0.5 and robot.way == 0.0)


def test_missing_object_is_not_found_after_one_turn():
    seeker = Seeker()
    robot = Robot(seeker)
    seeker.begin()
    assert robot.advance(60) == [Answer.NOT_FOUND]
    assert 2 * pi < robot.heading < 2 * pi + 0.5
    assert robot.way == 0.0


def test_lost_object_stops_robot_and_is_searched():
    seeker = Seeker()
    robot = Robot(seeker, (8.0, 0.0))
    seeker.begin()
    assert robot.advance(3) == [Answer.FOUND]
    robot.hidden = True
    way = robot.way
    assert robot.advance(5) == []
    assert robot.way - way < seeker.settings.speed * (seeker.settings.lost_timeout + 0.2)
    assert robot.advance(30) == [Answer.LOST]


def test_briefly_hidden_object_is_not_lost():
    seeker = Seeker()
    robot = Robot(seeker, (3.0, 0.0))
    seeker.begin()
    events = robot.advance(3)
    robot.hidden = True
    events += robot.advance(2)
    robot.hidden = False
    assert events + robot.advance(20) == [Answer.FOUND, Answer.ARRIVED]


def test_silent_detector_stops_robot():
    seeker = Seeker()
    robot = Robot(seeker, (3.0, 0.0))
    seeker.begin()
    robot.advance(2)
    robot.time_since_detections = 3.5
    assert robot.advance(1) == [Answer.NO_DETECTIONS]
    way = robot.way
    robot.advance(2)
    assert robot.way == way


def test_robot_waits_before_obstacle_and_gives_up():
    seeker = Seeker()
    robot = Robot(seeker, (3.0, 0.0))
    seeker.begin()
    robot.advance(2)
    robot.free_distance = 0.3
    way = robot.way
    assert robot.advance(3) == []
    assert robot.way == way
    robot.free_distance = inf
    robot.advance(1)
    assert robot.way > way
    robot.free_distance = 0.3
    assert robot.advance(7) == [Answer.BLOCKED]


def test_target_object_is_not_an_obstacle():
    seeker = Seeker(SeekSettings(distance=0.3))
    robot = Robot(seeker, (2.0, 0.0))
    seeker.begin()
    for _ in range(300):
        robot.free_distance = 1.85 - robot.x
        if robot.step().event is Answer.ARRIVED:
            break
    assert 1.85 - robot.x == pytest.approx(0.3, abs=0.05)


def test_seeker_follows_moving_object_until_stopped():
    seeker = Seeker()
    robot = Robot(seeker, (1.0, 0.0))
    seeker.begin(follow=True)
    events = []
    for step in range(400):
        robot.target = (1.0 + 0.02 * step, sin(step / 60))
        move = robot.step()
        events += [move.event] if move.event else []
    assert events == [Answer.FOUND]
    assert hypot(robot.target[0] - robot.x, robot.target[1] - robot.y) < 1.3
    seeker.stop()
    assert robot.advance(1) == []
    assert robot.step().linear == 0.0
