"""The resistance of the air to quadrotors: ``libhector_gazebo_quadrotor_aerodynamics.so``.

The force and the torque oppose the velocity v and the turning rate w of the body: each component is ``-C |v| v_i``, or
``-C |w| w_i``, in the axes of the body.

Source: hector_quadrotor (parameters, defaults, topics, formulas, and the coefficients of its parameter file).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array, rotation_matrix
from linkwright.messages import Header, get_message
from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.plugins.entities import vector_components
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.simulation.plugins.sensors.contact import wrench_to_message

_WRENCH_TYPE, _WIND_TYPE = "geometry_msgs/msg/WrenchStamped", "geometry_msgs/msg/Vector3"
FORCE_COEFFICIENTS = np.array((0.12, 0.12, 0.1))
"""The coefficients of the force along x, y and z, in N s^2/m^2."""
TORQUE_COEFFICIENTS = np.array((0.074156208, 0.074156208, 0.050643264))
"""The coefficients of the torque about x, y and z, in N m s^2."""
_MAX_RATE = 100.0
"""The limit of each component of the velocity in m/s and of the turning rate in rad/s."""
_FORWARD_RIGHT_DOWN = np.array((1.0, -1.0, -1.0))


@dataclass(frozen=True, kw_only=True)
class AerodynamicsParameters:
    """Parameters of ``libhector_gazebo_quadrotor_aerodynamics.so``."""

    wind_topic_name: str = parameter("/wind", aliases=("windTopicName",))
    wrench_topic: str = parameter("aerodynamics/wrench", aliases=("wrenchTopic",))
    frame_id: str = parameter("", aliases=("frameId",))


class HectorAerodynamics(SimulatedPlugin[AerodynamicsParameters]):
    """The substitute for ``libhector_gazebo_quadrotor_aerodynamics.so``.

    The original rotates velocities from the axes of the body to those of the world, instead of the other way. This is
    right only for a level quadrotor, and is reproduced with the mistakes of Gazebo.
    """

    PARAMETERS = AerodynamicsParameters
    IGNORED = ("bodyName", "updateRate", "paramNamespace")
    CARRIED = ("_wind",)

    def start(self) -> None:
        """Create the topics."""
        parameters, node = self.parameters, self.node
        self._link = self.first_link
        self._frame = parameters.frame_id or self._link.rpartition(SEPARATOR)[2]
        self._output = node.publisher(_WRENCH_TYPE, parameters.wrench_topic)
        node.subscribe(_WIND_TYPE, parameters.wind_topic_name, self._on_wind, 1)
        self.reset()
        self.every(0.0, self._update)

    def reset(self) -> None:
        """Calm the wind."""
        self._wind: Array = np.zeros(3)

    def _on_wind(self, message: Any) -> None:
        self._wind = np.array(vector_components(message))

    def _update(self) -> None:
        pose = self.simulation.link_pose(self._link)
        rotation = rotation_matrix(np.array(pose[3:]))
        velocity, rates = self.simulation.link_velocity(self._link)
        force = self._resist(rotation, velocity - self._wind, FORCE_COEFFICIENTS)
        torque = self._resist(rotation, rates, TORQUE_COEFFICIENTS)
        self.push(self._link, rotation @ force, rotation @ torque, at=pose[:3])
        if self._output.is_wanted:
            message = get_message(_WRENCH_TYPE)(header=Header(stamp=self.stamp(), frame_id=self._frame))
            message.wrench = wrench_to_message(force, torque)
            self._output.publish(message)

    def _resist(self, rotation: Array, rate: Array, coefficients: Array) -> Array:
        """Return the force or torque in the axes of the body that opposes a rate in the axes of the world."""
        limited = np.clip(rate, -_MAX_RATE, _MAX_RATE)
        if self.gazebo_mistakes:
            body_rate = _FORWARD_RIGHT_DOWN * (rotation @ (_FORWARD_RIGHT_DOWN * limited))
        else:
            body_rate = rotation.T @ limited
        resistance: Array = -coefficients * np.linalg.norm(body_rate) * body_rate
        return resistance
