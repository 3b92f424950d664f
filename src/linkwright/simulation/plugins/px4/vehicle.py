"""Vehicles under water of PX4: ``libgazebo_uuv_plugin.so``.

Each ``<buoyancy>`` lifts a link at a point, with its weight times a factor; the force falls from all to nothing while
the point rises through a layer at the surface z = 0. The base is slowed in proportion to its velocity, and the added
mass couples its motions (Coriolis).

Source: PX4-SITL_gazebo-classic (parameters, defaults, formulas); T. I. Fossen, *Handbook of Marine Craft Hydrodynamics
and Motion Control*, 2011, section 6.3. The inertia of the added mass is left out, as there.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from linkwright.diagnostics import phrase
from linkwright.geometry.arrays import Array
from linkwright.geometry.single import Vector3
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.xmltree import Element

_ZERO = (0.0, 0.0, 0.0)


@dataclass(frozen=True, kw_only=True)
class Px4VehicleParameters:
    """Parameters of ``libgazebo_uuv_plugin.so``: coefficients for the axes of the base link."""

    base_link_name: str = parameter(aliases=("baseLinkName",))
    added_mass_linear: Vector3 = parameter(_ZERO, aliases=("addedMassLinear",))
    added_mass_angular: Vector3 = parameter(_ZERO, aliases=("addedMassAngular",))
    damping_linear: Vector3 = parameter(_ZERO, aliases=("dampingLinear",))
    damping_angular: Vector3 = parameter(_ZERO, aliases=("dampingAngular",))


@dataclass(frozen=True, slots=True)
class _Float:
    """A point at which the water lifts a link.

    Attributes:
        link: the full name of the link.
        origin: the point in the frame of the link in m, shape (3,).
        factor: the force as a multiple of the weight of the link.
        layer: half the height in m of the layer in which the force falls.
    """

    link: str
    origin: Array
    factor: float
    layer: float


class Px4Vehicle(SimulatedPlugin[Px4VehicleParameters]):
    """The substitute for ``libgazebo_uuv_plugin.so``."""

    PARAMETERS = Px4VehicleParameters
    IGNORED = ("buoyancy",)

    def start(self) -> None:
        """Find the links.

        Raises:
            LinkwrightError: SIM133, there is no such link; SIM160, a buoyancy is not valid.
        """
        element = self.context.element
        self._base = self.link(self.parameters.base_link_name)
        self._floats = [self._read_float(child) for child in (() if element is None else element.elements("buoyancy"))]
        for link in {self._base, *(point.link for point in self._floats)}:
            self.simulation.keep_awake(link)
        self.every(0.0, self._push_links)

    def _read_float(self, element: Element) -> _Float:
        words = (self.text_in(element, "origin") or "0 0 0").split()[:3]
        try:
            x, y, z = (float(word) for word in words)
        except ValueError as error:
            message = phrase("plugin '{plugin}': <origin> needs three numbers", plugin=self.context.name)
            raise self.parameter_error(message, element) from error
        return _Float(
            self.link(self.text_in(element, "link_name")),
            np.array((x, y, z)),
            self.number_in(element, "compensation", 0.0),
            abs(self.number_in(element, "height_scale_limit", 0.1)),
        )

    def _push_links(self) -> None:
        simulation = self.simulation
        simulation.refresh()
        forces: dict[str, tuple[Array, Array]] = {}
        for point in self._floats:
            body, data = simulation.body(point.link), simulation.data
            position = data.xpos[body] + data.xmat[body].reshape(3, 3) @ point.origin
            weight = float(simulation.model.body_mass[body]) * np.array(simulation.model.opt.gravity)
            force = -point.factor * _compute_share(float(position[2]), point.layer) * weight
            old_force, old_torque = forces.get(point.link, (np.zeros(3), np.zeros(3)))
            forces[point.link] = old_force + force, old_torque + np.cross(position - data.xipos[body], force)
        body, data = simulation.body(self._base), simulation.data
        axes = data.xmat[body].reshape(3, 3)
        force, torque = self._compute_drag(axes)
        old_force, old_torque = forces.get(self._base, (np.zeros(3), np.zeros(3)))
        forces[self._base] = old_force + axes @ force, old_torque + axes @ torque
        for link, (force, torque) in forces.items():
            self.push(link, force, torque)

    def _compute_drag(self, axes: Array) -> tuple[Array, Array]:
        """Return the force and the torque of damping and added mass on the base, in its axes."""
        parameters = self.parameters
        linear, angular = (velocity @ axes for velocity in self.simulation.link_velocity(self._base))
        momentum = np.array(parameters.added_mass_linear) * linear
        spin = np.array(parameters.added_mass_angular) * angular
        force = -np.array(parameters.damping_linear) * linear - np.cross(momentum, angular)
        torque = -np.array(parameters.damping_angular) * angular - np.cross(momentum, linear) - np.cross(spin, angular)
        return force, torque


def _compute_share(height: float, layer: float) -> float:
    """Return the share of the lift at a height in m of the point over the surface."""
    if height > layer:
        return 0.0
    return min((layer - height) / (2.0 * layer), 1.0) if layer else 1.0
