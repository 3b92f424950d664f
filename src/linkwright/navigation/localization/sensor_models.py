"""Likelihoods of scans on a map from many poses: the sensor models of nav2_amcl.

Source: "Probabilistic Robotics", chapter 6. Beams are combined as in nav2_amcl: the likelihood of a pose is 1 plus the
sum of the cubes of its beams' likelihoods, which is less strict than their product. ``likelihood_field_prob`` uses the
product.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.navigation.grids.distances import distance_field
from linkwright.navigation.grids.grid import FREE, OCCUPIED, Grid
from linkwright.navigation.grids.rays import ranges
from linkwright.navigation.localization.beams import Beams
from linkwright.navigation.localization.motion_models import Poses

Likelihoods = NDArray[np.float64]
MODELS = ("likelihood_field", "likelihood_field_prob", "beam")
_FIT_DISTANCE = 0.15
"""The distance from obstacles of the map, in metres, up to which the end of a beam fits."""


@dataclass(frozen=True, slots=True)
class BeamSkipping:
    """Settings of beam skipping, which ignores beams that fit only few particles.

    Such beams are those that hit people, for example.

    Attributes:
        distance: the maximum distance from the map's nearest obstacle at which a beam fits a particle, in metres.
        threshold: the share of particles that a beam must fit.
        error_threshold: if more than this share of beams would be skipped, all beams are used.
    """

    distance: float = 0.5
    threshold: float = 0.3
    error_threshold: float = 0.9


@dataclass(frozen=True, slots=True)
class LaserSettings:
    """Parameters of the sensor models, with nav2's names."""

    z_hit: float = 0.5
    z_short: float = 0.05
    z_max: float = 0.05
    z_rand: float = 0.5
    sigma_hit: float = 0.2
    lambda_short: float = 0.1
    laser_likelihood_max_dist: float = 2.0


