"""The motion of a compliant arm: each axis of a control frame is a mass with a spring and a damper.

    M a + D v + K x = F

The displacement x of the force-torque sensor from its reference follows from the measured wrench F; the matrices are
diagonal in the control frame. Source: admittance_controller of ros2_controllers (equations, the damping of the joints,
gravity compensation) and kinematics_interface_kdl (the damped inverse of the Jacobian).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import atan2

import numpy as np

from linkwright.geometry.arrays import Array, quaternion_from_matrix
from linkwright.kinematics.chain import ChainConfiguration, KinematicChain


@dataclass(frozen=True)
class AdmittanceSettings:
    """The frames and constants of the equation.

    Attributes:
        sensor_frame: the link of the force-torque sensor, whose displacement is x.
        control_frame: the link whose axes the constants refer to.
        world_frame: the link in which gravity acts along -z.
        gravity_frame: the link in which the center of gravity is given.
        center_of_gravity: the center of gravity of the tool, shape (3,), in m.
        weight: the weight of the tool, in N.
        filter_coefficient: the weight of the newest wrench in the exponential filter, from 0 to 1.
        selected_axes: 1 for each axis with a force, otherwise 0, shape (6,).
        mass: the masses and moments of inertia, shape (6,), in kg and kg m².
        stiffness: the stiffness, shape (6,), in N/m and Nm/rad.
        damping: the damping, shape (6,), in N s/m and Nm s/rad.
        joint_damping: the damping of the joint velocities, in 1/s.
        alpha: the damping of the inverse of the Jacobian.
    """

    sensor_frame: str
    control_frame: str
    world_frame: str
    gravity_frame: str
    center_of_gravity: Array
    weight: float
    filter_coefficient: float
    selected_axes: Array
    mass: Array
    stiffness: Array
    damping: Array
    joint_damping: float
    alpha: float


@dataclass
class AdmittanceState:
    """The state of the equation in the base of the chain.

    Attributes:
        positions: the displacements of the joints from their references, shape (joints,).
        velocities: the velocities of these displacements, shape (joints,).
        accelerations: their accelerations, shape (joints,).
        wrench: the filtered wrench without gravity, shape (6,).
        displacement: the translation and rotation vector of the sensor from its reference, shape (6,).
        rotation: the rotation of this displacement, shape (3, 3).
        velocity: the velocity of the sensor that the displacements cause, shape (6,).
        acceleration: the acceleration that they cause, shape (6,).
        reference_frame: the frame of the sensor at the references, shape (4, 4).
        control_rotation: the rotation of the control frame, shape (3, 3).
    """

    positions: Array
    velocities: Array
    accelerations: Array
    wrench: Array = field(default_factory=lambda: np.zeros(6))
    displacement: Array = field(default_factory=lambda: np.zeros(6))
    rotation: Array = field(default_factory=lambda: np.eye(3))
    velocity: Array = field(default_factory=lambda: np.zeros(6))
    acceleration: Array = field(default_factory=lambda: np.zeros(6))
    reference_frame: Array = field(default_factory=lambda: np.eye(4))
    control_rotation: Array = field(default_factory=lambda: np.eye(3))


class Admittance:
    """The motion of an arm with compliance.

    Args:
        chain: the chain of the arm.

    Attributes:
        state: the current state.
    """

    def __init__(self, chain: KinematicChain) -> None:
        self._chain = chain
        self.reset()

    def reset(self) -> None:
        """Return to the references without velocity, and forget the wrench."""
        count = len(self._chain.joint_names)
        self.state = AdmittanceState(np.zeros(count), np.zeros(count), np.zeros(count))
        self._world_wrench = np.zeros(6)

    def step(
        self, settings: AdmittanceSettings, wrench: Array, positions: Array, references: Array, period_s: float
    ) -> None:
        """Advance the state by a period.

        Args:
            settings: the constants of the equation.
            wrench: the force and torque in the frame of the sensor, shape (6,), in N and Nm.
            positions: the measured positions of the joints of the chain, shape (joints,).
            references: their references, shape (joints,).
            period_s: the period, in s.
        """
        state, current = self.state, self._chain.configure(positions)
        sensor_frame = current.link_frame(settings.sensor_frame)
        state.reference_frame = self._chain.configure(references).link_frame(settings.sensor_frame)
        state.control_rotation = current.link_frame(settings.control_frame)[:3, :3]
        state.wrench = self._filter_wrench(settings, wrench, current)
        state.rotation = sensor_frame[:3, :3] @ state.reference_frame[:3, :3].T
        state.displacement = np.concatenate(
            (sensor_frame[:3, 3] - state.reference_frame[:3, 3], _rotation_vector(state.rotation))
        )
        to_base = np.kron(np.eye(2), state.control_rotation)
        force = settings.selected_axes * (to_base.T @ state.wrench)
        force -= settings.damping * (to_base.T @ state.velocity) + settings.stiffness * (to_base.T @ state.displacement)
        jacobian = current.jacobian(settings.sensor_frame)
        state.accelerations = _solve(jacobian, to_base @ (force / settings.mass), settings.alpha)
        state.accelerations -= settings.joint_damping * state.velocities
        state.velocities = state.velocities + state.accelerations * period_s
        state.positions = state.positions + state.velocities * period_s
        state.velocity = jacobian @ state.velocities
        state.acceleration = jacobian @ state.accelerations

    def _filter_wrench(self, settings: AdmittanceSettings, wrench: Array, current: ChainConfiguration) -> Array:
        """Return the filtered wrench in the base, without the weight of the tool."""
        to_world = current.link_frame(settings.world_frame)[:3, :3].T
        sensor_to_world = to_world @ current.link_frame(settings.sensor_frame)[:3, :3]
        gravity_to_world = to_world @ current.link_frame(settings.gravity_frame)[:3, :3]
        weight = np.array([0.0, 0.0, -settings.weight])
        force = sensor_to_world @ wrench[:3] - weight
        torque = sensor_to_world @ wrench[3:] - np.cross(gravity_to_world @ settings.center_of_gravity, weight)
        newest = np.concatenate((force, torque))
        self._world_wrench = self._world_wrench + settings.filter_coefficient * (newest - self._world_wrench)
        return np.concatenate((to_world.T @ self._world_wrench[:3], to_world.T @ self._world_wrench[3:]))


def _solve(jacobian: Array, twist: Array, alpha: float) -> Array:
    """Return the joint rates that cause a twist, by damped least squares."""
    square = jacobian.T @ jacobian + alpha * np.eye(jacobian.shape[1])
    rates: Array = np.asarray(np.linalg.solve(square, jacobian.T @ twist), dtype=np.float64)
    return rates


def _rotation_vector(matrix: Array) -> Array:
    """Return the axis of a rotation times its angle."""
    quaternion = quaternion_from_matrix(matrix)
    sine = float(np.linalg.norm(quaternion[:3]))
    if sine < 1e-12:
        return np.zeros(3)
    vector: Array = quaternion[:3] * (2.0 * atan2(sine, quaternion[3]) / sine)
    return vector
