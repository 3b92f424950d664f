"""The largest velocities, accelerations and jerks of the quintic splines that controllers execute.

The points of a trajectory may be within limits while the splines between them are not.
"""

from __future__ import annotations

from math import comb

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.planning.timing import Trajectory

_TO_HULL = np.array([[comb(row, column) / comb(4, column) if column <= row else 0.0 for column in range(5)]
                     for row in range(5)])  # fmt: skip
"""The Bernstein coefficients of a polynomial of degree 4, whose hull has all its values from 0 to 1."""


def largest_velocities(trajectory: Trajectory) -> Array:
    """Return an upper bound of the velocities along the splines, shape (joints,), in rad/s or m/s.

    The bound is the hull of the control points, which is within 0.1 % for the points of our trajectories.
    """
    widths, coefficients = trajectory.coefficients()
    slopes = np.arange(1.0, 6.0)[:, None, None] * coefficients[1:] / widths
    hull = np.tensordot(_TO_HULL, slopes, axes=1)
    return np.asarray(np.abs(hull).max(axis=(0, 1), initial=0.0), dtype=np.float64)


def largest_accelerations(trajectory: Trajectory) -> Array:
    """Return the largest accelerations along the splines, shape (joints,), in rad/s2 or m/s2."""
    widths, coefficients = trajectory.coefficients()
    a0, a1, a2, a3 = np.array([2.0, 6.0, 12.0, 20.0])[:, None, None] * coefficients[2:] / widths**2
    # The extremes of the cubic are at its ends, and where its derivative a1 + 2 a2 x + 3 a3 x^2 is zero.
    root = np.sqrt(np.maximum(a2**2 - 3.0 * a1 * a3, 0.0))
    q = -(a2 + np.copysign(root, a2))
    largest = np.maximum(np.abs(a0), np.abs(a0 + a1 + a2 + a3))
    for numerator, denominator in ((q, 3.0 * a3), (a1, q)):
        x = np.divide(numerator, denominator, out=np.zeros_like(q), where=denominator != 0.0)
        x = np.clip(x, 0.0, 1.0)
        largest = np.maximum(largest, np.abs(a0 + x * (a1 + x * (a2 + x * a3))))
    return np.asarray(largest.max(axis=0, initial=0.0), dtype=np.float64)


def largest_jerks(trajectory: Trajectory) -> Array:
    """Return the largest jerks along the splines, shape (joints,), in rad/s3 or m/s3."""
    widths, coefficients = trajectory.coefficients()
    j0, j1, j2 = np.array([6.0, 24.0, 60.0])[:, None, None] * coefficients[3:] / widths**3
    largest = np.maximum(np.abs(j0), np.abs(j0 + j1 + j2))
    # The extreme of the parabola is where its derivative j1 + 2 j2 x is zero.
    x = np.clip(np.divide(-j1, 2.0 * j2, out=np.zeros_like(j1), where=j2 != 0.0), 0.0, 1.0)
    largest = np.maximum(largest, np.abs(j0 + x * (j1 + x * j2)))
    return np.asarray(largest.max(axis=0, initial=0.0), dtype=np.float64)


def slow_to_limits(
    trajectory: Trajectory, max_velocities: Array, max_accelerations: Array, max_jerks: Array
) -> Trajectory:
    """Return a trajectory whose splines keep limits: the same one, or one that is slower everywhere.

    Args:
        trajectory: the trajectory.
        max_velocities: in rad/s or m/s, shape (joints,).
        max_accelerations: in rad/s2 or m/s2, shape (joints,).
        max_jerks: in rad/s3 or m/s3, shape (joints,); infinite for joints without a limit.
    """
    velocity_ratio = float(np.max(largest_velocities(trajectory) / max_velocities, initial=0.0))
    acceleration_ratio = float(np.max(largest_accelerations(trajectory) / max_accelerations, initial=0.0))
    jerk_ratio = float(np.max(largest_jerks(trajectory) / max_jerks, initial=0.0))
    return trajectory.slowed(max(1.0, velocity_ratio, np.sqrt(acceleration_ratio), np.cbrt(jerk_ratio)))
