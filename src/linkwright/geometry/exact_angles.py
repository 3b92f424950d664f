"""Sines and cosines that have the same bits on every machine.

The sine of a system's library depends on the library and on the processor, in the last bit. The functions here use only
additions and multiplications of floats, which IEEE 754 defines completely.
"""

from __future__ import annotations

from math import fmod

from linkwright.geometry.single import Quaternion, Vector3

_QUARTER_TURN = 1.5707963267948966
_QUARTER_TURN_REST = 6.123233995736766e-17
"""The part of pi/2 that the float above lacks."""
_LARGE_ANGLE = 1e6
_GRID = float(1 << 40)
"""Results are multiples of 1 / _GRID, so that rotations by quarter turns are exact."""
_SINE_TERMS = (-1 / 6, 1 / 120, -1 / 5040, 1 / 362880, -1 / 39916800, 1 / 6227020800)
_COSINE_TERMS = (-1 / 2, 1 / 24, -1 / 720, 1 / 40320, -1 / 3628800, 1 / 479001600, -1 / 87178291200)


def sine_and_cosine(angle: float) -> tuple[float, float]:
    """Return the sine and cosine of an angle in radians, rounded to 2^-40.

    Raises:
        ValueError: the angle is not finite.
    """
    if not -_LARGE_ANGLE < angle < _LARGE_ANGLE:
        angle = fmod(angle, 4.0 * _QUARTER_TURN)  # exact in every library
    quarters = round(angle / _QUARTER_TURN)
    remainder = angle - quarters * _QUARTER_TURN - quarters * _QUARTER_TURN_REST
    square = remainder * remainder
    sine = _round_to_grid(remainder + remainder * square * _sum_series(_SINE_TERMS, square))
    cosine = _round_to_grid(1.0 + square * _sum_series(_COSINE_TERMS, square))
    return ((sine, cosine), (cosine, -sine), (-sine, -cosine), (-cosine, sine))[quarters % 4]


def exact_quaternion(rpy: Vector3) -> Quaternion:
    """Return the rotation Rz(yaw) Ry(pitch) Rx(roll) as a quaternion, of angles in radians."""
    (sin_roll, cos_roll), (sin_pitch, cos_pitch), (sin_yaw, cos_yaw) = (sine_and_cosine(angle / 2.0) for angle in rpy)
    return (
        sin_roll * cos_pitch * cos_yaw - cos_roll * sin_pitch * sin_yaw,
        cos_roll * sin_pitch * cos_yaw + sin_roll * cos_pitch * sin_yaw,
        cos_roll * cos_pitch * sin_yaw - sin_roll * sin_pitch * cos_yaw,
        cos_roll * cos_pitch * cos_yaw + sin_roll * sin_pitch * sin_yaw,
    )


def regular_polygon(sides: int) -> tuple[tuple[float, float], ...]:
    """Return cosine and sine of each corner of a regular polygon; the first corner is also the last."""
    turn = 4.0 * _QUARTER_TURN
    points = [sine_and_cosine(turn * side / sides) for side in range(sides)]
    return tuple((cosine, sine) for sine, cosine in (*points, points[0]))


def _sum_series(terms: tuple[float, ...], square: float) -> float:
    total = 0.0
    for term in reversed(terms):
        total = total * square + term
    return total


def _round_to_grid(value: float) -> float:
    return round(value * _GRID) / _GRID
