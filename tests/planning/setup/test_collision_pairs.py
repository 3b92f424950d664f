"""The pairs of links whose collisions need no checks, and the reasons."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from linkwright.inertia.mesh_library import MeshLibrary
from linkwright.packages import PackageFinder
from linkwright.planning.collision_scene import AllowedCollisions, CollisionScene
from linkwright.planning.setup.collision_pairs import ClosedGripper, CollisionPairs, find_collision_pairs, link_pair
from linkwright.planning.setup.link_surfaces import LinkSurfaces, do_triangles_intersect
from linkwright.planning.setup.position_sampler import PositionSampler
from linkwright.planning.shapes import robot_shapes
from linkwright.urdf import Robot
from tests.planning.arms import arm
from tests.planning.setup.robots import chain, joint, link, robot, two_arms

pytestmark = pytest.mark.extra("arm")


def find(description: Robot, *grippers: ClosedGripper, samples: int = 2000) -> CollisionPairs:
    meshes = MeshLibrary(PackageFinder(), Path())
    shapes, errors = robot_shapes(description, meshes)
    assert not errors
    return find_collision_pairs(description, shapes, LinkSurfaces(description, meshes), grippers, samples)


def test_reasons_of_an_arm() -> None:
    pairs = find(arm().robot)
    assert pairs.disabled["base", "shoulder"] == "Adjacent"
    assert pairs.disabled["forearm", "palm"] == "Never"
    assert ("base", "flange") not in pairs.disabled
    assert len(pairs.disabled) + pairs.checked == 9 * 8 // 2


def test_result_is_the_same_each_time() -> None:
    assert find(two_arms()) == find(two_arms())


def test_no_pair_is_disabled_that_collides_in_other_positions() -> None:
    description = two_arms()
    pairs = find(description)
    shapes, _ = robot_shapes(description, MeshLibrary(PackageFinder(), Path()))
    known = AllowedCollisions({frozenset(pair): True for pair, reason in pairs.disabled.items() if reason != "Never"})
    scene, sampler, random = (
        CollisionScene(description, shapes, (), known),
        PositionSampler(description),
        np.random.default_rng(5),
    )
    seen = {link_pair(pair) for _ in range(5000) for pair in scene.colliding_pairs(sampler.sample(random))}
    assert seen
    assert not seen.intersection(pairs.disabled)


def test_rare_collision_is_found_by_search() -> None:
    """Two small boxes on rails meet in so few positions that sampling alone misses them."""
    text = link("base")
    for name, axis, x in (("a", "1 0 0", 5.0), ("b", "0 1 0", 5.7)):
        text += link(f"{name}_rail") + joint(
            f"{name}_1", "base", f"{name}_rail", kind="prismatic", axis=axis, xyz=f"{x} 0 0"
        )
        text += link(name, 0.01) + joint(f"{name}_2", f"{name}_rail", name, kind="prismatic", axis="0 0 1", xyz="1 1 0")
    assert ("a", "b") not in find(robot(text), samples=20).disabled


def test_siblings_on_a_link_without_shapes_are_not_adjacent() -> None:
    text = link("base") + link("a", 0.1) + joint("first", "base", "a") + link("b", 0.1) + joint("second", "base", "b")
    assert find(robot(text)).disabled["a", "b"] != "Adjacent"
    through = link("base", 0.1) + link("m") + joint("first", "base", "m") + link("b", 0.1) + joint("second", "m", "b")
    assert find(robot(through)).disabled == {("b", "base"): "Adjacent"}


def test_links_that_touch_by_default_and_often_are_disabled() -> None:
    text = link("base", 0.1) + link("a", 0.1) + joint("first", "base", "a", xyz="0 0 0.2", axis="0 0 1")
    text += link("b", 0.1) + joint("second", "base", "b", xyz="0.02 0 0.2", axis="0 0 1")
    assert find(robot(text)).disabled["a", "b"] == "Default"


def test_links_that_touch_by_default_but_seldom_are_checked() -> None:
    text = link("base") + link("a", 0.1) + joint("first", "base", "a", kind="prismatic", axis="1 0 0")
    text += link("b", 0.1) + joint("second", "base", "b", kind="prismatic", axis="1 0 0")
    text += link("c", 0.001) + joint("third", "base", "c", kind="prismatic", axis="1 0 0", xyz="0 3 0")
    assert ("a", "b") not in find(robot(text)).disabled
    assert find(robot(text), ClosedGripper(frozenset(("a", "b")), np.zeros(3))).disabled["a", "b"] == "Default"


def test_fingers_that_touch_when_closed_are_disabled() -> None:
    text = link("base", 0.01)
    for name, sign in (("a", 1), ("b", -1)):
        text += link(name, 0.1) + joint(
            name, "base", name, kind="prismatic", axis=f"0 {sign} 0", xyz=f"0 {sign * 0.05} 0.3", limits=(0.0, 0.5)
        )
    assert ("a", "b") not in find(robot(text)).disabled
    gripper = ClosedGripper(frozenset(("a", "b")), np.zeros(2))
    assert find(robot(text), gripper).disabled["a", "b"] == "Default"


def test_links_that_nearly_always_touch_are_disabled() -> None:
    """The default positions are the only ones in which the box on the slide is clear of the other one."""
    text = link("base") + link("a", 1.0) + joint("first", "base", "a", kind="prismatic", axis="1 0 0", limits=(0, 0.2))
    text += link("b", 1.0) + joint(
        "second", "base", "b", kind="prismatic", axis="0 0 1", limits=(0.0, 30.0), xyz="0 0 1.01"
    )
    text = text.replace(
        "size='1.0 1.0 1.0'/></geometry></collision></link><joint name='second'",
        "size='1 1 60'/></geometry></collision></link><joint name='second'",
    )
    text = text.replace("xyz='0 0 1.01'", "xyz='0 0 -30.6'")
    assert find(robot(text)).disabled["a", "b"] == "Always"


def test_fixed_links_are_disabled_whether_they_touch_or_not() -> None:
    text = link("base", 0.1) + link("m", 0.1) + joint("m_mount", "base", "m", kind="fixed", xyz="0 0 0.1")
    for name, x in (("near", 0.05), ("far", 1.0)):
        text += link(name, 0.1) + joint(f"{name}_mount", "base", name, kind="fixed", xyz=f"{x} 0 0.1")
    text += chain("base", "", 3)
    pairs = find(robot(text)).disabled
    assert pairs["m", "near"] == "Default"
    assert pairs["far", "m"] == "Never"


@pytest.mark.parametrize(("height", "expected"), [(0.5, True), (1.5, False), (-0.2, False)])
def test_triangles_intersect(height: float, expected: bool) -> None:
    flat = np.array([[[0.0, 0.0, height], [2.0, 0.0, height], [0.0, 2.0, height]]])
    upright = np.array([[[0.2, 0.2, 0.0], [0.4, 0.2, 0.0], [0.3, 0.3, 1.0]]])
    assert do_triangles_intersect(flat, upright) is expected
    assert do_triangles_intersect(upright, flat) is expected


def test_meshes_decide_where_only_their_hulls_touch(tmp_path: Path) -> None:
    """A ball moves in a bowl, whose hull it is always in."""
    bowl = _bowl(tmp_path / "bowl.stl")
    text = (
        link("base", 0.001)
        + f"<link name='bowl'><collision><geometry><mesh filename='{bowl}'/></geometry></collision></link>"
    )
    text += joint("turn", "base", "bowl", axis="0 0 1") + link("arm", 0.01)
    text += joint("slide", "base", "arm", kind="prismatic", axis="0 0 1", xyz="0 0 0", limits=(0.0, 0.1))
    assert find(robot(text)).disabled["arm", "bowl"] == "Never"


def _bowl(path: Path) -> Path:
    """Write an open box of four walls around the z axis as ASCII STL."""
    corners = [(0.5, 0.5), (-0.5, 0.5), (-0.5, -0.5), (0.5, -0.5)]
    lines: list[Any] = ["solid bowl"]
    for index, (x, y) in enumerate(corners):
        u, v = corners[(index + 1) % 4]
        for triangle in (((x, y, -1), (u, v, -1), (u, v, 1)), ((x, y, -1), (u, v, 1), (x, y, 1))):
            lines.append("facet normal 0 0 0\nouter loop")
            lines += [f"vertex {a} {b} {c}" for a, b, c in triangle]
            lines.append("endloop\nendfacet")
    path.write_text("\n".join([*lines, "endsolid bowl", ""]))
    return path
