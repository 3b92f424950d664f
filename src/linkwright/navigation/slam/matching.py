"""Scan matching: a search over poses, followed by least squares."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import pi

import numpy as np

from linkwright.navigation.slam.poses import FloatArray, transform_points, wrap_angles
from linkwright.navigation.slam.reference import LikelihoodField, Reference
from linkwright.navigation.slam.scan import PlanarScan
from linkwright.navigation.slam.search import Search, find_best_pose
from linkwright.navigation.slam.steps import Steps

MIN_POINTS = 12
"""The minimum number of points of a scan for matching."""

_MAX_ITERATIONS = 15
_FIRST_MAX_DISTANCE_M, _LAST_MAX_DISTANCE_M = 0.30, 0.10
"""The maximum distance of corresponding points in the first and in the last iterations, in meters."""
_CAUCHY_SCALE_M = 0.03
"""The scale of the Cauchy weights, in meters: larger distances have less influence."""
_CONVERGENCE_STEP = 1e-5
_MIN_INFORMATION_FRACTION = 0.02
"""The minimum information per point, as a fraction of the maximum, for a direction to be corrected."""
_INDEPENDENT_FRACTION = 0.1
"""The fraction of the points that counts as independent, because the points of one scan have common errors."""
_MIN_ERROR_M = 0.01
_WIDER_ANGLE_OFFSETS_RAD = (0.349, 0.698, 1.047)
"""Angles added to the window if nothing fits and ``use_response_expansion`` is set, in radians, as in Karto."""


@dataclass(frozen=True, slots=True, eq=False)
class Match:
    """The result of scan matching.

    Attributes:
        pose: the pose of the robot, of shape (3,), in the frame of the reference.
        response: the response of the search, 0 to 1 (see `linkwright.navigation.slam.search`), reduced by penalties.
        information: the inverse of the pose's covariance, of shape (3, 3), for x, y and yaw in the frame of the robot;
            near 0 in directions without information, as along a corridor.
        inliers: the share of the points that are on a wall, 0 to 1.
        error: the root mean square of the points' distances from their walls, in meters.
    """

    pose: FloatArray
    response: float
    information: FloatArray
    inliers: float
    error: float


def match_scan(
    reference: Reference, scan: PlanarScan, guess: FloatArray, search: Search, *, expand: bool = False
) -> Steps[Match | None]:
    """Match a scan against earlier scans, in steps.

    In directions without information, as along a corridor, the pose keeps the value of the guess.

    Args:
        reference: the earlier scans.
        scan: the current scan.
        guess: the expected pose of the robot, of shape (3,).
        search: the window and method of the search.
        expand: whether to search larger angles if the response is 0.

    Returns:
        The match; None if there are too few points.
    """
    if len(scan.points) < MIN_POINTS or len(reference) < MIN_POINTS:
        return None
    likelihood = LikelihoodField(reference.points, search.cell, search.smear_deviation)
    yield
    pose, response = yield from find_best_pose(likelihood, scan.points, guess, search)
    for offset in _WIDER_ANGLE_OFFSETS_RAD if expand else ():
        if response > 0:
            break
        wider_search = replace(search, angle_offset=search.angle_offset + offset)
        pose, response = yield from find_best_pose(likelihood, scan.points, guess, wider_search)
    reference.find_lines()
    yield
    return _refine(reference, scan, guess, pose, response)


def _refine(reference: Reference, scan: PlanarScan, guess: FloatArray, start: FloatArray, response: float) -> Match:
    """Return the match at a pose, refined by point-to-line ICP with Cauchy weights.

    Source: Censi, "An ICP variant using a point-to-line metric", 2008.
    """
    mean_radius = max(float(np.sqrt((scan.points**2).sum(axis=1).mean())), 0.1)
    scale = np.array(
        (1.0, 1.0, 1.0 / mean_radius)
    )  # Scale the rotation to the distance by which it moves an average point.
    pose, max_distance = start.copy(), _FIRST_MAX_DISTANCE_M
    system = _compute_normal_equations(reference, scan, pose, max_distance, scale)
    projection = _compute_constrained_projection(system[0], len(scan.points))
    yaw_offset = wrap_angles(start - guess)[2]
    shift: FloatArray = np.array((start[0] - guess[0], start[1] - guess[1], yaw_offset)) / scale
    pose = guess + scale * (projection @ shift)
    for _ in range(_MAX_ITERATIONS):
        hessian, gradient, _, _ = _compute_normal_equations(reference, scan, pose, max_distance, scale)
        projection = _compute_constrained_projection(hessian, len(scan.points))
        step: FloatArray = -np.linalg.pinv(projection @ hessian @ projection, rcond=1e-9, hermitian=True) @ (
            projection @ gradient
        )
        step *= min(1.0, 0.2 / max(float(np.abs(step).max()), 1e-12))
        pose += scale * step
        if np.abs(step).max() < _CONVERGENCE_STEP and max_distance == _LAST_MAX_DISTANCE_M:
            break
        max_distance = max(_LAST_MAX_DISTANCE_M, 0.7 * max_distance)
    hessian, _, inliers, error = _compute_normal_equations(reference, scan, pose, _LAST_MAX_DISTANCE_M, scale)
    projection = _compute_constrained_projection(hessian, len(scan.points))
    unscaled = projection @ hessian @ projection / np.outer(scale, scale)
    cos, sin = np.cos(pose[2]), np.sin(pose[2])
    axes = np.array(((cos, -sin, 0.0), (sin, cos, 0.0), (0.0, 0.0, 1.0)))
    information: FloatArray = axes.T @ unscaled @ axes * (_INDEPENDENT_FRACTION / max(error, _MIN_ERROR_M) ** 2)
    pose[2] = (pose[2] + pi) % (2 * pi) - pi
    return Match(pose, response, information, inliers, error)


def _compute_constrained_projection(hessian: FloatArray, points: int) -> FloatArray:
    """Return the projection onto the directions that the points constrain, of shape (3, 3)."""
    values, vectors = np.linalg.eigh(hessian)
    constrained = vectors[:, values > _MIN_INFORMATION_FRACTION * points]
    result: FloatArray = constrained @ constrained.T
    return result


def _compute_normal_equations(
    reference: Reference, scan: PlanarScan, pose: FloatArray, max_distance: float, scale: FloatArray
) -> tuple[FloatArray, FloatArray, float, float]:
    """Return the normal equations of point-to-line matching at a pose.

    Returns:
        The matrix, of shape (3, 3); the negated right-hand side, of shape (3,); the share of the points that are on a
        wall; and the error of the points that were used, in meters.
    """
    points = transform_points(pose, scan.points)
    distances, _, wall_points, normals, flatness = reference.find_nearest(points)
    sensor = transform_points(pose, scan.origin[None])[0]
    is_facing = np.einsum("ni,ni->n", normals, sensor - wall_points) > 0  # Ignore the other side of a thin wall.
    is_used = (distances < max_distance) & is_facing & (flatness > 0.3)
    if not is_used.any():
        return np.zeros((3, 3)), np.zeros(3), 0.0, max_distance
    points, normals = points[is_used], normals[is_used]
    residuals = np.einsum("ni,ni->n", normals, points - wall_points[is_used])
    weights = flatness[is_used] / (1 + (residuals / _CAUCHY_SCALE_M) ** 2)
    lever_arms = points - pose[:2]
    yaw_derivatives = normals[:, 1] * lever_arms[:, 0] - normals[:, 0] * lever_arms[:, 1]
    rows = np.column_stack((normals, yaw_derivatives)) * scale
    weighted_rows = rows * weights[:, None]
    inlier_count = int((np.abs(residuals) < _LAST_MAX_DISTANCE_M).sum())
    error = float(np.sqrt((weights * residuals**2).sum() / weights.sum()))
    return weighted_rows.T @ rows, weighted_rows.T @ residuals, inlier_count / len(scan.points), error
