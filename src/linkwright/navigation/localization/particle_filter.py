"""An adaptive particle filter, with KLD sampling as in nav2_amcl."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import ceil, sqrt

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.grids.library import load_scipy
from linkwright.navigation.localization.motion_models import Poses

_BIN_SIZE = np.array((0.5, 0.5, np.pi / 18.0))
"""The size of a bin of poses along x and y, in meters, and yaw, in radians."""
_YAW_BINS = 36
_CONVERGENCE_DISTANCE = 0.5
"""The filter has converged if all particles are within this distance of their mean, in meters."""


@dataclass(frozen=True, slots=True)
class FilterSettings:
    """Settings of a particle filter: KLD sampling, and recovery by random particles.

    Attributes:
        min_particles: the minimum number of particles.
        max_particles: the maximum number of particles.
        pf_err: the maximum error of the distribution.
        pf_z: the standard normal quantile for the probability that the error is at most `pf_err`.
        recovery_alpha_slow: the rate of the slow average of likelihoods; 0 to never add random particles.
        recovery_alpha_fast: the rate of the fast average.
    """

    min_particles: int = 500
    max_particles: int = 2000
    pf_err: float = 0.05
    pf_z: float = 0.99
    recovery_alpha_slow: float = 0.0
    recovery_alpha_fast: float = 0.0


@dataclass(frozen=True, slots=True)
class Estimate:
    """An estimated pose.

    Attributes:
        pose: x and y in meters and yaw in radians: the mean of the most likely cluster.
        weight: the weight of that cluster, 0 to 1.
        covariance: the covariance of all particles, of shape (3, 3).
    """

    pose: tuple[float, float, float]
    weight: float
    covariance: NDArray[np.float64]


class ParticleFilter:
    """A particle filter of planar poses.

    Args:
        settings: the settings, such as the number of particles.
        seed: the random seed; the same seed gives the same result.

    Attributes:
        particles: the particles, of shape (n, 3).
        weights: the weights of the particles, of shape (n,), with a sum of 1.
    """

    def __init__(self, settings: FilterSettings, seed: int = 0) -> None:
        self.settings = settings
        self.random = np.random.default_rng(seed)
        self.particles: Poses = np.zeros((settings.max_particles, 3))
        self.weights: NDArray[np.float64] = np.full(settings.max_particles, 1.0 / settings.max_particles)
        self._slow_average = self._fast_average = 0.0

    def set_particles(self, particles: Poses) -> None:
        """Replace the particles, and give all of them the same weight."""
        self.particles = particles
        self.weights = np.full(len(particles), 1.0 / len(particles))
        self._slow_average = self._fast_average = 0.0

    def draw_around(self, pose: tuple[float, float, float], covariance: NDArray[np.float64]) -> None:
        """Draw the maximum number of particles around a pose, with a covariance of shape (3, 3)."""
        count = self.settings.max_particles
        values, axes = np.linalg.eigh((covariance + covariance.T) / 2.0)
        deviations = self.random.normal(size=(count, 3)) * np.sqrt(np.maximum(values, 0.0))
        self.set_particles(np.array(pose) + deviations @ axes.T)

    def update_weights(self, likelihoods: NDArray[np.float64]) -> None:
        """Multiply the weights by the likelihoods, and normalize them.

        If all products are 0, the particles get equal weights instead. The recovery averages are updated as well.
        """
        weights = self.weights * likelihoods
        total = float(weights.sum())
        if not total > 0.0:
            self.weights = np.full(len(weights), 1.0 / len(weights))
            return
        # The total is the mean likelihood. nav2 divides it by the number of particles again, so nav2's averages depend
        # on that number.
        slow_rate, fast_rate = self.settings.recovery_alpha_slow, self.settings.recovery_alpha_fast
        self._slow_average = (
            total if self._slow_average == 0.0 else self._slow_average + slow_rate * (total - self._slow_average)
        )
        self._fast_average = (
            total if self._fast_average == 0.0 else self._fast_average + fast_rate * (total - self._fast_average)
        )
        self.weights = weights / total

    def resample(self, random_particles: Callable[[int], Poses]) -> None:
        """Resample the particles in proportion to their weights.

        KLD sampling determines the number of particles.

        Args:
            random_particles: returns a number of random particles, which replace drawn particles while scans match
                worse than before.
        """
        settings, random = self.settings, self.random
        random_share = max(0.0, 1.0 - self._fast_average / self._slow_average) if self._slow_average > 0.0 else 0.0
        count = settings.max_particles
        sums = np.cumsum(self.weights)
        indices = np.minimum(np.searchsorted(sums, random.uniform(0.0, sums[-1], count), side="right"), len(sums) - 1)
        new_particles = self.particles[indices]
        if random_share > 0.0:
            replaced = np.flatnonzero(random.uniform(size=count) < random_share)
            new_particles[replaced] = random_particles(len(replaced))
            self._slow_average = self._fast_average = 0.0
        slow_average, fast_average = self._slow_average, self._fast_average
        self.set_particles(new_particles[: self._compute_required_count(new_particles)].copy())
        self._slow_average, self._fast_average = slow_average, fast_average

    def has_converged(self) -> bool:
        """Return whether all particles are near their mean position."""
        offsets: NDArray[np.float64] = np.abs(self.particles[:, :2] - self.particles[:, :2].mean(axis=0))
        return bool(offsets.max() <= _CONVERGENCE_DISTANCE)

    def estimate(self) -> Estimate:
        """Return the mean pose of the most likely cluster, and the covariance of all particles."""
        clusters = _label_clusters(self.particles)
        weights = np.bincount(clusters, self.weights)
        best_cluster = int(weights.argmax())
        members = clusters == best_cluster
        x, y, yaw, _ = _compute_mean(self.particles[members], self.weights[members])
        return Estimate((x, y, yaw), float(weights[best_cluster]), self._compute_covariance())

    def _compute_covariance(self) -> NDArray[np.float64]:
        x, y, _, concentration = _compute_mean(self.particles, self.weights)
        offsets = self.particles[:, :2] - (x, y)
        covariance = np.zeros((3, 3))
        covariance[:2, :2] = (offsets * self.weights[:, None]).T @ offsets
        covariance[2, 2] = -2.0 * np.log(min(1.0, max(concentration, 1e-12)))
        return covariance

    def _compute_required_count(self, particles: Poses) -> int:
        """Return the number of drawn particles that KLD sampling keeps.

        The number grows with the number of bins that the particles occupy.
        """
        _, first_indices = np.unique(_assign_bins(particles)[0], return_index=True)
        is_new_bin = np.zeros(len(particles), np.int64)
        is_new_bin[first_indices] = 1
        bins = np.cumsum(is_new_bin)
        limits = np.array([self._compute_kld_count(count) for count in range(int(bins[-1]) + 1)])
        sufficient = np.flatnonzero(np.arange(1, len(particles) + 1) > limits[bins])
        return int(sufficient[0]) + 1 if len(sufficient) else len(particles)

    def _compute_kld_count(self, bins: int) -> int:
        """Return the number of particles needed for a number of occupied bins.

        Source: Fox, "KLD-sampling", with the approximation of Wilson and Hilferty.
        """
        settings = self.settings
        if bins <= 1:
            return settings.max_particles
        variance = 2.0 / (9.0 * (bins - 1))
        count = ceil((bins - 1) / (2.0 * settings.pf_err) * (1.0 - variance + sqrt(variance) * settings.pf_z) ** 3)
        return min(max(count, settings.min_particles), settings.max_particles)


def _assign_bins(particles: Poses) -> tuple[NDArray[np.int64], int]:
    """Return the bin number of each particle, and the difference between neighbors along x.

    Neighbors along y differ by the number of yaw bins, and neighbors in yaw differ by 1 and wrap after a full turn.
    A border of empty bins surrounds all others.
    """
    bins: NDArray[np.int64] = np.floor(particles / _BIN_SIZE).astype(np.int64)
    bins[:, :2] -= bins[:, :2].min(axis=0) - 1
    along_x = (int(bins[:, 1].max()) + 2) * _YAW_BINS
    return bins[:, 0] * along_x + bins[:, 1] * _YAW_BINS + bins[:, 2] % _YAW_BINS, along_x


def _label_clusters(particles: Poses) -> NDArray[np.int64]:
    """Return the index of each particle's cluster.

    Adjacent bins belong to the same cluster.
    """
    numbers, along_x = _assign_bins(particles)
    bins, bin_indices = np.unique(numbers, return_inverse=True)
    yaw = bins % _YAW_BINS
    own_indices = np.arange(len(bins))
    pairs = []
    for step in (along_x + _YAW_BINS, along_x, along_x - _YAW_BINS, _YAW_BINS, 0):  # Opposite steps are symmetric.
        for yaw_step in (-1, 0, 1):
            neighbors = bins - yaw + step + (yaw + yaw_step) % _YAW_BINS
            neighbor_indices = np.minimum(np.searchsorted(bins, neighbors), len(bins) - 1)
            exists = bins[neighbor_indices] == neighbors
            pairs.append(np.stack((own_indices[exists], neighbor_indices[exists])))
    edges = np.concatenate(pairs, axis=1)
    matrix = load_scipy("sparse").coo_matrix((np.ones(edges.shape[1]), edges), shape=(len(bins), len(bins)))
    _, labels = load_scipy("sparse.csgraph").connected_components(matrix, directed=False)
    clusters: NDArray[np.int64] = np.asarray(labels, np.int64)[bin_indices.reshape(-1)]
    return clusters


def _compute_mean(particles: Poses, weights: NDArray[np.float64]) -> tuple[float, float, float, float]:
    """Return the weighted mean of x, y and yaw, and the concentration of the yaws, 0 to 1."""
    total = float(weights.sum())
    fractions = weights / total if total > 0.0 else np.full(len(weights), 1.0 / len(weights))
    x, y = fractions @ particles[:, :2]
    cosine, sine = float(fractions @ np.cos(particles[:, 2])), float(fractions @ np.sin(particles[:, 2]))
    return float(x), float(y), float(np.arctan2(sine, cosine)), float(np.hypot(cosine, sine))
