"""Force-torque sensors in joints."""

from __future__ import annotations

import numpy as np

from linkwright.geometry.arrays import Array, quaternion_inverse, rotate
from linkwright.geometry.single import IDENTITY, Transform, compose, invert
from linkwright.sdf.sensors import ForceTorque
from linkwright.simulation.sensors.mount import update_accelerations
from linkwright.simulation.sensors.noise import VectorNoise
from linkwright.simulation.simulation import Simulation


class ForceTorqueSensor:
    """A sensor for the force and torque between a joint's links, at the joint's origin.

    Args:
        simulation: the simulation of the world.
        joint: the name of the joint in the world; the joint may be fixed.
        sensor: the parsed sensor; None for SDF's defaults.
        offset: the pose of the sensor in the frame of the joint.
        generator: the source of the noise.

    Raises:
        KeyError: there is no such joint.
    """

    def __init__(
        self,
        simulation: Simulation,
        joint: str,
        sensor: ForceTorque | None,
        generator: np.random.Generator,
        offset: Transform = IDENTITY,
    ) -> None:
        self._simulation = simulation
        self._settings = sensor or ForceTorque()
        self._force_noise = VectorNoise(self._settings.force, generator)
        self._torque_noise = VectorNoise(self._settings.torque, generator)
        self._joint = simulation.scene.joints[joint]
        structure = simulation.scene.models[joint.partition("::")[0]].structure
        child_pose = next(
            tree_link.link.pose for tree_link in structure.links if tree_link.link.name == self._joint.child
        )
        self._joint_in_child = compose(invert(child_pose), self._joint.pose)
        self._offset = offset

    def measure(self) -> tuple[Array, Array]:
        """Return the force in N and the torque in N m, in the configured measurement frame.

        With ``parent_to_child``, the parent exerts the force and torque on the child; otherwise the child exerts them
        on the parent.

        Raises:
            KeyError: the links no longer exist.
        """
        simulation = self._simulation
        update_accelerations(simulation)
        data, body = simulation.data, int(simulation.model.body(self._joint.child).id)
        joint = compose(simulation.link_pose(self._joint.child), self._joint_in_child)
        wrench, reference_point = data.cfrc_int[body], data.subtree_com[simulation.model.body_rootid[body]]
        force = np.array(wrench[3:])
        torque = np.array(wrench[:3]) - np.cross(np.subtract(joint[:3], reference_point), force)
        if self._settings.measure_direction != "parent_to_child":
            force, torque = -force, -torque
        to_frame = quaternion_inverse(np.array(self._compute_measurement_orientation(joint)))
        return self._force_noise.apply(rotate(to_frame, force)), self._torque_noise.apply(rotate(to_frame, torque))

    def _compute_measurement_orientation(self, joint: Transform) -> tuple[float, ...]:
        """Return the orientation in the world of the configured measurement frame, as a quaternion.

        `joint` is the current pose of the joint.
        """
        if self._settings.frame == "parent":
            parent = self._joint.parent
            return (0.0, 0.0, 0.0, 1.0) if parent == "world" else self._simulation.link_pose(parent)[3:]
        if self._settings.frame == "sensor":
            return compose(joint, self._offset)[3:]
        return self._simulation.link_pose(self._joint.child)[3:]
