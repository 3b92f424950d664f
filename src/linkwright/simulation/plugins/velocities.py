"""Initial and random velocities: ``libInitialVelocityPlugin.so`` and ``libRandomVelocityPlugin.so``.

Source: Gazebo Classic (parameters, defaults, formulas).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

import numpy as np

from linkwright.diagnostics import phrase
from linkwright.geometry.arrays import Array
from linkwright.geometry.single import Vector3
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.planar_move import PlanarDrive

_AXES = ("x", "y", "z")


@dataclass(frozen=True, kw_only=True)
class InitialVelocityParameters:
    """Parameters of ``libInitialVelocityPlugin.so``: velocities in the axes of the world."""

    linear: Vector3 | None = None
    angular: Vector3 | None = None


class InitialVelocity(PlanarDrive[InitialVelocityParameters]):
    """The substitute for ``libInitialVelocityPlugin.so``: sets the velocity of the model once, and after a reset."""

    PARAMETERS = InitialVelocityParameters

    def start(self) -> None:
        """Set the velocity.

        Raises:
            LinkwrightError: SIM160, the model is fixed to the world.
        """
        self.require_free_model()
        self.reset()

    def reset(self) -> None:
        """Set the velocity again."""
        parameters = self.parameters
        linear, angular = (_to_vector(velocity) for velocity in self.simulation.link_velocity(self.first_link))
        self.simulation.set_model_velocity(
            self.context.path, parameters.linear or linear, parameters.angular or angular
        )


@dataclass(frozen=True, kw_only=True)
class RandomVelocityParameters:
    """Parameters of ``libRandomVelocityPlugin.so``: velocities in m/s in the axes of the world, the period in s."""

    link: str = parameter()
    initial_velocity: Vector3 = (0.0, 0.0, 0.0)
    velocity_factor: float = 1.0
    update_period: float = 10.0
    min_x: float = -inf
    max_x: float = inf
    min_y: float = -inf
    max_y: float = inf
    min_z: float = -inf
    max_z: float = inf


class RandomVelocity(PlanarDrive[RandomVelocityParameters]):
    """The substitute for ``libRandomVelocityPlugin.so``: moves a model in a direction that changes at random.

    The velocity is set after each step, so gravity and obstacles hardly act. The model keeps its turning rates.
    """

    PARAMETERS = RandomVelocityParameters
    CARRIED = ("_velocity", "_last_change")

    def start(self) -> None:
        """Find the link.

        Raises:
            LinkwrightError: SIM133, there is no such link; SIM160, it is not the first link of a model that moves
                freely.
        """
        self.require_free_model()
        if self.link(self.parameters.link) != self.first_link:
            raise self.parameter_error(
                phrase(
                    "plugin '{plugin}': <link> must be the first link of the model, because the other links follow it",
                    plugin=self.context.name,
                )
            )
        parameters = self.parameters
        limits = [(getattr(parameters, f"min_{axis}"), getattr(parameters, f"max_{axis}")) for axis in _AXES]
        self._lower, self._upper = ([limit(pair) for pair in limits] for limit in (min, max))
        self.reset()
        self.every(0.0, self._move)

    def reset(self) -> None:
        """Restore the initial velocity, and restart the random numbers."""
        self._generator = self.random
        self._velocity = self.parameters.initial_velocity
        self._last_change = self.simulation.time

    def _move(self) -> None:
        period = self.parameters.update_period * NANOSECONDS_PER_SECOND
        if self.simulation.time - self._last_change > period:
            self._last_change = self.simulation.time
            self._velocity = self._draw_velocity()
        angular = _to_vector(self.simulation.link_velocity(self.first_link)[1])
        self.simulation.set_model_velocity(self.context.path, self._velocity, angular)

    def _draw_velocity(self) -> Vector3:
        """Return a velocity in a random direction, clipped to the limits."""
        direction = self._generator.uniform(-1.0, 1.0, 3)
        velocity = direction / np.linalg.norm(direction) * self.parameters.velocity_factor
        return _to_vector(np.clip(velocity, self._lower, self._upper))


def _to_vector(values: Array) -> Vector3:
    x, y, z = values.tolist()
    return x, y, z
