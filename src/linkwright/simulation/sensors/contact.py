"""Contact sensors: pairs of collisions, with positions, normals, depths and forces."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.sensors.mount import GeomTable, Mount, get_part_name

_COLLISION_MARK = "#collision"


@dataclass(frozen=True, slots=True)
class Contact:
    """A contact between two collisions in the last step.

    Attributes:
        collision1: the sensor's collision, with its link and model: ``robot::bumper::collision``.
        collision2: the other collision.
        positions: the contact points, in m in the world, shape (points, 3).
        normals: unit vectors from the other collision to the sensor's, in the axes of the world, shape (points, 3).
        depths: the penetration depths in m, shape (points,).
        forces: the forces on the link of the sensor, in N, in the axes of the world, shape (points, 3).
        torques: the torques on the link about the origin of its frame, in N m, shape (points, 3).
    """

    collision1: str
    collision2: str
    positions: Array
    normals: Array
    depths: Array
    forces: Array
    torques: Array


class ContactSensor:
    """A sensor for the contacts of a link's collisions.

    Args:
        mount: the mount of the sensor on its link.
        collisions: the names of the collisions; if empty, all collisions of the link.
    """

    def __init__(self, mount: Mount, collisions: Sequence[str] = ()) -> None:
        self._mount = mount
        self._simulation = mount.simulation
        self._collision_names = {
            f"{mount.link}{SEPARATOR}{collision.rpartition(SEPARATOR)[2]}" for collision in collisions
        }
        self._is_sensed_table = GeomTable(self._simulation, self._mark_sensed_geoms)

    def _mark_sensed_geoms(self, names: list[str]) -> list[float]:
        return [float(self._is_sensed(get_part_name(name))) for name in names]

    def _is_sensed(self, part: str) -> bool:
        name, mark, _ = part.partition(_COLLISION_MARK)
        if not mark:
            return False
        return (
            name in self._collision_names
            if self._collision_names
            else name.rpartition(SEPARATOR)[0] == self._mount.link
        )

    def measure(self) -> list[Contact]:
        """Return the current contacts, one for each pair of collisions.

        Raises:
            KeyError: the link no longer exists.
        """
        sensed_mask, origin = (
            self._is_sensed_table.array(),
            np.array(self._mount.simulation.link_pose(self._mount.link)[:3]),
        )
        model, data, mujoco = self._simulation.model, self._simulation.data, load_mujoco()
        count = data.ncon
        pairs = data.contact.geom[:count]
        rows_by_pair: dict[tuple[str, str], list[Array]] = {}
        for index in np.nonzero((sensed_mask[pairs[:, 0]] > 0) | (sensed_mask[pairs[:, 1]] > 0))[0] if count else ():
            is_first = sensed_mask[pairs[index, 0]] > 0
            own_geom, other_geom = (
                (pairs[index, 0], pairs[index, 1]) if is_first else (pairs[index, 1], pairs[index, 0])
            )
            wrench = np.zeros(6)
            mujoco.mj_contactForce(model, data, int(index), wrench)
            frame = data.contact.frame[index].reshape(3, 3)
            sign = -1.0 if is_first else 1.0  # frame and force both point from the first geom to the second
            position = np.array(data.contact.pos[index])
            force = sign * wrench[:3] @ frame
            torque = sign * wrench[3:] @ frame + np.cross(position - origin, force)
            row = np.concatenate([position, sign * frame[0], [max(-data.contact.dist[index], 0.0)], force, torque])
            names = _get_collision_name(model.geom(own_geom).name), _get_collision_name(model.geom(other_geom).name)
            rows_by_pair.setdefault(names, []).append(row)
        return [_create_contact(names, np.array(rows)) for names, rows in rows_by_pair.items()]


def _get_collision_name(geom: str) -> str:
    return geom.partition(_COLLISION_MARK)[0]


def _create_contact(names: tuple[str, str], rows: Array) -> Contact:
    return Contact(*names, rows[:, :3], rows[:, 3:6], rows[:, 6], rows[:, 7:10], rows[:, 10:13])
