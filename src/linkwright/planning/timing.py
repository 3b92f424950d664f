"""Time-optimal trajectories along paths, within limits of velocity and acceleration.

The corners of a path are rounded with circular arcs, as in Kunz and Stilman, "Time-Optimal Trajectory Generation for
Path Following with Bounded Acceleration and Velocity", RSS 2012, which MoveIt uses. The speed along the path is found
by reachability, as in Pham and Pham, "A New Approach to Time-Optimal Path Parameterization Based on Reachability
Analysis", IEEE Transactions on Robotics 34 (2018): a backward pass finds the largest speed at each point from which the
rest of the path is possible, and a forward pass accelerates as much as that allows.

The variables at a point of the path are the square x of the speed along the path, and the acceleration u along it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array

_MIN_SLOPE = 1e-9
"""The magnitude of a derivative by the path's length up to which it counts as zero."""
_MIN_LENGTH = 1e-9
"""The distance in rad or m up to which two corners of a path count as the same."""
_MAX_TURN = 1e-6
"""The change of the direction at a point of the path up to which the motion does not stop there."""
_MARGIN = 0.995
"""The share of the limits that is used, because they are exceeded by up to 0.2 % between two points."""
_MIN_ANGLE = 1e-4
"""The angle in rad between two lines up to which there is no corner."""
_LINE_SPACING = 0.1
"""The maximum distance in rad or m between two points of a line at which the speed is computed."""
_ARC_SPACING = 0.05
"""The maximum angle in rad between the directions at two points of an arc."""
_MIN_POINTS = 8
"""The minimum number of points of a line or arc."""


MaxPathSpeeds = Callable[[Array, Array], Array]
"""Returns the maximum speeds along a path, shape (n,), at positions and their derivatives by the length (n, joints)."""


@dataclass(frozen=True, slots=True, eq=False)
class Trajectory:
    """Positions of joints over time, starting and ending at rest.

    Attributes:
        times: in s, increasing from 0, shape (n,).
        positions: in rad or m, shape (n, joints).
        velocities: in rad/s or m/s, shape (n, joints).
        accelerations: in rad/s2 or m/s2, shape (n, joints).
    """

    times: Array
    positions: Array
    velocities: Array
    accelerations: Array

    @property
    def duration(self) -> float:
        """The duration in s."""
        return float(self.times[-1])

    def interpolate(self, times: Array) -> tuple[Array, Array, Array]:
        """Return positions, velocities and accelerations by the quintic splines that controllers use.

        Each has the shape (n, joints).

        Args:
            times: in s, shape (n,).
        """
        if len(self.times) == 1:
            rest = np.zeros((len(times), self.positions.shape[1]))
            return rest + self.positions, rest, rest
        indexes = np.clip(np.searchsorted(self.times, times, side="right") - 1, 0, len(self.times) - 2)
        widths, (first, slope, c2, c3, c4, c5) = self.coefficients(indexes)
        x = (np.clip(times, 0.0, self.duration) - self.times[indexes])[:, None] / widths
        return (
            first + x * (slope + x * (c2 + x * (c3 + x * (c4 + x * c5)))),
            (slope + x * (2.0 * c2 + x * (3.0 * c3 + x * (4.0 * c4 + x * 5.0 * c5)))) / widths,
            (2.0 * c2 + x * (6.0 * c3 + x * (12.0 * c4 + x * 20.0 * c5))) / widths**2,
        )

    def coefficients(self, indexes: Any = slice(None, -1)) -> tuple[Array, Array]:
        """Return the durations of intervals in s, shape (n, 1), and the coefficients of their quintic splines.

        The coefficients have the shape (6, n, joints) and are by the share of the interval, from 0 to 1.

        Args:
            indexes: the indexes of the intervals; by default all of them.
        """
        numbers = np.arange(len(self.times))[indexes]
        widths = (self.times[numbers + 1] - self.times[numbers])[:, None]
        (first, slope, bend), (last, end_slope, end_bend) = (
            (self.positions[at], self.velocities[at] * widths, self.accelerations[at] * widths**2)
            for at in (numbers, numbers + 1)
        )
        change = last - first
        c3 = 10.0 * change - 6.0 * slope - 4.0 * end_slope - 1.5 * bend + 0.5 * end_bend
        c4 = -15.0 * change + 8.0 * slope + 7.0 * end_slope + 1.5 * bend - end_bend
        c5 = 6.0 * change - 3.0 * (slope + end_slope) + 0.5 * (end_bend - bend)
        return widths, np.array((first, slope, bend / 2.0, c3, c4, c5))

    def slowed(self, factor: float) -> Trajectory:
        """Return the same motion in a time that is longer by a factor."""
        if factor == 1.0:
            return self
        return Trajectory(self.times * factor, self.positions, self.velocities / factor, self.accelerations / factor**2)


