"""What collides in a planning scene."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.geometry.shapes import Box, Sphere
from linkwright.planning.collision_scene import AllowedCollisions, CollisionScene, LinkMargin, SceneObject
from linkwright.planning.robot_model import PlacedShape
from linkwright.planning.shapes import hull_corners, scale_shape
from tests.planning.arms import arm

pytestmark = pytest.mark.extra("arm")

IDENTITY = np.array((0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0))


def pose(x: float, y: float, z: float) -> np.ndarray:
    return np.array((x, y, z, 0.0, 0.0, 0.0, 1.0))


def scene(*objects: SceneObject, allowed: AllowedCollisions | None = None) -> CollisionScene:
    return CollisionScene(arm().robot, arm().shapes, objects, allowed or arm().allowed())


def ball(name: str, radius: float, *, at: np.ndarray, **more: object) -> SceneObject:
    return SceneObject(name, (PlacedShape(Sphere(radius), IDENTITY),), at, **more)  # type: ignore[arg-type]


class TestCollisionScene:
    def test_straight_arm_is_free(self) -> None:
        assert scene().is_free(arm().positions())
        assert scene().contacts(arm().positions()) == []

    def test_folded_arm_collides_with_itself(self) -> None:
        contacts = scene().contacts(arm().positions(elbow=2.8, lift=0.3, bend=1.5))
        assert {frozenset((contact.first, contact.second)) for contact in contacts}

    @pytest.mark.parametrize(("distance", "is_free"), [(0.0401, True), (0.0399, False)])
    def test_sphere_touches_cylinder_at_the_sum_of_the_radii(self, distance: float, is_free: bool) -> None:
        # The upper arm has a radius of 0.04 m, and extends from z = 0.2 to z = 0.5.
        near = scene(ball("ball", 0.1, at=pose(0.1 + distance, 0.0, 0.35)))
        assert near.is_free(arm().positions()) is is_free
        for contact in near.contacts(arm().positions()):
            assert {contact.first, contact.second} == {"ball", "upper_arm"}
            assert contact.depth == pytest.approx(0.0001, abs=2e-5)

    @pytest.mark.parametrize(("depth", "collides"), [(5e-8, False), (1e-6, True)])
    def test_depth_by_rounding_is_a_touch_for_all_checks(self, depth: float, collides: bool) -> None:
        near = scene(ball("ball", 0.1, at=pose(0.14 - depth, 0.0, 0.35)))
        every_shape = np.ones(len(near.shape_frames(arm().positions())), dtype=bool)
        assert near.is_free(arm().positions()) is not collides
        assert bool(near.contacts(arm().positions())) is collides
        assert (near.find_colliding_pair(arm().positions(), every_shape) is not None) is collides
        assert near.colliding_pairs(arm().positions()) == {frozenset(("ball", "upper_arm"))}

    def test_object_moves_with_the_link_that_holds_it(self) -> None:
        held = ball("held", 0.05, at=pose(0.0, 0.0, 0.1), link="tool", touch_links=frozenset(("tool",)))
        wall = SceneObject("wall", (PlacedShape(Box((0.1, 2.0, 2.0)), IDENTITY),), pose(0.92, 0.0, 0.5))
        reaching = arm().positions(lift=1.2)
        assert scene(wall).is_free(reaching)
        contacts = scene(held, wall).contacts(reaching)
        assert {frozenset((contact.first, contact.second)) for contact in contacts} == {frozenset(("held", "wall"))}

    def test_allowed_pair_is_left_out(self) -> None:
        obstacle = ball("ball", 0.1, at=pose(0.1, 0.0, 0.35))
        allowed = arm().allowed()
        allowed.defaults["ball"] = True
        assert scene(obstacle, allowed=allowed).is_free(arm().positions())
        allowed.pairs[frozenset(("ball", "upper_arm"))] = False
        assert not scene(obstacle, allowed=allowed).is_free(arm().positions())

    def test_mesh_is_replaced_by_its_hull(self) -> None:
        corners = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=np.float64)
        hull = hull_corners(np.concatenate((corners, [(0.5, 0.5, 0.5)])))
        assert hull is not None
        assert sorted(map(tuple, hull.tolist())) == sorted(map(tuple, corners.tolist()))
        assert hull_corners(corners[:4]) is None


class TestMargins:
    @pytest.mark.parametrize(
        ("margin", "reach"),
        [
            (LinkMargin(), 0.04),
            (LinkMargin(padding=0.02), 0.06),
            (LinkMargin(scale=1.5), 0.06),
            (LinkMargin(0.01, 1.5), 0.07),
        ],
    )
    @pytest.mark.parametrize("gap", [-1e-4, 1e-4])
    def test_objects_keep_away_from_a_link(self, margin: LinkMargin, reach: float, gap: float) -> None:
        near = ball("ball", 0.1, at=pose(0.1 + reach + gap, 0.0, 0.35))
        checked = CollisionScene(arm().robot, arm().shapes, [near], arm().allowed(), {"upper_arm": margin})
        assert checked.is_free(arm().positions()) is (gap > 0.0)
        assert [contact.depth for contact in checked.contacts(arm().positions())] == pytest.approx(
            [-gap] if gap < 0.0 else [], abs=2e-5
        )

    def test_attached_objects_have_the_margin_of_their_link(self) -> None:
        held = ball("held", 0.05, at=pose(0.0, 0.0, 0.1), link="flange", touch_links=frozenset(("flange", "palm")))
        arm().model.move(arm().positions())
        z = float(arm().model.link_pose("flange")[2]) + 0.1 + 0.05
        ceiling = SceneObject("ceiling", (PlacedShape(Box((1.0, 1.0, 0.1)), IDENTITY),), pose(0.0, 0.0, z + 0.06))
        for padding, is_free in ((0.0, True), (0.02, False)):
            checked = CollisionScene(arm().robot, {}, [held, ceiling], arm().allowed(), {"flange": LinkMargin(padding)})
            assert checked.is_free(arm().positions()) is is_free

    def test_links_keep_their_size_toward_each_other(self) -> None:
        margins = {link: LinkMargin(0.05, 1.2) for link in arm().robot.links}
        checked = CollisionScene(arm().robot, arm().shapes, [], arm().allowed(), margins)
        random = np.random.default_rng(1)
        for _ in range(200):
            positions = arm().positions()
            positions[arm().indexes] = arm().group.sample(random)
            assert checked.is_free(positions) is scene().is_free(positions)

    def test_hull_is_scaled_around_its_middle(self) -> None:
        corners = np.array([(x, y, z) for x in (1.0, 3.0) for y in (0.0, 2.0) for z in (-1.0, 1.0)])
        scaled = scale_shape(PlacedShape(corners, IDENTITY), 2.0).shape
        assert isinstance(scaled, np.ndarray)
        np.testing.assert_allclose((scaled.min(axis=0), scaled.max(axis=0)), ((0.0, -1.0, -2.0), (4.0, 3.0, 2.0)))


@pytest.mark.parametrize(("gap", "expected"), [(0.01, 0.01), (0.03, 0.03), (0.06, 0.05), (-0.01, 0.0)])
@pytest.mark.parametrize("padding", [0.0, 0.02])
def test_clearances_are_measured_within_the_range(gap: float, expected: float, padding: float) -> None:
    near = ball("ball", 0.1, at=pose(0.14 + padding + gap, 0.0, 0.35))
    margins = {"upper_arm": LinkMargin(padding)}
    checked = CollisionScene(arm().robot, arm().shapes, [near], arm().allowed(), margins, range_m=0.05)
    to_self, to_world = checked.clearances(arm().positions())
    assert to_world == pytest.approx(expected, abs=1e-5)
    assert to_self == pytest.approx(0.05, abs=0.05)
    assert checked.is_free(arm().positions()) is (gap > 0.0)
    assert len(checked.contacts(arm().positions())) == (gap < 0.0)
