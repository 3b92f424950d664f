"""Extended and unscented Kalman filters for the motion of a body.

Both filters predict a state (see `motion_model`) and its covariance over time, and correct them by measurements of some
of the 15 quantities.

Sources: T. Moore and D. Stouch 2014 for the extended filter and its default noise; S. Julier and J. Uhlmann, "Unscented
Filtering and Nonlinear Estimation", 2004, for the unscented filter.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from math import inf, isfinite, sqrt

import numpy as np

from linkwright.navigation.estimation.motion_model import (
    ACCELERATION,
    POSE,
    RATES,
    STATE_SIZE,
    TWIST,
    Matrix,
    State,
    Vector,
    predict_state,
    state_jacobian,
    wrap_angle,
    wrap_state_angles,
)

MIN_VARIANCE = 1e-9
"""The minimum variance of a measured value, so that the matrices can be inverted."""

DEFAULT_NOISE = (0.05, 0.05, 0.06, 0.03, 0.03, 0.06, 0.025, 0.025, 0.04, 0.01, 0.01, 0.02, 0.01, 0.01, 0.015)
"""The default variances added to the state per second."""

_ANGLES = (State.ROLL, State.PITCH, State.YAW)


@dataclass(frozen=True, slots=True, eq=False)
class Measurement:
    """A measurement of some of the state's quantities.

    Attributes:
        source: the name of the sensor.
        time_ns: the time of the measurement.
        values: the measured values, shape (15,).
        covariance: the covariance of the values, shape (15, 15).
        used: whether each of the 15 values is used.
        threshold: the maximum Mahalanobis distance from the expected values; measurements beyond it are rejected.
        control: the velocities commanded at that time, shape (6,), and the time of the command.
    """

    source: str
    time_ns: int
    values: Vector
    covariance: Matrix
    used: tuple[bool, ...]
    threshold: float = inf
    control: tuple[Vector, int] | None = None


@dataclass(frozen=True, slots=True)
class Control:
    """The response of a body to six commanded velocities.

    The velocities are vx, vy, vz and the rates of roll, pitch and yaw.

    Attributes:
        used: whether each of the six velocities is controlled.
        timeout_ns: the age at which a command counts as zero velocity.
        acceleration_limits: the maximum accelerations, in m/s2 and rad/s2.
        acceleration_gains: the acceleration per unit of velocity error.
        deceleration_limits: the limits for slowing down.
        deceleration_gains: the gains for slowing down.
    """

    used: tuple[bool, ...]
    timeout_ns: int
    acceleration_limits: tuple[float, ...]
    acceleration_gains: tuple[float, ...]
    deceleration_limits: tuple[float, ...]
    deceleration_gains: tuple[float, ...]

    def compute_acceleration(self, index: int, velocity: float, commanded: float) -> float:
        """Return the acceleration that brings one of the six velocities to its commanded value.

        The acceleration is within the limits, in m/s2 or rad/s2.
        """
        error = commanded - velocity
        target = commanded if abs(error) <= abs(commanded) + 0.01 else 0.0
        if abs(target) < abs(velocity):
            limit, gain = self.deceleration_limits[index], self.deceleration_gains[index]
        else:
            limit, gain = self.acceleration_limits[index], self.acceleration_gains[index]
        return min(max(gain * error, -limit), limit)


@dataclass(slots=True, eq=False)
class Snapshot:
    """The state of a filter at one time, as returned by `KalmanFilter.snapshot`."""

    state: Vector
    covariance: Matrix
    time_ns: int
    is_initialized: bool
    command: tuple[Vector, int]


@dataclass(slots=True, eq=False)
class Settings:
    """The settings of a filter.

    Attributes:
        noise: the covariance added per second, shape (15, 15).
        initial_covariance: the covariance at the start, shape (15, 15).
        initial_state: the state at the start, shape (15,).
        uses_dynamic_noise: whether the noise of the pose grows with the velocity and is zero at rest.
        control: the response to commands; None to ignore commands.
    """

    noise: Matrix = field(default_factory=lambda: np.diag(DEFAULT_NOISE))
    initial_covariance: Matrix = field(default_factory=lambda: np.eye(STATE_SIZE) * 1e-9)
    initial_state: Vector = field(default_factory=lambda: np.zeros(STATE_SIZE))
    uses_dynamic_noise: bool = False
    control: Control | None = None


class KalmanFilter(ABC):
    """The base class of filters that predict and correct a state and its covariance.

    Args:
        settings: the settings; see `Settings`.

    Attributes:
        state: the estimated state, shape (15,).
        covariance: the covariance of the state, shape (15, 15).
        time_ns: the time of the state.
        is_initialized: whether a measurement has initialized the state.
    """

    def __init__(self, settings: Settings | None = None) -> None:
        self.settings = settings or Settings()
        self.state: Vector
        self.covariance: Matrix
        self.time_ns = 0
        self.reset()

    def reset(self) -> None:
        """Reset the filter.

        The next measurement initializes the state.
        """
        self.state = self.settings.initial_state.copy()
        self.covariance = self.settings.initial_covariance.copy()
        self.is_initialized = False
        self.command: tuple[Vector, int] = (np.zeros(6), 0)

    def snapshot(self) -> Snapshot:
        """Return a copy of the filter's state that can be passed to `restore`."""
        return Snapshot(self.state.copy(), self.covariance.copy(), self.time_ns, self.is_initialized, self.command)

    def restore(self, snapshot: Snapshot) -> None:
        """Restore the state that `snapshot` returned."""
        self.state, self.covariance = snapshot.state.copy(), snapshot.covariance.copy()
        self.time_ns, self.is_initialized, self.command = snapshot.time_ns, snapshot.is_initialized, snapshot.command

    def process(self, measurement: Measurement) -> bool:
        """Predict the state up to the time of a measurement, and correct it with the measurement.

        A measurement from before the state's time corrects the state without a prediction. The first measurement
        initializes the state. Returns whether the measurement was used.
        """
        if not self.is_initialized:
            self._initialize(measurement)
            return True
        if measurement.time_ns > self.time_ns:
            self.predict(measurement.time_ns)
        return self.correct(measurement)

    def predict(self, time_ns: int) -> None:
        """Predict the state and its covariance at a later time."""
        seconds = (time_ns - self.time_ns) / 1e9
        self._apply_commands(time_ns, seconds)
        self._predict(seconds)
        self.time_ns = time_ns

    def correct(self, measurement: Measurement) -> bool:
        """Correct the state by a measurement at the state's time.

        Returns whether the measurement was used: it must contain finite values, and pass the Mahalanobis test.
        """
        used_indices = _find_used_indices(measurement)
        if not used_indices:
            return False
        innovation = measurement.values[used_indices] - self.state[used_indices]
        for row, index in enumerate(used_indices):
            if index in _ANGLES:
                innovation[row] = wrap_angle(float(innovation[row]))
        noise = _select_noise(measurement, used_indices)
        try:
            inverse = np.linalg.inv(self.covariance[np.ix_(used_indices, used_indices)] + noise)
        except np.linalg.LinAlgError:
            return False
        if float(innovation @ inverse @ innovation) >= measurement.threshold**2:
            return False
        gain = self.covariance[:, used_indices] @ inverse
        self.state = self.state + gain @ innovation
        correction = np.eye(STATE_SIZE)
        correction[:, used_indices] -= gain
        self.covariance = correction @ self.covariance @ correction.T + gain @ noise @ gain.T
        wrap_state_angles(self.state)
        return True

    @abstractmethod
    def _predict(self, seconds: float) -> None: ...

    def _initialize(self, measurement: Measurement) -> None:
        used_indices = _find_used_indices(measurement)
        self.state[used_indices] = measurement.values[used_indices]
        self.covariance[np.ix_(used_indices, used_indices)] = measurement.covariance[np.ix_(used_indices, used_indices)]
        self.time_ns = measurement.time_ns
        self.is_initialized = True

    def _compute_process_noise(self, seconds: float) -> Matrix:
        noise = self.settings.noise
        if self.settings.uses_dynamic_noise:
            noise = noise.copy()
            noise[POSE, POSE] *= float(self.state[TWIST] @ self.state[TWIST])
        return noise * seconds

    def _apply_commands(self, time_ns: int, seconds: float) -> None:
        control = self.settings.control
        if control is None:
            return
        command, commanded_ns = self.command
        has_timed_out = time_ns - commanded_ns >= control.timeout_ns
        for index, is_controlled in enumerate(control.used):
            if not is_controlled:
                continue
            velocity = float(self.state[TWIST][index])
            acceleration = control.compute_acceleration(
                index, velocity, 0.0 if has_timed_out else float(command[index])
            )
            if index < 3:
                self.state[ACCELERATION][index] = acceleration
            else:
                self.state[RATES][index - 3] += acceleration * seconds


