"""The forces of water on a link that moves in it: damping, added mass, and the Coriolis forces of the added mass.

Forces of added mass that follow the measured acceleration are unstable for bodies lighter than the water that they
move. Here, the acceleration in which added mass and damping would result is computed first, and gives the forces.

Source: T. I. Fossen, *Guidance and Control of Ocean Vehicles*, 1994, 2.4.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array, rotation_matrix
from linkwright.geometry.single import add_vectors, cross
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.simulation.simulation import Simulation


class BodyInWater:
    """A link that moves in water.

    Args:
        simulation: the simulation of the world.
        link: the full name of the link.

    Attributes:
        link: the full name of the link.
        added_mass: the added mass and inertia, shape (6, 6), zero at first.
        linear: the resistance per velocity, shape (6, 6), zero at first.
        quadratic: the resistance per product of two velocities, shape (6, 6, 6), zero at first.
        absolute: the resistance per product of a velocity and the magnitude of another one, shape (6, 6, 6), zero at
            first.
        has_coriolis: whether the Coriolis forces of the added mass act.
    """

    def __init__(self, simulation: Simulation, link: str) -> None:
        self.link = link
        self.added_mass: Array = np.zeros((6, 6))
        self.linear: Array = np.zeros((6, 6))
        self.quadratic: Array = np.zeros((6, 6, 6))
        self.absolute: Array = np.zeros((6, 6, 6))
        self.has_coriolis = True
        self._simulation, self._revision = simulation, -1
        self.reset()
        simulation.keep_awake(link)

    def reset(self) -> None:
        """Forget the last velocity and forces."""
        self._previous: tuple[Array, Array] | None = None

    def compute_forces(self, current: Array) -> tuple[Array, Array, Array]:
        """Return the force in N, the torque in N m, and the point in m at which they act, in world axes.

        Args:
            current: the velocity of the water in m/s, in world axes, shape (3,).
        """
        simulation = self._simulation
        seconds, body = simulation.step / NANOSECONDS_PER_SECOND, simulation.body(self.link)
        if self._revision != simulation.revision:
            self._revision, self._inertia = simulation.revision, _compute_spatial_inertia(simulation.model, body)
        rotation = simulation.data.xmat[body].reshape(3, 3)
        linear, angular = simulation.link_velocity(self.link)
        velocity = np.concatenate([(linear - current) @ rotation, angular @ rotation])
        damping = self.linear + self.absolute @ np.abs(velocity) + self.quadratic @ velocity
        other_forces = np.zeros(6)
        if self._previous is not None:
            previous_velocity, previous_forces = self._previous
            other_forces = self._inertia @ (velocity - previous_velocity) / seconds - previous_forces
        resistance = damping @ velocity
        if self.has_coriolis:
            resistance += self._compute_coriolis_forces(velocity)
        implicit_inertia = self.added_mass + damping * seconds
        acceleration = np.linalg.solve(self._inertia + implicit_inertia, other_forces - resistance)
        forces: Array = -resistance - implicit_inertia @ acceleration
        self._previous = velocity, forces
        return rotation @ forces[:3], rotation @ forces[3:], simulation.data.xpos[body]

    def _compute_coriolis_forces(self, velocity: Array) -> Array:
        """Return the Coriolis and centripetal forces and torques of the added mass.

        gz computes them with the opposite sign.
        """
        px, py, pz, hx, hy, hz = (self.added_mass @ velocity).tolist()
        u, v, w, p, q, r = velocity.tolist()
        x, y, z = cross((p, q, r), (px, py, pz))
        k, m, n = add_vectors(cross((u, v, w), (px, py, pz)), cross((p, q, r), (hx, hy, hz)))
        return np.array((x, y, z, k, m, n))


def _compute_spatial_inertia(model: Any, body: int) -> Array:
    """Return a body's spatial inertia about its origin, in its axes, shape (6, 6)."""
    mass, (x, y, z) = float(model.body_mass[body]), model.body_ipos[body].tolist()
    qw, qx, qy, qz = model.body_iquat[body].tolist()
    axes = rotation_matrix((qx, qy, qz, qw))
    offset = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    inertia = np.zeros((6, 6))
    inertia[:3, :3] = mass * np.eye(3)
    inertia[:3, 3:], inertia[3:, :3] = -mass * offset, mass * offset
    inertia[3:, 3:] = axes @ np.diag(model.body_inertia[body]) @ axes.T - mass * offset @ offset
    return inertia
