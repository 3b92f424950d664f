"""An adaptive particle filter, with KLD sampling as in nav2_amcl."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import ceil, sqrt

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.grids.library import load_scipy
from linkwright.navigation.localization.motion_models import Poses

_BIN = np.array((0.5, 0.5, np.pi / 18.0))
"""Metres, metres and radians within which poses count as one."""
_TURNS = 36
_CONVERGED = 0.5
"""Metres from their mean within which all particles of a filter are that has converged."""


@dataclass(frozen=True, slots=True)
class FilterSettings:
    """Settings of a particle filter: the number of particles, and the addition of random ones.

    Attributes:
        min_particles: the minimum number of particles.
        max_particles: the maximum number of particles.
        pf_err: the maximum error of the distribution.
        pf_z: the upper standard normal quantile of the probability that the error is not exceeded.
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
        pose: x and y in metres and yaw in radians: the mean of the most likely cluster.
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
        self._slow = self._fast = 0.0

    def begin(self, particles: Poses) -> None:
        """Replace the particles, and give all of them the same weight."""
        self.particles = particles
        self.weights = np.full(len(particles), 1.0 / len(particles))
        self._slow = self._fast = 0.0

    def draw_around(self, pose: tuple[float, float, float], covariance: NDArray[np.float64]) -> None:
        """Draw the maximum number of particles around a pose, with a covariance of shape (3, 3)."""
        count = self.settings.max_particles
        values, axes = np.linalg.eigh((covariance + covariance.T) / 2.0)
        drawn = self.random.normal(size=(count, 3)) * np.sqrt(np.maximum(values, 0.0))
        self.begin(np.array(pose) + drawn @ axes.T)

    def weigh(self, likelihoods: NDArray[np.float64]) -> None:
        """Multiply the weights by the likelihood of each particle, and normalise them."""
        weights = self.weights * likelihoods
        total = float(weights.sum())
        if not total > 0.0:
            self.weights = np.full(len(weights), 1.0 / len(weights))
            return
        # The total is the mean likelihood. nav2 divides it by the number of particles again, so its averages depend on
        # that
        # number.
        slow, fast = self.settings.recovery_alpha_slow, self.settings.recovery_alpha_fast
        self._slow = total if self._slow == 0.0 else self._slow + slow * (total - self._slow)
        self._fast = total if self._fast == 0.0 else self._fast + fast * (total - self._fast)
        self.weights = weights / total

    def resample(self, anywhere: Callable[[int], Poses]) -> None:
        """Resample the particles by their weights; KLD sampling determines their number.

        Args:
            anywhere: returns a given number of random particles, which are added while scans match worse than before.
        """
        settings, random = self.settings, self.random
        lost = max(0.0, 1.0 - self._fast / self._slow) if self._slow > 0.0 else 0.0
        most = settings.max_particles
        sums = np.cumsum(self.weights)
        chosen = np.minimum(np.searchsorted(sums, random.uniform(0.0, sums[-1], most), side="right"), len(sums) - 1)
        drawn = self.particles[chosen]
        if lost > 0.0:
            new = np.flatnonzero(random.uniform(size=most) < lost)
            drawn[new] = anywhere(len(new))
            self._slow = self._fast = 0.0
        slow, fast = self._slow, self._fast
        self.begin(drawn[: self._needed(drawn)].copy())
        self._slow, self._fast = slow, fast

    def has_converged(self) -> bool:
        """Return whether all particles are near their mean position."""
        away: NDArray[np.float64] = np.abs(self.particles[:, :2] - self.particles[:, :2].mean(axis=0))
        return bool(away.max() <= _CONVERGED)

    def estimate(self) -> Estimate:
        """Return the mean pose of the most likely cluster, and the covariance of all particles."""
        clusters = _clusters(self.particles)
        weights = np.bincount(clusters, self.weights)
        best = int(weights.argmax())
        members = clusters == best
        x, y, yaw, _ = _mean(self.particles[members], self.weights[members])
        return Estimate((x, y, yaw), float(weights[best]), self._covariance())

    def _covariance(self) -> NDArray[np.float64]:
        x, y, _, length = _mean(self.particles, self.weights)
        away = self.particles[:, :2] - (x, y)
        covariance = np.zeros((3, 3))
        covariance[:2, :2] = (away * self.weights[:, None]).T @ away
        covariance[2, 2] = -2.0 * np.log(min(1.0, max(length, 1e-12)))
        return covariance

    def _needed(self, drawn: Poses) -> int:
        """Return how many of the drawn particles suffice for the number of bins that they occupy."""
        _, first = np.unique(_bins(drawn)[0], return_index=True)
        new = np.zeros(len(drawn), np.int64)
        new[first] = 1
        bins = np.cumsum(new)
        limits = np.array([self._limit(count) for count in range(int(bins[-1]) + 1)])
        enough = np.flatnonzero(np.arange(1, len(drawn) + 1) > limits[bins])
        return int(enough[0]) + 1 if len(enough) else len(drawn)

    def _limit(self, bins: int) -> int:
        """Return the number of particles needed for a number of occupied bins.

        Source: Fox, "KLD-sampling", with the approximation of Wilson and Hilferty.
        """
        settings = self.settings
        if bins <= 1:
            return settings.max_particles
        b = 2.0 / (9.0 * (bins - 1))
        needed = ceil((bins - 1) / (2.0 * settings.pf_err) * (1.0 - b + sqrt(b) * settings.pf_z) ** 3)
        return min(max(needed, settings.min_particles), settings.max_particles)


