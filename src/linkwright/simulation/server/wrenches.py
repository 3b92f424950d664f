"""Forces and torques that act on links for a limited time (``gazebo_ros_force_system``)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from linkwright.geometry.arrays import Array, rotation_matrix
from linkwright.geometry.single import Vector3
from linkwright.simulation.simulation import Simulation


@dataclass(frozen=True, slots=True)
class Wrench:
    """A force and a torque on a link.

    Attributes:
        force: the force in N, in the axes of the world.
        torque: the torque in N m, in the axes of the world.
        point: the point of application of the force in m, in the frame of the link.
        start_ns: the simulated time in nanoseconds from which the wrench acts.
        end_ns: the simulated time in nanoseconds until which the wrench acts; None for no end.
    """

    force: Vector3
    torque: Vector3
    point: Vector3
    start_ns: int
    end_ns: int | None


class Wrenches:
    """The wrenches that act on links.

    The wrenches on a link add up.

    Args:
        simulation: the simulation of the world.
    """

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._wrenches: dict[str, list[Wrench]] = {}
        self._is_scheduled = False

    def add(self, link: str, wrench: Wrench) -> None:
        """Add a wrench on a link, to be applied from the next step on."""
        self._wrenches.setdefault(link, []).append(wrench)
        if not self._is_scheduled:
            self._is_scheduled = True
            self._simulation.call_every(0, self._apply_wrenches)
        self._apply_wrenches()

    def clear(self, link: str) -> None:
        """Remove all wrenches on a link."""
        if self._wrenches.pop(link, None) and link in self._simulation.scene.bodies:
            self._simulation.push(link, (0.0, 0.0, 0.0))

    def _apply_wrenches(self) -> None:
        now, simulation = self._simulation.time, self._simulation
        for link, wrenches in tuple(self._wrenches.items()):
            remaining = [wrench for wrench in wrenches if wrench.end_ns is None or now < wrench.end_ns]
            self._wrenches[link] = remaining
            if not remaining or link not in simulation.scene.bodies:
                del self._wrenches[link]
                if link in simulation.scene.bodies:
                    simulation.push(link, (0.0, 0.0, 0.0))
                continue
            force, torque = self._sum_wrenches(link, [wrench for wrench in remaining if wrench.start_ns <= now])
            simulation.push(link, force.tolist(), torque.tolist())

    def _sum_wrenches(self, link: str, wrenches: list[Wrench]) -> tuple[Array, Array]:
        """Return the total force in N, and the torque in N m about a link's center of mass."""
        pose = self._simulation.link_pose(link)
        rotation, mass_center = rotation_matrix(pose[3:]), self._simulation.data.body(link).xipos
        force, torque = np.zeros(3), np.zeros(3)
        for wrench in wrenches:
            arm = rotation @ np.asarray(wrench.point) + np.asarray(pose[:3]) - mass_center
            force += wrench.force
            torque += np.asarray(wrench.torque) + np.cross(arm, wrench.force)
        return force, torque