class MapLikelihoods:
    """The sensor models for scans on one map.

    Args:
        grid: an occupancy grid; cells equal to `OCCUPIED` stop beams.
        settings: the settings of the models.

    Raises:
        LinkwrightError: NAV101, SciPy is not installed.
    """

    def __init__(self, grid: Grid, settings: LaserSettings) -> None:
        self.grid = grid
        self._settings = settings
        occupied = grid.cells == OCCUPIED
        distances = distance_field(occupied, grid.resolution)
        self.distances = Grid(cells=distances, resolution=grid.resolution, x=grid.x, y=grid.y, yaw=grid.yaw)
        limited = np.minimum(distances, settings.laser_likelihood_max_dist)
        # A border of cells far from obstacles represents everything outside the map, so indices need no range check.
        far = settings.laser_likelihood_max_dist
        self._distances = np.pad(limited, 1, constant_values=far).astype(np.float32)
        self._gaussian = settings.z_hit * np.exp(-0.5 * (self._distances / settings.sigma_hit) ** 2)
        self._table: tuple[tuple[str, float], NDArray[np.float32]] | None = None
        self._free = np.argwhere(grid.cells == FREE)

    def likelihoods(
        self, model: str, particles: Poses, beams: Beams, skipping: BeamSkipping | None = None
    ) -> Likelihoods:
        """Return the likelihood of a scan from each pose by one of `MODELS`, of shape (particles,).

        Likelihoods are positive and not normalised.
        """
        if model == "beam":
            return self._by_rays(particles, beams)
        product = model == "likelihood_field_prob"
        hits = beams.ends[beams.hits]
        if not len(hits):
            return np.ones(len(particles))
        cells = self._cells(particles, hits)
        values = self._values(model, beams.range_max).take(cells)
        if not product:
            sums: Likelihoods = values.sum(axis=1, dtype=np.float64)
            return 1.0 + sums
        if skipping is not None:
            values = values[:, self._kept(cells, skipping)]
        exponents = values.sum(axis=1, dtype=np.float64)
        # Likelihoods are relative to the best one because a product of so many factors would underflow to 0.
        likelihoods: Likelihoods = np.exp(exponents - exponents.max())
        return likelihoods

    def fit(self, pose: tuple[float, float, float], beams: Beams) -> float | None:
        """Return the share of beams from a pose that end near an obstacle of the map, 0 to 1.

        Returns None if no beam hit anything.
        """
        hits = beams.ends[beams.hits]
        if not len(hits):
            return None
        distances = self._distances.take(self._cells(np.array([pose]), hits))
        return float((distances <= _FIT_DISTANCE).mean())

    def random_poses(self, count: int, random: np.random.Generator) -> Poses:
        """Return random poses that are uniformly distributed in the free cells, of shape (count, 3).

        If no cell is free, the poses are distributed over the whole map.
        """
        free = self._free if len(self._free) else np.argwhere(np.ones_like(self.grid.cells, np.bool_))
        cells = free[random.integers(0, len(free), count)]
        points = self.grid.centres_of(cells) + random.uniform(-0.5, 0.5, (count, 2)) * self.grid.resolution
        return np.column_stack((points, random.uniform(-np.pi, np.pi, count)))

    def _values(self, model: str, range_max: float) -> NDArray[np.float32]:
        """Return a beam's contribution to the likelihood for each cell in which the beam can end."""
        key = (model, range_max)
        if self._table is None or self._table[0] != key:
            chance = self._gaussian + self._settings.z_rand / range_max
            table = np.log(np.maximum(chance, 1e-9)) if model == "likelihood_field_prob" else chance**3
            self._table = (key, table.astype(np.float32))
        return self._table[1]

    def _cells(self, particles: Poses, ends: NDArray[np.float64]) -> NDArray[np.int64]:
        """Return the cells in which beams end, of shape (particles, beams).

        The cells are flat indices into the map with its border.
        """
        grid = self.grid
        c, s = np.cos(grid.yaw), np.sin(grid.yaw)
        x, y = particles[:, 0] - grid.x, particles[:, 1] - grid.y
        turned = particles[:, 2] - grid.yaw
        cosine, sine = np.cos(turned), np.sin(turned)
        column, row = (c * x + s * y) / grid.resolution + 1.0, (c * y - s * x) / grid.resolution + 1.0
        # One matrix product for all beams; single precision resolves a tenth of a cell on maps of a million cells a
        # side.
        ends = np.vstack((ends.T / grid.resolution, np.ones(len(ends)))).astype(np.float32)
        columns = np.column_stack((cosine, -sine, column)).astype(np.float32) @ ends
        rows = np.column_stack((sine, cosine, row)).astype(np.float32) @ ends
        for values, most in ((columns, grid.columns + 1), (rows, grid.rows + 1)):
            np.minimum(values, np.float32(most), out=values)
            np.maximum(values, np.float32(0.0), out=values)
        cells: NDArray[np.int64] = rows.astype(np.int64)
        cells *= grid.columns + 2
        cells += columns.astype(np.int64)
        return cells

    def _kept(self, cells: NDArray[np.int64], skipping: BeamSkipping) -> NDArray[np.bool_]:
        fits: NDArray[np.bool_] = self._distances.take(cells) < skipping.distance
        kept: NDArray[np.bool_] = fits.mean(axis=0) > skipping.threshold
        return kept if 1.0 - kept.mean() < skipping.error_threshold else np.ones_like(kept)

    def _by_rays(self, particles: Poses, beams: Beams) -> Likelihoods:
        settings, measured, most = self._settings, beams.ranges, beams.range_max
        c, s = np.cos(particles[:, 2]), np.sin(particles[:, 2])
        x, y = beams.origin
        lasers = np.column_stack((particles[:, 0] + c * x - s * y, particles[:, 1] + s * x + c * y))
        angles = particles[:, 2, None] + beams.angles
        expected = ranges(self.distances, lasers[:, None, :], angles, most)
        error = measured - expected
        chance = settings.z_hit * np.exp(-0.5 * (error / settings.sigma_hit) ** 2)
        short = settings.z_short * settings.lambda_short * np.exp(-settings.lambda_short * measured)
        chance += np.where(error < 0.0, short, 0.0)
        chance += np.where(measured >= most, settings.z_max, settings.z_rand / most)
        likelihoods: Likelihoods = 1.0 + (chance**3).sum(axis=1)
        return likelihoods
