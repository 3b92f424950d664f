"""The base class of drive controllers that follow velocity commands and publish odometry."""

from __future__ import annotations

from math import nan
from typing import Generic, TypeVar

from linkwright.control.controllers.controller import Controller
from linkwright.control.controllers.drive_odometry import DriveOdometry
from linkwright.control.controllers.velocity_input import VelocityInput

P = TypeVar("P")


class DriveController(Controller[P], Generic[P]):
    """The base class of drive controllers.

    `on_configure` of a subclass creates the attributes.

    Attributes:
        _input: the velocity commands.
        _odometry: the odometry, with its topics.
        _has_angles: whether the states of the wheels are positions instead of velocities.
    """

    _input: VelocityInput
    _odometry: DriveOdometry
    _has_angles = False

    def on_activate(self) -> None:
        """Reset the velocities to zero, and accept commands."""
        for reference in self.references:
            reference.value = nan
        self._odometry.odometer.reset_velocity()
        self._last_angles: list[float] | None = None
        self._input.open()

    def on_deactivate(self) -> None:
        """Stop the wheels."""
        self._input.close()
        for command in self.commands:
            command.value = 0.0

    def _compute_speeds(self, values: list[float], period_s: float) -> list[float] | None:
        """Return the velocities of the wheels in rad/s, computed from the values of their states.

        Returns None if the states are positions and no time has passed.
        """
        if not self._has_angles:
            return values
        last_angles, self._last_angles = self._last_angles or values, values
        if period_s <= 0.0:
            return None
        return [(angle - last_angle) / period_s for angle, last_angle in zip(values, last_angles, strict=True)]
