"""Sensor and motion models of amcl: scans and motions with known results."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from linkwright.geometry.single import IDENTITY, Transform, quaternion_from_rpy
from linkwright.messages import get_message
from linkwright.navigation.grids.grid import FREE, OCCUPIED, UNKNOWN, Grid
from linkwright.navigation.localization.beams import Beams, beams_from_scan
from linkwright.navigation.localization.motion_models import (
    MotionModel,
    Noise,
    move_differentially,
    move_omnidirectionally,
)
from linkwright.navigation.localization.sensor_models import MODELS, BeamSkipping, LaserSettings, MapLikelihoods

_QUIET = Noise(0.0, 0.0, 0.0, 0.0, 0.0)


def make_room(yaw: float = 0.0) -> MapLikelihoods:
    """Return a room of 6 by 4 meters with walls; its corner is at (0, 0)."""
    cells = np.full((80, 120), FREE, np.int8)
    cells[[0, -1]] = cells[:, [0, -1]] = OCCUPIED
    return MapLikelihoods(Grid(cells=cells, resolution=0.05, yaw=yaw), LaserSettings())


def beams_in_room(x: float, y: float, yaw: float, count: int = 36) -> Beams:
    """Return the beams of a laser at the robot's center."""
    angles = np.linspace(-pi, pi, count, endpoint=False)
    directions = np.stack((np.cos(angles + yaw), np.sin(angles + yaw)), axis=-1)
    walls = np.where(directions > 0, (np.array((5.975, 3.975)) - (x, y)), (np.array((0.025, 0.025)) - (x, y)))
    directions = np.where(np.abs(directions) < 1e-9, np.copysign(1e-9, walls), directions)
    ranges = (walls / directions).min(axis=1)
    ends = ranges[:, None] * np.stack((np.cos(angles), np.sin(angles)), axis=-1)
    return Beams((0.0, 0.0), ends, ranges, 12.0)


@pytest.mark.parametrize("model", MODELS)
def test_true_pose_is_likeliest(model: str) -> None:
    offsets = np.array([(x, y, yaw) for x in (-0.4, 0, 0.4) for y in (-0.4, 0, 0.4) for yaw in (-0.3, 0, 0.3)])
    poses = np.array((2.0, 1.5, 0.4)) + offsets
    likelihoods = make_room().compute_likelihoods(model, poses, beams_in_room(2.0, 1.5, 0.4))
    assert likelihoods.argmax() == 13
    assert (likelihoods > 0.0).all()


@pytest.mark.parametrize("model", MODELS)
def test_true_pose_is_likeliest_on_rotated_map(model: str) -> None:
    rotated_room = make_room(yaw=pi / 2)
    poses = np.array([(-1.5, 2.0, 0.4 + pi / 2), (-1.5, 2.0, 0.4), (-2.5, 2.0, 0.4 + pi / 2)])
    assert rotated_room.compute_likelihoods(model, poses, beams_in_room(2.0, 1.5, 0.4)).argmax() == 0


def test_likelihood_matches_likelihood_field_formula() -> None:
    settings = LaserSettings(z_hit=0.6, z_rand=0.4, sigma_hit=0.1)
    cells = np.full((20, 40), FREE, np.int8)
    cells[:, 30] = OCCUPIED
    likelihoods = MapLikelihoods(Grid(cells=cells, resolution=0.1), settings)
    beams = Beams((0.0, 0.0), np.array([[1.0, 0.0]]), np.array([1.0]), 8.0)
    likelihood = likelihoods.compute_likelihoods(
        "likelihood_field", np.array([[2.05, 1.05, 0.0], [1.85, 1.05, 0.0]]), beams
    )
    probabilities = 0.6 * np.exp(-0.5 * (np.array([0.0, 0.2]) / 0.1) ** 2) + 0.4 / 8.0
    assert likelihood == pytest.approx(1.0 + probabilities**3, abs=1e-6)
    product = likelihoods.compute_likelihoods(
        "likelihood_field_prob", np.array([[2.05, 1.05, 0.0], [1.85, 1.05, 0.0]]), beams
    )
    assert product[1] / product[0] == pytest.approx(probabilities[1] / probabilities[0], rel=1e-5)


def test_beams_without_hit_are_neutral_and_beams_off_map_do_not_match() -> None:
    beams = Beams((0.0, 0.0), np.array([[12.0, 0.0]]), np.array([12.0]), 12.0)
    assert make_room().compute_likelihoods("likelihood_field", np.array([[2.0, 2.0, 0.0]]), beams).tolist() == [1.0]
    assert make_room().compute_matching_share((2.0, 2.0, 0.0), beams) is None
    assert make_room().compute_matching_share((500.0, -300.0, 0.0), beams_in_room(2.0, 2.0, 0.0)) == 0.0
    assert make_room().compute_matching_share((2.0, 2.0, 0.0), beams_in_room(2.0, 2.0, 0.0)) == 1.0