def parameterize(
    corners: Array,
    max_velocities: Array,
    max_accelerations: Array,
    *,
    max_deviation: float = 0.1,
    interval_s: float = 0.1,
    max_path_speeds: MaxPathSpeeds | None = None,
) -> Trajectory:
    """Return the fastest trajectory along a path that starts and ends at rest.

    Args:
        corners: the corners of the path, shape (n, joints).
        max_velocities: in rad/s or m/s, shape (joints,), or (n - 1, joints) for limits that differ between corners.
        max_accelerations: in rad/s2 or m/s2, of the same shape.
        max_deviation: the maximum distance of the trajectory from a corner, in rad or m over all joints; 0 to stop at
            each corner.
        interval_s: the time in s between two points of the trajectory.
        max_path_speeds: an additional limit of the speed along the path.
    """
    shape = (len(corners) - 1, corners.shape[1])
    limits = np.array([np.broadcast_to(rows, shape) for rows in (max_velocities, max_accelerations)])
    is_distinct = np.linalg.norm(np.diff(corners, axis=0), axis=1) > _MIN_LENGTH
    corners, limits = corners[np.concatenate(([True], is_distinct))], limits[:, is_distinct]
    if len(corners) < 2:
        zeros = np.zeros_like(corners[:1])
        return Trajectory(np.zeros(1), corners[:1], zeros, zeros)
    path = _round_corners(corners, limits * _MARGIN, max_deviation)
    return _sample(path, _compute_speeds(path, max_path_speeds), interval_s)


@dataclass(frozen=True, slots=True, eq=False)
class _Piece:
    """A line or an arc of a path.

    Attributes:
        length: the length in rad or m over all joints.
        origin: the first point of a line, or the center of an arc, shape (joints,).
        direction: the direction at the start, shape (joints,).
        limits: the maximum velocities and accelerations, shape (2, joints).
        radial: the direction from the center to the first point of an arc, shape (joints,); zeros for a line.
        radius: the radius of an arc; infinite for a line.
    """

    length: float
    origin: Array
    direction: Array
    limits: Array
    radial: Array
    radius: float = np.inf

    @property
    def points(self) -> Array:
        """The distances from the start at which the speed is computed."""
        steps = self.length / (_LINE_SPACING if np.isinf(self.radius) else _ARC_SPACING * self.radius)
        count = max(_MIN_POINTS, int(np.ceil(steps)) + 1)
        return np.linspace(0.0, self.length, count, dtype=np.float64)

    def evaluate(self, distances: Array) -> tuple[Array, Array, Array]:
        """Return positions and their first two derivatives by the length.

        Each has the shape (n, joints).
        """
        if np.isinf(self.radius):
            zeros = np.zeros((len(distances), len(self.origin)))
            return self.origin + distances[:, None] * self.direction, zeros + self.direction, zeros
        angles = (distances / self.radius)[:, None]
        radial = np.cos(angles) * self.radial + np.sin(angles) * self.direction
        slopes = np.cos(angles) * self.direction - np.sin(angles) * self.radial
        return self.origin + self.radius * radial, slopes, -radial / self.radius


