"""Airplanes by their stability derivatives: ``gz-sim-advanced-lift-drag-system`` and ``libAdvancedLiftDragPlugin.so``.

One plugin computes the forces and moments on the whole airplane. A coefficient is a sum of products: derivatives times
the angle of attack, the angle of sideslip, the turning rates and the angles of the control surfaces. The names are
those of AVL: ``CD`` drag, ``CY`` side force, ``CL`` lift, and ``Cell``, ``Cem``, ``Cen`` moments about x, y and z,
followed by ``0`` constant, ``a`` angle of attack, ``b`` sideslip, and ``p``, ``q``, ``r`` rates of roll, pitch and yaw.

Source: gz-sim and PX4-SITL_gazebo-classic (parameters, defaults, formulas). gz-sim drops ``Cem0`` and ``Cema``; this is
one of the known mistakes of Gazebo.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, cos, degrees, exp, pi, sin, sqrt

import numpy as np

from linkwright.diagnostics import phrase
from linkwright.geometry.arrays import Array
from linkwright.geometry.single import Vector3
from linkwright.sdf.plugins import library_name
from linkwright.simulation.plugins.fluids.directions import normalize
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin

_COEFFICIENTS = ("CD", "CY", "CL", "Cell", "Cem", "Cen")
_DRAG, _LIFT, _PITCH = 0, 2, 4
_ANGLES = tuple(f"{name}{cause}" for cause in "ab" for name in _COEFFICIENTS if name != "CD")
_RATES = tuple(f"{name}{cause}" for cause in "pqr" for name in _COEFFICIENTS)
_DERIVATIVES = ("CD0", "CL0", "Cem0", *_ANGLES, *_RATES)
_LEAST_SPEED = 1e-9
"""The speed in m/s up to which the air exerts no forces."""
_STALL_SHARPNESS = 15.0
_FLAT_PLATE = (-0.224, -0.115)
"""The drag of a stalled wing, fitted to measurements: exponents for a wing and for its aspect ratio."""


@dataclass(frozen=True, kw_only=True)
class AdvancedLiftDragParameters:
    """Parameters of both plugins; the derivatives are read from the element."""

    link_name: str = parameter()
    air_density: float = 1.2041
    area: float = 1.0
    alpha_stall: float = pi / 2
    mac: float = 0.0
    eff: float = 0.0
    cp: Vector3 = parameter((0.0, 0.0, 0.0), aliases=("ref_pt",))
    forward: Vector3 = (1.0, 0.0, 0.0)
    upward: Vector3 = (0.0, 0.0, 1.0)


class AdvancedLiftDrag(SimulatedPlugin[AdvancedLiftDragParameters]):
    """The substitute for ``gz-sim-advanced-lift-drag-system`` and ``libAdvancedLiftDragPlugin.so``."""

    PARAMETERS = AdvancedLiftDragParameters
    IGNORED = (
        *_DERIVATIVES,
        *("AR", "Cema_stall", "num_ctrl_surfaces", "control_surface"),
        *("a0", "CLa_stall", "CDa_stall", "radial_symmetry", "control_joint_rad_to_cl", "topic_name", "windSubTopic"),
    )

    def start(self) -> None:
        """Read the derivatives, and find the link and the joints of the control surfaces.

        Raises:
            LinkwrightError: SIM133, SIM134, there is no such link or joint; SIM160, a derivative is not a number, or
                the aspect ratio is missing.
        """
        parameters, element = self.parameters, self.context.element
        values = {name: self.number_in(element, name, 0.0) for name in (*_DERIVATIVES, "AR", "Cema_stall")}
        self._aspect_ratio = values["AR"]
        if self._aspect_ratio <= 0.0 or parameters.eff <= 0.0 or parameters.area <= 0.0:
            message = phrase(
                "plugin '{plugin}': <AR>, <eff> and <area> must be positive, because the drag depends on them",
                plugin=self.context.name,
            )
            raise self.parameter_error(message)
        self._constant, self._by_alpha, self._by_beta = (
            np.array([values.get(f"{name}{cause}", 0.0) for name in _COEFFICIENTS]) for cause in "0ab"
        )
        self._by_rates = np.array([[values[f"{name}{cause}"] for cause in "pqr"] for name in _COEFFICIENTS])
        self._stalled_pitch = values["Cema_stall"]
        self._span = sqrt(parameters.area * self._aspect_ratio)
        self._chord = parameters.mac or parameters.area / self._span
        self._link = self.link(parameters.link_name)
        self._find_control_surfaces()
        self._forward, self._down = normalize(parameters.forward), -normalize(parameters.upward)
        plugin = self.context.plugin
        is_gz = plugin is not None and library_name(plugin.filename).startswith("gz-sim-")
        self._drops_pitch = self.gazebo_mistakes and is_gz
        self.simulation.keep_awake(self._link)
        self.every(0.0, self._apply_forces)
        self._apply_forces()

    def _find_control_surfaces(self) -> None:
        element = self.context.element
        surfaces = [] if element is None else list(element.elements("control_surface"))
        self._joints = [self.joint(self.text_in(surface, "name")) for surface in surfaces]
        self._by_controls = np.zeros((len(_COEFFICIENTS), len(surfaces)))
        for index, surface in enumerate(surfaces):
            derivatives = [self.number_in(surface, f"{name}_ctrl", 0.0) for name in _COEFFICIENTS]
            self._by_controls[:, index] = np.array(derivatives) * self.number_in(surface, "direction", 1.0)

    def _apply_forces(self) -> None:
        simulation = self.simulation
        body, data = simulation.body(self._link), simulation.data
        rotation = data.xmat[body].reshape(3, 3)
        offset = rotation @ np.array(self.parameters.cp)
        linear, angular = simulation.link_velocity(self._link)
        velocity = linear + np.cross(angular, offset) - np.array(simulation.wind)
        force, torque = self._compute_wrench(rotation, velocity, rotation.T @ angular)
        self.push(self._link, force, torque, at=data.xpos[body] + offset)

    def _compute_wrench(self, rotation: Array, velocity: Array, rates: Array) -> tuple[Array, Array]:
        """Return the force in N and the torque in N m, in the axes of the world.

        Args:
            rotation: the orientation of the link, shape (3, 3).
            velocity: the velocity of the reference point relative to the air, in m/s and the axes of the world.
            rates: the angular velocity of the link in rad/s, in the axes of the link.
        """
        forward, down = rotation @ self._forward, rotation @ self._down
        right = np.cross(down, forward)
        in_plane = velocity - velocity @ right * right
        speed = float(np.linalg.norm(in_plane))
        if speed <= _LEAST_SPEED:
            return np.zeros(3), np.zeros(3)
        direction = in_plane / speed
        alpha = atan2(float(direction @ down), float(direction @ forward))
        beta = atan2(float(velocity @ right), float(velocity @ forward))
        half_lengths = np.array((self._span, self._chord, self._span)) / 2
        turning = rates * (1.0, -1.0, -1.0) * half_lengths / speed
        coefficients = self._compute_coefficients(alpha, beta) + self._by_rates @ turning
        drag, side, lift, roll, pitch, yaw = (
            0.5 * self.parameters.air_density * speed**2 * self.parameters.area * coefficients
        )
        force = side * right - drag * direction - lift * np.cross(direction, right)
        torque = self._span * (roll * forward + yaw * down) + self._chord * pitch * right
        return force, torque

    def _compute_coefficients(self, alpha: float, beta: float) -> Array:
        """Return the coefficients without the effects of turning rates, shape (6,), for two angles in rad."""
        stall = self.parameters.alpha_stall
        coefficients = self._constant + self._by_alpha * alpha + self._by_beta * beta
        linear_range = min(max(alpha, -stall), stall)
        pitch = self._constant[_PITCH] + self._by_alpha[_PITCH] * linear_range
        pitch += self._stalled_pitch * (alpha - linear_range)
        coefficients[_PITCH] = self._by_beta[_PITCH] * beta + (0.0 if self._drops_pitch else pitch)
        stalled = _compute_stalled_share(alpha, stall)
        attached_lift = self._constant[_LIFT] + self._by_alpha[_LIFT] * alpha
        stalled_lift = 2.0 * np.sign(alpha) * sin(alpha) ** 2 * cos(alpha)
        coefficients[_LIFT] = (1.0 - stalled) * attached_lift + stalled * stalled_lift + self._by_beta[_LIFT] * beta
        angles = [degrees(self.simulation.joint_state(joint)[0]) for joint in self._joints]
        controls = self._by_controls @ np.array(angles)
        lift = coefficients[_LIFT] + controls[_LIFT]
        attached_drag = self._constant[_DRAG] + lift**2 / (pi * self._aspect_ratio * self.parameters.eff)
        longest = max(self._aspect_ratio, 1.0 / self._aspect_ratio)
        flat_plate = 2.0 / (1.0 + exp(_FLAT_PLATE[0] + _FLAT_PLATE[1] * longest))
        coefficients[_DRAG] = (1.0 - stalled) * attached_drag + stalled * flat_plate * sin(alpha) ** 2
        result: Array = coefficients + controls
        return result


def _compute_stalled_share(alpha: float, stall: float) -> float:
    """Return how much of the wing is stalled, from 0 to 1, for an angle of attack in rad."""
    above, below = exp(-_STALL_SHARPNESS * (alpha - stall)), exp(_STALL_SHARPNESS * (alpha + stall))
    return (1.0 + above + below) / ((1.0 + above) * (1.0 + below))
