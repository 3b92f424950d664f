"""The mount of a sensor on a link, and tables with a value for each geom."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.geometry.single import IDENTITY, Transform, Vector3, add_vectors, compose, cross, rotate
from linkwright.sdf.links import Collision, Visual
from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.simulation import Simulation


@dataclass(frozen=True, slots=True)
class Mount:
    """The mount of a sensor on a link, with the pose and motion of the sensor.

    Attributes:
        simulation: the simulation of the world.
        link: the name of the link in the world, such as ``robot::laser_link``.
        offset: the pose of the sensor in the frame of the link.
    """

    simulation: Simulation
    link: str
    offset: Transform = IDENTITY

    def __post_init__(self) -> None:
        self.simulation.keep_awake(self.link)

    @property
    def model(self) -> str:
        """The name of the model that contains the link."""
        return self.link.partition(SEPARATOR)[0]

    @property
    def body(self) -> int:
        """The index of the link's body in MuJoCo's current model."""
        return self.simulation.body(self.link)

    def pose(self) -> Transform:
        """Return the pose of the sensor in the world.

        Raises:
            KeyError: the link no longer exists.
        """
        pose = self.simulation.link_pose(self.link)
        return pose if self.offset == IDENTITY else compose(pose, self.offset)

    def velocity(self) -> tuple[Vector3, Vector3]:
        """Return the linear velocity in m/s and the angular velocity in rad/s of the sensor.

        Both are in world axes.
        """
        linear, angular = self.simulation.link_velocity(self.link)
        rates = _to_vector(angular)
        if self._is_at_origin:
            return _to_vector(linear), rates
        return add_vectors(_to_vector(linear), cross(rates, self._compute_arm())), rates

    @property
    def _is_at_origin(self) -> bool:
        """Whether the sensor is at the origin of its link."""
        return self.offset[:3] == IDENTITY[:3]

    def _compute_arm(self) -> Vector3:
        """Return the vector from the origin of the link to the sensor, in m and in world axes."""
        return rotate(self.simulation.link_pose(self.link)[3:], self.offset[:3])

    def measure_inertial_motion(self) -> tuple[Vector3, Vector3]:
        """Return the angular velocity and the proper acceleration of the sensor.

        Both are in world axes, in rad/s and m/s2.

        At rest, the proper acceleration is the opposite of gravity and points upwards.
        """
        update_accelerations(self.simulation)
        simulation, mujoco, acceleration = self.simulation, load_mujoco(), np.zeros(6)
        kind = mujoco.mjtObj.mjOBJ_XBODY
        mujoco.mj_objectAcceleration(simulation.model, simulation.data, kind, self.body, acceleration, 0)
        angular = _to_vector(simulation.link_velocity(self.link)[1])
        p, q, r, x, y, z = acceleration.tolist()
        if self._is_at_origin:
            return angular, (x, y, z)
        arm = self._compute_arm()
        return angular, add_vectors(add_vectors((x, y, z), cross((p, q, r), arm)), cross(angular, cross(angular, arm)))


def _to_vector(values: Array) -> Vector3:
    x, y, z = values.tolist()
    return x, y, z


def update_accelerations(simulation: Simulation) -> None:
    """Update the accelerations of all bodies and the forces between them in MuJoCo's data."""
    simulation.refresh()
    load_mujoco().mj_rnePostConstraint(simulation.model, simulation.data)


def get_part_name(geom: str) -> str:
    """Return the name of the visual or collision to which a MuJoCo geom belongs.

    The name is the beginning of the geom's name, such as ``robot::base_link::lid#visual``.
    """
    name, separator, kind = geom.partition("#")
    return name + separator + kind.partition("#")[0]


def find_visuals_and_collisions(simulation: Simulation) -> Iterator[tuple[str, Visual | Collision]]:
    """Yield the visuals and collisions of all models, named as by `get_part_name`."""
    for model in simulation.scene.models.values():
        for tree_link in model.structure.links:
            link = tree_link.link
            for visual in link.link.visuals:
                yield f"{link.name}{SEPARATOR}{visual.name}#visual", visual
            for collision in link.link.collisions:
                yield f"{link.name}{SEPARATOR}{collision.name}#collision", collision


class GeomTable:
    """A table with a value for each geom of MuJoCo's model, updated when the model is rebuilt.

    Args:
        simulation: the simulation of the world.
        compute_values: a function that returns the values for a list of geom names, in the order of the names.
    """

    def __init__(self, simulation: Simulation, compute_values: Any) -> None:
        self._simulation = simulation
        self._values = compute_values
        self._revision = -1
        self._array: Array = np.zeros(0)

    def array(self) -> Array:
        """Return the values by geom index, shape (geoms + 1,).

        The last value is 0, because the index -1 means that there is no geom.
        """
        self._simulation.refresh()
        if self._revision != self._simulation.revision:
            model = self._simulation.model
            names = [model.geom(index).name for index in range(model.ngeom)]
            self._array = np.array([*self._values(names), 0.0])
            self._revision = self._simulation.revision
        return self._array
