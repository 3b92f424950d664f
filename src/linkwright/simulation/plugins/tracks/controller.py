"""Tracks and conveyor belts: ``gz-sim-track-controller-system``.

The surfaces of a link move at the commanded speed around its y axis: forward at the top, backward at the bottom. While
a vehicle turns, the motion of the surface follows a circle around the vehicle's center of rotation.

Source: gz-sim (parameters, defaults, topics); M. Pecka, K. Zimmermann, T. Svoboda, "Fast simulation of vehicles with
non-deformable tracks", IROS 2017 (the motion of the surface). MuJoCo moves the whole surface of a shape in one way, so
the mean direction of its contacts applies.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array, rotation_matrix
from linkwright.geometry.single import quaternion_from_rpy
from linkwright.kinematics.limits import SpeedLimiter
from linkwright.messages import Header, get_message
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.plugins.entities import vector_components
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin

_ODOMETRY_TYPE = "nav_msgs/msg/Odometry"
_MIN_LENGTH = 1e-9


@dataclass(frozen=True, kw_only=True)
class TrackControllerParameters:
    """Parameters of ``gz-sim-track-controller-system``."""

    link: str = parameter()
    track_orientation: tuple[float, float, float] = (0.0, 0.0, 0.0)
    velocity_topic: str = ""
    center_of_rotation_topic: str = ""
    max_command_age: float = inf
    odometry_topic: str = ""
    odometry_publish_frequency: float = 50.0
    min_velocity: float = -inf
    max_velocity: float = inf
    min_acceleration: float = -inf
    max_acceleration: float = inf
    min_jerk: float = -inf
    max_jerk: float = inf


class GzTrackController(SimulatedPlugin[TrackControllerParameters]):
    """The substitute for ``gz-sim-track-controller-system``.

    Commands are speeds in m/s, ``std_msgs/msg/Float64``, and centers of rotation, ``geometry_msgs/msg/Vector3``.
    """

    PARAMETERS = TrackControllerParameters
    IGNORED = ("debug",)
    CARRIED = ("_command", "_command_time", "_center", "_position", "_limiter")

    def start(self) -> None:
        """Find the link, and create the topics.

        Raises:
            LinkwrightError: SIM133, there is no such link.
        """
        parameters, node = self.parameters, self.node
        self._link = self.link(parameters.link)
        self.simulation.keep_awake(self._link)
        self._axis = rotation_matrix(quaternion_from_rpy(parameters.track_orientation)) @ np.array((0.0, 1.0, 0.0))
        self._revision, self._normals = -1, dict[int, Array]()
        self.reset()
        base = f"/model/{self.context.path}/link/{parameters.link}"
        command_guard = node.command_guard(self._stop_motion)
        node.subscribe(
            "std_msgs/msg/Float64",
            parameters.velocity_topic or f"{base}/track_cmd_vel",
            self._on_command,
            command_guard=command_guard,
            stop_motion=self._stop_motion,
        )
        center_topic = parameters.center_of_rotation_topic or f"{base}/track_cmd_center_of_rotation"
        node.subscribe("geometry_msgs/msg/Vector3", center_topic, self._on_center)
        self._output = node.publisher(_ODOMETRY_TYPE, parameters.odometry_topic or f"{base}/odometry")
        self.every(0.0, self._move)
        self.every(parameters.odometry_publish_frequency, self._publish)

    def reset(self) -> None:
        """Stop the track, and set its position to zero."""
        parameters = self.parameters
        self._command, self._command_time, self._position = 0.0, 0, 0.0
        self._speed = 0.0
        self._center: Array | None = None
        self._limiter = SpeedLimiter(
            (parameters.min_velocity, parameters.max_velocity),
            (parameters.min_acceleration, parameters.max_acceleration),
            (parameters.min_jerk, parameters.max_jerk),
        )

    def stop(self) -> None:
        """Stop the surfaces. Those of a rebuilt model do not move yet, and have other indices."""
        if self._revision == self.simulation.revision:
            self.simulation.model.geom_surfacevel[list(self._normals)] = 0.0

    def _on_command(self, message: Any) -> None:
        self._command, self._command_time = float(message.data), self.simulation.time
        self.simulation.wake()

    def _on_center(self, message: Any) -> None:
        center = np.array(vector_components(message))
        self._center = center if np.isfinite(center).all() else None

    def _stop_motion(self) -> bool:
        """Command a speed of zero, and return whether it was nonzero."""
        old_command, self._command = self._command, 0.0
        return old_command != 0.0

    def _move(self) -> None:
        simulation, parameters = self.simulation, self.parameters
        seconds = simulation.step / NANOSECONDS_PER_SECOND
        age = (simulation.time - self._command_time) / NANOSECONDS_PER_SECOND
        self._speed = self._limiter.approach(0.0 if age > parameters.max_command_age else self._command, seconds)
        self._position += self._speed * seconds
        self._find_geoms()
        model, data = simulation.model, simulation.data
        for geom in self._normals:
            rotation = data.geom_xmat[geom].reshape(3, 3)
            linear, angular = self._compute_surface_motion(geom)
            model.geom_surfacevel[geom, :3], model.geom_surfacevel[geom, 3:] = linear @ rotation, angular @ rotation
        if self._speed != 0.0:
            model.flg_surfacevel = True

    def _find_geoms(self) -> None:
        """Find the geoms of the link's collisions, if the model was rebuilt.

        At first, vehicles are expected to touch the ground below, and fixed belts objects above.
        """
        simulation = self.simulation
        simulation.refresh()
        if self._revision == simulation.revision:
            return
        self._revision, model = simulation.revision, simulation.model
        prefix = f"{self._link}{SEPARATOR}"
        names = [model.geom(geom).name for geom in range(model.ngeom)]
        is_fixed = model.body_weldid[simulation.body(self._link)] == 0
        normal = np.array((0.0, 0.0, -1.0 if is_fixed else 1.0))
        self._normals = {
            geom: normal for geom, name in enumerate(names) if name.startswith(prefix) and "#collision" in name
        }

    def _compute_surface_motion(self, geom: int) -> tuple[Array, Array]:
        """Return the linear and the angular velocity of a geom's surface.

        Both are in world axes, in m/s and rad/s.
        """
        simulation, zero = self.simulation, np.zeros(3)
        axis = rotation_matrix(simulation.link_pose(self._link)[3:]) @ self._axis
        points, normals = self._find_contacts(geom)
        belt_direction = np.cross(normals, axis).mean(axis=0)
        length = float(np.linalg.norm(belt_direction))
        if length < _MIN_LENGTH:
            return zero, zero
        if self._center is None:
            return self._speed * belt_direction / length, zero
        arms = points - self._center
        tangents = np.cross(normals, arms)
        distance = float(np.linalg.norm(tangents, axis=1).mean())
        if distance < _MIN_LENGTH:
            return zero, zero
        alignment = float((tangents @ belt_direction).sum())
        angular = normals.mean(axis=0) * (self._speed if alignment >= 0.0 else -self._speed) / distance
        return np.cross(angular, simulation.data.geom_xpos[geom] - self._center), angular

    def _find_contacts(self, geom: int) -> tuple[Array, Array]:
        """Return the contact points of a geom, and the normals into it.

        Both have the shape (n, 3), in world axes. Without a contact, the only point is the center of the geom, with
        the last normal.
        """
        data = self.simulation.data
        pairs = data.contact.geom[: data.ncon]
        touching = np.nonzero((pairs == geom).any(axis=1))[0]
        if not len(touching):
            return data.geom_xpos[geom][None, :].copy(), self._normals[geom][None, :]
        signs = np.where(pairs[touching, 1] == geom, 1.0, -1.0)  # normals point from the first geom to the second
        normals: Array = data.contact.frame[touching, :3] * signs[:, None]
        self._normals[geom] = normals.mean(axis=0)
        return data.contact.pos[touching].copy(), normals

    def _publish(self) -> None:
        if self._output.is_wanted:
            message = get_message(_ODOMETRY_TYPE)(header=Header(stamp=self.stamp()))
            message.pose.pose.position.x, message.twist.twist.linear.x = self._position, self._speed
            self._output.publish(message)
