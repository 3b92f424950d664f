"""The particle filter: the number of particles, resampling, and the estimated pose."""

from __future__ import annotations

from math import ceil, pi, sqrt

import numpy as np
import pytest

from linkwright.navigation.localization.motion_models import Noise, Poses, move_differentially
from linkwright.navigation.localization.particle_filter import FilterSettings, ParticleFilter
from tests.navigation.localization.test_sensor_models import beams_in_room, make_room


def _no_random_poses(count: int) -> Poses:
    raise AssertionError(count)


def test_particles_have_given_mean_and_covariance() -> None:
    particle_filter = ParticleFilter(FilterSettings(max_particles=20_000))
    covariance = np.array([[0.25, 0.1, 0.0], [0.1, 0.16, 0.0], [0.0, 0.0, 0.04]])
    particle_filter.draw_around((1.0, -2.0, 3.0), covariance)
    assert particle_filter.particles.mean(axis=0) == pytest.approx([1.0, -2.0, 3.0], abs=0.02)
    assert np.cov(particle_filter.particles.T) == pytest.approx(covariance, abs=0.01)
    estimate = particle_filter.estimate()
    assert estimate.pose == pytest.approx((1.0, -2.0, 3.0), abs=0.02)
    assert estimate.covariance[:2, :2] == pytest.approx(covariance[:2, :2], abs=0.01)
    assert estimate.covariance[2, 2] == pytest.approx(0.04, abs=0.005)


def test_particle_count_follows_number_of_occupied_bins() -> None:
    settings = FilterSettings(min_particles=100, max_particles=5000)
    particle_filter = ParticleFilter(settings)
    bins = 40
    poses = np.column_stack((np.arange(bins) * 0.5 + 0.25, np.full(bins, 0.25), np.full(bins, 0.01)))
    particle_filter.set_particles(np.repeat(poses, 100, axis=0))
    particle_filter.resample(_no_random_poses)
    b = 2.0 / (9.0 * (bins - 1))
    assert len(particle_filter.particles) == ceil((bins - 1) / 0.1 * (1.0 - b + sqrt(b) * 0.99) ** 3) + 1
    particle_filter.set_particles(np.repeat(poses[:2], 100, axis=0))
    particle_filter.resample(_no_random_poses)
    assert len(particle_filter.particles) == 101


def test_resampling_follows_weights() -> None:
    particle_filter = ParticleFilter(FilterSettings())
    particle_filter.set_particles(np.array([(0.25, 0.25, 0.01), (3.25, 0.25, 0.01), (6.25, 0.25, 0.01)]))
    particle_filter.update_weights(np.array([1.0, 0.0, 3.0]))
    particle_filter.resample(_no_random_poses)
    identifiers, counts = np.unique(particle_filter.particles[:, 0], return_counts=True)
    assert identifiers.tolist() == [0.25, 6.25]
    assert counts[1] / counts.sum() == pytest.approx(0.75, abs=0.05)


def test_estimate_is_mean_of_likeliest_cluster() -> None:
    particle_filter = ParticleFilter(FilterSettings())
    # The headings are on both sides of the jump from pi to -pi.
    large_cluster = np.random.default_rng(0).normal((2.0, 1.0, pi), (0.2, 0.2, 0.2), (600, 3))
    large_cluster[:, 2] = (large_cluster[:, 2] + pi) % (2 * pi) - pi
    small_cluster = np.random.default_rng(1).normal((8.0, 5.0, 0.0), 0.1, (400, 3))
    particle_filter.set_particles(np.concatenate((large_cluster, small_cluster)))
    estimate = particle_filter.estimate()
    assert estimate.weight == pytest.approx(0.6, abs=0.01)
    assert estimate.pose[:2] == pytest.approx((2.0, 1.0), abs=0.03)
    assert abs(estimate.pose[2]) == pytest.approx(pi, abs=0.03)
    assert not particle_filter.has_converged()
    particle_filter.set_particles(small_cluster)
    assert particle_filter.has_converged()


def test_random_particles_are_added_when_likelihood_drops() -> None:
    particle_filter = ParticleFilter(FilterSettings(recovery_alpha_slow=0.001, recovery_alpha_fast=0.5))
    particle_filter.set_particles(np.tile((1.0, 1.0, 0.0), (1000, 1)))
    random_counts: list[int] = []

    def draw_random_poses(count: int) -> Poses:
        random_counts.append(count)
        return np.full((count, 3), 9.0)

    for likelihood in (8.0, 8.0, 1.0):
        particle_filter.update_weights(np.full(len(particle_filter.particles), likelihood))
        particle_filter.resample(draw_random_poses)
    assert len(random_counts) == 1
    assert random_counts[0] / 2000 == pytest.approx(1 - 4.5 / 7.993, abs=0.05)


def test_zero_likelihoods_give_uniform_weights() -> None:
    particle_filter = ParticleFilter(FilterSettings())
    particle_filter.update_weights(np.zeros(2000))
    assert particle_filter.weights == pytest.approx(1.0 / 2000)


def test_pose_error_of_half_a_meter_is_corrected_while_driving() -> None:
    """Scans and odometry are exact, and the first pose is wrong by 0.5 m and 0.3 rad."""
    likelihoods = make_room()
    particle_filter = ParticleFilter(FilterSettings())
    true_pose = np.array((1.5, 1.2, 0.2))
    particle_filter.draw_around((1.8, 0.8, 0.5), np.diag((0.25, 0.25, (pi / 12) ** 2)))
    for _ in range(12):
        old_pose = (float(true_pose[0]), float(true_pose[1]), float(true_pose[2]))
        true_pose += (0.25 * np.cos(true_pose[2]), 0.25 * np.sin(true_pose[2]), 0.05)
        new_pose = (float(true_pose[0]), float(true_pose[1]), float(true_pose[2]))
        move_differentially(particle_filter.particles, old_pose, new_pose, Noise(), particle_filter.random)
        particle_filter.update_weights(
            likelihoods.compute_likelihoods("likelihood_field", particle_filter.particles, beams_in_room(*new_pose))
        )
        particle_filter.resample(_no_random_poses)
    x, y, yaw = particle_filter.estimate().pose
    assert np.hypot(x - true_pose[0], y - true_pose[1]) < 0.1
    assert abs(yaw - true_pose[2]) < 0.1


def test_same_seed_gives_same_particles() -> None:
    def run() -> list[list[float]]:
        particle_filter = ParticleFilter(FilterSettings(), seed=7)
        particle_filter.draw_around((2.0, 1.5, 0.0), np.eye(3) * 0.1)
        particle_filter.update_weights(
            make_room().compute_likelihoods("likelihood_field", particle_filter.particles, beams_in_room(2.0, 1.5, 0.0))
        )
        particle_filter.resample(_no_random_poses)
        drawn: list[list[float]] = particle_filter.particles.tolist()
        return drawn

    assert run() == run()
