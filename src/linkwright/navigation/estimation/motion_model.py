"""The motion model of a body in space: its state, prediction and Jacobian.

The state of 15 numbers consists of position (m) and roll, pitch, yaw (rad) in the world, and of linear velocity (m/s),
angular velocity (rad/s) and linear acceleration (m/s2) in the body. Acceleration and angular velocity are constant
between measurements. Source: T. Moore and D. Stouch, "A Generalized Extended Kalman Filter Implementation for the Robot
Operating System", 2014.
"""

from __future__ import annotations

from enum import IntEnum
from math import cos, pi, sin

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
Matrix = NDArray[np.float64]


class State(IntEnum):
    """The indices of the quantities in the state."""

    X = 0
    Y = 1
    Z = 2
    ROLL = 3
    PITCH = 4
    YAW = 5
    VX = 6
    VY = 7
    VZ = 8
    VROLL = 9
    VPITCH = 10
    VYAW = 11
    AX = 12
    AY = 13
    AZ = 14


STATE_SIZE = len(State)
POSITION, ANGLES = slice(0, 3), slice(3, 6)
POSE = slice(0, 6)
VELOCITY, RATES = slice(6, 9), slice(9, 12)
TWIST = slice(6, 12)
ACCELERATION = slice(12, 15)


def wrap_angle(angle: float) -> float:
    """Return an angle in radians, wrapped to -pi to pi."""
    return (angle + pi) % (2.0 * pi) - pi if not -pi <= angle <= pi else angle


def wrap_state_angles(state: Vector) -> None:
    """Wrap roll, pitch and yaw of a state to -pi to pi, in place."""
    state[ANGLES] = [wrap_angle(angle) for angle in state[ANGLES].tolist()]


def rotation(roll: float, pitch: float, yaw: float) -> Matrix:
    """Return the rotation matrix from the body to the world, of shape (3, 3).

    The matrix is Rz(yaw) Ry(pitch) Rx(roll).
    """
    sr, cr, sp, cp, sy, cy = sin(roll), cos(roll), sin(pitch), cos(pitch), sin(yaw), cos(yaw)
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def predict_state(state: Vector, seconds: float) -> Vector:
    """Return the predicted state after some seconds, as a new array of shape (15,).

    Angles are wrapped to -pi to pi.
    """
    rotation_matrix, angle_rates = rotation(*state[ANGLES].tolist()), _angle_rates(state)
    predicted = state.copy()
    predicted[POSITION] += rotation_matrix @ _shift(state, seconds)
    predicted[ANGLES] += angle_rates @ state[RATES] * seconds
    predicted[VELOCITY] += state[ACCELERATION] * seconds
    wrap_state_angles(predicted)
    return predicted


def state_jacobian(state: Vector, seconds: float) -> Matrix:
    """Return the Jacobian of `predict_state` with respect to the state, shape (15, 15)."""
    roll, pitch, yaw = state[ANGLES].tolist()
    rotation_matrix, angle_rates = rotation(roll, pitch, yaw), _angle_rates(state)
    jacobian = np.eye(STATE_SIZE)
    jacobian[POSITION, VELOCITY] = rotation_matrix * seconds
    jacobian[POSITION, ACCELERATION] = rotation_matrix * (0.5 * seconds * seconds)
    jacobian[ANGLES, RATES] = angle_rates * seconds
    jacobian[VELOCITY, ACCELERATION] = np.eye(3) * seconds

    # A small rotation about an axis moves a point by the cross product of the axis with the point.
    shift = _shift(state, seconds)
    world_shift = rotation_matrix @ shift
    mx, my, mz = world_shift.tolist()
    jacobian[POSITION, State.ROLL] = rotation_matrix[:, 2] * shift[1] - rotation_matrix[:, 1] * shift[2]
    jacobian[POSITION, State.PITCH] = (cos(yaw) * mz, sin(yaw) * mz, -sin(yaw) * my - cos(yaw) * mx)
    jacobian[POSITION, State.YAW] = (-my, mx, 0.0)

    sr, cr, sp, cp = sin(roll), cos(roll), sin(pitch), cos(pitch)
    _, pitch_rate, yaw_rate = (state[RATES] * seconds).tolist()
    pitch_change, unscaled_yaw_change = cr * pitch_rate - sr * yaw_rate, sr * pitch_rate + cr * yaw_rate
    jacobian[State.ROLL, State.ROLL] += pitch_change * sp / cp
    jacobian[State.PITCH, State.ROLL] = -unscaled_yaw_change
    jacobian[State.YAW, State.ROLL] = pitch_change / cp
    jacobian[State.ROLL, State.PITCH] = unscaled_yaw_change / (cp * cp)
    jacobian[State.YAW, State.PITCH] = unscaled_yaw_change * sp / (cp * cp)
    return jacobian


def _shift(state: Vector, seconds: float) -> Vector:
    """Return the displacement of the body after some seconds, in the body's axes."""
    shift: Vector = state[VELOCITY] * seconds + state[ACCELERATION] * (0.5 * seconds * seconds)
    return shift


def _angle_rates(state: Vector) -> Matrix:
    """Return the matrix that maps angular velocity to the rates of roll, pitch and yaw.

    The angular velocity is in the frame of the body. The matrix has shape (3, 3).
    """
    roll, pitch = float(state[State.ROLL]), float(state[State.PITCH])
    sr, cr, sp, cp = sin(roll), cos(roll), sin(pitch), cos(pitch)
    return np.array([[1.0, sr * sp / cp, cr * sp / cp], [0.0, cr, -sr], [0.0, sr / cp, cr / cp]])
