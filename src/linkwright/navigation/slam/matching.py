"""Scan matching: a search over poses, followed by least squares."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import pi

import numpy as np

from linkwright.navigation.slam.poses import Floats, transform_points, wrapped
from linkwright.navigation.slam.reference import Likelihood, Reference
from linkwright.navigation.slam.scan import PlanarScan
from linkwright.navigation.slam.search import Search, best_pose
from linkwright.navigation.slam.steps import Steps

LEAST_POINTS = 12
"""The least number of points of a scan to be matched."""

_ROUNDS = 15
_FARTHEST, _NEAREST = 0.30, 0.10
"""The greatest distance in metres of corresponding points, in the first round and in the last ones."""
_SCALE = 0.03
"""Distances beyond this count less and less, in metres."""
_CONVERGED = 1e-5
_SINGULAR = 0.02
"""Directions with less than this share of the greatest possible information, per point, are left as they were."""
_DEPENDENT = 0.1
"""Points of one scan share their errors: they count as this share of their number."""
_LEAST_ERROR = 0.01
_EXPANSIONS = (0.349, 0.698, 1.047)
"""Angles that are searched besides where nothing fits and use_response_expansion is true, in radians; as in Karto."""


@dataclass(frozen=True, slots=True, eq=False)
class Match:
    """The result of scan matching.

    Attributes:
        pose: the pose of the robot, of shape (3,), in the frame of the reference.
        response: the response of the search, 0 to 1 (see `linkwright.navigation.slam.search`), reduced by penalties.
        information: the inverse of the pose's covariance, of shape (3, 3), for x, y and yaw in the frame of the robot;
            near 0 in directions without information, as along a corridor.
        inliers: the share of the points on a wall, 0 to 1.
        error: the root mean square of the points' distances from their walls, in metres.
    """

    pose: Floats
    response: float
    information: Floats
    inliers: float
    error: float


def match(
    reference: Reference, scan: PlanarScan, guess: Floats, search: Search, *, expand: bool = False
) -> Steps[Match | None]:
    """Match a scan against earlier scans, in steps.

    In directions without information, as along a corridor, the pose is that of the guess.

    Args:
        reference: the earlier scans.
        scan: the current scan.
        guess: the expected pose of the robot, of shape (3,).
        search: the window and method of the search.
        expand: whether to search larger angles if the response is 0.

    Returns:
        The match; None if there are too few points.
    """
    if len(scan.points) < LEAST_POINTS or len(reference) < LEAST_POINTS:
        return None
    likelihood = Likelihood(reference.points, search.cell, search.smear_deviation)
    yield
    pose, response = yield from best_pose(likelihood, scan.points, guess, search)
    for offset in _EXPANSIONS if expand else ():
        if response > 0:
            break
        wider = replace(search, angle_offset=search.angle_offset + offset)
        pose, response = yield from best_pose(likelihood, scan.points, guess, wider)
    reference.find_lines()
    yield
    return _refine(reference, scan, guess, pose, response)


def _refine(reference: Reference, scan: PlanarScan, guess: Floats, start: Floats, response: float) -> Match:
    """Refine a pose by point-to-line ICP with Cauchy weights.

    Source: Censi, "An ICP variant using a point-to-line metric", 2008.
    """
    reach = max(float(np.sqrt((scan.points**2).sum(axis=1).mean())), 0.1)
    scale = np.array((1.0, 1.0, 1.0 / reach))  # Scale the rotation to the distance by which it moves an average point.
    pose, farthest = start.copy(), _FARTHEST
    system = _normal_equations(reference, scan, pose, farthest, scale)
    free = _constrained_projection(system[0], len(scan.points))
    turn = wrapped(start - guess)[2]
    shift: Floats = np.array((start[0] - guess[0], start[1] - guess[1], turn)) / scale
    pose = guess + scale * (free @ shift)
    for _ in range(_ROUNDS):
        hessian, gradient, _, _ = _normal_equations(reference, scan, pose, farthest, scale)
        free = _constrained_projection(hessian, len(scan.points))
        step: Floats = -np.linalg.pinv(free @ hessian @ free, rcond=1e-9, hermitian=True) @ (free @ gradient)
        step *= min(1.0, 0.2 / max(float(np.abs(step).max()), 1e-12))
        pose += scale * step
        if np.abs(step).max() < _CONVERGED and farthest == _NEAREST:
            break
        farthest = max(_NEAREST, 0.7 * farthest)
    hessian, _, inliers, error = _normal_equations(reference, scan, pose, _NEAREST, scale)
    free = _constrained_projection(hessian, len(scan.points))
    unscaled = free @ hessian @ free / np.outer(scale, scale)
    cos, sin = np.cos(pose[2]), np.sin(pose[2])
    axes = np.array(((cos, -sin, 0.0), (sin, cos, 0.0), (0.0, 0.0, 1.0)))
    information: Floats = axes.T @ unscaled @ axes * (_DEPENDENT / max(error, _LEAST_ERROR) ** 2)
    pose[2] = (pose[2] + pi) % (2 * pi) - pi
    return Match(pose, response, information, inliers, error)


def _constrained_projection(hessian: Floats, points: int) -> Floats:
    """Return the projection onto the directions that the points constrain, of shape (3, 3)."""
    values, vectors = np.linalg.eigh(hessian)
    kept = vectors[:, values > _SINGULAR * points]
    result: Floats = kept @ kept.T
    return result


def _normal_equations(
    reference: Reference, scan: PlanarScan, pose: Floats, farthest: float, scale: Floats
) -> tuple[Floats, Floats, float, float]:
    """Return the normal equations of point-to-line matching at a pose.

    Returns:
        The matrix, of shape (3, 3); the negated right-hand side, of shape (3,); the share of the points that are on a
        wall; and the error of the points that were used, in metres.
    """
    points = transform_points(pose, scan.points)
    distances, _, places, normals, flatness = reference.nearest(points)
    view = transform_points(pose, scan.origin[None])[0]
    ahead = np.einsum("ni,ni->n", normals, view - places) > 0  # Ignore the other side of a thin wall.
    chosen = (distances < farthest) & ahead & (flatness > 0.3)
    if not chosen.any():
        return np.zeros((3, 3)), np.zeros(3), 0.0, farthest
    points, normals = points[chosen], normals[chosen]
    residuals = np.einsum("ni,ni->n", normals, points - places[chosen])
    weights = flatness[chosen] / (1 + (residuals / _SCALE) ** 2)
    arms = points - pose[:2]
    turned = normals[:, 1] * arms[:, 0] - normals[:, 0] * arms[:, 1]
    rows = np.column_stack((normals, turned)) * scale
    weighted = rows * weights[:, None]
    on_it = int((np.abs(residuals) < _NEAREST).sum())
    error = float(np.sqrt((weights * residuals**2).sum() / weights.sum()))
    return weighted.T @ rows, weighted.T @ residuals, on_it / len(scan.points), error
