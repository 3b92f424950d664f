"""Wings, fins and blades: ``gz-sim-lift-drag-system`` and ``libLiftDragPlugin.so``.

Lift and drag act at the center of pressure of a link that moves through the air. They grow with the dynamic pressure
and the area, and with the angle of attack until the wing stalls. A control joint changes the lift, as a flap does.

Source: gz-sim and Gazebo Classic (parameters, defaults, formulas). As there, the moments ``cma`` and ``cma_stall``
have no effect.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import acos, pi

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.geometry.single import Vector3, add_vectors, cross, dot, length, scaled, subtract_vectors
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin

_MIN_SPEED = 0.01
"""The speed in m/s up to which the air exerts no forces."""


@dataclass(frozen=True, kw_only=True)
class LiftDragParameters:
    """Parameters of ``gz-sim-lift-drag-system`` and ``libLiftDragPlugin.so``."""

    link_name: str = parameter()
    air_density: float = 1.2041
    area: float = 1.0
    a0: float = 0.0
    cla: float = 1.0
    cda: float = 0.01
    alpha_stall: float = pi / 2
    cla_stall: float = 0.0
    cda_stall: float = 1.0
    cp: Vector3 = (0.0, 0.0, 0.0)
    forward: Vector3 = (1.0, 0.0, 0.0)
    upward: Vector3 = (0.0, 0.0, 1.0)
    radial_symmetry: bool = False
    control_joint_name: str = ""
    control_joint_rad_to_cl: float = 4.0


class LiftDrag(SimulatedPlugin[LiftDragParameters]):
    """The substitute for ``gz-sim-lift-drag-system`` and ``libLiftDragPlugin.so``."""

    PARAMETERS = LiftDragParameters
    IGNORED = ("cma", "cma_stall", "cm_delta")

    def start(self) -> None:
        """Find the link and the control joint.

        Raises:
            LinkwrightError: SIM133, SIM134, there is no such link or joint.
        """
        parameters = self.parameters
        self._link = self.link(parameters.link_name)
        self._control_joint = self.joint(parameters.control_joint_name) if parameters.control_joint_name else ""
        self._forward, self._upward = _normalize(parameters.forward), _normalize(parameters.upward)
        self.simulation.keep_awake(self._link)
        self.every(0.0, self._apply_forces)
        self._apply_forces()

    def _apply_forces(self) -> None:
        simulation = self.simulation
        body, data = simulation.body(self._link), simulation.data
        axes = data.xmat[body].tolist()
        offset = _to_world(axes, self.parameters.cp)
        linear, angular = (_to_tuple(velocity) for velocity in simulation.link_velocity(self._link))
        velocity = subtract_vectors(add_vectors(linear, cross(angular, offset)), simulation.wind)
        position = add_vectors(_to_tuple(data.xpos[body]), offset)
        self.push(self._link, self._compute_force(axes, velocity), at=np.array(position))

    def _compute_force(self, axes: list[float], velocity: Vector3) -> Vector3:
        """Return the force in N, in the axes of the world.

        Args:
            axes: the rotation matrix of the link, row by row.
            velocity: the velocity of the center of pressure relative to the air, in m/s and the axes of the world.
        """
        parameters = self.parameters
        forward = _to_world(axes, self._forward)
        if length(velocity) <= _MIN_SPEED or dot(forward, velocity) <= 0.0:
            return 0.0, 0.0, 0.0
        upward = _to_world(axes, self._upward)
        if parameters.radial_symmetry:
            upward = _normalize(cross(forward, cross(forward, velocity)))
        spanwise = _normalize(cross(forward, upward))
        sweep_factor = 1.0 - dot(spanwise, _normalize(velocity)) ** 2
        in_plane = subtract_vectors(velocity, scaled(spanwise, dot(velocity, spanwise)))
        lift_direction = _normalize(cross(spanwise, in_plane))
        angle = acos(min(max(dot(lift_direction, upward), -1.0), 1.0))
        angle_of_attack = parameters.a0 + (angle if dot(lift_direction, forward) >= 0.0 else -angle)
        angle_of_attack = (angle_of_attack + pi / 2) % pi - pi / 2
        lift, drag = (sweep_factor * coefficient for coefficient in self._compute_coefficients(angle_of_attack))
        if self._control_joint:
            lift += parameters.control_joint_rad_to_cl * self.simulation.joint_state(self._control_joint)[0]
        pressure = 0.5 * parameters.air_density * parameters.area * dot(in_plane, in_plane)
        return subtract_vectors(scaled(lift_direction, pressure * lift), scaled(_normalize(in_plane), pressure * drag))

    def _compute_coefficients(self, angle_of_attack: float) -> tuple[float, float]:
        """Return the coefficients of lift and drag for an angle of attack in rad."""
        parameters = self.parameters
        magnitude, sign = abs(angle_of_attack), 1.0 if angle_of_attack > 0.0 else -1.0
        before_stall, after_stall = min(magnitude, parameters.alpha_stall), max(magnitude - parameters.alpha_stall, 0.0)
        lift = parameters.cla * before_stall + parameters.cla_stall * after_stall
        drag = parameters.cda * before_stall + parameters.cda_stall * after_stall
        if after_stall > 0.0:
            lift = max(lift, 0.0)
        return sign * lift, abs(drag)


def _normalize(vector: Vector3) -> Vector3:
    """Return a vector of length 1, or the zero vector."""
    size = length(vector)
    return scaled(vector, 1.0 / size) if size else vector


def _to_world(axes: list[float], vector: Vector3) -> Vector3:
    """Return a vector of a link in the axes of the world, with the rotation matrix of the link row by row."""
    a, b, c, d, e, f, g, h, i = axes
    x, y, z = vector
    return a * x + b * y + c * z, d * x + e * y + f * z, g * x + h * y + i * z


def _to_tuple(values: Array) -> Vector3:
    x, y, z = values.tolist()
    return x, y, z
