"""Navigation of mbot in the house.

It uses the parameters and the launch file of my_robot_navigation.
"""

from __future__ import annotations

import math

import pytest

from linkwright.graph.actions.goal import GoalStatus
from tests.places import GAZEBO_PACKAGE
from tests.robots.house import House

pytest.importorskip("mujoco")
pytest.importorskip("scipy")

GOALS = [
    (-3.0, 0.2, 0.0),
    (-1.9, 1.8, 1.57),
    (-2.6, 1.5, 3.14),
    (0.0, 1.8, 1.57),
    (2.5, 2.0, 0.0),
    (3.8, 2.4, 0.0),
    (1.6, 3.2, 1.57),
    (0.0, 0.0, 0.0),
    (2.8, 0.3, 0.0),
    (3.0, -1.2, -1.57),
    (2.2, -3.4, 3.14),
    (3.9, -3.4, 0.0),
    (3.0, -2.6, 0.0),
    (0.6, -3.0, -1.57),
    (-0.9, -3.2, 3.14),
    (-2.4, -2.6, 1.57),
    (-3.5, -0.7, 3.14),
    (-4.4, 0.2, 3.14),
    (-1.7, 2.6, 0.0),
    (0.3, -0.5, 0.0),
]
"""Goals in all rooms, below the table, and between the furniture."""


@pytest.mark.slow
def test_twenty_goals_in_all_rooms_are_reached_without_contact():
    with House() as house:
        for x, y, yaw in GOALS:
            assert house.go_to(x, y, yaw) == GoalStatus.SUCCEEDED, (x, y)
            assert math.dist(house.place(), (x, y)) < 0.3
        assert house.touched == set()


def test_robot_passes_door_and_goal_is_canceled():
    with House() as house:
        assert house.go_to(-1.9, 1.6, 1.57) == GoalStatus.SUCCEEDED
        assert math.dist(house.place(), (-1.9, 1.6)) < 0.3
        results = house.send(0.0, 0.0)
        house.advance_and_watch(3.0)
        before = house.place()
        house.goal.cancel_goal_async()
        house.advance_and_watch(2.0)
        assert results[0].status == GoalStatus.CANCELED
        after = house.place()
        assert math.dist(before, after) < 0.3
        house.advance_and_watch(1.0)
        assert math.dist(after, house.place()) < 0.01, "mbot stands still"
        assert house.touched == set()


def test_contacts_are_detected():
    with House() as house:
        house.drive(0.5)
        house.advance_and_watch(5.0)
        assert house.touched == {"walls::link::wall_13#collision"}


def test_goal_in_wall_is_aborted_with_reason():
    with House() as house:
        assert house.go_to(-0.9, 2.4, seconds=20.0) == GoalStatus.ABORTED
        assert any("the goal (-0.90, 2.40) is" in text for text in house.logged())
        assert math.dist(house.place(), (0.0, 0.0)) < 0.05, "mbot did not move"


@pytest.mark.slow
def test_robot_avoids_obstacle_appearing_on_path():
    with House() as house:
        results = house.send(-3.2, 0.0)
        house.advance_and_watch(2.0)
        house.spawn(GAZEBO_PACKAGE / "models" / "crate" / "model.sdf", "crate", pose=(-1.6, 0.0, 0.0, 0.0, 0.0, 0.0))
        for _ in range(90):
            house.advance_and_watch(1.0)
            if results:
                break
        assert results, house.logged()[-5:]
        assert results[0].status == GoalStatus.SUCCEEDED
        assert math.dist(house.place(), (-3.2, 0.0)) < 0.3
        assert house.touched == set()
