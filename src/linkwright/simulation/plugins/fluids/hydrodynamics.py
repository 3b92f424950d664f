"""Forces of water on a moving body: ``gz-sim-hydrodynamics-system``.

The system applies the damping, the added mass and the Coriolis forces of the added mass to a link, from the derivatives
in the notation of SNAME: ``xDotU`` is the force along x for each m/s2 along x, ``xU`` the force for each m/s, and
``xUabsU`` the force for each (m/s)2. Forces have the sign of the derivative, so those of a real body are negative.

Source: gz-sim (parameters, topics, defaults).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.geometry.single import Vector3
from linkwright.simulation.plugins.entities import vector_components
from linkwright.simulation.plugins.fluids.body_in_water import BodyInWater
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
    """A plugin that applies the forces of water to a link.

    Attributes:
        body: the link, and the coefficients of the forces.
        current: the velocity of the water in m/s, in world axes, shape (3,).
    """

    CARRIED = ("current",)

    body: BodyInWater
    current: Array

    def start_forces(self, link_name: str) -> None:
        """Apply the forces to a link, named without the model, after every step.

        Raises:
            LinkwrightError: SIM133, there is no such link; SIM160, a derivative is not a number.
        """
        self.body = BodyInWater(self.simulation, self.link(link_name))
        self.read_derivatives()
        self.reset()
        self.every(0.0, self._apply_forces)
        self._apply_forces()

    @abstractmethod
    def read_derivatives(self) -> None:
        """Set the coefficients of the body.

        Raises:
            LinkwrightError: SIM160, a derivative is not a number.
        """

    def reset(self) -> None:
        """Restore still water."""
        self.current = np.zeros(3)
        self.body.reset()

    def _apply_forces(self) -> None:
        self.simulation.refresh()
        force, torque, point = self.body.compute_forces(self.current)
        self.push(self.body.link, force, torque, at=point)


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
        element, body = self.context.element, self.body
        for row, force in enumerate(_FORCES):
            for column, first in enumerate(_VELOCITIES):
                body.added_mass[row, column] = -self.number_in(element, f"{force}Dot{first}", 0.0)
                body.linear[row, column] = -self.number_in(element, f"{force}{first}", 0.0)
                for depth, second in enumerate(_VELOCITIES):
                    body.absolute[row, column, depth] = -self.number_in(element, f"{force}{first}abs{second}", 0.0)
                    body.quadratic[row, column, depth] = -self.number_in(element, f"{force}{first}{second}", 0.0)
        if self.parameters.disable_added_mass:
            body.added_mass[:] = 0.0
        body.has_coriolis = not self.parameters.disable_coriolis

    def _on_current(self, message: Any) -> None:
        self.current = np.array(vector_components(message))