def _bins(particles: Poses) -> tuple[NDArray[np.int64], int]:
    """Return the bin number of each particle, and the difference between neighbours along x.

    The number changes by the number of bins in a full turn per step along y, and by 1 along yaw, wrapping after a full
    turn. A border of empty bins surrounds all others.
    """
    bins: NDArray[np.int64] = np.floor(particles / _BIN).astype(np.int64)
    bins[:, :2] -= bins[:, :2].min(axis=0) - 1
    along_x = (int(bins[:, 1].max()) + 2) * _TURNS
    return bins[:, 0] * along_x + bins[:, 1] * _TURNS + bins[:, 2] % _TURNS, along_x


def _clusters(particles: Poses) -> NDArray[np.int64]:
    """Return the index of each particle's cluster; adjacent bins belong to the same cluster."""
    numbers, along_x = _bins(particles)
    bins, where = np.unique(numbers, return_inverse=True)
    yaw = bins % _TURNS
    here = np.arange(len(bins))
    pairs = []
    for way in (along_x + _TURNS, along_x, along_x - _TURNS, _TURNS, 0):  # The opposite directions are symmetric.
        for turn in (-1, 0, 1):
            beside = bins - yaw + way + (yaw + turn) % _TURNS
            at = np.minimum(np.searchsorted(bins, beside), len(bins) - 1)
            found = bins[at] == beside
            pairs.append(np.stack((here[found], at[found])))
    edges = np.concatenate(pairs, axis=1)
    matrix = load_scipy("sparse").coo_matrix((np.ones(edges.shape[1]), edges), shape=(len(bins), len(bins)))
    _, labels = load_scipy("sparse.csgraph").connected_components(matrix, directed=False)
    clusters: NDArray[np.int64] = np.asarray(labels, np.int64)[where.reshape(-1)]
    return clusters


def _mean(particles: Poses, weights: NDArray[np.float64]) -> tuple[float, float, float, float]:
    """Return the weighted mean of x, y and yaw, and the concentration of the yaws, 0 to 1."""
    total = float(weights.sum())
    shares = weights / total if total > 0.0 else np.full(len(weights), 1.0 / len(weights))
    x, y = shares @ particles[:, :2]
    c, s = float(shares @ np.cos(particles[:, 2])), float(shares @ np.sin(particles[:, 2]))
    return float(x), float(y), float(np.arctan2(s, c)), float(np.hypot(c, s))
