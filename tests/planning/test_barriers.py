"""Positions of joints that no path can pass."""

from __future__ import annotations

from dataclasses import replace
from time import perf_counter

import numpy as np
import pytest

from linkwright.geometry.shapes import Box
from linkwright.planning.barriers import Barrier, Barriers
from linkwright.planning.collision_scene import CollisionScene, SceneObject
from linkwright.planning.goals import Goal, JointTarget
from linkwright.planning.groups import JointGroup
from linkwright.planning.planner import Failure, MotionPlanner, PlanError, PlanRequest
from linkwright.planning.robot_model import PlacedShape
from tests.planning.arms import arm

pytestmark = pytest.mark.extra("arm")

FORWARD, BACKWARD = {"lift": 1.3, "elbow": 0.5}, {"lift": -1.3, "elbow": -0.5}


def box(name: str, size: tuple[float, float, float], center: tuple[float, float, float], link: str = "") -> SceneObject:
    shape = PlacedShape(Box(size), np.array((0, 0, 0, 0, 0, 0, 1.0)))
    return SceneObject(name, (shape,), np.array((*center, 0, 0, 0, 1.0)), link)


CEILING = box("ceiling", (3.0, 3.0, 0.02), (0.0, 0.0, 0.4))
"""A plate below the elbow of the upright arm, which keeps the upper arm from swinging to the other side."""


def find(goal: dict[str, float], *objects: SceneObject, group: JointGroup | None = None) -> Barrier | None:
    scene = CollisionScene(arm().robot, arm().shapes, objects, arm().allowed())
    barriers = Barriers(scene, group or arm().group, arm().indexes, arm().positions(**FORWARD))
    return barriers.find(arm().positions(**goal))


def test_barrier_is_a_position_at_which_the_links_up_to_the_joint_collide() -> None:
    barrier = find(BACKWARD, CEILING)
    assert barrier is not None
    assert (barrier.joint, barrier.pair, barrier.is_only_pair) == ("lift", ("ceiling", "upper_arm"), True)
    # The upper arm is 0.3 m long, and its joint is 0.2 m below the plate.
    assert abs(barrier.position) < np.arccos(0.19 / 0.3) + 0.2
    assert str(barrier) == f"'lift' cannot pass {barrier.position:.2f}, where 'ceiling' and 'upper_arm' collide"


def test_goal_on_the_same_side_has_no_barrier() -> None:
    assert find(FORWARD | {"pan": 2.0, "elbow": 1.0}, CEILING) is None


def test_passage_for_some_positions_of_the_joints_before_is_no_barrier() -> None:
    assert find(BACKWARD, box("half", (3.0, 3.0, 0.02), (0.0, 1.7, 0.4))) is None


def test_collisions_of_the_links_after_the_joint_are_no_barrier() -> None:
    assert find(BACKWARD, box("high ceiling", (3.0, 3.0, 0.02), (0.0, 0.0, 0.6))) is None
    assert find(BACKWARD, box("large tool", (0.5, 0.5, 0.5), (0.0, 0.0, 0.3), link="tool")) is None


def test_continuous_joints_have_no_barrier() -> None:
    turning = replace(arm().group, is_continuous=np.array([name == "lift" for name in arm().group.joint_names]))
    assert find(BACKWARD, CEILING, group=turning) is None


def test_failure_tells_of_the_barrier_long_before_the_time_is_over() -> None:
    scene = CollisionScene(arm().robot, arm().shapes, [CEILING], arm().allowed())
    targets = {name: JointTarget(BACKWARD.get(name, 0.0)) for name in arm().group.joint_names}
    request = PlanRequest(arm().group, arm().positions(**FORWARD), [Goal(targets)], timeout_s=120.0)
    begin = perf_counter()
    with pytest.raises(PlanError) as caught:
        MotionPlanner(arm().model, scene).plan(request)
    assert perf_counter() - begin < 60.0
    assert caught.value.failure is Failure.PLANNING_FAILED
    assert str(caught.value).startswith("no path to the goal was found: 'lift' cannot pass ")