class ExtendedKalmanFilter(KalmanFilter):
    """A Kalman filter that linearizes the motion at the state."""

    def _predict(self, seconds: float) -> None:
        jacobian, noise = state_jacobian(self.state, seconds), self._compute_process_noise(seconds)
        self.state = predict_state(self.state, seconds)
        self.covariance = jacobian @ self.covariance @ jacobian.T + noise


class UnscentedKalmanFilter(KalmanFilter):
    """A Kalman filter that computes mean and covariance from propagated sigma points.

    Args:
        settings: the settings; see `Settings`.
        alpha: the spread of the sigma points around the state.
        kappa: a secondary scaling of the spread.
        beta: prior knowledge of the distribution; 2 for a normal distribution.
    """

    def __init__(
        self, settings: Settings | None = None, *, alpha: float = 0.001, kappa: float = 0.0, beta: float = 2.0
    ) -> None:
        spread = alpha * alpha * (STATE_SIZE + kappa) - STATE_SIZE
        self._scale = sqrt(STATE_SIZE + spread)
        self._weights = np.full(2 * STATE_SIZE + 1, 0.5 / (STATE_SIZE + spread))
        self._weights[0] = spread / (STATE_SIZE + spread)
        self._covariance_weights = self._weights.copy()
        self._covariance_weights[0] += 1.0 - alpha * alpha + beta
        super().__init__(settings)

    def _predict(self, seconds: float) -> None:
        noise = self._compute_process_noise(seconds)
        root = _square_root(self.covariance) * self._scale
        points = [self.state, *(self.state + column for column in root.T), *(self.state - column for column in root.T)]
        predicted_points = np.array([predict_state(point, seconds) for point in points])
        # Angles near +-pi are averaged relative to the first point.
        center = predicted_points[0]
        deviations = predicted_points - center
        for index in _ANGLES:
            deviations[:, index] = [wrap_angle(float(angle)) for angle in deviations[:, index]]
        mean = self._weights @ deviations
        deviations -= mean
        self.state = center + mean
        wrap_state_angles(self.state)
        self.covariance = (deviations.T * self._covariance_weights) @ deviations + noise


def _square_root(covariance: Matrix) -> Matrix:
    """Return a matrix square root of a covariance.

    If rounding made the covariance invalid, the root of the nearest positive semidefinite matrix is returned.
    """
    try:
        root: Matrix = np.asarray(np.linalg.cholesky(covariance), dtype=np.float64)
    except np.linalg.LinAlgError:
        values, vectors = np.linalg.eigh((covariance + covariance.T) / 2.0)
        root = vectors * np.sqrt(np.maximum(values, 0.0))
    return root


def _find_used_indices(measurement: Measurement) -> list[int]:
    """Return the indices of the used values that are finite and have a finite variance."""
    values, covariance = measurement.values, measurement.covariance
    return [
        index
        for index, used in enumerate(measurement.used)
        if used and isfinite(values[index]) and isfinite(covariance[index, index])
    ]


def _select_noise(measurement: Measurement, used_indices: list[int]) -> Matrix:
    noise = measurement.covariance[np.ix_(used_indices, used_indices)].copy()
    for row in range(len(used_indices)):
        noise[row, row] = max(abs(noise[row, row]), MIN_VARIANCE)
    return noise