def test_beams_that_few_particles_explain_are_skipped() -> None:
    beams = beams_in_room(2.0, 1.5, 0.0)
    beams.end_points[:6] *= 0.4  # a person stands in these beams
    poses = np.array([(2.0, 1.5, 0.0), (2.1, 1.5, 0.0), (1.4, 1.5, 0.0)])
    likelihoods = make_room()
    without_skipping = likelihoods.compute_likelihoods("likelihood_field_prob", poses, beams)
    skipped = likelihoods.compute_likelihoods("likelihood_field_prob", poses, beams, BeamSkipping())
    remaining_beams = Beams((0.0, 0.0), beams.end_points[6:], beams.ranges[6:], 12.0)
    assert skipped == pytest.approx(
        likelihoods.compute_likelihoods("likelihood_field_prob", poses, remaining_beams), rel=1e-5
    )
    assert without_skipping[2] > 1.5 * skipped[2]


def test_random_poses_are_in_free_cells() -> None:
    cells = np.full((10, 10), UNKNOWN, np.int8)
    cells[3, 7] = FREE
    poses = MapLikelihoods(Grid(cells=cells, resolution=1.0), LaserSettings()).draw_random_poses(
        50, np.random.default_rng(1)
    )
    assert (np.floor(poses[:, :2]) == (7, 3)).all()
    assert np.ptp(poses[:, 2]) > 4.0


def _scan(ranges: list[float]) -> object:
    return get_message("sensor_msgs/msg/LaserScan")(
        angle_min=-pi / 2, angle_max=pi / 2, angle_increment=pi / 2, range_min=0.1, range_max=5.0, ranges=ranges
    )


def test_beams_of_scan_are_in_robot_frame() -> None:
    pose: Transform = (0.5, 0.0, 0.3, *quaternion_from_rpy((0.0, 0.0, pi / 2)))
    beams = beams_from_scan(_scan([1.0, 2.0, 3.0]), pose, 60)
    assert beams.end_points == pytest.approx(np.array([[1.5, 0.0], [0.5, 2.0], [-2.5, 0.0]]))
    assert beams.angles == pytest.approx([0.0, pi / 2, pi])


def test_beams_of_upside_down_laser_are_mirrored() -> None:
    upside_down: Transform = (0.0, 0.0, 0.3, *quaternion_from_rpy((pi, 0.0, 0.0)))
    beams = beams_from_scan(_scan([1.0, 2.0, 3.0]), upside_down, 60)
    assert beams.end_points == pytest.approx(np.array([[0.0, 1.0], [2.0, 0.0], [0.0, -3.0]]), abs=1e-12)


def test_invalid_and_out_of_range_beams_are_clamped_or_omitted() -> None:
    nan, inf = float("nan"), float("inf")
    assert beams_from_scan(_scan([nan, 0.05, inf]), IDENTITY, 60).ranges.tolist() == [5.0, 5.0]
    assert beams_from_scan(_scan([1.0, 3.0, 4.5]), IDENTITY, 60, 2.0, 4.0).ranges.tolist() == [4.0, 3.0, 4.0]
    assert len(beams_from_scan(_scan([1.0, 3.0, 4.5]), IDENTITY, 1).ranges) == 1
    assert len(beams_from_scan(_scan([]), IDENTITY, 60).ranges) == 0


@pytest.mark.parametrize("model", [move_differentially, move_omnidirectionally])
def test_particles_follow_odometry_without_noise(model: MotionModel) -> None:
    particles = np.array([[0.0, 0.0, 0.0], [5.0, 5.0, pi / 2]])
    model(particles, (1.0, 1.0, 0.0), (2.0, 1.5, 0.5), _QUIET, np.random.default_rng(0))
    assert particles == pytest.approx(np.array([[1.0, 0.5, 0.5], [4.5, 6.0, pi / 2 + 0.5]]))


def test_reversing_is_not_a_half_turn() -> None:
    random = np.random.default_rng(0)
    particles = np.zeros((4000, 3))
    move_differentially(particles, (0.0, 0.0, 0.0), (-1.0, 0.0, 0.0), Noise(0.2, 0.0, 0.0, 0.0), random)
    assert particles == pytest.approx(np.tile((-1.0, 0.0, 0.0), (4000, 1)), abs=1e-9)


@pytest.mark.parametrize(
    ("model", "noise", "column", "sigma"),
    [
        (move_differentially, Noise(0.0, 0.0, 0.04, 0.0), 0, 0.2),
        (move_omnidirectionally, Noise(0.0, 0.0, 0.04, 0.0), 0, 0.2),
        (move_omnidirectionally, Noise(0.0, 0.0, 0.0, 0.0, 0.04), 1, 0.2),
        (move_omnidirectionally, Noise(0.0, 0.04, 0.0, 0.0), 2, 0.2),
    ],
)
def test_motion_noise_matches_its_parameters(model: MotionModel, noise: Noise, column: int, sigma: float) -> None:
    particles = np.zeros((20_000, 3))
    model(particles, (0.0, 0.0, 0.0), (1.0, 0.0, 0.0), noise, np.random.default_rng(0))
    assert particles[:, column].std() == pytest.approx(sigma, rel=0.03)
