"""Vehicles with tracks: ``gz-sim-tracked-vehicle-system``.

The system commands the speeds of the tracks and their center of rotation, on the topics of their
``gz-sim-track-controller-system``.

Source: gz-sim (parameters, defaults, topics, speeds, odometry).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import inf
from typing import Any

import numpy as np

from linkwright.diagnostics import phrase
from linkwright.geometry.single import rotate
from linkwright.graph.stepped.node import Output
from linkwright.kinematics.planar import PlanarPose
from linkwright.messages import Vector3, from_values, get_message
from linkwright.simulation.plugins.gz_drive import GZ_RATE_HZ, DriveCommands, GzDriveParameters, connect_drive
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.xmltree import Element

_FLOAT_TYPE = "std_msgs/msg/Float64"
_LIMITS = tuple(f"{side}_{item}" for side in ("min", "max") for item in ("velocity", "acceleration", "jerk"))
_MIN_SPEED = 1e-6
"""The least speed in m/s or rad/s that counts as motion."""


@dataclass(frozen=True, kw_only=True)
class TrackedVehicleParameters(GzDriveParameters):
    """Parameters of ``gz-sim-tracked-vehicle-system``."""

    body_link: str = ""
    tracks_separation: float = 1.0
    steering_efficiency: float = 0.5
    steering_efficiency_topic: str = ""


@dataclass(frozen=True, slots=True)
class _Track:
    """The topics of a track, and the side on which it is: 1 for the left, -1 for the right."""

    side: float
    speed_output: Output
    center_output: Output


class GzTrackedVehicle(SimulatedPlugin[TrackedVehicleParameters]):
    """The substitute for ``gz-sim-tracked-vehicle-system``."""

    PARAMETERS = TrackedVehicleParameters
    IGNORED = (
        *("left_track", "right_track", "linear_velocity", "angular_velocity"),  # read by start
        *("track_height", "tracks_height", "debug"),
    )
    CARRIED = ("_pose", "_efficiency")

    def start(self) -> None:
        """Find the tracks and the body, and create the topics.

        Raises:
            LinkwrightError: SIM133, there is no such link; SIM160, a side has no track, or the separation is zero.
        """
        parameters = self.parameters
        if parameters.tracks_separation <= 0.0:
            raise self.parameter_error(
                phrase(
                    "plugin '{plugin}': <{tag}> must be greater than 0",
                    plugin=self.context.name,
                    tag="tracks_separation",
                )
            )
        self._body = self.link(parameters.body_link) if parameters.body_link else self.first_link
        self._tracks = [*self._find_tracks("left_track", 1.0), *self._find_tracks("right_track", -1.0)]
        self._commands = DriveCommands(replace(parameters, **self._read_limits()))
        self._topics = connect_drive(self, parameters, self._commands)
        topic = parameters.steering_efficiency_topic or f"/model/{self.context.path}/steering_efficiency"
        self.node.subscribe(_FLOAT_TYPE, topic, self._on_efficiency)
        self.reset()
        self.every(GZ_RATE_HZ, self._drive)
        self.every(parameters.odom_publish_frequency, self._publish)

    def reset(self) -> None:
        """Stop the vehicle, and reset the odometry to its origin."""
        self._commands.restart()
        self._pose = PlanarPose()
        self._efficiency = self.parameters.steering_efficiency
        self._velocity = (0.0, 0.0)

    def resume(self, previous: SimulatedPlugin[TrackedVehicleParameters]) -> None:
        """Take over velocity and odometry from the previous instance."""
        super().resume(previous)
        assert isinstance(previous, GzTrackedVehicle)
        self._commands.resume(previous._commands)

    def _find_tracks(self, tag: str, side: float) -> Iterator[_Track]:
        elements = [] if self.context.element is None else list(self.context.element.elements(tag))
        if not elements:
            message = phrase("plugin '{plugin}': <{tag}> is missing", plugin=self.context.name, tag=tag)
            raise self.parameter_error(message)
        for element in elements:
            name = self.text_in(element, "link")
            self.link(name)
            base = f"/model/{self.context.path}/link/{name}"
            speed_topic = self.text_in(element, "velocity_topic") or f"{base}/track_cmd_vel"
            center_topic = self.text_in(element, "center_of_rotation_topic") or f"{base}/track_cmd_center_of_rotation"
            centers = self.node.publisher("geometry_msgs/msg/Vector3", center_topic)
            yield _Track(side, self.node.publisher(_FLOAT_TYPE, speed_topic), centers)

    def _read_limits(self) -> dict[str, Any]:
        """Return the limits of the nested elements, by the names of the parameters of other drives."""
        limits = {}
        for kind in ("linear", "angular"):
            element: Element | None = (
                None if self.context.element is None else self.context.element.first(f"{kind}_velocity")
            )
            for item in _LIMITS:
                side, _, derivative = item.partition("_")
                default = -inf if side == "min" else inf
                limits[f"{side}_{kind}_{derivative}"] = self.number_in(element, item, default)
        return limits

    def _on_efficiency(self, message: Any) -> None:
        if message.data > 0.0:
            self._efficiency = float(message.data)
            self._command_tracks(*self._velocity)

    def _drive(self) -> None:
        forward, _, turning = self._commands.next_velocity()
        self._pose.advance(forward / GZ_RATE_HZ, 0.0, turning / GZ_RATE_HZ)
        if np.abs(np.subtract((forward, turning), self._velocity)).max() > _MIN_SPEED or turning:
            self._command_tracks(forward, turning)
        self._velocity = (forward, turning)

    def _command_tracks(self, forward: float, turning: float) -> None:
        """Publish the speeds of the tracks, and their center of rotation.

        On a straight path, the center is infinitely far away.
        """
        center = (inf, inf, inf)
        if abs(turning) >= _MIN_SPEED:
            radius = 0.0 if abs(forward) < _MIN_SPEED else forward / turning
            pose = self.simulation.link_pose(self._body)
            x, y, z = rotate(pose[3:], (0.0, radius, 0.0))
            center = (pose[0] + x, pose[1] + y, pose[2] + z)
        speed_difference = turning * self.parameters.tracks_separation / (2.0 * self._efficiency)
        for track in self._tracks:
            track.center_output.publish(from_values(Vector3, center))
            track.speed_output.publish(get_message(_FLOAT_TYPE)(data=forward - track.side * speed_difference))

    def _publish(self) -> None:
        forward, turning = self._velocity
        self._topics.publish(self.stamp(), self._pose.transform, forward, 0.0, turning)
