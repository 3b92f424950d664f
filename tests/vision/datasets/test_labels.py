"""Labels are exact, compared with projected shapes and with another renderer."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.sdf.optics import Optics
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.rendering.factory import make_renderer
from linkwright.simulation.rendering.renderer import Channels, compute_image_axes
from linkwright.vision.datasets.arrangement import Arrangement, arrange
from linkwright.vision.datasets.classes import find_objects, make_default_rules
from linkwright.vision.datasets.labels import encode_run_lengths, find_bounding_box, label_image
from linkwright.vision.datasets.options import Options
from linkwright.vision.datasets.randomized_world import RandomizedWorld
from tests.simulation.worlds import load_simulation
from tests.vision.datasets.masks import color_mask
from tests.vision.datasets.places import SIGN_MODEL, world_text, write_yard

OPTIONS = Options(width=320, height=240)


@pytest.fixture
def world(tmp_path):
    simulation = load_simulation(write_yard(tmp_path))
    world = RandomizedWorld(simulation, find_objects(simulation, make_default_rules([simulation])), 2, 4)
    world.set_patterns(np.random.default_rng(0))
    yield world
    world.close()


def take_shots(world, count):
    for number in range(count):
        world.reset()
        yield arrange(world, OPTIONS, np.random.default_rng(number))


def label_arrangement(world, arrangement):
    geoms = world.renderer.render(arrangement.optics, arrangement.pose, Channels.GEOMS).geoms
    return label_image(world, arrangement, geoms, OPTIONS.min_size, OPTIONS.min_visible), geoms


def arrange_alone(arrangement, movable):
    return Arrangement(arrangement.optics, arrangement.pose, (movable,), ())


def test_run_lengths_match_mask():
    masks = np.random.default_rng(0).random((20, 7, 5)) < 0.5
    for mask in (*masks, np.zeros((7, 5), bool), np.ones((7, 5), bool)):
        counts = encode_run_lengths(mask)
        assert sum(counts) == mask.size
        assert all(count > 0 for count in counts[1:])
        assert (color_mask(counts, 7, 5) == mask).all()


def test_box_of_mask_is_computed():
    mask = np.zeros((6, 8), bool)
    assert find_bounding_box(mask) is None
    mask[2, 3] = mask[4, 1] = True
    assert find_bounding_box(mask) == (1, 2, 4, 5)


def test_full_boxes_of_balls_match_projected_outlines(world):
    """The cone of tangent rays gives the exact outline of a ball."""
    compared = 0
    for arrangement in take_shots(world, 12):
        labels, _ = label_arrangement(world, arrangement)
        label_by_box = {label.full_box: label for label in labels}
        axes = compute_image_axes(arrangement.pose)
        for movable in (placed_object for placed_object in arrangement.placed_objects if placed_object.label == 0):
            center = (world.simulation.data.geom_xpos[movable.geoms[0]] - np.array(arrangement.pose[:3])) @ axes
            if center[2] < 0.5:
                continue
            ends = [projected_outline(center[axis], center[2], 0.2) for axis in (0, 1)]
            expected = np.array(
                [
                    arrangement.optics.cx + arrangement.optics.fx * ends[0][0],
                    arrangement.optics.cy + arrangement.optics.fy * ends[1][0],
                    arrangement.optics.cx + arrangement.optics.fx * ends[0][1],
                    arrangement.optics.cy + arrangement.optics.fy * ends[1][1],
                ]
            )
            if not ((expected > -100) & (expected < 340)).all():
                continue
            matching_boxes = [box for box in label_by_box if np.abs(np.array(box) - expected).max() <= 2.0]
            hidden = not any(label.label == 0 for label in labels)
            assert matching_boxes or hidden or is_covered(world, arrangement, movable)
            compared += bool(matching_boxes)
    assert compared >= 5


def is_covered(world, arrangement, movable):
    geoms = world.renderer.render(arrangement.optics, arrangement.pose, Channels.GEOMS).geoms
    return not np.isin(geoms, movable.geoms).any()


def projected_outline(sideways, forward, radius):
    """Return the minimum and maximum slope of the rays in a plane that touch a circle."""
    distance = np.hypot(sideways, forward)
    center_angle, half_angle = np.arctan2(sideways, forward), np.arcsin(min(radius / distance, 1.0))
    return np.tan(center_angle - half_angle), np.tan(center_angle + half_angle)


def test_labels_match_mujoco_renderer(world):
    other = make_renderer(world.simulation, "mujoco")
    compared = 0
    for arrangement in take_shots(world, 8):
        labels, _ = label_arrangement(world, arrangement)
        geoms = other.render(arrangement.optics, arrangement.pose, Channels.GEOMS).geoms
        boxes = [find_bounding_box(np.isin(geoms, movable.geoms)) for movable in arrangement.placed_objects]
        for label in labels:
            if min(label.box[2] - label.box[0], label.box[3] - label.box[1]) >= 4:
                assert min(np.abs(np.array(box) - label.box).max() for box in boxes if box is not None) <= 1
                compared += 1
    assert compared >= 10


def test_visible_box_and_full_box_are_consistent(world):
    for arrangement in take_shots(world, 8):
        labels, geoms = label_arrangement(world, arrangement)
        for label in labels:
            left, top, right, bottom = label.box
            assert color_mask(label.run_lengths, *geoms.shape).sum() == label.area
            assert find_bounding_box(color_mask(label.run_lengths, *geoms.shape)) == label.box
            assert label.full_box[0] <= left
            assert label.full_box[1] <= top
            assert label.full_box[2] >= right
            assert label.full_box[3] >= bottom
            assert 0.0 < label.visibility <= 1.0
            inside = (
                label.full_box[0] >= 0
                and label.full_box[1] >= 0
                and label.full_box[2] <= 320
                and label.full_box[3] <= 240
            )
            assert label.is_truncated != inside


def test_unoccluded_objects_are_fully_visible(world):
    for arrangement in take_shots(world, 4):
        for movable in arrangement.placed_objects:
            for geoms in world.structures.values():
                world.hide(geoms)
            world.hide(world.distractors)
            for other in arrangement.placed_objects:
                if other is not movable:
                    world.hide(other.geoms)
            labels, _ = label_arrangement(world, arrange_alone(arrangement, movable))
            assert all(label.visibility > 0.97 or label.is_truncated for label in labels)
            break


def test_placed_objects_do_not_overlap(world):
    for arrangement in take_shots(world, 12):
        places = [
            (world.simulation.data.geom_xpos[movable.geoms, :2].mean(axis=0), movable.radius)
            for movable in arrangement.placed_objects
            if movable.label == 0
        ]
        for number, (place, _) in enumerate(places):
            for other, _ in places[:number]:
                assert np.linalg.norm(place - other) >= 0.4 - 1e-6


@pytest.mark.parametrize(("height", "focal", "ignored"), [(0.7, 414.0, True), (1.0, 180.0, False)])
def test_sign_is_ignored_unless_its_plate_is_visible(tmp_path, height, focal, ignored):
    path = tmp_path / "signs.world"
    path.write_text(world_text(SIGN_MODEL))
    simulation = load_simulation(path)
    world = RandomizedWorld(simulation, find_objects(simulation, make_default_rules([simulation])), 1, 0)
    try:
        world.set_patterns(np.random.default_rng(0))
        world.place_object(world.movable_objects[0], np.zeros(3), np.eye(3))
        optics = Optics(320, 240, focal, focal, 160, 120, 0.03, 30.0)
        arrangement = Arrangement(optics, (-2.0, 0.0, height, 0.0, 0.0, 0.0, 1.0), (world.movable_objects[0],), ())
        geoms = world.renderer.render(arrangement.optics, arrangement.pose, Channels.GEOMS).geoms
        (label,) = label_image(world, arrangement, geoms, 12, 0.3)
    finally:
        world.close()
    assert label.visibility >= 0.3  # the whole sign is visible enough; without its plate, it is a pole
    assert label.is_ignored == ignored


def test_distractors_do_not_resemble_balls_and_drums(world):
    model, kinds = world.simulation.model, load_mujoco().mjtGeom
    for number in range(20):
        for geom in world.distractors:
            world.shape_distractor(geom, np.random.default_rng(number))
            half_extents = model.geom_aabb[geom, 3:]
            assert half_extents.max() >= 2.4 * half_extents.min()
            if model.geom_type[geom] == kinds.mjGEOM_CAPSULE:
                assert model.geom_size[geom, 1] >= 1.5 * model.geom_size[geom, 0]


def test_few_objects_are_placed_behind_walls(world):
    """The wall of the yard is 6 m long, and 3 m from the center of the yard."""
    hidden_count = objects = 0
    for arrangement in take_shots(world, 40):
        for movable in arrangement.placed_objects:
            object_position = world.simulation.data.geom_xpos[movable.geoms, :2].mean(axis=0)
            camera_position = np.array(arrangement.pose[:2])
            objects += 1
            if (
                min(camera_position[1], object_position[1]) < 2.95
                and max(camera_position[1], object_position[1]) > 3.05
            ):
                crossing = camera_position[0] + (object_position[0] - camera_position[0]) * (
                    3.0 - camera_position[1]
                ) / (object_position[1] - camera_position[1])
                hidden_count += bool(arrangement.structures) and abs(crossing) < 3.0
    assert objects > 50
    assert hidden_count < 0.2 * objects
