"""The particle filter: the number of particles, resampling, and the estimated pose."""

from __future__ import annotations

from math import ceil, pi, sqrt

import numpy as np
import pytest

from linkwright.navigation.localization.motion_models import Noise, Poses, move_differentially
from linkwright.navigation.localization.particle_filter import FilterSettings, ParticleFilter
from tests.navigation.localization.test_sensor_models import beams_in_room, room


def _no_random_poses(count: int) -> Poses:
    raise AssertionError(count)


def test_particles_have_given_mean_and_covariance() -> None:
    particles = ParticleFilter(FilterSettings(max_particles=20_000))
    covariance = np.array([[0.25, 0.1, 0.0], [0.1, 0.16, 0.0], [0.0, 0.0, 0.04]])
    particles.draw_around((1.0, -2.0, 3.0), covariance)
    assert particles.particles.mean(axis=0) == pytest.approx([1.0, -2.0, 3.0], abs=0.02)
    assert np.cov(particles.particles.T) == pytest.approx(covariance, abs=0.01)
    estimate = particles.estimate()
    assert estimate.pose == pytest.approx((1.0, -2.0, 3.0), abs=0.02)
    assert estimate.covariance[:2, :2] == pytest.approx(covariance[:2, :2], abs=0.01)
    assert estimate.covariance[2, 2] == pytest.approx(0.04, abs=0.005)


def test_particle_count_follows_number_of_occupied_bins() -> None:
    settings = FilterSettings(min_particles=100, max_particles=5000)
    particles = ParticleFilter(settings)
    bins = 40
    poses = np.column_stack((np.arange(bins) * 0.5 + 0.25, np.full(bins, 0.25), np.full(bins, 0.01)))
    particles.set_particles(np.repeat(poses, 100, axis=0))
    particles.resample(_no_random_poses)
    b = 2.0 / (9.0 * (bins - 1))
    assert len(particles.particles) == ceil((bins - 1) / 0.1 * (1.0 - b + sqrt(b) * 0.99) ** 3) + 1
    particles.set_particles(np.repeat(poses[:2], 100, axis=0))
    particles.resample(_no_random_poses)
    assert len(particles.particles) == 101


def test_resampling_follows_weights() -> None:
    particles = ParticleFilter(FilterSettings())
    particles.set_particles(np.array([(0.25, 0.25, 0.01), (3.25, 0.25, 0.01), (6.25, 0.25, 0.01)]))
    particles.update_weights(np.array([1.0, 0.0, 3.0]))
    particles.resample(_no_random_poses)
    identifiers, counts = np.unique(particles.particles[:, 0], return_counts=True)
    assert identifiers.tolist() == [0.25, 6.25]
    assert counts[1] / counts.sum() == pytest.approx(0.75, abs=0.05)


def test_estimate_is_mean_of_likeliest_cluster() -> None:
    particles = ParticleFilter(FilterSettings())
    # The headings are on both sides of the jump from pi to -pi.
    large_cluster = np.random.default_rng(0).normal((2.0, 1.0, pi), (0.2, 0.2, 0.2), (600, 3))
    large_cluster[:, 2] = (large_cluster[:, 2] + pi) % (2 * pi) - pi
    small_cluster = np.random.default_rng(1).normal((8.0, 5.0, 0.0), 0.1, (400, 3))
    particles.set_particles(np.concatenate((large_cluster, small_cluster)))
    estimate = particles.estimate()
    assert estimate.weight == pytest.approx(0.6, abs=0.01)
    assert estimate.pose[:2] == pytest.approx((2.0, 1.0), abs=0.03)
    assert abs(estimate.pose[2]) == pytest.approx(pi, abs=0.03)
    assert not particles.has_converged()
    particles.set_particles(small_cluster)
    assert particles.has_converged()


def test_random_particles_are_added_when_likelihood_drops() -> None:
    particles = ParticleFilter(FilterSettings(recovery_alpha_slow=0.001, recovery_alpha_fast=0.5))
    particles.set_particles(np.tile((1.0, 1.0, 0.0), (1000, 1)))
    random_counts: list[int] = []

    def draw_random_poses(count: int) -> Poses:
        random_counts.append(count)
        return np.full((count, 3), 9.0)

    for likelihood in (8.0, 8.0, 1.0):
        particles.update_weights(np.full(len(particles.particles), likelihood))
        particles.resample(draw_random_poses)
    assert len(random_counts) == 1
    assert random_counts[0] / 2000 == pytest.approx(1 - 4.5 / 7.993, abs=0.05)


def test_zero_likelihoods_give_uniform_weights() -> None:
    particles = ParticleFilter(FilterSettings())
    particles.update_weights(np.zeros(2000))
    assert particles.weights == pytest.approx(1.0 / 2000)


def test_pose_error_of_half_a_meter_is_corrected_while_driving() -> None:
    """Scans and odometry are exact, and the first pose is wrong by 0.5 m and 0.3 rad."""
    likelihoods = room()
    particles = ParticleFilter(FilterSettings())
    true = np.array((1.5, 1.2, 0.2))
    particles.draw_around((1.8, 0.8, 0.5), np.diag((0.25, 0.25, (pi / 12) ** 2)))
    for _ in range(12):
        old_pose = (float(true[0]), float(true[1]), float(true[2]))
        true += (0.25 * np.cos(true[2]), 0.25 * np.sin(true[2]), 0.05)
        new_pose = (float(true[0]), float(true[1]), float(true[2]))
        move_differentially(particles.particles, old_pose, new_pose, Noise(), particles.random)
        particles.update_weights(
            likelihoods.compute_likelihoods("likelihood_field", particles.particles, beams_in_room(*new_pose))
        )
        particles.resample(_no_random_poses)
    x, y, yaw = particles.estimate().pose
    assert np.hypot(x - true[0], y - true[1]) < 0.1
    assert abs(yaw - true[2]) < 0.1


def test_same_seed_gives_same_particles() -> None:
    def run() -> list[list[float]]:
        particles = ParticleFilter(FilterSettings(), seed=7)
        particles.draw_around((2.0, 1.5, 0.0), np.eye(3) * 0.1)
        particles.update_weights(
            room().compute_likelihoods("likelihood_field", particles.particles, beams_in_room(2.0, 1.5, 0.0))
        )
        particles.resample(_no_random_poses)
        drawn: list[list[float]] = particles.particles.tolist()
        return drawn

    assert run() == run()
