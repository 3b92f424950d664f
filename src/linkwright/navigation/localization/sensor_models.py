"""The sensor models of nav2_amcl: the likelihood of a scan at each of many poses.

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
from linkwright.navigation.grids.rays import cast_rays
from linkwright.navigation.localization.beams import Beams
from linkwright.navigation.localization.motion_models import Poses

Likelihoods = NDArray[np.float64]
MODELS = ("likelihood_field", "likelihood_field_prob", "beam")
_FIT_DISTANCE_M = 0.15
"""The maximum distance from the end of a beam to an obstacle of the map for the beam to fit, in meters."""


@dataclass(frozen=True, slots=True)
class BeamSkipping:
    """Settings of beam skipping.

    Beam skipping ignores beams that fit only few particles, such as beams that hit people.

    Attributes:
        distance: the maximum distance from the map's nearest obstacle at which a beam fits a particle, in meters.
        threshold: the share of particles that a beam must fit.
        error_threshold: if more than this share of beams would be skipped, all beams are used.
    """

    distance: float = 0.5
    threshold: float = 0.3
    error_threshold: float = 0.9


@dataclass(frozen=True, slots=True)
class LaserSettings:
    """Parameters of the sensor models, with nav2's names.

    Lengths are in meters, and ``lambda_short`` is in 1/m.
    """

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
        is_occupied = grid.cells == OCCUPIED
        distances = distance_field(is_occupied, grid.resolution)
        self.distances = Grid(cells=distances, resolution=grid.resolution, x=grid.x, y=grid.y, yaw=grid.yaw)
        clipped_distances = np.minimum(distances, settings.laser_likelihood_max_dist)
        # A border of cells far from obstacles represents everything outside the map, so indices need no range check.
        max_distance = settings.laser_likelihood_max_dist
        self._distances = np.pad(clipped_distances, 1, constant_values=max_distance).astype(np.float32)
        self._gaussian = settings.z_hit * np.exp(-0.5 * (self._distances / settings.sigma_hit) ** 2)
        self._cached_table: tuple[tuple[str, float], NDArray[np.float32]] | None = None
        self._free_cells = np.argwhere(grid.cells == FREE)

    def compute_likelihoods(
        self, model: str, particles: Poses, beams: Beams, beam_skipping: BeamSkipping | None = None
    ) -> Likelihoods:
        """Return the likelihood of a scan from each pose by one of `MODELS`, of shape (particles,).

        Likelihoods are positive and not normalized.
        """
        if model == "beam":
            return self._compute_beam_likelihoods(particles, beams)
        uses_product = model == "likelihood_field_prob"
        hit_points = beams.end_points[beams.hit_mask]
        if not len(hit_points):
            return np.ones(len(particles))
        cells = self._find_end_cells(particles, hit_points)
        values = self._compute_contributions(model, beams.range_max).take(cells)
        if not uses_product:
            sums: Likelihoods = values.sum(axis=1, dtype=np.float64)
            return 1.0 + sums
        if beam_skipping is not None:
            values = values[:, self._select_unskipped_beams(cells, beam_skipping)]
        exponents = values.sum(axis=1, dtype=np.float64)
        # Likelihoods are relative to the best one because a product of so many factors would underflow to 0.
        likelihoods: Likelihoods = np.exp(exponents - exponents.max())
        return likelihoods

    def compute_matching_share(self, pose: tuple[float, float, float], beams: Beams) -> float | None:
        """Return the share of beams from a pose that end near an obstacle of the map, 0 to 1.

        Returns None if no beam hit anything.
        """
        hit_points = beams.end_points[beams.hit_mask]
        if not len(hit_points):
            return None
        distances = self._distances.take(self._find_end_cells(np.array([pose]), hit_points))
        return float((distances <= _FIT_DISTANCE_M).mean())

    def draw_random_poses(self, count: int, random: np.random.Generator) -> Poses:
        """Return random poses of shape (count, 3), uniformly distributed over the free cells.

        If no cell is free, the poses are distributed over the whole map.
        """
        cell_choices = (
            self._free_cells if len(self._free_cells) else np.argwhere(np.ones_like(self.grid.cells, np.bool_))
        )
        cells = cell_choices[random.integers(0, len(cell_choices), count)]
        points = self.grid.centers_of(cells) + random.uniform(-0.5, 0.5, (count, 2)) * self.grid.resolution
        return np.column_stack((points, random.uniform(-np.pi, np.pi, count)))

    def _compute_contributions(self, model: str, range_max: float) -> NDArray[np.float32]:
        """Return a beam's contribution to the likelihood for each cell in which the beam can end."""
        key = (model, range_max)
        if self._cached_table is None or self._cached_table[0] != key:
            probability = self._gaussian + self._settings.z_rand / range_max
            table = np.log(np.maximum(probability, 1e-9)) if model == "likelihood_field_prob" else probability**3
            self._cached_table = (key, table.astype(np.float32))
        return self._cached_table[1]

    def _find_end_cells(self, particles: Poses, ends: NDArray[np.float64]) -> NDArray[np.int64]:
        """Return the end cells of beams, shape (particles, beams).

        The cells are flat indices into the map with its border.
        """
        grid = self.grid
        map_cosine, map_sine = np.cos(grid.yaw), np.sin(grid.yaw)
        x, y = particles[:, 0] - grid.x, particles[:, 1] - grid.y
        map_yaws = particles[:, 2] - grid.yaw
        cosine, sine = np.cos(map_yaws), np.sin(map_yaws)
        column, row = (
            (map_cosine * x + map_sine * y) / grid.resolution + 1.0,
            (map_cosine * y - map_sine * x) / grid.resolution + 1.0,
        )
        # One matrix product transforms all beams. Single precision resolves a tenth of a cell on maps with a million
        # cells along a side.
        ends = np.vstack((ends.T / grid.resolution, np.ones(len(ends)))).astype(np.float32)
        columns = np.column_stack((cosine, -sine, column)).astype(np.float32) @ ends
        rows = np.column_stack((sine, cosine, row)).astype(np.float32) @ ends
        for values, max_index in ((columns, grid.columns + 1), (rows, grid.rows + 1)):
            np.minimum(values, np.float32(max_index), out=values)
            np.maximum(values, np.float32(0.0), out=values)
        cells: NDArray[np.int64] = rows.astype(np.int64)
        cells *= grid.columns + 2
        cells += columns.astype(np.int64)
        return cells

    def _select_unskipped_beams(self, cells: NDArray[np.int64], beam_skipping: BeamSkipping) -> NDArray[np.bool_]:
        is_fit: NDArray[np.bool_] = self._distances.take(cells) < beam_skipping.distance
        is_kept: NDArray[np.bool_] = is_fit.mean(axis=0) > beam_skipping.threshold
        return is_kept if 1.0 - is_kept.mean() < beam_skipping.error_threshold else np.ones_like(is_kept)

    def _compute_beam_likelihoods(self, particles: Poses, beams: Beams) -> Likelihoods:
        settings, measured, max_range = self._settings, beams.ranges, beams.range_max
        cosine, sine = np.cos(particles[:, 2]), np.sin(particles[:, 2])
        x, y = beams.origin
        laser_positions = np.column_stack(
            (particles[:, 0] + cosine * x - sine * y, particles[:, 1] + sine * x + cosine * y)
        )
        angles = particles[:, 2, None] + beams.angles
        expected = cast_rays(self.distances, laser_positions[:, None, :], angles, max_range)
        errors = measured - expected
        probability = settings.z_hit * np.exp(-0.5 * (errors / settings.sigma_hit) ** 2)
        short_probability = settings.z_short * settings.lambda_short * np.exp(-settings.lambda_short * measured)
        probability += np.where(errors < 0.0, short_probability, 0.0)
        probability += np.where(measured >= max_range, settings.z_max, settings.z_rand / max_range)
        likelihoods: Likelihoods = 1.0 + (probability**3).sum(axis=1)
        return likelihoods