class _Path:
    """A path of lines and arcs, and points along it.

    Attributes:
        lengths: the length of the path up to each point, shape (n,).
        positions: the positions of the joints, shape (n, joints).
        slopes: the derivatives of the positions by the length, shape (n, joints).
        curvatures: their second derivatives, shape (n, joints).
        max_velocities: the limits at each point, shape (n, joints).
        max_accelerations: the limits at each point, shape (n, joints).
    """

    def __init__(self, pieces: Sequence[_Piece]) -> None:
        self._pieces = pieces
        self._starts = np.cumsum([0.0, *(piece.length for piece in pieces)])
        self.lengths = np.concatenate(
            [start + piece.points for start, piece in zip(self._starts, pieces, strict=False)]
        )
        evaluated = [piece.evaluate(piece.points) for piece in pieces]
        self.positions, self.slopes, self.curvatures = (
            np.concatenate([parts[index] for parts in evaluated]) for index in range(3)
        )
        counts = [len(piece.points) for piece in pieces]
        self.max_velocities, self.max_accelerations = (
            np.repeat([piece.limits[index] for piece in pieces], counts, axis=0) for index in (0, 1)
        )

    def evaluate(self, lengths: Array) -> tuple[Array, Array, Array]:
        """Return positions and their first two derivatives by the length.

        Each has the shape (n, joints).

        Args:
            lengths: the lengths of the path up to the requested points, increasing, shape (n,).
        """
        numbers = np.clip(np.searchsorted(self._starts, lengths, side="right") - 1, 0, len(self._pieces) - 1)
        parts = [
            piece.evaluate(np.minimum(lengths[numbers == number] - self._starts[number], piece.length))
            for number, piece in enumerate(self._pieces)
        ]
        positions, slopes, curvatures = (np.concatenate([part[index] for part in parts]) for index in range(3))
        return positions, slopes, curvatures


def _round_corners(corners: Array, limits: Array, max_deviation: float) -> _Path:
    """Return a path with an arc at each corner, on which the smaller limits of both lines hold."""
    pieces: list[_Piece] = []
    start = corners[0]
    for index in range(1, len(corners)):
        end, arc = corners[index], None
        if index < len(corners) - 1:
            arc_limits = limits[:, index - 1 : index + 1].min(axis=1)
            arc = _make_arc(corners[index - 1], end, corners[index + 1], arc_limits, max_deviation)
        if arc is not None:
            end = arc.evaluate(np.zeros(1))[0][0]
        length = float(np.linalg.norm(end - start))
        if length > _MIN_LENGTH:
            pieces.append(_Piece(length, start, (end - start) / length, limits[:, index - 1], np.zeros_like(start)))
        start = end
        if arc is not None:
            pieces.append(arc)
            start = arc.evaluate(np.array([arc.length]))[0][0]
    return _Path(pieces)


def _make_arc(previous: Array, corner: Array, following: Array, limits: Array, max_deviation: float) -> _Piece | None:
    """Return the arc that rounds a corner, or None if the path is straight or turns back there."""
    incoming, outgoing = corner - previous, following - corner
    incoming_length, outgoing_length = float(np.linalg.norm(incoming)), float(np.linalg.norm(outgoing))
    incoming, outgoing = incoming / incoming_length, outgoing / outgoing_length
    angle = float(np.arccos(np.clip(incoming @ outgoing, -1.0, 1.0)))
    if angle < _MIN_ANGLE or angle > np.pi - _MIN_ANGLE or max_deviation <= 0.0:
        return None
    half = angle / 2.0
    reach = min(incoming_length / 2.0, outgoing_length / 2.0, max_deviation * np.sin(half) / (1.0 - np.cos(half)))
    radius = float(reach / np.tan(half))
    to_center = outgoing - incoming
    center = corner + to_center / np.linalg.norm(to_center) * radius / np.cos(half)
    radial = corner - reach * incoming - center
    return _Piece(radius * angle, center, incoming, limits, radial / np.linalg.norm(radial), radius)


def _compute_speeds(path: _Path, max_path_speeds: MaxPathSpeeds | None) -> Array:
    """Return the square of the speed along the path at each of its points, shape (n,)."""
    steps = np.diff(path.lengths)
    limits, offsets, ratios = _speed_limits(path, steps)
    if max_path_speeds is not None:
        limits = np.minimum(limits, max_path_speeds(path.positions, path.slopes) ** 2)
    is_corner = np.linalg.norm(np.diff(path.slopes, axis=0), axis=1) > _MAX_TURN
    is_corner &= steps == 0.0
    limits[:-1][is_corner] = limits[1:][is_corner] = 0.0
    reachable = limits
    reachable[-1] = 0.0
    for index in range(len(steps) - 1, -1, -1):
        step = 2.0 * steps[index]
        if step <= 0.0:
            reachable[index] = min(reachable[index], reachable[index + 1])
            continue
        with np.errstate(divide="ignore", invalid="ignore"):
            bounds = (reachable[index + 1] / step + offsets[index]) / (1.0 / step - ratios[index])
        bounds = np.where(1.0 / step - ratios[index] > 0.0, bounds, np.inf)
        reachable[index] = min(reachable[index], float(bounds.min()))
    speeds = np.zeros_like(reachable)
    for index in range(len(steps)):
        largest = float((offsets[index] - ratios[index] * speeds[index]).min())
        speeds[index + 1] = max(0.0, min(reachable[index + 1], speeds[index] + 2.0 * steps[index] * largest))
    return speeds


