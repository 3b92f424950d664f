"""Forces of water on a moving body: ``gz-sim-hydrodynamics-system``.

The system applies the damping, the added mass and the Coriolis forces of the added mass to a link, from the derivatives
in the notation of SNAME: ``xDotU`` is the force along x for each m/s2 along x, ``xU`` the force for each m/s, and
``xUabsU`` the force for each (m/s)2. Forces have the sign of the derivative, so those of a real body are negative.

Forces of added mass that follow the measured acceleration are unstable for bodies lighter than the water that they
move. Here, the acceleration in which added mass and damping would result is computed first, and gives the forces.

Source: gz-sim (parameters, topics, defaults); T. I. Fossen, *Guidance and Control of Ocean Vehicles*, 1994, 2.4.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

import numpy as np

from linkwright.geometry.arrays import Array, rotation_matrix
from linkwright.geometry.single import Vector3, add_vectors, cross
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.simulation.plugins.entities import vector_components
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin

P = TypeVar("P")

_FORCES, _VELOCITIES = "xyzkmn", "UVWPQR"
"""The letters of SNAME for forces and torques, and for linear and angular velocities, each along x, y and z."""


def _list_derivative_names() -> Iterator[str]:
    """Yield the names of all derivatives."""
    for force in _FORCES:
        for first in _VELOCITIES:
            yield f"{force}Dot{first}"
            yield f"{force}{first}"
            for second in _VELOCITIES:
                yield f"{force}{first}abs{second}"
                yield f"{force}{first}{second}"


@dataclass(frozen=True, kw_only=True)
class HydrodynamicsParameters:
    """Parameters of ``gz-sim-hydrodynamics-system``."""

    link_name: str = parameter()
    namespace: str = ""
    default_current: Vector3 = (0.0, 0.0, 0.0)
    disable_added_mass: bool = False
    disable_coriolis: bool = False


class Hydrodynamics(SimulatedPlugin[P], ABC, Generic[P]):
    """A plugin that applies damping, added mass and its Coriolis forces to a link.

    Subclasses set the attributes in `start`, and then call `start_forces`.

    Attributes:
        link_name: the full name of the link.
        added_mass: the added mass and inertia, shape (6, 6); all entries of real bodies are positive on the diagonal.
        linear: the force per velocity, shape (6, 6).
        quadratic: the force per product of two velocities, shape (6, 6, 6).
        absolute: the force per product of a velocity and the magnitude of another one, shape (6, 6, 6).
        has_coriolis: whether the Coriolis forces of the added mass act.
        current: the velocity of the water in m/s, in world axes, shape (3,).
    """

    CARRIED = ("current",)

    link_name: str
    current: Array
    has_coriolis = True

    def start_forces(self, link_name: str) -> None:
        """Apply the forces to a link, named without the model, after every step.

        Raises:
            LinkwrightError: SIM133, there is no such link.
        """
        self.link_name = self.link(link_name)
        self.added_mass, self.linear = np.zeros((6, 6)), np.zeros((6, 6))
        self.quadratic, self.absolute = np.zeros((6, 6, 6)), np.zeros((6, 6, 6))
        self.read_derivatives()
        self._revision = -1
        self.reset()
        self.simulation.keep_awake(self.link_name)
        self.every(0.0, self._apply_forces)
        self._apply_forces()

    @abstractmethod
    def read_derivatives(self) -> None:
        """Set the entries of the added mass and of the damping, which are zero.

        Raises:
            LinkwrightError: SIM160, a derivative is not a number.
        """

    def reset(self) -> None:
        """Restore still water."""
        self.current = np.zeros(3)
        self._previous: tuple[Array, Array] | None = None

    def _apply_forces(self) -> None:
        simulation, seconds = self.simulation, self.simulation.step / NANOSECONDS_PER_SECOND
        body = simulation.body(self.link_name)
        if self._revision != simulation.revision:
            self._revision, self._inertia = simulation.revision, _compute_spatial_inertia(simulation.model, body)
        rotation = simulation.data.xmat[body].reshape(3, 3)
        linear, angular = simulation.link_velocity(self.link_name)
        velocity = np.concatenate([(linear - self.current) @ rotation, angular @ rotation])
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
        self.push(self.link_name, rotation @ forces[:3], rotation @ forces[3:], at=simulation.data.xpos[body])

    def _compute_coriolis_forces(self, velocity: Array) -> Array:
        """Return the Coriolis and centripetal forces and torques of the added mass.

        gz computes them with the opposite sign.
        """
        px, py, pz, hx, hy, hz = (self.added_mass @ velocity).tolist()
        u, v, w, p, q, r = velocity.tolist()
        x, y, z = cross((p, q, r), (px, py, pz))
        k, m, n = add_vectors(cross((u, v, w), (px, py, pz)), cross((p, q, r), (hx, hy, hz)))
        return np.array((x, y, z, k, m, n))


class GzHydrodynamics(Hydrodynamics[HydrodynamicsParameters]):
    """The substitute for ``gz-sim-hydrodynamics-system``."""

    PARAMETERS = HydrodynamicsParameters
    IGNORED = (
        "water_density",  # has no effect in gz either
        *_list_derivative_names(),  # read by read_derivatives
    )

    def start(self) -> None:
        """Find the link, read the derivatives, and subscribe to the current of the water.

        Raises:
            LinkwrightError: SIM133, there is no such link; SIM160, a derivative is not a number.
        """
        parameters = self.parameters
        self.has_coriolis = not parameters.disable_coriolis
        self.start_forces(parameters.link_name)
        namespace = parameters.namespace
        topic = f"/model/{namespace}/ocean_current" if namespace else "/ocean_current"
        self.node.subscribe("geometry_msgs/msg/Vector3", topic, self._on_current)

    def reset(self) -> None:
        """Restore the default current."""
        super().reset()
        self.current = np.array(self.parameters.default_current)

    def read_derivatives(self) -> None:
        """Read the derivatives, whose sign is that of the force."""
        element = self.context.element
        for row, force in enumerate(_FORCES):
            for column, first in enumerate(_VELOCITIES):
                self.added_mass[row, column] = -self.number_in(element, f"{force}Dot{first}", 0.0)
                self.linear[row, column] = -self.number_in(element, f"{force}{first}", 0.0)
                for depth, second in enumerate(_VELOCITIES):
                    self.absolute[row, column, depth] = -self.number_in(element, f"{force}{first}abs{second}", 0.0)
                    self.quadratic[row, column, depth] = -self.number_in(element, f"{force}{first}{second}", 0.0)
        if self.parameters.disable_added_mass:
            self.added_mass[:] = 0.0

    def _on_current(self, message: Any) -> None:
        self.current = np.array(vector_components(message))


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
