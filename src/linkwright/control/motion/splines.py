"""The segments of a trajectory: splines from one point to the next.

Source: joint_trajectory_controller of ros2_controllers. A segment is linear if its points have only positions, cubic if
they also have velocities, and quintic if they have accelerations as well.
"""

from __future__ import annotations

from dataclasses import dataclass, field

_Polynomial = tuple[float, float, float, float, float, float]
"""The coefficients of powers 0 to 5 of the time."""


@dataclass(slots=True)
class MotionState:
    """The positions, velocities and accelerations of joints.

    Each list is empty or has one value per joint.

    Attributes:
        positions: the positions in rad or m.
        velocities: the velocities in rad/s or m/s.
        accelerations: the accelerations in rad/s² or m/s².
    """

    positions: list[float] = field(default_factory=list)
    velocities: list[float] = field(default_factory=list)
    accelerations: list[float] = field(default_factory=list)

    def copy(self) -> MotionState:
        """Return a copy with its own lists."""
        return MotionState(list(self.positions), list(self.velocities), list(self.accelerations))


class Segment:
    """A spline between two states.

    Args:
        start: the initial state, with positions.
        end: the final state, with positions.
        duration_s: the duration, in seconds; more than 0.
    """

    __slots__ = ("_polynomials",)

    def __init__(self, start: MotionState, end: MotionState, duration_s: float) -> None:
        count = len(start.positions)
        polynomials: list[_Polynomial] = []
        for joint in range(count):
            start_position, end_position = start.positions[joint], end.positions[joint]
            if not (start.velocities and end.velocities):
                polynomials.append((start_position, (end_position - start_position) / duration_s, 0.0, 0.0, 0.0, 0.0))
                continue
            velocities = start.velocities[joint], end.velocities[joint]
            if not (start.accelerations and end.accelerations):
                polynomials.append(_fit_cubic(start_position, end_position, *velocities, duration_s))
                continue
            accelerations = start.accelerations[joint], end.accelerations[joint]
            polynomials.append(_fit_quintic(start_position, end_position, *velocities, *accelerations, duration_s))
        self._polynomials = polynomials

    def sample(self, seconds: float) -> MotionState:
        """Return the state at a time in seconds after the start, with values in all three lists."""
        positions: list[float] = []
        velocities: list[float] = []
        accelerations: list[float] = []
        t = seconds
        for a0, a1, a2, a3, a4, a5 in self._polynomials:
            positions.append(a0 + t * (a1 + t * (a2 + t * (a3 + t * (a4 + t * a5)))))
            velocities.append(a1 + t * (2.0 * a2 + t * (3.0 * a3 + t * (4.0 * a4 + t * 5.0 * a5))))
            accelerations.append(2.0 * a2 + t * (6.0 * a3 + t * (12.0 * a4 + t * 20.0 * a5)))
        return MotionState(positions, velocities, accelerations)


def _fit_cubic(p0: float, p1: float, v0: float, v1: float, duration: float) -> _Polynomial:
    """Return the cubic polynomial for the positions and velocities at both ends."""
    distance, length = p1 - p0, duration
    return (
        p0,
        v0,
        (3.0 * distance - (2.0 * v0 + v1) * length) / length**2,
        ((v0 + v1) * length - 2.0 * distance) / length**3,
        0.0,
        0.0,
    )


def _fit_quintic(p0: float, p1: float, v0: float, v1: float, a0: float, a1: float, duration: float) -> _Polynomial:
    """Return the quintic polynomial for position, velocity and acceleration at both ends."""
    distance, length = p1 - p0, duration
    return (
        p0,
        v0,
        0.5 * a0,
        (20.0 * distance - (8.0 * v1 + 12.0 * v0) * length - (3.0 * a0 - a1) * length**2) / (2.0 * length**3),
        ((14.0 * v1 + 16.0 * v0) * length - 30.0 * distance + (3.0 * a0 - 2.0 * a1) * length**2) / (2.0 * length**4),
        (12.0 * distance - 6.0 * (v1 + v0) * length - (a0 - a1) * length**2) / (2.0 * length**5),
    )