def _speed_limits(path: _Path, steps: Array) -> tuple[Array, Array, Array]:
    """Return the limits of x and u at each point of a path.

    Returns:
        The largest x for which there is a possible u, shape (n,), and the offsets and ratios of the lines that bound u,
        each of shape (n, lines): -offset - ratio * x and offset - ratio * x.
    """
    slopes, curvatures = path.slopes, path.curvatures
    # Between two points of an arc, a joint may move faster than at one of them.
    steepest = np.abs(slopes)
    steepest[:-1] = np.maximum(steepest[:-1], np.abs(slopes[1:]))
    steepest[1:] = np.maximum(steepest[1:], np.abs(slopes[:-1]))
    limits = np.divide(path.max_velocities, steepest, out=np.full_like(slopes, np.inf), where=steepest > _MIN_SLOPE)
    limits = (limits**2).min(axis=1)
    # u must also be possible at the next point, where x is larger by 2 * step * u.
    end_slopes = slopes.copy()
    end_slopes[:-1] = slopes[1:] + 2.0 * steps[:, None] * curvatures[1:]
    end_curvatures = np.concatenate((curvatures[1:], curvatures[-1:]))
    all_slopes = np.concatenate((slopes, end_slopes), axis=1)
    all_curvatures = np.concatenate((curvatures, end_curvatures), axis=1)
    accelerations = path.max_accelerations
    bounds = np.concatenate((accelerations, np.concatenate((accelerations[1:], accelerations[-1:]))), axis=1)
    is_moving = np.abs(all_slopes) > _MIN_SLOPE
    offsets = np.divide(bounds, np.abs(all_slopes), out=np.full_like(all_slopes, np.inf), where=is_moving)
    ratios = np.divide(all_curvatures, all_slopes, out=np.zeros_like(all_slopes), where=is_moving)
    is_turning = np.abs(all_curvatures) > _MIN_SLOPE
    pure = np.divide(
        bounds, np.abs(all_curvatures), out=np.full_like(all_slopes, np.inf), where=is_turning & ~is_moving
    )
    differences = ratios[:, None, :] - ratios[:, :, None]
    crossings = np.divide(
        offsets[:, :, None] + offsets[:, None, :],
        differences,
        out=np.full_like(differences, np.inf),
        where=differences > _MIN_SLOPE,
    )
    return np.minimum(limits, np.minimum(pure.min(axis=1), crossings.min(axis=(1, 2)))), offsets, ratios


def _sample(path: _Path, squared_speeds: Array, interval_s: float) -> Trajectory:
    """Return the trajectory at regular times."""
    speeds = np.sqrt(squared_speeds)
    steps = np.diff(path.lengths)
    sums = speeds[:-1] + speeds[1:]
    durations = np.divide(2.0 * steps, sums, out=np.zeros_like(steps), where=sums > 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        accelerations = np.where(steps > 0.0, (squared_speeds[1:] - squared_speeds[:-1]) / (2.0 * steps), 0.0)
    ends = np.concatenate(([0.0], np.cumsum(durations)))
    count = max(2, int(np.ceil(ends[-1] / interval_s)) + 1)
    times = np.linspace(0.0, ends[-1], count)
    indexes = np.clip(np.searchsorted(ends, times, side="right") - 1, 0, len(steps) - 1)
    elapsed = times - ends[indexes]
    distances = speeds[indexes] * elapsed + 0.5 * accelerations[indexes] * elapsed**2
    sampled_speeds = np.maximum(0.0, speeds[indexes] + accelerations[indexes] * elapsed)
    positions, slopes, curvatures = path.evaluate(path.lengths[indexes] + np.clip(distances, 0.0, steps[indexes]))
    sampled_speeds[0] = sampled_speeds[-1] = 0.0
    return Trajectory(
        times,
        positions,
        slopes * sampled_speeds[:, None],
        slopes * accelerations[indexes][:, None] + curvatures * (sampled_speeds**2)[:, None],
    )
