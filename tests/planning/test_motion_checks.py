"""Checks of motions between the configurations that are given."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.geometry.shapes import Box
from linkwright.planning.collision_scene import CollisionScene, SceneObject
from linkwright.planning.motion_checks import RANGE_M, CheckedConfiguration, MotionCheck
from linkwright.planning.robot_model import PlacedShape
from tests.planning.arms import arm

pytestmark = pytest.mark.extra("arm")

STRETCHED = {"lift": 1.5708}
"""The arm is stretched out along x, with the tool 0.87 m in front of the base, 0.2 m above the ground."""


def plate(name: str, center: tuple[float, float, float], link: str = "") -> SceneObject:
    shape = PlacedShape(Box((0.05, 5e-4, 0.05)), np.array((0, 0, 0, 0, 0, 0, 1.0)))
    return SceneObject(name, (shape,), np.array((*center, 0, 0, 0, 1.0)), link)


def check(pans: list[float], *objects: SceneObject) -> list[CheckedConfiguration]:
    scene = CollisionScene(arm().robot, arm().shapes, objects, arm().allowed())
    with scene.measuring_up_to(RANGE_M):
        motion = [arm().positions(**STRETCHED | {"pan": pan})[arm().indexes] for pan in pans]
        return list(MotionCheck(scene, arm().positions(), arm().indexes).check(motion))


HELD, STANDING = plate("held", (0.0, 0.0, 0.1), "tool"), plate("standing", (0.97, 0.0, 0.2))
"""Two plates of half a millimeter, one at the tool and one in its way."""


def test_collision_between_two_configurations_is_found() -> None:
    first, *between, last = check([-0.0015, 0.0015], HELD, STANDING)
    assert first.distance > 1e-4
    assert last.distance > 1e-4
    assert min(configuration.distance for configuration in between) < 0.0


def test_approach_without_collision_is_certainly_free() -> None:
    approach = check([-0.0015, -0.0011, -0.0007], HELD, STANDING)
    assert all(configuration.is_reached_freely for configuration in approach)
    assert 0.0 < approach[-1].distance < approach[0].distance


def test_shapes_that_slide_along_each_other_are_not_split_without_end() -> None:
    box = PlacedShape(Box((0.08, 0.5, 0.02)), np.array((0, 0, 0, 0, 0, 0, 1.0)))
    table = SceneObject("table", (box,), np.array((0.97, 0.0, 0.2 - 0.025 - 0.01 - 2e-5, 0, 0, 0, 1.0)))
    sliding = check([-0.004, 0.0, 0.004], HELD, table)
    assert len(sliding) <= 5
    assert all(configuration.is_reached_freely and 0.0 < configuration.distance < 5e-5 for configuration in sliding)


def test_configurations_without_anything_near_are_only_those_of_the_motion() -> None:
    assert [checked.distance for checked in check([-0.5, -0.495, -0.49], HELD, STANDING)] == [RANGE_M] * 3


def test_shapes_that_keep_their_distance_need_no_more_configurations() -> None:
    near = SceneObject("near", HELD.shapes, HELD.pose + np.array((0.0, 0.001, 0.0, 0, 0, 0, 0)), "flange")
    assert len(check([0.0, 0.005, 0.01], HELD, near)) == 3


def test_range_is_that_of_before_after_the_block() -> None:
    scene = CollisionScene(arm().robot, arm().shapes, [HELD, STANDING], arm().allowed())
    positions = arm().positions(**STRETCHED | {"pan": 0.0015})
    assert not scene.measure_nearness(positions).distances
    with scene.measuring_up_to(RANGE_M):
        assert scene.measure_nearness(positions).distances
        assert scene.is_free(positions)
    assert not scene.measure_nearness(positions).distances
